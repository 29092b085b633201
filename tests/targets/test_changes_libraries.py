"""Known changes of platform libraries: what is in force on which machine."""

import msgspec
import pytest
from rosimpact.impact.targets.changes import iterate_in_force, load_rows, load_transitive
from rosimpact.impact.targets.distro.distro import DistroTarget
from rosimpact.impact.targets.tables import DATA
from rosimpact.impact.targets.unpacked import read_table
from rosimpact.impact.targets.version import is_at_least, parse


class Machine(DistroTarget):
    """A target that only has libraries."""

    def __init__(self, python_major: int = 3, **libraries: str):
        self.platform = "ubuntu focal"
        self.distro, self.ros, self.python_major = "noetic", 1, python_major
        self.libraries = {name.replace("_", "-"): version for name, version in libraries.items()}

    def find_version(self, package):
        return None

    def find_library(self, name):
        return self.libraries.get(name)

    def find_oldest_library(self, name):
        return None


class Nothing:
    """A provider table that knows no release."""

    def has_header(self, *_):
        return None


def state_of(machine: Machine, kind: str, name: str) -> str:
    """The state of a change whose old or new spelling is name, empty where it is in order."""
    found = {
        state
        for row, state in iterate_in_force(machine, Nothing())
        if row.kind.startswith(kind) and name == (row.new if state == "absent" else row.old)
    }
    return found.pop() if len(found) == 1 else "/".join(sorted(found))


@pytest.mark.parametrize(
    ("machine", "kind", "name", "expected"),
    [
        # OpenCV 2.4 to 3 to 4: constants, headers in both directions, SIFT that came back
        (Machine(opencv="3.2.0"), "api", "CV_LOAD_IMAGE_COLOR", ""),
        (Machine(opencv="4.2.0"), "api", "CV_LOAD_IMAGE_COLOR", "removed"),
        (Machine(opencv="4.2.0"), "api", "CV_BGR2GRAY", "removed"),
        (Machine(opencv="2.4.8"), "header", "opencv2/imgcodecs.hpp", "absent"),
        (Machine(opencv="3.2.0"), "header", "opencv2/imgcodecs.hpp", ""),
        (Machine(opencv="4.2.0"), "header", "opencv/cv.h", "removed"),
        (Machine(opencv="4.2.0"), "api", "cv::SIFT", "removed"),
        (Machine(opencv="4.5.4"), "api", "cv::SIFT", ""),
        (Machine(opencv="4.6.0"), "api", "cv::aruco::drawAxis", ""),
        (Machine(opencv="4.10.0"), "api", "cv::aruco::drawAxis", "removed"),
        # Boost
        (Machine(boost="1.65.1"), "header", "boost/signal.hpp", ""),
        (Machine(boost="1.71.0"), "header", "boost/signal.hpp", "removed"),
        (Machine(boost="1.58.0"), "header", "boost/asio/io_context.hpp", "absent"),
        (Machine(boost="1.83.0"), "api", "boost::asio::io_service", "deprecated"),
        (Machine(boost="1.90.0"), "api", "boost::asio::io_service", "removed"),
        # PCL, FFmpeg, gazebo classic, Ceres, FCL, TBB
        (Machine(pcl="1.10.0"), "api", "pcl_isnan", ""),
        (Machine(pcl="1.12.1"), "api", "pcl_isnan", "removed"),
        (Machine(pcl="1.10.0"), "header", "pcl/memory.h", "absent"),
        (Machine(ffmpeg_libavcodec="2.8.17"), "api", "CODEC_ID_H264", ""),
        (Machine(ffmpeg_libavcodec="3.4.11"), "api", "CODEC_ID_H264", "removed"),
        (Machine(ffmpeg_libavcodec="4.4.2"), "api", "avcodec_decode_video2", ""),
        (Machine(ffmpeg_libavcodec="6.1.1"), "api", "avcodec_decode_video2", "removed"),
        (Machine(gazebo_classic="7.0.0"), "api", "GetWorldPose", ""),
        (Machine(gazebo_classic="9.0.0"), "api", "GetWorldPose", "removed"),
        (Machine(gazebo_classic="9.0.0"), "header", "gazebo/math/gzmath.hh", "removed"),
        (Machine(ceres="2.0.0"), "header", "ceres/manifold.h", "absent"),
        (Machine(ceres="2.2.0"), "header", "ceres/local_parameterization.h", "removed"),
        (Machine(fcl="0.5.0"), "header", "fcl/narrowphase/collision.h", "absent"),
        (Machine(fcl="0.7.0"), "header", "fcl/collision.h", "removed"),
        (Machine(tbb="2021.5.0"), "header", "tbb/task_scheduler_init.h", "removed"),
        # Python and NumPy; Python 2 has what Python 3 dropped
        (Machine(python="3.12.3"), "python", "collections.Mapping", "removed"),
        (Machine(python="3.8.2"), "python", "collections.Mapping", "deprecated"),
        (Machine(python="3.6.7", python_major=2), "python", "string.letters", ""),
        (Machine(python="3.6.7"), "python", "string.letters", "removed"),
        (Machine(numpy="1.21.5"), "python", "numpy.float", "deprecated"),
        (Machine(numpy="1.26.4"), "python", "numpy.float", "removed"),
        (Machine(numpy="2.3.5"), "python", "numpy.bool", ""),
        (Machine(numpy="2.3.5"), "python", "numpy.NaN", "removed"),
        # Standard headers that older compilers lack
        (Machine(gcc="7.5.0"), "header", "filesystem", "absent"),
        (Machine(gcc="9.4.0"), "header", "filesystem", ""),
        (Machine(gcc="5.4.0"), "header", "optional", "absent"),
    ],
)  # fmt: skip
def test_states(machine: Machine, kind: str, name: str, expected: str) -> None:
    assert state_of(machine, kind, name) == expected


def test_constants_of_the_c_api_are_excused_by_its_headers() -> None:
    rows = {row.old: row for row in load_rows() if row.package == "opencv"}
    assert "imgproc/types_c.h" in rows["CV_BGR2GRAY"].unless
    assert any(ending.endswith("highgui_c.h") for ending in rows["CV_WINDOW_AUTOSIZE"].unless)


def test_standard_names_are_told_by_the_header_that_defines_them_first() -> None:
    rows = {row.name: row for row in load_transitive() if row.library == "gcc"}
    assert rows["uint32_t"].since == "13" and rows["uint32_t"].headers[0] == "cstdint"
    assert rows["std::mutex"].headers[0] == "mutex"
    assert rows["std::condition_variable"].headers == ("condition_variable",)


def test_every_row_of_the_file_states_its_source_and_orders_its_versions() -> None:
    file = msgspec.json.decode((DATA / "changes_libraries.json").read_bytes())
    assert len(file["changes"]) > 100
    read_from_wheels = {
        (group["package"], name)
        for group in read_table(DATA / "changes_pypi.json.zst", dict)["changes"]
        for name in group["names"]
    }
    for group in file["changes"]:
        assert group["library"] and group["source"] and group["names"], group
        # Where it names no version, wheels do.
        wanted = {(group["package"], name) for name in group["names"]}
        bounded = any(group.get(key) for key in ("removed_in", "deprecated_in", "new_since"))
        assert bounded or wanted <= read_from_wheels, group["source"]
        for earlier, later in (("deprecated_in", "removed_in"), ("removed_in", "back_in")):
            if group.get(earlier) and group.get(later):
                assert parse(group[earlier]) != parse(group[later])
                assert is_at_least(group[later], group[earlier]), (group["source"], earlier, later)
        assert all(old != new for old, new in group["names"].items()), group["source"]

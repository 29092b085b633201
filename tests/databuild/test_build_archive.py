"""Which packages an archive has, by its index and by the lists of files of others."""

import pytest
from rosimpact.databuild.archive import build_table, find_lacking
from rosimpact.databuild.providers import list_ros_packages, read_names
from rosimpact.impact.targets.providers.archive import Archives

INDEX = """\
Package: winch-dev
Source: winch (1.0)
Provides: rope-dev (= 1), cord-dev

Package: ros-crane
Source: ros-crane

Package: python3-rosdep2
Source: rosdep
Provides: python3-rosdep
"""


def test_names_of_an_index_with_what_is_provided(tmp_path):
    (tmp_path / "suite_main_binary-amd64_Packages").write_text(INDEX)
    assert read_names(tmp_path) == {
        "winch-dev", "rope-dev", "cord-dev", "ros-crane", "python3-rosdep2", "python3-rosdep"
    }  # fmt: skip
    assert set(list_ros_packages(tmp_path)) == {"ros-crane", "python3-rosdep2", "python3-rosdep"}
    with pytest.raises(FileNotFoundError, match="no Packages index"):
        read_names(tmp_path / "nowhere")


class Listed:
    """As Providers: the packages of names with the bits of the platforms that have them."""

    platforms = ("debian bookworm", "ubuntu jammy", "ubuntu noble")

    def list_packages_of_names(self):
        yield ("winch-dev",), 0b011
        yield ("winch-dev", "rope-dev"), 0b110
        yield ("rope-dev",), 0b100
        yield ("cord-dev",), 0b001


def test_a_release_lacks_what_alone_has_files_in_another():
    assert find_lacking(Listed()) == {"ubuntu jammy": {"rope-dev"}, "ubuntu noble": {"winch-dev"}}


SUITES = {
    "debian bullseye": {"old", "both", "gone"},
    "debian bookworm": {"old", "both"},
    "debian trixie": {"both", "new"},
    "debian forky": {"both", "new"},
}


@pytest.mark.parametrize(
    ("platform", "package", "lacks"),
    [
        ("debian trixie", "old", True),
        ("debian bookworm", "old", False),
        ("debian trixie", "elsewhere", False),  # that no archive ever had
        ("ubuntu resolute", "old", True),
        ("ubuntu noble", "old", False),  # which Debian had before
        ("ubuntu noble", "gone", False),  # whose files nobody listed
        ("ubuntu focal", "old", False),  # before all that was read
        ("robostack", "old", False),
    ],
)
def test_what_a_platform_lacks(platform, package, lacks):
    names = {name for names in SUITES.values() for name in names}
    lacking = {"ubuntu noble": {"old"}, "ubuntu resolute": {"old"}, "ubuntu focal": {"old"}}
    assert Archives(build_table(SUITES, names, lacking)).lacks(platform, package) is lacks

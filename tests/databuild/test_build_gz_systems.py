"""Systems of gz-sim and what its loader accepts, read from the tags of two small clones."""

import pygit2
import pytest
from rosimpact.databuild.git import BuildError
from rosimpact.databuild.gz_systems import build_table
from rosimpact.impact.targets.gz_systems import GzSystems


def release(repository, tag, files):
    """Commits files, by path, and tags them."""

    def write(files):
        builder = repository.TreeBuilder()
        folders = {}
        for path, text in files.items():
            head, _, rest = path.partition("/")
            if rest:
                folders.setdefault(head, {})[rest] = text
            else:
                builder.insert(head, repository.create_blob(text.encode()), pygit2.enums.FileMode.BLOB)
        for name, inside in folders.items():
            builder.insert(name, write(inside), pygit2.enums.FileMode.TREE)
        return builder.write()

    who = pygit2.Signature("a", "a@example.org", 1700000000, 0)
    repository.create_reference(f"refs/tags/{tag}", repository.create_commit(None, who, who, tag, write(files), []))


@pytest.fixture
def clones(tmp_path):
    systems, vendor = (pygit2.init_repository(str(tmp_path / name), bare=True) for name in ("systems", "vendor"))
    imu = {"src/systems/CMakeLists.txt": "function(gz_add_system name)\ngz_add_system(${x})\nendfunction()\n",
           "src/systems/imu/CMakeLists.txt": "gz_add_system(imu\n  SOURCES Imu.cc)\n"}  # fmt: skip
    release(systems, "ignition-gazebo6_6.0.0", {**imu, "src/SystemLoader.cc": "using namespace gz::sim;"})
    release(systems, "ignition-gazebo6_6.10.0", {**imu, "src/SystemLoader.cc": 'std::string prefix{"gz-sim"};'})
    release(systems, "gz-sim8_8.0.0-pre1", {**imu, "src/SystemLoader.cc": ""})
    imu["src/systems/dvl/CMakeLists.txt"] = "gz_add_system(dvl SOURCES D.cc)\n"
    release(systems, "gz-sim8_8.0.0", {**imu, "src/SystemLoader.cc": "", "src/Util.cc": '"ignition-gazebo"'})
    parts = "set(LIB_VER_MAJOR 8)\nset(LIB_VER_MINOR 0)\nset(LIB_VER_PATCH 0)\n"
    release(vendor, "upstream/0.0.10", {"CMakeLists.txt": parts})
    release(vendor, "upstream/0.0.9", {"CMakeLists.txt": parts})
    return tmp_path / "systems", tmp_path / "vendor"


def test_versions_have_systems_and_prefixes(clones):
    assert build_table(*clones) == GzSystems(
        ("6.0.0", "6.10.0", "8.0.0"),
        {"dvl": (2, 2), "imu": ()},
        {"gz-sim": (1, 2), "ignition-gazebo": ()},
        {"0.0.9": "8.0.0", "0.0.10": "8.0.0"},
    )


def test_a_clone_without_releases_is_an_error(clones):
    with pytest.raises(BuildError, match="no tags of releases"):
        build_table(clones[1], clones[0])

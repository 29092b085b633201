"""Building a file of surfaces from clones: which states are read, what a stopped run keeps, what is missing."""

import pickle
import subprocess

import pytest
from rosimpact.databuild import surfaces as build_surfaces
from rosimpact.databuild.jobs import Job, run
from rosimpact.databuild.surface.clones import Clones
from rosimpact.databuild.surfaces import build, list_distros, plan
from rosimpact.impact.targets.distro.distro import DistroTarget, TargetError
from rosimpact.impact.targets.surface.changes import Line
from rosimpact.impact.targets.surface.store import StoredSurfacesError, SurfaceHistory, Surfaces
from rosimpact.impact.targets.unpacked import read_packed

MANIFEST = """<package format="3"><name>{name}</name><version>{version}</version><description>d</description>
<maintainer email="a@b.c">m</maintainer><license>l</license><buildtool_depend>{made_by}</buildtool_depend>
<export><build_type>{made_by}</build_type></export></package>"""
CMAKE = """cmake_minimum_required(VERSION 3.16)
project({name})
find_package({made_by} REQUIRED)
install(DIRECTORY include/ DESTINATION include)
{ending}
"""


def git(folder, *arguments):
    identity = ("-c", "user.name=a", "-c", "user.email=a@b.c")
    subprocess.run(["git", "-C", str(folder), *identity, *arguments], check=True, capture_output=True)


def release(folder, name, tag, code, made_by="ament_cmake"):
    """Commits a package with one header as a release, and tags it."""
    if not (folder / ".git").exists():
        folder.mkdir(parents=True)
        git(folder, "init", "-q", "-b", "rolling")
    ending = "ament_package()" if made_by.startswith("ament") else "catkin_package(INCLUDE_DIRS include)"
    (folder / name / "include" / name).mkdir(parents=True, exist_ok=True)
    (folder / name / "package.xml").write_text(MANIFEST.format(name=name, version=tag, made_by=made_by))
    (folder / name / "CMakeLists.txt").write_text(CMAKE.format(name=name, made_by=made_by, ending=ending))
    (folder / name / "include" / name / "a.hpp").write_text(code)
    git(folder, "add", "-A")
    git(folder, "commit", "-qm", "x")
    git(folder, "tag", tag)


@pytest.fixture
def clones(tmp_path, monkeypatch):
    """Clones of two repositories, each with the versions that humble and jazzy have."""
    monkeypatch.setenv("ROSIMPACT_CACHE", str(tmp_path / "cache"))
    for repository, name in (("ros2+rclcpp", "rclcpp"), ("ros-perception+vision_opencv", "cv_bridge")):
        for distro in ("humble", "jazzy"):
            version = DistroTarget(distro).find_version(name)
            release(tmp_path / "clones" / repository, name, version, f"void of_{distro}();")
    return Clones(tmp_path / "clones")


def test_each_clone_is_one_job_that_can_be_sent_away(clones):
    jobs, missing = plan(clones, ("humble", "jazzy"), ("rclcpp", "cv_bridge", "nav2_core"))
    assert [(job.name, [(s.revision.rpartition("/")[2], s.approximate) for s in job.states]) for job in jobs] == [
        (name, [(DistroTarget(distro).find_version(package), False) for distro in ("humble", "jazzy")])
        for name, package in (("ros-perception/vision_opencv", "cv_bridge"), ("ros2/rclcpp", "rclcpp"))
    ]
    assert missing == tuple(
        f"nav2_core {DistroTarget(distro).find_version('nav2_core')} {distro}" for distro in ("humble", "jazzy")
    )
    again: Job = pickle.loads(pickle.dumps(jobs[1]))
    assert again.compute_key() == jobs[1].compute_key()
    assert run(again) == run(jobs[1])


def test_what_is_written(clones, tmp_path):
    file = tmp_path / "out" / "surfaces.sqlite"
    seen = []
    built = build(clones, ("humble", "jazzy"), file, jobs=1, progress=lambda *told: seen.append(told))
    assert (built.packages, built.versions, built.approximate) == (2, 4, 0)
    assert [told[1:] for told in seen] == [(1, 2), (2, 2)]
    history = Surfaces(file).find_history("rclcpp", 2)
    old, new = (DistroTarget(distro).find_version("rclcpp") for distro in ("humble", "jazzy"))
    assert history.index_names() == {"of_humble": (old,), "of_jazzy": (new,), "rclcpp/a.hpp": (old, new)}
    assert [path.name for path in file.parent.iterdir()] == ["surfaces.sqlite"]
    # Packages of the same repositories that this clone does not have are told.
    assert any(line.startswith("rclcpp_action ") for line in built.failed)


def test_packages_of_another_file_are_written_too(clones, tmp_path):
    """A package that both have keeps the history with more versions."""
    first, second = tmp_path / "first.sqlite", tmp_path / "second.sqlite"
    build(clones, ("humble", "jazzy"), first, ("rclcpp",), jobs=1)
    built = build(clones, ("humble",), second, jobs=1, onto=first)
    assert (built.packages, built.versions) == (2, 3)
    written = Surfaces(second)
    assert len(written.find_history("rclcpp", 2).versions) == 2
    assert len(written.find_history("cv_bridge", 2).versions) == 1
    assert written.about.distros == "humble jazzy"
    (tmp_path / "text").write_text("no file of surfaces")
    with pytest.raises(StoredSurfacesError, match=r"text: no file of surfaces .*surface build"):
        build(clones, ("humble",), second, jobs=1, onto=tmp_path / "text")


def test_processes_give_the_same(clones, tmp_path):
    for name, jobs in (("one", 1), ("two", 2)):
        build(clones, ("humble",), tmp_path / name, ("rclcpp", "cv_bridge"), jobs)
    assert (tmp_path / "one").read_bytes() == (tmp_path / "two").read_bytes()


def test_a_stopped_run_goes_on(clones, tmp_path, monkeypatch):
    file = tmp_path / "surfaces.sqlite"
    asked = (clones, ("humble",), file, ("rclcpp", "cv_bridge"), 1)

    def stop(name, done, total):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        build(*asked, progress=stop)
    assert not file.exists()
    done = []
    monkeypatch.setattr(build_surfaces, "run", lambda job: done.append(job.name) or run(job))
    assert build(*asked).packages == 2
    assert len(done) == 1


def test_a_moved_tag_is_read_again(clones, tmp_path):
    file = tmp_path / "surfaces.sqlite"
    build(clones, ("humble",), file, ("rclcpp",), 1)
    version = DistroTarget("humble").find_version("rclcpp")
    git(clones.folder / "ros2+rclcpp", "tag", "-f", version, "HEAD")
    build(Clones(clones.folder), ("humble",), file, ("rclcpp",), 1)
    assert "of_jazzy" in Surfaces(file).find_history("rclcpp", 2).index_names()


def test_versions_of_one_package_in_two_clones_are_one_job(clones, tmp_path):
    older, newer = (DistroTarget(distro).find_version("rclcpp") for distro in ("jazzy", "kilted"))
    release(clones.folder / "ros2-gbp+any-release", "rclcpp", f"release/kilted/rclcpp/{newer}-1", "void of_kilted();")
    (job,), missing = plan(Clones(clones.folder), ("jazzy", "kilted"), ("rclcpp",))
    assert [(state.clone, state.version) for state in job.states] == [
        ("ros2/rclcpp", older),
        ("ros2-gbp/any-release", newer),
    ]
    packed = run(job).packages["rclcpp", 2]
    assert SurfaceHistory("rclcpp", packed.data, packed.includes).versions == (older, newer)
    assert list(read_packed(packed.changes, Line).events["c++"]) == ["of_jazzy", "of_kilted"]
    assert missing == ()


def test_all_versions_that_a_distro_ever_had(clones):
    folder = clones.folder / "ros2+rclcpp"
    had = list(dict.fromkeys(version for _, version in DistroTarget("humble").list_releases("rclcpp")))
    for version in had[:2]:
        release(folder, "rclcpp", version, f"int of_{version.replace('.', '_')};")
    git(folder, "branch", "humble")
    (job,), missing = plan(Clones(clones.folder), ("humble",), ("rclcpp",), "all")
    assert [state.version for state in job.states] == [*had[:2], had[-1]]
    assert not any(state.approximate for state in job.states)
    # What has no tag is missing.
    assert missing == tuple(f"rclcpp {version} humble" for version in had[2:-1])
    git(folder, "tag", "-d", had[-1])
    (job,), missing = plan(Clones(clones.folder), ("humble",), ("rclcpp",), "all")
    assert [state.version for state in job.states] == had[:2]
    assert missing[-1] == f"rclcpp {had[-1]} humble"
    # Only where it has no tag for any does a branch stand for what the distro has now.
    git(folder, "tag", "-d", had[0], had[1])
    (job,), missing = plan(Clones(clones.folder), ("humble",), ("rclcpp",), "all")
    assert [(state.version, state.approximate) for state in job.states] == [(had[-1], True)]
    assert len(missing) == len(had) - 1


def test_a_version_belongs_to_the_generations_of_ros_that_had_it(tmp_path, monkeypatch):
    monkeypatch.setenv("ROSIMPACT_CACHE", str(tmp_path / "cache"))
    for distro in ("noetic", "jazzy"):
        release(tmp_path / "clones" / "ros+angles", "angles", DistroTarget(distro).find_version("angles"), "void f();")
    (job,), _ = plan(Clones(tmp_path / "clones"), ("noetic", "jazzy"), ("angles",))
    assert [state.generations for state in job.states] == [(1,), (2,)]


def test_one_version_of_two_repositories_is_two_states(tmp_path, monkeypatch):
    """ros_control of Indigo and ros2_control of Foxy have released the same numbers of packages of the same name."""
    monkeypatch.setenv("ROSIMPACT_CACHE", str(tmp_path / "cache"))
    folder = tmp_path / "clones"
    for repository, made_by, code in (
        ("ros_control", "catkin", "void one();"),
        ("ros2_control", "ament_cmake", "void two();"),
    ):
        release(folder / f"ros-controls+{repository}", "hardware_interface", "0.8.0", code, made_by)
    (job,), _ = plan(Clones(folder), ("indigo", "foxy"), ("hardware_interface",), "all")
    assert sorted((one.clone, one.version, one.generations) for one in job.states if not one.approximate) == [
        ("ros-controls/ros2_control", "0.8.0", (2,)),
        ("ros-controls/ros_control", "0.8.0", (1,)),
    ]
    packages = run(job).packages
    has = {
        ros: SurfaceHistory("", packed.data, packed.includes).index_names().keys()
        for (_, ros), packed in packages.items()
    }
    assert ["one" in has[1], "two" in has[1], "one" in has[2], "two" in has[2]] == [True, False, False, True]


def test_a_package_of_ros_1_is_no_state_of_a_ros_2_version(tmp_path, monkeypatch):
    monkeypatch.setenv("ROSIMPACT_CACHE", str(tmp_path / "cache"))
    version = DistroTarget("jazzy").find_version("angles")
    release(tmp_path / "clones" / "ros+angles", "angles", version, "void f();", "catkin")
    (job,), _ = plan(Clones(tmp_path / "clones"), ("jazzy",), ("angles",))
    result = run(job)
    assert result.packages == {}
    assert result.failed == (f"angles {version}: ros/angles has a ROS 1 package at its tag",)


def test_an_unknown_distro():
    with pytest.raises(TargetError, match="`jazy` is no distro; known are "):
        list_distros(("jazy",))

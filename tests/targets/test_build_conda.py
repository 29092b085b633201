"""How pins of conda-forge and RoboStack become versions by day."""

import json

import pygit2
import pytest
import zstandard
from rosimpact.databuild import conda
from rosimpact.databuild.git import BuildError


@pytest.mark.parametrize(
    ("text", "pins"),
    [
        ("boost:\n  - 1.74\n", {"boost": "1.74"}),
        ("boost:  # [unix]\n- '1.74.*'   # [linux]\n- 1.70  # [osx]\n", {"boost": "1.74.*"}),
        ("fmt:  # [win]\n  - 9\npcl: 1.13\n", {"pcl": "1.13"}),
        (
            "gcc:\n  - 15  # [linux]\n  - 14  # [linux and (x86_64 or aarch64) and os.environ.get('C', '') == 'T']\n",
            {"gcc": "15"},
        ),
        ("python:\n  - 3.11\n  - 3.12\n", {}),
        ("a:\n  - 1  # [not emscripten]\n  - 2  # [emscripten]\nb:\n  - 3  # [linux; no]\n", {"a": "1"}),
        ("# a comment\npin_run_as_build:\n  boost:\n    max_pin: x.x\nzlib:\n\n  - 1.2\n", {"zlib": "1.2"}),
    ],
)
def test_pins_of_a_linux_build(text, pins):
    found = conda.read_pins(text)
    assert {name: values[0] for name, values in found.items() if len(set(values)) == 1} == pins


@pytest.mark.parametrize(
    ("pin", "library"),
    [("libboost_devel", "boost"), ("libopencv", "opencv"), ("eigen", "eigen3"), ("qt6_main", "qt6"), ("tinyxml2", ""),
     ("cxx_compiler_version", "gcc"), ("yaml", ""), ("yaml_cpp", "yaml-cpp")],
)  # fmt: skip
def test_the_library_of_a_pin(pin, library):
    assert conda.find_library(pin, ["boost", "eigen3", "gcc", "opencv", "qt6", "tinyxml", "yaml-cpp"]) == library


@pytest.mark.parametrize(
    ("text", "held"),
    [
        ("mutex_package:\n  run_constraints:\n    - libboost 1.90.*\n    - vtk 9.6.2.*\nskip: [libxml2 2]\n",
         {"libboost": "1.90", "vtk": "9.6.2"}),
        ("  run_constrained:\n  # why\n  - pcl 1.14\n  - ogre 1.10.*  # [win]\n\n  run_exports:\n    - fmt 9\n",
         {"pcl": "1.14"}),
        ("run_constraints:\n  - poco >=1.11,<2\n  - poco\n", {}),
        ("requirements:\n  - pcl 1.14\n", {}),
    ],
)  # fmt: skip
def test_what_a_mutex_package_holds_others_to(text, held):
    assert conda.read_constraints(text) == held


KEYS = """
asio: {robostack: [asio]}
b: {robostack: {linux: [eigen, eigen-abi-devel], osx: []}}
c: {ubuntu: [x]}
d: {robostack: ["sqlite 3.*"]}
"""


def test_packages_of_rosdep_keys():
    assert conda.read_resolutions(KEYS) == {
        "asio": ("asio",),
        "b": ("eigen", "eigen-abi-devel"),
        "c": (),
        "d": ("sqlite",),
    }


@pytest.mark.parametrize(
    ("keys", "library"),
    [({"asio": ("asio",)}, "asio"), ({"libceres-dev": ("ceres-solver",)}, "ceres"),
     ({"ffmpeg": ("ffmpeg",)}, "ffmpeg-libavcodec"), ({"libopenblas-dev": ("libblas",)}, ""),
     ({"libpcl-all-dev": ("vtk-base",)}, ""), ({"gazebo": ("gazebo", "asio")}, "gazebo-classic")],
)  # fmt: skip
def test_libraries_of_packages_by_their_keys(keys, library):
    (package, *_), *_ = keys.values()
    assert conda.name_libraries(keys, ()).get(package, "") == library


RELEASES = {"2024-01-01": "3.9.1", "2024-02-01": "3.10.0", "2024-03-01": "4.0.0"}


@pytest.mark.parametrize(
    ("pin", "day", "version"),
    [("3.*", "2024-02-02", "3.10.0"), ("3", "2024-01-15", "3.9.1"), ("4", "2024-01-15", ""),
     ("2.1", "2024-01-15", "2.1"), ("2022", "2024-01-15", "2022"), ("any", "2024-01-15", "")],
)  # fmt: skip
def test_what_a_pin_means_on_a_day(pin, day, version):
    assert conda.resolve_version(pin, day, RELEASES) == version


def commit(repository, path, text, day, parents=None, reference="HEAD"):
    entry = repository.create_blob(text.encode())
    for part in reversed(path.split("/")):
        builder = repository.TreeBuilder()
        builder.insert(part, entry, 0o100644 if part == path.split("/")[-1] else 0o040000)
        entry = builder.write()
    who = pygit2.Signature("a", "a@example.org", 1700000000 + day * 86400, 0)
    if parents is None:
        parents = [repository.head.target] if not repository.head_is_unborn else []
    return repository.create_commit(reference, who, who, "m", entry, parents)


def test_the_table_by_channel_and_day(tmp_path, monkeypatch):
    pins = pygit2.init_repository(str(tmp_path / conda.PINNING), bare=True)
    commit(pins, "recipe/conda_build_config.yaml", "fmt:\n  - 9\nboost:\n  - 1.82\n", 0)
    commit(pins, "recipe/conda_build_config.yaml", "fmt:\n  - 10\nboost:\n  - 1.82\n", 10)
    own = pygit2.init_repository(str(tmp_path / "RoboStack+ros-humble"), bare=True)
    commit(own, "conda_build_config.yaml", "fmt:\n  - 9.1\n", 5)
    commit(own, "conda_build_config.yaml", "numpy:\n  - 1.26\n", 20)
    recipe = pygit2.init_repository(str(tmp_path / "conda-forge+fmt-feedstock"), bare=True)
    commit(recipe, "recipe/meta.yaml", '{% set version = "9.0.0" %}\n', -2)
    commit(recipe, "recipe/meta.yaml", '{% set version = "10.2.1" %}\n', 9)
    alone = pygit2.init_repository(str(tmp_path / "conda-forge+ompl-feedstock"), bare=True)
    commit(alone, "recipe/recipe.yaml", "context:\n  version: 1.6.0\n", 1)
    table = conda.build(tmp_path)
    assert table["conda-forge"] == {
        "boost": {"2023-11-14": "1.82"},
        "fmt": {"2023-11-12": "9.0.0", "2023-11-24": "10.2.1"},
        "ompl": {"2023-11-15": "1.6.0"},
    }
    assert table["humble"] == {"fmt": {"2023-11-19": "9.1", "2023-12-04": ""}, "numpy": {"2023-12-04": "1.26"}}
    monkeypatch.setattr(conda, "DATA", tmp_path / "out")
    monkeypatch.setattr(conda, "build", lambda clones, before: table)
    conda.main([str(tmp_path)])
    assert json.loads(zstandard.decompress((tmp_path / "out/conda.json.zst").read_bytes())) == table


def test_what_a_merge_brings_counts_from_the_day_of_its_branch(tmp_path):
    commit(pygit2.init_repository(str(tmp_path / conda.PINNING), bare=True), "recipe/conda_build_config.yaml", "", 0)
    own = pygit2.init_repository(str(tmp_path / "RoboStack+ros-jazzy"), bare=True)
    path = "vinca.yaml"
    text = "mutex_package:\n  run_constraints:\n    - libboost {}.*\n    - vtk {}.*\n"
    first = commit(own, path, text.format("1.88", "9.5"), 0)
    tried = commit(own, path, text.format("1.91", "9.6"), 2, [first], None)
    branch = commit(own, path, text.format("1.90", "9.6"), 3, [tried], None)
    branch = commit(own, path, text.format("1.90", "9.6") + "a: b\n", 4, [branch], None)
    commit(own, path, text.format("1.90", "9.6"), 9, [first, branch])
    table = conda.build(tmp_path)
    assert table["jazzy"] == {
        "boost": {"2023-11-14": "1.88", "2023-11-17": "1.90"},
        "vtk": {"2023-11-14": "9.5", "2023-11-16": "9.6"},
    }


def test_what_is_pinned_no_longer_is_as_its_recipe_has_it(tmp_path):
    pins = pygit2.init_repository(str(tmp_path / conda.PINNING), bare=True)
    commit(pins, "recipe/conda_build_config.yaml", "asio:\n  - 1.28\nfmt:\n  - 10\n  - 11\npcl:\n  - 1.13\n", 0)
    commit(pins, "recipe/conda_build_config.yaml", "fmt:\n  - 10\n  - 11\n", 10)
    commit(pygit2.init_repository(str(tmp_path / "RoboStack+ros-jazzy"), bare=True), "robostack.yaml", KEYS, 0)
    for name in ("asio", "fmt"):
        recipe = pygit2.init_repository(str(tmp_path / f"conda-forge+{name}-feedstock"), bare=True)
        commit(recipe, "recipe/meta.yaml", '{% set version = "1-36-0" %}\n', 5)
    before = {"conda-forge": {"ogre": {"2023-01-01": "14.0"}, "pcl": {"2023-01-01": "1.12"}}}
    assert conda.build(tmp_path, before)["conda-forge"] == {
        "asio": {"2023-11-14": "1.28", "2023-11-24": "1.36.0"},
        "ogre": {"2023-01-01": "14.0"},
        "pcl": {"2023-11-14": "1.13", "2023-11-24": ""},
    }


def test_without_the_pins_nothing_is_written(tmp_path):
    with pytest.raises(BuildError, match="is no clone; fetch it first"):
        conda.build(tmp_path)

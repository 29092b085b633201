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
        ("gcc:\n  - 15  # [linux]\n  - 14  # [linux and (x86_64 or aarch64) and os.environ.get('C', '') == 'T']\n",
         {"gcc": "15"}),
        ("python:\n  - 3.11\n  - 3.12\n", {}),
        ("a:\n  - 1  # [not emscripten]\n  - 2  # [emscripten]\nb:\n  - 3  # [linux; no]\n", {"a": "1"}),
        ("# a comment\npin_run_as_build:\n  boost:\n    max_pin: x.x\nzlib:\n\n  - 1.2\n", {"zlib": "1.2"}),
    ],
)
def test_pins_of_a_linux_build(text, pins):
    assert conda.read_pins(text) == pins


@pytest.mark.parametrize(
    ("pin", "library"),
    [("libboost_devel", "boost"), ("libopencv", "opencv"), ("eigen", "eigen3"), ("qt6_main", "qt6"), ("tinyxml2", ""),
     ("cxx_compiler_version", "gcc"), ("yaml", ""), ("yaml_cpp", "yaml-cpp")],
)  # fmt: skip
def test_the_library_of_a_pin(pin, library):
    assert conda.find_library(pin, ["boost", "eigen3", "gcc", "opencv", "qt6", "tinyxml", "yaml-cpp"]) == library


RELEASES = {"2024-01-01": "3.9.1", "2024-02-01": "3.10.0", "2024-03-01": "4.0.0"}


@pytest.mark.parametrize(
    ("pin", "day", "version"),
    [("3.*", "2024-02-02", "3.10.0"), ("3", "2024-01-15", "3.9.1"), ("4", "2024-01-15", ""),
     ("2.1", "2024-01-15", "2.1"), ("2022", "2024-01-15", "2022"), ("any", "2024-01-15", "")],
)  # fmt: skip
def test_what_a_pin_means_on_a_day(pin, day, version):
    assert conda.resolve_version(pin, day, RELEASES) == version


def commit(repository, path, text, day):
    entry = repository.create_blob(text.encode())
    for part in reversed(path.split("/")):
        builder = repository.TreeBuilder()
        builder.insert(part, entry, 0o100644 if part == path.split("/")[-1] else 0o040000)
        entry = builder.write()
    who = pygit2.Signature("a", "a@example.org", 1700000000 + day * 86400, 0)
    parents = [repository.head.target] if not repository.head_is_unborn else []
    repository.create_commit("HEAD", who, who, "m", entry, parents)


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
        "fmt": {"2023-11-14": "9.0.0", "2023-11-24": "10.2.1"},
        "ompl": {"2023-11-15": "1.6.0"},
    }
    assert table["humble"] == {"fmt": {"2023-11-19": "9.1", "2023-12-04": ""}, "numpy": {"2023-12-04": "1.26"}}
    monkeypatch.setattr(conda, "DATA", tmp_path / "out")
    monkeypatch.setattr(conda, "build", lambda clones: table)
    conda.main([str(tmp_path)])
    assert json.loads(zstandard.decompress((tmp_path / "out/conda.json.zst").read_bytes())) == table


def test_without_the_pins_nothing_is_written(tmp_path):
    with pytest.raises(BuildError, match="is no clone; fetch it first"):
        conda.build(tmp_path)

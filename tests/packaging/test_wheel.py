"""What is shipped: the content of wheel and sdist, and that the wheel runs where the user's own packages come first."""

import importlib.metadata
import json
import os
import shutil
import subprocess
import sys
import tarfile
import venv
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
ROOMS = ("impact", "corpus", "classifier", "databuild", "edges")
LIMIT = 43_000_000  # bytes, of which the shipped data are at most 30,000,000


def left_behind(folder: str, names: list[str]) -> set[str]:
    """What git ignores, and git's own folder; `build` is left behind at the root alone."""
    top = {"build", "dist"} if Path(folder) == ROOT else set()
    return {
        name
        for name in names
        if name in top | {".git", ".venv", "__pycache__"} or name.endswith((".egg-info", "_cache", ".hypothesis"))
    }


@pytest.fixture(scope="module")
def source(tmp_path_factory):
    """A copy of the project without anything an earlier build may have left."""
    copy = tmp_path_factory.mktemp("source") / "rosimpact"
    shutil.copytree(ROOT, copy, ignore=left_behind, symlinks=True)
    return copy


@pytest.fixture(scope="module")
def wheel(source, tmp_path_factory):
    return built(source, "build_wheel", tmp_path_factory.mktemp("wheel"))


@pytest.fixture(scope="module")
def wheel_names(wheel):
    with zipfile.ZipFile(wheel) as archive:
        return archive.namelist()


@pytest.fixture(scope="module")
def sdist_names(source, tmp_path_factory):
    with tarfile.open(built(source, "build_sdist", tmp_path_factory.mktemp("sdist"))) as archive:
        return {name.partition("/")[2] for name in archive.getnames()}


@pytest.fixture(scope="module")
def installed(wheel, tmp_path_factory):
    """A virtual environment that holds the wheel; its dependencies come from the environment of the tests."""
    folder = tmp_path_factory.mktemp("venv")
    # Since 22.3 pip installs into other environments. To make one with a pip of its own takes longer than all the rest.
    shared = pip_version() >= (22, 3)
    venv.create(folder, with_pip=not shared, symlinks=True)
    pip = [sys.executable, "-m", "pip", "--python", folder / "bin/python"] if shared else [folder / "bin/pip"]
    subprocess.run([*pip, "install", "--no-deps", "--no-index", wheel], check=True, capture_output=True)
    (site,) = folder.glob("lib/python*/site-packages")
    # Folders named in a .pth file come behind the venv's own, so the wheel goes before the rosimpact under test; .pth
    # files inside them, such as that of an editable installation, are not read.
    (site / "dependencies.pth").write_text("".join(f"{path}\n" for path in sys.path if path.endswith("-packages")))
    return folder


@pytest.fixture
def shadowing(tmp_path):
    """What a sourced workspace puts first on PYTHONPATH: here, packages with the names of our rooms."""
    for room in ROOMS:
        (tmp_path / room).mkdir()
        (tmp_path / room / "__init__.py").write_text(f'raise ImportError("the user\'s own package {room}")\n')
    return tmp_path


def pip_version() -> tuple[int, ...]:
    """The version of the pip of the tests' environment, empty when there is none."""
    try:
        return tuple(int(part) for part in importlib.metadata.version("pip").split(".") if part.isdigit())
    except importlib.metadata.PackageNotFoundError:
        return ()


def built(source: Path, function: str, folder: Path) -> Path:
    code = f"import sys; from setuptools import build_meta; build_meta.{function}(sys.argv[1])"
    result = subprocess.run([sys.executable, "-c", code, folder], cwd=source, capture_output=True, text=True)
    assert result.returncode == 0, result.stdout + result.stderr
    assert "Deprecat" not in result.stderr, result.stderr
    (path,) = folder.iterdir()
    return path


def run(installed: Path, *command: str, pythonpath: Path | None = None) -> subprocess.CompletedProcess[str]:
    environment = {"PATH": os.environ["PATH"], "HOME": str(installed), "XDG_CACHE_HOME": str(installed / "cache")}
    if pythonpath:
        environment["PYTHONPATH"] = str(pythonpath)
    program, *arguments = command
    return subprocess.run(
        [installed / "bin" / program, *arguments], cwd=installed, env=environment, capture_output=True, text=True
    )


def test_the_wheel_holds_the_rooms_alone(wheel_names):
    code = {name for name in wheel_names if ".dist-info/" not in name}
    assert {"/".join(name.split("/")[:2]) for name in code} == {f"rosimpact/{room}" for room in ROOMS}
    assert not [name for name in code if Path(name).name.startswith(("test_", "conftest")) or "/tests/" in name]


@pytest.mark.parametrize("room", ROOMS)
def test_every_room_is_typed(wheel_names, room):
    assert f"rosimpact/{room}/py.typed" in wheel_names


def test_no_module_or_data_file_is_left_out(wheel_names):
    tracked = {
        f"rosimpact/{path.relative_to(ROOT)}"
        for room in ROOMS
        for path in (ROOT / room).rglob("*")
        if path.is_file() and "__pycache__" not in path.parts and not path.name.startswith(".")
    }
    assert tracked - set(wheel_names) == set()


def test_the_wheel_is_small_enough(wheel):
    with zipfile.ZipFile(wheel) as archive:
        unpacked = sum(entry.file_size for entry in archive.infolist())
    assert wheel.stat().st_size <= unpacked <= LIMIT


def test_the_licence_is_stated_and_shipped(wheel):
    with zipfile.ZipFile(wheel) as archive:
        names = archive.namelist()
        (metadata,) = (archive.read(name).decode() for name in names if name.endswith(".dist-info/METADATA"))
    assert "\nLicense-Expression: Apache-2.0\n" in metadata
    assert [name for name in names if name.endswith(".dist-info/licenses/LICENSE")]


@pytest.mark.parametrize(
    "name",
    [
        "README.md",
        "LICENSE",
        "CHANGELOG.md",
        "CONTRIBUTING.md",
        "setup.py",
        ".ci/run",
        "impact/cli/app.py",
        "examples/ros2_ws/rosimpact.toml",
        "tests/packaging/test_wheel.py",
    ],
)
def test_the_sdist_can_be_built_and_tested(sdist_names, name):
    assert name in sdist_names


def test_the_sdist_holds_no_leftovers(sdist_names):
    assert not [name for name in sdist_names if "__pycache__" in name or name.startswith((".git/", ".venv", "build/"))]


def test_help_comes_from_the_wheel(installed, shadowing):
    result = run(installed, "rosimpact", "--help", pythonpath=shadowing)
    assert result.returncode == 0, result.stderr
    assert "check" in result.stdout
    where = run(installed, "python", "-c", "import rosimpact.impact.cli as c; print(c.__file__)", pythonpath=shadowing)
    assert where.stdout.startswith(str(installed)), where.stdout + where.stderr


@pytest.mark.parametrize("workspace", ["ros1_ws", "ros2_ws"])
def test_check_runs_beside_packages_of_the_same_names(installed, shadowing, workspace):
    command = ["rosimpact", "check", str(ROOT / "examples" / workspace), "--format", "json"]
    alone, shadowed = run(installed, *command), run(installed, *command, pythonpath=shadowing)
    assert shadowed.returncode == alone.returncode == 1, shadowed.stderr + alone.stderr
    findings = json.loads(shadowed.stdout)["findings"]
    assert findings == json.loads(alone.stdout)["findings"]
    assert findings

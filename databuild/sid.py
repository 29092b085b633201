"""Versions of libraries in Debian unstable by day, from the changelogs of its packages: `debian sid` of conda.json.zst.

A changelog says on which day each version was made for unstable, where it came to within hours. Debian shortens it to
the last years: of days before the oldest entry nothing is known.

    python -P -m rosimpact.databuild.sid WORK APT_CONF    # a configuration of apt for sid alone, in which
                                                          # `apt-get update` was run

WORK keeps the changelogs.
"""

from __future__ import annotations

import argparse
import gzip
import json
import os
import re
import subprocess
from collections.abc import Iterator
from email.utils import parsedate_to_datetime
from pathlib import Path

import zstandard

from ..edges.files import write_file
from ..impact.targets.distro.conda import SID
from ..impact.targets.tables import DATA
from ..impact.targets.unpacked import read_table
from .libraries import extract_upstream_version

FILE = "conda.json.zst"
_NAMED = """
abseil=libabsl-dev apriltag=libapriltag-dev armadillo=libarmadillo-dev assimp=libassimp-dev boost=libboost-dev
bullet=libbullet-dev ccd=libccd-dev ceres=libceres-dev cmake=cmake console-bridge=libconsole-bridge-dev
eigen3=libeigen3-dev empy=python3-empy fcl=libfcl-dev ffmpeg-libavcodec=libavcodec-dev flann=libflann-dev
flask=python3-flask fmt=libfmt-dev geographiclib=libgeographiclib-dev gflags=libgflags-dev
glog=libgoogle-glog-dev gsl=libgsl-dev gtest=libgtest-dev jinja2=python3-jinja2 jsoncpp=libjsoncpp-dev
libcurl=libcurl4-openssl-dev libusb=libusb-1.0-0-dev libxml2=libxml2-dev lz4=liblz4-dev
matplotlib=python3-matplotlib networkx=python3-networkx nlohmann-json=nlohmann-json3-dev nlopt=libnlopt-dev
numpy=python3-numpy octomap=liboctomap-dev ogre=libogre-1.12-dev ompl=libompl-dev opencv=libopencv-dev
openssl=libssl-dev orocos-kdl=liborocos-kdl-dev paho-mqtt=python3-paho-mqtt pcl=libpcl-dev pillow=python3-pil
poco=libpoco-dev protobuf=libprotobuf-dev pybind11=pybind11-dev pyqt5=python3-pyqt5 pyserial=python3-serial
pytest=python3-pytest python=python3-minimal pyyaml=python3-yaml qt=qtbase5-dev qt6=qt6-base-dev
scikit-image=python3-skimage scipy=python3-scipy setuptools=python3-setuptools shapely=python3-shapely
spdlog=libspdlog-dev sqlite3=libsqlite3-dev suitesparse=libsuitesparse-dev tbb=libtbb-dev tinyxml=libtinyxml-dev
tinyxml2=libtinyxml2-dev transforms3d=python3-transforms3d urdfdom=liburdfdom-dev
urdfdom-headers=liburdfdom-headers-dev vtk=libvtk9-dev yaml-cpp=libyaml-cpp-dev zeromq=libzmq3-dev
zstd=libzstd-dev
"""
PACKAGES = {name: package for name, _, package in (one.partition("=") for one in _NAMED.split())}
"""Libraries, by their names in platform_versions.yaml, with the Debian package whose version that table has. Compilers
are left out: the changelog of their default has numbers of its own."""
_DEFAULTS = frozenset(("boost",))
"""Libraries whose package names the default version, with a last number of its own."""
_ENTRY = re.compile(
    r"^\S+ \((?P<version>[^)\s]+)\) (?P<suites>[^;\n]*);.*?^ -- [^\n]*>  (?P<day>[^\n]+)$", re.MULTILINE | re.DOTALL
)


def read_changelog(text: str) -> dict[str, str]:
    """The versions of the library that unstable had, by the first day of each, oldest first."""
    found: dict[str, str] = {}
    last = ""
    entries = [entry for entry in _ENTRY.finditer(text) if entry["suites"].split()[:1] in (["unstable"], ["sid"])]
    for entry in reversed(entries):
        version = extract_upstream_version(entry["version"])
        if version != last:
            found[parsedate_to_datetime(entry["day"]).date().isoformat()] = last = version
    return found


def read_changelogs(work: Path, configuration: Path) -> Iterator[tuple[str, dict[str, str]]]:
    """Each library with its versions by day. work: keeps the changelogs. configuration: of apt."""
    work.mkdir(parents=True, exist_ok=True)
    for library, package in sorted(PACKAGES.items()):
        kept = work / f"{package}.changelog"
        if not kept.exists():
            write_file(kept, _fetch_changelog(package, work, configuration))
        rows = read_changelog(kept.read_text(encoding="utf-8", errors="replace"))
        if library in _DEFAULTS:
            rows = {day: ".".join(version.split(".")[:3]) for day, version in rows.items()}
        yield library, rows


def _fetch_changelog(package: str, work: Path, configuration: Path) -> bytes:
    """The changelog in a package; empty where it has none, or a link to that of another one."""
    environment = {**os.environ, "APT_CONFIG": str(configuration)}
    subprocess.run(["apt-get", "-qq", "download", package], cwd=work, env=environment, check=False, capture_output=True)
    text = b""
    for file in work.glob(f"{package}_*.deb"):
        files = subprocess.run(["dpkg-deb", "--fsys-tarfile", file], capture_output=True, check=False).stdout
        # Of a package that Debian makes itself the first is missing.
        for name in (f"./usr/share/doc/{package}/changelog{kind}.gz" for kind in (".Debian", "")):
            packed = subprocess.run(["tar", "-xO", name], input=files, capture_output=True, check=False).stdout
            text = text or (gzip.decompress(packed) if packed else b"")
        file.unlink()
    return text


def write_channels(file: Path, channels: dict[str, dict[str, dict[str, str]]]) -> None:
    """Writes the table, a library a line."""
    lines = (
        f"{json.dumps(channel)}: {{\n"
        + ",\n".join(f"  {json.dumps(name)}: {json.dumps(rows)}" for name, rows in libraries.items())
        + "\n}"
        for channel, libraries in channels.items()
    )
    text = "{\n" + ",\n".join(lines) + "\n}\n"
    write_file(file, zstandard.ZstdCompressor(level=19).compress(text.encode()))


def main(arguments: list[str] | None = None) -> None:
    """The command line described at the top."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("work", type=Path)
    parser.add_argument("configuration", type=Path)
    parser.add_argument("--output", type=Path, default=DATA)
    given = parser.parse_args(arguments)
    read = dict(read_changelogs(given.work, given.configuration))
    channels = read_table(given.output / FILE, dict[str, dict[str, dict[str, str]]])
    channels[SID] = {library: rows for library, rows in read.items() if rows}
    write_channels(given.output / FILE, channels)
    unread = sorted(read.keys() - channels[SID].keys())
    print(f"{len(channels[SID])} libraries; not read: {', '.join(unread) or 'none'}")


if __name__ == "__main__":
    main()

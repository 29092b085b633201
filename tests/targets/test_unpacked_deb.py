"""Debian packages as they are downloaded: what is in them comes out, and what they claim costs little."""

import functools
import gzip
import io
import lzma
import os
import random
import resource
import tarfile
import time
import zlib
from pathlib import Path

import pytest
import zstandard
from rosimpact.databuild.surface import unpacked_deb
from rosimpact.databuild.surface.unpacked_deb import DebError, DebFile, read_members
from rosimpact.edges.limits import Limits

PACKERS = {
    ".xz": functools.partial(lzma.compress, preset=0),
    ".gz": gzip.compress,
    ".zst": zstandard.ZstdCompressor().compress,
    "": bytes,
}


def ar(*parts: tuple[str, bytes]) -> bytes:
    found = b"!<arch>\n"
    for name, data in parts:
        found += f"{name:16}{0:<12}{0:<6}{0:<6}{100644:<8}{len(data):<10}`\n".encode() + data + b"\n" * (len(data) % 2)
    return found


def tar(*entries: tuple[str, object], format=tarfile.GNU_FORMAT) -> bytes:
    """name and content; for a link, what it leads to; for another type, the header's fields."""
    file = io.BytesIO()
    with tarfile.open(fileobj=file, mode="w", format=format) as archive:
        for name, what in entries:
            info = tarfile.TarInfo(name)
            data = what if isinstance(what, bytes) else b""
            if isinstance(what, str):
                info.type, info.linkname = tarfile.SYMTYPE, what
            elif isinstance(what, dict):
                for field, value in what.items():
                    setattr(info, field, value)
            else:
                info.size = len(data)
            archive.addfile(info, io.BytesIO(data))
    return file.getvalue()


def deb(data: bytes, packing: str = ".xz") -> bytes:
    parts = (("debian-binary", b"2.0\n"), ("control.tar.xz", b"odd"), (f"data.tar{packing}", PACKERS[packing](data)))
    return ar(*parts)


def of(tmp_path: Path, data: bytes) -> dict[str, DebFile]:
    (tmp_path / "a.deb").write_bytes(data)
    return read_members(tmp_path / "a.deb")


LONG = "usr/" + "deep/" * 60 + "long.h"
FILES = tar(
    ("./usr/include/a.h", b"int a;\n" * 200_000),
    ("./usr/bin/run", {"mode": 0o755}),
    ("./usr/include/b.h", "a.h"),
    ("./usr/include/out.h", "../../../../etc/passwd"),
    ("./usr/include/hard.h", {"type": tarfile.LNKTYPE, "linkname": "./usr/include/a.h"}),
    ("./usr/include/hard_out.h", {"type": tarfile.LNKTYPE, "linkname": "../../etc/passwd"}),
    ("./dev/pipe", {"type": tarfile.FIFOTYPE}),
    (LONG, b"long"),
)


@pytest.mark.parametrize("packing", PACKERS)
def test_what_is_in_it(tmp_path, packing):
    found = of(tmp_path, deb(FILES, packing))
    a = DebFile(b"int a;\n" * 200_000, False)
    assert found == {
        "usr/include/a.h": a,
        "usr/include/b.h": a,
        "usr/include/hard.h": a,
        "usr/bin/run": DebFile(b"", True),
        LONG: DebFile(b"long", False),
    }


def test_streams_one_after_another(tmp_path):
    for packing in (".xz", ".gz", ".zst"):
        pack = PACKERS[packing]
        data = pack(FILES[:1000]) + pack(FILES[1000:])
        assert len(of(tmp_path, ar(("data.tar" + packing, data)))) == 5


def header(kind: bytes = tarfile.REGTYPE, size: int = 0) -> bytes:
    info = tarfile.TarInfo("usr/a")
    info.type, info.size = kind, size
    return info.tobuf(tarfile.GNU_FORMAT)


def bomb(packing: str) -> bytes:
    """A package of few bytes that unpacks to 300 MB, made piece by piece."""
    packers = {
        ".xz": lzma.LZMACompressor(preset=0),
        ".gz": zlib.compressobj(1, wbits=31),
        ".zst": zstandard.ZstdCompressor().compressobj(),
    }
    packer, piece = packers[packing], bytes(1 << 20)
    pieces = [packer.compress(header(size=2**33)), *(packer.compress(piece) for _ in range(300)), packer.flush()]
    return ar(("data.tar" + packing, b"".join(pieces)))


HOSTILE = {
    "no archive": (b"text", "is no Debian package"),
    "nothing": (b"", "is no Debian package"),
    "no files": (ar(("debian-binary", b"2.0\n")), "holds no files"),
    "a part of negative size": (b"!<arch>\n" + f"{'x':48}{-60:<10}`\n".encode(), "holds no files"),
    "a part of no size": (b"!<arch>\n" + f"{'x':48}{'':10}`\n".encode(), "holds no files"),
    "many parts": (ar(*[("x", b"")] * 5000), "holds no files"),
    "another packing": (ar(("data.tar.lzma", b"")), "which is not known"),
    "cut off": (deb(FILES)[:-100], "is broken"),
    "no xz": (ar(("data.tar.xz", b"text")), "is broken"),
    "no tar": (deb(b"text" * 1000), "is broken"),
    "a bomb of xz": (lambda: bomb(".xz"), "unpacks to more than"),
    "a bomb of gzip": (lambda: bomb(".gz"), "unpacks to more than"),
    "a bomb of zstd": (lambda: bomb(".zst"), "unpacks to more than"),
    "a window of 2 GB": (
        ar(("data.tar.zst", b"\x28\xb5\x2f\xfd\x00\xa8" + bytes(9))),
        "is broken",
    ),
    "many files": (deb(tar(*[(f"{n}", b"") for n in range(3000)])), "more than 2,000 files"),
    "long names": (
        deb(header(tarfile.GNUTYPE_LONGNAME, 2**32)),
        "a header that is too long",
    ),
    "names of names": (
        deb(header(tarfile.GNUTYPE_LONGNAME) * 20_000),
        "is broken",
    ),
    "headers of pax": (
        deb(tar(("a", {"pax_headers": {"path": "9" * 9000}}), format=tarfile.PAX_FORMAT)),
        "dpkg does not know",
    ),
    "sparse files": (deb(header(tarfile.GNUTYPE_SPARSE)), "dpkg does not know"),
    "a file without an end": (deb(header(size=2**33)), "is broken"),
    "many streams": (ar(("data.tar.gz", gzip.compress(b"") * 5000)), "compressed parts"),
}


@pytest.mark.parametrize(("data", "said"), HOSTILE.values(), ids=HOSTILE)
def test_what_is_broken_is_named_at_once(tmp_path, monkeypatch, data, said):
    monkeypatch.setattr(unpacked_deb, "get_limits", lambda: Limits(deb=200 << 20))
    monkeypatch.setattr(unpacked_deb, "_MEMBERS", 2000)
    data = data() if callable(data) else data
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    began = time.process_time()
    with pytest.raises(DebError, match=said) as raised:
        of(tmp_path, data)
    assert time.process_time() - began < 5
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 300_000, "kilobytes"
    assert "\n" not in str(raised.value)


def test_any_damage_is_a_clause(tmp_path):
    chance = random.Random(3)
    for packing in PACKERS:
        whole = deb(tar(("usr/a", b"a" * 3000), ("usr/b", "a"), (LONG, b"x")), packing)
        for _ in range(100):
            data = bytearray(whole)
            for _ in range(chance.randrange(1, 5)):
                data[chance.randrange(len(data))] = chance.randrange(256)
            try:
                of(tmp_path, bytes(data))
            except DebError as error:
                assert "a.deb" in str(error)


@pytest.mark.parametrize("make", [os.mkfifo, os.mkdir, lambda path: path.symlink_to("/dev/zero")])
def test_what_is_no_file_is_not_opened(tmp_path, make):
    make(tmp_path / "a.deb")
    with pytest.raises(OSError):
        read_members(tmp_path / "a.deb")


def test_a_package_larger_than_its_limit(tmp_path, monkeypatch):
    monkeypatch.setattr(unpacked_deb, "get_limits", lambda: Limits(deb=1000))
    with pytest.raises(OSError, match="larger than 1000 bytes"):
        of(tmp_path, bytes(2000))

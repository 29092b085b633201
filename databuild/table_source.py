"""Where `rosimpact data update --from` takes tables from: a folder, an archive of one, or the address of one.

Whoever made it may be mistaken or hostile. Names are looked for, never taken from it; only regular files are read, and
never more bytes than a limit. What is wrong with it raises UserError.
"""

import contextlib
import errno
import gzip
import stat
import tarfile
import tempfile
import time
import zipfile
from collections.abc import Callable, Collection, Iterable, Iterator
from pathlib import Path, PurePosixPath
from typing import IO
from urllib.parse import quote, urlsplit

from ..edges.console import UserError
from ..edges.files import open_for_replacing, open_regular, read_chunks
from ..edges.limits import format_size
from ..impact.targets.tables import LARGEST

ReadTable = Callable[[str], Iterator[bytes]]
"""Gives a file of a source piece by piece."""
_LARGEST_ARCHIVE = 256 << 20
"""Bytes of an archive, and of all that it holds; each table has a limit of its own."""
_MOST_MEMBERS = 10_000
_CHUNK = 1 << 16
_TIMEOUT = 30.0
_FILE_SECONDS = 1800.0
_REDIRECTS = 5
_TARS = (".tar.zst", ".tar.gz", ".tgz")
_TAR = ".unpacked.tar"
# The largest window that zstd itself unpacks unless told otherwise.
_WINDOW = 1 << 27


@contextlib.contextmanager
def open_source(source: str, names: Collection[str], scratch: Path) -> Iterator[ReadTable]:
    """What reads the files of a source. names: those that it may be asked for. scratch: a folder in which an archive is
    unpacked, for as long as this is open."""
    path = Path(source)
    if source.startswith(("http://", "https://")):
        with _open_address(source) as read:
            yield read
    elif path.is_dir():
        yield lambda name: _read_file(path / name)
    elif not path.exists():
        raise UserError(f"{source}: not there; name a folder, an archive or an address that has a manifest.json")
    elif path.name.endswith((*_TARS, ".zip")):
        scratch.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(prefix="unpacked-", dir=scratch) as folder:
            _unpack(path, frozenset(names), Path(folder))
            yield lambda name: _read_file(Path(folder) / name)
    else:
        raise UserError(f"{source}: neither a folder nor an archive ({', '.join(_TARS)}, .zip); unpack it first")


def _read_file(path: Path) -> Iterator[bytes]:
    try:
        yield from read_chunks(path, follow=False)
    except FileNotFoundError:
        raise UserError(f"{path.parent}: has no {path.name}; name what `rosimpact data build` made") from None


@contextlib.contextmanager
def _open_address(address: str) -> Iterator[ReadTable]:
    import requests

    try:
        parts = urlsplit(address)
        if not parts.hostname or parts.username or parts.query or parts.fragment:
            raise ValueError
    except ValueError:
        raise UserError("--from: write the address of a folder, without a name, password or query") from None

    def fetch_file(name: str) -> Iterator[bytes]:
        place = f"{address.rstrip('/')}/{quote(name)}"
        deadline = time.monotonic() + _FILE_SECONDS
        try:
            with session.get(place, stream=True, timeout=_TIMEOUT) as answer:
                hops = {urlsplit(one.url).scheme for one in (*answer.history, answer)}
                if parts.scheme == "https" and hops != {"https"}:
                    raise UserError(f"{place}: leads to an address without encryption; ask for another source")
                if answer.status_code != 200:
                    raise UserError(f"{place}: the server answers {answer.status_code}; check the address")
                for chunk in answer.iter_content(_CHUNK):
                    if time.monotonic() > deadline:
                        raise UserError(f"{place}: takes more than {_FILE_SECONDS / 60:.0f} minutes; try again later")
                    yield chunk
        except requests.RequestException as error:
            raise UserError(f"{place}: {_describe_failure(error)}; run it again to go on") from None

    with requests.Session() as session:
        session.max_redirects = _REDIRECTS
        # What is unpacked on the way has no size that could be told before.
        session.headers["Accept-Encoding"] = "identity"
        # Otherwise requests would send a password from ~/.netrc.
        session.auth = lambda request: request
        yield fetch_file


def _describe_failure(error: Exception) -> str:
    """Why a request failed, without the objects that requests puts into its texts."""
    import requests

    if isinstance(error, requests.Timeout):
        return f"no answer for {_TIMEOUT:.0f} seconds"
    if isinstance(error, requests.TooManyRedirects):
        return f"is redirected more than {_REDIRECTS} times"
    if isinstance(error, requests.exceptions.ChunkedEncodingError):
        return "the connection broke"
    return "cannot be reached" if isinstance(error, requests.ConnectionError) else type(error).__name__


def _unpack(path: Path, names: frozenset[str], folder: Path) -> None:
    """Writes the files of an archive that are called so, at its top or in a folder there."""
    import zlib

    import zstandard

    try:
        with contextlib.ExitStack() as opened:
            stream = opened.enter_context(open(open_regular(path), "rb"))
            if path.stat().st_size > _LARGEST_ARCHIVE:
                raise UserError(f"{path}: larger than {format_size(_LARGEST_ARCHIVE)}; unpack it and name the folder")
            if path.name.endswith(".zip"):
                members = _list_zip(opened.enter_context(zipfile.ZipFile(stream)))
            else:
                _write_limited(_decompress(path, stream), _LARGEST_ARCHIVE, folder / _TAR, str(path))
                members = _list_tar(opened.enter_context(tarfile.open(folder / _TAR, "r:")))
            for name, member in _select_members(path, members, names):
                _write_limited(_read_stream(member), LARGEST, folder / name, f"{path}: `{name}`")
    except (tarfile.TarError, zipfile.BadZipFile, zlib.error, zstandard.ZstdError, OSError, EOFError,
            ValueError, NotImplementedError, RuntimeError) as error:  # fmt: skip
        # A place before the beginning, which a damaged archive may name, is an invalid argument of no file.
        if isinstance(error, OSError) and (error.filename or error.errno not in (None, errno.EINVAL)):
            raise
        raise UserError(f"{path}: cannot be unpacked: {error or 'it is cut off'}; get it again") from None


def _decompress(path: Path, stream: IO[bytes]) -> Iterator[bytes]:
    import zstandard

    if not path.name.endswith(".zst"):
        return _read_stream(gzip.GzipFile(fileobj=stream))
    return _read_stream(zstandard.ZstdDecompressor(max_window_size=_WINDOW).stream_reader(stream))


def _read_stream(stream: IO[bytes] | gzip.GzipFile) -> Iterator[bytes]:
    while chunk := stream.read(_CHUNK):
        yield chunk


def _write_limited(chunks: Iterable[bytes], limit: int, file: Path, what: str) -> None:
    size = 0
    with open_for_replacing(file) as opened:
        for chunk in chunks:
            size += len(chunk)
            if size > limit:
                raise UserError(f"{what}: unpacks to more than {format_size(limit)}; get it from another source")
            opened.write(chunk)


_Member = tuple[str, Callable[[], IO[bytes] | None]]
"""The path of a member, and what opens it, which gives None for what is no regular file."""


def _list_tar(archive: tarfile.TarFile) -> Iterator[_Member]:
    for one in archive:
        yield one.name, lambda one=one: archive.extractfile(one) if one.isreg() and not one.issparse() else None


def _list_zip(archive: zipfile.ZipFile) -> Iterator[_Member]:
    for one in archive.infolist():
        if one.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
            raise zipfile.BadZipFile(f"`{one.filename}` is compressed in another way than `zip` does")
        regular = stat.S_IFMT(one.external_attr >> 16) in (0, stat.S_IFREG)
        yield one.filename, lambda one=one, regular=regular: archive.open(one) if regular else None


def _select_members(path: Path, members: Iterable[_Member], names: frozenset[str]) -> Iterator[tuple[str, IO[bytes]]]:
    found: set[str] = set()
    for number, (place, open_member) in enumerate(members):
        if number == _MOST_MEMBERS:
            raise UserError(f"{path}: holds more than {_MOST_MEMBERS} files; pack the data folder alone")
        *folders, name = PurePosixPath(place).parts or ("",)
        if name not in names or len(folders) > 1:
            continue
        member = open_member()
        if member is None or name in found:
            fault = "is no regular file" if member is None else "is there twice"
            raise UserError(f"{path}: `{name}` {fault}; pack one data folder alone")
        found.add(name)
        yield name, member

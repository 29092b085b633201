"""Adds what happened since a snapshot was made, read over the network through the rosdistro library.

For each living distro the sync tags that the snapshot does not know yet are listed, and the distribution file of each
is read as it was tagged, so that availability keeps following syncs. Declared dependencies come from the distro's
cache, rosdep rules from the current files.
"""

import contextlib
import datetime
import sqlite3
import tempfile
import time
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

from ..edges.limits import format_size
from .git import BuildError, Report
from .keys import FILES, parse_rules
from .manifests import parse_manifest

INDEX = "https://raw.githubusercontent.com/ros/rosdistro/{ref}/index-v4.yaml"
"""Where rosdistro's index is; `{ref}` is a branch or tag."""
_LARGEST = 64 << 20


class Refreshed(NamedTuple):
    """What came in: syncs as `humble/2026-09-01`, numbers of changed releases, manifests and rules, and what failed."""

    syncs: tuple[str, ...]
    releases: int
    manifests: int
    rules: int
    failures: tuple[str, ...]


def fetch_sync_days(distro: str) -> list[str]:
    """Days of a distro's sync tags in ros/rosdistro, through GitHub's interface."""
    from github import Github

    repository = Github(timeout=30, retry=0).get_repo("ros/rosdistro", lazy=True)
    prefix = f"tags/{distro}/"
    return sorted(ref.ref.removeprefix(f"refs/{prefix}") for ref in repository.get_git_matching_refs(prefix))


def refresh_database(
    raw: bytes,
    index_url: str = INDEX,
    sync_days: Callable[[str], Iterable[str]] = fetch_sync_days,
    report: Report | None = None,
) -> tuple[bytes, Refreshed]:
    """The database with everything newer added, and what that was. raw: an unpacked database.

    Raises BuildError when the index cannot be had; what fails later is listed in the result and left as it was.
    """
    with _restrict_hosts(index_url):
        return _add_newer(raw, index_url, sync_days, report)


_HOSTS = ("raw.githubusercontent.com", "repo.ros2.org", "repositories.ros.org", "packages.ros.org", "docs.ros.org")
"""Where ROS keeps its index and caches, besides the host of the index itself."""


@contextlib.contextmanager
def _restrict_hosts(index_url: str) -> Iterator[None]:
    """Lets urllib, with which the rosdistro library asks, ask these hosts alone, also when it is redirected: what an
    index names is not the user's word. Files are read where the index is a file itself."""
    import urllib.error
    import urllib.parse
    import urllib.request

    own = urllib.parse.urlsplit(index_url)
    hosts = (*_HOSTS, own.hostname)

    class Known(urllib.request.BaseHandler):
        handler_order = 100  # before those that ask

        def check(self, request: urllib.request.Request) -> None:
            place = urllib.parse.urlsplit(request.full_url)
            if place.scheme == "file" == own.scheme or (place.scheme in ("http", "https") and place.hostname in hosts):
                return
            raise urllib.error.URLError(f"{place.scheme}://{place.hostname or ''} is no host of ROS, and is not asked")

        http_open = https_open = file_open = ftp_open = data_open = check

    urllib.request.install_opener(urllib.request.build_opener(Known))
    try:
        yield
    finally:
        urllib.request.install_opener(None)  # type: ignore[arg-type]


def _add_newer(
    raw: bytes, index_url: str, sync_days: Callable[[str], Iterable[str]], report: Report | None
) -> tuple[bytes, Refreshed]:
    import rosdistro

    tell = report or (lambda what, done, total: None)
    now = int(time.time())
    failures: list[str] = []
    try:
        index = rosdistro.get_index(index_url.format(ref="master"))
    except Exception as error:
        raise BuildError(f"the ROS index cannot be read ({error}); go online and try again") from None
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "distros.sqlite"
        path.write_bytes(raw)
        with contextlib.closing(sqlite3.connect(path)) as connection:
            # Nothing but this process sees the file.
            connection.execute("PRAGMA journal_mode=OFF")
            into = _Writer(connection)
            syncs: list[str] = []
            releases = manifests = 0
            living = [name for name, entry in sorted(index.distributions.items()) if _is_supported(entry)]
            for done, name in enumerate(living):
                tell(f"reading {name}", done, len(living))
                distro = into.ensure_distro(name, index.distributions[name])
                try:
                    days = [day for day in sync_days(name) if _is_day(day) and day[:10] > into.find_last_sync(distro)]
                    for day in days:
                        tagged = rosdistro.get_index(index_url.format(ref=f"{name}/{day}"))
                        releases += into.write_state(distro, rosdistro.get_distribution_file(tagged, name), day[:10])
                        syncs.append(f"{name}/{day}")
                except Exception as error:
                    failures.append(f"syncs of {name}: {error}")
                try:
                    cache = rosdistro.get_distribution_cache(index, name)
                    manifests += into.add_manifests(distro, name, cache.release_package_xmls)
                except Exception as error:
                    failures.append(f"manifests of {name}: {error}")
            tell("reading rosdep rules", 0, 0)
            try:
                rules = into.write_rules(_fetch_rosdep_rules(index_url), now)
            except (OSError, ValueError) as error:
                rules = 0
                failures.append(f"rosdep rules: {error}")
            date = datetime.datetime.fromtimestamp(now, datetime.timezone.utc).date().isoformat()
            connection.execute("INSERT OR REPLACE INTO meta VALUES('date', ?)", (date,))
            connection.commit()
            connection.execute("VACUUM")
        return path.read_bytes(), Refreshed(tuple(syncs), releases, manifests, rules, tuple(failures))


def _is_supported(entry: dict[str, Any]) -> bool:
    return entry.get("distribution_status") != "end-of-life"


def _is_day(text: str) -> bool:
    try:
        datetime.date.fromisoformat(text[:10])
    except ValueError:
        return False
    return True


def _fetch_rosdep_rules(index_url: str) -> dict[tuple[str, str], str]:
    """Today's rules of rosdep's default files, the first file that has one winning."""
    import urllib.request

    base = index_url.format(ref="master").rpartition("/")[0]
    rules: dict[tuple[str, str], str] = {}
    for name in FILES:
        with urllib.request.urlopen(f"{base}/{name}", timeout=30) as answer:
            data = answer.read(_LARGEST + 1)
            if len(data) > _LARGEST:
                raise ValueError(f"{name} is larger than {format_size(_LARGEST)}")
            parsed = parse_rules(data)
        if parsed is None:
            raise ValueError(f"{name} is no YAML mapping")
        rules = {**parsed, **rules}
    return rules


class _Writer:
    """Adds rows where something differs from the newest state in the database."""

    def __init__(self, connection: sqlite3.Connection):
        self.connection = connection
        self._ids: dict[str, dict[str, int]] = {}

    def ensure_distro(self, name: str, entry: dict[str, Any]) -> int:
        """The id of a distro, which is added when it is new."""
        self.connection.execute(
            "INSERT INTO distro(name, ros, python, status) VALUES(?, ?, ?, ?)"
            " ON CONFLICT(name) DO UPDATE SET status = excluded.status",
            (
                name,
                2 if entry.get("distribution_type") == "ros2" else 1,
                int(entry.get("python_version") or 3),
                str(entry.get("distribution_status") or ""),
            ),
        )
        return self.connection.execute("SELECT id FROM distro WHERE name = ?", (name,)).fetchone()[0]

    def find_last_sync(self, distro: int) -> str:
        return self.connection.execute("SELECT max(day) FROM sync WHERE distro = ?", (distro,)).fetchone()[0] or ""

    def write_state(self, distro: int, file: Any, day: str) -> int:
        """Makes a distribution file (of the rosdistro library) the state as of a sync; gives the number of changes."""
        start = datetime.datetime.combine(datetime.date.fromisoformat(day), datetime.time(), datetime.timezone.utc)
        newest = self.connection.execute("SELECT max(ts) FROM release WHERE distro = ?", (distro,)).fetchone()[0] or 0
        ts = max(int(start.timestamp()), newest + 1)
        self.connection.execute("INSERT OR REPLACE INTO sync VALUES(?, ?, ?)", (distro, day, ts))
        platforms = ",".join(
            f"{system} {release}".lower()
            for system, releases in sorted(file.release_platforms.items(), key=lambda item: item[0] != "ubuntu")
            for release in releases
        )
        last = self.connection.execute(
            "SELECT names FROM platforms WHERE distro = ? ORDER BY ts DESC LIMIT 1", (distro,)
        ).fetchone()
        if platforms and (last is None or last[0] != platforms):
            self.connection.execute("INSERT OR REPLACE INTO platforms VALUES(?, ?, ?)", (distro, ts, platforms))
        old = {
            name: (version, names or "")
            for name, _, version, names in self.connection.execute(
                "SELECT n.name, max(r.ts), r.version, p.names FROM release r JOIN repository n ON n.id = r.repository"
                " LEFT JOIN packages p ON p.id = r.packages WHERE r.distro = ? GROUP BY r.repository",
                (distro,),
            )
        }
        new: dict[str, tuple[str, str]] = {}
        for name, repository in file.repositories.items():
            release = repository.release_repository
            if release is not None and release.version is not None:
                new[name] = (str(release.version), " ".join(sorted(release.package_names)))
        changed = 0
        for name in sorted(old.keys() | new.keys()):
            version, names = new.get(name, (None, ""))
            if old.get(name, (None, "")) == (version, names):
                continue
            changed += 1
            repository = self._add_id("repository", name)
            packages = self._add_id("packages", names) if version is not None else None
            self.connection.execute(
                "INSERT OR REPLACE INTO release VALUES(?, ?, ?, ?, ?)", (distro, repository, ts, version, packages)
            )
            for package in names.split():
                self.connection.execute(
                    "INSERT OR IGNORE INTO home VALUES(?, ?, ?)", (self._add_id("package", package), distro, repository)
                )
        return changed

    def add_manifests(self, distro: int, name: str, texts: dict[str, str]) -> int:
        """Adds the manifests of a rosdistro cache that the database lacks; gives their number."""
        added = 0
        for text in texts.values():
            declared = parse_manifest(name, text)
            if declared is None:
                continue
            package = self._add_id("package", declared.package)
            dependencies = self._add_id("dependencies", declared.entries)
            added += self.connection.execute(
                "INSERT OR IGNORE INTO manifest VALUES(?, ?, ?, ?, ?)",
                (distro, package, declared.version, dependencies, declared.build_type),
            ).rowcount
        return added

    def write_rules(self, rules: dict[tuple[str, str], str], ts: int) -> int:
        """Makes these the rosdep rules from `ts` on; gives the number of changes."""
        old = {
            (key, system): rule
            for key, system, rule, _ in self.connection.execute(
                "SELECT key, os, rule, max(ts) FROM rule GROUP BY key, os"
            )
        }
        changed = [
            (key, system, ts, rules.get((key, system)))
            for key, system in sorted(old.keys() | rules.keys())
            if old.get((key, system)) != rules.get((key, system))
        ]
        self.connection.executemany("INSERT OR REPLACE INTO rule VALUES(?, ?, ?, ?)", changed)
        return len(changed)

    def _add_id(self, table: str, text: str) -> int:
        column = {"packages": "names", "dependencies": "entries"}.get(table, "name")
        if table not in self._ids:
            self._ids[table] = {
                known: number for number, known in self.connection.execute(f"SELECT id, {column} FROM {table}")
            }
        ids = self._ids[table]
        if text not in ids:
            row = self.connection.execute(f"INSERT INTO {table}({column}) VALUES(?)", (text,))
            ids[text] = row.lastrowid or 0
        return ids[text]

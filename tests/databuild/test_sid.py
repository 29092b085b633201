"""Versions in Debian unstable by day, from changelogs."""

import pytest
from rosimpact.databuild.sid import PACKAGES, read_changelog

ENTRY = "{package} ({version}) {suites}; urgency=medium\n\n  * Changed.\n\n -- A. B. <a@example.org>  {day}\n"


def make_changelog(*entries):
    """A changelog of (version, suites, day), newest first."""
    return "\n".join(ENTRY.format(package="winch", version=v, suites=s, day=d) for v, s, d in entries)


@pytest.mark.parametrize(
    ("entries", "expected"),
    [
        ([("1:1.4.0+dfsg-2", "unstable", "Tue, 05 Mar 2024 23:30:00 +0100"),
          ("1:1.4.0+dfsg-1", "unstable", "Mon, 04 Mar 2024 08:00:00 +0000"),
          ("1:1.3.2-1", "unstable", "Sun, 01 Oct 2023 08:00:00 +0000")],
         {"2023-10-01": "1.3.2", "2024-03-04": "1.4.0"}),
        # What is only in experimental, or in a stable release, is not in unstable.
        ([("2.0-1", "experimental", "Tue, 05 Mar 2024 10:00:00 +0000"),
          ("1.0-1+deb12u1", "bookworm-security", "Mon, 04 Mar 2024 10:00:00 +0000"),
          ("1.0-1", "unstable", "Sun, 01 Oct 2023 10:00:00 +0000")],
         {"2023-10-01": "1.0"}),
        ([], {}),
    ],
)  # fmt: skip
def test_versions_of_a_changelog(entries, expected):
    assert read_changelog(make_changelog(*entries)) == expected


def test_each_library_has_its_package():
    assert PACKAGES["opencv"] == "libopencv-dev" and len(set(PACKAGES.values())) == len(PACKAGES)

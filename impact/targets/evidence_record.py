"""What a finding about a changed name rests on, as data; evidence.py finds it."""

from __future__ import annotations

from typing import NamedTuple


class OnTarget(NamedTuple):
    """A change as one target has it.

    version: of the package or library there, empty when not known. holds: whether the change is in force there. since:
    ISO day on which its distro got the change, be it before or after the target's own day; empty when it has not, or
    that is not known.
    """

    target: str
    version: str
    holds: bool
    since: str = ""


class Evidence(NamedTuple):
    """The change that a finding rests on.

    package: a ROS package or, where library is set, a platform library. change: removed, added, changed or deprecated.
    name: what is used; instead: the other spelling, where there is one that some versions take: the new one of a name
    that was removed, the old one of a name that was added. side: `c++`, `header`, `python`, `cmake` or as in
    surface_changes.Line; empty where no surface is to be asked.
    old, new: the declarations before and since, a line each, one for each overload; empty where none is recorded. last,
    first: the last version before the change and the first with it, as far as they are known; first may be a bound as
    in changes.Row. source: what says so, for rows that a person wrote. new_in: where `first` does not tell, distro to
    the first version with the change (empty: never there). header: an include path whose presence in a release of the
    package decides instead, where that is known. ahead: the finding is about what is to come on its targets. stored:
    the stored surfaces tell which versions have the change. other: the same about `instead`, where it is known.
    targets: see add_target_states().
    """

    package: str
    change: str
    name: str = ""
    instead: str = ""
    side: str = ""
    old: tuple[str, ...] = ()
    new: tuple[str, ...] = ()
    last: str = ""
    first: str = ""
    library: bool = False
    source: str = ""
    new_in: tuple[tuple[str, str], ...] = ()
    header: str = ""
    ahead: bool = False
    stored: bool = False
    other: Evidence | None = None
    targets: tuple[OnTarget, ...] = ()

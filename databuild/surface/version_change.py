"""What comparing two versions of a package gives, one difference after the other."""

import msgspec


class VersionChange(msgspec.Struct, frozen=True, gc=False):
    """One difference between two versions of a package.

    side: `c++`, `python`, `message` or `build` (CMake, headers, programs, plugins, launch files).
    kind: `removed`, `added`, `moved`, `deprecated`, `signature`, `default`, `value`, `type`, `base`, `access`,
    `deleted`, `pure`, `final`, `kind`, `wire` (both versions of a message do not talk to each other).
    what: of which sort the thing is (`class`, `method`, `header`, `field`, `target`, `executable` ...).
    name: as users write it. old, now: declarations. aspects: in what signatures differ.
    instead: what to use now, where that is known or can be guessed. moved_to: the package that has it now.
    where: the header or module that has or had it.
    breaks: code that used the old one may no longer build or run. sure: from 0 to 1.
    """

    package: str
    side: str
    kind: str
    what: str
    name: str
    old: str = ""
    now: str = ""
    aspects: tuple[str, ...] = ()
    instead: str = ""
    moved_to: str = ""
    where: str = ""
    breaks: bool = True
    sure: float = 1.0


OPEN = 0.5
"""How sure a change is that hangs on something outside of the repository, or that is not understood."""

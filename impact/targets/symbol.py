"""What is asked of a target, and its answer: a symbol, and how the target stands to it. See availability.py."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, NamedTuple

if TYPE_CHECKING:
    from ..facts.python.uses import PythonUse
    from .distro.distro import DistroTarget
    from .evidence_record import Evidence

State = Literal["present", "removed", "not yet", "changed", "deprecated", "upcoming", "unknown"]


class CppUseForm(NamedTuple):
    """How a C++ name is used, as in model.package.CppApiUse."""

    how: str
    arguments: int = -1
    given: tuple[str, ...] = ()
    templated: int = -1


class Symbol(NamedTuple):
    """Something that may be there or not. kind: `package`, `header`, `c++`, `python`, `command`, `target`, `variable`,
    `component` (of the CMake package of a library, which packages names), `executable`, `plugin`, `launch file`,
    `launch argument` (name: `path argument`), `parameter`, `interface` (name: `msg/Name`), `field` (name:
    `msg/Name.field`, or `srv/Name.request.field` of one section) or, of reviewed rows, `use` (name: its label).
    packages: that may have it; of platform libraries none. use: how a name of C++ or Python is used, where that is
    asked about too."""

    kind: str
    name: str
    packages: tuple[str, ...] = ()
    use: CppUseForm | PythonUse | None = None


class Horizon(NamedTuple):
    """What a target is going to be. name: as a message has it. platform: the newest distro, of which only the platform
    counts (libraries and Python), packages that it lacks, and what is deprecated here already. What its packages change
    otherwise is shown by `rosimpact upgrade`, since nobody gets them without moving on. far: more than two long-term
    distros ahead, or ahead of a distro that is no longer maintained and gets no update, which is worth no warning."""

    target: DistroTarget
    name: str
    platform: bool = False
    far: bool = False


class Availability(NamedTuple):
    """How a target stands to a symbol, or to one use of it.

    state: `present`; `removed`, earlier versions of this ROS generation had it; `not yet`, only later ones have it;
    `changed`, there under the same name, and something else; `deprecated`, there, and it warns; `upcoming`, there, and
    removed, or changed, on the horizon; `unknown`. package, version: of what decides, as the target (or, of what is
    upcoming, the horizon) has it. since: the version that removed, added, changed or deprecated it, as far as it is
    known. replacement: what stands for it, replacement_since: the version that has that first; moved_to: the package
    that has it now. alike: what is there under a similar name. library: package is a platform library. sure: nothing
    about it is guessed. horizon: where it is removed, of what is upcoming.
    form: how it is changed, for what it is used as: `arguments`, `types`, `template` (nothing tells a template
    argument), `override`, `pure`, `default` or `call`; of what is not there, `never` where no version has it; by a
    reviewed row `renamed`, where the replacement is the same thing, or `meaning`, which changed. earlier: a version
    before the target's took the use; else a later one does. detail: what the package itself says of it, why a call is
    refused, or what to do. gone_in: of what is deprecated, the version that removes it.
    """

    symbol: Symbol
    state: State
    package: str = ""
    version: str = ""
    since: str = ""
    replacement: str = ""
    moved_to: str = ""
    alike: str = ""
    library: bool = False
    sure: bool = True
    evidence: Evidence | None = None
    horizon: Horizon | None = None
    replacement_since: str = ""
    form: str = ""
    earlier: bool = True
    detail: str = ""
    gone_in: str = ""

    @property
    def is_missing(self) -> bool:
        """Whether a use of it fails on the target."""
        return self.state in ("removed", "not yet")

    def apply_horizon(self, horizon: Horizon) -> Availability:
        """What this horizon's answer is for the target that has it still."""
        evidence = self.evidence._replace(ahead=True) if self.evidence is not None else None
        return self._replace(state="upcoming", horizon=horizon, evidence=evidence)

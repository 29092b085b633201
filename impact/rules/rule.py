"""What a rule is, what it yields, and how rules are found.

A rule is one check, in one module. Its name is the module's, with dashes, and its documentation is the module's
docstring, to which the section *Severity* is added where it is the same for all findings. It is a generator, registered
by `@rule`:

    @rule(
        scope="change",
        texts=Text("the field `{subject}` of `{definition}` was removed", help="keep the field for one release"),
    )
    def removed_field(workspace: Workspace, base: Workspace):
        ...
        yield Diagnostic(at, field.name, package.name, data={"definition": name})

Its scope says what it is called with, and how often:

    scope          called with                    when
    package        view, package                  for each target, once with every package to report on
    target         view                           once for each target; it reports on the packages that the view
                                                  iterates over, which may be a part of the workspace
    workspace      workspace                      once: no target has a say in it
    change         workspace, base                once, and only when there is a base to compare with
    flow           workspace                      once; it rests on the message flow, and on nothing that is not
                                                  remembered with the flow
    flow_change    workspace, base                as `flow`, and only when there is a base
    install_space  view, installed, libraries     once for each machine that built files are checked on, and only
                                                  when there is an install space
    targets        views                          once, with all targets together; it yields (view, diagnostic)

A rule of the scope `package` may yield Upcoming as well, which is rated package by package. What rules are written with
is imported from vocabulary.py.

It yields diagnostics: data, not text. What differs between targets (a version, a date) is data of one diagnostic for
each target; they become one finding, and its text is rendered from the templates of the rule when all are known.
"""

from __future__ import annotations  # docs/queries.md shows types by the names they have here

import importlib
import pkgutil
import re
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import Any, Literal, NamedTuple

import msgspec

from ..targets.evidence_record import Evidence
from ..targets.symbol import Horizon
from .fix_actions import FixAction
from .severity import SEVERITIES, Doubt, Together, limit_severity
from .text import Text, Value

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib  # pyright: ignore[reportMissingImports]

IMPRECISE = Path(__file__).with_name("imprecise.toml")

Scope = Literal["package", "target", "workspace", "change", "flow", "flow_change", "install_space", "targets"]


class Diagnostic(NamedTuple):
    """What a rule yields: one fact on one target, as data. findings.py merges those of several targets into a Finding.

    at: anything with path, line, column. subject: one name, the thing at fault, as a person would type it. package:
    the package of the place. data: the values that the rule's texts name, beside subject and package; every rule calls
    a version `version`, the first version with a change `since`, and what to write instead `replacement`. kind: which
    of the rule's texts describes it, where there are several. doubts: what speaks against the rule's usual severity, as
    severity() takes it. together: with which others it is worth one warning.
    fix: actions that repair it, see fix_actions.py; kept only when every target asked for yields the same. evidence:
    the change that it rests on, without targets; check.py adds how each target stands to it. also: further packages
    that it is about.
    """

    at: Any
    subject: str
    package: str = ""
    data: Mapping[str, Value] = {}
    kind: str = ""
    doubts: tuple[Doubt | bool | None, ...] = ()
    fix: tuple[FixAction, ...] = ()
    evidence: Evidence | None = None
    together: tuple[Together, ...] = ()
    also: tuple[str, ...] = ()

    @property
    def place(self) -> tuple[str, int, int]:
        """Path, line and column of where it stands."""
        return getattr(self.at, "path", ""), getattr(self.at, "line", 0), getattr(self.at, "column", 0)

    @property
    def fact(self) -> object:
        """What is said of a target: two diagnostics with equal facts are one."""
        return self.kind, self.data

    @property
    def ahead(self) -> bool:
        """Whether it holds on what the target is going to be, and not yet on it."""
        coming = self.evidence is not None and self.evidence.ahead
        return coming or not {Doubt.UPCOMING, Doubt.FAR}.isdisjoint(self.doubts)

    @property
    def values(self) -> dict[str, Value]:
        """The values that a text can name."""
        return {"subject": self.subject, "package": self.package, **self.data}


class Upcoming(NamedTuple):
    """A diagnostic of something that is still there. changed: the package or library that goes without it. order: what
    breaks first comes first. home: the repository of a package that goes itself, whose packages go together.

    Nothing breaks on the target yet. What goes with the next sync, a later update or on the newest distro is worth one
    warning for each package or library that changes, in the whole workspace: its first place by what breaks first. The
    rest are notes, and so is what only a distro further ahead lacks.
    """

    diagnostic: Diagnostic
    changed: str
    horizon: Horizon
    order: tuple = ()
    home: str = ""


def rate_upcoming(found: Iterable[Diagnostic | Upcoming]) -> Iterator[Diagnostic]:
    """The diagnostics of one package, those of what is upcoming last, what breaks first before the others."""
    every: list[Upcoming] = []
    for one in found:
        if isinstance(one, Upcoming):
            every.append(one)
        else:
            yield one
    for diagnostic, changed, horizon, _, home in sorted(every, key=lambda one: one.order):
        evidence = diagnostic.evidence
        diagnostic = diagnostic._replace(evidence=evidence and evidence._replace(ahead=True))
        late = Doubt.FAR if horizon.far else Doubt.UPCOMING
        causes = (changed, f"the repository {home}") if home else (changed,)
        together = tuple(Together(f"{cause} of {horizon.name}", everywhere=True) for cause in causes)
        yield diagnostic._replace(doubts=(*diagnostic.doubts, late), together=together)


class Finding(NamedTuple):
    """A finding as reported, see docs/findings.md. repeated: it is a note only since another one is the warning.
    ahead: it holds on what the targets are going to be, not yet on them. also: further packages that it is about."""

    rule: str
    severity: str
    package: str
    path: str
    line: int
    column: int
    subject: str
    targets: tuple[str, ...]
    message: str
    help: str = ""
    new: bool = True
    fingerprint: str = ""
    fix: tuple[FixAction, ...] = ()
    evidence: Evidence | None = None
    repeated: bool = False
    ahead: bool = False
    also: tuple[str, ...] = ()

    @property
    def packages(self) -> tuple[str, ...]:
        """All packages that it is about; an empty name where it is about none."""
        return self.package, *self.also


class Rule(NamedTuple):
    """A registered rule.

    family: its folder. severity: the usual one. scope: see the module. preview: its precision is not measured yet, or
    too low. doubts: what speaks against an error in all of its diagnostics. group: the rule that it was a part of
    before, empty otherwise. texts: templates by kind of diagnostic. yields_to: rules that say the same with more
    weight. on_request: it runs only where it, its group or its family is selected by name.
    """

    name: str
    family: str
    severity: str
    run: Callable[..., Iterator]
    documentation: str = ""
    scope: Scope = "target"
    preview: bool = False
    doubts: tuple[Doubt, ...] = ()
    group: str = ""
    texts: Mapping[str, Text] = {}
    yields_to: tuple[str, ...] = ()
    on_request: bool = False

    @property
    def groups(self) -> tuple[str, ...]:
        """The rules that it was a part of, the last one first: a rule that was split off may have been split again."""
        former = _RULES.get(self.group)
        return (self.group, *(former.groups if former else ())) if self.group else ()

    @property
    def names(self) -> tuple[str, ...]:
        """The names that mean this rule in settings and comments, the most specific first: its own, those of its
        groups, that of its family."""
        return self.name, *self.groups, self.family

    @property
    def summary(self) -> str:
        """What it reports, in the first sentence of its documentation."""
        return self.documentation.strip().partition("\n")[0].partition(": ")[2]

    @property
    def has_base(self) -> bool:
        """Whether it compares with a base."""
        return self.scope in ("change", "flow_change")

    @property
    def reads_flow(self) -> bool:
        """Whether it rests on the message flow."""
        return self.scope in ("flow", "flow_change")

    def compute_severity(self, diagnostic: Diagnostic) -> str:
        """How severe a diagnostic is: the usual severity, lowered by its doubts."""
        return min(self.severity, limit_severity(*diagnostic.doubts), key=SEVERITIES.index)

    def verify(self, diagnostic: Diagnostic) -> None:
        """Raises ValueError when the rule has no text for a diagnostic, or the text cannot be rendered from its data: a
        value is missing, or has another type than the text expects."""
        text = self.texts.get(diagnostic.kind)
        if text is None:
            raise ValueError(f"{self.name} has no text for diagnostics of the kind `{diagnostic.kind}`")
        lacking = text.fields - diagnostic.values.keys()
        if lacking:
            raise ValueError(f"{self.name}: the data of `{diagnostic.subject}` lacks {', '.join(sorted(lacking))}")
        try:
            limit_severity(*diagnostic.doubts)
            text.render([("", diagnostic.values)])
        except (ValueError, TypeError) as error:
            raise ValueError(f"{self.name}: the data of `{diagnostic.subject}`: {error}") from None


_RULES: dict[str, Rule] = {}


def rule(
    *,
    scope: Scope = "package",
    severity: Literal["note", "warning", "error"] = "error",
    doubts: tuple[Doubt, ...] = (),
    texts: Text | Mapping[str, Text],
    group: str = "",
    preview: bool = False,
    yields_to: tuple[str, ...] = (),
    on_request: bool = False,
):
    """Registers the decorated generator as a rule; the module's docstring tells how it is called.

    scope: see the module; `package` is registered as `target`, with the loop over the packages. severity: the highest
    that a finding of the rule can have, for what stops no build and no run however sure it is. doubts: what speaks
    against that in every finding. texts: one template, or several by the kind of diagnostic. group: the name of the
    rule that this check was a part of, so that settings, comments, baselines and fingerprints which name that one go on
    to hold for this one. preview: it runs only when asked for, since its precision is not measured
    yet or, by benchmarks/verdicts.py, surely below 9 in 10. yields_to:
    rules of the scopes `package` and `target` that tell the same cause with more weight: where one of them reports a
    place on a target, this rule's diagnostics of that place are left out there. on_request: it takes much longer than
    others, and runs only where it, its group or its family is selected by name; not with `all`.
    """

    def register(function):
        parts = function.__module__.split(".")
        module = importlib.import_module(function.__module__)
        name = parts[-1].replace("_", "-")
        usual = min(severity, limit_severity(*doubts), key=SEVERITIES.index)
        run, called = (_run_on_packages(function), "target") if scope == "package" else (function, scope)
        documentation = _tell_severity(module.__doc__ or "", usual)
        by_kind = {"": texts} if isinstance(texts, Text) else texts
        held_back = preview or name in read_imprecise()
        _RULES[name] = Rule(
            name, parts[-2], usual, run, documentation, called, held_back, doubts, group, by_kind, yields_to, on_request
        )
        return function

    return register


def _run_on_packages(function: Callable[..., Iterable[Diagnostic | Upcoming]]) -> Callable[..., Iterator[Diagnostic]]:
    def run(view: Iterable) -> Iterator[Diagnostic]:
        for package in view:
            yield from rate_upcoming(function(view, package))

    return run


def _tell_severity(documentation: str, usual: str) -> str:
    """The documentation of a rule; with its severity, where it does not say on what that depends."""
    if not documentation or "\nSeverity\n" in documentation:
        return documentation
    place = _AFTER_SEVERITY.search(documentation)
    at = place.start() if place is not None else len(documentation.rstrip())
    return f"{documentation[:at]}\n\nSeverity\n    {usual}.{documentation[at:]}"


_AFTER_SEVERITY = re.compile(r"\n\n(?:Example|Not reported)\n")


@cache
def read_imprecise() -> dict[str, tuple[int, int]]:
    """Rules that are previews since readers found fewer than 9 in 10 of their findings true: how many of how many, from
    what `benchmarks/verdicts.py precision` wrote."""
    return msgspec.convert(tomllib.loads(IMPRECISE.read_text(encoding="utf-8")), dict[str, tuple[int, int]])


def load_rules() -> dict[str, Rule]:
    """Every rule by name, importing the families on first use."""
    for _ in import_rules():
        pass
    return dict(sorted(_RULES.items()))


def group_rules(rules: Mapping[str, Rule]) -> dict[str, list[Rule]]:
    """The rules that every group stands for, by the group's name. A rule of that very name comes first: it is what
    is left of the rule that the others were a part of."""
    found: dict[str, list[Rule]] = {}
    for rule in sorted(rules.values(), key=lambda rule: (rule.name != rule.group, rule.name)):
        for group in rule.groups:
            found.setdefault(group, []).append(rule)
    for name, members in found.items():
        if name in rules and rules[name] not in members:
            members.insert(0, rules[name])
    return dict(sorted(found.items()))


def import_rules() -> Iterator[None]:
    """Imports the modules of all families, one in each step."""
    for name in _list_modules():
        if name not in sys.modules:
            importlib.import_module(name)
        yield


@cache
def _list_modules() -> list[str]:
    package = importlib.import_module(__name__.rpartition(".")[0])
    found = []
    for family in pkgutil.iter_modules(package.__path__, package.__name__ + "."):
        if family.ispkg:
            folder = importlib.import_module(family.name)
            modules = pkgutil.iter_modules(folder.__path__, folder.__name__ + ".")
            found += [family.name, *(module.name for module in modules)]
    return found

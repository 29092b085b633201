"""Diagnostics made into findings: merged over targets, fingerprinted, selected, suppressed, compared with a base."""

import re
from collections import Counter, defaultdict
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from functools import lru_cache
from hashlib import blake2b
from typing import NamedTuple

from ...edges.console import UserError, format_json
from ...edges.documents import load_json
from ..config import PathSetting
from ..facts.place import Allow
from ..rules.fix_actions import FixAction
from ..rules.rule import Diagnostic, Finding, Rule
from ..rules.severity import SEVERITIES, Doubt
from ..rules.text import Value, append_targets

_MOST_OF_ONE = 1_000_000
EVERYTHING = ("all", "*")

_RANK = {name: rank for rank, name in enumerate(SEVERITIES)}


def rank(severity: str) -> int:
    """A severity as a number, the graver the greater; 0 for one that is not known."""
    return _RANK.get(severity, 0)


class Suppression(NamedTuple):
    """What allow comments did: findings left, findings silenced, and (path, line, rule) of comments without effect."""

    kept: list[Finding]
    suppressed: list[Finding]
    unused: list[tuple[str, int, str]]


class SettingsError(UserError, ValueError):
    """A setting that cannot be obeyed; the text names it and what to write instead."""


def drop_outweighed(
    yielded: Sequence[tuple[str, Diagnostic]], rules: Mapping[str, Rule]
) -> list[tuple[str, Diagnostic]]:
    """What rules yield on one target, in order, without what another rule tells of the same place with more weight, see
    `yields_to` of rule(), and without what a rule yields twice."""
    places = {(name, *diagnostic.place) for name, diagnostic in yielded}
    seen: set[tuple] = set()
    result = []
    for name, diagnostic in yielded:
        place = diagnostic.place
        known = name, place[:2], diagnostic.subject, repr(diagnostic.fact), diagnostic.doubts
        if known in seen or any((other, *place) in places for other in rules[name].yields_to):
            continue
        seen.add(known)
        result.append((name, diagnostic))
    return result


def lower_repeats(yielded: Sequence[tuple[str, Diagnostic]], rules: Mapping[str, Rule]) -> list[tuple[str, Diagnostic]]:
    """What rules yield on one target, in order, with notes for the warnings whose cause another one tells; that one is
    about their packages too, where its rule is the same."""
    shared = [_list_shared(rules[name], diagnostic) for name, diagnostic in yielded]
    counts = Counter(key for keys in shared for key in keys)
    reported: dict[tuple[str, str, str], int] = {}
    also: dict[int, dict[str, None]] = defaultdict(dict)
    result = []
    for place, ((name, diagnostic), keys) in enumerate(zip(yielded, shared, strict=True)):
        if told := [reported[key] for key in keys if key in reported]:
            diagnostic = diagnostic._replace(doubts=(*diagnostic.doubts, Doubt.REPEATED))
            if yielded[told[0]][0] == name and yielded[told[0]][1].package != diagnostic.package:
                also[told[0]][diagnostic.package] = None
        for key, few in keys.items():
            if counts[key] > few:
                reported.setdefault(key, place)
        result.append((name, diagnostic))
    for place, packages in also.items():
        name, diagnostic = result[place]
        result[place] = name, diagnostic._replace(also=(*diagnostic.also, *packages))
    return result


def _list_shared(rule: Rule, diagnostic: Diagnostic) -> dict[tuple[str, str, str], int]:
    """The causes that a warning shares with others, as it counts them, each with how many are worth one of their
    own."""
    if not diagnostic.together or rule.compute_severity(diagnostic) != "warning":
        return {}
    return {
        ("", "", each.cause) if each.everywhere else (rule.name, diagnostic.package, each.cause): each.few
        for each in diagnostic.together
    }


def merge_diagnostics(
    diagnostics: Iterable[tuple[str, str, Diagnostic]],
    *,
    targets: Sequence[str],
    rules: Mapping[str, Rule],
    line_text: Callable[[str, int], str],
    holds: Callable[[tuple[FixAction, ...], str], bool] = lambda fix, target: False,
) -> list[Finding]:
    """One fact about several targets becomes one finding.

    diagnostics: (rule name, target name, diagnostic); an empty target name stands for every target. targets: those
    asked for, in order. rules: for severities and texts. line_text: the text of a line, empty when it cannot be read.

    Diagnostics of the same rule, path, line, subject and severity are one finding; two different facts about one target
    stay apart, and so does what breaks on a target from what is still to come on another. The fix is kept when every
    target asked for yields the same, or where a target yields no such diagnostic, when `holds(fix, target)` says that
    it is right there as well. Sorted by path, line, column, rule; fingerprinted.
    """
    order = {name: index for index, name in enumerate(targets)}
    groups: dict[tuple, list[dict[str, Diagnostic]]] = {}
    for rule_name, target, diagnostic in diagnostics:
        severity = rules[rule_name].compute_severity(diagnostic)
        key = (rule_name, severity, *diagnostic.place[:2], diagnostic.subject, diagnostic.ahead)
        names = (target,) if target else tuple(targets) or ("",)
        _add_to_group(groups.setdefault(key, []), names, diagnostic)
    findings = [
        _make_finding(rules[name], severity, path, line, by_target, order, holds)
        for (name, severity, path, line, _, _), facts in groups.items()
        for by_target in facts
    ]
    grouped = {rule.name: rule.groups[-1] for rule in rules.values() if rule.groups}
    return add_fingerprints(sort_findings(findings), line_text, grouped)


def sort_findings(findings: Iterable[Finding]) -> list[Finding]:
    """Findings by path, line, column, rule and subject, the graver first: the order of every report."""
    return sorted(findings, key=_sort_key)


def _add_to_group(facts: list[dict[str, Diagnostic]], names: tuple[str, ...], diagnostic: Diagnostic) -> None:
    """Puts a diagnostic into the first fact of its group that says nothing else about these targets."""
    for by_target in facts:
        if all(name not in by_target or by_target[name].fact == diagnostic.fact for name in names):
            for name in names:
                by_target.setdefault(name, diagnostic)
            return
    facts.append(dict.fromkeys(names, diagnostic))


def _make_finding(
    rule: Rule,
    severity: str,
    path: str,
    line: int,
    by_target: dict[str, Diagnostic],
    order: dict[str, int],
    holds: Callable[[tuple[FixAction, ...], str], bool],
) -> Finding:
    targets = sorted(by_target, key=lambda target: order.get(target, len(order)))
    diagnostics = [by_target[target] for target in targets]
    first = diagnostics[0]
    right = bool(first.fix) and all(
        by_target[target].fix == first.fix if target in by_target else holds(first.fix, target)
        for target in order or by_target
    )
    message, help = _render(rule, list(zip(targets, diagnostics, strict=True)))
    return Finding(
        rule=rule.name,
        severity=severity,
        package=first.package,
        path=path,
        line=line,
        column=first.place[2],
        subject=first.subject,
        targets=tuple(target for target in targets if target),
        message=message,
        help=help,
        fix=first.fix if right else (),
        evidence=next((each.evidence for each in diagnostics if each.evidence is not None), None),
        repeated=all(Doubt.REPEATED in each.doubts for each in diagnostics),
        ahead=first.ahead,
        also=tuple(dict.fromkeys(name for each in diagnostics for name in each.also)),
    )


def _render(rule: Rule, by_target: Sequence[tuple[str, Diagnostic]]) -> tuple[str, str]:
    """Message and help of a finding. Diagnostics of one kind are rendered from their data together."""
    kinds: dict[str, list[tuple[str, Mapping[str, Value]]]] = {}
    for target, diagnostic in by_target:
        kinds.setdefault(diagnostic.kind, []).append((target, diagnostic.values))
    messages: dict[str, list[str]] = {}
    helps: dict[str, list[str]] = {}
    for kind, data in kinds.items():
        for texts, text in zip((messages, helps), rule.texts[kind].render(data), strict=True):
            texts.setdefault(text, []).extend(target for target, _ in data)
    return _join(messages), _join(helps)


def _join(texts: Mapping[str, list[str]]) -> str:
    """One text of those of several kinds, each with its targets where they differ."""
    rendered = {text: names for text, names in texts.items() if text}
    if len(rendered) <= 1:
        return next(iter(rendered), "")
    return "; ".join(append_targets(text, names) for text, names in rendered.items())


def _sort_key(finding: Finding) -> tuple:
    return (finding.path, finding.line, finding.column, finding.rule, finding.subject, -rank(finding.severity),
            finding.message)  # fmt: skip


_LONGEST_LINE = 10_000


def add_fingerprints(
    findings: Iterable[Finding], line_text: Callable[[str, int], str], groups: Mapping[str, str] | None = None
) -> list[Finding]:
    """Findings with a fingerprint that stays the same when lines above them come and go.

    It is a hash of rule, path, package, subject, the line's text with white space levelled, and how many findings
    alike stand before it. Findings are expected in file order. groups: the first group by the rule, of rules that were
    a part of another one; the group's name counts for theirs, so that baselines from before still know their findings.
    """
    groups = groups or {}
    seen: Counter[str] = Counter()
    result = []
    place, text = ("", 0), ""
    for finding in findings:
        if (finding.path, finding.line) != place:
            place = finding.path, finding.line
            text = " ".join(line_text(*place).split()) if finding.line else ""
            if len(text) > _LONGEST_LINE:  # it may have as many findings
                text = _hash_text(text)
        rule = groups.get(finding.rule, finding.rule)
        content = "\0".join((rule, finding.path, finding.package, finding.subject, text))
        digest = _hash_text(f"{content}\0{seen[content]}")
        seen[content] += 1
        result.append(finding._replace(fingerprint=digest))
    return result


def _hash_text(text: str) -> str:
    return blake2b(text.encode("utf-8", "surrogatepass"), digest_size=12).hexdigest()


def mark_new(findings: Iterable[Finding], base: Iterable[Finding]) -> list[Finding]:
    """Findings with `new` False where the base had the same fact, at least as severe and on the same targets.

    Matched one to one in three passes: same fingerprint; same rule, path, package and subject (its line was edited);
    same rule, package and subject (its file was moved).
    """
    result = [finding._replace(new=True) for finding in findings]
    old = list(base)
    free = set(range(len(old)))
    keys: tuple[Callable[[Finding], object], ...] = (
        lambda finding: finding.fingerprint,
        lambda finding: (finding.rule, finding.path, finding.package, finding.subject),
        lambda finding: (finding.rule, finding.package, finding.subject),
    )
    for key in keys:
        pool: dict[object, list[int]] = defaultdict(list)
        for index in sorted(free):
            pool[key(old[index])].append(index)
        for index, finding in enumerate(result):
            candidates = pool.get(key(finding)) if finding.new else None
            match = next((other for other in candidates or () if _covers(old[other], finding)), None)
            if candidates and match is not None:
                candidates.remove(match)
                free.discard(match)
                result[index] = finding._replace(new=False)
    return result


def _covers(old: Finding, finding: Finding) -> bool:
    worth = "warning" if old.repeated else old.severity
    return rank(worth) >= rank(finding.severity) and set(finding.targets) <= set(old.targets)


def choose_rules(
    rules: Mapping[str, Rule], *, select: Sequence[str] = (), ignore: Sequence[str] = (), preview: bool = False
) -> dict[str, Rule]:
    """The rules to run. select and ignore hold names of rules, groups or families, or `all`; the more specific wins.

    Where both mean a rule as closely, it is ignored. A preview rule runs when previews are asked for or when it, or its
    group, is selected by name; one that takes long when it, its group or its family is.
    Raises SettingsError for a name that is no rule, group or family.
    """
    known = _list_known_names(rules.values())
    for name in (*select, *ignore):
        if name not in known and name not in EVERYTHING:
            raise SettingsError(_describe_unknown_rule(name, rules))
    return {
        name: rule
        for name, rule in rules.items()
        if _rank_specificity(select or EVERYTHING, rule.names) > _rank_specificity(ignore, rule.names)
        and (
            not {*rule.names}.isdisjoint(select)
            if rule.on_request
            else preview or not rule.preview or not {*rule.names[:-1]}.isdisjoint(select)
        )
    }


def _list_known_names(rules: Iterable[Rule]) -> list[str]:
    """What a setting can name beside `all`: rules, groups and, last, families."""
    rules = list(rules)
    names = dict.fromkeys(name for rule in rules for name in rule.names[:-1])
    return [*names, *sorted({rule.family for rule in rules})]


def _rank_specificity(settings: Collection[str], names: Sequence[str]) -> int:
    """How closely the names in a setting mean a rule: the more, the more specific the name; 2 by family, 1 with
    everything, 0 not at all. names: those of the rule."""
    for place, name in enumerate(names):
        if name in settings:
            return len(names) + 1 - place
    return int(any(name in settings for name in EVERYTHING))


def _describe_unknown_rule(name: str, rules: Mapping[str, Rule]) -> str:
    from difflib import get_close_matches

    close = get_close_matches(name, _list_known_names(rules.values()), n=1)
    hint = f"did you mean `{close[0]}`? " if close else ""
    families = sorted({rule.family for rule in rules.values()})
    return f"no rule or family is called `{name}`; {hint}families are {', '.join(families)}"


def verify_settings(settings: Sequence[PathSetting], rules: Mapping[str, Rule]) -> Sequence[PathSetting]:
    """The settings, when every name in them is a rule, a group, a family or `all` and every severity is one.

    Raises SettingsError otherwise.
    """
    known = _list_known_names(rules.values())
    for entry in settings:
        where = f'[paths."{entry.pattern}"]'
        for name in (*entry.select, *entry.ignore, *entry.severity):
            if name not in known and name not in EVERYTHING:
                raise SettingsError(f"{where}: {_describe_unknown_rule(name, rules)}")
        for name, value in entry.severity.items():
            if value not in (*SEVERITIES, "off"):
                raise SettingsError(f"{where}: severity of `{name}` is `{value}`; write note, warning, error or off")
    return settings


def apply_settings(
    findings: Iterable[Finding], settings: Sequence[PathSetting], rules: Mapping[str, Rule]
) -> list[Finding]:
    """Findings under the per-path settings that match them; of several that match, later ones go over earlier ones.

    A severity of `off` silences. rules: by name, for their groups and families.
    """
    if not settings:
        return list(findings)
    result = []
    for finding in findings:
        names = _list_rule_names(finding, rules)
        severity: str | None = finding.severity
        for entry in settings:
            if matches_glob(entry.pattern, finding.path):
                severity = _apply_setting(entry, names, severity)
        if severity is not None:
            result.append(finding._replace(severity=severity))
    return result


def _list_rule_names(finding: Finding, rules: Mapping[str, Rule]) -> tuple[str, ...]:
    """The names that mean a finding's rule in settings and comments, the most specific first."""
    return rules[finding.rule].names if finding.rule in rules else (finding.rule,)


def _apply_setting(entry: PathSetting, names: Sequence[str], severity: str | None) -> str | None:
    """The severity a setting gives, None when it silences. names: those of the rule."""
    if _rank_specificity(entry.select or EVERYTHING, names) <= _rank_specificity(entry.ignore, names):
        return None
    for name in (*names, *EVERYTHING):
        if name in entry.severity:
            return None if entry.severity[name] == "off" else entry.severity[name]
    return severity


def matches_glob(glob: str, path: str) -> bool:
    """Whether a path relative to the root is meant by a glob: `*` and `?` stay within a folder, `**` spans folders,
    and a folder's name means everything below it.

    All ways through the glob are followed at once, as bits of a number that say where in the path one can be, so that
    no glob makes it slow.
    """
    at_sign, slashes = _index_characters(path)
    everywhere = (2 << len(path)) - 1
    inner = everywhere >> 1 & ~slashes
    reached = 1
    for piece in _split_glob(glob):
        if not reached:
            return False
        behind = -(reached & -reached) & everywhere  # the first place and all after it
        if piece == "*":
            # The sum carries each place to the end of its folder's name.
            reached |= ((reached & inner) + inner) ^ inner
        elif piece == "**":
            reached = behind
        elif piece == "/**":
            reached = (reached & slashes) << 1
            reached = -(reached & -reached) & everywhere
        elif piece == "**/":
            reached |= (behind & slashes) << 1
        elif piece == "?":
            reached = (reached & inner) << 1
        elif len(piece) > 2:
            of_class = _compile_glob_class(piece[1:-1])
            signs = of_class.sub("", path) if of_class is not None else path
            others = sum(mask for sign, mask in at_sign.items() if sign in signs)
            reached = (reached & (everywhere >> 1) & ~others) << 1
        else:
            reached = (reached & at_sign.get(piece, 0)) << 1
    return bool(reached >> len(path) & 1 or reached & slashes)


@lru_cache(maxsize=512)
def _split_glob(glob: str) -> tuple[str, ...]:
    """A glob in pieces: `**/`, `/**`, `**`, `*`, `?`, classes such as `[ab]`, and single characters."""
    found: list[str] = []
    for piece in re.findall(
        r"\*\*/|/?\*\*$|\*\*|\*|\?|\[!?[^\]/]+\]|.", glob.removeprefix("./").rstrip("/"), re.DOTALL
    ):
        is_class = len(piece) > 2 and piece[0] == "["
        found += piece if is_class and _compile_glob_class(piece[1:-1]) is None else [piece]
    return tuple(found)


@lru_cache(maxsize=64)
def _index_characters(path: str) -> tuple[dict[str, int], int]:
    """Where each character stands in a path, as bits, and where the slashes do."""
    found: dict[str, int] = {}
    for place, sign in enumerate(path):
        found[sign] = found.get(sign, 0) | 1 << place
    return found, found.get("/", 0)


@lru_cache(maxsize=512)
def _compile_glob_class(content: str) -> re.Pattern[str] | None:
    """`[ab]`, `[a-z]` or `[!a]` of a glob, for one character; None for what is no class (`[z-a]`)."""
    negated = content.startswith("!")
    signs = re.sub(r"[\\\[\]^&~|]", r"\\\g<0>", content[negated:])
    signs = signs.replace("--", r"\--")
    try:
        return re.compile(f"[^/{signs}]" if negated else f"[{signs}]")
    except re.error:
        return None


def suppress(
    findings: Iterable[Finding],
    allows: Mapping[str, Sequence[Allow]],
    *,
    rules: Mapping[str, Rule],
    ran: Collection[str],
) -> Suppression:
    """Findings without those that an `allow` comment of their file silences.

    allows: comments by path; an Allow at line 0 holds for the whole file. rules: by name, since a comment may name a
    group or a family. ran: rules that ran, since a comment for another rule cannot be called unused.
    """
    kept: list[Finding] = []
    silent: list[Finding] = []
    used: set[tuple[str, int, str]] = set()
    reach: dict[str, dict[int, dict[str, tuple[int, int]]]] = {}
    for finding in findings:
        comments = allows.get(finding.path, ())
        hit = None
        if comments:
            lines = reach.get(finding.path)
            if lines is None:
                lines = reach[finding.path] = _reach(comments)
            names = (*_list_rule_names(finding, rules), *EVERYTHING)
            for line in (finding.line, 0):
                there = lines.get(line)
                found = [(*there[name], name) for name in names if name in there] if there else []
                if found:
                    _, at, name = min(found, key=lambda one: one[0])  # of one comment the first name counts
                    hit = finding.path, at, name
                    break
        if hit is None:
            kept.append(finding)
        else:
            used.add(hit)
            silent.append(finding)
    live = {name for rule in ran for name in (rules[rule].names if rule in rules else (rule,))} | {*EVERYTHING}
    known = {name for rule in rules.values() for name in rule.names[:-1]}
    unused = [
        (path, allow.line, name)
        for path, comments in allows.items()
        for allow in comments
        for name in allow.rules
        if (path, allow.line, name) not in used and (name in live or name not in known)
    ]
    return Suppression(kept, silent, sorted(unused))


def _reach(comments: Sequence[Allow]) -> dict[int, dict[str, tuple[int, int]]]:
    """By the lines that comments hold for, the names that they allow: which comment is the first, and its line. A block
    of comment lines reaches the line behind the block."""
    after: dict[int, int] = {}
    for line in sorted({allow.line for allow in comments if allow.own_line}, reverse=True):
        after[line] = after.get(line + 1, line + 1)
    lines: dict[int, dict[str, tuple[int, int]]] = defaultdict(dict)
    for number, allow in enumerate(comments):
        reached = [allow.line, after[allow.line]] if allow.own_line and allow.line else [allow.line]
        for line in reached:
            for name in allow.rules:
                lines[line].setdefault(name, (number, allow.line))
    return lines


def format_baseline(findings: Iterable[Finding]) -> str:
    """The text of a baseline file that knows these findings: by content, so that moved lines stay known.

    Only `fingerprint` and `count` are read again; the rest is for the person who reviews the file.
    """
    known = list(findings)
    counts = Counter(finding.fingerprint for finding in known)
    facts = {finding.fingerprint: finding for finding in reversed(known)}
    entries = [
        {
            "rule": finding.rule,
            "path": finding.path,
            "subject": finding.subject,
            "fingerprint": fingerprint,
            "count": counts[fingerprint],
        }
        for fingerprint, finding in sorted(facts.items(), key=lambda item: (*_sort_key(item[1]), item[0]))
    ]
    return format_json({"schema": 1, "findings": entries}) + "\n"


def read_baseline(text: str | bytes) -> Counter[str]:
    """Fingerprints a baseline file knows, with their counts. Raises SettingsError when it is not a baseline file."""
    try:
        data = load_json(text)
        if data["schema"] != 1:
            raise SettingsError(f"the baseline has schema {data['schema']}; this version reads schema 1")
        counts = ((str(entry["fingerprint"]), int(entry.get("count", 1))) for entry in data["findings"])
        return Counter({fingerprint: max(0, min(count, _MOST_OF_ONE)) for fingerprint, count in counts})
    except SettingsError:
        raise
    except (ValueError, TypeError, KeyError, AttributeError, OverflowError) as error:
        raise SettingsError(f"the baseline cannot be read ({error}); write it anew with --write-baseline") from None


def split_by_baseline(findings: Iterable[Finding], known: Counter[str]) -> tuple[list[Finding], list[Finding]]:
    """(findings a baseline does not know, findings it knows)."""
    left = Counter(known)
    fresh: list[Finding] = []
    old: list[Finding] = []
    for finding in findings:
        (old if left[finding.fingerprint] > 0 else fresh).append(finding)
        left[finding.fingerprint] -= 1
    return fresh, old


def prune_baseline(known: Counter[str], findings: Iterable[Finding]) -> tuple[str, int]:
    """(the baseline's text without what is fixed, how many entries went). Findings it does not know are not added."""
    _, old = split_by_baseline(findings, known)
    return format_baseline(old), sum(known.values()) - len(old)


def has_failures(findings: Iterable[Finding], fail_on: str = "error") -> bool:
    """Whether a new finding is at or above a severity; `never` never fails."""
    if fail_on == "never":
        return False
    least = _RANK[fail_on]
    return any(finding.new and rank(finding.severity) >= least for finding in findings)


class UpgradeItem(NamedTuple):
    """One thing to do: findings of one cause, which is the same rule and subject in one package. The gravest come
    first; there is at least one."""

    package: str
    rule: str
    subject: str
    severity: str
    findings: tuple[Finding, ...]


def group_items(findings: Iterable[Finding], order: Sequence[str]) -> list[UpgradeItem]:
    """Findings as things to do, package by package in an order; in a package the gravest first, then by place.

    What belongs to no package comes first, and a package that the order does not name last.
    """
    causes: dict[tuple[str, str, str], list[Finding]] = defaultdict(list)
    for finding in findings:
        causes[finding.package, finding.rule, finding.subject].append(finding)
    place = {"": -1} | {name: number for number, name in enumerate(order)}
    made = []
    for (package, rule, subject), group in causes.items():
        group.sort(key=lambda finding: -rank(finding.severity))
        made.append(UpgradeItem(package, rule, subject, group[0].severity, tuple(group)))
    return sorted(made, key=lambda item: (place.get(item.package, len(place)), item.package, -rank(item.severity)))

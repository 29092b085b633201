"""The report as SARIF 2.1.0 (OASIS standard), as code scanning services read it."""

import json
import re
from typing import Any
from urllib.parse import quote

from ...edges.console import escape, escape_bytes_in_json, escape_json
from ..analysis.report import Report, locate_in_excerpt
from ..rules.fix_actions import Edit
from ..rules.rule import Finding, Rule
from . import evidence
from .json import build_target_data

SCHEMA = "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json"
_ROOT = "%SRCROOT%"


def render(report: Report) -> str:
    """The report as SARIF text that ends in a line end. Suppressed and known findings are in it, marked as such."""
    results = [
        *((finding, []) for finding in report.findings),
        *((finding, [{"kind": "inSource"}]) for finding in report.suppressed),
        *((finding, [{"kind": "external", "justification": "in the baseline"}]) for finding in report.known),
    ]
    known = {rule.name: rule for rule in report.rules()}
    rules = [_build_rule(name, known.get(name)) for name in sorted({finding.rule for finding, _ in results})]
    index = {rule["id"]: position for position, rule in enumerate(rules)}
    run = {
        "tool": {
            "driver": {
                "name": "rosimpact",
                "version": report.version,
                "semanticVersion": report.version,
                "rules": rules,
            }
        },
        "invocations": [_build_invocation(report)],
        "originalUriBaseIds": {_ROOT: {"description": {"text": "the root of the workspace"}}},
        "columnKind": "unicodeCodePoints",
        "results": [_render(report, finding, silent, index) for finding, silent in results],
        "properties": {
            "targets": list(map(build_target_data, report.targets)),
            "data": report.data,
            "coverage": report.coverage._asdict() | {"unresolved": dict(report.coverage.unresolved)},
        }
        | ({"base": report.base} if report.base else {}),
    }
    if not re.fullmatch(r"\d+\.\d+\.\d+(?:[-+].*)?", report.version):
        del run["tool"]["driver"]["semanticVersion"]
    log = {"$schema": SCHEMA, "version": "2.1.0", "runs": [run]}
    return escape_json(escape_bytes_in_json(json.dumps(log, ensure_ascii=False, indent=1))) + "\n"


def _build_invocation(report: Report) -> dict[str, Any]:
    covered = report.coverage
    notices = [{"level": "error", "message": {"text": report.failure}}] if report.failure else []
    if covered.parsed < covered.files:
        unread = covered.files - covered.parsed
        notices.append({"level": "warning", "message": {"text": f"{unread} of {covered.files} files were not read"}})
    invocation: dict[str, Any] = {"executionSuccessful": not report.failure}
    return invocation | ({"toolExecutionNotifications": notices} if notices else {})


def _build_rule(name: str, rule: Rule | None) -> dict[str, Any]:
    """The descriptor of a rule that has results, with its documentation as help."""
    if rule is None or not rule.documentation.strip():
        return {"id": name}
    head, _, body = rule.documentation.strip().partition("\n")
    short = head.partition(": ")[2] or head
    what = re.search(r"^What it does\n((?:[ \t]+\S.*\n?)+)", body, re.MULTILINE)
    full = " ".join(what[1].split()) if what else short
    return {
        "id": name,
        "name": "".join(part.title() for part in name.split("-")),
        "shortDescription": {"text": short},
        "fullDescription": {"text": full},
        "help": {"text": rule.documentation.strip(), "markdown": _render_help(body) or short},
        "defaultConfiguration": {"level": rule.severity},
        "properties": {"tags": ["ros", rule.family], "precision": "medium" if rule.preview else "high"},
    }


def _render_help(body: str) -> str:
    """A rule's documentation as Markdown: its sections become headings, examples code blocks."""
    lines: list[str] = []
    code = False
    for line in body.strip("\n").split("\n"):
        if line and not line[0].isspace():
            lines += (["```", ""] if code else []) + [f"**{line}**", ""]
            code = line.rstrip(":").lower() in ("example", "use instead")
            lines += ["```"] if code else []
        else:
            lines.append(line[4:] if line.startswith("    ") else line)
    while lines and not lines[-1]:
        lines.pop()
    return "\n".join(lines + (["```"] if code else []))


def _render(report: Report, finding: Finding, silent: list[dict[str, str]], index: dict[str, int]) -> dict[str, Any]:
    shown = "".join(f"\n{label}: {line}" for label, line in evidence.format_lines(finding))
    text = _escape_links(finding.message + shown + (f"\nhelp: {finding.help}" if finding.help else ""))
    result: dict[str, Any] = {
        "ruleId": finding.rule,
        "ruleIndex": index[finding.rule],
        "level": finding.severity,
        "message": {"text": text},
        "locations": [_build_location(report, finding)],
        "partialFingerprints": {"rosimpact/v1": finding.fingerprint},
        "properties": {
            "targets": list(finding.targets),
            "package": finding.package,
            "subject": finding.subject,
        }
        | ({"evidence": evidence.make_object(finding.evidence)} if finding.evidence is not None else {}),
    }
    if report.base:
        result["baselineState"] = "new" if finding.new else "unchanged"
    if silent:
        result["suppressions"] = silent
    if any(isinstance(part, Edit) for part in finding.fix):
        result["fixes"] = [_build_fix(finding)]
    return result


def _escape_links(text: str) -> str:
    """A message in which `[text](target)` is no link (SARIF 3.11.6): names and declarations may look like one."""
    return re.sub(r"\[(?=[^\[\]]*\]\()", r"\\[", text)


# A long line may have thousands of findings, each of which would quote it.
_LONGEST_SNIPPET = 10_000


def _build_location(report: Report, finding: Finding) -> dict[str, Any]:
    place: dict[str, Any] = {"artifactLocation": _build_artifact(finding.path)}
    if finding.line:
        region: dict[str, Any] = {"startLine": finding.line}
        lines = report.excerpt(finding.path, finding.line)
        first, shown = locate_in_excerpt(finding, lines)
        brief = sum(map(len, lines)) <= _LONGEST_SNIPPET
        if shown is not None:
            if brief:
                region["snippet"] = {"text": shown.text}
            if finding.column:
                region["startColumn"] = finding.column
                if shown.width:
                    # The end is exclusive: the column behind the last character.
                    region["endColumn"] = shown.start + shown.width + 1
            if brief:
                place["contextRegion"] = {
                    "startLine": first,
                    "endLine": first + len(lines) - 1,
                    "snippet": {"text": "\n".join(lines)},
                }
        elif finding.column:
            region["startColumn"] = finding.column
        place["region"] = region
    location: dict[str, Any] = {"physicalLocation": place}
    if finding.package:
        location["logicalLocations"] = [{"name": finding.package, "kind": "package"}]
    return location


def _build_artifact(path: str) -> dict[str, str]:
    """A path as a relative URI; one that is empty stands for the root itself."""
    # A first segment with a colon would read as a scheme (RFC 3986, 4.2); quote escapes colons, so that it cannot.
    try:
        data = path.encode("utf-8", "surrogateescape")
    except UnicodeEncodeError:
        data = escape(path).encode()
    return {"uri": quote(data, safe="/") or "./", "uriBaseId": _ROOT}


def _build_fix(finding: Finding) -> dict[str, Any]:
    by_path: dict[str, list[Edit]] = {}
    for edit in finding.fix:
        if isinstance(edit, Edit):
            by_path.setdefault(edit.path, []).append(edit)
    return {
        "description": {"text": finding.help or "apply the fix"},
        "artifactChanges": [
            {
                "artifactLocation": _build_artifact(path),
                "replacements": [
                    {
                        "deletedRegion": {"byteOffset": edit.start, "byteLength": edit.end - edit.start},
                        "insertedContent": {"text": edit.text},
                    }
                    for edit in edits
                ],
            }
            for path, edits in by_path.items()
        ],
    }

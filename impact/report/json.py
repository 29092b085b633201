"""The JSON report: schema 1, described by findings.schema.json beside this file and in docs/findings.md."""

import json
from pathlib import Path
from typing import Any

from ...edges.console import format_json
from ..analysis.report import AnalysisCoverage, Report, ReportedTarget
from ..rules.rule import Finding
from . import evidence

SCHEMA = 1


def render(report: Report) -> str:
    """The report as JSON text that ends in a line end. Valid, with `failure` set, for a run that failed too."""
    data: dict[str, Any] = {
        "schema": SCHEMA,
        "tool": {"name": "rosimpact", "version": report.version, "data": report.data},
        "targets": [
            build_target_data(target) | ({"reason": target.reason} if target.reason else {}) | build_notes(target)
            for target in report.targets
        ],
        "findings": [build_finding_data(finding) for finding in report.findings],
        "coverage": build_coverage_data(report.coverage),
    }
    for key, value in (
        ("suppressed", len(report.suppressed)),
        ("known", len(report.known)),
        ("base", report.base),
        ("failure", report.failure),
    ):
        if value:
            data[key] = value
    if report.impact is not None and report.impact.effects:
        from .impact import build_compact_data

        data["impact"] = build_compact_data(report.impact)
    return dump_json(data)


def build_target_data(target: ReportedTarget) -> dict[str, Any]:
    """What every report tells of a target."""
    return {"name": target.name, "distro": target.distro, "date": target.date, "platform": target.platform}


def build_notes(target: ReportedTarget) -> dict[str, Any]:
    """What was adjusted of a target, where anything was."""
    return {"notes": list(target.notes)} if target.notes else {}


def build_coverage_data(coverage: AnalysisCoverage) -> dict[str, Any]:
    """What was analysed, as the schemas have it."""
    return coverage._asdict() | {"unresolved": dict(sorted(coverage.unresolved.items()))}


def dump_json(data: dict[str, Any]) -> str:
    """Data as JSON text that ends in a line end, whatever bytes its texts hold."""
    return format_json(data) + "\n"


def render_schema() -> str:
    """The published JSON schema as text (draft 2020-12)."""
    return Path(__file__).with_name("findings.schema.json").read_text(encoding="utf-8")


def merge_shared_schema(name: str) -> str:
    """A schema that lies beside this file, with the definitions in it that it shares with this report: of a finding,
    a target, the tool and the coverage."""
    ours, whole = json.loads(render_schema()), json.loads(Path(__file__).with_name(name).read_text(encoding="utf-8"))
    shared = {key: ours["properties"][key] for key in ("tool", "coverage")}
    shared["target"] = ours["properties"]["targets"]["items"]
    whole["$defs"] = {**whole.get("$defs", {}), **shared, **ours["$defs"]}
    del whole["$defs"]["change"]  # of the message flow, which is asked with a base alone
    return json.dumps(whole, indent=1, ensure_ascii=False) + "\n"


def build_finding_data(finding: Finding) -> dict[str, Any]:
    """A finding as the schema has it."""
    data = {name: value for name, value in finding._asdict().items() if name not in _NOT_TOLD}
    data["targets"] = list(finding.targets)
    return data | ({"evidence": evidence.make_object(finding.evidence)} if finding.evidence is not None else {})


_NOT_TOLD = frozenset(("fix", "evidence", "repeated", "ahead", "also"))

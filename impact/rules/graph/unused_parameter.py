"""unused-parameter: a node reads a parameter and does nothing with it.

What it does
    Reports parameters that C++ code reads into a variable of the function, if the variable occurs nowhere else in it.

Why it breaks
    The value that a launch or parameter file sets has no effect: mostly a constant is used in its place.

Example
    std::string scan_topic;
    nh.getParam("scan_topic", scan_topic);
    sub = nh.subscribe("/scan", 1, callback);

Use instead
    sub = nh.subscribe(scan_topic, 1, callback);

Not reported
    Members of classes and variables of the file, which other code may use; reads whose result tells whether the
    parameter is set, also those into a value of any type (XmlRpcValue).
"""

import re
from collections.abc import Iterator

from ...facts.flow import FlowCall, FlowFunction
from ...model.flow.file_selection import get_facts
from ...model.flow.workspace import list_code
from ..vocabulary import At, Diagnostic, Text, Workspace, rule

_READS = frozenset(("getParam", "getParamCached", "param", "get_parameter", "get_parameter_or"))

_ANY_TYPE = re.compile(r"\b(?:XmlRpcValue|rclcpp::Parameter)\b")
_TEXT = re.compile(r'"[^"]*"')


@rule(
    scope="flow",
    severity="warning",
    preview=True,
    texts=Text(
        "the parameter `{subject}` is read into `{variable}`, which nothing uses", help="use it, or do not read it"
    ),
)
def unused_parameter(workspace: Workspace):
    facts = get_facts(workspace)
    for path, package in list_code(workspace).items():
        file = facts.get_facts(path).facts if facts.kinds[path] == "flow_cpp" else None
        found = [(function, call) for function in file.functions for call in _list_reads(function)] if file else []
        lines = workspace.read(path).decode("utf-8", "replace").split("\n") if found else []
        for function, call in found:
            variable = call.arguments[1].text
            if _is_only_declared(variable, lines[function.line - 1 : function.end]):
                yield Diagnostic(At(path, call.line), call.arguments[0].text, package, {"variable": variable})


def _list_reads(function: FlowFunction) -> Iterator[FlowCall]:
    """Calls that read a parameter of a known name into a variable, and whose result is not used."""
    for call in function.calls:
        if call.callee.rpartition(".")[2].rpartition("::")[2] in _READS and len(call.arguments) > 1 and call.guard < 0:
            name, variable = call.arguments[:2]
            if name.kind == "text" and variable.kind == "name" and variable.text.isidentifier() and not call.target:
                yield call


def _is_only_declared(variable: str, lines: list[str]) -> bool:
    """Whether a function names a variable twice: where it is declared, and where the parameter is read into it."""
    named = [line for line in lines for _ in re.finditer(rf"\b{variable}\b", _TEXT.sub("", line))]
    if len(named) != 2 or _ANY_TYPE.search(named[0]):
        return False
    return bool(re.match(rf"\s*[A-Za-z_][\w:<>, ]*[\w>]\s+{variable}\s*[;={{(]", named[0]))

"""unmatched-parenthesis: a parenthesis of a C++ file that a target compiles has no counterpart.

What it does
    Reports the first parenthesis without a counterpart in sources of targets and in headers that these include.

Why it breaks
    The compiler stops at a syntax error.

Severity
    error; warning in tests.

Example
    RCLCPP_INFO(get_logger(), "%s", name.c_str());)

Use instead
    RCLCPP_INFO(get_logger(), "%s", name.c_str());

Not reported
    Files in which it depends on a directive of the preprocessor which parentheses there are.
"""

from ...facts.cpp.lexical import UNMATCHED
from ..vocabulary import At, Diagnostic, Package, TargetView, Text, list_place_doubts, rule


@rule(texts=Text("a parenthesis behind `{subject}` has no counterpart, and the compiler stops", "close or remove it"))
def unmatched_parenthesis(view: TargetView, package: Package):
    wrong = [one for one in package.linked.problems if one[2].startswith(UNMATCHED)]
    compiled = dict(package.linked.source_targets) if wrong else {}
    targets = {target.name: target for target in package.build.targets}
    for path, line, message in wrong:
        made = [targets[name] for name in compiled.get(path, ()) if name in targets]
        if made and any(view.is_sure(target.conditions) for target in made):
            role = "test" if all(target.kind == "test" for target in made) else "build"
            name = message.removeprefix(UNMATCHED).removesuffix("()")
            yield Diagnostic(At(path, line), name, package.name, doubts=list_place_doubts(view, role))

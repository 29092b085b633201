"""Files are opened and written, documents parsed and text printed through `edges`: whoever goes another way is here."""

import ast
from pathlib import Path

ROOT = Path(__file__).parents[2]
ROOMS = ("impact", "corpus", "classifier", "edges")
"""databuild makes the data that is shipped, from material of whoever runs it."""

_MEASURED = "files in the temporary folder of a measurement; nodes run without rosimpact"
_SHIPPED = "data that is shipped beside the module"
DOORS = {
    "open": {
        "impact/values/harness/replay.py": "the errors of a harness, into a temporary folder",
        "impact/values/ir/executor.py": "how much memory this process uses",
        "edges/files.py": "the door",
        "edges/processes.py": "/proc/self/statm",
        "impact/targets/machine/loader.py": "a descriptor of open_regular()",
        "corpus/report.py": "a descriptor of open_regular()",
        "corpus/sources/ros_answers.py": "a descriptor of open_regular()",
        **dict.fromkeys(("impact/measure/children.py", "impact/measure/nodes/node_loop.py"), _MEASURED),
        "impact/prune/recorder.py": "what a run did; it runs without rosimpact",
        "impact/prune/verify.py": "what the nodes of a run print",
    },
    "os.open": {
        "edges/files.py": "the door",
        "edges/console.py": "/dev/null",
        "edges/processes.py": "/dev/null",
        "impact/facts/store.py": "the cache's folder, for its lock",
        "corpus/labelling.py": "the journal of labels, which is locked while it is open",
    },
    ".read_bytes": {
        "impact/rules/explain.py": _SHIPPED,
        "corpus/figures.py": "our own labels, and a picture just drawn",
        **dict.fromkeys(
            (f"impact/targets/{name}.py" for name in (
                "changes", "machine/sonames", "providers/compiled", "surface/fields", "surface/store", "unpacked",
            )),
            _SHIPPED,
        ),
    },
    ".read_text": dict.fromkeys(
        (
            *("impact/cli/new_rule.py", "impact/model/cmake/names.py", "impact/model/flow/frameworks.py"),
            *("impact/report/json.py", "impact/report/page.py", "impact/rules/rule.py", "corpus/label_screen.py"),
        ),
        _SHIPPED,
    ),
    ".write_text": {},
    ".write_bytes": {},
    "os.replace": {
        "impact/targets/unpacked.py": "the cache",
        "impact/facts/store.py": "the cache",
        "impact/values/harness/precompiled.py": "the cache",
        "corpus/polite.py": "a download that goes on where it stopped",
    },
    "print": {},
    "eval": {},
    "exec": {},
    "os.system": {},
    "subprocess.run": {
        "impact/targets/capture.py": "dpkg-query and the like, without words of a workspace",
        "impact/measure/children.py": "ip, tc, cmake and ROS's generators, which get fields and types alone",
        "impact/prune/verify.py": "the build of the workspace that the user asked for",
        "impact/values/harness/toolchain.py": "the compiler, on a harness",
        "impact/values/sandbox.py": "whether the network can be cut off",
    },
    "subprocess.Popen": {
        "impact/measure/children.py": "measuring nodes and their master",
        "impact/prune/verify.py": "the nodes of the workspace that the user asked for, and their master",
        "impact/values/harness/replay.py": "the harness of a callback that the user asked to run",
        "impact/values/sandbox.py": "a callback in Python that the user asked to run",
    },
    "pickle.loads": {"edges/processes.py": "what our own processes send each other"},
    "marshal.loads": {"classifier/features.py": "a nameless temporary file of one process"},
    "yaml.load": dict.fromkeys(("impact/targets/providers/providers.py", "impact/targets/snapshot.py"), _SHIPPED),
    "yaml.load_all": {},
    "yaml.safe_load": {"impact/targets/machine/sonames.py": _SHIPPED},
    "json.loads": {
        "edges/documents.py": "the door",
        "impact/report/json.py": "our own schemas",
        "classifier/model.py": "parts of a model whose size was looked at",
        "classifier/triage.py": "one line of a limited length",
        "corpus/figures.py": "settings that `study run` gives",
        "impact/values/python/stand_in.py": "what our own process sends to a replay",
    },
}  # fmt: skip


def called(tree: ast.AST):
    """Every call as `name`, `owner.name` and `.name`."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
            yield node.func.id
        elif isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
            owner = node.func.value.id if isinstance(node.func.value, ast.Name) else ""
            yield f"{owner}.{node.func.attr}"
            if owner != "files":  # edges.files has a function of that name
                yield f".{node.func.attr}"


def test_nobody_goes_past_the_doors():
    found: dict[str, set[str]] = {door: set() for door in DOORS}
    for room in ROOMS:
        for module in (ROOT / room).rglob("*.py"):
            path = module.relative_to(ROOT).as_posix()
            for name in set(called(ast.parse(module.read_text(encoding="utf-8")))) & DOORS.keys():
                found[name].add(path)
    assert found == {door: set(modules) for door, modules in DOORS.items()}

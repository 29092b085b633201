"""undefined-name: a Python file uses a name that nothing defines.

What it does
    Reports names that a Python file uses but neither defines nor imports, such as a class whose import was forgotten;
    imports from a module of the package, or of another one of the workspace, that does not exist or does not define the
    name, or from a package of an unknown name in place of its own; imports of modules that setup() does not install;
    modules of a package that import another one of its folder by its bare name, or lead out of the package by a
    relative import; relative imports of programs; modules that are called or subscripted; private members of `self`
    that nothing sets; functions of entry points that their
    module does not define; star imports of a package from itself, which Python 2 took from a module in it; and builtins
    (`raw_input`, `unicode`) and dictionary methods (`iteritems`) that only Python 2 has, where the target has Python 3.

Why it breaks
    Python raises a NameError, ImportError or AttributeError when it reaches the line.

Severity
    error for code that always runs when a program, launch file or module of the package is started or imported; warning
    inside functions, which may not be called, for methods, in tests, and in files that are not installed; note in
    examples, and inside functions of files that are not installed. What only the newest distro
    does not accept is a warning at the first place of a package, and a note at the others.

Example
    name = raw_input("name? ")

Use instead
    name = input("name? ")

Not reported
    Code inside a `try` that catches the error, or under a test of the Python version; files with a star import, or that
    define names with `exec`, `globals()` and the like; imports from such modules; modules that another package has as
    well; methods that the file itself defines.
"""

from collections.abc import Iterator

from ...model.package import ImportUse
from ...model.python.undefined import classify_undefined
from ...targets.distro.distro import DistroTarget
from ..python_files import RejectedUse, is_no_example, list_python_doubts, report_refused
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, Together, rule


@rule(
    scope="target",
    texts={
        "undefined": Text("`{subject}` is neither defined nor imported in this file", "define or import `{subject}`"),
        "python 2": Text(
            "`{subject}` is not defined in Python {version}[[ ({horizon})]]", "use the Python 3 equivalent"
        ),
        "module": Text("the package has no module `{subject}`", "correct the module path in the import"),
        "module of another": Text("`{owner}` has no module `{subject}`", "correct the module path in the import"),
        "itself": Text(
            "`from {subject} import *` in `{subject}` itself gives nothing in Python 3[[ ({horizon})]]",
            "write `from .{subject} import *`",
        ),
        "beside": Text(
            "`{subject}` is a module of the same package, where Python 3[[ ({horizon})]] does not look for it",
            "write `.{subject}`",
        ),
        "above": Text("`{subject}` leads out of the package, which Python refuses", "write `{replacement}`"),
        "alone": Text(
            "`{subject}` is imported by a program, which is in no package that it could be relative to",
            "import it by the name of its package",
        ),
        "module used": Text("`{subject}` is a module, which cannot be called or subscripted", "import a name of it"),
        "private": Text("nothing in the file sets `{subject}`", "correct the name"),
        "unlisted": Text(
            "`{subject}` is imported, but setup() does not install this Python package",
            "add `{subject}` to `packages`, or use find_packages()",
        ),
        "imported": Text("`{module}` does not define `{subject}`", "import a name that `{module}` defines"),
    },
)
def undefined_name(view: TargetView):
    for package in view:
        for use, name, kind in _list_uses(view, package):
            if kind in _OF_PYTHON2:
                continue
            if kind == "unlisted":
                if use.role == "run":
                    doubts = (use.lazy is False or Doubt.LATE, package.build_type == "ament_python" or Doubt.DISTURBS)
                    same = (Together(use.module),)
                    yield Diagnostic(use.at, use.module, package.name, {}, kind, doubts, together=same)
                continue
            if kind in ("above", "alone"):
                inside, doubts = use.module.lstrip("."), _collect_import_doubts(view, package, use)
                data = {"replacement": inside if inside.startswith(f"{package.name}.") else f".{inside}"}
                yield Diagnostic(use.at, use.module, package.name, data, kind, doubts, together=(Together(kind),))
                continue
            if kind in ("imported", "module") and view.may_find_module_elsewhere(package, use.module or name):
                continue
            # A module that is not there has, by its first name, to be one of the package.
            own = kind != "module" or name.partition(".")[0] in package.linked.modules
            doubts = (*_collect_import_doubts(view, package, use), own or Doubt.AMBIGUOUS)
            # Whoever looks at the first in a file sees the others; wrong imports are mended one by one.
            together = (Together(use.at.path if kind == "undefined" else f"{use.at.path} {name}"),)
            subject = name.removesuffix("()").removeprefix("self.") if kind in ("module used", "private") else name
            yield Diagnostic(use.at, subject, package.name, {"module": use.module}, kind, doubts, together=together)
        yield from _find_lacking_elsewhere(view, package)

    def find(package: Package, target: DistroTarget) -> Iterator[RejectedUse]:
        for use, name, kind in _list_uses(view, package):
            head = use.module.partition(".")[0]
            subject = {"python 2": name.lstrip("."), "beside": head}.get(kind, use.module)
            if kind == "python 2" or (kind in _OF_PYTHON2 and not view.may_find_module_elsewhere(package, subject)):
                doubts = (*_collect_doubts(use), kind != "itself" or Doubt.LATE)
                yield RejectedUse(use, subject, kind, doubts=doubts, conditions=use.conditions)

    yield from report_refused(view, find)


# Builtins and methods of Python 2, and imports of a module by its bare name, or of all of it, that Python 2 takes from
# the folder of the importing one.
_OF_PYTHON2 = ("python 2", "beside", "itself")


def _list_uses(view: TargetView, package: Package) -> Iterator[tuple[ImportUse, str, str]]:
    """What surely counts here, each with its name and kind."""
    for use in package.linked.undefined:
        if view.is_sure(use.conditions):
            yield use, use.names[0], classify_undefined(use.module, use.names[0])


def _find_lacking_elsewhere(view: TargetView, package: Package) -> Iterator[Diagnostic]:
    """Imports from modules of other packages of the workspace that do not exist or do not define the name."""
    for use in package.linked.imports:
        owners = view.workspace.modules.get(use.module.partition(".")[0], ())
        if len(owners) != 1 or owners[0] == package.name or not view.is_sure(use.conditions):
            continue
        owner = view.workspace.packages[owners[0]]
        if view.may_find_module_elsewhere(owner, use.module):
            continue
        for name in owner.linked.python_offer.list_lacking(use.module, use.names):
            kind = "module of another" if name == use.module else "imported"
            data = {"module": use.module, "owner": owner.name}
            yield Diagnostic(use.at, name, package.name, data, kind, _collect_import_doubts(view, package, use))


def _collect_import_doubts(view: TargetView, package: Package, use: ImportUse) -> tuple[Doubt | bool, ...]:
    place = list_python_doubts(view, package, use.role, use.at.path)
    if use.role == "aside" and not (use.module or use.lazy) and is_no_example(package, use.at.path):
        place = (Doubt.LATE,)  # whoever starts or imports the file comes by
    return (*place, *_collect_doubts(use), use.role != "test" or Doubt.TEST)


def _collect_doubts(use: ImportUse) -> tuple[Doubt, ...]:
    doubts = (Doubt.LATE,) if use.lazy else ()
    of_any_type = use.names and use.names[0].startswith(".") and not use.module
    return (*doubts, Doubt.INCOMPLETE) if of_any_type else doubts

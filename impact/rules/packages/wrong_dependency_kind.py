"""wrong-dependency-kind: a dependency is declared, and not as what it is used for.

What it does
    Reports packages that built code needs and the manifest declares only for tests or for running, packages that an
    installed header includes and the manifest does not pass on to dependants, and packages needed at run time that are
    declared for building only.

Why it breaks
    A build without tests, or a machine that only builds, lacks the package. A dependant that includes the public header
    finds the header's own includes missing. An installed robot lacks what the node imports.

Severity
    warning; note where rosdep installs the package all the same (declared for running, needed to build), and where what
    is needed to run is declared for tests.

Example
    <test_depend>moveit_ros_planning</test_depend>      # and CMakeLists.txt finds it outside BUILD_TESTING

Use instead
    <depend>moveit_ros_planning</depend>

Not reported
    What another declared dependency brings as the right kind.
"""

from ...model.view import View
from ..cure import Declare, Remove
from ..evidence import circular
from ..rule import Hit, rule

_FOR_BUILD = frozenset({"build", "buildtool", "build_export", "buildtool_export"})
_FOR_RUN = frozenset({"exec", "build_export"})


@rule(severity="warning")
def wrong_dependency_kind(view: View):
    for package in view:
        declared = view.declared(package)
        build, exported, run = None, None, None
        told = set()
        for need in view.weighed(package):
            own = [p.name for p in need.providers if p.name in declared]
            if not own or not need.certain or not need.required or any(n in told for n in own):
                continue
            kinds = set().union(*(declared[n] for n in own))
            name = own[0]
            if need.role == "build" and need.how in ("find_package", "component", "include"):
                if not kinds & _FOR_BUILD:
                    build = (
                        build if build is not None else view.spread(n for n, k in declared.items() if k & _FOR_BUILD)
                    )
                    if view.answered(need.providers, build):
                        continue
                    if package.manifest.format == 1 or kinds <= {"exec"}:
                        # rosdep installs run dependencies along, so only the order of a clean build suffers
                        severity = "warning" if name in view.workspace.packages or kinds == {"test"} else "note"
                    else:
                        severity = "warning"
                    told.add(name)
                    kind = "for tests" if kinds == {"test"} else "for running"
                    yield Hit(
                        need.at,
                        name,
                        f"`{name}` is needed to build and declared only {kind}",
                        f"declare it as `<{'build_depend' if package.manifest.format == 1 else 'depend'}>`",
                        package.name,
                        severity=severity,
                        fix=_cure(view, package, name, "depend", kinds),
                    )
                elif need.public and need.how == "include" and not kinds & {"build_export", "exec"}:
                    exported = (
                        exported
                        if exported is not None
                        else view.spread(
                            n for n, k in declared.items() if k & {"build_export", "exec", "buildtool_export"}
                        )
                    )
                    if view.answered(need.providers, exported):
                        continue
                    told.add(name)
                    yield Hit(
                        need.at,
                        name,
                        f"an installed header includes `{need.subject}` and dependants do not get `{name}`",
                        f"declare it as `<{'run_depend' if package.manifest.format == 1 else 'depend'}>`",
                        package.name,
                        fix=_cure(view, package, name, "depend", kinds),
                    )
            elif need.role == "run" and need.how in ("import", "launch") and not kinds & _FOR_RUN:
                run = run if run is not None else view.spread(n for n, k in declared.items() if k & _FOR_RUN)
                if view.answered(need.providers, run):
                    continue
                told.add(name)
                yield Hit(
                    need.at,
                    name,
                    f"`{name}` is needed to run and declared only for {'tests' if kinds == {'test'} else 'building'}",
                    f"declare it as `<{'run_depend' if package.manifest.format == 1 else 'exec_depend'}>`",
                    package.name,
                    severity="warning" if kinds != {"test"} else "note",
                    fix=_cure(view, package, name, "exec_depend", kinds),
                )


def _cure(view: View, package, name: str, tag: str, kinds: set[str]) -> tuple[Declare | Remove, ...]:
    """What is declared for tests alone is declared anew, since `depend` beside `test_depend` says one thing twice."""
    path = package.digest.manifest_path
    if circular(view, package, name):
        return ()
    if kinds == {"test"} and tag == "depend":
        return (Remove(path, name, "test_depend"), Declare(path, name, tag))
    return (Declare(path, name, tag),)

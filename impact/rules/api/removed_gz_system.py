"""removed-gz-system: a world or model loads a system that the target's version of gz-sim does not have.

What it does
    Reports `<plugin filename="...">` in SDF, URDF and xacro files that names a system of gz-sim (Ignition Gazebo until
    version 6) which the version of the target does not have, by a name that its loader does not accept or that is of
    another version, or misspelt.

Why it breaks
    The simulator starts, says that it failed to load the system, and runs without it: no sensor data, no drive.

Severity
    warning, since it is not known which file is loaded and the simulator goes on; note in examples.

Example
    <plugin filename="gz-sim-particle-emitter2-system" name="gz::sim::systems::ParticleEmitter2"/>   # gz-sim 7

Use instead
    <plugin filename="gz-sim-particle-emitter-system" name="gz::sim::systems::ParticleEmitter"/>     # gz-sim 8

Not reported
    Libraries of the workspace; targets on which it is not known which version of gz-sim is used; files in folders named
    after another distro.
"""

from ...model.misspelling import is_slip
from ...targets.gz_systems import PREFIXES, find_gz_version, load_gz_systems, split_name
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, list_place_doubts, rule
from .diagnosis import is_of_another_distro


@rule(
    severity="warning",
    preview=True,
    texts={
        "name": Text(
            "`{subject}` is not found by the loader of gz-sim {version}[[ (accepted since {since})]]",
            help="use `{replacement}`",
        ),
        "major": Text("`{subject}` is of another version than gz-sim {version}", help="use `{replacement}`"),
        "removed": Text("`{subject}` is not available in gz-sim {version}[[ (last in {since})]]"),
        "not yet": Text("`{subject}` is not available in gz-sim {version}[[ (added in {since})]]"),
        "never": Text("gz-sim {version} has no system `{subject}`", help="did you mean `{replacement}`?"),
    },
)
def removed_gz_system(view: TargetView, package: Package):
    uses = [(use, split_name(use.reference.name)) for use in package.linked.references]
    uses = [(use, name) for use, name in uses if use.reference.kind == "plugin" and name is not None]
    version = find_gz_version(view.target, view.brought_to_workspace) if uses else ""
    if not version:
        return
    table = load_gz_systems()
    files = frozenset(package.linked.files)
    made = {target.output_name or target.name for one in view.workspace for target in one.build.targets}
    for use, (prefix, major, system) in uses:
        if is_of_another_distro(view, use.at.path, files) or use.reference.name.removeprefix("lib") in made:
            continue
        subject = use.reference.name
        spans = table.systems.get(system)
        data = {"version": version, "replacement": "", "since": ""}
        if spans is None:
            here = (known for known, spans in table.systems.items() if table.has(spans, version))
            close = [known for known in here if is_slip(known, system)]
            if len(close) != 1:
                continue
            kind, data["replacement"] = "never", subject.replace(system, close[0])
        elif not table.has(spans, version):
            kind = "removed" if (last := table.find_last(spans, version)) else "not yet"
            data["since"] = last or table.find_first(spans, version)
        elif major and major != version.partition(".")[0]:
            kind, data["replacement"] = "major", subject.replace(f"{prefix}{major}", prefix)
        elif not table.has(table.prefixes[prefix], version):
            kind, data["since"] = "name", table.find_first(table.prefixes[prefix], version)
            data["replacement"] = subject.replace(prefix, next(one for one in PREFIXES if one != prefix))
        else:
            continue
        doubts = (*list_place_doubts(view, use.role), Doubt.LATE, Doubt.DISTURBS)
        yield Diagnostic(use.at, subject, package.name, data, kind, doubts)

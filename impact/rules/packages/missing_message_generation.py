"""missing-message-generation: messages are generated, and their generator is not found.

What it does
    Reports packages of ROS 1 that call generate_messages() and do not find message_generation, which brings the
    generators of all languages.

Why it breaks
    Nothing generates the headers and modules, so that the code which includes them does not compile.

Severity
    error where nothing that is found brings it; warning where another package happens to, or may.

Example
    find_package(catkin REQUIRED COMPONENTS std_msgs)

Use instead
    find_package(catkin REQUIRED COMPONENTS std_msgs message_generation)

Not reported
    Packages that find a generator themselves, or genmsg, which looks for those that are installed.
"""

from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, Together, rule


@rule(
    group="missing-interface-wiring",
    texts=Text(
        "messages are generated but `{subject}` is not found[[; only `{through}` brings it]]",
        "add `{subject}` to find_package(catkin REQUIRED COMPONENTS ...)",
    ),
)
def missing_message_generation(view: TargetView, package: Package):
    if package.build_type != "catkin":
        return
    generated = [g for g in package.build.generated if g.how == "catkin"]
    found = {f.name for f in package.build.found}
    if not generated or "message_generation" in found:
        return
    # What message_generation hands on makes messages for one language each; genmsg looks for all that is installed.
    generators = {*view.roles.list_exports("message_generation")} - {"genmsg"}
    if found & generators or generators & view.list_transitive(found & {"genmsg"}):
        return
    through = next((f for f in sorted(found) if {"message_generation", "genmsg"} & view.list_transitive([f])), "")
    doubts = (
        (Doubt.INCOMPLETE,) if through or "genmsg" in found or view.unknown_contents.may_come_along(package) else ()
    )
    data, same = {"through": through}, (Together("message_generation is not found", everywhere=True),)
    yield Diagnostic(generated[0].at, "message_generation", package.name, data, doubts=doubts, together=same)

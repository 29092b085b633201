"""abstract-object: an object is made of a class that leaves out a pure virtual method of its base in the workspace.

What it does
    Reports classes of which objects are made by `new`, make_shared(), make_unique(), as a variable, as a member, or as
    a plugin, where a base class of the workspace has a pure virtual method that neither they nor their other bases
    implement.

Why it breaks
    The compiler stops: "invalid new-expression of abstract class type".

Example
    class Base { virtual void stop() = 0; };
    class Wheel : public Base {};
    auto wheel = std::make_shared<Wheel>();

Use instead
    class Wheel : public Base { void stop() override; };

Not reported
    Classes or bases with macros that may declare methods; templates; bases that are not known; a method of that name
    whose parameters may be the same types under other names.
"""

from ..vocabulary import Diagnostic, Package, TargetView, Text, list_place_doubts, rule


@rule(
    texts=Text(
        "`{owner}` does not implement `{subject}`, which is pure virtual, and objects of it are made[[ in {place}]]",
        "it is declared as `{declared}`",
    )
)
def abstract_object(view: TargetView, package: Package):
    for found in package.linked.abstract:
        if view.applies(found.conditions):
            made = found.made
            place = f"{made.path}:{made.line}" if made is not None and made.path != found.at.path else ""
            data = {"owner": found.class_, "declared": found.declared, "place": place}
            doubts = list_place_doubts(view, found.role, found.conditions)
            subject = f"{found.base}::{found.method}"
            yield Diagnostic(found.at, subject, package.name, data, doubts=doubts)

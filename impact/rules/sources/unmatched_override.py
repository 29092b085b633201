"""unmatched-override: a method says `override` and overrides none of its base's in the workspace.

What it does
    Reports methods that say `override` or `final` in classes with bases of the workspace, where these have no method of
    that name, none that is virtual, only ones with other parameters, or one that gives back something else, and what
    they are derived from in other packages has none of that name on the target.

Why it breaks
    The compiler stops: "marked 'override', but does not override".

Example
    class Base { virtual void go(double speed); };
    class Wheel : public Base { void go(int speed) override; };

Use instead
    class Wheel : public Base { void go(double speed) override; };

Not reported
    Classes with a base that is not known, has several definitions, or is of a package whose classes are not completely
    known in the version that the target has; types that may be the same under another name; bases with macros that may
    declare methods, where no method of that name is seen.
"""

from ...targets.surface.overrides import has_method
from ..vocabulary import Diagnostic, Package, TargetView, Text, list_place_doubts, rule

_HELP = "it is declared as `{declared}`"


@rule(
    texts={
        "absent": Text("`{method}` is marked `override`, but no base class of `{owner}` declares it"),
        "plain": Text("`{method}` is marked `override`, but `{subject}` is not virtual", _HELP),
        "types": Text("`{method}` is marked `override`, but its signature differs from that of `{subject}`", _HELP),
        "result": Text("`{method}` overrides `{subject}`, but returns another type", _HELP),
    }
)
def unmatched_override(view: TargetView, package: Package):
    for found in package.linked.lost_overrides:
        if view.applies(found.conditions) and _are_without(view, package, found.outer, found.method):
            data = {"method": found.method, "owner": found.class_, "declared": found.declared}
            doubts = list_place_doubts(view, found.role, found.conditions)
            subject = f"{found.base}::{found.method}"
            yield Diagnostic(found.at, subject, package.name, data, kind=found.kind, doubts=doubts)


def _are_without(view: TargetView, package: Package, classes: tuple[str, ...], method: str) -> bool:
    """Whether classes of other packages surely have no method of a name. classes: as a package writes them."""
    bases = [(_find_owner(view, package, name), name) for name in classes]
    return not bases or (all(owner for owner, _ in bases) and has_method(view.offers, bases, method) is False)


def _find_owner(view: TargetView, package: Package, class_: str) -> str:
    """The package that declares a class; empty where none is known to."""
    owners = (class_.partition("::")[0], *view.collect_declared(package))
    return next((one for one in owners if "::" in class_ and view.offers.has_name("c++", class_, one)), "")

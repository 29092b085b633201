"""unmatched-override: a method says `override` and overrides none of its base's in the workspace.

What it does
    Reports methods that say `override` or `final` in classes all of whose bases are classes of the workspace, where
    these have no method of that name, none that is virtual, only ones with other parameters, or one that gives back
    something else.

Why it breaks
    The compiler stops: "marked 'override', but does not override".

Example
    class Base { virtual void go(double speed); };
    class Wheel : public Base { void go(int speed) override; };

Use instead
    class Wheel : public Base { void go(double speed) override; };

Not reported
    Classes with a base that is a template, of another package, not known, or has several definitions; types that may be
    the same under another name; bases with macros that may declare methods, where no method of that name is seen.
"""

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
        if view.applies(found.conditions):
            data = {"method": found.method, "owner": found.class_, "declared": found.declared}
            doubts = list_place_doubts(view, found.role, found.conditions)
            subject = f"{found.base}::{found.method}"
            yield Diagnostic(found.at, subject, package.name, data, kind=found.kind, doubts=doubts)

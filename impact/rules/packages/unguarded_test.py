"""unguarded-test: a command of catkin that makes tests is called where tests may be switched off.

What it does
    Reports calls of catkin_add_gtest(), catkin_add_nosetests(), add_rostest() and their kin that stand outside of
    if(CATKIN_ENABLE_TESTING).

Why it breaks
    With -DCATKIN_ENABLE_TESTING=OFF, catkin stops: "() is not available when tests are not enabled".

Severity
    warning for the first of the workspace; note for the rest: whoever switches tests off stops at the first.

Example
    catkin_add_nosetests(test)

Use instead
    if(CATKIN_ENABLE_TESTING)
      catkin_add_nosetests(test)
    endif()

Not reported
    Calls under any test of a variable that is called after testing.
"""

from ..vocabulary import Package, TargetView, Text, Together, rule
from .refused_names import diagnose_refused

# Who builds the workspace has tests switched on, or stops at the first of them.
_ONCE = (Together("tests that are not guarded", everywhere=True),)


@rule(
    severity="warning",
    texts=Text(
        "`{subject}()` is called where tests may be switched off, and stops there",
        "call it inside of if(CATKIN_ENABLE_TESTING)",
    ),
)
def unguarded_test(view: TargetView, package: Package):
    if view.target.ros == 1:
        yield from diagnose_refused(view, package, "unguarded", _ONCE)

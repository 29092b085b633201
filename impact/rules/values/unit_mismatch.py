"""unit-mismatch: a publisher sends degrees where radians are taken, or millimetres where metres are.

What it does
    Reports an assignment to a field of a message that is published, whose unit is known by a name (`yaw_deg`,
    `distance_mm`) or by a conversion (`math.degrees()`, `* 180 / M_PI`, `* 1000`), and differs from the unit that a
    subscriber of the workspace takes the field to have, by the same signs, or that REP-103 gives it. This
    takes no exploration.

Why it matters
    The robot turns 57 times as far, or drives 1000 times as far, as it should.

Severity
    warning.

Example
    twist.angular.z = yaw_deg        # geometry_msgs/Twist is in radians per second

Use instead
    twist.angular.z = math.radians(yaw_deg)

Not reported
    Expressions without such a sign; fields that publisher and subscriber both take in the same other unit. It runs only
    where it, or `values`, is selected by name.
"""

from ...values.matching import UNIT
from ..vocabulary import Text, Workspace, rule
from .mismatches import find_diagnostics


@rule(
    scope="workspace",
    severity="warning",
    preview=True,
    on_request=True,
    texts={
        "": Text(
            "`{subject}` of `{topic}` is sent in {value}; `{subscriber}` ({reader}) takes it as {expected}",
            help="convert it on one side",
        ),
        "standard": Text(
            "`{subject}` of `{topic}` is sent in {value}; REP-103 says {expected}",
            help="convert it to {expected}",
        ),
    },
)
def unit_mismatch(workspace: Workspace):
    return find_diagnostics(workspace, UNIT)

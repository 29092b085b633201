"""Every row of the table of renamed parameters, against what the stored versions declare."""

import pytest
from rosimpact.impact.targets.parameters import find_last_part, find_renamed_parameters, load_renamed_parameters
from rosimpact.impact.targets.surface.store import load_shipped
from rosimpact.impact.targets.version import is_at_least

ROWS = [
    (package, row.since, row.source, old, new)
    for row in load_renamed_parameters()
    for package in row.packages
    for old, new in row.names.items()
]


@pytest.mark.parametrize(("package", "since", "source", "old", "new"), ROWS, ids=lambda value: str(value)[-30:])
def test_the_new_name_is_declared_since_then_and_the_old_one_before(package, since, source, old, new):
    history = load_shipped().find_history(package, 2)
    declared = {v: {find_last_part(name) for name, _ in history.list_parameters(v)} for v in history.versions}
    before = [names for version, names in declared.items() if not is_at_least(version, since)]
    after = [names for version, names in declared.items() if is_at_least(version, since)]
    assert any(old in names for names in before)
    assert new in after[0] and not any(old in names for names in after)
    assert source.startswith("https://")


def test_either_name_leads_to_the_other():
    assert find_renamed_parameters("nav2_controller")["progress_checker_plugin"] == ("progress_checker_plugins",)
    assert find_renamed_parameters("nav2_controller")["progress_checker_plugins"] == ("progress_checker_plugin",)
    assert find_renamed_parameters("rclcpp") == {}

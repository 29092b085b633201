"""What a machine needs for real measurements; tests that need it are skipped, and say why."""

import pytest
from rosimpact.edges.console import UserError
from rosimpact.impact.measure import namespaces, ros1


@pytest.fixture(scope="session")
def allowed():
    """Skips where namespaces with limited links cannot be made."""
    if missing := namespaces.find_missing():
        pytest.skip("; ".join(missing))
    try:
        with namespaces.open_namespaces(1_000_000):
            return
    except UserError as error:
        pytest.skip(str(error))


@pytest.fixture(scope="session")
def roscpp():
    """Skips where ROS 1 is not installed."""
    if missing := ros1.find_ros1("roscpp")[1]:
        pytest.skip("; ".join(missing))


@pytest.fixture(scope="session")
def rospy():
    """Skips where ROS 1 for Python is not installed."""
    if missing := ros1.find_ros1("rospy")[1]:
        pytest.skip("; ".join(missing))

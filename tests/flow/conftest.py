"""The page of the message-flow graph in a browser."""

import pytest
from rosimpact.impact.report.graph import draw


@pytest.fixture
def page(browser, opened):
    yield lambda graph, base=None, fragment="", **asked: opened(draw(graph, "html", base, **asked), fragment)
    assert browser.get_log("browser") == []

"""The timeline of changes in a real browser: filters, search, places, hostile names."""

import pytest
from msgspec import structs
from rosimpact.impact.logic.changes import LogicChange, ReachedSubscriber
from rosimpact.impact.logic.history import Commit
from rosimpact.impact.logic.repository import Logic, LogicCoverage
from rosimpact.impact.report.timeline import render

FIRST = Commit("a" * 40, "", "2020-01-01T00:00:00Z", "Wait for a scan")
LAST = Commit("b" * 40, "a" * 40, "2024-05-29T00:00:00Z", "Drop the timer")
READER = ReachedSubscriber("viewer", "viewer/viewer", "/cloud", "Viewer::onCloud", "viewer/viewer.cpp", 40)
TIGHTENED = LogicChange(
    "tightened", "amcl", "amcl/amcl.cpp", 13, "Amcl::onScan", "amcl/amcl", "cloud", ("/cloud",), "a_msgs/Cloud",
    old="map_", new="map_ && ready_", why="only when `ready_` too", reaches=(READER,),
)  # fmt: skip
GONE = structs.replace(
    TIGHTENED, kind="gone", package="beep", path="beep/beep.py", topic="beeps", new=None, why="", reaches=()
)
LOGIC = Logic("repo", "HEAD", (LAST, FIRST), ((LAST, GONE), (FIRST, TIGHTENED)), LogicCoverage(2, 2))
PAYLOAD = "</script><img src=x onerror=window.hacked=1>`\u2028{{data}}"


@pytest.fixture
def page(browser, opened):
    yield lambda logic: opened(render(logic, "1.2"))
    assert browser.get_log("browser") == []


def texts(browser, selector):
    return [each.text for each in browser.find_elements("css selector", selector)]


def test_each_change_has_its_place_its_conditions_and_whom_it_reaches(page):
    browser = page(LOGIC)
    assert texts(browser, ".commit") == ["Drop the timer", "Wait for a scan"]
    assert texts(browser, ".change .badge") == ["gone", "tightened"]
    assert texts(browser, ".tightened .message code") == ["ready_"]
    assert texts(browser, ".tightened pre div") == ["- map_", "+ map_ && ready_"]
    assert texts(browser, ".reaches li") == ["reaches viewer/viewer, Viewer::onCloud viewer/viewer.cpp:40"]
    assert texts(browser, ".tightened > .place") == ["amcl/amcl.cpp:13"]


@pytest.mark.parametrize(
    ("field", "value"), [("kind", "=gone"), ("package", "=beep"), ("topic", "=beeps"), ("search", "beep.py timer")]
)
def test_filters(page, field, value):
    browser = page(LOGIC)
    browser.execute_script(
        "const node = document.getElementById(arguments[0]); node.value = arguments[1];"
        "node.dispatchEvent(new Event('input', {bubbles: true}))", field, value,
    )  # fmt: skip
    assert texts(browser, ".change .badge") == ["gone"]
    assert texts(browser, "#count") == ["1 of 2 changes in 1 commit"]


def test_a_bar_is_a_time(page):
    browser = page(LOGIC)
    browser.find_element("css selector", "#bars button:not([disabled])").click()
    assert texts(browser, ".commit") == ["Wait for a scan"]


def test_hostile_names_stay_names(page):
    odd = structs.replace(
        TIGHTENED, package=PAYLOAD, path=PAYLOAD, node=PAYLOAD, topic=PAYLOAD, new=PAYLOAD, why=PAYLOAD
    )
    browser = page(Logic(PAYLOAD, PAYLOAD, (FIRST,), ((FIRST, odd),), LogicCoverage(1, 1)))
    assert browser.execute_script("return window.hacked") is None
    assert browser.execute_script("return document.querySelectorAll('main img').length") == 0
    assert "onerror=window.hacked=1>" in texts(browser, ".change .place")[0]


def test_nothing_changed(page):
    browser = page(Logic("repo", "HEAD", (), (), LogicCoverage(0, 0)))
    assert texts(browser, "#count") == ["0 of 0 changes in 0 commits"]
    assert not browser.find_element("id", "bars").is_displayed()


def test_the_light_is_switched_and_paper_is_light(page):
    browser = page(LOGIC)

    def light():
        return browser.execute_script("return document.documentElement.dataset.theme")

    before = light()
    browser.find_element("id", "theme").click()
    assert {before, light()} == {"light", "dark"}
    browser.execute_script("document.documentElement.dataset.theme = 'dark'; dispatchEvent(new Event('beforeprint'))")
    assert light() == "light"
    browser.execute_script("dispatchEvent(new Event('afterprint'))")
    assert light() == "dark"

"""The page in a real browser: filters, keyboard, no noise on console or network, hostile text, 5,000 findings."""

import json
import re
import time

import pytest
from rosimpact.impact.report import html
from rosimpact.impact.rules.rule import Finding


@pytest.fixture
def page(opened):
    return lambda report, fragment="": opened(html.render(report), fragment)


def texts(browser, selector):
    return browser.execute_script(
        "return [...document.querySelectorAll(arguments[0])].map((node) => node.textContent)", selector
    )


def choose(browser, name, value):
    browser.execute_script(
        "const node = document.getElementById(arguments[0]); node.value = arguments[1];"
        "node.dispatchEvent(new Event('input', {bubbles: true}))",
        name,
        value,
    )


def asked_for(browser):
    """Addresses the page asked for, itself excepted."""
    events = [json.loads(entry["message"])["message"] for entry in browser.get_log("performance")]
    urls = [e["params"]["request"]["url"] for e in events if e["method"] == "Network.requestWillBeSent"]
    return [url for url in urls if url != browser.current_url.partition("#")[0] and url != "about:blank"]


def test_the_page_shows_everything_and_asks_for_nothing(page, team):
    browser = page(team)
    assert texts(browser, "#verdict") == [
        "breaks on jazzy: 1, rolling: 1, robot: 1; may break on humble: 1",
    ]
    assert texts(browser, "#matrix thead th") == ["package", "humble", "jazzy", "rolling", "robot"]
    assert texts(browser, "#matrix tbody td") == ["! 1", "✗ 1", "✗ 1", "! 1", "·", "·", "·", "✗ 1"]
    assert texts(browser, "#reason") == ["Targets chosen: rosimpact.toml"]
    assert not browser.find_element("id", "old-label").is_displayed(), "nothing is older without a base"
    assert texts(browser, "#list .badge") == ["error", "error", "warning"]
    assert texts(browser, "#list mark") == ["tf2_geometry_msgs/tf2_geometry_msgs.h", "OpenCV", "cv_bridge"]
    assert browser.get_log("browser") == []
    assert asked_for(browser) == []


@pytest.mark.parametrize(
    ("field", "value", "places"),
    [
        ("target", "0", ["src/localizer/src/node.cpp:3:11"]),
        ("target", "3", ["src/planner/CMakeLists.txt:2:14", "src/localizer/src/node.cpp:3:11"]),
        ("package", "=planner", ["src/planner/CMakeLists.txt:2:14"]),
        ("rule", "removed-header", ["src/localizer/src/node.cpp:2:11"]),
        ("search", "OPENCV asks", ["src/planner/CMakeLists.txt:2:14"]),
        ("search", "no such thing", []),
    ],
)
def test_filters(page, team, field, value, places):
    browser = page(team)
    choose(browser, field, value)
    assert texts(browser, "#list .place") == places
    assert texts(browser, "#count") == [f"{len(places)} of 4 findings"]
    browser.refresh()
    assert texts(browser, "#list .place") == places, "the address keeps the filter"


def test_severities_are_switched_with_the_keyboard(page, team):
    browser = page(team)
    browser.execute_script("document.getElementById('note').focus()")
    browser.switch_to.active_element.send_keys(" ")
    assert texts(browser, "#list .badge") == ["error", "error", "warning", "note"]
    browser.find_element("tag name", "body").send_keys("/")
    browser.switch_to.active_element.send_keys("planner")
    assert texts(browser, "#list .badge") == ["error"]


def test_a_cell_of_the_matrix_filters_and_lets_go(page, team):
    browser = page(team)
    cell = "#matrix tbody tr:first-child td:nth-child(3) button"
    browser.find_element("css selector", cell).send_keys("\n")
    assert texts(browser, "#list .badge") == ["error", "warning"]
    assert browser.find_element("css selector", cell).get_attribute("aria-pressed") == "true"
    browser.find_element("css selector", cell).send_keys("\n")
    assert texts(browser, "#count") == ["3 of 4 findings"]


def test_clean_packages_are_shown_when_asked(page, team):
    browser = page(team)
    assert len(texts(browser, "#matrix tbody tr")) == 2
    browser.find_element("id", "clean").click()
    assert len(texts(browser, "#matrix tbody tr")) == 5


def test_hostile_text_stays_text(page, hostile):
    browser = page(hostile)
    assert browser.execute_script("return window.hacked") is None
    assert browser.execute_script("return document.querySelectorAll('#list img, #list script, #list a').length") == 0
    assert "onerror=window.hacked=1>" in texts(browser, "#list .place")[0]
    assert "onerror=window.hacked=1>" in texts(browser, "#list pre")[0]
    assert browser.get_log("browser") == []
    assert asked_for(browser) == []


def test_hostile_filters_in_the_address_do_nothing(page, team):
    browser = page(team, "#package=%3D%3Cimg%20src%3Dx%20onerror%3Dalert(1)%3E&target=99&rule=x&search=%3Cscript%3E")
    assert browser.get_log("browser") == []
    assert texts(browser, "#list .place") == []


def test_five_thousand_findings_can_all_be_reached(page, large):
    browser = page(large)
    assert texts(browser, "#count") == ["3,750 of 5,000 findings"]
    assert len(texts(browser, "#list > li")) < 500, "only what is near the window is made"
    for _ in range(60):
        browser.execute_script("document.getElementById('next').click()")
    assert len(texts(browser, "#list > li")) == 3750
    choose(browser, "search", "h4999.hpp")
    browser.execute_script("document.getElementById('note').click()")
    assert texts(browser, "#list .message") == ["h4999.hpp is gone"]


def test_one_cause_is_one_card_with_its_places_folded(page, quiet):
    gone = [Finding("r", "error", "ui", f"{n}.cpp", 1, 0, "x", ("jazzy",), "`x` is gone") for n in range(9)]
    other = Finding("r", "error", "arm", "9.cpp", 1, 0, "x", ("jazzy",), "`x` is gone")
    browser = page(quiet._replace(findings=(*gone, other)))
    assert texts(browser, "#list .place") == ["0.cpp:1", "9.cpp:1"]
    assert texts(browser, "#count") == ["2 findings in 10 places"]
    assert texts(browser, "#matrix td.error") == ["✗ 1", "✗ 1"]
    browser.find_element("css selector", "#list .places summary").click()
    wait = time.monotonic() + 5
    while len(texts(browser, "#list .place")) < 10 and time.monotonic() < wait:
        time.sleep(0.02)
    assert texts(browser, "#list .place")[:3] == ["0.cpp:1", "1.cpp:1", "2.cpp:1"]
    choose(browser, "search", "3.cpp")
    assert texts(browser, "#list .place") == ["3.cpp:1"]
    assert texts(browser, "#count") == ["1 of 2 findings in 10 places"]


def test_nothing_found(page, quiet):
    browser = page(quiet)
    assert texts(browser, "#verdict")[0].startswith("no known break on: humble, jazzy, rolling, robot; 3 includes, ")
    assert texts(browser, "#count") == ["0 findings"]
    assert browser.get_log("browser") == []


def test_the_page_holds_no_address_to_load_from(team):
    text = html.render(team)
    assert not re.search(r"""(?:src|href)\s*=|url\(|@import|https?://""", text)
    assert text.count("</script>") == 2


def test_data_cannot_leave_its_block(hostile):
    text = html.render(hostile)
    block = text.partition('id="data">')[2].partition("</script>")[0]
    assert json.loads(block)["root"].startswith("</script>")
    assert not re.search("[<>&\u2028]", block)
    assert "{{" not in re.sub(r"(?s)<script.*", "", text)

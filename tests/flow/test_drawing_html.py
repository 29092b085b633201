"""The page of the message-flow graph in a real browser: places, filters, keyboard, hostile names, 300 nodes."""

import json
import re
from itertools import pairwise

import pytest
from msgspec import structs
from robot import DRIVER, robot
from rosimpact.impact.model.flow.graph import (
    Callback,
    Coverage,
    Endpoint,
    Graph,
    GuardAt,
    Node,
    ParameterUse,
    Publish,
    Qos,
    Timer,
    Trigger,
    Unresolved,
    Way,
)
from rosimpact.impact.report.graph import draw

NOW = robot()
OTHER = DRIVER.replace("if (ready_) ", "").replace("rclcpp::SensorDataQoS()", "10").replace('"calibrate"', '"tune"')
BEFORE = structs.replace(robot(driver=OTHER), rev="v1.0")
PAYLOAD = "</script><script>window.hacked=1</script><img src=x onerror=window.hacked=1>'\"`🤖\u2028{{data}}\u202e"


def hostile() -> Graph:
    """Every text is one that tries to be more than a text."""
    guard = GuardAt("if", PAYLOAD, PAYLOAD, 3, PAYLOAD)
    trigger = Trigger("timer", PAYLOAD, PAYLOAD, 4)
    callback = Callback(PAYLOAD, PAYLOAD, 5)
    made = {"node": PAYLOAD, "type": PAYLOAD, "path": PAYLOAD, "line": 1, "written": PAYLOAD, "function": PAYLOAD}
    return Graph(
        nodes=(Node(PAYLOAD, PAYLOAD, PAYLOAD, "executable", PAYLOAD, PAYLOAD, "cpp", PAYLOAD, 1, PAYLOAD),),
        endpoints=(
            Endpoint("publisher", topic=PAYLOAD, qos=Qos(reliability=PAYLOAD, written=PAYLOAD), **made),
            Endpoint("server", topic=f"/{PAYLOAD}", callback=callback, **made),
            Endpoint("subscriber", topic="", reason=PAYLOAD, **made),
        ),
        publishes=(
            Publish(
                PAYLOAD, PAYLOAD, PAYLOAD, PAYLOAD, 2, PAYLOAD, PAYLOAD, PAYLOAD, (guard,), (trigger,), 1,
                (Way(trigger, (guard,)),),
            ),
        ),
        timers=(Timer(PAYLOAD, PAYLOAD, callback, PAYLOAD, 6),),
        parameters=(ParameterUse(PAYLOAD, PAYLOAD, "declared", PAYLOAD, 7, PAYLOAD),),
        coverage=Coverage(3, 2, 0, 1, (PAYLOAD,), (Unresolved(PAYLOAD, PAYLOAD, PAYLOAD, 8, PAYLOAD),)),
        root=PAYLOAD,
    )  # fmt: skip


def large() -> Graph:
    """300 nodes and 600 topics: each node says two and hears up to four, near and far ones."""
    nodes = tuple(Node(f"p{n % 30}/n{n}", f"/ns/node_number_{n}", f"p{n % 30}", "executable") for n in range(300))
    ends = []
    for n, node in enumerate(nodes):
        said = [f"/ns/topic_{2 * n}", f"/ns/topic_{2 * n + 1}"]
        heard = [f"/ns/topic_{(n * k + j) % 600}" for k, j in ((2, 590), (2, 583), (7, 11), (13, 5))][: 1 + n % 4]
        for role, topics in (("publisher", said), ("subscriber", heard)):
            ends += [Endpoint(role, node.id, topic, "std_msgs/String", f"p/n{n}.cpp", 10) for topic in topics]
    return Graph(nodes, tuple(ends), (), (), (), Coverage(len(ends), len(ends), 0, 300), root="large")


@pytest.fixture
def page(browser, opened):
    yield lambda graph, base=None, fragment="", **asked: opened(draw(graph, "html", base, **asked), fragment)
    assert browser.get_log("browser") == []


def texts(browser, selector):
    return browser.execute_script(
        "return [...document.querySelectorAll(arguments[0])].map((node) => node.textContent)", selector
    )


def labels(browser, selector=""):
    """What screen readers call the boxes that fit the selector, sorted."""
    return sorted(
        browser.execute_script(
            "return [...document.querySelectorAll('.box[role]' + arguments[0])].map((box) => box.ariaLabel)",
            selector,
        )
    )


def click(browser, label):
    browser.find_element("css selector", f'.box[aria-label="{label}"]').click()


def choose(browser, name, value):
    browser.execute_script(
        "const node = document.getElementById(arguments[0]); node.value = arguments[1];"
        "node.dispatchEvent(new Event('input', {bubbles: true}))",
        name,
        value,
    )


def keys(browser, *pressed):
    from selenium.webdriver import ActionChains

    ActionChains(browser).send_keys(*pressed).perform()


def asked_for(browser):
    """Addresses the page asked for, itself excepted."""
    events = [json.loads(entry["message"])["message"] for entry in browser.get_log("performance")]
    urls = [e["params"]["request"]["url"] for e in events if e["method"] == "Network.requestWillBeSent"]
    return [url for url in urls if url != browser.current_url.partition("#")[0] and url != "about:blank"]


ALL = ["node /driver", "node /mover", "node /planner", "service /calibrate", "topic /plan", "topic /scan"]


def test_the_page_shows_everything_and_asks_for_nothing(page):
    browser = page(NOW)
    assert labels(browser) == ALL
    assert texts(browser, "#facts") == ["3 nodes · 2 topics · 1 service"]
    assert len(texts(browser, "#lines .edge")) == 6
    panel = browser.find_element("id", "panel").text
    assert "8 of 9 API calls resolved (89 %); 3 files read." in panel
    assert "unknown()" in panel and "planner/planner.cpp:7" in panel, "what is not resolved is said"
    assert not browser.find_element("id", "changed-label").is_displayed(), "nothing is changed without a base"
    assert asked_for(browser) == []


def test_messages_flow_from_left_to_right_and_no_boxes_overlap(page):
    browser = page(NOW)
    found = browser.execute_script(
        "return [...document.querySelectorAll('.box[role]')].map((box) => {"
        " const {left, right, top, bottom} = box.querySelector('.shape').getBoundingClientRect();"
        " return [box.getAttribute('aria-label'), left, right, top, bottom]; })"
    )
    place = {name: sides for name, *sides in found}
    way = ["node /driver", "topic /scan", "node /planner", "topic /plan", "node /mover"]
    for left, right in pairwise(way):
        assert place[left][1] < place[right][0]
    assert not overlapping([sides for _, *sides in found])


def overlapping(boxes):
    """Pairs of boxes (left, right, top, bottom) that share some ground."""
    return [
        (a, b)
        for n, a in enumerate(boxes)
        for b in boxes[:n]
        if a[0] < b[1] and b[0] < a[1] and a[2] < b[3] and b[2] < a[3]
    ]


def test_a_click_on_a_topic_shows_who_uses_it_and_where(page):
    browser = page(NOW)
    click(browser, "topic /scan")
    panel = browser.find_element("id", "panel").text
    for said in (
        "topic, sensor_msgs/LaserScan", "PUBLISHERS (1)", "/driver", "driver/driver.cpp:5", "QoS best_effort",
        "driver/driver.cpp:6", "on timer 100ms", "when ready_", "SUBSCRIBERS (1)", "callback Planner::onScan",
        "planner/planner.cpp:10",
    ):  # fmt: skip
        assert said in panel
    assert labels(browser, ".on") == ["node /driver", "node /planner", "topic /scan"]
    browser.find_element("css selector", "#panel li .go").click()
    assert browser.find_element("css selector", "#panel h2").text == "/driver"
    assert "calibrate" in browser.find_element("id", "panel").text


def test_a_click_on_an_arrow_shows_its_places(page):
    browser = page(NOW)
    browser.execute_script(
        "[...document.querySelectorAll('.edge')].find((edge) => edge.textContent === '/driver publishes /scan')"
        ".querySelector('.reach').dispatchEvent(new MouseEvent('click', {bubbles: true}))"
    )
    assert browser.find_element("css selector", "#panel h2").text == "/driver publishes /scan"
    assert "driver/driver.cpp:5" in texts(browser, "#panel .place")
    assert labels(browser, ".on") == ["node /driver", "topic /scan"]


@pytest.mark.parametrize(
    ("field", "value", "left"),
    [
        ("package", "=mover", ["node /mover", "topic /plan"]),
        ("service", None, [name for name in ALL if not name.startswith("service")]),
        ("topic", None, ["node /driver", "node /planner", "service /calibrate"]),
    ],
)
def test_filters(page, field, value, left):
    browser = page(NOW)
    if value is None:
        browser.find_element("id", field).click()
    else:
        choose(browser, field, value)
    assert labels(browser) == left
    browser.refresh()
    assert labels(browser) == left, "the address keeps the filter"
    browser.find_element("css selector", "button[type=reset]").click()
    browser.execute_async_script("setTimeout(arguments[0], 50)")
    assert labels(browser) == ALL


def test_only_what_is_near(page):
    browser = page(NOW)
    click(browser, "node /mover")
    browser.find_element("css selector", "#panel .tools button").click()
    assert labels(browser) == ["node /mover", "node /planner", "topic /plan"]


def test_the_keyboard_alone_searches_opens_walks_and_closes(page):
    from selenium.webdriver import Keys

    browser = page(NOW)
    keys(browser, "/", "laserscan")
    assert labels(browser, ".hit") == ["topic /scan"]
    assert texts(browser, "#count") == ["1 found"]
    keys(browser, Keys.ENTER)
    assert texts(browser, "#panel h2") == ["/scan"]
    keys(browser, Keys.ESCAPE)
    assert labels(browser, ".chosen") == []
    keys(browser, Keys.ESCAPE)
    assert browser.find_element("id", "search").get_attribute("value") == ""
    for _ in range(12):
        keys(browser, Keys.TAB)
        if browser.switch_to.active_element.get_attribute("role") == "button":
            break
    assert browser.switch_to.active_element.get_attribute("aria-label") == "topic /scan", (
        "the tab key goes on from there"
    )
    keys(browser, Keys.ARROW_RIGHT, Keys.ENTER)
    assert texts(browser, "#panel h2") == ["/planner"]
    keys(browser, Keys.ESCAPE)
    assert "Coverage" in texts(browser, "#panel h3")


def test_changes_against_a_base(page):
    browser = page(NOW, BEFORE)
    assert texts(browser, "#legend li")[-3:] == ["added", "removed", "changed"]
    marks = {mark: texts(browser, f"#lines .edge.{mark} title") for mark in ("added", "removed", "changed")}
    assert marks == {
        "added": ["/driver serves /calibrate (added)"],
        "removed": ["/driver serves /tune (removed)"],
        "changed": ["/driver publishes /scan (changed: QoS, guards)"],
    }
    assert "service /tune, removed" in labels(browser)
    browser.find_element("id", "changed").click()
    assert "topic /plan" not in labels(browser)
    click(browser, "topic /scan")
    browser.find_element("css selector", "#panel .before summary").click()
    assert browser.find_element("css selector", "#panel .before").text.startswith("before (v1.0)")
    assert "ready_" not in browser.find_element("css selector", "#panel .before").text


def test_hostile_names_stay_names(page):
    browser = page(hostile(), everything=True)
    for box in range(3):
        browser.execute_script(
            "document.querySelectorAll('.box[role]')[arguments[0]].dispatchEvent(new MouseEvent('click'))", box
        )
        assert "onerror=window.hacked=1>" in browser.find_element("id", "panel").text
    choose(browser, "search", PAYLOAD[:40])
    assert browser.execute_script("return window.hacked") is None
    assert browser.execute_script("return document.querySelectorAll('main img, main script, main a').length") == 0
    assert "\u202e" not in browser.page_source, "nothing turns the direction of the text"
    assert asked_for(browser) == []


def test_hostile_filters_in_the_address_do_nothing(page):
    browser = page(NOW, fragment="#package=%3D%3Cimg%20src%3Dx%3E&show=__proto__&near=%3Cscript%3E&topic=x")
    assert texts(browser, "#panel h2") == ["ws"]


def test_three_hundred_nodes_and_six_hundred_topics_are_usable(page):
    browser = page(large())
    assert len(labels(browser)) == 900
    seconds = browser.execute_script("return performance.getEntriesByName('rosimpact graph drawn')[0].startTime") / 1000
    assert seconds < 10, "2 s on an idle machine; the rest is for busy ones"
    boxes = browser.execute_script(
        "return [...document.querySelectorAll('.box[role] .shape')].map((box) => {"
        " const {left, right, top, bottom} = box.getBoundingClientRect(); return [left, right, top, bottom]; })"
    )
    assert not overlapping(boxes)
    choose(browser, "search", "topic_599")
    assert labels(browser, ".hit") == ["topic /ns/topic_599"]
    choose(browser, "search", "")
    choose(browser, "package", "=p7")
    assert sum(label.startswith("node") for label in labels(browser)) == 10


def test_the_layout_is_the_same_every_time(page):
    def places(browser):
        return browser.execute_script(
            "return [...document.querySelectorAll('.box[role]')].map((box) => box.getAttribute('transform'))"
        )

    assert places(page(large())) == places(page(large()))


def test_paper_shows_the_whole_graph(page):
    browser = page(large())
    browser.execute_script("dispatchEvent(new Event('beforeprint'))")
    room = browser.execute_script("return document.getElementById('drawing').viewBox.baseVal.width")
    widest = browser.execute_script("return document.getElementById('world').getBBox().width")
    assert room >= widest
    assert browser.execute_script("return document.getElementById('world').getAttribute('transform')") is None
    browser.execute_script("dispatchEvent(new Event('afterprint'))")
    assert browser.execute_script("return document.getElementById('drawing').getAttribute('viewBox')") is None


def test_an_empty_graph(page):
    browser = page(Graph((), (), (), (), (), Coverage(0, 0, 0, 0)))
    assert browser.find_element("id", "empty").is_displayed()


def test_the_page_holds_no_address_to_load_from():
    text = draw(NOW, "html")
    assert not re.search(r"""(?:src|href)\s*=|url\(|@import|https?://""", text)
    assert text.count("</script>") == 2


def test_data_cannot_leave_its_block():
    text = draw(hostile(), "html")
    block = text.partition('id="data">')[2].partition("</script>")[0]
    assert json.loads(block)["root"].startswith("</script>")
    assert not re.search("[<>&\u2028]", block)
    assert "{{policy}}" not in text
    assert text.partition("{{data}}")[2].startswith("\\u202e</title>"), "a name that looks like a gap is not filled"

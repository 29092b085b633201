"""The page of the message-flow graph in a real browser: places, filters, keyboard, hostile names."""

import json
import re
from itertools import pairwise

import pytest
from in_browser import asked_for, choose, click, keys, labels, overlapping, texts
from msgspec import structs
from robot import DRIVER, robot
from rosimpact.impact.model.flow.definitions import DefinedMember, make_key
from rosimpact.impact.model.flow.graph import (
    Callback,
    Coverage,
    Endpoint,
    Graph,
    GuardAt,
    Node,
    OutsideNode,
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
        nodes=tuple(
            Node(
                id, PAYLOAD, PAYLOAD, "executable", PAYLOAD, PAYLOAD, "cpp", PAYLOAD, 1, PAYLOAD, (PAYLOAD,),
                (PAYLOAD, f"{PAYLOAD}/2"),
            )
            for id in (PAYLOAD, f"{PAYLOAD}/2")
        ),
        endpoints=(
            Endpoint("publisher", topic=PAYLOAD, qos=Qos(reliability=PAYLOAD, written=PAYLOAD), **made),
            Endpoint("server", topic=f"/{PAYLOAD}", callback=callback, only_if=PAYLOAD, **made),
            Endpoint("subscriber", topic=PAYLOAD, **made | {"node": f"{PAYLOAD}/2"}),
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
        outside=(OutsideNode(PAYLOAD, PAYLOAD, PAYLOAD, PAYLOAD, PAYLOAD, (PAYLOAD,), (PAYLOAD,)),),
    )  # fmt: skip


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


def test_possible_nodes_stand_beside_the_graph(page):
    joy = OutsideNode("/joy", "joy", "joy_node", "node", "a.launch.xml:4", ("$(env SIM)",), ("sticks",))
    include = OutsideNode("", "nav2_bringup", "launch/bringup.launch.py", "launch file", "a.launch.xml:6")
    browser = page(structs.replace(NOW, outside=(joy, include)))
    assert "Possible nodes, whose code is not here (2)" in texts(browser, "#panel h3")
    said = texts(browser, "#panel li.unsure")
    assert said[0] == "/joy joy/joy_nodeuses sticksonly if $(env SIM)a.launch.xml:4"
    assert said[1].startswith("any of a launch file nav2_bringup/launch/bringup.launch.py")
    assert "node /joy" not in " ".join(labels(browser)), "they are no boxes: nothing tells what they talk about"


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


@pytest.mark.parametrize("group", ["", "package"])
def test_hostile_names_stay_names(page, group):
    key = make_key("topic", PAYLOAD)
    member = DefinedMember(PAYLOAD, PAYLOAD, key, PAYLOAD)
    browser = page(
        hostile(), fragment=f"#group={group}", everything=True, interfaces={key: {PAYLOAD: [member]}},
        editor="vscode://file/{path}:{line}", folder=PAYLOAD,
    )  # fmt: skip
    for box in range(len(labels(browser))):
        browser.execute_script(
            "document.querySelectorAll('.box[role]')[arguments[0]].dispatchEvent(new MouseEvent('click'))", box
        )
        assert "onerror=window.hacked=1>" in browser.find_element("id", "panel").text
    choose(browser, "view", "table")
    assert "onerror=window.hacked=1>" in browser.find_element("id", "table").text
    choose(browser, "search", PAYLOAD[:40])
    assert browser.execute_script("return window.hacked") is None
    assert browser.execute_script("return document.querySelectorAll('main img, main script').length") == 0
    links = browser.execute_script("return [...document.querySelectorAll('main a')].map((one) => one.protocol)")
    assert set(links) <= {"vscode:"}
    assert "\u202e" not in browser.page_source, "nothing turns the direction of the text"
    assert asked_for(browser) == []


def test_hostile_filters_in_the_address_do_nothing(page):
    asked = "package=%3D%3Cimg%20src%3Dx%3E&show=__proto__&near=%3Cscript%3E&topic=x&open=%7B&sort=x+down&view=x"
    browser = page(NOW, fragment=f"#{asked}")
    assert texts(browser, "#panel h2") == ["ws"]


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

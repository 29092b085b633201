"""The page of a system of 200 nodes and 400 topics in a real browser: opening, moving, and every control."""

import re

import pytest
from in_browser import choose, click, keys, labels, overlapping, texts
from large import LAUNCHES, NODES, TOPICS, build_large_graph
from msgspec import structs
from rosimpact.impact.model.flow.definitions import DefinedMember
from rosimpact.impact.model.flow.graph import Qos
from rosimpact.impact.report.graph import draw

LARGE = build_large_graph()
EDITOR = {"editor": "vscode://file/{path}:{line}", "folder": "/home/a b/ws#1"}


def count_layouts(browser) -> int:
    return browser.execute_script("return performance.getEntriesByName('rosimpact graph layout').length")


def get_view(browser):
    return browser.execute_script("return document.getElementById('world').getAttribute('transform')")


def press(browser, name):
    browser.find_element("id", name).click()


def get_boxes(browser):
    return browser.execute_script(
        "return [...document.querySelectorAll('.box[role] .shape')].map((box) => {"
        " const {left, right, top, bottom} = box.getBoundingClientRect(); return [left, right, top, bottom]; })"
    )


def find(browser, text):
    choose(browser, "search", text)
    browser.find_element("id", "search").send_keys("\n")


def reopen(browser):
    """Follows the address anew; the page is then as the address says."""
    browser.refresh()
    return browser


def count_work(browser, open_page) -> dict[str, int]:
    """What a page does until it is drawn: `calls` of its functions, `layouts` of the browser, `elements` made."""
    ask = browser.execute_cdp_cmd
    browser.get("about:blank")
    ask("Profiler.enable", {})
    ask("Profiler.startPreciseCoverage", {"callCount": True, "detailed": False})
    ask("Performance.enable", {})
    try:
        open_page()
        metrics = {one["name"]: one["value"] for one in ask("Performance.getMetrics", {})["metrics"]}
        scripts = ask("Profiler.takePreciseCoverage", {})["result"]
    finally:
        ask("Profiler.stopPreciseCoverage", {})
        ask("Profiler.disable", {})
        ask("Performance.disable", {})
    functions = [one for script in scripts if script["url"].endswith(".html") for one in script["functions"]]
    assert functions, "the browser counts"
    return {
        "calls": sum(one["ranges"][0]["count"] for one in functions),
        "layouts": int(metrics["LayoutCount"]),
        "elements": browser.execute_script("return document.querySelectorAll('*').length"),
    }


def test_it_opens_with_little_work(page, capsys):
    # Seconds are those of the machine and of what it does beside: they are printed. Opening takes 40,000 calls and
    # 0.1 s of processor time; a search through all pairs of nodes and topics would take 80,000 more.
    half = build_large_graph(NODES // 2)
    browser = page(half)
    of_half = count_work(browser, lambda: page(half))
    work = count_work(browser, lambda: page(LARGE))
    seconds = browser.execute_script("return performance.getEntriesByName('rosimpact graph drawn')[0].startTime") / 1000
    with capsys.disabled():
        print(f" [opened in {seconds:.2f} s, {work}]", end="")
    assert work["calls"] < 80_000
    assert work["layouts"] <= 6
    assert work["elements"] == of_half["elements"], "what is folded is not made"
    whole = count_work(browser, lambda: page(LARGE, fragment="#group=none"))
    assert whole["calls"] < 15 * 80_000, "a box or an arrow for each of 1,500 things"
    assert whole["layouts"] <= 6


def test_it_opens_folded_and_fitted(page):
    browser = page(LARGE)
    assert count_layouts(browser) == 1
    assert labels(browser) == [f"group /space_{n}, 20 nodes" for n in range(10)]
    assert texts(browser, "#facts") == [f"{NODES} nodes · {TOPICS + 1} topics"]
    stage = browser.execute_script(
        "const {left, right, top, bottom} = document.getElementById('drawing').getBoundingClientRect();"
        "return [left, right, top, bottom]"
    )
    assert all(
        a[0] >= stage[0] and a[1] <= stage[1] and a[2] >= stage[2] and a[3] <= stage[3] for a in get_boxes(browser)
    )


def test_unfolded_everything_is_there_and_nothing_overlaps(page):
    browser = page(LARGE)
    press(browser, "unfold")
    assert len(labels(browser)) == NODES + TOPICS
    assert not overlapping(get_boxes(browser))
    assert count_layouts(browser) == 2
    press(browser, "fold")
    assert len(labels(browser)) == 10


def test_moving_and_zooming_lay_nothing_out_anew(page):
    from selenium.webdriver import ActionChains, Keys

    browser = page(LARGE)
    press(browser, "unfold")
    made = "return [...document.querySelectorAll('#world *')].length"
    before, shapes, views = count_layouts(browser), browser.execute_script(made), {get_view(browser)}
    browser.execute_script("window.changed = 0; new MutationObserver((all) => { window.changed += all.length; })"
                           ".observe(document.getElementById('world'), {childList: true, subtree: true})")  # fmt: skip
    drawing = browser.find_element("id", "drawing")
    middle = browser.execute_script(
        "const area = document.getElementById('drawing').getBoundingClientRect();"
        "return [Math.round(area.left + area.width / 2), Math.round(area.top + 8)]"
    )
    chain = ActionChains(browser).w3c_actions
    chain.pointer_action.move_to_location(*middle).pointer_down().move_to_location(middle[0] - 200, middle[1] + 90)
    chain.pointer_action.pointer_up()
    chain.perform()
    views.add(get_view(browser))
    for name in ("in", "out", "in", "in", "in", "in", "in"):
        press(browser, name)
        views.add(get_view(browser))
    browser.execute_script(
        "arguments[0].dispatchEvent(new WheelEvent('wheel', {deltaY: -300, cancelable: true}))", drawing
    )
    views.add(get_view(browser))
    browser.execute_script("document.getElementById('map').focus()")
    for pressed in (Keys.ARROW_LEFT, Keys.ARROW_UP, Keys.ARROW_RIGHT, "+", "-", "-", "0"):
        keys(browser, pressed)
        views.add(get_view(browser))
    assert len(views) > 9, "each of them moved it"
    assert (count_layouts(browser), browser.execute_script(made)) == (before, shapes)
    assert browser.execute_script("return window.changed") == 0


def test_the_map_shows_and_moves_what_is_in_view(page):
    from selenium.webdriver import ActionChains

    browser = page(LARGE)
    assert not browser.find_element("id", "map").is_displayed(), "all is in view"
    for _ in range(5):
        press(browser, "in")
    assert browser.find_element("id", "map").is_displayed()
    before = get_view(browser)
    chart = browser.find_element("id", "map")
    ActionChains(browser).move_to_element_with_offset(chart, -75, 0).click().perform()
    assert get_view(browser) != before
    part = browser.execute_script(
        "const {x, width} = document.getElementById('map-part').getBBox(); return x + width / 2"
    )
    whole = browser.execute_script("return document.getElementById('map').viewBox.baseVal.width")
    assert part < whole / 4, "the middle of the view is where the map was pressed"


def test_groups_unfold_by_mouse_and_keyboard(page):
    from selenium.webdriver import ActionChains, Keys

    browser = page(LARGE)
    group = browser.find_element("css selector", '.box[aria-label^="group /space_3"]')
    ActionChains(browser).double_click(group).perform()
    assert sum(label.startswith("node /space_3/") for label in labels(browser)) == 20
    assert sum(label.startswith("group") for label in labels(browser)) == 9
    keys(browser, "f")
    assert "group /space_3, 20 nodes" in labels(browser)
    assert browser.switch_to.active_element.get_attribute("aria-label") == "group /space_3, 20 nodes"
    keys(browser, Keys.ENTER)
    assert texts(browser, "#panel h2") == ["/space_3"]
    assert "Nodes (20)" in texts(browser, "#panel h3")
    browser.find_element("css selector", "#panel .tools button").click()
    assert sum(label.startswith("node /space_3/") for label in labels(browser)) == 20
    reopen(browser)
    assert sum(label.startswith("node /space_3/") for label in labels(browser)) == 20, "the address keeps it"
    press(browser, "fold")
    keys(browser, Keys.ESCAPE)
    browser.find_element("css selector", '#panel [aria-label="unfold /space_4"]').click()
    assert sum(label.startswith("node /space_4/") for label in labels(browser)) == 20


def test_other_groupings(page):
    browser = page(LARGE)
    choose(browser, "group", "package")
    assert labels(browser)[:2] == ["group package_0, 10 nodes", "group package_1, 10 nodes"]
    choose(browser, "group", "none")
    assert len(labels(browser)) == NODES + TOPICS
    assert not browser.find_element("id", "folding").is_displayed()
    reopen(browser)
    assert len(labels(browser)) == NODES + TOPICS


def test_an_arrow_between_groups_tells_what_passes_through_it(page):
    browser = page(LARGE)
    title = next(title for title in texts(browser, "#lines .edge title") if re.search(r": \d+ names", title))
    browser.execute_script(
        "[...document.querySelectorAll('.edge')]"
        ".find((edge) => edge.querySelector('title').textContent === arguments[0])"
        ".querySelector('.reach').dispatchEvent(new MouseEvent('click', {bubbles: true}))",
        title,
    )
    ends, count = title.split(": ")[0], re.search(r"(\d+) names", title)[1]
    assert texts(browser, "#panel h2") == [ends]
    assert texts(browser, "#panel h3") == [f"Through ({count})"]
    reopen(browser)
    assert texts(browser, "#panel h2") == [ends], "the address keeps it"


@pytest.mark.parametrize(("view", "kind", "count"), [("nodes", "node", NODES), ("topics", "topic", TOPICS)])
def test_nodes_only_and_topics_only(page, view, kind, count):
    browser = page(LARGE)
    press(browser, "unfold")
    choose(browser, "view", view)
    assert [label.split()[0] for label in labels(browser)] == [kind] * count
    assert texts(browser, "#lines .edge title")
    reopen(browser)
    assert len(labels(browser)) == count


def test_dead_ends_and_standard_names_are_hidden_on_request(page):
    browser = page(LARGE)
    choose(browser, "group", "none")
    heard = {one.topic for one in LARGE.endpoints if one.role == "subscriber"}
    press(browser, "ends")
    assert {label.split()[1].rstrip(",") for label in labels(browser) if label.startswith("topic")} == heard
    press(browser, "ends")
    press(browser, "standard")
    assert "topic /rosout" in labels(browser)
    browser.find_element("css selector", "button[type=reset]").click()
    browser.execute_async_script("setTimeout(arguments[0], 50)")
    assert "topic /rosout" not in labels(browser)
    assert "topic /rosout" in labels(page(LARGE, fragment="#group=none", everything=True))


def test_the_choice_of_a_launch_file(page):
    browser = page(LARGE, fragment="#group=none")
    choose(browser, "launch", f"={LAUNCHES[2]}")
    shown = {label.split()[1].rstrip(",") for label in labels(browser) if label.startswith("node")}
    assert shown == {node.name for node in LARGE.nodes if LAUNCHES[2] in node.launches}
    alone = structs.replace(LARGE, nodes=tuple(structs.replace(node, launches=LAUNCHES[:1]) for node in LARGE.nodes))
    assert not page(alone).find_element("id", "launch").is_displayed()


def test_a_group_counts_what_the_filters_let_through(page):
    browser = page(LARGE)
    choose(browser, "launch", f"={LAUNCHES[2]}")
    counts = {n: sum(LAUNCHES[2] in node.launches for node in LARGE.nodes[n::10]) for n in range(10)}
    assert labels(browser) == [f"group /space_{n}, {count} of 20 nodes" for n, count in counts.items()]
    choose(browser, "package", "=package_4")
    assert not any(label.startswith("group /space_4, 1 ") for label in labels(browser)), "one node stands for itself"


def test_the_search_finds_what_is_folded(page):
    from selenium.webdriver import Keys

    browser = page(LARGE)
    keys(browser, "/", "node_number_133")
    assert texts(browser, "#count") == ["1 found"]
    assert labels(browser, ".hit") == ["group /space_3, 20 nodes"]
    keys(browser, Keys.ENTER)
    assert texts(browser, "#panel h2") == ["/space_3/node_number_133"]
    assert labels(browser, ".chosen") == ["group /space_3, 20 nodes"]


def read_column(browser, number):
    return texts(browser, f"#rows tr > :nth-child({number})")


def test_the_table_is_sorted_and_filtered(page):
    from selenium.webdriver import Keys

    browser = page(LARGE)
    choose(browser, "view", "table")
    assert not browser.find_element("id", "drawing").is_displayed()
    names = read_column(browser, 1)
    assert len(names) == TOPICS
    assert names[:3] == ["/space_0/topic_0", "/space_0/topic_1", "/space_0/topic_20"], "numbers are sorted as such"
    browser.find_element("css selector", '[data-column="rate"]').click()
    rates = [float(rate.removesuffix(" Hz")) for rate in read_column(browser, 7)]
    assert rates == sorted(rates)
    keys(browser, Keys.ENTER)
    assert browser.switch_to.active_element.get_attribute("data-column") == "rate", "the focus stays"
    assert read_column(browser, 7)[0] == "50 Hz"
    assert browser.find_element("css selector", 'th[aria-sort="descending"]').text.startswith("Rate")
    reopen(browser)
    assert read_column(browser, 7)[0] == "50 Hz", "the address keeps the order"
    choose(browser, "search", "laserscan topic_40")
    assert read_column(browser, 1) == ["/space_0/topic_40"]
    assert read_column(browser, 3) == ["sensor_msgs/LaserScan"]
    assert read_column(browser, 6) == ["best_effort volatile depth 5"]
    browser.find_element("css selector", "#rows .go").click()
    assert texts(browser, "#panel h2") == ["/space_0/topic_40"]
    assert "published at" in browser.find_element("id", "panel").text


def test_what_is_not_certain_is_drawn_apart_and_said(page):
    browser = page(LARGE, fragment="#group=none")
    assert "not certain" in texts(browser, "#legend li")
    sure, unsure = "node /space_4/node_number_4", "node /space_3/node_number_3, not certain"
    dashes = "return getComputedStyle(document.querySelector(`[aria-label='${arguments[0]}'] .shape`)).strokeDasharray"
    assert browser.execute_script(dashes, sure) == "none"
    assert browser.execute_script(dashes, unsure) != "none"
    assert any(title.endswith("(not certain)") for title in texts(browser, "#lines .edge.unsure title"))
    find(browser, "node_number_3")
    assert (
        "not certain: whether it is started, or its name, depends on IfCondition"
        in browser.find_element("id", "panel").text
    )
    find(browser, "topic_7")
    assert "not certain: the name is a parameter's default" in browser.find_element("id", "panel").text
    only = next(one for one in LARGE.endpoints if one.only_if)
    find(browser, only.topic.rpartition("/")[2])
    assert "only if USE_GPU" in browser.find_element("id", "panel").text


def test_the_fields_of_a_message_unfold(page):
    interfaces = {
        "nav_msgs/msg/Path": {"message": [
            DefinedMember("header", "std_msgs/Header", "std_msgs/msg/Header"),
            DefinedMember("MAX", "int32", "", "5", True),
        ]},
        "std_msgs/msg/Header": {"message": [DefinedMember("frame_id", "string")]},
        "other_msgs/msg/Unused": {"message": [DefinedMember("unused", "string")]},
    }  # fmt: skip
    assert "Unused" not in draw(LARGE, "html", interfaces=interfaces), "what the graph does not use is left out"
    browser = page(LARGE, fragment="#show=topic+%2Fspace_0%2Ftopic_1", interfaces=interfaces)
    assert "Fields of nav_msgs/msg/Path" in texts(browser, "#panel h3")
    assert texts(browser, "#panel .fields > li") == ["header std_msgs/Header", "MAX int32 = 5"]
    browser.find_element("css selector", "#panel .fields summary").send_keys("\n")
    browser.execute_async_script("setTimeout(arguments[0], 50)")
    assert "frame_id string" in texts(browser, "#panel .fields .fields > li")


def test_places_open_in_the_editor(page):
    fragment = "#show=node+%2Fspace_0%2Fnode_number_0"
    browser = page(LARGE, fragment=fragment, **EDITOR)
    found = browser.execute_script(
        "return [...document.querySelectorAll('#panel a')].map((one) => one.getAttribute('href'))"
    )
    assert "vscode://file//home/a%20b/ws%231/src/package_0/src/node_0.cpp:20" in found
    assert f"vscode://file//home/a%20b/ws%231/{LAUNCHES[0]}:10" in found, "the launch file that starts it"
    browser = page(LARGE, fragment=fragment)
    assert browser.execute_script("return document.querySelectorAll('#panel a').length") == 0
    assert "src/package_0/src/node_0.cpp:20" in browser.find_element("id", "panel").text


def test_what_the_base_alone_has_is_no_link_into_the_files(page):
    one = LARGE.endpoints[0]
    base = structs.replace(LARGE, endpoints=(*LARGE.endpoints, structs.replace(one, topic="/gone", path="gone.cpp")))
    browser = page(LARGE, base, fragment="#show=topic+%2Fgone", **EDITOR)
    assert "gone.cpp:30" in texts(browser, "#panel span.place")
    assert browser.execute_script("return document.querySelectorAll('#panel a').length") == 0


def test_changes_against_a_base_are_seen_on_folded_groups(page):
    changed = structs.replace(LARGE.endpoints[0], qos=Qos("best_effort", written="rmw_qos_profile_sensor_data"))
    browser = page(structs.replace(LARGE, endpoints=(changed, *LARGE.endpoints[1:])), LARGE)
    assert [label for label in labels(browser) if label.endswith("changed")] == ["group /space_0, 20 nodes, changed"]


def test_every_control_is_reached_by_the_keyboard(page):
    from selenium.webdriver import Keys

    browser = page(LARGE)
    press(browser, "in")
    reached = set()
    browser.execute_script("document.activeElement.blur()")
    for _ in range(40):
        keys(browser, Keys.TAB)
        active = browser.switch_to.active_element
        reached.add(active.get_attribute("id") or active.get_attribute("class") or active.get_attribute("type"))
    wanted = {
        "search", "view", "group", "fold", "unfold", "launch", "package", "topic", "ends", "standard", "reset", "map",
        "in", "out", "fit", "theme",
    }  # fmt: skip
    assert wanted - reached == set()
    assert any(str(one).startswith("box group") for one in reached)


def test_the_layout_is_the_same_every_time(page):
    def places(browser):
        return browser.execute_script(
            "return [...document.querySelectorAll('.box[role]')].map((box) => box.getAttribute('transform'))"
        )

    assert places(page(LARGE, fragment="#group=none")) == places(page(LARGE, fragment="#group=none"))


def test_paper_shows_the_whole_graph(page):
    browser = page(LARGE, fragment="#group=none")
    browser.execute_script("dispatchEvent(new Event('beforeprint'))")
    room = browser.execute_script("return document.getElementById('drawing').viewBox.baseVal.width")
    widest = browser.execute_script("return document.getElementById('world').getBBox().width")
    assert room >= widest
    assert browser.execute_script("return document.getElementById('world').getAttribute('transform')") is None
    browser.execute_script("dispatchEvent(new Event('afterprint'))")
    assert browser.execute_script("return document.getElementById('drawing').getAttribute('viewBox')") is None


def test_a_click_on_a_node_shows_its_neighbours(page):
    browser = page(LARGE, fragment="#group=none&package=%3Dpackage_4")
    click(browser, "node /space_4/node_number_4")
    assert set(labels(browser, ".on")) == {
        "node /space_4/node_number_4", "topic /space_4/topic_8", "topic /space_4/topic_9",
    }  # fmt: skip

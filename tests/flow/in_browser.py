"""What tests of the page of the graph read from a browser, and do in it."""

import json


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


def overlapping(boxes):
    """Pairs of boxes (left, right, top, bottom) that share some ground."""
    return [
        (a, b)
        for n, a in enumerate(boxes)
        for b in boxes[:n]
        if a[0] < b[1] and b[0] < a[1] and a[2] < b[3] and b[2] < a[3]
    ]

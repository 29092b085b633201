"""Classes of OpenCV that Python does not make by a call, from a stub."""

import re

from rosimpact.databuild.opencv_python import find_makers, make_group

STUB = """
class Rope:
    @classmethod
    def create(cls, length: int = ...) -> Rope: ...
class Knot(Rope):
    def turn(self) -> None: ...
class Hook:
    def __init__(self) -> None: ...
    @classmethod
    def create(cls) -> Hook: ...
class Plain:
    def load(self) -> None: ...
def createKnot(turns: int = ...) -> Knot: ...
def createPlain() -> Rope: ...
"""


def test_classes_with_what_makes_them():
    assert find_makers(STUB) == {"Rope": "Rope_create", "Knot": "createKnot"}


def test_a_use_is_a_call_of_the_class_in_cv2():
    use = make_group({"Rope": "Rope_create"})["uses"]["cv2.Rope()"]
    assert re.search(use["before"] + use["word"], "x = cv2.Rope()") and use["help"] == "use `cv2.Rope_create`"

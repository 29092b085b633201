"""What becomes of uses of Python names on a target: gone, not there yet, refused, overridden, deprecated."""

from types import SimpleNamespace

import pytest
from rosimpact.databuild.extract.python import extract
from rosimpact.databuild.jobs import Packing
from rosimpact.databuild.surface.compare import RepositorySurfaces
from rosimpact.databuild.surface_file import write
from rosimpact.impact.facts.python.uses import CallArguments, PythonUse
from rosimpact.impact.targets.surface.offers import Offers
from rosimpact.impact.targets.surface.offers_python import (
    PythonOffers,
    explain_difference,
    explain_refusal,
    read_parameters,
)
from rosimpact.impact.targets.surface.store import Surfaces
from rosimpact.impact.targets.surface.surface import BuildSurface, InstalledModule, PythonSurface, Surface


@pytest.fixture
def offers(tmp_path):
    """A function that gives what a target offers whose `arm` has a version, of these modules in versions 1, 2, 3 ..."""

    def made(version, *versions, approximate=()):
        packing = Packing()
        for number, modules in enumerate(versions, 1):
            modules = {"arm": modules} if isinstance(modules, str) else modules
            python = PythonSurface(
                "arm",
                tuple(
                    InstalledModule(name, "", name == "arm", extract(text.encode())) for name, text in modules.items()
                ),
            )
            one = Surface("arm", f"{number}.0.0", BuildSurface("arm", f"{number}.0.0"), python)
            packing.add("arm", one.version, (2,), RepositorySurfaces({"arm": one}), one.version in approximate)
        drums = Surface("drums", "1.0.0", BuildSurface("drums", "1.0.0"), PythonSurface("drums", ()))  # without Python
        packing.add("drums", drums.version, (2,), RepositorySurfaces({"drums": drums}), False)
        write(tmp_path / "surfaces.sqlite", packing.pack_packages())
        target = SimpleNamespace(ros=2, find_version={"arm": version, "drums": "1.0.0"}.get)
        return PythonOffers(Offers(target, Surfaces(tmp_path / "surfaces.sqlite")))

    return made


def use(name, how="name", positional=0, keywords=(), parameters=""):
    given = CallArguments(positional, tuple(keywords)) if how in ("call", "method") else None
    return PythonUse(name, how, 1, 1, given, parameters)


def test_a_name_that_went_is_told_with_the_versions_around(offers):
    lost = offers("3.0.0", "def f(): pass", "def f(): pass", "").ask(use("arm.f"), ["arm"])
    assert (lost.state, lost.symbol.name, lost.since, lost.sure) == ("removed", "arm.f", "3.0.0", True)
    assert (lost.evidence.last, lost.evidence.first) == ("2.0.0", "3.0.0")


def test_a_name_that_comes_later_is_not_there_yet(offers):
    lost = offers("1.0.0", "", "", "def f(): pass").ask(use("arm.f"), ["arm"])
    assert (lost.state, lost.since) == ("not yet", "3.0.0")


def test_what_an_older_distro_got_and_this_one_not_yet_is_not_called_gone(offers):
    lost = offers("2.0.0", "def f(): pass", "", "def f(): pass").ask(use("arm.f"), ["arm"])
    assert (lost.state, lost.since) == ("not yet", "3.0.0")


def test_a_name_that_only_another_module_has_is_never_there(offers):
    version = {"arm": "", "arm.joint": "class Joint: pass", "arm.link": "class Link: pass"}
    of = offers("2.0.0", version, {**version, "arm.hand": ""}, version)
    lost = of.ask(use("arm.link.Joint"), ["arm"])
    assert (lost.state, lost.form, lost.sure) == ("not yet", "never", True)
    # A package of the same module that has no Python is not asked.
    assert of.ask(use("arm.link.Joint"), ["drums", "arm"]) == lost
    assert of.ask(use("arm.joint.Joint"), ["arm"]) is None
    open_module = {**version, "arm.link": "from elsewhere import *"}
    assert offers("2.0.0", open_module, open_module, version).ask(use("arm.link.Joint"), ["arm"]) is None


@pytest.mark.parametrize("name", ["arm.always", "arm.never", "other.f"])
def test_what_never_changed_or_never_was_is_not_spoken_of(offers, name):
    assert offers("2.0.0", "always = 1\ndef f(): pass", "always = 1").ask(use(name), ["arm"]) is None


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("arm.spin", True),
        ("arm.tool.spin", True),
        ("arm.tool.f", True),  # only another module has it
        ("arm.f", False),  # some version has had it somewhere
        ("arm.tool", False),
        ("arm.hand.spin", False),  # who knows where that module comes from
        ("arm.open.spin", False),
    ],
)
def test_an_import_of_what_no_version_has(offers, name, told):
    modules = {"arm": "def f(): pass", "arm.tool": "", "arm.open": "from elsewhere import *"}
    lost = offers("2.0.0", modules, {**modules, "arm": ""}).ask(use(name, "from"), ["arm"])
    assert (lost is not None and lost.form == "never") == told


def test_a_lost_module_is_told_for_what_lies_in_it(offers):
    known = offers("2.0.0", {"arm": "", "arm.old": "class C:\n  def m(self): pass"}, {"arm": ""})
    assert known.ask(use("arm.old.C.m", "member"), ["arm"]).symbol.name == "arm.old"


def test_a_member_is_found_by_any_path_to_its_class(offers):
    before = {"arm": "from arm.node import Node", "arm.node": "class Node:\n  def m(self): pass\n  def n(self): pass"}
    after = {"arm": "from arm.node import Node", "arm.node": "class Node:\n  def n(self): pass"}
    known = offers("2.0.0", before, after)
    assert known.ask(use("arm.node.Node.m", "method"), ["arm"]).symbol.name == "arm.node.Node.m"
    assert known.ask(use("arm.Node.m", "method"), ["arm"]).symbol.name == "arm.Node.m"
    assert known.ask(use("arm.Node.n", "method"), ["arm"]) is None


@pytest.mark.parametrize(
    "module",
    [
        "from elsewhere import Base\nclass C(Base): pass",  # a base of another package may have it
        "class C:\n  def __getattr__(self, name): pass",
        "from elsewhere import *",
        "from elsewhere import C",
    ],
)
def test_what_may_be_there_is_not_called_gone(offers, module):
    assert offers("2.0.0", "class C:\n  def m(self): pass", module).ask(use("arm.C.m", "method"), ["arm"]) is None


@pytest.mark.parametrize(
    ("how", "positional", "keywords", "state"),
    [
        ("call", 2, (), ("changed", "call", True)),
        ("call", 1, ("speed",), ("changed", "call", True)),
        ("call", 0, (), None),  # no version takes it
        ("call", 1, ("force",), ("changed", "call", False)),
        ("call", 1, (), None),
        ("name", 0, (), None),
    ],
)
def test_calls_are_measured_by_the_parameters(offers, how, positional, keywords, state):
    known = offers("2.0.0", "def f(a, speed=0): pass", "def f(a): pass", "def f(a, *, force=0): pass")
    lost = known.ask(use("arm.f", how, positional, keywords), ["arm"])
    assert (lost and (lost.state, lost.form, lost.earlier)) == state


def test_a_class_is_called_as_its_constructor(offers):
    old, new = "class C:\n  def __init__(self, a): pass", "class C:\n  def __init__(self, a, b): pass"
    lost = offers("2.0.0", old, new).ask(use("arm.C", "call", 1), ["arm"])
    assert (lost.form, lost.detail) == ("call", "`b` must be given")
    assert (lost.evidence.old, lost.evidence.new) == (("arm.C(a)",), ("arm.C(a, b)",))


def test_a_class_has_the_constructor_of_every_object(offers):
    known = offers("2.0.0", "class C:\n  def __init__(self): pass", "class C: pass")
    assert known.ask(use("arm.C.__init__", "call", 1), ["arm"]) is None


def test_a_method_called_by_its_class_is_left_alone(offers):
    known = offers("2.0.0", "class C:\n  def m(self, a): pass", "class C:\n  def m(self): pass")
    assert known.ask(use("arm.C.m", "call", 2), ["arm"]) is None
    assert known.ask(use("arm.C.m", "method", 1), ["arm"]).form == "call"


def test_a_decorator_that_is_not_known_may_change_the_parameters(offers):
    old, new = "@wrapped\ndef f(a): pass", "@wrapped\ndef f(a, b): pass"
    assert offers("2.0.0", old, new).ask(use("arm.f", "call", 1), ["arm"]) is None


def test_an_override_is_measured_by_what_the_base_class_is_called_with(offers):
    known = offers("2.0.0", "class C:\n  def m(self, a): pass", "class C:\n  def m(self, a, b): pass")
    assert known.ask(use("arm.C.m", "override", parameters="(a)"), ["arm"]).detail == "`b` is given to it and not taken"
    assert known.ask(use("arm.C.m", "override", parameters="(a, b)"), ["arm"]) is None
    assert known.ask(use("arm.C.m", "override", parameters="(*args)"), ["arm"]) is None


def test_a_deprecation_is_told_with_its_message(offers):
    module = "from typing_extensions import deprecated\n@deprecated('use g')\ndef f(): pass"
    lost = offers("2.0.0", "def f(): pass", module).ask(use("arm.f", "call"), ["arm"])
    assert (lost.state, lost.detail) == ("deprecated", "use g")


def test_what_a_branch_stands_for_is_not_spoken_of(offers):
    assert offers("2.0.0", "def f(): pass", "", approximate=["2.0.0"]).ask(use("arm.f"), ["arm"]) is None
    assert offers("2.0.0", "def f(): pass", "", approximate=["1.0.0"]).ask(use("arm.f"), ["arm"]) is None
    lost = offers("3.0.0", "def f(): pass", "", "", approximate=["2.0.0"]).ask(use("arm.f"), ["arm"])
    assert (lost.evidence.last, lost.evidence.first) == ("1.0.0", "3.0.0")


def test_between_two_stored_versions_only_what_both_say_is_told(offers):
    assert offers("2.5.0", "def f(): pass", "", "def f(): pass").ask(use("arm.f"), ["arm"]) is None
    assert offers("2.5.0", "def f(): pass", "", "").ask(use("arm.f"), ["arm"]).state == "removed"


@pytest.mark.parametrize(
    ("parameters", "positional", "keywords", "expected"),
    [
        ("(a, b=...)", 1, (), ""),
        ("(a, b=...)", 3, (), "it takes at most 2 arguments by position"),
        ("()", 1, (), "it takes no arguments by position"),
        ("(a, *args)", 5, (), ""),
        ("(a)", 0, ("a",), ""),
        ("(a, /)", 0, ("a",), "it has no parameter `a`"),
        ("(a)", 1, ("b",), "it has no parameter `b`"),
        ("(a, **more)", 1, ("b",), ""),
        ("(a)", 1, ("a",), "`a` is given by position and by name"),
        ("(*, k)", 0, (), "`k` must be given"),
    ],
)
def test_whether_a_call_fits(parameters, positional, keywords, expected):
    assert explain_refusal(CallArguments(positional, keywords), read_parameters(parameters)) == expected


@pytest.mark.parametrize(
    ("own", "base", "fits"),
    [
        ("(a)", "(a)", True),
        ("(b)", "(a)", True),
        ("(a)", "(a, b=...)", True),
        ("(a)", "(a, b)", False),
        ("(a, b)", "(a)", False),
        ("(a, b=...)", "(a)", True),
        ("(a)", "(a, *, k)", False),
        ("(a, **more)", "(a, *, k)", True),
    ],
)
def test_whether_a_method_can_stand_for_anothers(own, base, fits):
    assert (explain_difference(read_parameters(own), read_parameters(base)) == "") is fits

"""Names that branches on the distro bind, and files that are named by it."""

import ast

import pytest
from rosimpact.impact.facts.python.branches import list_branched_names, list_compared_distros, list_distro_files

HEAD = 'import os\ndistro = os.environ["ROS_DISTRO"]\n'
# (text behind HEAD, (name, line, number of branches) of each)
NAMES = [
    ('if distro == "humble":\n    a = 1\nprint(a)\n', [("a", 5, 1)]),
    ('if distro == "humble":\n    a = 1\nelse:\n    a = 2\nprint(a)\n', []),
    ('if distro == "humble":\n    a = 1\nelse:\n    raise RuntimeError\nprint(a)\n', []),
    ('if distro == "humble":\n    a = 1\nelif distro == "foxy":\n    os._exit(1)\nprint(a)\n', [("a", 7, 2)]),
    ('if distro == "humble":\n    import a.b as c\n    from d import e\nprint(c, e)\n', [("c", 6, 1), ("e", 6, 1)]),
    # other tests, other bindings, uses that some ways alone reach
    ('if distro.startswith("h"):\n    a = 1\nprint(lambda: a)\n', []),
    ('if os.name == "nt":\n    a = 1\nprint(a)\n', []),
    ('a = 0\nif distro == "humble":\n    a = 1\nprint(a)\n', []),
    ('if distro == "humble":\n    a = 1\nif a:\n    print(a)\nprint(1 and a)\n', []),
    ('if distro == "humble":\n    a = 1\nfor a in ():\n    pass\nprint(a)\n', []),
    ('if distro == "humble":\n    a = 1\ndef f():\n    global a\n    a = 2\nf()\nprint(a)\n', []),
    ('if distro == "humble":\n    a = 1\nfrom b import *\nprint(a)\n', []),
    # functions
    ('def f():\n    if distro == "humble":\n        a = 1\n    return a\n', [("a", 6, 1)]),
    ('def f(a):\n    if distro == "humble":\n        a = 1\n    return a\n', []),
]


@pytest.mark.parametrize(("text", "expected"), NAMES)
def test_names_of_branches_on_the_distro(text, expected):
    found = list_branched_names(ast.parse(HEAD + text))
    assert [(one.name, one.line, len(one.branches)) for one in found] == expected


# (expression, path)
FILES = [
    ('os.path.join(share, "config", distro + ".yaml")', "config/{distro}.yaml"),
    ('f"{share}/config/{distro}/robot.yaml"', "config/{distro}/robot.yaml"),
    ('Path(share) / "config" / f"{distro}.yaml"', "config/{distro}.yaml"),
    ('PathJoinSubstitution([share, "a", [EnvironmentVariable("ROS_DISTRO"), ".yaml"]])', "a/{distro}.yaml"),
    ('os.path.join(share, "config", name + distro + ".yaml")', None),
    ('os.path.join(share, "config", name + (distro + ".yaml"))', None),
    ('"/opt/ros/" + distro', None),
    ("distro + suffix", None),
    ('os.path.exists(share + "/" + distro + ".yaml")', None),
]


@pytest.mark.parametrize(("expression", "path"), FILES)
def test_files_that_are_named_by_the_distro(expression, path):
    found = list_distro_files(ast.parse(f"{HEAD}x = {expression}\n"))
    assert [one.name for one in found] == ([] if path is None else [path])


def test_long_and_deep_code_is_not_followed():
    chain = "".join(f'elif distro == "{number}":\n    a = {number}\n' for number in range(900))
    assert list(list_branched_names(ast.parse(f'{HEAD}if distro == "x":\n    a = 1\n{chain}print(a)\n'))) == []
    deep = " + ".join([*["'.'"] * 300, "distro", "'.yaml'"])
    assert list(list_distro_files(ast.parse(f"{HEAD}x = {deep}\n"))) == []


START = "Node()"
# (text behind HEAD, (kind, name, line, number of branches) of each)
OTHERS = [
    (f'if distro == "a":\n    {START}\nelif distro == "b":\n    {START}\n', [("start", "ROS_DISTRO", 3, 2)]),
    (f'if distro == "a":\n    {START}\nelif distro == "b":\n    {START}\nelse:\n    pass\n', []),
    (f'if distro == "a":\n    {START}\nelif distro == "b":\n    print()\n', []),
    (f'if distro == "a":\n    {START}\nelif c:\n    {START}\n', []),
    (f'if distro == "a":\n    {START}\n', []),
    # What is bound and used tells it already.
    ('if distro == "a":\n    n = Node()\nelif distro == "b":\n    n = Node()\nprint(n)\n', [("name", "n", 7, 2)]),
    ('print({"a": 1, "b": 2}[distro])\n', [("key", "ROS_DISTRO", 3, 2)]),
    ('t = {"a": 1}\ndef f():\n    return t[os.environ["ROS_DISTRO"]]\n', [("key", "t", 5, 1)]),
    ('t = {"a": 1, **u}\nprint(t[distro])\n', []),
    ('t = {"a": 1}\nt["b"] = 2\nprint(t[distro])\n', []),
    ('t = {"a": 1}\nt.update(u)\nprint(t[distro])\n', []),
    ('t = {"a": 1}\nfill(t)\nprint(t[distro])\n', []),
    ('t = {"a": 1}\nif distro not in t:\n    raise SystemExit\nprint(t[distro])\n', []),
    ('t = {"a": 1}\ntry:\n    print(t[distro])\nexcept KeyError:\n    pass\n', []),
    ('t = {"a": 1}\nprint(t[other])\n', []),
]


@pytest.mark.parametrize(("text", "expected"), OTHERS)
def test_what_is_started_or_looked_up_by_the_distro(text, expected):
    found = list_branched_names(ast.parse(HEAD + text))
    assert [(one.kind, one.name, one.line, len(one.branches)) for one in found] == expected


def test_names_that_the_distro_is_compared_with():
    tests = ('distro in ("a", "b")', '"c" != os.getenv("ROS_DISTRO")', 'distro.lower() == "d"', 'name == "e"')
    assert [one.name for one in list_compared_distros(ast.parse(HEAD + "\n".join(tests)))] == ["a", "b", "c"]

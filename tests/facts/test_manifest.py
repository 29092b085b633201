"""package.xml to facts."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rosimpact.impact.facts.manifest import Dependency, extract
from rosimpact.impact.facts.markup import unescape

HEAD = """<?xml version="1.0"?>
<package format="{format}">
  <name>walker</name>
  <version>1.2.3</version>
  <description>Walks.</description>
  <maintainer email="a@b.org">A</maintainer>
  <license>BSD</license>
"""


def manifest(format_, *lines):
    """A valid manifest whose own lines start at line 8."""
    return (HEAD.format(format=format_) + "\n".join(lines) + "\n</package>\n").encode()


def pairs(facts):
    return [(d.name, d.kind, d.tag, d.line) for d in facts.dependencies]


KINDS = [
    (1, "build_depend", ["build"]),
    (1, "run_depend", ["build_export", "exec"]),
    (1, "buildtool_depend", ["buildtool"]),
    (1, "test_depend", ["test"]),
    (1, "conflict", ["conflict"]),
    (2, "depend", ["build", "build_export", "exec"]),
    (2, "build_depend", ["build"]),
    (2, "build_export_depend", ["build_export"]),
    (2, "buildtool_depend", ["buildtool"]),
    (2, "buildtool_export_depend", ["buildtool_export"]),
    (2, "exec_depend", ["exec"]),
    (2, "test_depend", ["test"]),
    (2, "doc_depend", ["doc"]),
    (3, "replace", ["replace"]),
    (3, "group_depend", ["group"]),
    (3, "member_of_group", ["member_of_group"]),
]


@pytest.mark.parametrize(("format_", "tag", "kinds"), KINDS)
def test_a_tag_stands_for_kinds(format_, tag, kinds):
    facts = extract(manifest(format_, f"  <{tag}>legs</{tag}>"))
    assert pairs(facts) == [("legs", kind, tag, 8) for kind in kinds]
    assert facts.problems == ()
    assert (facts.name, facts.version, facts.format, facts.line) == ("walker", "1.2.3", format_, 3)


def test_condition_bounds_and_column():
    facts = extract(
        manifest(
            3, '  <exec_depend condition="$ROS_VERSION == 2 and $X &lt; 3"', '    version_gte="1.0">a</exec_depend>'
        )
    )
    assert facts.dependencies == (
        Dependency("a", "exec", "exec_depend", 9, 23, "$ROS_VERSION == 2 and $X < 3", (("version_gte", "1.0"),)),
    )


def test_commented_dependencies_do_not_count():
    assert (
        extract(manifest(2, "<!-- <depend>a</depend> -->", "<depend>b<!-- x --></depend>")).dependencies[0].name == "b"
    )


def test_exports():
    facts = extract(
        manifest(
            3,
            "<export>",
            '<build_type condition="$ROS_VERSION == 1">catkin</build_type>',
            '<build_type condition="$ROS_VERSION == 2">ament_cmake</build_type>',
            '<nav_core plugin="${prefix}/p.xml"/>',
            "<architecture_independent/>",
            "<deprecated>old</deprecated>",
            "</export>",
        )
    )
    assert facts.build_types == (("catkin", "$ROS_VERSION == 1"), ("ament_cmake", "$ROS_VERSION == 2"))
    assert [(e.tag, e.attributes, e.text, e.line) for e in facts.exports[2:]] == [
        ("nav_core", {"plugin": "${prefix}/p.xml"}, "", 11),
        ("architecture_independent", {}, "", 12),
        ("deprecated", {}, "old", 13),
    ]
    assert facts.deprecated
    assert not facts.metapackage


def test_metapackage_without_catkin_is_warned_of():
    facts = extract(manifest(1, "<run_depend>a</run_depend>", "<export><metapackage/></export>"))
    assert facts.metapackage
    assert facts.problems == ()
    assert [w.message for w in facts.warnings] == ["metapackage `walker` must buildtool_depend on catkin"]


PROBLEMS = [
    (manifest(2, "<build-depend>a</build-depend>"),
     [(8, "`<build-depend>` is no tag of manifest format 2; `<build_depend>` is")]),
    (manifest(2, "<run_depend>a</run_depend>"),
     [(8, "`<run_depend>` is no tag of manifest format 2, which calls it `<exec_depend>`")]),
    (manifest(1, "<exec_depend>a</exec_depend>"),
     [(8, "`<exec_depend>` is no tag of manifest format 1, it needs format 2")]),
    (manifest(2, "<group_depend>a</group_depend>"),
     [(8, "`<group_depend>` is no tag of manifest format 2, it needs format 3")]),
    (manifest(2, "<buid_depend>a</buid_depend>"),
     [(8, "`<buid_depend>` is no tag of manifest format 2; `<build_depend>` is")]),
    (manifest(2, "<rosdoc/>"),
     [(8, "`<rosdoc>` is no tag of manifest format 2")]),
    (manifest(2, '<depend condition="1">a</depend>'),
     [(8, "the `depend` tag must not have the following attributes: condition")]),
    (manifest(2, "<depend>a</depend>", "<exec_depend>a</exec_depend>"),
     [(8, "the generic dependency on `a` is redundant")]),
    (manifest(2, "<depend>walker</depend>"),
     [(8, "the package `walker` must not")]),
    (manifest(4),
     [(1, "manifest format `4` is none of 1, 2 and 3")]),
    (manifest("two"),
     [(1, "catkin_pkg cannot read it: ValueError")]),
    (manifest(2).replace(b"1.2.3", b"1.2"),
     [(4, "package version `1.2` does not follow version conventions")]),
    (manifest(2).replace(b"a@b.org", b"nobody"),
     [(6, "invalid email `nobody`")]),
    (manifest(2).replace(b"  <license>BSD</license>\n", b""),
     [(2, "the package node must contain at least one `license` tag")]),
    (manifest(2, "<depend>a</dep>"),
     [(8, "not well-formed XML: mismatched tag")]),
    (b"", [(1, "not well-formed XML: no element found")]),
    (b"<robot/>", [(1, "has no `<package>` element")]),
    (b"\xff\xfe\x00", [(1, "not well-formed XML")]),
]  # fmt: skip


@pytest.mark.parametrize(("data", "expected"), PROBLEMS)
def test_what_build_tools_refuse_is_a_problem_with_its_line(data, expected):
    found = extract(data).problems
    assert [p.line for p in found][: len(expected)] == [line for line, _ in expected]
    for problem, (_, message) in zip(found, expected, strict=False):
        assert problem.message.startswith(message)


COLUMNS = [
    ("  <build-depend>a</build-depend>", 4),
    ("<depend>a</depend><depend>a</depend>", 9),
    ("  <maintainer email='nobody'>A</maintainer>", 30),
    (" <depend>a</depend><", 21),
]


@pytest.mark.parametrize(("line", "column"), COLUMNS)
def test_problems_have_the_column_of_their_element(line, column):
    found = extract(manifest(3, line)).problems
    assert found[0].column == column


def test_exports_and_the_name_have_their_columns():
    facts = extract(manifest(3, "<export>", "  <build_type> ament_cmake</build_type>", "  <rviz a='1'",
                             "    plugin='${prefix}/x.xml'/>", "</export>"))  # fmt: skip
    assert (facts.line, facts.column) == (3, 9)
    assert [(e.line, e.column) for e in facts.exports] == [(9, 16), (10, 4)]
    assert facts.exports[1].places == {"a": (10, 12), "plugin": (11, 13)}


def test_unknown_tags_are_listed_and_plain_ones_still_understood():
    facts = extract(manifest(2, "<build-depend>a</build-depend>", "<rosdoc>b</rosdoc>"))
    assert facts.unknown_tags == (("build-depend", "a", 8, 2), ("rosdoc", "b", 9, 2))
    assert pairs(facts) == [("a", "build", "build-depend", 8)]


def test_a_broken_file_is_read_on():
    facts = extract(
        manifest(2, "<depend>a</depend>", "<depend>b", "<exec_depend>c</exec_depend>", "<depend>d</depend>")
    )
    assert facts.name == "walker"
    assert {d.name for d in facts.dependencies} == {"a", "b", "c", "d"}
    assert len(facts.problems) == 1


BOMB = b"""<?xml version="1.0"?>
<!DOCTYPE package [
<!ENTITY a "aaaaaaaaaa">
<!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;&a;&a;">
<!ENTITY c SYSTEM "file:///etc/passwd">
]>
<package format="2"><name>p</name><version>&b;</version><depend>&c;</depend></package>
"""


def test_entities_are_refused_and_not_expanded():
    facts = extract(BOMB)
    assert [p.message for p in facts.problems] == ["defines XML entities, which are not expanded"]
    assert (facts.name, facts.version) == ("p", "&b;")


SNIPPETS = st.sampled_from(
    ["<package>", '<package format="3">', "</package>", "<name>p</name>", "<depend>a", "</depend>", "<export>", "\n",
     "</export>", '<depend version_gte="1', '">', "<!--", "-->", "<![CDATA[", "]]>", "<?x", "&lt;", "&#0;", "é", "<a/>",
     "<build_type>"]
)  # fmt: skip


@given(st.one_of(st.binary(max_size=200), st.lists(SNIPPETS, max_size=20).map(lambda parts: "".join(parts).encode())))
def test_never_raises_and_lines_lie_in_the_file(data):
    facts = extract(data)
    last = data.count(b"\n") + 1
    lines = [facts.line, *(d.line for d in facts.dependencies), *(p.line for p in facts.problems + facts.warnings)]
    assert all(1 <= line <= last for line in [*lines, *(e.line for e in facts.exports)])


ODDITIES = [
    ("Walks.", ""),
    ("Walks.", "<p>Walks.</p>"),
    ("Walks.", "<!-- no -->"),
    ("BSD", ""),
    (">A<", "><b>A</b><"),
    (">A<", "><"),
    ("walker", "<![CDATA[walker]]>"),
    ("<license>", '<license file="LICENSE">'),
    ("<version>", '<version compatibility="1">'),
    ("<version>", '<version compatibility="1.0.0">'),
    ("<license>", "<name>again</name><license>"),
    ("<license>", "<export/><export/><license>"),
    ("<license>", '<depend version_gte="1" version_is="2">a</depend><license>'),
    ("<license>", "<depend>a<b/></depend><license>"),
    ("<license>", "<url>x</url><url type='y'/><license>"),
    ("<license>", "<author/><license>"),
    ("<license>", "<group_depend>g</group_depend><member_of_group>g</member_of_group><license>"),
    ("<license>", "<export><metapackage/></export><license>"),
    ("<license>", "<buildtool_depend>catkin</buildtool_depend><export><metapackage/></export><license>"),
    ("<package", "<x><package"),
    ("<package", '<package xmlns="urn:x"'),
]


def agrees(data):
    """Asserts that problems and warnings are there when catkin_pkg has any, and only then."""
    from catkin_pkg.package import InvalidPackage, parse_package_string

    warnings: list[str] = []
    try:
        parse_package_string(data, warnings=warnings)
        accepted = True
    except InvalidPackage:
        accepted = False
    facts = extract(data)
    assert (not facts.problems) == accepted
    if accepted:
        assert len(facts.warnings) == len(warnings)


@pytest.mark.parametrize("format_", [1, 2, 3])
@pytest.mark.parametrize(("old", "new"), ODDITIES)
def test_odd_manifests_are_judged_as_catkin_pkg_judges(format_, old, new):
    agrees(manifest(format_).replace(old.encode(), new.encode()))


@given(
    st.sampled_from([1, 2, 3]),
    st.lists(st.tuples(st.sampled_from(sorted({tag for _, tag, _ in KINDS})), st.sampled_from("ab")), max_size=4),
    st.sampled_from(["walker", "Walker", "a b", ""]),
    st.sampled_from(["1.2.3", "01.2.3", "1", ""]),
    st.sampled_from(["a@b.org", "a@b", "", "a.b@c.d.org"]),
)
def test_the_short_way_agrees_with_catkin_pkg(format_, dependencies, name, version, email):
    data = manifest(format_, *(f"<{tag}>{text}</{tag}>" for tag, text in dependencies))
    data = (
        data.replace(b"walker", name.encode()).replace(b"1.2.3", version.encode()).replace(b"a@b.org", email.encode())
    )
    agrees(data)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("&#65;&#x42;&lt;&amp;", "AB<&"),
        ("&#xE000;&#x10FFFF;", "\ue000\U0010ffff"),
        # no characters
        *((text, text) for text in ("&#xD800;", "&#xDFFF;", "&#x110000;", "&other; a & b")),
    ],
)
def test_references_to_characters(text, expected):
    assert unescape(text) == expected

"""`rosimpact graph` on workspaces as they are on disk and in git."""

import json
import subprocess
from pathlib import Path
from textwrap import dedent

import pytest
from rosimpact.impact.cli.app import app
from typer.testing import CliRunner

TALKER = """
    #include <rclcpp/rclcpp.hpp>
    #include <std_msgs/msg/string.hpp>
    class Talker : public rclcpp::Node {
     public:
      Talker() : Node("talker") {
        pub_ = create_publisher<std_msgs::msg::String>(declare_parameter("topic", "chatter"), 10);
        timer_ = create_wall_timer(1s, [this]() { pub_->publish(message_); });
      }
      rclcpp::Publisher<std_msgs::msg::String>::SharedPtr pub_;
      std_msgs::msg::String message_;
    };
    int main(int argc, char** argv) { rclcpp::spin(std::make_shared<Talker>()); }
"""
LISTENER = """
    import rclpy
    from rclpy.node import Node
    from std_msgs.msg import String

    class Listener(Node):
        def __init__(self):
            super().__init__("listener")
            self.create_subscription(String, "chatter", self.hear, 10)

        def hear(self, message):
            pass

    def main():
        rclpy.spin(Listener())
"""
CMAKE = """
    cmake_minimum_required(VERSION 3.16)
    project(talk)
    find_package(ament_cmake REQUIRED)
    find_package(rclcpp REQUIRED)
    add_executable(talker_node src/talker.cpp)
    install(TARGETS talker_node DESTINATION lib/${PROJECT_NAME})
    ament_package()
"""
SETUP = """
    from setuptools import setup
    setup(name="hear", packages=["hear"], entry_points={"console_scripts": ["hear_node = hear.node:main"]})
"""
LAUNCH = """
    <launch>
      <arg name="where" default="front"/>
      <node pkg="talk" exec="talker_node" name="speaker" namespace="$(var where)">
        <param name="topic" value="speech"/>
      </node>
      <node pkg="hear" exec="hear_node"><remap from="chatter" to="front/speech"/></node>
    </launch>
"""


def manifest(name: str, kind: str) -> str:
    return (
        f'<?xml version="1.0"?><package format="3"><name>{name}</name><version>1.0.0</version>'
        '<description>x</description><maintainer email="a@b.org">a</maintainer><license>MIT</license>'
        f"<buildtool_depend>{kind}</buildtool_depend><export><build_type>{kind}</build_type></export></package>"
    )


@pytest.fixture
def ws(tmp_path: Path) -> Path:
    files = {
        "src/talk/package.xml": manifest("talk", "ament_cmake"),
        "src/talk/CMakeLists.txt": CMAKE,
        "src/talk/src/talker.cpp": TALKER,
        "src/talk/launch/talk.launch.xml": LAUNCH,
        "src/hear/package.xml": manifest("hear", "ament_python"),
        "src/hear/setup.py": SETUP,
        "src/hear/hear/__init__.py": "",
        "src/hear/hear/node.py": LISTENER,
    }
    for name, text in files.items():
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(dedent(text).lstrip())
    return tmp_path


def run(*arguments: object) -> tuple[int, str, str]:
    result = CliRunner().invoke(app, ["graph", *map(str, arguments)])
    return result.exit_code, result.stdout, result.stderr


def edges(text: str) -> set[tuple[str, str, str]]:
    found = json.loads(text)
    return {
        (each["node"], role.removesuffix("s"), each["topic"])
        for role in ("publishers", "subscribers")
        for each in found[role]
        if not each["implied"]
    }


def test_a_system_has_the_names_that_its_launch_files_give(ws):
    code, out, _ = run(ws, "-f", "json")
    assert code == 0
    assert edges(out) == {
        ("/front/speaker", "publisher", "/front/speech"),
        ("/listener", "subscriber", "/front/speech"),
    }


def test_what_no_launch_file_starts_has_the_names_of_its_code(ws):
    launch = ws / "src/talk/launch/talk.launch.xml"
    launch.write_text(launch.read_text().replace('<node pkg="hear" exec="hear_node">', '<node pkg="hear" exec="gone">'))
    assert edges(run(ws, "-f", "json")[1]) == {
        ("/front/speaker", "publisher", "/front/speech"),
        ("hear/hear_node", "subscriber", "/chatter"),
    }


def test_what_a_launch_file_leaves_open_stands_in_brackets(ws):
    launch = ws / "src/talk/launch/talk.launch.xml"
    launch.write_text(launch.read_text().replace('default="front"', ""))
    found = json.loads(run(ws, "-f", "json")[1])
    ((name, how),) = {(each["topic"], each["how"]) for each in found["publishers"] if not each["implied"]}
    assert (name, how) == ("/<where>/speech", "partly")


def test_nodes_are_told_by_what_is_built_and_installed(ws):
    code, out, _ = run(ws, "--code", "-f", "json")
    assert code == 0
    assert edges(out) == {("talk/talker_node", "publisher", "/chatter"), ("hear/hear_node", "subscriber", "/chatter")}
    names = {node["id"]: (node["name"], node["kind"], node["language"]) for node in json.loads(out)["nodes"]}
    assert names == {
        "talk/talker_node": ("/talker", "executable", "cpp"),
        "hear/hear_node": ("/listener", "script", "python"),
    }


def test_a_node_tells_the_launch_files_that_start_it(ws):
    other = ws / "src/talk/launch/other.launch.xml"
    other.write_text('<launch><include file="$(find-pkg-share talk)/launch/talk.launch.xml"/></launch>')
    third = ws / "src/talk/launch/third.launch.xml"
    third.write_text('<launch><node pkg="hear" exec="hear_node"/></launch>')
    nodes = {node["name"]: node for node in json.loads(run(ws, "-f", "json")[1])["nodes"]}
    folder = "src/talk/launch"
    assert nodes["/front/speaker"]["launches"] == [f"{folder}/other.launch.xml"], "what another includes is no system"
    assert nodes["/listener"]["launches"] == [f"{folder}/other.launch.xml", f"{folder}/third.launch.xml"]
    assert nodes["/front/speaker"]["started"] == f"{folder}/talk.launch.xml:3", "a path in the workspace"


@pytest.mark.parametrize("text", ["", "no XML", '<package format="3"><name>talk</name><version>0.1', "<package/>"])
def test_a_manifest_that_colcon_refuses_is_told(ws, tmp_path, text):
    assert "refuse" not in run(ws)[2]
    (ws / "src/talk/package.xml").write_text(text)
    code, out, err = run(ws)
    assert (code, "/speech" in out) == (0, True)
    assert err.startswith("rosimpact: src/talk/package.xml:1: ") and "nodes may be missing" in err
    (tmp_path / "alone").mkdir()
    (tmp_path / "alone/package.xml").write_text(text)
    code, out, err = run(tmp_path / "alone")
    assert (code, out) == (2, "")
    assert "no package could be read (package.xml:1: " in err


def find_data(text: str) -> dict:
    return json.loads(text.partition('id="data">')[2].partition("</script>")[0])


def test_the_page_has_the_fields_of_the_types_that_the_graph_uses(ws):
    folder = ws / "src/own_msgs"
    for name, text in {
        "package.xml": manifest("own_msgs", "ament_cmake"),
        "CMakeLists.txt": 'project(own_msgs)\nrosidl_generate_interfaces(own_msgs "msg/Mood.msg" "msg/Other.msg")\n',
        "msg/Mood.msg": "int32 GOOD=1\nint32 mood 1\nstd_msgs/Header header\nPart[] parts\n",
        "msg/Part.msg": "string<=10 text\n",
        "msg/Other.msg": "string text\n",
    }.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)
    source = ws / "src/talk/src/talker.cpp"
    source.write_text(source.read_text().replace("std_msgs::msg::String", "own_msgs::msg::Mood"))
    data = find_data(run(ws, "-f", "html")[1])
    assert data["interfaces"]["own_msgs/msg/Mood"] == {"message": [
        ["GOOD", "int32", "", "1", True], ["mood", "int32", "", "1", False],
        ["header", "std_msgs/Header", "std_msgs/msg/Header", "", False],
        ["parts", "Part[]", "own_msgs/msg/Part", "", False],
    ]}  # fmt: skip
    assert data["interfaces"]["own_msgs/msg/Part"] == {"message": [["text", "string<=10", "", "", False]]}
    assert "frame_id" in [member[0] for member in data["interfaces"]["std_msgs/msg/Header"]["message"]], "as released"
    assert "own_msgs/msg/Other" not in data["interfaces"]


@pytest.mark.parametrize(
    ("options", "editor"),
    [
        ([], "vscode://file/{path}:{line}"),
        (["--editor", "idea://open?file={path}&line={line}"], "idea://open?file={path}&line={line}"),
        (["--editor", "off"], ""),
    ],
)
def test_the_page_links_into_the_editor(ws, options, editor):
    data = find_data(run(ws, "-f", "html", *options)[1])
    assert (data["editor"], data["folder"]) == (editor, str(ws.resolve()))


@pytest.mark.parametrize("pattern", ["", "vim", "javascript:alert('{path}')", "data:text/html,{path}", "vscode://file"])
def test_an_editor_that_is_no_address_is_refused(ws, pattern):
    code, _, err = run(ws, "-f", "html", "--editor", pattern)
    assert code == 2
    help = "write an address such as vscode://file/{path}:{line}, or off for no links"
    assert err == f"rosimpact: --editor {pattern}: {help}\n"


def test_a_launch_file_gives_names_parameters_and_remappings(ws):
    code, out, _ = run(ws, "--launch", "talk.launch.xml", "-f", "json")
    assert code == 0
    assert edges(out) == {
        ("/front/speaker", "publisher", "/front/speech"),
        ("/listener", "subscriber", "/front/speech"),
    }
    code, out, _ = run(ws, "--launch", "talk.launch.xml", "--set", "where:=rear", "-f", "json")
    assert ("/rear/speaker", "publisher", "/rear/speech") in edges(out)


def test_an_argument_that_the_launch_file_does_not_declare_is_told(ws):
    code, _, err = run(ws, "--launch", "talk.launch.xml", "--set", "wehre:=rear", "-f", "json")
    assert code == 0
    assert "--set wehre: `src/talk/launch/talk.launch.xml` has no such argument; it declares `where`" in err
    assert "no such argument" not in run(ws, "--launch", "talk.launch.xml", "--set", "where:=rear")[2]


TWO = ["--launch", "talk/launch/talk.launch.xml where:=rear", "--launch", "hear.launch.xml"]


def write_second_launch(ws: Path) -> None:
    (ws / "src/hear/launch").mkdir()
    (ws / "src/hear/launch/hear.launch.xml").write_text(
        '<launch><arg name="to" default="rear/speech"/><node pkg="hear" exec="hear_node" name="second">'
        '<remap from="chatter" to="$(var to)"/></node></launch>'
    )


def test_several_launch_files_start_one_system(ws):
    write_second_launch(ws)
    both = {("/rear/speaker", "publisher", "/rear/speech"), ("/listener", "subscriber", "/front/speech")}
    assert edges(run(ws, *TWO, "-f", "json")[1]) == both | {("/second", "subscriber", "/rear/speech")}
    found = json.loads(run(ws, *TWO, "--set", "to:=a, b", "-f", "json")[1])
    assert found["coverage"]["calls"] == json.loads(run(ws, "-f", "json")[1])["coverage"]["calls"]
    assert edges(run(ws, *TWO, "--set", "to:=other", "-f", "json")[1]) == both | {("/second", "subscriber", "/other")}


def test_one_node_that_two_launch_files_start_is_shown_once(ws):
    found = json.loads(run(ws, *["--launch", "talk.launch.xml"] * 2, "-f", "json")[1])
    assert [node["id"] for node in found["nodes"]] == ["/front/speaker", "/listener"]


def test_a_system_is_named_in_the_configuration(ws):
    write_second_launch(ws)
    (ws / "rosimpact.toml").write_text(
        '[systems.robot]\nlaunch = ["talk/launch/talk.launch.xml where:=rear", "hear.launch.xml"]\n'
        'arguments = { to = "other", where = "top" }\n'
    )
    code, out, err = run(ws, "--system", "robot", "-f", "json")
    assert (code, err) == (0, "")
    assert edges(out) == {
        ("/rear/speaker", "publisher", "/rear/speech"),
        ("/listener", "subscriber", "/front/speech"),
        ("/second", "subscriber", "/other"),
    }
    _, out, _ = run(ws, "--system", "robot", "--set", "to:=third", "-f", "json")
    assert ("/second", "subscriber", "/third") in edges(out)


SYSTEMS = {
    "unknown": ('launch = ["talk.launch.xml"]', "other", "has no [systems.other]; known are `robot`"),
    "no file": ('launch = ["none.launch"]', "robot", "--system robot: none.launch: no such file in the workspace"),
    "no launch files": ("", "robot", "[systems.robot] needs `launch`"),
    "another key": ('launch = ["talk.launch.xml"]\nlunch = 1', "robot", "[systems.robot] has no `lunch`"),
    "arguments in a list": ('launch = ["talk.launch.xml"]\narguments = []', "robot", "`arguments` must be a table"),
}


@pytest.mark.parametrize(("table", "asked", "said"), SYSTEMS.values(), ids=SYSTEMS)
def test_a_system_that_cannot_be_shown_is_told_in_a_line(ws, table, asked, said):
    (ws / "rosimpact.toml").write_text(f"[systems.robot]\n{table}\n")
    code, out, err = run(ws, "--system", asked)
    assert (code, out, err.count("\n")) == (2, "", 1)
    assert said in err


def test_strict_fails_where_a_name_is_not_known(ws):
    assert run(ws, "--strict")[::2] == (0, "")
    source = ws / "src/hear/hear/node.py"
    whole = source.read_text()
    source.write_text(whole.replace('"chatter"', "open('names').read()"))
    code, out, err = run(ws, "--strict")
    assert (code, "2 nodes" in out) == (1, True)
    assert "src/hear/hear/node.py:8: subscriber name" in err
    assert "1 API call whose name or type is not fully known" in err
    assert run(ws, "--strict", "--package", "talk")[0] == 0
    source.write_text(whole)
    launch = ws / "src/talk/launch/talk.launch.xml"
    launch.write_text(launch.read_text().replace('default="front"', ""))
    code, _, err = run(ws, "--strict")
    assert code == 1
    assert "known in part only, as `/<where>/speech`" in err
    assert run(ws, "--strict", "--launch", "talk.launch.xml where:=rear")[0] == 0


def test_strict_does_not_ask_about_nodes_of_other_packages(ws):
    launch = ws / "src/talk/launch/talk.launch.xml"
    launch.write_text(launch.read_text().replace("</launch>", '<node pkg="elsewhere" exec="x"/></launch>'))
    assert run(ws, "--strict", "--launch", "talk.launch.xml")[0] == 0


def test_beside_a_base(ws):
    def git(*arguments: str) -> None:
        settings = ["-c", "user.name=a", "-c", "user.email=a@b.org", "-c", "init.defaultBranch=main"]
        subprocess.run(["git", *settings, *arguments], cwd=ws, check=True, capture_output=True)

    git("init")
    git("add", "-A")
    git("commit", "-m", "first")
    source = ws / "src/talk/src/talker.cpp"
    source.write_text(source.read_text().replace("pub_->publish", "if (ready_) pub_->publish"))
    code, out, _ = run(ws, "--base", "HEAD")
    assert code == 0
    assert "~ publishes   /front/speaker" in out
    assert "changed: guards" in out
    code, out, _ = run(ws, "--rev", "HEAD")
    assert "when ready_" not in out
    data = find_data(run(ws, "--rev", "HEAD", "-f", "html")[1])
    assert data["editor"] == "", "the files on disk are others"


def test_an_unchanged_workspace_is_not_joined_again(ws, monkeypatch):
    first = run(ws)
    monkeypatch.setattr("rosimpact.impact.model.flow.workspace.join_code", lambda *_: pytest.fail("joined again"))
    assert run(ws) == first


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--format", "png"], "--format png: unknown"),
        (["--launch", "none.launch"], "--launch none.launch: no such file"),
        (["--set", "a:=1"], "name it with --launch"),
        (["--system", "robot"], "rosimpact.toml has no [systems.robot]; add it with its launch files"),
        (["--system", "robot", "--launch", "talk.launch.xml"], "leave out --system or --launch"),
        (["--launch", "talk.launch.xml", "--set", "a"], "write NAME:=VALUE"),
        (["--node", "talkr"], "`talkr`: no node of this name"),
        (["--base", "nowhere"], "no base to compare with"),
    ],
)
def test_what_cannot_be_drawn(ws, arguments, said):
    code, out, err = run(ws, *arguments)
    assert code == 2
    assert said in err
    assert "Traceback" not in err + out


def test_a_folder_without_packages(tmp_path):
    code, _, err = run(tmp_path)
    assert code == 2
    assert "no package was found" in err


def test_a_file_for_the_graph(ws, tmp_path):
    assert run(ws, "-f", "dot", "-o", tmp_path / "graph.dot")[0] == 0
    assert (tmp_path / "graph.dot").read_text().startswith("digraph")

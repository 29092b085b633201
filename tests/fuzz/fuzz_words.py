"""What a mutation may insert, by language: key words, brackets, and names that the extractors look for."""

from __future__ import annotations

_ANY = (
    "\0", "\n", "\r\n", "\t", "  ", "\\", "\\\n", '"', "'", "`", "$", "%", "&", "\ufeff", "\u202e", "\u2028", "é",
    "\x1b[2J", "::", "##[", "9" * 40, "0x", "1e999", "-1", "..", "../", "/", "//", "~", "{", "}", "(", ")", "[", "]",
    "<", ">", ",", ";", "9" * 4400,
)  # fmt: skip

_XML = (
    "<", "</", "/>", ">", "<!--", "-->", "<![CDATA[", "]]>", "<!DOCTYPE x [<!ENTITY e 'v'>]>", "&e;", "&#0;",
    "&#xD800;", "&#9999999999;", "&lt;", '<?xml version="1.0" encoding="utf-16"?>', "<a", 'a="', "='", "<!",
)  # fmt: skip

WORDS: dict[str, tuple[str, ...]] = {
    "manifest": (
        *_XML, "<package format='3'>", "</package>", "<name>", "</name>", "<depend>", "</depend>", "<export>",
        "<build_type>", "<exec_depend", "condition=\"$ROS_VERSION == 2\"", "condition=\"", " and ", " or ",
        "$ROS_DISTRO", "version_gte=", "version_lt='1.2'", "<group_depend>", "<member_of_group>", "<conflict>",
        "<build_export_depend>", "<metapackage/>", "<architecture_independent/>", "<rosbag migration_rule_file='x'/>",
        "<url type='x'>", "<version>1.0.0</version>",
    ),
    "cmake": (
        "if(", "elseif(", "else()", "endif()", "foreach(x ", "endforeach()", "while(", "endwhile()", "function(f ",
        "endfunction()", "macro(m ", "endmacro()", "find_package(", "REQUIRED", "COMPONENTS", "set(", "list(APPEND ",
        "list(SORT ", "list(FILTER X INCLUDE REGEX ", "string(REGEX REPLACE ", "string(REGEX MATCHALL ", "math(EXPR X ",
        "${X}", "${", "$ENV{", "$<", "$<IF:", "$<TARGET_PROPERTY:", "[==[", "]==]", "#[[", "]]", "#", "file(GLOB X ",
        "file(GLOB_RECURSE X **/*", "include(", "add_subdirectory(", "add_library(", "add_executable(",
        "target_link_libraries(", "install(TARGETS ", "ament_auto_add_library(", "rosidl_generate_interfaces(",
        "cmake_parse_arguments(A \"\" \"\" \"\" ${ARGN})", "PARENT_SCOPE", "CACHE INTERNAL", "RANGE 1 9999999",
        "IN LISTS ", "return()", "break()", "continue()", "MATCHES \"(a+)+$\"", "VERSION_LESS", "NOT ", "AND ", "OR ",
        "STREQUAL ", "catkin_package(CATKIN_DEPENDS ", "generate_messages(", "project(x VERSION 1.2)",
        "ament_package()", "ZIP_LISTS", "cmake_language(CALL ", "cmake_language(EVAL CODE ", "execute_process(COMMAND ",
        "get_property(", "_FOUND",
    ),
    "cpp": (
        "#include <", "#include \"", "#if ", "#ifdef ", "#elif ", "#else", "#endif", "#define X(a, ...) ", "##",
        "#pragma once", "__has_include(<a>)", "defined(", "/*", "*/", "//", 'R"x(', ')x"', '"', "'", "??=",
        "template <", "typename T", "class C : public ", "struct S {", "};", "namespace n {", "namespace a::b",
        "using namespace ", "using X = ", "typedef ", "enum class E : int {", "operator", "operator()", "operator<",
        "virtual ", "override", "= delete", "= default", "constexpr", "decltype(", "auto ", "->", "::", "<<", ">>",
        "&&", "[&](", "[[deprecated(\"", "]]", "__attribute__((", "noexcept(", "friend ", "extern \"C\" {",
        "static_assert(", "requires ", "concept ", "co_await ", "create_publisher<std_msgs::msg::String>(\"t\", 10)",
        "nh.advertise<", "nh.subscribe(\"", "create_subscription<", "declare_parameter(\"", "get_parameter(",
        "rclcpp::QoS(", "PLUGINLIB_EXPORT_CLASS(", "std::bind(&", "std::placeholders::_1",
        "int main(int argc, char** argv) {", "for (;;)", "while (", "switch (", "case 1:", "return ",
        "std::make_shared<", "void f(", "int x{", "u8\"", "1'000", "0b1", "0x1p3", "%:", "<:", "_Pragma(\"",
    ),
    "python": (
        "def f(", "async def ", "class C(", "):\n    ", "import ", "from . import ", "lambda: ", "if ", "elif ",
        "else:\n", "try:\n", "except Exception, e:\n", "finally:\n", "with ", "for x in ", "while True:\n", "yield ",
        "await ", "return ", "print 'x'", "exec 'x'", "0777", "u'", "f'{", "{x!r:>{y}}", '"""', "'''", "\\N{DIGIT ONE}",
        "\\ud800", "\\x", "b'", "@property\n", "__all__ = [", "global ", "match x:\n    case ", ":=", "*args",
        "**kwargs", "->", "%s", ".format(", "self.create_publisher(String, 't', 10)", "rospy.Publisher('",
        "rospy.Subscriber(", "self.declare_parameter('", "Node(package='", "LaunchDescription([",
        "generate_launch_description():\n", "IncludeLaunchDescription(", "LaunchConfiguration('",
        "PathJoinSubstitution([", "PythonExpression([", "DeclareLaunchArgument('", "OpaqueFunction(", "setup(",
        "find_packages(", "entry_points={", "data_files=[", "glob('", "os.path.join(", "sys.version_info >= ",
        "[x for x in ", "if __name__ == '__main__':\n", "type X = ", "\t", "    ", "\f", "#", "-*- coding: utf-7 -*-",
        "ParameterGenerator()", "gen.add('",
    ),
    "launch_xml": (
        *_XML, "<launch>", "</launch>", "<node pkg='", "exec='", "type='", "<group", "<include file='", "<arg name='",
        "<param name='", "<remap from='", "$(find ", "$(find-pkg-share ", "$(var ", "$(arg ", "$(eval ", "$(env ",
        "$(optenv ", "$(anon ", "$(dirname)", "$(if ", "$(and ", "$(not ", "$(", ")", "if=\"", "unless=\"",
        "<rosparam>", "<rosparam command='load' file='", "<let name='", "<push-ros-namespace namespace='",
        "<composable_node ", "<node_container ", "<xacro:include filename='", "<xacro:macro name='",
        "<plugin filename='lib", "<class type='", "<library path='", "base_class_type='", "${", "}",
        "subst_value='true'", "clear_params", "ns='", "__name:=",
    ),
    "launch_yaml": (
        "launch:\n", "- node:\n", "    pkg: ", "    exec: ", "- arg:\n", "- include:\n", "- group:\n", "- let:\n",
        "- push_ros_namespace:\n", "    param:\n", "    remap:\n", "file: $(find-pkg-share ", "$(var ", "$(eval \"",
        "$(", "&a ", "*a", "<<: *a", "!!python/object:os.system ", "? ", "|\n", ">-\n", "- ", ": ", "[", "]", "{", "}",
        "---\n", "/**:\n", "ros__parameters:\n", "%YAML 1.1\n", "!!binary ", "!!set ", "2001-99-99", "0o7", "1:30",
        ".nan", ".inf",
    ),
    "interface": (
        "int32 ", "string<=", "uint8[]", "float64[3]", "[<=", "string", "wstring", "bool", "Header", "std_msgs/",
        "geometry_msgs/", "---\n", " x", "=", " X=1\n", "#", "\"", "'", "byte", "char", "time", "duration",
        "module a {", "struct B {", "};", "typedef ", "sequence<", "enum E {", "union U switch(long) {", "case 1:",
        "const long X = ", "@key", "@verbatim (", "#include \"", "interface ", "map<", "@default (value=",
        "@bit_bound(", "::", "/*", "*/", "//",
    ),
    "yaml": (
        "- ", ": ", "&a ", "*a", "<<: *a", "? ", "|", ">", "!!python/name:os", "!!timestamp ", "!!int ", "!!float ",
        "!!omap", "[", "]", "{", "}", "---", "...", "%TAG ! x:\n", "\"\\ud800\"", "2001-13-40", "~", "null", "=",
        "repositories:\n", "type: git\n", "version: ", "names:\n", "paths:\n", "packages-ignore-regex: ",
        "base-paths: ", "packages-skip: [", "metas: ", "ros__parameters:", "/**:", "build:\n", "(a+)+$",
        "dependencies: [", "  ", "\t",
    ),
    "toml": (
        "[", "]", "[[", "]]", "=", " = ", "\"", "'''", '"""', "{", "}", ",", ".", "a.b.c", "#", "true",
        "1979-05-27T07:32:00Z", "inf", "nan", "0x", "1_000", "[targets.x]\n", "distro = \"humble\"\n", "[workspace]\n",
        "underlays = [", "[check]\n", "fail_on = \"error\"", "select = [", "[paths.\"*\"]\n", "ignore = [",
        "severity = {", "[project]\n", "name = ", "dependencies = [", "[project.scripts]\n", "\\u0000", "\\ud800",
        "index = ", "date = ", "file = ",
    ),
    "cfg": (
        "[", "]", "[metadata]\n", "name = ", "[options]\n", "install_requires =\n", "  ", "[options.entry_points]\n",
        "console_scripts =\n", "%(x)s", "=", ":", "#", ";", "[develop]\n", "script_dir=$base/lib/x\n", "${x}",
        "a = b:c\n", "[options.package_data]\n", "* = *\n", "\n\n", "[DEFAULT]\n",
    ),
    "shell": (
        "#!/bin/bash\n", "#!/usr/bin/env python3\n", "rosrun ", "roslaunch ", "ros2 run ", "ros2 launch ", "source ",
        "$(", ")", "`", "<<EOF\n", "EOF\n", "if [ ", "]; then\n", "fi\n", "for x in ", "; do\n", "done\n", "\\\n", "&&",
        "|", "export ",
    ),
    "allow": (
        "# rosimpact: allow(", "// rosimpact:allow(", "<!-- rosimpact: allow(", ")", ",", "*", "removed-header",
        "--", ";",
    ),
    "listing": (
        "ii  ", "hi  ", "ros-humble-rclcpp", ":amd64", " 16.0.8-1jammy.20240101.120000 ", "ros-", "noetic", "-dbgsym",
        "\t", "+dfsg", "libopencv-dev", "4.5.4", "~", "-", ":", "rc  ",
    ),
    "json": (
        "{", "}", "[", "]", ":", ",", "\"", "\\u0000", "\\ud800", "null", "true", "1e999", "-0", "\"schema\":1",
        "\"findings\":[", "\"fingerprint\":\"", "\"count\":", "\"rosimpact_target\":1", "\"packages\":{", "\"distro\":",
        "\"id\":", "\"title\":", "\"body\":", "\"source\":", "\"added_at\":", "\"tags\":", "\"author\":", "\"url\":",
    ),
    "text": (
        "::error::", "::add-mask::", "##[error]", "##vso[task", "##teamcity[", "\x1b[31m", "\x1b]8;;http://x\x07",
        "\x9b31m", "\u202e", "\u2066", "\u200b", "\u0085", "\u00a0", "\x0b", "\x0c", "|", "`", "``", "![x](http://x)",
        "[x](y)", "<img src=x>", "@me", "#1", "http://x", "www.x.org", "&amp;", "<!--", "-->", "</script>", "***", "__",
        "~~", "$$", "\\", "- ", "1. ", "# ", "> ", "\n\n", "|---|", "\ud800",
    ),
    "regex": (
        "(", ")", "|", "*", "+", "?", "^", "$", "[", "]", "[^",
        "[]", "\\", ".", "a", "b", "-", "{1,9}", "\n", "(a+)+", "&&", "--",
    ),
    "html": (
        "<p>", "</p>", "<pre><code>", "</code></pre>", "<ul><li>", "<ol start=9>", "<a href='x'>",
        "<img src=x alt='y'>", "<em>", "<strong>", "<table><tr><td>", "<blockquote>", "<br/>", "&lt;", "&#0;", "<!--",
        "<![CDATA[", "<script>", "<h1>", "`", "```", "<div class='question'>", "<div id='question-table'>",
        "class='js-question'", "post-id='1'", "<title>",
    ),
    "conditions": (
        "defined(", "__has_include(<", ">)", "ROS_VERSION", ">=", "==", "&&", "||", "!", "<<", "?", ":", "%", "0",
        "9999999999", "$ROS_VERSION", " == ", " and ", " or ", "NOT ", "AND ", "OR ", "EQUAL ", "VERSION_LESS ",
        "MATCHES ", "TARGET ", "${", "}", "sys.version_info", "[0]", " >= (3, 8)", "os.environ.get('ROS_DISTRO')",
        " in ", "RCLCPP_VERSION_GTE(1,2,3)", "not ",
    ),
    "bytes": (
        "\x7fELF", "\0\0\0\0", "\x7f\x7f\x7f\x7f", "!<arch>\n", "debian-binary   ", "control.tar.gz  ",
        "data.tar.xz     ", "data.tar.gz", "`\n", "DIRC", "link\0\0\0\0", "GNU\0", ".dynsym\0", ".gnu.version_r\0",
    ),
}  # fmt: skip
"""Language: words. Every language also has what _ANY holds."""

WORDS = {language: (*_ANY, *words) for language, words in WORDS.items()}

"""Small files that ask for much time or memory; large ones; and many."""

from __future__ import annotations

import lzma
import os
import struct
import zlib
from collections.abc import Callable

import pygit2

from .harness import CMAKE, COMMANDS, NEEDS_GIT, STATUS, Attack, Place, cmake, manifest, write

GROUP = "bombs"
CHECK = (*COMMANDS["check"], "--notes", "-f", "json")


def aliases(start: str = "a", levels: int = 12, wide: int = 9) -> str:
    """A document of YAML whose aliases stand for wide^levels nodes."""
    lines = [f"{start}: &x0 [{','.join('x' * wide)}]"]
    lines += [f"{start}{n}: &x{n} [{','.join([f'*x{n - 1}'] * wide)}]" for n in range(1, levels)]
    return "\n".join(lines) + "\n"


def merges(levels: int = 28) -> str:
    """A document of YAML whose merge keys double at each level."""
    lines = ["a0: &m0 {k0: v}"]
    lines += [f"a{n}: &m{n} {{<<: [*m{n - 1}, *m{n - 1}], k{n}: v}}" for n in range(1, levels)]
    return "\n".join(lines) + "\n"


def entities(body: str) -> str:
    names = "abcdefghijkl"
    text = "<?xml version='1.0'?><!DOCTYPE x [<!ENTITY a '" + "A" * 1000 + "'>"
    text += "".join(f"<!ENTITY {names[n + 1]} '{f'&{names[n]};' * 10}'>" for n in range(10)) + "]>"
    return text + body.replace("BOMB", "&k;")


def quadratic_entities(body: str) -> str:
    """One entity of 100 KB, asked for 20,000 times: no nesting to be noticed by."""
    text = "<?xml version='1.0'?><!DOCTYPE x [<!ENTITY a '" + "A" * 100_000 + "'>]>"
    return text + body.replace("BOMB", "&a;" * 20_000)


def cmake_row(name: str, more: str) -> tuple[str, dict[str, str | bytes]]:
    return f"CMake: {name}", {"src/bad/CMakeLists.txt": cmake("bad", more)}


def file_row(name: str, path: str, text: str | bytes) -> tuple[str, dict[str, str | bytes]]:
    return name, {path: text}


YAML_PLACES = (
    "defaults.yaml",
    ".colcon/defaults.yaml",
    "colcon.meta",
    "src/bad/colcon.pkg",
    "src/bad/launch/a.launch.yaml",
    "src/bad/config/a.yaml",
)
XML_PLACES = {
    "src/bad/package.xml": manifest("bad", "rclcpp").split("?>")[1].replace("<description>d", "<description>BOMB"),
    "src/bad/launch/a.launch": "<launch><node pkg='BOMB' type='x' name='BOMB'/></launch>",
    "src/bad/launch/a.launch.xml": "<launch><node pkg='BOMB' exec='BOMB'/></launch>",
    "src/bad/urdf/a.urdf.xacro": "<robot name='BOMB'/>",
    "src/bad/plugins.xml": "<library path='BOMB'><class type='BOMB' base_class_type='x'/></library>",
}
NL = "\n"
def make_files() -> list[tuple[str, dict[str, str | bytes]]]:
    """The files of each row; 140 MB, which are not kept."""
    return [
        *[file_row(f"YAML aliases in {path}", path, aliases()) for path in YAML_PLACES],
        *[file_row(f"YAML merges in {path}", path, merges()) for path in YAML_PLACES],
        *[file_row(f"YAML nested deeply in {path}", path, "a: " + "[" * 60_000) for path in YAML_PLACES],
        *[
            file_row(
                f"YAML of 1,500 levels of indentation in {path}", path, "".join(" " * n + "a:\n" for n in range(1_500))
            )
            for path in YAML_PLACES[:3]
        ],
        *[
            file_row(f"YAML that holds itself in {path}", path, "build: &a\n  packages-skip: *a\nnames: *a\n")
            for path in YAML_PLACES
        ],
        *[
            file_row(f"YAML of 200,000 keys in {path}", path, "".join(f"k{n}: {n}\n" for n in range(200_000)))
            for path in ("defaults.yaml", "src/bad/config/a.yaml")
        ],
        *[
            file_row(f"YAML integer of 100,000 digits in {path}", path, "a: " + "9" * 100_000 + "\n")
            for path in YAML_PLACES[:4:2]
        ],
        *[
            file_row(f"YAML sexagesimal integer in {path}", path, "a: 1" + ":59" * 40_000 + "\n")
            for path in YAML_PLACES[::3]
        ],
        *[file_row(f"XML entities in {path}", path, entities(text)) for path, text in XML_PLACES.items()],
        *[
            file_row(f"XML quadratic entities in {path}", path, quadratic_entities(text))
            for path, text in XML_PLACES.items()
        ],
        *[file_row(f"XML nested deeply in {path}", path, "<a>" * 200_000 + "</a>" * 200_000) for path in XML_PLACES],
        *[
            file_row(
                f"XML of 100,000 attributes in {path}",
                path,
                "<a " + " ".join(f"a{n}='x'" for n in range(100_000)) + "/>",
            )
            for path in list(XML_PLACES)[:3]
        ],
        file_row("TOML dotted keys in pyproject.toml", "src/bad/pyproject.toml", ".".join("a" * 40_000) + " = 1\n"),
        file_row(
            "TOML dotted tables in pyproject.toml",
            "src/bad/pyproject.toml",
            "".join(f"[{'.'.join('a' * n)}]\n" for n in range(1, 1_200)),
        ),
        file_row("TOML nested in pyproject.toml", "src/bad/pyproject.toml", "a = " + "[" * 100_000),
        file_row("TOML inline tables in pyproject.toml", "src/bad/pyproject.toml", "a = " + "{a=" * 20_000),
        file_row("TOML array of tables in pyproject.toml", "src/bad/pyproject.toml", "[[a]]\n" * 100_000),
        file_row(
            "setup.cfg of interpolations",
            "src/bad/setup.cfg",
            "[metadata]\n" + "".join(f"a{n} = %(a{n + 1})s%(a{n + 1})s\n" for n in range(40)) + "name = %(a0)s\n",
        ),
        file_row(
            "setup.cfg of 200,000 lines",
            "src/bad/setup.cfg",
            "[metadata]\n" + "".join(f"a{n} = 1\n" for n in range(100_000)),
        ),
        file_row(
            "package.xml of 100,000 dependencies",
            "src/bad/package.xml",
            manifest("bad", *[f"d{n}" for n in range(15_000)]),
        ),
        file_row(
            "package.xml of 20,000 times the same dependency",
            "src/bad/package.xml",
            manifest("bad", *["rclcpp"] * 15_000),
        ),
        file_row(
            "package.xml with a condition of 100,000 ands",
            "src/bad/package.xml",
            manifest("bad")
            .replace("<depend>", "<depend>", 1)
            .replace("<export>", '<depend condition="' + "$A == 1 and " * 20_000 + '$A == 1">x</depend><export>'),
        ),
        file_row(
            "package.xml with a nested condition",
            "src/bad/package.xml",
            manifest("bad").replace(
                "<export>", '<depend condition="' + "(" * 20_000 + "$A == 1" + ")" * 20_000 + '">x</depend><export>'
            ),
        ),
        file_row("package.xml name of 500 KB", "src/bad/package.xml", manifest("b" * 500_000)),
        file_row(
            "package.xml of 2 MB of spaces in a tag",
            "src/bad/package.xml",
            manifest("bad").replace("<license>", "<license" + " " * 900_000 + ">"),
        ),
        file_row(
            "gitmodules, quadratic",
            ".gitmodules",
            "".join(f'[submodule "s{n}"]\n\tpath = src/s{n}\n\turl = x\n' for n in range(20_000)),
        ),
        file_row("gitmodules of one section", ".gitmodules", '[submodule "s"]\n' + "\tpath = a\n" * 100_000),
        file_row("gitmodules of open quotes", ".gitmodules", '[submodule "' + "\\\\" * 300_000),
        file_row(
            "regular expression of packages-select-regex",
            "defaults.yaml",
            "build:\n  packages-skip-regex: ['(a+)+$', '(h|he|hea|heal)*$', '(.*)*x']\n"
            + "list:\n  packages-select-regex: ['((.+)+)+!']\n",
        ),
        file_row(
            "regular expression of packages-skip-regex, long names",
            "src/" + "a" * 60 + "/package.xml",
            manifest("a" * 60 + "_"),
        ),
        cmake_row("50,000 elseif", "if(A)\n" + "elseif(B)\n" * 50_000 + "endif()"),
        cmake_row("50,000 ifs in a row", "if(A)\nendif()\n" * 50_000),
        cmake_row("5,000 nested ifs with finds", "if(A)\nfind_package(rclcpp)\n" * 5_000 + "endif()\n" * 5_000),
        cmake_row("condition of 50,000 ORs", "if(" + "A OR " * 50_000 + "B)\nfind_package(x)\nendif()"),
        cmake_row("condition of NOTs", "if(" + "NOT " * 50_000 + "B)\nendif()"),
        cmake_row("string(REPEAT)", 'string(REPEAT "xyz" 1000000000 A)\nset(B "${A}${A}")'),
        cmake_row(
            "string(REPEAT) of REPEAT", "set(A x)\n" + 'string(REPEAT "${A}" 1000 A)\n' * 5 + "find_package(${A})"
        ),
        cmake_row("string(APPEND) that doubles", "set(A x)\n" + 'string(APPEND A "${A}")\n' * 60),
        cmake_row("list(APPEND) that doubles", "set(A x;y)\n" + "list(APPEND A ${A})\n" * 60),
        cmake_row(
            "list(TRANSFORM) that grows", "set(A x;y)\n" + 'list(TRANSFORM A REPLACE ".+" "\\\\0\\\\0;\\\\0")\n' * 60
        ),
        cmake_row(
            "REGEX REPLACE that doubles",
            "set(A x)\n" + 'string(REGEX REPLACE "(.*)" "\\\\1\\\\1\\\\1" A "${A}")\n' * 60,
        ),
        cmake_row("REGEX REPLACE backtracks", f'string(REGEX REPLACE "(a+)+b" "x" A "{"a" * 5000}")'),
        cmake_row("MATCHES backtracks", f'if("{"a" * 60}!" MATCHES "^(a+)+$")\nfind_package(x)\nendif()'),
        cmake_row(
            "MATCHES of alternatives backtracks", f'if("{"a" * 60}!" MATCHES "^(a|aa|a*)*$")\nfind_package(x)\nendif()'
        ),
        cmake_row("MATCHES of stars", f'if("{"a" * 3000}" MATCHES "{"a*" * 100}b")\nfind_package(x)\nendif()'),
        cmake_row("MATCHES nested deeply", f'if("a" MATCHES "{"(" * 5_000}a{")" * 5_000}")\nendif()'),
        cmake_row("REGEX MATCHALL backtracks", f'string(REGEX MATCHALL "(x+x+)+y" A "{"x" * 5000}")'),
        cmake_row("list(FILTER) backtracks", f'set(A {"a" * 60}!)\nlist(FILTER A INCLUDE REGEX "^(a+)+$")'),
        cmake_row("foreach over 10^9", "foreach(i RANGE 1000000000)\nset(x ${i})\nendforeach()"),
        cmake_row("foreach over steps of 0", "foreach(i RANGE 0 10 0)\nset(x ${i})\nendforeach()"),
        cmake_row("foreach over negative numbers", "foreach(i RANGE 10 -99999999999)\nset(x ${i})\nendforeach()"),
        cmake_row("nested foreach", "foreach(a RANGE 999)\n" * 5 + "set(x 1)\n" + "endforeach()\n" * 5),
        cmake_row(
            "foreach that makes 10^6 targets", "foreach(i RANGE 1000000)\nadd_library(l${i} a.cpp)\nendforeach()"
        ),
        cmake_row(
            "ZIP_LISTS of long lists",
            'string(REPEAT "a;" 100000 A)\n' + "foreach(a b IN ZIP_LISTS A A)\nlist(APPEND B ${A})\nendforeach()",
        ),
        cmake_row("while(TRUE)", "while(TRUE)\nlist(APPEND L x)\nendwhile()"),
        cmake_row("while that counts", 'set(i 0)\nwhile(i LESS 100000000)\nmath(EXPR i "${i}+1")\nendwhile()'),
        cmake_row(
            "math of long numbers",
            'math(EXPR A "' + "9" * 10_000 + "*" + "9" * 10_000 + '")\nmath(EXPR B "1<<99999999999")',
        ),
        cmake_row(
            "math of powers",
            'math(EXPR A "' + "9**" * 20 + '9")\nmath(EXPR B "' + "(" * 10_000 + "1" + ")" * 10_000 + '")',
        ),
        cmake_row("recursive macro", "macro(f)\nf()\nf()\nendmacro()\nf()"),
        cmake_row("recursive function that grows", "function(f x)\nf(${x}${x})\nendfunction()\nf(a)"),
        cmake_row(
            "40 macros that call the next twice",
            "macro(m40)\nendmacro()\n"
            + "".join(f"macro(m{n})\nm{n + 1}()\nm{n + 1}()\nendmacro()\n" for n in range(39, -1, -1))
            + "m0()",
        ),
        cmake_row(
            "function that defines itself", "function(f)\nfunction(f)\nf()\nendfunction()\nf()\nendfunction()\nf()"
        ),
        cmake_row(
            "cmake_language(CALL) of itself",
            'function(f)\ncmake_language(CALL f)\ncmake_language(EVAL CODE "f()")\nendfunction()\nf()',
        ),
        cmake_row("include of itself", "include(${CMAKE_CURRENT_LIST_FILE})\ninclude(CMakeLists.txt)"),
        cmake_row("add_subdirectory of itself", "add_subdirectory(.)\nadd_subdirectory(${CMAKE_CURRENT_SOURCE_DIR} x)"),
        (
            "CMake: 30 files that include the next twice",
            {
                "src/bad/CMakeLists.txt": cmake("bad", "include(c0.cmake)"),
                **{f"src/bad/c{n}.cmake": f"include(c{n + 1}.cmake)\ninclude(c{n + 1}.cmake)\n" for n in range(30)},
                "src/bad/c30.cmake": "find_package(x)\n",
            },
        ),
        cmake_row("variables in variables", "set(A ${" * 3_000 + "x" + "}" * 3_000 + ")"),
        cmake_row("references nested deeply", 'set(A "' + "${" * 50_000 + '")'),
        cmake_row(
            "generator expressions nested deeply",
            "add_library(l a.cpp)\ntarget_link_libraries(l " + "$<IF:1," * 5_000 + "x" + ",y>" * 5_000 + ")",
        ),
        cmake_row("file(GLOB_RECURSE) of /", "file(GLOB_RECURSE A /*)\nadd_library(l ${A})"),
        cmake_row(
            "file(GLOB) of stars",
            "file(GLOB A " + "*/" * 50 + "*)\nfile(GLOB_RECURSE B ../../../*)\nadd_library(l ${A} ${B})",
        ),
        cmake_row("file(GLOB) of a pattern that backtracks", "file(GLOB A " + "*a" * 40 + "b)\nadd_library(l ${A})"),
        cmake_row("one command of 300,000 arguments", "set(A " + "x " * 300_000 + ")"),
        cmake_row("one argument of 3 MB", 'set(A "' + "x" * 3_000_000 + '")'),
        cmake_row("100,000 open parentheses", "if(" + "(" * 100_000),
        cmake_row(
            "bracket arguments of many equals", "set(A " + "".join(f"[{'=' * n}[x]" for n in range(1, 1_200)) + ")"
        ),
        cmake_row(
            "10,000 targets linked in a row",
            "".join(f"add_library(l{n} a.cpp)\ntarget_link_libraries(l{n} PUBLIC l{n + 1})\n" for n in range(5_000)),
        ),
        cmake_row(
            "1,000 targets linked to each other",
            "".join(f"add_library(l{n} a.cpp)\n" for n in range(300))
            + "".join(
                f"target_link_libraries(l{n} PUBLIC " + " ".join(f"l{m}" for m in range(300)) + ")\n"
                for n in range(300)
            ),
        ),
        cmake_row(
            "targets linked in a circle",
            "add_library(a a.cpp)\nadd_library(b b.cpp)\ntarget_link_libraries(a b)\ntarget_link_libraries(b a)",
        ),
        cmake_row(
            "aliases in a circle",
            "add_library(a ALIAS b)\nadd_library(b ALIAS a)\ntarget_link_libraries(a b)\nget_target_property(X a "
            "ALIASED_TARGET)",
        ),
        file_row(
            "C++: 50,000 else if",
            "src/bad/src/n.cpp",
            "void f(int a) {\nif (a) {}\n" + "else if (a) {}\n" * 50_000 + "}\n",
        ),
        file_row("C++: 50,000 #elif", "src/bad/src/n.cpp", "#if A\n" + "#elif B\nint a;\n" * 50_000 + "#endif\n"),
        file_row(
            "C++: 20,000 nested #if", "src/bad/src/n.cpp", "#if A\n" * 20_000 + "#include <a.h>\n" + "#endif\n" * 20_000
        ),
        file_row(
            "C++: #if of 100,000 parentheses",
            "src/bad/src/n.cpp",
            "#if " + "(" * 100_000 + "1" + ")" * 100_000 + "\n#include <a.h>\n#endif\n",
        ),
        file_row(
            "C++: #if of 50,000 ||",
            "src/bad/src/n.cpp",
            "#if " + "defined(A) || " * 50_000 + "1\n#include <tf2_geometry_msgs/tf2_geometry_msgs.h>\n#endif\n",
        ),
        file_row(
            "C++: #if of shifts",
            "src/bad/src/n.cpp",
            "#if (1 << 99999999999) && 9" + "9" * 10_000 + " * 99 == 1\n#include <a.h>\n#endif\n",
        ),
        file_row(
            "C++: 100,000 macros that double",
            "src/bad/src/n.cpp",
            "".join(f"#define M{n} M{n + 1} M{n + 1}\n" for n in range(60))
            + "int x = M0;\n#if M0\n#include <a.h>\n#endif\n",
        ),
        file_row("C++: line continuation without end", "src/bad/src/n.cpp", "#define A \\\n" * 100_000),
        file_row("C++: templates", "src/bad/src/n.cpp", "A<" * 50_000 + ">" * 50_000 + " x;\n"),
        file_row("C++: templates that may be comparisons", "src/bad/src/n.cpp", "auto x = " + "a < b(" * 8_000 + ";\n"),
        file_row("C++: braces", "src/bad/src/n.cpp", "void f() " + "{" * 100_000 + "}" * 100_000),
        file_row("C++: parentheses", "src/bad/src/n.cpp", "int x = " + "(" * 100_000 + "1" + ")" * 100_000 + ";"),
        file_row("C++: casts", "src/bad/src/n.cpp", "int x = " + "(a)" * 60_000 + "1;"),
        file_row("C++: brackets", "src/bad/src/n.cpp", "int x" + "[" * 60_000 + "]" * 60_000 + ";"),
        file_row(
            "C++: lambdas in lambdas",
            "src/bad/src/n.cpp",
            "auto x = " + "[&]() { return " * 5_000 + "1" + "; }" * 5_000 + ";",
        ),
        file_row(
            "C++: calls in calls",
            "src/bad/src/n.cpp",
            "void g() { int x = " + "f(" * 30_000 + "1" + ")" * 30_000 + "; }",
        ),
        file_row("C++: members of members", "src/bad/src/n.cpp", "void g() { x" + ".y()" * 50_000 + "; }"),
        file_row("C++: namespaces", "src/bad/src/n.cpp", "namespace a {" * 50_000),
        file_row("C++: classes in classes", "src/bad/src/n.cpp", "class A {" * 20_000 + "};" * 20_000),
        file_row("C++: declarators", "src/bad/src/n.cpp", "int " + "*(" * 30_000 + "a" + ")" * 30_000 + ";"),
        file_row("C++: conditional expressions", "src/bad/src/n.cpp", "int x = " + "a ? b : " * 50_000 + "c;"),
        file_row("C++: string of 100,000 literals", "src/bad/src/n.cpp", "auto x = " + '"a" ' * 100_000 + ";"),
        file_row(
            "C++: sum of 100,000 strings",
            "src/bad/src/n.cpp",
            "void f() { auto x = std::string()" + ' + "a"' * 50_000 + "; node.advertise<M>(x, 1); }",
        ),
        file_row(
            "C++: variable that doubles",
            "src/bad/src/n.cpp",
            'void f(ros::NodeHandle n) { std::string a0 = "xx";\n'
            + "".join(f"std::string a{k + 1} = a{k} + a{k};\n" for k in range(60))
            + "n.advertise<std_msgs::Int32>(a60, 1); }\n",
        ),
        file_row(
            "C++: 20,000 publishers",
            "src/bad/src/n.cpp",
            "void f(ros::NodeHandle n) {\n"
            + "".join(f'ros::Publisher p{k} = n.advertise<std_msgs::Int32>("t{k}", 1);\n' for k in range(10_000))
            + "}\n",
        ),
        file_row(
            "C++: mutual recursion",
            "src/bad/src/n.cpp",
            "".join(
                f'void f{k}(ros::NodeHandle n, std::string s) {{ f{(k + 1) % 200}(n, s + "x"); f{(k + 7) % 200}(n, s '
                f'+ "y"); n.advertise<std_msgs::Int32>(s, 1); }}\n'
                for k in range(200)
            )
            + 'int main() { ros::NodeHandle n; f0(n, "a"); }\n',
        ),
        file_row(
            "C++: 2^40 paths of calls",
            "src/bad/src/n.cpp",
            "".join(
                f'void f{k}(rclcpp::Node* n, std::string s) {{ f{k + 1}(n, s + "a"); f{k + 1}(n, s + "b"); }}\n'
                for k in range(40)
            )
            + "void f40(rclcpp::Node* n, std::string s) { n->create_publisher<std_msgs::msg::Int32>(s, 1); }\n"
            + 'int main() { f0(n, "x"); }\n',
        ),
        file_row("C++: one line of 4 MB", "src/bad/src/n.cpp", "int a = 1; " * 350_000),
        file_row("C++: 3 MB of an open comment", "src/bad/src/n.cpp", "/* " + "x/*" * 1_000_000),
        file_row("C++: raw strings that do not end", "src/bad/src/n.cpp", 'R"a(' * 50_000),
        file_row("C++: quotes that do not end", "src/bad/src/n.cpp", "'\"" * 200_000),
        file_row("C++: backslashes", "src/bad/src/n.cpp", '"' + "\\" * 2_000_001 + '\n"'),
        file_row(
            "C++: conditions for the solver",
            "src/bad/src/n.cpp",
            "void f(int a) { if ("
            + " && ".join(f"(a*a*a*{k} + a*{k + 1} != {k * 7919} || a % {k + 2} == 1)" for k in range(400))
            + ") pub_->publish(m); }",
        ),
        file_row("Python: 50,000 elif", "src/bad/scripts/n.py", "if a:\n    pass\n" + "elif a:\n    pass\n" * 50_000),
        file_row("Python: nested brackets", "src/bad/scripts/n.py", "x = " + "[" * 100_000 + "]" * 100_000 + "\n"),
        file_row(
            "Python: nested blocks",
            "src/bad/scripts/n.py",
            "".join(" " * n + "if a:\n" for n in range(1_000)) + " " * 1_000 + "pass\n",
        ),
        file_row("Python: not not not", "src/bad/scripts/n.py", "x = " + "not " * 100_000 + "a\n"),
        file_row("Python: lambdas", "src/bad/scripts/n.py", "x = " + "lambda: " * 50_000 + "1\n"),
        file_row("Python: sum of 100,000", "src/bad/scripts/n.py", "x = " + "'a' + " * 100_000 + "'a'\n"),
        file_row(
            "Python: powers",
            "src/bad/scripts/n.py",
            "import rclpy\nx = 9 ** 9 ** 9 ** 9\nnode.create_publisher(M, 'a' * 9 ** 9 ** 9, 1)\n",
        ),
        file_row(
            "Python: text times a number",
            "src/bad/scripts/n.py",
            "import rclpy\nnode.create_publisher(M, 'abc' * 10 ** 12, 1)\nnode.create_publisher(M, '%99999999999d' % "
            "1, 1)\n",
        ),
        file_row(
            "Python: format of a width",
            "src/bad/scripts/n.py",
            "import rclpy\nx = 1\nnode.create_publisher(M, f'{x:>99999999999}', 1)\nnode.create_publisher(M, '{:>"
            "99999999999}'.format(1), 1)\n",
        ),
        file_row(
            "Python: variable that doubles",
            "src/bad/scripts/n.py",
            "import rclpy\na = 'xx'\n" + "a = a + a\n" * 60 + "node.create_publisher(M, a, 1)\n",
        ),
        file_row(
            "Python: lists that double",
            "src/bad/scripts/n.py",
            "import rclpy\na = [1]\n"
            + "a = a + a\n" * 60
            + "a *= 10 ** 12\nfor i in a:\n    node.create_publisher(M, 't%d' % i, 1)\n",
        ),
        file_row(
            "Python: range of 10^12",
            "src/bad/scripts/n.py",
            "import rclpy\nfor i in range(10 ** 12):\n    node.create_publisher(M, 't%d' % i, 1)\nx = list(range(10 "
            "** 12))\n",
        ),
        file_row("Python: number of 100,000 digits", "src/bad/scripts/n.py", "x = " + "9" * 100_000 + "\n"),
        file_row(
            "Python: 2^40 paths of calls",
            "src/bad/scripts/n.py",
            "import rclpy\n"
            + "".join(f"def f{k}(n, s):\n    f{k + 1}(n, s + 'a')\n    f{k + 1}(n, s + 'b')\n" for k in range(40))
            + "def f40(n, s):\n    n.create_publisher(Int32, s, 1)\nf0(node, 'x')\n",
        ),
        file_row("Python: decorators", "src/bad/scripts/n.py", "@a\n" * 50_000 + "def f(): pass\n"),
        file_row(
            "Python: 2, with prints and backticks", "src/bad/scripts/n.py", "print 'a'\nx = " + "`" * 50_000 + "\n"
        ),
        file_row(
            "Python: 2, nested brackets", "src/bad/scripts/n.py", "print 'a'\nx = " + "(" * 50_000 + ")" * 50_000 + "\n"
        ),
        file_row(
            "setup.py of doubling lists",
            "src/bad/setup.py",
            "from setuptools import setup\na = ['x']\n"
            + "a = a + a\n" * 60
            + "setup(name='bad', packages=a, data_files=[('x', a * 10 ** 9)])\n",
        ),
        file_row(
            "setup.py that globs /",
            "src/bad/setup.py",
            "from glob import glob\nfrom setuptools import setup\nsetup(name='bad', data_files=[('x', glob('/**', "
            "recursive=True) + glob('../../**/*'))])\n",
        ),
        file_row(
            "launch.py that loops",
            "src/bad/launch/a.launch.py",
            "from launch import LaunchDescription\nfrom launch_ros.actions import Node\n"
            "def generate_launch_description():\n    d = LaunchDescription()\n    while True:\n"
            "        d.add_action(Node(package='bad', executable='x'))\n    return d\n",
        ),
        file_row(
            "launch.py of 10^9 nodes",
            "src/bad/launch/a.launch.py",
            "from launch import LaunchDescription\nfrom launch_ros.actions import Node\n"
            "def generate_launch_description():\n    return LaunchDescription([Node(package='bad', executable='x%d' "
            "% i) for i in range(10 ** 9)])\n",
        ),
        file_row(
            "launch.py that recurs",
            "src/bad/launch/a.launch.py",
            "from launch import LaunchDescription\ndef f(a):\n    return f(a + a) + f(a)\n"
            "def generate_launch_description():\n    return LaunchDescription(f([1]))\n",
        ),
        file_row(
            "launch.py that includes itself",
            "src/bad/launch/a.launch.py",
            "import os\nfrom launch import LaunchDescription\nfrom launch.actions import IncludeLaunchDescription\n"
            "def generate_launch_description():\n    return LaunchDescription([IncludeLaunchDescription(__file__), "
            "IncludeLaunchDescription(__file__)])\n",
        ),
        file_row(
            "launch.xml that includes itself twice",
            "src/bad/launch/a.launch.xml",
            "<launch><include file='$(dirname)/a.launch.xml'/><include file='$(dirname)/a.launch.xml'/></launch>",
        ),
        file_row(
            "launch that includes itself with another argument",
            "src/bad/launch/a.launch",
            "<launch><arg name='a' default='x'/><include file='$(dirname)/a.launch'><arg name='a' value='$(arg a)"
            "$(arg a)'/></include></launch>",
        ),
        (
            "launch files, 2^30 includes",
            {
                f"src/bad/launch/l{n}.launch.xml": f"<launch><include file='$(dirname)/l{n + 1}.launch.xml'/><"
                f"include file='$(dirname)/l{n + 1}.launch.xml'/></launch>"
                for n in range(30)
            },
        ),
        file_row(
            "launch of substitutions",
            "src/bad/launch/a.launch.xml",
            "<launch><node pkg='" + "$(find " * 5_000 + "x" + ")" * 5_000 + "' exec='x'/></launch>",
        ),
        file_row(
            "launch of eval",
            "src/bad/launch/a.launch",
            "<launch><arg name='a' default=\"$(eval 9**9**9**9)\"/><arg name='b' default=\"$(eval 'a' * 10**12)\"/><"
            "node pkg='bad' type='$(arg a)' name='$(arg b)'/></launch>",
        ),
        file_row(
            "launch of arguments that double",
            "src/bad/launch/a.launch",
            "<launch><arg name='a0' default='xx'/>"
            + "".join(f"<arg name='a{n + 1}' default='$(arg a{n})$(arg a{n})'/>" for n in range(60))
            + "<node pkg='bad' type='x' name='$(arg a60)'/></launch>",
        ),
        file_row(
            "launch of 20,000 nodes",
            "src/bad/launch/a.launch.xml",
            "<launch>"
            + "".join(f"<node pkg='healthy' exec='healthy_node' name='n{n}'/>" for n in range(20_000))
            + "</launch>",
        ),
        file_row(
            "launch of 20,000 nested groups",
            "src/bad/launch/a.launch.xml",
            "<launch>" + "<group>" * 20_000 + "</group>" * 20_000 + "</launch>",
        ),
        file_row(
            "xacro macro that calls itself",
            "src/bad/urdf/a.urdf.xacro",
            "<robot xmlns:xacro='http://ros.org/wiki/xacro'><xacro:macro name='m'><xacro:m/><xacro:m/></xacro:macro><"
            "xacro:m/></robot>",
        ),
        file_row(
            "xacro that includes itself",
            "src/bad/urdf/a.urdf.xacro",
            "<robot xmlns:xacro='http://ros.org/wiki/xacro'><xacro:include filename='a.urdf.xacro'/><xacro:include "
            "filename='a.urdf.xacro'/></robot>",
        ),
        file_row(
            "xacro of expressions",
            "src/bad/urdf/a.urdf.xacro",
            "<robot xmlns:xacro='http://ros.org/wiki/xacro'><xacro:property name='a' value='${9**9**9**9}'/><x "
            "a='${a}'/></robot>",
        ),
        file_row("msg of 100,000 fields", "src/bad/msg/Bad.msg", "".join(f"int32 f{n}\n" for n in range(100_000))),
        file_row("msg of brackets", "src/bad/msg/Bad.msg", "int32" + "[]" * 50_000 + " a\n"),
        file_row(
            "msg of long numbers",
            "src/bad/msg/Bad.msg",
            "int32 A="
            + "9" * 100_000
            + "\nint32["
            + "9" * 100_000
            + "] a\nint32[<="
            + "9" * 5_000
            + "] b\nstring<="
            + "9" * 5_000
            + " c\n",
        ),
        file_row("msg that holds itself", "src/bad/msg/Bad.msg", "bad/Bad a\nBad[] b\n"),
        ("msg files, 2^30 of them inside", {f"src/bad/msg/M{n}.msg": f"M{n + 1} a\nM{n + 1} b\n" for n in range(30)}),
        file_row("idl nested deeply", "src/bad/msg/Bad.idl", "module a {" * 50_000),
        file_row(
            "idl of sequences",
            "src/bad/msg/Bad.idl",
            "module a { struct B { " + "sequence<" * 50_000 + "long" + ">" * 50_000 + " x; }; };",
        ),
        file_row("shell nested deeply", "src/bad/scripts/run.sh", "#!/bin/bash\n" + "$(" * 50_000 + "\n"),
        file_row("shell of open quotes", "src/bad/scripts/run.sh", "#!/bin/bash\nros2 run " + "'\"`" * 50_000 + "\n"),
        file_row("shell of here documents", "src/bad/scripts/run.sh", "#!/bin/bash\n" + "cat <<E " * 20_000 + "\n"),
        file_row("shell of ifs", "src/bad/scripts/run.sh", "#!/bin/bash\n" + "if true; then\n" * 20_000),
        file_row(
            "plugins of 50,000 classes",
            "src/bad/plugins.xml",
            "<library path='x'>"
            + "".join(f"<class name='c{n}' type='c{n}' base_class_type='b'/>" for n in range(50_000))
            + "</library>",
        ),
        file_row(
            "comment that suppresses everything, long",
            "src/bad/CMakeLists.txt",
            CMAKE.format(name="bad", more="# rosimpact: ignore[" + "a," * 300_000 + "]"),
        ),
        file_row("a file of 3 GB without contents", "src/bad/src/n.cpp", b""),
        file_row(
            "spaces before a keyword, for regular expressions",
            "src/bad/src/n.cpp",
            "#include" + " " * 1_000_000 + "\nclass" + " " * 1_000_000 + "\nusing" + "\t" * 1_000_000,
        ),
        file_row(
            "spaces in Python, for regular expressions",
            "src/bad/scripts/n.py",
            "import" + " " * 1_000_000 + "\nx = 1" + " " * 1_000_000 + "#",
        ),
        file_row(
            "spaces in CMake, for regular expressions",
            "src/bad/CMakeLists.txt",
            CMAKE.format(name="bad", more="find_package" + " " * 1_000_000 + "(\n\n" + "\n" * 1_000_000 + ")"),
        ),
        file_row("spaces in a msg, for regular expressions", "src/bad/msg/Bad.msg", "int32" + " " * 900_000 + "\n"),
        file_row("dashes in an srv", "src/bad/srv/Bad.srv", "---\n" * 200_000),
        file_row("hashes in a parameter file", "src/bad/config/a.yaml", "#" * 3_000_000),
    ]

DEAR = ("700 MB", "inflates", "100,000 files", "10,000 empty", "2,000 packages", "C++: 60 MB", "manifest of 100 MB")
FLOW = (
    "Python: 2^40 paths of calls",
    "C++: 2^40 paths of calls",
    "C++: mutual recursion",
    "C++: variable that doubles",
    "C++: 50,000 else if",
    "C++: 20,000 publishers",
    "C++: conditions for the solver",
    "Python: 50,000 elif",
    "Python: powers",
    "Python: text times a number",
    "Python: range of 10^12",
    "Python: lists that double",
    "launch files, 2^30 includes",
    "launch of arguments that double",
    "launch of 20,000 nodes",
    "launch of eval",
    "launch.py that loops",
    "launch.py of 10^9 nodes",
    "launch.py that recurs",
    "YAML aliases in src/bad/config/a.yaml",
    "msg files, 2^30 of them inside",
    "C++: sum of 100,000 strings",
    "launch.xml that includes itself twice",
)


def deep_folders(levels: int) -> Callable[[Place], None]:
    def make(place: Place) -> None:
        here = os.getcwd()
        try:
            os.chdir(place.ws / "src/bad")
            for _ in range(levels):
                os.mkdir("d")
                os.chdir("d")
            with open("a.cpp", "w") as file:
                file.write("int a;\n")
        finally:
            os.chdir(here)

    return make


def large(path: str, part: bytes, count: int) -> Callable[[Place], None]:
    """A large file, which is not kept in memory as the others are."""
    return lambda place: write(place.ws, {path: part * count})


def many_files(place: Place) -> None:
    folder = place.ws / "src/bad/data"
    folder.mkdir()
    for number in range(100_000):
        os.close(os.open(folder / f"f{number}.txt", os.O_CREAT | os.O_WRONLY))


def many_packages(place: Place) -> None:
    write(place.ws, {f"src/p{n}/package.xml": manifest(f"p{n}", f"p{n + 1}") for n in range(2_000)})


def many_sources(place: Place) -> None:
    write(place.ws, {f"src/bad/src/f{n}.cpp": "" for n in range(10_000)})


def sparse(path: str, size: int, head: bytes = b"") -> Callable[[Place], None]:
    def make(place: Place) -> None:
        file = place.ws / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(head)
        os.truncate(file, size)

    return make


def elf(loop: str) -> bytes:
    """A library of 64 bits that says wrong things of itself."""
    head = bytearray(b"\x7fELF" + bytes([2, 1, 1]) + bytes(9))
    head += struct.pack(
        "<HHIQQQIHHHHHH",
        3,
        62,
        1,
        0,
        64,
        64,
        0,
        64,
        56,
        0xFFFF if loop == "segments" else 1,
        64,
        0xFFFF if loop == "sections" else 1,
        0,
    )
    size = 1 << 62 if loop == "size" else 4096
    start = 64 if loop == "itself" else 176
    head += struct.pack("<IIQQQQQQ", 2, 6, start, start, start, size, size, 8)
    head += bytes(56)
    for tag, value in ((1, 1 << 60), (5, 176), (10, 1 << 60), (14, 1 << 40), (29, 3)):
        head += struct.pack("<QQ", tag, value)
    if loop == "tags":
        head += struct.pack("<QQ", 1, 1) * 200_000
    return bytes(head) + b"\xff" * 4096


def tree_of_trees(place: Place) -> None:
    """A commit whose folders stand for 10^10 files."""
    repository = pygit2.Repository(str(place.ws))
    blob = repository.create_blob(b"x")
    tree = blob
    mode = pygit2.GIT_FILEMODE_BLOB
    for _ in range(10):
        builder = repository.TreeBuilder()
        for name in "abcdefghij":
            builder.insert(name, tree, mode)
        tree, mode = builder.write(), pygit2.GIT_FILEMODE_TREE
    top = repository.TreeBuilder(repository.head.peel(pygit2.Commit).tree)
    top.insert("bomb", tree, mode)
    who = pygit2.Signature("a", "a@b.org", 1_700_000_300, 0)
    repository.create_commit("HEAD", who, who, "bomb", top.write(), [repository.head.target])


def deep_tree(place: Place) -> None:
    repository = pygit2.Repository(str(place.ws))
    tree, mode = repository.create_blob(b"x"), pygit2.GIT_FILEMODE_BLOB
    for _ in range(5_000):
        builder = repository.TreeBuilder()
        builder.insert("d", tree, mode)
        tree, mode = builder.write(), pygit2.GIT_FILEMODE_TREE
    top = repository.TreeBuilder(repository.head.peel(pygit2.Commit).tree)
    top.insert("deep", tree, mode)
    who = pygit2.Signature("a", "a@b.org", 1_700_000_300, 0)
    repository.create_commit("HEAD", who, who, "deep", top.write(), [repository.head.target])


def large_blob(path: str) -> Callable[[Place], None]:
    def make(place: Place) -> None:
        repository = pygit2.Repository(str(place.ws))
        blob = repository.create_blob(b" " * 700_000_000)
        commit_blob(repository, path, blob)

    return make


def commit_blob(repository: pygit2.Repository, path: str, blob: object, mode: int = pygit2.GIT_FILEMODE_BLOB) -> None:
    """A commit on HEAD with a blob at a path."""

    def placed(tree: pygit2.Tree | None, parts: list[str]) -> object:
        builder = repository.TreeBuilder(tree) if tree is not None else repository.TreeBuilder()
        if len(parts) == 1:
            builder.insert(parts[0], blob, mode)
        else:
            inner = tree[parts[0]] if tree is not None and parts[0] in tree else None
            builder.insert(parts[0], placed(inner, parts[1:]), pygit2.GIT_FILEMODE_TREE)
        return builder.write()

    tree = placed(repository.head.peel(pygit2.Commit).tree, path.split("/"))
    who = pygit2.Signature("a", "a@b.org", 1_700_000_300, 0)
    repository.create_commit("HEAD", who, who, "blob", tree, [repository.head.target])


def loose_bomb(place: Place) -> None:
    """The object of CMakeLists.txt of `bad`, replaced by one that says it is small and inflates to 2 GB."""
    repository = pygit2.Repository(str(place.ws))
    name = str(repository.head.peel(pygit2.Commit).tree["src/bad/CMakeLists.txt"].id)
    path = place.ws / ".git/objects" / name[:2] / name[2:]
    path.chmod(0o644)
    packer = zlib.compressobj(9)
    data = packer.compress(b"blob 2000000000\0")
    block = b" " * 10_000_000
    path.write_bytes(data + b"".join(packer.compress(block) for _ in range(200)) + packer.flush())


def deb(inner: str) -> Callable[[Place], None]:
    def make(place: Place) -> None:
        if inner == "xz":
            packed = lzma.compress(b"\0" * 1_500_000_000, preset=0)
        elif inner == "zst":
            import zstandard

            packer = zstandard.ZstdCompressor(level=1).compressobj()
            block = b"\0" * 10_000_000
            packed = b"".join(packer.compress(block) for _ in range(300)) + packer.flush()
        else:
            packer = zlib.compressobj(9, zlib.DEFLATED, 31)
            block = b"\0" * 10_000_000
            packed = b"".join(packer.compress(block) for _ in range(200)) + packer.flush()
        parts = [("debian-binary", b"2.0\n"), (f"control.tar.{inner}", packed), (f"data.tar.{inner}", packed)]
        data = b"!<arch>\n"
        for name, content in parts:
            data += f"{name:<16}{0:<12}{0:<6}{0:<6}{100644:<8}{len(content):<10}`\n".encode() + content
            data += b"\n" * (len(content) % 2)
        write(place.ws, {"a.deb": data})

    return make


def rows() -> list[Attack]:
    found: list[Attack] = []
    table = dict(make_files())
    for name, files in table.items():
        if "3 GB" in name:
            found.append(Attack(name, GROUP, sparse("src/bad/src/n.cpp", 3_000_000_000), CHECK))
        else:
            found.append(Attack(name, GROUP, files, CHECK))
    for command in ("graph", "impact", "logic"):
        for name in FLOW:
            if command == "logic" and name.startswith(("launch", "YAML", "msg")):
                continue
            make = table[name]
            if command == "graph" and "launch" in name:
                path = next(iter(make))
                arguments = (*COMMANDS["graph"], "--launch", os.path.basename(path))
                found.append(Attack(f"graph --launch: {name}", GROUP, make, arguments, found="", status=(0, 2)))
            found.append(
                Attack(
                    f"{command}: {name}",
                    GROUP,
                    committed(make) if command in NEEDS_GIT else make,
                    COMMANDS[command],
                    (STATUS[command],),
                    git=command in NEEDS_GIT,
                )
            )
    for command in ("upgrade", "why", "env"):
        for name in (
            "YAML aliases in defaults.yaml",
            "XML entities in src/bad/package.xml",
            "C++: 50,000 else if",
            "CMake: 50,000 elseif",
            "package.xml of 100,000 dependencies",
            "CMake: string(REPEAT)",
        ):
            found.append(Attack(f"{command}: {name}", GROUP, table[name], COMMANDS[command], (STATUS[command],)))
    toml = {
        "dotted keys": ".".join("a" * 40_000) + " = 1\n",
        "nested": "a = " + "[" * 100_000,
        "tables": "".join(f"[{'.'.join('a' * n)}]\n" for n in range(1, 1_200)),
        "dotted targets": "[targets]\n" + ".".join("a" * 20_000) + ".distro = 'humble'\n",
        "100,000 targets": "".join(f"[targets.t{n}]\ndistro = 'humble'\n" for n in range(20_000)),
        "long integer": "[check]\nfail_on = " + "9" * 100_000 + "\n",
        "10,000 patterns": "".join(f'[paths."{"*" * 30}a{n}"]\nignore = ["all"]\n' for n in range(1_000)),
        "a pattern that backtracks": '[paths."' + "**/*a" * 30 + 'b"]\nignore = ["removed-header"]\n',
        "private names that backtrack": "[workspace]\nprivate = ['" + "*a" * 40 + "b']\n",
        "3 MB": "# " + "x" * 3_000_000,
    }
    found += [
        Attack(
            f"rosimpact.toml: {name}",
            GROUP,
            {"rosimpact.toml": text, "src/" + "a" * 60 + "/package.xml": manifest("a" * 60, "a" * 70)},
            CHECK,
            refusable="rosimpact.toml",
        )
        for name, text in toml.items()
    ]
    settings = {"rosdep_sources": "['r.yaml']", "repos": "['r.yaml']", "index": "'r.yaml'", "underlays": "['r.yaml']"}
    for key, value in settings.items():
        for what, text in {
            "aliases": aliases(),
            "merges": merges(),
            "deep": "a: " + "[" * 60_000,
            "zeros": b"\0" * 5_000_000,
        }.items():
            found.append(
                Attack(
                    f"rosimpact.toml: {key} of {what}",
                    GROUP,
                    {"rosimpact.toml": f"[workspace]\n{key} = {value}\n", "r.yaml": text},
                    CHECK,
                    refusable="r.yaml",
                )
            )
    given = {
        "baseline": ("k.json", (*CHECK, "--baseline", "{ws}/k.json")),
        "machine": ("k.json", ("check", "{ws}", "-t", "{ws}/k.json")),
        "repos": ("k.repos", (*CHECK, "--base", "{ws}/k.repos")),
        "listing": ("k.dpkg.txt", ("check", "{ws}", "-t", "{ws}/k.dpkg.txt")),
    }
    contents: dict[str, str | bytes] = {
        "deep JSON": "[" * 500_000,
        "a long integer": '{"schema": ' + "9" * 100_000 + "}",
        "aliases": aliases(),
        "lines without end": "x" * 5_000_000,
        "zeros": b"\0" * 5_000_000,
        "many objects": '{"schema": 1, "findings": [' + "{}," * 300_000 + "{}]}",
    }
    for what, (path, command) in given.items():
        for name, content in contents.items():
            found.append(
                Attack(f"{what} of {name}", GROUP, {path: content}, command, status=(2,), found="", words=(path,))
            )
    install = (*CHECK, "--install", "{ws}/install")
    for kind in ("itself", "size", "segments", "sections", "tags"):
        found.append(Attack(f"library that loops: {kind}", GROUP, {"install/bad/lib/libbad.so": elf(kind)}, install))
    found += [
        Attack(
            "library of 3 GB",
            GROUP,
            sparse("install/bad/lib/libbad.so", 3_000_000_000, elf("itself")[:200]),
            install,
            (0, 1, 2),
            found="",
        ),
        Attack("C++: 60 MB", GROUP, large("src/bad/src/n.cpp", b"int a;\n", 8_600_000), CHECK),
        Attack("a manifest of 100 MB", GROUP, large("src/bad/package.xml", b"<package>  ", 9_000_000), CHECK),
        Attack(
            "rosimpact.toml: 100 MB",
            GROUP,
            large("rosimpact.toml", b"# x\n", 25_000_000),
            CHECK,
            refusable="rosimpact.toml",
        ),
        Attack("folders 1,500 deep", GROUP, deep_folders(1_500), CHECK, snapshot=False),
        Attack("graph: folders 1,500 deep", GROUP, deep_folders(1_500), COMMANDS["graph"], snapshot=False),
        Attack("100,000 files in a folder", GROUP, many_files, CHECK, snapshot=False),
        Attack("10,000 empty sources", GROUP, many_sources, CHECK, snapshot=False, seconds=15),
        Attack("2,000 packages in a row", GROUP, many_packages, CHECK, snapshot=False, seconds=15),
        Attack(
            "a git tree of 10^10 names",
            GROUP,
            tree_of_trees,
            (*CHECK, "--rev", "HEAD"),
            git=True,
            status=(0, 1, 2),
            found="",
        ),
        Attack(
            "a git tree of 10^10 names, base",
            GROUP,
            tree_of_trees,
            (*CHECK, "--base", "HEAD~1"),
            git=True,
            status=(0, 1, 2),
            found="",
        ),
        Attack(
            "logic: a git tree of 10^10 names",
            GROUP,
            tree_of_trees,
            COMMANDS["logic"],
            git=True,
            status=(0, 2),
            found="",
        ),
        Attack(
            "impact: a git tree of 10^10 names",
            GROUP,
            tree_of_trees,
            COMMANDS["impact"],
            git=True,
            status=(0, 2),
            found="",
        ),
        Attack(
            "graph: a git tree of 10^10 names",
            GROUP,
            tree_of_trees,
            (*COMMANDS["graph"], "--rev", "HEAD"),
            git=True,
            status=(0, 2),
            found="",
        ),
        Attack(
            "a git tree 5,000 deep", GROUP, deep_tree, (*CHECK, "--rev", "HEAD"), git=True, status=(0, 1, 2), found=""
        ),
        Attack("logic: a git tree 5,000 deep", GROUP, deep_tree, COMMANDS["logic"], git=True, status=(0, 2), found=""),
        Attack("a git blob of 700 MB", GROUP, large_blob("src/bad/src/big.cpp"), (*CHECK, "--rev", "HEAD"), git=True),
        Attack("logic: a git blob of 700 MB", GROUP, large_blob("src/bad/src/big.cpp"), COMMANDS["logic"], git=True),
        Attack(
            "a git blob of 700 MB as package.xml",
            GROUP,
            large_blob("src/bad/package.xml"),
            (*CHECK, "--rev", "HEAD"),
            git=True,
        ),
        Attack(
            "a git blob of 700 MB as rosimpact.toml",
            GROUP,
            large_blob("rosimpact.toml"),
            (*CHECK, "--rev", "HEAD"),
            git=True,
            refusable="rosimpact.toml",
        ),
        Attack("a git object that inflates to 2 GB", GROUP, loose_bomb, (*CHECK, "--rev", "HEAD"), git=True),
        Attack(
            "logic: a git object that inflates to 2 GB",
            GROUP,
            loose_bomb,
            COMMANDS["logic"],
            git=True,
            status=(0, 2),
            found="",
        ),
        *[
            Attack(
                f"a Debian package that inflates: {kind}",
                GROUP,
                deb(kind),
                ("surface", "diff", "rclcpp", "{ws}/a.deb", "jazzy"),
                status=(0, 1, 2),
                found="",
            )
            for kind in ("xz", "zst", "gz")
        ],
        Attack(
            "a report of 100 MB to triage",
            GROUP,
            large("r.txt", b"x ", 50_000_000),
            ("triage", "{ws}/r.txt"),
            status=(0, 2),
            found="",
        ),
        Attack(
            "a report without end to triage", GROUP, {}, ("triage", "-"), status=(0, 2), found="", stdin="/dev/zero"
        ),
        Attack(
            "a report in JSON, deep",
            GROUP,
            {"r.jsonl": '{"title": ' + "[" * 500_000},
            ("triage", "{ws}/r.jsonl", "--jsonl"),
            status=(0, 2),
            found="",
        ),
        Attack("installed command: YAML aliases", GROUP, {"defaults.yaml": aliases()}, CHECK, direct=True),
    ]
    return [row._replace(dear=True) if any(word in row.name for word in DEAR) else row for row in found]


def committed(files: dict[str, str | bytes]) -> Callable[[Place], None]:
    from .harness import commit

    def make(place: Place) -> None:
        write(place.ws, files)
        text = (place.ws / "src/healthy/src/node.cpp").read_text()
        write(place.ws, {"src/healthy/src/node.cpp": text.replace("> 3", "> 4")})
        commit(place.ws, "more", time=1_700_000_200)

    return make

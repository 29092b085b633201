"""Prunes generated workspaces of ROS 1, builds and runs them, and compares what their nodes say with what they said.

usage: prune_property.py [--cpp 100] [--python 100] [--first 0] [--jobs 2] [--keep FOLDER] [--results FILE]

A workspace is made from its number: messages with nested ones, arrays, strings, headers and constants; nodes in C++ or
Python that fill and publish them on several topics; callbacks of all forms that read some fields, directly, through
helpers, members, aliases and parts. The planner of `rosimpact prune` sees sources as users write them. They are built
with the headers of roscpp and the generators of ROS 1 (pruning/generate.py), and run in one process without a master:
publish() serializes, and every subscriber is given what it deserializes itself (pruning/facade.cpp, pruning/facade).
Both versions must write the same lines, and a workspace that is pruned must send fewer bytes.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import re
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

HERE = Path(__file__).parent / "pruning"
PYTHON = "/usr/bin/python3"
PRIMITIVES = ("bool", "int8", "uint8", "int16", "int32", "uint32", "int64", "float32", "float64", "string", "time",
              "duration")  # fmt: skip
LIBRARIES = ("roscpp", "rostime", "rosconsole", "roscpp_serialization", "boost_thread")


class Field(NamedTuple):
    """A field. array: "", "[]" or "[N]"."""

    name: str
    type: str
    array: str = ""


class Outcome(NamedTuple):
    """What became of a workspace. state: "equal", "refused" (nothing was pruned) or "FAILED"."""

    name: str
    state: str
    pruned: int
    refusals: tuple[str, ...]
    before: int = 0
    after: int = 0
    detail: str = ""


class Case:
    """A workspace by its number. files: text by path; nodes: sources that have a `main`, those that subscribe first."""

    def __init__(self, number: int, language: str):
        self.random = random.Random(f"{language}{number}")
        self.name = f"{language}{number}"
        self.package = f"{language}{number}_msgs"
        self.language = language
        self.files: dict[str, str] = {}
        self.nodes: list[str] = []
        self.messages: dict[str, list[Field]] = {}
        self.topics: list[tuple[str, str]] = []
        self._count = 0
        # Every callback of a message's type reads the same fields, so that topics share a lighter message.
        self.alike = self.chance(0.25)
        self._make_messages()
        (CppWriter if language == "cpp" else PythonWriter)(self).write()
        self._finish()

    def chance(self, share: float) -> bool:
        """Whether something that happens in a share of cases does here."""
        return self.random.random() < share

    def name_new(self, stem: str) -> str:
        """A name that is used nowhere else."""
        self._count += 1
        return f"{stem}{self._count}"

    def _make_messages(self) -> None:
        pick = self.random.choice
        names = ["Inner", "Part", "Whole", "Other"]
        for place, name in enumerate(names[: 2 + self.random.randrange(3)]):
            fields: list[Field] = []
            if self.chance(0.3):
                fields.append(Field("header", "Header"))
            for number in range(self.random.randint(2, 5)):
                fields.append(Field(f"{name.lower()[0]}{number}", pick(PRIMITIVES), pick(("", "", "", "[]", "[3]"))))
            for number, inner in enumerate(names[:place]):
                if self.chance(0.7):
                    fields.append(Field(f"{inner.lower()}_{number}", inner, pick(("", "", "[]", "[]", "[2]"))))
            self.random.shuffle(fields)
            self.messages[name] = fields
            lines = [f"{one.type}{one.array} {one.name}" for one in fields]
            if self.chance(0.4):
                lines.insert(0, "int32 LIMIT=7")
            self.files[f"{self.package}/msg/{name}.msg"] = "\n".join(lines) + "\n"
        tops = list(self.messages)[-2:]
        for number in range(self.random.randint(1, 3)):
            self.topics.append((f"topic{number}", pick(tops)))
        if self.alike:
            self.topics.append((f"topic{len(self.topics)}", self.topics[0][1]))

    @contextmanager
    def choose_alike(self, type_: str) -> Iterator[None]:
        """Within it, what is read of a message of a type is the same each time, if the case is such a one."""
        state = self.random.getstate()
        if self.alike:
            self.random.seed(f"{self.name} {type_}")
        yield
        if self.alike:
            self.random.setstate(state)

    def _finish(self) -> None:
        head = '<package format="2"><name>{}</name><version>1.0.0</version><description>d</description>\n' \
            '<maintainer email="a@b.org">m</maintainer><license>BSD</license>\n' \
            "<buildtool_depend>catkin</buildtool_depend><depend>{}</depend></package>\n"
        listed = " ".join(f"{name}.msg" for name in self.messages)
        self.files[f"{self.package}/package.xml"] = head.format(self.package, "std_msgs")
        self.files[f"{self.package}/CMakeLists.txt"] = (
            f"project({self.package})\nfind_package(catkin REQUIRED COMPONENTS message_generation std_msgs)\n"
            f"add_message_files(FILES {listed})\ngenerate_messages(DEPENDENCIES std_msgs)\ncatkin_package()\n"
        )
        self.files["nodes/package.xml"] = head.format("nodes", f"roscpp</depend><depend>{self.package}")
        build = f"project(nodes)\nfind_package(catkin REQUIRED COMPONENTS roscpp {self.package})\ncatkin_package()\n"
        for number, node in enumerate(self.nodes if self.language == "cpp" else ()):
            build += f"add_executable(node{number} {node.removeprefix('nodes/')})\n"
        self.files["nodes/CMakeLists.txt"] = f"{build}include_directories(include)\n"

    def write(self, root: Path) -> None:
        """Writes the workspace to a folder; now and then with other ends of lines."""
        endings = self.random.choice(("\n", "\n", "\n", "\r\n"))
        mark = "\ufeff" if self.chance(0.1) else ""
        for name, text in self.files.items():
            path = root / name
            path.parent.mkdir(parents=True, exist_ok=True)
            code = name.startswith("nodes/") and name.endswith((".cpp", ".py", ".h"))
            text = text.replace("\n", endings) if code else text
            path.write_bytes(((mark if code and not text.startswith("#!") else "") + text).encode())


class CppWriter:
    """The nodes of a case in C++."""

    def __init__(self, case: Case):
        self.case, self.pick, self.chance = case, case.random.choice, case.chance
        self.space = case.package
        self.using = case.chance(0.2)
        self.before: list[str] = []
        self.members: list[str] = []
        self.later: list[str] = []

    def spell(self, type_: str) -> str:
        """A message's name in the code."""
        return type_ if self.using else f"{self.space}::{type_}"

    def write(self) -> None:
        """Puts the files into the case."""
        case = self.case
        includes = "".join(f"#include <{case.package}/{name}.h>\n" for name in case.messages)
        standard = "#include <boost/bind/bind.hpp>\n#include <iostream>\n#include <vector>\n\n"
        start = f"#include <ros/ros.h>\n{includes}{standard}"
        if self.using:
            start += f"using namespace {case.package};\n\n"
        bodies = [self.make_callback(topic, type_) for topic, type_ in case.topics for _ in range(self.pick((1, 1, 2)))]
        hear = self._write_class(start, bodies)
        self.before, self.members, self.later = [], [], []
        talk = self._write_talker()
        one = self.chance(0.25)
        if one:
            text = hear.replace("MAIN", "") + talk.replace("MAIN", "  Hear hear;\n")
            case.files["nodes/src/node.cpp"] = text
            case.nodes.append("nodes/src/node.cpp")
            return
        main = 'int main(int argc, char** argv) {\n  ros::init(argc, argv, "hear");\n' \
            "  static Hear hear;\n  ros::spin();\n  hear.finish();\n  return 0;\n}\n"
        case.files["nodes/src/hear.cpp"] = hear + main
        case.files["nodes/src/talk.cpp"] = start + talk.replace("MAIN", "")
        case.nodes += ["nodes/src/hear.cpp", "nodes/src/talk.cpp"]

    # Subscribers

    def make_callback(self, topic: str, type_: str) -> tuple[str, str, str]:
        """A declaration, a body, and the statement that subscribes."""
        name, spelt = self.case.name_new("on"), self.spell(type_)
        parameters = (
            (f"const {spelt}::ConstPtr& m", "->"), (f"const {spelt}ConstPtr &m", "->"), (f"{spelt}ConstPtr m", "->"),
            (f"const {spelt}& m", "."), (f"{spelt} m", "."), (f"const boost::shared_ptr<{spelt} const>& m", "->"),
            (f"const boost::shared_ptr<const {spelt}> & m", "->"), (f"{spelt}::ConstPtr const& m", "->"),
            (f"const ros::MessageEvent<{spelt} const>& m", "event"),
        )  # fmt: skip
        parameter, access = self.pick(parameters)
        lines: list[str] = []
        base = "m"
        if access == "event":
            lines.append(f"const {spelt}ConstPtr& e = m.getMessage();")
            base, access = "e", "->"
        whole = f"*{base}" if access == "->" else base
        form = self.pick(("direct",) * 5 + ("helper", "pointer", "member", "alias", "copy", "listed", "struct",
                                            "template", "macro", "overload", "constructed"))  # fmt: skip
        lines.append(f'std::cout << "{topic} {name}";')
        if form == "direct" or (form == "pointer" and (access == "." or base == "e")):
            lines += self.read_whole(f"{base}{access}", type_)
        elif form in ("helper", "template", "overload", "macro"):
            helper = self.case.name_new("help")
            inner = "\n".join(f"  {one}" for one in self.read_whole("x.", type_))
            kind = f"inline void {{}}(const {spelt}& x)"
            kind = "template <class T> void {}(const T& x)" if form == "template" else kind
            self.before.append(f"{kind.format(helper)} {{\n{inner}\n}}")
            if form == "overload":
                self.before.append(f"inline void {helper}(int x) {{ std::cout << x; }}")
            if form == "macro":
                self.before.append(f"#define CALL_{helper.upper()}(x) {helper}(x)")
                helper = f"CALL_{helper.upper()}"
            lines.append(f"{helper}({whole});")
        elif form == "pointer":
            helper = self.case.name_new("help")
            inner = "\n".join(f"  {one}" for one in self.read_whole("x->", type_))
            self.before.append(f"inline void {helper}(const {spelt}::ConstPtr& x) {{\n{inner}\n}}")
            lines.append(f"{helper}({base});")
        elif form == "member":
            kept = self.case.name_new("last")
            self.members.append(f"{spelt} {kept}_;")
            lines.append(f"{kept}_ = {whole};")
            lines += self.read_whole(f"{kept}_.", type_)
        elif form == "alias":
            lines.append(f"const {self.pick((spelt, 'auto'))}& a = {whole};")
            lines += self.read_whole("a.", type_)
        elif form == "copy":
            lines.append(self.pick((f"{spelt} c = {whole};", f"{spelt} c({whole});", f"auto c = {whole};")))
            lines += self.read_whole("c.", type_)
        elif form == "listed":
            kept = self.case.name_new("list")
            self.members.append(f"std::vector<{spelt}> {kept}_;")
            lines.append(f"{kept}_.push_back({whole});")
            lines += self.read_whole(f"{kept}_.back().", type_)
        elif form == "struct":
            kept = self.case.name_new("Box")
            self.before.append(f"struct {kept} {{\n  {spelt} inside;\n}};")
            lines += [f"{kept} box;", f"box.inside = {whole};", *self.read_whole("box.inside.", type_)]
        elif form == "constructed":
            kept = self.case.name_new("Seen")
            inner = " ".join(self.read_whole("x.", type_))
            self.before.append(f"struct {kept} {{\n  explicit {kept}(const {spelt}& x) {{ {inner} }}\n}};")
            lines.append(f"{kept} seen({whole});")
        lines.append("std::cout << std::endl;")
        if self.chance(0.08):
            again = self.case.name_new("again")
            self.members.append(f"ros::Publisher {again}_ = nh_.advertise<{spelt}>(\"{again}\", 1);")
            lines.append(f"{again}_.publish({self.pick((whole, base))});")
        return self._subscribe(topic, spelt, name, parameter, lines)

    def _subscribe(self, topic: str, spelt: str, name: str, parameter: str, lines: list[str]) -> tuple[str, str, str]:
        members = any(re.search(r"\b(last|list|again)\d+_", one) for one in lines)
        form = self.pick(("method", "method", "free", "lambda", "split", "bind"))
        if members and form == "free":
            form = "method"
        tab = self.pick(("  ", "    ", "\t"))
        body = "\n".join(f"{tab}{one}" for one in lines)
        if self.chance(0.15):
            body = tab + " ".join(lines)
        wide = re.sub(r"^const |[ &]*&\s*m$| m$", "", parameter)
        if form == "free":
            self.before.append(f"void {name}({parameter})\n{{\n{body}\n}}")
            return "", "", f'nh_.subscribe("{topic}", 10, {self.pick(("", "&"))}{name})'
        if form == "lambda" and "ConstPtr" in wide and "Event" not in wide:
            plain = parameter if "::ConstPtr&" in parameter else f"const {spelt}::ConstPtr& m"
            call = f'nh_.subscribe<{spelt}>("{topic}", 10, [this]({plain}) {{\n{body}\n  }})'
            return "", "", call
        if form == "bind" and parameter == f"const {spelt}::ConstPtr& m":
            call = f'nh_.subscribe<{spelt}>("{topic}", 10, boost::bind(&Hear::{name}, this, boost::placeholders::_1))'
            return f"  void {name}({parameter}) {{\n{body}\n  }}", "", call
        call = f'nh_.subscribe("{topic}", 10, &Hear::{name}, this)'
        if form == "split":
            declared = re.sub(r"\bm$", "", parameter).rstrip() if self.chance(0.3) else parameter
            return f"  void {name}({declared});", f"void Hear::{name}({parameter})\n{{\n{body}\n}}", call
        return f"  void {name}({parameter}) {{\n{body}\n  }}", "", call

    def _write_class(self, start: str, bodies: Sequence[tuple[str, str, str]]) -> str:
        subscribers = [f"sub{number}_" for number, _ in enumerate(bodies)]
        made = "\n".join(f"    {name} = {call};" for name, (_, _, call) in zip(subscribers, bodies, strict=True))
        declared = "\n".join(one for one, _, _ in bodies if one)
        members = "\n".join(f"  {one}" for one in ("ros::NodeHandle nh_;", *self.members))
        handles = "\n".join(f"  ros::Subscriber {name};" for name in subscribers)
        text = "\n\n".join(self.before) + (
            f"\n\nclass Hear {{\n public:\n  Hear() {{\n{made}\n  }}\n{declared}\n  void finish() {{}}\n private:\n"
            f"{members}\n{handles}\n}};\n\n"
        )
        sources = "\n\n".join(one for _, one, _ in bodies if one) + "\n\n"
        if self.chance(0.4):
            guard = self.pick(("#pragma once\n", "#ifndef HEAR_H\n#define HEAR_H\n"))
            end = "#endif\n" if "ifndef" in guard else ""
            self.case.files["nodes/include/nodes/hear.h"] = f"{guard}{start}{text}{end}"
            return f'#include "nodes/hear.h"\n\n{sources}'
        return f"{start}{text}{sources}"

    def read_whole(self, base: str, type_: str) -> list[str]:
        """Statements that print some fields of the message of a topic. base: with `.` or `->`."""
        with self.case.choose_alike(type_):
            return self.read(base, type_)

    def read(self, base: str, type_: str, depth: int = 0) -> list[str]:
        """Statements that print some fields of a message. base: with `.` or `->`."""
        lines: list[str] = []
        for field in self.case.messages[type_]:
            if not self.chance(0.4):
                continue
            at, name = f"{base}{field.name}", self.case.name_new("v")
            if field.type == "Header":
                lines.append(self.pick((f"std::cout << ' ' << {at}.seq << {at}.frame_id;",
                                        f"std::cout << ' ' << {at}.stamp.sec;")))  # fmt: skip
            elif field.type in PRIMITIVES:
                lines += self._read_plain(at, field, name)
            elif not field.array:
                spelt = self.spell(field.type)
                made = self.pick(("", "", f"const auto& {name} = {at};", f"auto {name} = {at};",
                                  f"{spelt} {name} = {at};", f"const {spelt}& {name} = {at};"))  # fmt: skip
                lines += [made] * bool(made)
                lines += self.read(f"{name}." if made else f"{at}.", field.type, depth + 1)
            else:
                lines += self._read_elements(at, field, name, depth)
        return lines

    def _read_plain(self, at: str, field: Field, name: str) -> list[str]:
        def show(what: str) -> str:
            if field.type in ("int8", "uint8", "bool"):
                return f"std::cout << ' ' << static_cast<int>({what});"
            if field.type in ("time", "duration"):
                return f"std::cout << ' ' << {what}.toSec();"
            return f"std::cout << ' ' << {what};"

        if not field.array:
            return [self.pick((show(at), f"const auto {name} = {at}; {show(name)}"))]
        if field.array == "[3]":
            return [show(f"{at}[1]")]
        return [self.pick((
            f"std::cout << ' ' << {at}.size();", f"for (const auto& {name} : {at}) {show(name)}",
            f"for (size_t {name} = 0; {name} < {at}.size(); ++{name}) {{ {show(f'{at}[{name}]')} }}",
        ))]  # fmt: skip

    def _read_elements(self, at: str, field: Field, name: str, depth: int) -> list[str]:
        spelt = self.spell(field.type)
        form = self.pick(("index", "range", "range", "typed", "iterator", "size", "front"))
        if form == "size":
            return [f"std::cout << ' ' << {at}.size();"]
        if form == "front":
            inner = " ".join(self.read(f"{at}.{self.pick(('front', 'back'))}().", field.type, depth + 1))
            return [f"if (!{at}.empty()) {{ {inner} }}"]
        if form == "index":
            inner = " ".join(self.read(f"{at}[{name}].", field.type, depth + 1))
            return [f"for (size_t {name} = 0; {name} < {at}.size(); ++{name}) {{ {inner} }}"]
        if form == "iterator":
            inner = " ".join(self.read(f"{name}->", field.type, depth + 1))
            return [f"for (auto {name} = {at}.begin(); {name} != {at}.end(); ++{name}) {{ {inner} }}"]
        inner = " ".join(self.read(f"{name}.", field.type, depth + 1))
        kind = self.pick(("const auto&", "auto", "auto const &")) if form == "range" else f"const {spelt}&"
        return [f"for ({kind} {name} : {at}) {{ {inner} }}"]

    # Publishers

    def _write_talker(self) -> str:
        blocks: list[str] = []
        made: dict[str, str] = {}
        for type_ in self.case.messages:
            made[type_] = self.case.name_new("make")
            fills = "\n".join(f"  {one}" for one in self.fill("m.", type_, made))
            spelt = self.spell(type_)
            blocks.append(f"{spelt} {made[type_]}(int i)\n{{\n  {spelt} m;\n{fills}\n  return m;\n}}")
        sends: list[str] = []
        joined = self.chance(0.25)
        handles = ", ".join(f"pub{number}" for number, _ in enumerate(self.case.topics))
        advertised = [f"ros::Publisher {handles};"] if joined else []
        for number, (topic, type_) in enumerate(self.case.topics):
            spelt, pub, name = self.spell(type_), f"pub{number}", f"m{number}"
            declared = "" if joined else "ros::Publisher "
            advertised.append(f'{declared}{pub} = nh.advertise<{spelt}>("{topic}", 10);')
            make = f"{made[type_]}(i)"
            sends.append(self.pick((
                f"{spelt} {name} = {make}; {pub}.publish({name});", f"{pub}.publish({make});",
                f"{spelt}Ptr {name}(new {spelt}({make}));\n    {pub}.publish({name});",
                f"{spelt}::Ptr {name} = boost::make_shared<{spelt}>({make});\n    {pub}.publish(*{name});",
                f"auto {name} = boost::make_shared<{spelt}>({make}); if (i != 5) {pub}.publish({name});",
                f"if (i % 2) {pub}.publish({make}); else {pub}.publish({made[type_]}(i + 7));",
                f"{spelt} {name};\n    {name} = {make};\n"
                f"    if ({pub}.getNumSubscribers() > 0)\n      {pub}.publish( {name} );",
                f"boost::shared_ptr<{spelt} const> {name}(new {spelt}({make})); {pub}.publish({name});",
            )))  # fmt: skip
        gap = self.pick(("\n    ", " "))
        return "\n\n".join(blocks) + (
            '\n\nint main(int argc, char** argv) {\n  ros::init(argc, argv, "talk");\n  ros::NodeHandle nh;\nMAIN'
            + "  " + self.pick(("\n  ", "\n  ", " ")).join(advertised)
            + f"\n  for (int i = 0; i < 3 && ros::ok(); ++i) {{\n    {gap.join(sends)}\n    ros::spinOnce();\n  }}\n"
            "  return 0;\n}\n"
        )

    def fill(self, base: str, type_: str, made: dict[str, str]) -> Iterator[str]:
        """Statements that set fields."""
        for field in self.case.messages[type_]:
            at, salt = f"{base}{field.name}", self.case.random.randint(1, 9)

            def value(where: str, field: Field = field, salt: int = salt) -> str:
                number = f"({where} + {salt})"
                if field.type == "bool":
                    return f"{number} % 2 == 0"
                if field.type == "string":
                    return f'"s" + std::to_string{number}'
                if field.type in ("time", "duration"):
                    return f"ros::{field.type.title()}{number}"
                return f"{made[field.type]}{number}" if field.type in made else f"{number} * {salt} % 100"

            if field.type == "Header":
                yield f'{at}.frame_id = "map"; {at}.stamp = ros::Time(50 + i);'
            elif not field.array:
                yield f"{at} = {value('i')};"
            elif field.array == "[]":
                yield f"for (int k = 0; k < (i + {salt}) % 4; ++k) {at}.push_back({value('i + k')});"
            else:
                yield f"for (int k = 0; k < {field.array[1]}; ++k) {at}[k] = {value('i + k')};"


class PythonWriter:
    """The nodes of a case in Python."""

    def __init__(self, case: Case):
        self.case, self.pick, self.chance = case, case.random.choice, case.chance
        self.before: list[str] = []
        self.form = ""

    def write(self) -> None:
        """Puts the files into the case."""
        case = self.case
        calls: list[tuple[str, str, list[str], str]] = []
        for topic, type_ in case.topics:
            for _ in range(self.pick((1, 1, 2))):
                calls.append((topic, type_, *self._make_callback(topic, type_)))
        end = self._write_hearer(calls)
        imports = self._write_imports()
        case.files["nodes/scripts/hear.py"] = imports + "\n\n".join(self.before) + end
        self.before = []
        case.files["nodes/scripts/talk.py"] = self._write_talker()
        case.nodes += ["nodes/scripts/hear.py", "nodes/scripts/talk.py"]

    def _write_imports(self) -> str:
        package, names = self.case.package, list(self.case.messages)
        self.form = self.pick(("from", "from", "from", "brackets", "star", "module", "as"))
        start = "#!/usr/bin/env python3\n" if self.chance(0.6) else ""
        start += '"""A node."""\n\n' if self.chance(0.4) else ""
        lines = {
            "from": f"from {package}.msg import {', '.join(names)}",
            "brackets": f"from {package}.msg import (\n    " + ",\n    ".join(names) + ",\n)",
            "star": f"from {package}.msg import *",
            "module": f"import {package}.msg",
            "as": f"import {package}.msg as messages",
        }
        text = f"{start}import copy\n\nimport rospy\n{lines[self.form]}\n\n"
        # What was written before the form was drawn names types by a mark.
        self.before = [re.sub(r"§(\w+)", lambda found: self.spell(found[1]), one) for one in self.before]
        return text

    def spell(self, type_: str) -> str:
        """A message's name in the code."""
        head = {"module": f"{self.case.package}.msg.", "as": "messages."}.get(self.form, "")
        return f"{head}{type_}"

    def _make_callback(self, topic: str, type_: str) -> tuple[list[str], str]:
        name = self.case.name_new("on_")
        lines = [f'out = ["{topic} {name}"]']
        form = self.pick(("direct",) * 5 + ("helper", "member", "alias", "copy", "listed", "deep", "method", "whole",
                                            "asked", "asked"))  # fmt: skip
        if form in ("helper", "method"):
            helper = self.case.name_new("help_")
            inner = "\n".join(f"    {one}" for one in self.read_whole("x", type_) or ["pass"])
            self.before.append(f"def {helper}(x, out):\n{inner}\n")
            lines.append(f"{helper}({self.pick(('m, out', 'm, out=out'))})")
        elif form == "member":
            kept = self.case.name_new("last_")
            lines += [f"self.{kept} = m", *self.read_whole(f"self.{kept}", type_)]
        elif form == "listed":
            kept = self.case.name_new("list_")
            lines += [f"{kept} = []", f"{kept}.append(m)", *self.read_whole(f"{kept}[-1]", type_)]
        elif form in ("alias", "copy", "deep"):
            made = {"alias": "m", "copy": "copy.copy(m)", "deep": "copy.deepcopy(m)"}[form]
            lines += [f"a = {made}", *self.read_whole("a", type_)]
        elif form == "whole" and self.chance(0.4):
            lines.append("out.append(str(m))")
        elif form == "asked":
            at = self.pick(self.case.messages[type_]).name
            lines.append(self.pick((f"out.append(isinstance(m, §{type_}))", f"out.append(hasattr(m, {at!r}))",
                                    "out.append(type(m).__name__)", f"out.append(str(getattr(m, {at!r}))[:9])",
                                    f"out.append(type(m) is §{type_})")))  # fmt: skip
            lines += self.read_whole("m", type_)
        else:
            lines += self.read_whole("m", type_)
        lines.append("print(*out)")
        return lines, name

    def read_whole(self, base: str, type_: str) -> list[str]:
        """Statements that put some fields of the message of a topic into `out`."""
        with self.case.choose_alike(type_):
            return self.read(base, type_)

    def read(self, base: str, type_: str) -> list[str]:
        """Statements that put some fields of a message into `out`."""
        lines: list[str] = []
        for field in self.case.messages[type_]:
            if not self.chance(0.4):
                continue
            at, name = f"{base}.{field.name}", self.case.name_new("v")
            if field.type == "Header":
                lines.append(f"out.append({at}.{self.pick(('frame_id', 'stamp.secs', 'seq'))})")
            elif field.type in PRIMITIVES:
                lines += self._read_plain(at, field, name)
            elif not field.array:
                part = self.chance(0.4)
                lines += [f"{name} = {at}"] * part
                lines += self.read(name if part else at, field.type)
            else:
                lines += self._read_elements(at, field, name)
        return lines

    def _read_plain(self, at: str, field: Field, name: str) -> list[str]:
        convert = ".to_sec()" if field.type in ("time", "duration") else ""
        if not field.array:
            return [f"{name} = {at}{convert}", f"out.append({name})"] if self.chance(0.3) else [
                f"out.append({at}{convert})"
            ]  # fmt: skip
        if field.array == "[3]":
            return [f"out.append({at}[1]{convert})"]
        if field.type == "uint8":
            return [f"out.append(len({at}))"]
        return [self.pick((
            f"out.append(len({at}))", f"out += [{name}{convert} for {name} in {at}]",
            f"for {name} in {at}: out.append({name}{convert})",
        ))]  # fmt: skip

    def _read_elements(self, at: str, field: Field, name: str) -> list[str]:
        form = self.pick(("for", "for", "enumerate", "size", "last", "list", "lambda"))
        plain = [one.name for one in self.case.messages[field.type] if not one.array and one.type in PRIMITIVES]
        if form == "size":
            return [f"out.append(len({at}))"]
        if form in ("list", "lambda") and plain:
            one = self.pick(plain)
            return [f"out += [str({name}.{one}) for {name} in {at}]" if form == "list" else
                    f"out += map(lambda {name}: str({name}.{one}), {at})"]  # fmt: skip
        if form == "last":
            return [f"if {at}:", *(f"    {one}" for one in self.read(f"{at}[-1]", field.type) or ["pass"])]
        head = f"for index, {name} in enumerate({at}):" if form == "enumerate" else f"for {name} in {at}:"
        return [head, *(f"    {one}" for one in self.read(name, field.type) or ["pass"])]

    def _write_hearer(self, calls: Sequence[tuple[str, str, list[str], str]]) -> str:
        methods: list[str] = []
        subscribers: list[str] = []
        tab = self.pick(("    ", "    ", "\t"))
        for number, (topic, type_, lines, name) in enumerate(calls):
            free = self.chance(0.3) and not any("self." in line for line in lines)
            decorated = self.chance(0.15)
            if free:
                body = "\n".join(f"    {one}" for one in lines)
                mark = "@keep_as_is\n" if decorated else ""
                self.before.append(f"{mark}def {name}(m):\n{body}\n")
            else:
                body = "\n".join(f"{tab}{tab}{one.replace('    ', tab)}" for one in lines)
                methods.append(f"{tab}def {name}(self, m):\n{body}\n")
            given = self.pick(("{0!r}, §{1}, {2}", "{0!r}, §{1}, callback={2}, queue_size=3",
                               "name={0!r}, data_class=§{1}, callback={2}",
                               "{0!r}, data_class=§{1}, callback={2}"))  # fmt: skip
            call = given.format(topic, type_, name if free else f"self.{name}")
            subscribers.append(f"{tab}{tab}self.sub{number} = rospy.Subscriber({call})")
        self.before.insert(0, "def keep_as_is(function):\n    return function\n")
        self.before.append(
            f"class Hear:\n{tab}def __init__(self):\n" + "\n".join(subscribers) + "\n\n" + "\n".join(methods)
        )
        return '\n\nrospy.init_node("hear")\nhear = Hear()\nrospy.spin()\n'

    def _write_talker(self) -> str:
        imports = self._write_imports()
        made: dict[str, str] = {}
        blocks: list[str] = []
        for type_ in self.case.messages:
            made[type_] = self.case.name_new("make_")
            fills = "\n".join(f"    {one}" for one in self.fill(type_, made))
            blocks.append(f"def {made[type_]}(i):\n    m = {self.spell(type_)}()\n{fills}\n    return m\n")
        setup: list[str] = []
        sends: list[str] = []
        for number, (topic, type_) in enumerate(self.case.topics):
            pub, make, name = f"pub{number}", f"{made[type_]}(i)", f"m{number}"
            spelt = self.spell(type_)
            setup.append(self.pick((
                f"{pub} = rospy.Publisher({topic!r}, {spelt}, queue_size=10)",
                f"{pub} = rospy.Publisher({topic!r}, data_class={spelt}, queue_size=10)",
                f"{pub} = rospy.Publisher(\n    {topic!r},\n    {spelt},\n    queue_size=10,\n)",
            )))  # fmt: skip
            sends.append(self.pick((
                f"{pub}.publish({make})", f"{name} = {make}\n    {pub}.publish({name})",
                f"{name} = {make}; {pub}.publish({name})", f"{pub}.publish(\n        {make}\n    )",
                f"{pub}.publish(({make}))", f"if {pub}.get_num_connections():\n        {pub}.publish({make})",
                f"{pub}.publish({make} if i % 2 else {made[type_]}(i + 3))",
            )))  # fmt: skip
        short = all("\n" not in one and not one.startswith("if") for one in sends)
        gap = "; " if short and self.chance(0.3) else "\n    "
        body = gap.join(sends)
        return (
            imports + "\n" + "\n\n".join(blocks) + '\n\nrospy.init_node("talk")\n' + "\n".join(setup)
            + "\nrate = rospy.Rate(10)\ni = 0\nwhile not rospy.is_shutdown():\n    " + body
            + "\n    i += 1\n    rate.sleep()\n"
        )  # fmt: skip

    def fill(self, type_: str, made: dict[str, str]) -> Iterator[str]:
        """Statements that set fields."""
        for field in self.case.messages[type_]:
            at, salt = f"m.{field.name}", self.case.random.randint(1, 9)

            def value(where: str, field: Field = field, salt: int = salt) -> str:
                number = f"({where} + {salt})"
                if field.type == "bool":
                    return f"{number} % 2 == 0"
                if field.type == "string":
                    return f'"s" + str{number}'
                if field.type in ("time", "duration"):
                    return f"rospy.{field.type.title()}{number}"
                return f"{made[field.type]}{number}" if field.type in made else f"{number} * {salt} % 100"

            if field.type == "Header":
                yield f'{at}.frame_id = "map"'
                yield f"{at}.stamp = rospy.Time(50 + i)"
            elif not field.array:
                yield f"{at} = {value('i')}"
            else:
                count = f"(i + {salt}) % 4" if field.array == "[]" else field.array[1]
                made_list = f"[{value('i + k')} for k in range({count})]"
                yield f"{at} = bytes({made_list})" if field.type == "uint8" else f"{at} = {made_list}"


# Building and running


def run(command: Sequence[str], **more: object) -> subprocess.CompletedProcess[str]:
    """Runs a program with few resources and a limit of time."""
    return subprocess.run(  # type: ignore[call-overload]
        ["nice", *command], capture_output=True, text=True, timeout=300, check=False, **more
    )


class Builder:
    """Builds and runs. folder: for what all workspaces share."""

    def __init__(self, folder: Path):
        self.folder = folder
        self.flags = ["-O0", "-std=c++14", "-w", "-DROSCONSOLE_SEVERITY=2", "-DBOOST_BIND_GLOBAL_PLACEHOLDERS"]

    def prepare_cpp(self) -> None:
        """Compiles what all nodes in C++ use."""
        head = self.folder / "pch/ros"
        head.mkdir(parents=True, exist_ok=True)
        facade = self.folder / "facade.o"
        if facade.exists():
            return
        (head / "ros.h").write_text("#include_next <ros/ros.h>\n")
        source = self.folder / "all.h"
        source.write_text("#include <ros/ros.h>\n#include <boost/bind/bind.hpp>\n#include <iostream>\n")
        self._check(["g++", *self.flags, "-x", "c++-header", str(source), "-o", str(head / "ros.h.gch")])
        self._check(self._make_command(HERE / "facade.cpp", facade))

    def _check(self, command: Sequence[str]) -> None:
        done = run(command)
        if done.returncode:
            raise BuildError(done.stderr[:3000])

    def _make_command(self, source: Path, out: Path) -> list[str]:
        header = [f"-I{self.folder / 'pch'}", "-include", "ros/ros.h"]
        return ["g++", *self.flags, *header, "-c", str(source), "-o", str(out)]

    def run(self, root: Path, out: Path, case: Case) -> tuple[str, int]:
        """What the nodes of a workspace write, and how many bytes they send. Raises BuildError."""
        cpp, python = out / "include", out / "python"
        package = f"{case.package}={root / case.package / 'msg'}"
        done = run([PYTHON, str(HERE / "generate.py"), "messages", str(cpp), str(python), package])
        if done.returncode:
            raise BuildError(f"{done.stdout}{done.stderr}"[-2000:])
        nodes = [str(root / node) for node in case.nodes]
        if case.language == "python":
            path = os.pathsep.join((str(python), str(HERE / "facade"), "/usr/lib/python3/dist-packages"))
            done = run([PYTHON, "-B", str(HERE / "generate.py"), "run", *nodes], env={**os.environ, "PYTHONPATH": path})
        else:
            objects: list[str] = []
            for number, node in enumerate(nodes):
                objects.append(str(out / f"node{number}.o"))
                # A macro of the command line would make the compiled header useless.
                renamed = out / f"main{number}.h"
                renamed.write_text(f"#define main run_node{number}\n")
                more = ["-include", str(renamed), f"-I{cpp}", f"-I{root / 'nodes/include'}"]
                self._check([*self._make_command(Path(node), Path(objects[-1])), *more])
            program = str(out / "program")
            libraries = [f"-l{one}" for one in LIBRARIES]
            self._check(["g++", *objects, str(self.folder / "facade.o"), "-o", program, *libraries])
            done = run([program])
        if done.returncode:
            raise BuildError(f"exit {done.returncode}: {done.stdout[-500:]} {done.stderr[-2000:]}")
        return done.stdout, sum(int(line.split()[1]) for line in done.stderr.splitlines())


class BuildError(Exception):
    """A version that does not build, or does not run to its end."""


class Pruned(NamedTuple):
    """A workspace that was pruned in a folder, to `after` beside `before`."""

    case: Case
    root: Path
    pruned: int
    refusals: tuple[str, ...]


def prune_case(case: Case, root: Path) -> Pruned:
    """Writes a workspace to a folder, and prunes it."""
    from rosimpact.impact.prune.session import prepare, write_copy

    case.write(root / "before")
    prepared = prepare(root / "before", jobs=1)
    reasons = tuple(f"{one.topic}: {one.reason}" for one in prepared.plan.refusals)
    if prepared.plan.plans:
        write_copy(root / "before", root / "after", prepared)
    return Pruned(case, root, len(prepared.plan.plans), reasons)


def compare_versions(one: Pruned, builder: Builder) -> Outcome:
    """Builds, runs and compares."""
    name = one.case.name
    if not one.pruned:
        return Outcome(name, "refused", 0, one.refusals)
    try:
        text, size = builder.run(one.root / "before", one.root / "built_before", one.case)
    except BuildError as error:
        return Outcome(name, "INVALID", one.pruned, one.refusals, detail=str(error))
    try:
        other, less = builder.run(one.root / "after", one.root / "built_after", one.case)
    except BuildError as error:
        return Outcome(name, "FAILED", one.pruned, one.refusals, size, 0, str(error))
    if other != text:
        return Outcome(name, "FAILED", one.pruned, one.refusals, size, less, f"before:\n{text}\nafter:\n{other}")
    state = "equal" if less < size and text else "FAILED"
    return Outcome(name, state, one.pruned, one.refusals, size, less, "" if state == "equal" else "nothing is saved")


def main() -> int:
    """The benchmark; 1 where a workspace fails."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--cpp", type=int, default=100)
    parser.add_argument("--python", type=int, default=100)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--keep", type=Path)
    parser.add_argument("--results", type=Path)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        folder = options.keep or Path(scratch)
        folder.mkdir(parents=True, exist_ok=True)
        builder = Builder(folder)
        if options.cpp:
            builder.prepare_cpp()
        wanted = [(n, language) for language in ("cpp", "python")
                  for n in range(options.first, options.first + getattr(options, language))]  # fmt: skip

        with ThreadPoolExecutor(options.jobs) as pool:
            # The planner has this thread for itself.
            waiting = [
                pool.submit(compare_versions, prune_case(case, folder / case.name), builder)
                for case in (Case(*one) for one in wanted)
            ]
            outcomes: list[Outcome] = []
            for each in waiting:
                outcome = each.result()
                outcomes.append(outcome)
                print(outcome.name, outcome.state, outcome.pruned, len(outcome.refusals), outcome.before, outcome.after)
                if outcome.detail:
                    print(outcome.detail)
                sys.stdout.flush()
    if options.results:
        options.results.write_text("".join(json.dumps(one._asdict()) + "\n" for one in outcomes))
    for language in ("cpp", "python"):
        rows = [one for one in outcomes if one.name.startswith(language)]
        states = Counter(one.state for one in rows)
        print(language, len(rows), dict(states), "messages", sum(one.pruned for one in rows),
              "bytes", sum(one.before for one in rows), sum(one.after for one in rows))  # fmt: skip
    reasons = Counter(re.sub(r"^\S+: |`[^`]*`|\S+:\d+", "", why) for one in outcomes for why in one.refusals)
    for why, count in reasons.most_common():
        print(count, why)
    return int(any(one.state in ("FAILED", "INVALID") for one in outcomes))


if __name__ == "__main__":
    sys.exit(main())

"""Lays out a rule: its module and its first file of cases, which work and are to be edited."""

import re
from pathlib import Path

from ...edges import files
from ...edges.console import UserError

_NAME = re.compile(r"[a-z][a-z0-9]*(?:-[a-z0-9]+)*")

RULE = '''"""{name}: a manifest exports `{subject}`.

What it does
    Reports what is wrong, in a sentence.

Why it breaks
    What happens to whom, and when: configuring, compiling, linking, installing, starting.

Severity
    warning. Say what makes a finding more or less severe.

Example
    <export><{subject}/></export>

Use instead
    <export/>

Not reported
    What looks like it and works.
"""

from ...model.cmake.build import At
from ...model.view import TargetView
from ...model.workspace import Package
from ..rule import Diagnostic, Text, rule


@rule(
    severity="warning",
    preview=True,
    texts=Text("`{{package}}` exports `{{subject}}`", help="remove it"),
)
def {function}(view: TargetView, package: Package):
    for export in package.manifest.exports:
        if export.tag == "{subject}":
            yield Diagnostic(At(package.digest.manifest_path, export.line), export.tag, package.name)
'''
CASES = """# {name}

Targets: jazzy

```xml sled/package.xml
<?xml version="1.0"?>
<package format="3">
  <name>sled</name>
  <version>1.0.0</version>
  <description>sled</description>
  <maintainer email="robots@example.org">Robots</maintainer>
  <license>Apache-2.0</license>

  <buildtool_depend>ament_cmake</buildtool_depend>
  <depend>rclcpp</depend>

  <export>
    <build_type>ament_cmake</build_type>
  </export>
</package>
```

```cmake sled/CMakeLists.txt
cmake_minimum_required(VERSION 3.8)
project(sled)

find_package(ament_cmake REQUIRED)
find_package(rclcpp REQUIRED)

add_executable(sled src/sled.cpp)
target_link_libraries(sled rclcpp::rclcpp)
install(TARGETS sled DESTINATION lib/${{PROJECT_NAME}})

ament_package()
```

```cpp sled/src/sled.cpp
#include <rclcpp/rclcpp.hpp>

int main(int argc, char ** argv)
{{
  rclcpp::init(argc, argv);
  return 0;
}}
```

## Nothing is reported

## The manifest exports it

```diff sled/package.xml
     <build_type>ament_cmake</build_type>
+    <{subject}/>
```

```findings
warning sled/package.xml:14 {subject} [jazzy]
  `sled` exports `{subject}`
  help: remove it
```
"""


def write_rule(root: Path, name: str, family: str) -> tuple[Path, Path]:
    """Writes a rule's module and its file of cases, and returns their paths. root: a checkout of rosimpact.

    Raises UserError for a name that no rule can have, an unknown family, a rule that exists, and a root that is no
    checkout.
    """
    rules, cases = root / "impact/rules", root / "tests/rules"
    if not rules.is_dir() or not cases.is_dir():
        raise UserError(f"{root}: not a checkout of rosimpact; run the command where impact/ and tests/ are")
    if not _NAME.fullmatch(name):
        example = name.lower().replace("_", "-").replace(" ", "-")
        example = example if _NAME.fullmatch(example) else "removed-header"
        raise UserError(f"{name}: not a rule name; write lower-case words joined by dashes, such as {example}")
    families = sorted(folder.parent.name for folder in rules.glob("*/__init__.py"))
    if family not in families:
        raise UserError(f"--family {family}: unknown; choose one of {', '.join(families)}")
    function = name.replace("-", "_")
    if known := [path for path in rules.glob(f"*/{function}.py")]:
        raise UserError(f"{known[0]}: exists; choose another name")
    module, first = rules / family / f"{function}.py", cases / family / f"{function}.md"
    for path, text in ((module, RULE), (first, CASES)):
        filled = text.format(name=name, function=function, subject="replace_me")
        files.write_file(path, filled.encode(), beneath=root, instead_of=None)
    return module, first

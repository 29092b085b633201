"""What is said does not depend on the order in which Python keeps its sets."""

import os
import subprocess
import sys

MANIFEST = """<package format="3"><name>sled</name><version>1.0.0</version><description>d</description>
<maintainer email="a@b.org">a</maintainer><license>MIT</license><buildtool_depend>ament_cmake</buildtool_depend>
<export><build_type>ament_cmake</build_type></export></package>
"""


def test_findings_are_the_same_with_any_hash_seed(tmp_path):
    (tmp_path / "ws").mkdir()
    (tmp_path / "ws/package.xml").write_text(MANIFEST)
    (tmp_path / "ws/CMakeLists.txt").write_text(
        "cmake_minimum_required(VERSION 3.8)\nproject(sled)\nfind_package(ament_cmake REQUIRED)\n"
        "add_library(sled sled.cpp)\nament_package()\n"
    )
    (tmp_path / "ws/sled.cpp").write_text(
        "#include <string>\nuint8_t a;\nint8_t b;\nuint16_t c;\nint32_t d;\nuint32_t e;\nint64_t f;\n"
    )
    said = set()
    for seed in range(1, 6):
        environment = {**os.environ, "PYTHONHASHSEED": str(seed), "ROSIMPACT_CACHE": str(tmp_path / f"cache{seed}")}
        command = [
            sys.executable,
            "-c",
            "import sys; from rosimpact.impact.cli.app import main; sys.exit(main())",
            "check",
            "ws",
            "--target",
            "jazzy",
            "--preview",
            "--format",
            "json",
        ]
        ended = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True)
        assert "cstdint" in ended.stdout, ended.stderr
        said.add(ended.stdout)
    assert len(said) == 1

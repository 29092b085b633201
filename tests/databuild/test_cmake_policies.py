"""What the manual of CMake says of policies, and that the table can be read."""

from rosimpact.databuild.cmake_names import find_policies
from rosimpact.impact.model.cmake.names import DROPPED, ONLY_NEW, SINCE

TEXTS = {
    "CMP0001": ".. |REMOVED_IN_CMAKE_VERSION| replace:: 4.0\n.. include:: REMOVED.rst\n\nNames are one.\n",
    "CMP0002": ".. versionadded:: 3.27\n\nThe :module:`FindWinch` and :module:`FindRope` modules are removed.\n",
    "CMP0003": "The :command:`pull_rope` command should not be called.\n",
    "CMP0004": "The :command:`pull_rope` command is quiet.\n\nThe ``NEW`` behavior is that modules are removed.\n",
}


def test_policies_of_the_manual(tmp_path):
    (tmp_path / "policy").mkdir()
    for name, text in TEXTS.items():
        (tmp_path / "policy" / f"{name}.rst.txt").write_text(text)
    only_new, dropped = find_policies(tmp_path)
    assert only_new == {"CMP0001": "4.0"}
    assert dropped == {"FindWinch": "CMP0002", "FindRope": "CMP0002", "pull_rope": "CMP0003"}


def test_the_table_knows_newer_policies():
    assert (ONLY_NEW["CMP0054"], DROPPED["FindPythonInterp"], SINCE["CMP0148"]) == ("4.0", "CMP0148", "3.27")
    assert "CMP0066" not in ONLY_NEW and SINCE["string(REPEAT)"] == "3.15"

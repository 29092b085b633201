"""Modules of a package, of which some could not be read."""

import pytest
from rosimpact.impact.facts.python.source import PythonFile
from rosimpact.impact.model.python.undefined import PackageModules

READ = ("arm/arm/__init__.py", "arm/arm/tables/__init__.py", "arm/arm/move.py")


@pytest.mark.parametrize(
    ("unread", "lacks"),
    [
        ((), True),
        (("arm/arm/tables/tables.py",), False),
        (("arm/arm/tables/tables/__init__.py",), False),
        (("arm/arm/tables.py",), True),
    ],
)
def test_a_file_that_could_not_be_read_is_a_module(unread, lacks):
    modules = PackageModules(dict.fromkeys(READ, PythonFile((), (), ())), (), (*READ, *unread))
    assert modules.lacks("arm.tables.tables") is lacks

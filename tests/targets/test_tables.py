"""The shipped manifest is that of the shipped files; the number of their format is raised when their form changes."""

import ast
import contextlib
import hashlib
import json
import pkgutil
import re
import shutil
import sqlite3
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

import msgspec
import pytest
import zstandard
from rosimpact.databuild.table_manifest import format_manifest, make_manifest
from rosimpact.impact import targets
from rosimpact.impact.targets import tables
from rosimpact.impact.targets.tables import DATA, FORMAT, find_table, list_tables, read_manifest

KNOWN = Path(__file__).parent / "table_forms.json"


def test_the_shipped_manifest_is_that_of_the_shipped_files():
    shipped = read_manifest(DATA)
    assert make_manifest(DATA, shipped.date) == shipped, "run `python -P -m rosimpact.databuild.table_manifest`"


@pytest.mark.parametrize("name", read_manifest(DATA).tables)
def test_a_table_that_is_not_updated_is_the_shipped_one(name):
    assert find_table(name) == DATA / name
    assert list_tables(name) == [DATA / name]


def test_no_loader_names_the_shipped_folder():
    """They ask find_table(), which knows what is in use."""
    named = re.compile(r"\bDATA\b(?!\.md)|with_name\(|\"data\"")
    modules = [path for path in Path(next(iter(targets.__path__))).rglob("*.py") if path.name != "tables.py"]
    assert [path.name for path in modules if named.search(path.read_text(encoding="utf-8"))] == []


def list_forms(folder: Path) -> Iterator[tuple[str, Any]]:
    """What each loader expects: types of JSON and of packed rows by their module, and the tables of databases.
    folder: to unpack these in."""
    for module in pkgutil.walk_packages(targets.__path__, f"{targets.__name__}."):
        loaded = import_module(module.name)
        short = module.name.removeprefix(f"{targets.__name__}.")
        for node in ast.walk(ast.parse(Path(str(loaded.__file__)).read_bytes())):
            if isinstance(node, ast.Call) and getattr(node.func, "id", "") in ("read_table", "read_packed"):
                kind = ast.unparse(node.args[1])
                if kind != "kind":
                    yield f"{short} {kind}", drop_texts(msgspec.json.schema(eval(kind, vars(loaded))))
    for path in sorted(DATA.glob("*.sqlite*")):
        data = path.read_bytes()
        file = folder / path.name
        file.write_bytes(zstandard.decompress(data) if path.suffix == ".zst" else data)
        with contextlib.closing(sqlite3.connect(file)) as database:
            yield path.name, sorted(database.execute("SELECT sql FROM sqlite_master WHERE sql IS NOT NULL"))


def drop_texts(schema: Any) -> Any:
    """A schema without what is only for people to read."""
    if isinstance(schema, list):
        return [drop_texts(one) for one in schema]
    if not isinstance(schema, dict):
        return schema
    return {key: drop_texts(value) for key, value in schema.items() if key not in ("description", "title")}


def test_the_number_of_the_format_is_raised_when_the_form_of_a_table_changes(tmp_path, request):
    """Raise FORMAT, unless loaders of before read the tables of now and the other way round; then --update-cases."""
    forms = {
        name: hashlib.sha256(json.dumps(form, sort_keys=True).encode()).hexdigest()[:12]
        for name, form in list_forms(tmp_path)
    }
    made = json.dumps({"format": FORMAT, "forms": forms}, indent=1, sort_keys=True) + "\n"
    if request.config.getoption("--update-cases"):
        KNOWN.write_text(made)
    assert made == KNOWN.read_text()


def test_what_results_rest_on_differs_with_the_tables_in_use(tmp_path, monkeypatch):
    """Sizes and times of files tell the results of checks apart, the manifest what is joined from facts."""

    def read_stamps() -> tuple[Any, str]:
        tables.find_data_folder.cache_clear()
        tables.compute_data_version.cache_clear()
        return tables.compute_data_stamp(), tables.compute_data_version()

    monkeypatch.setenv("ROSIMPACT_CACHE", str(tmp_path))
    before, updated = read_stamps(), tmp_path / "updated/tables-0123456789abcdef"
    try:
        shutil.copytree(DATA, updated)  # with the times of the files
        (tmp_path / "updated/tables").write_text(updated.name)
        same = read_stamps()
        assert find_table("apt.json.zst") == updated / "apt.json.zst"
        assert same[0] != before[0] and same[1] == before[1]
        (updated / "parameters.json").write_text("{}")
        (updated / "manifest.json").write_bytes(format_manifest(make_manifest(updated, "2999-01-01")))
        other = read_stamps()
        assert other[0] != same[0] and other[1] != same[1]
    finally:
        monkeypatch.undo()
        read_stamps()

"""Maps the top-level rooms to `rosimpact.<room>`; everything else is in pyproject.toml."""

from setuptools import find_packages, setup

ROOMS = ("impact", "corpus", "classifier", "databuild", "edges")

setup(
    packages=[f"rosimpact.{name}" for name in find_packages(include=[*ROOMS, *(f"{room}.*" for room in ROOMS)])],
    package_dir={f"rosimpact.{room}": room for room in ROOMS},
    package_data={f"rosimpact.{room}": ["py.typed"] for room in ROOMS}
    | {
        "rosimpact.impact.cli": ["templates/*"],
        "rosimpact.impact.targets": ["data/*"],
        "rosimpact.impact.rules": ["precision.json", "imprecise.toml"],
        "rosimpact.impact.report": ["*.css", "*.html", "*.js", "*.json"],
        "rosimpact.impact.measure.nodes": ["node.cpp", "CMakeLists.txt"],
        "rosimpact.impact.values.harness": ["runtime/*", "runtime/**/*"],
        "rosimpact.impact.model.cmake": ["*.toml"],
        "rosimpact.impact.model.flow": ["*.toml"],
        "rosimpact.impact.report.graph": ["assets/*"],
        "rosimpact.corpus": ["py.typed", "labels.jsonl", "GUIDE.md"],
        "rosimpact.classifier": ["py.typed", "data/*"],
    },
)

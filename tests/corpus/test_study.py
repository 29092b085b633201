"""`rosimpact study run`: notebooks that fail fail the run; what is committed holds no texts and no paths."""

import csv
import json
import re
from pathlib import Path

import numpy as np
import pytest
from late import Late
from rosimpact.classifier import study as triage_study
from rosimpact.corpus.curves import estimate_pooled_share, estimate_survival
from rosimpact.corpus.figures import spread_places, write_names
from rosimpact.corpus.report import KINDS, LABELS, BugReport, CorpusError, read_labels
from rosimpact.corpus.study import run, run_study
from rosimpact.impact.cli.app import app
from rosimpact.impact.rules.rule import load_rules
from typer.testing import CliRunner

evaluate, training = Late("rosimpact.classifier.evaluate"), Late("rosimpact.classifier.training")
figure = Late("matplotlib.figure")

NOTEBOOKS = Path(__file__).parents[2] / "notebooks"
DATA = NOTEBOOKS / "data"
DOCS = NOTEBOOKS.parent / "docs"

DRAWS = """
import matplotlib.pyplot as plt
from rosimpact.corpus.figures import Page
page = Page.open("01_made")
figure, axes = plt.subplots()
axes.plot([0, 1], [1, 0])
page.show(figure, "line")
"""


def folder_with(tmp_path, source, figures=("line",), texts=False):
    folder = tmp_path / "notebooks"
    folder.mkdir(exist_ok=True)
    cell = {"cell_type": "code", "id": "c1", "metadata": {}, "execution_count": None, "outputs": [], "source": source}
    about = {"rosimpact": {"figures": list(figures), "texts": texts}}
    text = json.dumps({"cells": [cell], "metadata": about, "nbformat": 4, "nbformat_minor": 5})
    (folder / "01_made.ipynb").write_text(text)
    return folder


def test_figures_are_written_and_two_runs_are_equal(tmp_path):
    folder = folder_with(tmp_path, DRAWS)
    for name in ("one", "two"):
        (outcome,) = run(output=tmp_path / name, notebooks=folder)
        assert (outcome.failure, outcome.figures) == ("", ("line",))
    for file in ("01_made.ipynb", "figures/line.svg", "figures/line.png"):
        assert (tmp_path / "one" / file).read_bytes() == (tmp_path / "two" / file).read_bytes()


def test_the_command_line(tmp_path):
    folder = folder_with(tmp_path, DRAWS)
    options = ["--notebooks", str(folder), "--output", str(tmp_path / "out")]
    result = CliRunner().invoke(app, ["study", "run", "01", *options])
    assert (result.exit_code, (tmp_path / "out/figures/line.svg").is_file()) == (0, True)
    result = CliRunner().invoke(app, ["study", "run", "07", *options])
    assert result.exit_code == 2


@pytest.mark.parametrize(
    ("source", "said"),
    [
        ("raise ValueError('no such data')", "cell 1: ValueError: no such data"),
        (DRAWS.replace("axes.plot([0, 1], [1, 0])", ""), "figure `line` is empty"),
        ("1 + 1", "made no figure `line`"),
    ],
)
def test_a_notebook_without_its_figure_fails_the_run(tmp_path, capfd, source, said):
    folder = folder_with(tmp_path, source)
    assert run_study(output=tmp_path / "out", notebooks=folder) == 1
    assert f"01_made.ipynb: {said}" in re.sub(r"cell 1: ValueError: (figure)", r"\1", capfd.readouterr().err)


@pytest.mark.parametrize(
    ("more", "said"),
    [
        ({"names": ["07"]}, "no notebook `07`"),
        ({"full": True}, "reads the reports' texts"),
        ({"full": True, "reports": Path("none.jsonl")}, "no such file"),
        ({"reports": Path("none.jsonl")}, "add --full"),
    ],
)
def test_what_cannot_be_started(tmp_path, more, said):
    with pytest.raises(CorpusError, match=said):
        run(output=tmp_path / "out", notebooks=folder_with(tmp_path, DRAWS, texts=True), **more)


@pytest.mark.parametrize(("text", "said"), [("", "holds no reports"), ("a robot\n", "wrong.jsonl:1")])
def test_a_file_without_reports_is_refused_at_once(tmp_path, text, said):
    (tmp_path / "wrong.jsonl").write_text(text)
    with pytest.raises(CorpusError, match=said):
        run(notebooks=folder_with(tmp_path, DRAWS, texts=True), full=True, reports=tmp_path / "wrong.jsonl")


def test_without_the_extra(tmp_path, monkeypatch):
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    with pytest.raises(CorpusError, match=r"pip install 'rosimpact\[study\]'"):
        run(output=tmp_path)


def test_a_small_form_of_each_notebook(tmp_path):
    outcomes = run(output=tmp_path / "out", notebooks=NOTEBOOKS)
    assert [(one.name, one.failure) for one in outcomes if one.failure] == []
    assert all(one.figures for one in outcomes)


def test_what_is_committed_holds_outputs_but_no_paths_and_no_long_quotes():
    for path in NOTEBOOKS.glob("*.ipynb"):
        cells = [cell for cell in json.loads(path.read_text())["cells"] if cell["cell_type"] == "code"]
        shown = [
            "".join(value)
            for cell in cells
            for one in cell["outputs"]
            for kind, value in {**one.get("data", {}), "said": one.get("text", "")}.items()
            if not kind.startswith("image/")
        ]
        assert any(shown), f"{path.name} has no outputs"
        assert not re.search(r"(?<![\w.])/(?:home|tmp|root|work|usr|var|mnt)/", "\n".join(shown))
        cells_of_tables = [
            cell for text in shown for line in text.splitlines() if "|" in line for cell in line.split("|")
        ]
        assert all(len(cell.split()) <= 30 for cell in cells_of_tables)


# The shipped facts


def rows_of(name):
    with (DATA / name).open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def test_every_kind_has_its_rules_and_every_rule_named_exists():
    rows = rows_of("rules_of_kinds.csv")
    kinds = [(label, kind) for label in LABELS for kind in KINDS.get(label, ("",))]
    assert [(row["label"], row["kind"]) for row in rows] == kinds
    assert {rule for row in rows for rule in row["rules"].split()} <= load_rules().keys()
    for row in rows:
        assert row["extent"] in ("yes", "in part", "hardly", "no")
        assert (row["extent"] == "no") == (row["rules"] == "")


def test_what_robust_counts_is_what_its_page_says():
    page = (DOCS / "labels.md").read_text(encoding="utf-8")
    table = page[page.index("| | sure | likely | unmapped |") :].split("\n\n")[0].splitlines()[2:]
    cells = [[cell.strip(" `") or "0" for cell in line.strip("|").split("|")] for line in table]
    assert [list(row.values()) for row in rows_of("robust.csv")] == cells


def test_the_shipped_predictions_are_of_the_committed_labels():
    labels = {label.id: (label.label, label.decided) for label in read_labels()}
    found = triage_study.read(DATA)
    assert {one.id: (one.label, one.decided) for one in found.predictions} == labels
    assert all(abs(sum(one.probabilities) - 1) < 1e-3 for one in found.predictions)
    assert {row["id"] for row in rows_of("triage_errors_read.csv")} <= labels.keys()


def test_predictions_hold_no_text_and_can_be_read_again(tmp_path):
    report = BugReport("acme/arm#1", "https://x", "github", None, "Fails on jazzy", "secret words")
    example = training.Example(report=report, label="dependency", twice=False)
    predicted = evaluate.Predictions(np.array([[0.1, 0.6, 0.1, 0.1, 0.1]]), np.array([True]))
    beside = {"majority": {"macro_f1": {"value": 0.5, "low": 0.4, "high": 0.6}, "right": 1.0}}
    digests = {"labels_digest": "1", "texts_digest": "2"}
    found = triage_study.Measured(triage_study.make_predictions([example], predicted), beside, digests)
    triage_study.write(found, tmp_path)
    assert triage_study.read(tmp_path) == found
    assert "secret" not in "".join(path.read_text() for path in tmp_path.iterdir())
    (one,) = found.predictions
    assert (one.length, one.group, one.twice, one.abstained) == (26, "acme/arm", False, True)


@pytest.mark.parametrize(
    ("file", "change", "said"),
    [
        ("triage_predictions.jsonl", None, "No such file"),
        ("triage_predictions.jsonl", ('"label":"other"', '"label":"wish"'), r"jsonl:\d+: `.*` is no prediction"),
        ("triage_predictions.jsonl", ('"id"', '"name"'), "jsonl:1: .*missing required field"),
        ("triage_beside.json", ('"beside"', '"other"'), "cannot be read"),
    ],
)
def test_damaged_facts_name_the_file_and_the_cure(tmp_path, file, change, said):
    for name in (triage_study.PREDICTIONS, triage_study.BESIDE):
        text = (DATA / name).read_text(encoding="utf-8")
        if name != file:
            (tmp_path / name).write_text(text)
        elif change:
            (tmp_path / name).write_text(text.replace(*change))
    with pytest.raises(CorpusError, match=said) as error:
        triage_study.read(tmp_path)
    assert "rosimpact study predict" in str(error.value)


def test_predicting_from_a_file_that_is_not_there(tmp_path, capfd):
    assert triage_study.run_study(tmp_path / "none.jsonl", tmp_path / "out", quiet=True) == 2
    assert "none.jsonl" in capfd.readouterr().err
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("page", [DOCS / "study.md", NOTEBOOKS / "README.md"])
def test_the_pages_name_the_notebooks_there_are(page):
    named = set(re.findall(r"\b\d\d_\w+(?=\.ipynb)", page.read_text(encoding="utf-8")))
    assert named == {path.stem for path in NOTEBOOKS.glob("*.ipynb")}


def test_survival_by_hand():
    # Five followed: ends at 1, 2 and 4; two still stood at 2 and 5.
    curve = estimate_survival([1, 2, 2, 4, 5], [True, True, False, True, False])
    assert curve.x.tolist() == [0, 1, 2, 4, 5]
    assert curve.y == pytest.approx([1, 0.8, 0.6, 0.3, 0.3])
    assert (curve.low <= curve.y).all() and (curve.y <= curve.high).all()
    assert curve.evaluate(3)[0] == pytest.approx(0.6)
    assert curve.find_first_below(0.5) == 4
    with pytest.raises(ValueError, match="nothing was followed"):
        estimate_survival([], [])


def test_a_share_of_groups_that_are_alike_has_no_width():
    curve = estimate_pooled_share(np.array([[1, 2], [1, 2]]), [4, 4], [0, 1], draws=50)
    for values in (curve.y, curve.low, curve.high):
        assert values == pytest.approx([0.25, 0.5])
    wide = estimate_pooled_share(np.array([[0], [4]]), [4, 4], [0], draws=200)
    assert wide.low[0] < 0.5 < wide.high[0]


def test_names_stay_apart():
    assert spread_places([0.0, 0.01, 0.5], 0.1, 0, 1) == pytest.approx([0, 0.1, 0.5])
    assert spread_places([0.95, 0.99], 0.1, 0, 1) == pytest.approx([0.9, 1])


def test_names_of_lines_that_end_far_apart_are_left_where_they_are():
    axes = figure.Figure(figsize=(9, 4)).subplots()
    for name, x in (("early", 1.0), ("late", 10.0), ("later", 10.0)):
        axes.plot([0, x], [0, 1], label=name)
    write_names(axes)
    heights = {text.get_text(): text.xyann[1] for text in axes.texts}
    assert heights["early"] == pytest.approx(1)
    assert abs(heights["late"] - heights["later"]) > 0.03

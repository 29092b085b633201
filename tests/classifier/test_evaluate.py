"""The numbers: what they count, and that no repository is on both sides."""

import json

import numpy as np
import pytest
from late import Late
from rosimpact.impact.cli.app import app
from typer.testing import CliRunner

evaluate, training = Late("rosimpact.classifier.evaluate"), Late("rosimpact.classifier.training")


@pytest.fixture(scope="module")
def found(labelled):
    return training.read_examples(*labelled)


def test_no_repository_is_on_both_sides(found):
    groups = found.groups
    judged = []
    for learn, judge in training.make_splits(found, 10, 1):
        assert not {groups[row] for row in learn} & {groups[row] for row in judge}
        judged.extend(judge)
    assert sorted(judged) == list(range(len(found.rows)))


@pytest.mark.parametrize(
    ("truth", "said", "score"),
    [
        ([0, 1, 2, 3, 4], [0, 1, 2, 3, 4], 1.0),
        ([0, 0, 4, 4], [0, 4, 4, 4], (2 / 3 + 4 / 5) / 2),
        ([0, 0], [1, 1], 0.0),
    ],
)
def test_macro_f1_is_over_the_labels_that_are_there(truth, said, score):
    assert evaluate.average_f1(np.array(truth), np.array(said)) == pytest.approx(score)


def test_macro_f1_is_that_of_scikit_learn():
    from sklearn.metrics import f1_score

    source = np.random.default_rng(0)
    truth, said = source.integers(0, 5, 300), source.integers(0, 5, 300)
    assert evaluate.average_f1(truth, said) == pytest.approx(f1_score(truth, said, average="macro"))


@pytest.mark.parametrize(("sure", "right", "error"), [(0.9, 0.9, 0.0), (0.9, 0.5, 0.4)])
def test_calibration_error_is_the_gap_between_sure_and_right(sure, right, error):
    hits = np.arange(1000) % 10 < right * 10
    assert evaluate.compute_calibration_error(np.full(1000, sure), hits, bins=10) == pytest.approx(error, abs=1e-9)


def test_an_interval_is_over_repositories():
    truth = np.zeros(40, int)
    said = np.where(np.arange(40) < 20, 0, 1)

    def right(t, s):
        return float((t == s).mean())

    alone = evaluate.estimate_interval(right, truth, said, [str(n) for n in range(40)], resamples=200)
    together = evaluate.estimate_interval(right, truth, said, ["a"] * 20 + ["b"] * 20, resamples=200)
    assert alone.value == together.value == 0.5
    assert (together.low, together.high) == (0.0, 1.0)
    assert 0.2 < alone.low < 0.5 < alone.high < 0.8


def test_commands_train_evaluate_and_use_a_model(labelled, tmp_path):
    labels, reports = map(str, labelled)
    file = tmp_path / "own.npz"
    common = ["--labels", labels, "--reports", reports]
    done = CliRunner().invoke(app, ["classifier", "train", *common, "--output", str(file)])
    assert done.exit_code == 0, done.stderr
    assert "64 reports, 4 labels" in done.stdout
    said = CliRunner().invoke(app, ["triage", "missing dependency in package.xml", "--model", str(file), "-f", "json"])
    assert json.loads(said.stdout)["label"] == "dependency"
    measured = CliRunner().invoke(app, ["classifier", "evaluate", *common, "--no-ablations", "--format", "json"])
    assert measured.exit_code == 0, measured.stderr
    result = json.loads(measured.stdout)
    assert result["reports"] == 64
    assert result["scores"]["all"]["macro_f1"]["value"] > result["beside"]["majority"]["macro_f1"]["value"]
    assert sum(map(sum, result["confusion"])) == 64
    assert evaluate.render_text(result).startswith("64 reports of 8 repositories")


@pytest.mark.parametrize("command", ["train", "evaluate"])
def test_a_missing_file_is_named(command, labelled, tmp_path):
    result = CliRunner().invoke(
        app, ["classifier", command, "--labels", str(labelled[0]), "--reports", str(tmp_path / "none.jsonl")]
    )
    assert result.exit_code == 2
    assert "none.jsonl: cannot be read" in result.stderr
    assert len(result.stderr.splitlines()) == 1 or command == "train"

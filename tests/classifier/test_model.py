"""Models: trained to the digit, kept without code or texts, refused when they do not fit."""

import json
import pickle
import zipfile

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from late import Late
from rosimpact.classifier.model import SHIPPED, ClassifierError, compute_softmax, load, pack_json
from rosimpact.classifier.reading import VIEWS, read
from rosimpact.corpus.report import LABELS_FILE, read_labels
from written_reports import rows, write

training = Late("rosimpact.classifier.training")


@pytest.fixture(scope="module")
def found(labelled):
    return training.read_examples(*labelled)


@pytest.fixture(scope="module")
def model(found):
    return training.train(found)


@pytest.fixture(scope="module")
def shipped():
    return load()


def test_the_same_reports_give_the_same_bytes(tmp_path, labelled, model):
    model.save(tmp_path / "a.npz")
    labels, reports = labelled
    lines = reports.read_text().splitlines()
    mixed = tmp_path / "mixed.jsonl"
    mixed.write_text("\n".join(reversed(lines)))
    training.train(training.read_examples(labels, mixed)).save(tmp_path / "b.npz")
    assert (tmp_path / "a.npz").read_bytes() == (tmp_path / "b.npz").read_bytes()


def test_the_file_gives_what_scikit_learn_gave(found, model, tmp_path):
    model.save(tmp_path / "m.npz")
    kept = load(tmp_path / "m.npz")
    linear = training.fit(found)
    expected = linear.compute_scores(found.counts)
    reports = [example.report for example in found.rows]
    scores = np.array([kept.compute_scores(read(report.title, report.body)) for report in reports])
    assert np.allclose(scores, expected, atol=1e-4)


def test_a_changed_text_changes_the_digest(found):
    first, *rest = found.rows
    other = first._replace(
        report=type(first.report)(
            **{f: getattr(first.report, f) for f in first.report.__struct_fields__} | {"body": "new"}
        )
    )
    before, after = training.compute_digests(found.rows), training.compute_digests([other, *rest])
    assert before["labels_digest"] == after["labels_digest"]
    assert before["texts_digest"] != after["texts_digest"]


def test_words_of_one_repository_are_not_learnt(model):
    for view in VIEWS:
        words = model.arrays[f"vocabulary {view}"].tobytes().decode()
        assert "robot_a" not in words
        assert "tools_k" not in words


@pytest.mark.parametrize(
    ("title", "label"),
    [
        ("does not compile after upgrading to jazzy, undefined symbol", "library-update"),
        ("missing dependency in package.xml, no rosdep key", "dependency"),
        ("wrong frame_id, values in degrees instead of radians", "inconsistency"),
        ("segmentation fault when the window is closed", "other"),
    ],
)
def test_unseen_reports_are_labelled(model, shipped, title, label):
    assert model.judge(read(title, "")).label == label
    assert shipped.judge(read(title, "")).label == label


@settings(max_examples=50, deadline=None)
@given(st.text(), st.text())
def test_any_text_is_judged(title, body):
    model = _SHIPPED
    verdict = model.judge(read(title, body))
    assert set(verdict.probabilities) == set(model.labels)
    assert sum(verdict.probabilities.values()) == pytest.approx(1)
    assert len(model.list_reasons(read(title, body), verdict.label)) <= 8


_SHIPPED = load()


class TestShipped:
    def test_it_is_small_and_holds_no_pickle(self):
        assert SHIPPED.stat().st_size < 10_000_000
        with zipfile.ZipFile(SHIPPED) as archive:
            for name in archive.namelist():
                header = archive.read(name)[:400]
                assert b"'|O'" not in header, name

    def test_it_names_what_it_was_trained_on(self, shipped):
        labels = read_labels(LABELS_FILE)
        assert shipped.about["reports"] == len(labels)
        assert {id for id, _, _ in shipped.seen} == {label.id for label in labels}
        assert len(shipped.about["texts_digest"]) == 64

    def test_its_vocabulary_holds_no_phrase(self):
        for view, settings_ in VIEWS.items():
            grams = _SHIPPED.arrays[f"vocabulary {view}"].tobytes().decode().split("\n")
            assert max(len(gram.split()) for gram in grams) <= settings_.longest <= 3
            assert max(len(gram) for gram in grams) <= 3 * 40 + 2

    def test_the_labels_it_was_trained_on_are_those_of_the_corpus(self, shipped):
        judged = {label.id: label.label for label in read_labels(LABELS_FILE)}
        assert {id: label for id, _, label in shipped.seen} == judged


class TestNearest:
    def test_the_report_itself_is_nearest(self, found, model):
        example = found.rows[0]
        best = model.find_nearest(read(example.report.title, example.report.body))
        assert len(best) == 5
        assert best[0].likeness == pytest.approx(1, abs=1e-2)
        assert best[0].label == example.label

    def test_a_report_without_a_known_word_has_none(self, model):
        assert model.find_nearest(read("", "")) == []


class TestRefusals:
    @pytest.mark.parametrize("content", [b"", b"no archive", pickle.dumps({"a": 1}), b"PK\x03\x04broken"])
    def test_what_is_no_model(self, tmp_path, content):
        file = tmp_path / "m.npz"
        file.write_bytes(content)
        with pytest.raises(
            ClassifierError, match=r"m\.npz: is no model of rosimpact; make one with `rosimpact classif"
        ):
            load(file)

    def test_a_missing_file(self, tmp_path):
        with pytest.raises(ClassifierError, match="cannot be read"):
            load(tmp_path / "none.npz")

    @pytest.mark.parametrize("change", [{"format": 1}, {"signs": "0"}])
    def test_a_model_for_other_features(self, tmp_path, model, change):
        arrays = model.arrays | {"about": pack_json(model.about | change)}
        file = tmp_path / "m.npz"
        np.savez(file, **arrays)
        with pytest.raises(ClassifierError, match="train it again with `rosimpact classifier train`"):
            load(file)

    @pytest.mark.parametrize("lost", ["weights", "coefficients", "known", "vocabulary title"])
    def test_an_incomplete_model(self, tmp_path, model, lost):
        arrays = {name: array for name, array in model.arrays.items() if name != lost}
        file = tmp_path / "m.npz"
        np.savez(file, **arrays)
        with pytest.raises(ClassifierError, match="is incomplete"):
            load(file)

    def test_objects_in_the_archive_are_not_unpickled(self, tmp_path):
        class Trap:
            def __reduce__(self):
                return (pytest.fail, ("unpickled",))

        file = tmp_path / "m.npz"
        np.savez(file, about=np.array([Trap()], dtype=object))
        with pytest.raises(ClassifierError, match="is no model"):
            load(file)


class TestTooLittle:
    def test_no_text_for_any_label(self, tmp_path, labelled):
        reports = write(tmp_path / "r.jsonl", [])
        with pytest.raises(ClassifierError, match="holds none of the 64 reports"):
            training.read_examples(labelled[0], reports)

    def test_a_label_with_few_reports(self, tmp_path):
        reports, labels = rows(3)
        with pytest.raises(ClassifierError, match="library-update 6"):
            training.read_examples(write(tmp_path / "l.jsonl", labels), write(tmp_path / "r.jsonl", reports))

    def test_one_repository(self, tmp_path, labelled):
        reports, labels = rows()
        for number, (report, label) in enumerate(zip(reports, labels, strict=True)):
            report["id"] = label["id"] = f"lab/one#{number}"
        with pytest.raises(ClassifierError, match="of one repository"):
            training.read_examples(write(tmp_path / "l.jsonl", labels), write(tmp_path / "r.jsonl", reports))

    def test_two_labels_are_enough(self, tmp_path):
        reports, labels = rows()
        kept = [(r, lab) for r, lab in zip(reports, labels, strict=True) if lab["label"] in ("other", "dependency")]
        file = write(tmp_path / "l.jsonl", [lab for _, lab in kept])
        model = training.train(training.read_examples(file, write(tmp_path / "r.jsonl", [r for r, _ in kept])))
        assert model.labels == ["dependency", "other"]
        assert model.judge(read("missing dependency in package.xml", "")).label == "dependency"
        assert model.judge(read("segmentation fault in the window", "")).label == "other"


def test_softmax_adds_up_and_bears_large_scores():
    assert compute_softmax(np.array([1000.0, 1000.0])) == pytest.approx([0.5, 0.5])
    assert json.loads(pack_json({"a": "ü"}).tobytes()) == {"a": "ü"}

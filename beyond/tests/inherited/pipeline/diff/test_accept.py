"""Which results may replace the accepted record, and which files are copied."""

import pytest

from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.inherited.pipeline.diff import accept as module
from bouncing_ball_beyond.inherited.pipeline.diff.accept import accept
from bouncing_ball_beyond.inherited.pipeline.provenance import UNKNOWN, Revision


@pytest.fixture
def run(pair, monkeypatch):
    """``run(*names)``: accept in a committed checkout."""
    monkeypatch.setattr(module.provenance, "revision", lambda _: Revision("1f0e", "no"))
    made = [str(path) for path in (*pair.new.glob("figures/**/*"), pair.new / "paper.md")]

    def accepted(*names, more=()):
        return accept(pair.record, pair.new, [*made, *map(str, more)], names)

    return accepted


def contents(pair):
    return {path: path.read_bytes() for path in sorted(pair.record.rglob("*")) if path.is_file()}


def test_accept_copies_what_has_moved_and_nothing_else(pair, run):
    pair.move()
    pair.write("table1", pair.dataset("table1").assign_attrs(provenance_commit="2a2a"))
    (pair.new / "figures" / "claims.csv").unlink()
    before = contents(pair)
    assert {*run()} == {
        "removed figures/claims.csv",
        "copied figures/fig05.nc",
        "Commit the record with the reason: git add figures config *.md && git commit",
    }
    after = contents(pair)
    assert not (pair.record / "figures" / "claims.csv").exists()
    assert {path.name for path in after if after[path] != before[path]} == {"fig05.nc"}
    assert pair.compare().outcome.agrees
    assert run() == ["Nothing to accept: the results agree with the record."]


def test_a_new_artifact_is_copied_into_its_folder_beside_a_page_about_it(pair, run):
    new = pair.new / "figures" / "beyond" / "ext_height.nc"
    new.parent.mkdir()
    pair.write("beyond/ext_height", pair.dataset("fig05"))
    (pair.record / "figures" / "beyond").mkdir()
    page = pair.record / "figures" / "beyond" / "README.md"
    page.write_text("# Beyond the paper\n", encoding="utf-8")
    assert run(more=[new])[:-1] == ["copied figures/beyond/ext_height.nc"]
    assert page.exists()


def test_the_record_of_a_new_house_is_empty(pair, run):
    for path in (pair.record / "paper.md", *pair.record.glob("figures/*")):
        path.unlink()
    copied = [line for line in run() if line.startswith("copied ")]
    assert len(copied) == len([*pair.new.glob("figures/*")]) + 1
    assert pair.compare().outcome == "identical"


def test_accept_of_named_artifacts_copies_these_alone(pair, run, refusal):
    pair.move()
    pair.rewrite("paper.md", "reproduced", "contradicted")
    pair.write("table1", pair.dataset("table1").assign_attrs(provenance_commit="2a2a"))
    assert {*run("table1", "paper")[:-1]} == {"copied figures/table1.nc", "copied paper.md"}
    assert not pair.artifact("fig05").outcome.agrees
    with refusal(ModelError, "unknown artifact fig99"):
        run("fig05", "fig99")
    assert not pair.artifact("fig05").outcome.agrees


@pytest.mark.parametrize(
    ("attributes", "said"),
    [
        ({"provenance_dirty": "yes"}, "made with uncommitted changes, remove and run again: "),
        ({"provenance_configuration": '{"n": 2}'}, "has another configuration: {'n': 2}"),
    ],
)
def test_what_the_committed_code_and_values_would_not_give_is_refused(
    pair, run, refusal, attributes, said
):
    pair.move(**attributes)
    before = contents(pair)
    with refusal(ModelError, said, "figures/fig05.nc"):
        run("fig05")
    assert contents(pair) == before


@pytest.mark.parametrize(
    ("state", "said"),
    [
        (UNKNOWN, "this folder is no repository of git"),
        (Revision("1f0e", "yes"), "some changes are not committed"),
        (Revision("1f0e", "no"), "fig17.png is not made by this workflow: remove it"),
    ],
)
def test_a_refusal_changes_nothing(pair, run, monkeypatch, refusal, state, said):
    pair.move()
    monkeypatch.setattr(module.provenance, "revision", lambda _: state)
    (pair.new / "figures" / "fig17.png").touch()
    before = contents(pair)
    with refusal(ModelError, said):
        run()
    assert contents(pair) == before

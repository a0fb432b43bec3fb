"""Which results may replace the accepted record, and which files are copied."""

import subprocess

import pytest

from bouncing_ball.datasets.files import write_dataset
from bouncing_ball.errors import ModelError
from bouncing_ball.pipeline.diff import accept as module
from bouncing_ball.pipeline.diff.accept import accept
from bouncing_ball.pipeline.provenance import UNKNOWN, Revision


@pytest.fixture
def run(pair, monkeypatch):
    """``run(*names)``: accept in a committed checkout, for which Snakemake has nothing to do."""
    monkeypatch.setattr(module.provenance, "revision", lambda _: Revision("1f0e", "no"))
    monkeypatch.setattr(module, "jobs_left", lambda *_: 0)
    (pair.record / "config").mkdir()
    (pair.record / "config" / "config.yaml").write_text("release: force\n", encoding="utf-8")
    made = [str(path) for path in pair.new.glob("figures/**/*")]

    def accepted(*names, config=None, more=()):
        files = [*made, *map(str, more)]
        return accept(pair.record, pair.new, files, config or {"release": "force"}, names)

    return accepted


def contents(pair):
    return {path: path.read_bytes() for path in sorted(pair.record.rglob("*")) if path.is_file()}


def drift(pair, by=1e-3):
    data = pair.dataset("fig05")
    data.phase.values[1, 40] += by
    pair.write("fig05", data)


def test_accept_copies_what_has_moved_and_nothing_else(pair, run):
    drift(pair)
    pair.write("fig08", pair.dataset("fig08").assign_attrs(provenance_commit="2a2a"))
    (pair.new / "figures" / "fig09.svg").unlink()
    before = contents(pair)
    assert run() == [
        "removed figures/fig09.svg",
        "copied figures/fig05.nc",
        "Commit the record with the reason: git add figures config *.md && git commit",
    ]
    after = contents(pair)
    assert not (pair.record / "figures" / "fig09.svg").exists()
    assert {path.name for path in after if after[path] != before[path]} == {"fig05.nc"}
    assert pair.compare().outcome.agrees
    assert run() == ["Nothing to accept: the results agree with the record."]


def test_a_folder_has_its_artifacts_beyond_the_paper_beside_a_page_about_them(pair, run):
    old, new = (side / "figures/beyond/ext_height.nc" for side in (pair.record, pair.new))
    data = pair.dataset("fig05")
    write_dataset(data, old)
    write_dataset(data.assign(phase=data.phase + 1e-3), new)
    page = old.with_name("README.md")
    page.write_text("# Beyond the paper\n", encoding="utf-8")
    assert run(more=[new])[:-1] == ["copied figures/beyond/ext_height.nc"]
    assert page.exists()


def test_accept_of_named_artifacts_copies_these_alone(pair, run, refusal):
    drift(pair)
    pair.rewrite("paper.md", "reproduced", "contradicted")
    pair.write("fig08", pair.dataset("fig08").assign_attrs(provenance_commit="2a2a"))
    assert {*run("fig08", "paper")[:-1]} == {"copied figures/fig08.nc", "copied paper.md"}
    assert not pair.artifact("fig05").outcome.agrees
    pair.write("fig05", pair.dataset("fig05").assign_attrs(provenance_dirty="yes"))
    before = contents(pair)
    with refusal(ModelError, "uncommitted changes, remove and run again: ", "figures/fig05.nc"):
        run("fig05")
    with refusal(ModelError, "unknown artifact fig99"):
        run("fig05", "fig99")
    assert contents(pair) == before


@pytest.mark.parametrize(
    ("state", "left", "config", "said"),
    [
        (UNKNOWN, 0, "force", "this folder is no repository of git"),
        (Revision("1f0e", "yes"), 0, "force", "some changes are not committed"),
        (Revision("1f0e", "no"), 0, "displacement", "config.yaml: {'release': 'displacement'}"),
        (Revision("1f0e", "no"), 3, "force", "Snakemake would still run 3 jobs: run"),
        (Revision("1f0e", "no"), 1, "force", "Snakemake would still run 1 job: run"),
        (Revision("1f0e", "no"), 0, "force", "fig17.png is not made by this workflow: remove it"),
    ],
)
def test_a_refusal_changes_nothing(pair, run, monkeypatch, refusal, state, left, config, said):
    drift(pair)
    monkeypatch.setattr(module.provenance, "revision", lambda _: state)
    monkeypatch.setattr(module, "jobs_left", lambda *_: left)
    (pair.new / "figures" / "fig17.png").touch()
    before = contents(pair)
    with refusal(ModelError, said):
        run(config={"release": config})
    assert contents(pair) == before


def test_the_jobs_left_are_those_of_a_dry_run(monkeypatch, tmp_path, refusal):
    ends = iter([(0, "job  count\nall 1\ntotal 4\n", ""), (0, "", ""), (1, "", "many\nwords\n")])

    def done(*_, **__):
        return subprocess.CompletedProcess([], *next(ends))

    monkeypatch.setattr(module.subprocess, "run", done)
    assert module.jobs_left(tmp_path, []) == 4
    assert module.jobs_left(tmp_path, []) == 0
    with refusal(ModelError, "a dry run fails: words"):
        module.jobs_left(tmp_path, [])

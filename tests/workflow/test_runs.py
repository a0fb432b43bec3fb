"""Runs as a user sees them: targets by name, reproducible bytes, interruptions."""

import os
import re
import shutil
import signal
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import pytest

from bouncing_ball.datasets.files import read_dataset
from bouncing_ball.paper.artifacts import ARTIFACTS
from bouncing_ball.pipeline.artifact_files import files_in
from bouncing_ball.pipeline.diff.datasets import compare_datasets

ROOT = Path(__file__).resolve().parents[2]


def test_a_run_makes_every_file_of_the_record(pristine):
    made = {name for name in pristine.contents("results")}
    assert made == files_in(ROOT)


STAGES = {
    "schematics": {"fig01", "fig04"},
    "restitution_model": {"fig02", "fig03"},
    "apparent_restitution": {"fig05", "fig06", "fig10", "fig13"},
    "time_histories": {"fig07", "fig12"},
    "continuation_of_orbits": {"fig08", "fig09", "fig15", "table1"},
    "permanent_contact": {"fig11", "fig16"},
    "error_thresholds": {"fig14", "thresholds"},
}


def test_every_artifact_and_every_stage_is_a_target_with_all_of_its_files(fresh):
    # It ends with an error if there is no such target.
    made = fresh.planned_files(*ARTIFACTS, *STAGES)
    expected = {f"results/{file}" for file in files_in(ROOT) if file.startswith("figures/")}
    assert made.keys() == expected
    alone = {name: {name} for name in ARTIFACTS}
    needed = fresh.needed("all", "replication", *ARTIFACTS, *STAGES)
    for target, names in [*alone.items(), *STAGES.items()]:
        files = {Path(file).stem for file, rule in made.items() if rule in needed[target]}
        assert names <= files, target
    # The replication is another name of everything.
    assert needed["replication"] ^ needed["all"] == {"replication", "all"}


def test_a_run_gives_the_accepted_datasets(pristine, recorded):
    made = {name: read_dataset(pristine.path / f"results/figures/{name}.nc") for name in recorded}
    rows = {name: compare_datasets(recorded[name], data) for name, data in made.items()}
    assert [(name, row) for name in rows for row in rows[name] if not row.outcome.agrees] == []


def test_a_run_touches_no_tracked_file(pristine, cloned):
    before = cloned.contents()
    after = {k: v for k, v in pristine.contents().items() if not k.startswith("results/")}
    assert after == before


@pytest.mark.long
def test_a_killed_run_is_resumed_without_loss(fresh, pristine):
    names = ("fig11", "fig16", "fig12")
    files = [f"results/figures/{name}.nc" for name in names]
    fresh.interrupt(signal.SIGKILL, "--cores", "1", *files, after=1, of="figures/[!.]*.nc")
    early = fresh.contents("results")
    fresh.run("--cores", "1", *files)
    after = fresh.contents("results")
    assert len(early) < 3 and {Path(name).stem for name in after} == {*names}
    # What is there under its own name is whole, even after a kill, and stays.
    assert [name for name in early if early[name] != after[name]] == []
    # A run that nothing interrupts makes the same.
    expected = pristine.contents("results")
    assert [name for name in after if after[name] != expected[name]] == []


@pytest.mark.long
def test_a_run_that_nothing_interrupts_gives_the_same_bytes(pristine, fresh):
    # Another number of jobs at a time, another order.
    fresh.run("--cores", "1")
    after = fresh.contents("results")
    expected = pristine.contents("results")
    assert after.keys() == expected.keys()
    assert [name for name in after if after[name] != expected[name]] == []


@pytest.mark.long
def test_runs_with_other_parameters_stand_beside_each_other(fresh, tmp_path):
    values = {"elastic": 0.9, "plastic": 0.5}

    def run(name):
        given = tmp_path / f"{name}.yaml"
        given.write_text(f"paper: {{fig11: {{restitution: {values[name]}}}}}\n", encoding="utf-8")
        beside = ("--directory", str(tmp_path / name), "--configfile", str(given))
        return fresh.run("--cores", "1", "fig11", "diff", *beside, check=False)

    # At the same time, each with its own results and its own comparison, of this artifact alone.
    with ThreadPoolExecutor() as pool:
        done = dict(zip(values, pool.map(run, values), strict=True))
    for name, restitution in values.items():
        results = tmp_path / name / "results"
        assert read_dataset(results / "figures" / "fig11.nc").attrs["restitution"] == restitution
        assert {path.name for path in (results / "diff").iterdir()} == {"diff.txt", "index.html"}
        page = (results / "diff" / "diff.txt").read_text(encoding="utf-8")
        assert f"parameter changed, restitution 0.65 → {restitution}" in page
        lines = done[name].stdout.splitlines()
        made = [line.split()[1] for line in lines if line.startswith("made ")]
        assert made == ["results/figures/fig11.nc", "results/figures/fig11.png"]
        # The pictures of the record have more pixels, which the line says after that.
        (cause,) = [line for line in lines if line.startswith("fig11: ")]
        assert cause.startswith(f"fig11: parameter changed, restitution 0.65 → {restitution}")
        assert lines[-1] == "1 with changed parameters. The results differ from the record."
        page = os.path.relpath(results / "diff" / "index.html", fresh.path)
        last = f"diff: the results differ from the record (exit status 1), see {page}"
        assert done[name].returncode == 1 and done[name].stderr.splitlines()[-1] == last
    assert not (fresh.path / "results").exists()


@pytest.mark.long
def test_two_figures_that_are_interrupted_and_resumed_elsewhere_have_the_same_bytes(
    pristine, tmp_path
):
    # In another folder, and few at once: the same bytes as those of a whole run.
    elsewhere = replace(pristine, path=tmp_path / "elsewhere", package=str(pristine.path / "src"))
    shutil.copytree(pristine.path / "config", elsewhere.path / "config")
    run = ("--snakefile", str(pristine.path / "Snakefile"), "--cores", "1", "fig11", "fig12")
    expected = pristine.contents("results")
    found = []
    for count, sign in enumerate((signal.SIGINT, signal.SIGTERM), start=1):
        elsewhere.interrupt(sign, *run, after=count, of="figures/[!.]*")
        found.append(elsewhere.contents("results"))
    elsewhere.run(*run)
    found.append(elsewhere.contents("results"))
    kinds = ("nc", "png", "svg")
    whole = {f"figures/{name}.{kind}" for name in run[-2:] for kind in kinds}
    # What the job that was stopped had just written, Snakemake removes.
    assert found[0].keys() < whole and found[1].keys() < whole and found[2].keys() == whole
    assert [name for made in found for name in made if made[name] != expected[name]] == []


@pytest.mark.long
def test_the_report_shows_every_figure_offline(complete):
    complete.run("--report", "results/report.html")
    page = (complete.path / "results" / "report.html").read_text(encoding="utf-8")
    for name, each in ARTIFACTS.items():
        if not name.startswith("fig"):
            continue
        assert f"results/{each.place}.png" in page
        assert not name.startswith("fig") or f"Figure {int(name[3:])}." in page
    loaded = re.findall(r"<(?:script|link|img)[^>]+(?:src|href)=[\"'](\w+:[^\"']*)", page)
    assert [url for url in loaded if not url.startswith("data:")] == []

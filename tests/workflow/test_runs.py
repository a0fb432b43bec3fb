"""Runs as a user sees them: targets by name, reproducible bytes, interruptions."""

import re
import shutil
import signal
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import pytest
from declared_artifacts import ARTIFACTS

from bouncing_ball.datasets.files import read_dataset
from bouncing_ball.pipeline.diff.datasets import compare_datasets

ROOT = Path(__file__).resolve().parents[2]


def made_by_a_run():
    """The names of the datasets that a run makes."""
    return {name for name, each in ARTIFACTS.items() if each.study}


def test_a_run_makes_every_figure_and_table(pristine):
    made = set(pristine.contents("results"))
    figures = ROOT / "figures"
    drawn = {str(path.with_suffix("").relative_to(ROOT)) for path in figures.rglob("*.svg")}
    pictures = {f"{place}.{kind}" for place in drawn for kind in ("png", "svg")}
    data = {f"{ARTIFACTS[name].place}.nc" for name in made_by_a_run()}
    recorded = {str(path.with_suffix("").relative_to(ROOT)) for path in figures.rglob("*.csv")}
    texts = {f"{place}.{kind}" for place in recorded for kind in ("csv", "md")}
    pages = {"paper.md", "supplement.md", "tally.txt"}
    assert made == pictures | data | texts | pages


def test_the_replication_makes_the_artifacts_of_the_paper_and_nothing_else(fresh):
    jobs = fresh.planned("replication") - {
        "The figures, tables and claims of the paper and its article are up to date",
        "Writing results/paper.md and results/supplement.md",
    }
    # Messages such as "fig08", "Drawing fig08" and "Setting table1".
    made = {job.split()[-1] for job in jobs}
    assert made == {name for name, each in ARTIFACTS.items()}


def stages():
    """The artifacts of each stage of both sets of studies."""
    found = {}
    for each in ARTIFACTS.values():
        if not each.accepted:
            found.setdefault(each.stage, []).append(each)
    return found


# One of them, and weekly further ones of both sets of studies; below all of them at once.
SELDOM = [pytest.param(x, marks=pytest.mark.long) for x in ("proofs", "formulas", "schematics")]


@pytest.mark.parametrize("name", ["permanent_contact", *SELDOM])
def test_a_stage_is_a_target_that_makes_its_datasets_pictures_and_tables(fresh, name):
    made = set(fresh.planned_files(name))
    own = {file for each in stages()[name] for file in each.files}
    # The rest is what its studies read.
    assert own and own <= made
    assert all(ARTIFACTS[Path(file).stem].stage != name for file in made - own)


def test_every_stage_is_a_target(fresh):
    names = sorted(stages())
    assert {"apparent_restitution", "continuation_of_orbits", "error_thresholds"} <= {*names}
    # It ends with an error if there is no such target.
    made = set(fresh.planned_files(*names))
    for artifacts in stages().values():
        for each in artifacts:
            assert {*each.files} <= made


def test_a_run_gives_the_accepted_datasets(pristine, recorded):
    made = {name: read_dataset(pristine.path / ARTIFACTS[name].dataset) for name in made_by_a_run()}
    rows = {name: compare_datasets(recorded[name], data) for name, data in made.items()}
    assert [(name, row) for name in rows for row in rows[name] if not row.outcome.agrees] == []


def test_a_run_touches_no_tracked_file(pristine, cloned):
    before = cloned.contents()
    after = {k: v for k, v in pristine.contents().items() if not k.startswith("results/")}
    assert after == before


def test_a_killed_run_is_resumed_without_loss(fresh, pristine):
    files = ("results/figures/fig11.nc", "results/figures/fig12.nc")
    fresh.interrupt(signal.SIGKILL, "--cores", "1", *files, after=1, of="figures/[!.]*.nc")
    early = fresh.contents("results")
    fresh.run("--cores", "1", *files)
    after = fresh.contents("results")
    assert len(early) == 1 and len(after) == 2
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
    last = "diff: the results differ from the record (exit status 1), see results/diff/index.html"
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
        if not each.drawing:
            continue
        assert f"results/{each.place}.png" in page
        assert not name.startswith("fig") or f"Figure {int(name[3:])}." in page
    loaded = re.findall(r"<(?:script|link|img)[^>]+(?:src|href)=[\"'](\w+:[^\"']*)", page)
    assert [url for url in loaded if not url.startswith("data:")] == []

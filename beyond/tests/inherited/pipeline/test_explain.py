"""``bouncing-ball explain``: the origin of a file, and the commands that make it again."""

import json
import os
import subprocess
from pathlib import Path

import pytest
import xarray as xr
from matplotlib.figure import Figure

from bouncing_ball_beyond.inherited.datasets.files import write_dataset
from bouncing_ball_beyond.inherited.drawing.files import save
from bouncing_ball_beyond.inherited.pipeline import provenance as module
from bouncing_ball_beyond.inherited.pipeline.provenance import (
    PREFIX,
    Revision,
    gather,
    read_provenance,
)
from bouncing_ball_beyond.inherited.pipeline.sources import versions

COMMIT = "a" * 40
OTHER = "b" * 40
MADE = {
    "commit": COMMIT,
    "dirty": "no",
    "configuration": "{}",
    "inputs": '["config/x.yaml"]',
    "versions": json.dumps(versions()),
}


def made(target, **changed):
    return {PREFIX + name: text for name, text in (MADE | {"target": target} | changed).items()}


@pytest.fixture
def results(tmp_path, monkeypatch):
    """A folder with a dataset, its figure, its table and the paper."""
    monkeypatch.setattr(module, "revision", lambda _: Revision(COMMIT, "no"))
    monkeypatch.chdir(tmp_path)
    figures = tmp_path / "results" / "figures"
    attributes = {"title": "stage", "references": "paper", "restitution": 0.85, "n": [1, 2]}
    data = xr.Dataset(attrs=attributes | made("results/figures/fig08.nc"))
    write_dataset(data, figures / "fig08.nc")
    for kind in ("png", "svg"):
        save(Figure(), figures / f"fig08.{kind}", made("results/figures/fig08.png"))
    (figures / "fig08.csv").write_text("r\n0.85\n", encoding="utf-8")
    (tmp_path / "results" / "paper.md").write_text("# Text\n", encoding="utf-8")
    return tmp_path / "results"


MAKE = "snakemake --cores 2 --force"


def test_a_picture_is_explained_by_its_metadata_and_the_dataset_beside_it(results, ask, said):
    answer = ask("explain", "results/figures/fig08.png")
    assert answer == {
        "file": "results/figures/fig08.png",
        "commit": COMMIT,
        "checked_out": True,
        "dirty": "no",
        "configuration": {},
        "parameters": {"restitution": 0.85, "n": [1, 2]},
        "inputs": ["config/x.yaml"],
        "versions": versions(),
        "running": {},
        "make_again": [f"{MAKE} results/figures/fig08.png"],
    }
    assert ask("explain", "results/figures/fig08.svg") | {"file": answer["file"]} == answer
    lines = said("explain", "results/figures/fig08.png").splitlines()
    shown = dict(line.split("  ", 1) for line in lines)
    assert shown["commit"].strip() == COMMIT and shown["checked out"].strip() == "true"
    assert shown["parameters restitution"].strip() == "0.85"
    assert shown["make again"].strip() == f"{MAKE} results/figures/fig08.png"


@pytest.mark.parametrize("file", ["figures/fig08.nc", "figures/fig08.csv", "paper.md"])
def test_a_table_is_explained_by_its_dataset_and_the_paper_by_the_last_one(results, ask, file):
    other = xr.Dataset(attrs=made("results/figures/other.nc", commit=OTHER))
    write_dataset(other, results / "figures" / "other.nc")
    os.utime(results / "figures" / "other.nc", (0, 0))
    answer = ask("explain", str(results / file))
    assert answer["commit"] == COMMIT
    assert answer["make_again"] == [f"{MAKE} results/{file}"]


def test_another_commit_dirt_and_other_versions_are_named(results, ask, monkeypatch):
    path = results / "figures" / "fig08.png"
    target = "results/figures/fig08.png; date"
    changed = {"commit": OTHER, "dirty": "yes", "versions": '{"python": "3.99.0"}'}
    save(Figure(), path, made(target, **changed))
    answer = ask("explain", str(path))
    # Its dataset beside it is of another commit.
    assert answer["checked_out"] is False and answer["parameters"] == {}
    again = [f"git checkout {OTHER}", "make setup", f"{MAKE} '{target}'"]
    assert answer["make_again"] == again
    assert (answer["dirty"], answer["versions"]) == ("yes", {"python": "3.99.0"})
    assert answer["running"] == versions()
    monkeypatch.setattr(module, "house_of", lambda *starts: None)
    assert ask("explain", str(path))["checked_out"] is None


def test_a_target_is_quoted(results, ask):
    """A file may say anything, and a user may paste it."""
    write_dataset(xr.Dataset(attrs=made("$(rm a)")), results / "fig08.nc")
    assert ask("explain", "results/fig08.nc")["make_again"] == [f"{MAKE} '$(rm a)'"]


def test_a_house_is_named_or_found(results, ask, monkeypatch):
    asked = []
    monkeypatch.setattr(module, "revision", lambda house: asked.append(house) or module.UNKNOWN)
    for folder in (results.parent, results.parent / "beyond"):
        (folder / "config").mkdir(parents=True)
        for name in ("Snakefile", "config/config.yaml"):
            (folder / name).touch()
    ask("explain", "results/figures/fig08.nc")
    ask("explain", "results/figures/fig08.nc", "--house", "beyond")
    assert asked == [results.parent, results.parent / "beyond"]


def test_escape_sequences_are_shown_and_not_sent(results, said):
    changed = {"\x1b[2J": "\x1b]0;title\x07"}
    figure = results / "figures" / "fig11.png"
    save(Figure(), figure, made("\x1b[31m", configuration=json.dumps(changed)))
    text = said("explain", str(figure))
    assert "\x1b" not in text and "\x07" not in text and "\\x1b[31m" in text


def test_another_configuration_is_named_and_written_again(results, ask, said):
    changed = {"figures": {"fig11": {"restitution": 0.7}}, "release": "it's"}
    path = results / "figures" / "fig11.png"
    save(Figure(), path, made("fig11", configuration=json.dumps(changed)))
    answer = ask("explain", str(path))
    assert answer["configuration"] == changed
    write, make = answer["make_again"]
    subprocess.run(["sh", "-c", write], check=True)
    assert json.loads((results / "configuration.json").read_text(encoding="utf-8")) == changed
    assert make == f"{MAKE} fig11 --configfile results/configuration.json"
    shown = said("explain", str(path)).splitlines()
    assert 'configuration figures  {"fig11": {"restitution": 0.7}}' in shown


@pytest.mark.parametrize(
    ("file", "said"),
    [
        ("nothing.png", "cannot be read: no such file"),
        ("results", "cannot be read: no such file"),
        ("pipe.nc", "cannot be read: no such file"),
        ("foreign.png", "carries no provenance"),
        ("notes.md", "is not an artifact of this workflow: there is no notes.nc next to it"),
        ("paper.md", "is not an artifact of this workflow: there is no paper.nc next to it"),
        ("odd.nc", "its provenance is damaged"),
        ("other.nc", "carries no provenance"),
        ("cut.nc", "cannot be read: damaged, or not ours"),
        ("cut.png", "cannot be read: damaged, or not ours"),
        ("cut.svg", "cannot be read: damaged, or not ours"),
    ],
)
def test_a_file_that_is_not_ours_exits_2_with_one_line(results, refused, file, said):
    Figure().savefig("foreign.png")
    os.mkfifo("pipe.nc")
    write_dataset(xr.Dataset(attrs=made("a", versions="[1]")), "odd.nc")
    write_dataset(xr.Dataset(attrs={"provenance_inputs": "[]"}), "other.nc")
    for name in ("notes.md", "paper.md", "cut.nc", "cut.png", "cut.svg"):
        Path(name).write_bytes(b"text")
    status, line = refused("explain", file)
    assert status == 2 and line.startswith(f"bouncing-ball: {file}") and said in line


def test_a_job_gathers_its_commit_changes_and_sorted_inputs(tmp_path, monkeypatch):
    (tmp_path / "config").mkdir()
    (tmp_path / "config" / "config.yaml").write_text("n: 1\nr: 0.85\n", encoding="utf-8")
    monkeypatch.setattr(module, "revision", lambda _: Revision(COMMIT, "yes"))
    inputs = ["results/b.nc", "results/a.nc", "results/b.nc"]
    found = gather("results/c.nc", inputs, tmp_path, {"n": 2, "r": 0.85})
    write_dataset(xr.Dataset(attrs=found), tmp_path / "c.nc")
    assert read_provenance(tmp_path / "c.nc") == {
        "commit": COMMIT,
        "dirty": "yes",
        "configuration": {"n": 2},
        "target": "results/c.nc",
        "inputs": ["results/a.nc", "results/b.nc"],
        "versions": versions(),
        "parameters": {},
    }

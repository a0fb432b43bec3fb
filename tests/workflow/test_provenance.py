"""Every artifact says where it comes from, and nothing of when and on which machine."""

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from bouncing_ball.record.carriers import CARRIERS, read_provenance
from bouncing_ball.record.explain import explain
from bouncing_ball.record.job_log import read_log
from bouncing_ball.record.provenance import LIBRARIES, Provenance, file_digest


def artifacts(tree):
    """Paths of the files that carry provenance."""
    return [path for path in (tree.path / "results").rglob("*.*") if path.suffix in CARRIERS]


def test_every_artifact_says_where_it_comes_from(pristine):
    paths = artifacts(pristine)
    assert {path.suffix for path in paths} == set(CARRIERS)
    commit = pristine.git("rev-parse", "HEAD")
    lock = file_digest(pristine.path / "requirements.lock")
    for path in paths:
        # The form of every part is checked as it is read, to its last character:
        # nothing of the time, the machine or the place is in it.
        made = read_provenance(path)
        assert (made.commit, made.dirty, made.lock) == (commit, "no", lock), path
        assert made.configuration == "{}"
        for name, checksum in json.loads(made.inputs).items():
            assert re.fullmatch(r"results/figures/\w+\.nc", name)
            assert file_digest(pristine.path / name) == checksum, path
        expected = path.with_suffix(".png" if path.suffix == ".svg" else path.suffix)
        assert pristine.path / made.target == expected
        assert list(json.loads(made.versions)) == ["python", *LIBRARIES]


def test_every_text_has_its_provenance_in_the_log(pristine):
    figures = pristine.path / "results" / "figures"
    logs = pristine.path / "results" / "logs"
    found = {log.stem: read_log(log) for log in [*(logs / "tables").iterdir(), logs / "paper.log"]}
    assert {f"{path.stem}" for path in figures.glob("*.tex")} | {"paper"} == set(found)
    for name, log in found.items():
        made = log.provenance()
        assert made.commit == pristine.git("rev-parse", "HEAD") and made.dirty == "no"
        for path, checksum in log.sums.items():
            assert file_digest(pristine.path / path) == checksum
        for path, checksum in json.loads(made.inputs).items():
            assert file_digest(pristine.path / path) == checksum
        if name != "paper":
            data = read_provenance(figures / f"{name}.nc")
            assert made.parameters == data.parameters


def test_a_picture_has_the_parameters_of_its_dataset(pristine):
    figures = pristine.path / "results" / "figures"
    for data in figures.glob("fig*.nc"):
        made = read_provenance(data)
        for kind in (".png", ".svg"):
            assert read_provenance(data.with_suffix(kind)).parameters == made.parameters
    # What depends on other parameters has another checksum.
    different = {read_provenance(path).parameters for path in figures.glob("*.nc")}
    assert len(different) == len(list(figures.glob("*.nc")))


def test_a_commit_runs_nothing_again(complete):
    (complete.path / "README.md").write_text("Another text.\n", encoding="utf-8")
    (complete.path / "requirements.lock").write_text("", encoding="utf-8")
    complete.commit("Other words")
    (complete.path / "README.md").write_text("Not committed.\n", encoding="utf-8")
    assert complete.planned() == set()


def made_by(tree, *arguments) -> Provenance:
    tree.run("--cores", "1", "fig11", *arguments)
    made = {read_provenance(path) for path in tree.path.glob("results/figures/fig11.*")}
    assert len({(one.commit, one.dirty, one.parameters) for one in made}) == 1
    return read_provenance(tree.path / "results" / "figures" / "fig11.nc")


def test_a_dirty_tree_is_said_to_be_dirty(pristine, fresh):
    clean = read_provenance(pristine.path / "results" / "figures" / "fig11.nc")
    fresh.configure("figures", "fig11", "restitution", value=0.7)
    fresh.edit("impacts/permanent_contact.py")
    made = made_by(fresh)
    assert (made.commit, made.dirty) == (clean.commit, "yes")
    assert made.parameters != clean.parameters and made.sources != clean.sources


def test_another_configuration_is_named_and_its_command_gives_the_file(complete, monkeypatch):
    folder = complete.path / "results" / "figures"
    picture, kept = folder / "fig11.png", complete.path / "results" / "kept"
    clean = read_provenance(picture)
    shutil.copytree(folder, kept)
    config = complete.path / "results" / "mine.yaml"
    config.write_text("figures:\n  fig11:\n    restitution: 0.7\n", encoding="utf-8")
    made = made_by(complete, "--configfile", str(config))
    # The tree is clean: a commit and this configuration decide.
    assert (made.commit, made.dirty) == (clean.commit, "no")
    assert json.loads(made.configuration) == {"figures": {"fig11": {"restitution": 0.7}}}
    other = picture.read_bytes()
    assert other != (kept / "fig11.png").read_bytes()
    monkeypatch.chdir(complete.path)
    answer = explain(Path("results/figures/fig11.png"))
    assert answer["configuration"] == {"figures.fig11.restitution": 0.7}
    for kind in CARRIERS:
        (folder / f"fig11{kind}").unlink()
    found = complete.environment() | {"PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}"}
    for command in answer["make_again"]:
        subprocess.run(command, shell=True, check=True, capture_output=True, env=found)
    assert picture.read_bytes() == other

"""Every artifact says where it comes from, and nothing of when and on which machine."""

import json
import os
import re
import shutil
from pathlib import Path

from bouncing_ball.record.carriers import CARRIERS, read_provenance
from bouncing_ball.record.provenance import LIBRARIES, Provenance, file_digest


def artifacts(tree):
    """Paths of the files that carry provenance."""
    return [path for path in (tree.path / "results").rglob("*.*") if path.suffix in CARRIERS]


def test_every_artifact_says_where_it_comes_from(pristine):
    paths = artifacts(pristine)
    # 17 pictures twice, and 22 datasets.
    assert len(paths) == 2 * 17 + 22
    commit = pristine.git("rev-parse", "HEAD")
    lock = file_digest(pristine.path / "requirements.lock")
    for path in paths:
        made = read_provenance(path)
        assert (made.commit, made.dirty, made.lock) == (commit, "no", lock), path
        for name, checksum in json.loads(made.inputs).items():
            assert file_digest(pristine.path / name) == checksum, path
        # A picture is made with its twin, by the name of the first.
        assert Path(made.target).with_suffix("") == Path("results/figures", path.stem)
        assert "provenance_" not in "".join(json.loads(made.inputs))


def test_nothing_of_the_time_the_machine_or_the_place(pristine):
    # Every value, to its last character.
    word = r"[a-z0-9_]+"
    checksum = re.compile(r"[0-9a-f]{64}")
    for path in artifacts(pristine):
        made = read_provenance(path)
        assert re.fullmatch(r"[0-9a-f]{40}", made.commit)
        assert made.dirty == "no"
        assert re.fullmatch(rf"results/figures/{word}\.(nc|png)", made.target)
        for value in (made.parameters, made.sources, made.lock):
            assert checksum.fullmatch(value)
        for name, value in json.loads(made.inputs).items():
            assert re.fullmatch(rf"results/figures/{word}\.nc", name) and checksum.fullmatch(value)
        versions = json.loads(made.versions)
        assert list(versions) == ["python", *LIBRARIES]
        for value in versions.values():
            assert re.fullmatch(r"\d+(\.\d+)+(\.?(a|b|rc|post|dev)\d+)?", value)


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
    assert complete.planned() == set()
    (complete.path / "README.md").write_text("Not committed.\n", encoding="utf-8")
    assert complete.planned() == set()


def made_by(tree, *arguments) -> Provenance:
    tree.run("--cores", "1", "fig11", *arguments)
    made = {read_provenance(path) for path in artifacts(tree)}
    assert len({(one.commit, one.dirty, one.parameters) for one in made}) == 1
    return read_provenance(tree.path / "results" / "figures" / "fig11.nc")


def test_a_dirty_tree_is_said_to_be_dirty(pristine, fresh):
    clean = read_provenance(pristine.path / "results" / "figures" / "fig11.nc")
    fresh.configure("figures", "fig11", "restitution", value=0.7)
    made = made_by(fresh)
    assert (made.commit, made.dirty) == (clean.commit, "yes")
    assert made.parameters != clean.parameters and made.sources == clean.sources
    fresh.git("checkout", "--", ".")
    fresh.edit("impacts/permanent_contact.py")
    assert made_by(fresh).sources != clean.sources


def test_options_of_the_command_line_are_dirt(pristine, fresh):
    clean = read_provenance(pristine.path / "results" / "figures" / "fig11.nc")
    made = made_by(fresh, "--config", "release=force")
    assert (made.commit, made.dirty) == (clean.commit, "yes")
    # Back to the commit: made again, as its parameters are others.
    assert made_by(fresh) == clean
    # A reason is no parameter.
    assert made_by(fresh, "--forceall", "--config", "reason=Why") == clean


def test_a_package_from_elsewhere_is_dirt(fresh, tmp_path, monkeypatch):
    shutil.copytree(fresh.path / "src", tmp_path / "src")
    monkeypatch.setattr(
        type(fresh), "environment", lambda _: os.environ | {"PYTHONPATH": str(tmp_path / "src")}
    )
    made = made_by(fresh)
    assert (made.commit, made.dirty) == (fresh.git("rev-parse", "HEAD"), "yes")


def test_a_copy_without_git_is_unknown(fresh):
    shutil.rmtree(fresh.path / ".git")
    made = made_by(fresh)
    assert (made.commit, made.dirty) == ("unknown", "unknown")


def test_a_run_elsewhere_names_the_same_commit(pristine, tmp_path):
    elsewhere = tmp_path / "elsewhere"
    shutil.copytree(pristine.path / "config", elsewhere / "config")
    pristine.run("--cores", "1", "fig11", "--directory", str(elsewhere))
    for kind in CARRIERS:
        there = elsewhere / "results" / "figures" / f"fig11{kind}"
        assert there.read_bytes() == (pristine.path / there.relative_to(elsewhere)).read_bytes()

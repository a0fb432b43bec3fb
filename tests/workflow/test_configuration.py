"""Configurations that a run refuses before any job is run: one line, and no file is changed."""

import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


def test_a_wrong_configuration_stops_the_workflow_and_changes_no_file_but_an_earlier_page(complete):
    page = complete.path / "results/diff/index.html"
    page.parent.mkdir(exist_ok=True)
    page.write_text("<p>Everything agrees.</p>", encoding="utf-8")
    before = {k: (complete.path / k).stat().st_mtime_ns for k in complete.contents()}
    before.pop("config/config.yaml")
    before = {name: time for name, time in before.items() if not name.startswith("results/diff/")}
    # Snakemake itself would take the last one without a word.
    with (complete.path / "config/config.yaml").open("a") as file:
        file.write("release: force\n")
    assert complete.refusal().startswith("config/config.yaml: duplicate key 'release' in line ")
    after = {k: (complete.path / k).stat().st_mtime_ns for k in before}
    assert after == before
    assert not page.exists()


def test_a_configuration_that_is_no_text_of_yaml_gives_one_line(complete):
    path = complete.path / "config/config.yaml"
    kept = path.read_bytes()
    try:
        path.write_bytes("# Größe\n".encode("latin-1") + kept)
        said = "config/config.yaml: not YAML: unacceptable character #x00"
        assert complete.refusal().startswith(said)
    finally:
        path.write_bytes(kept)


@pytest.mark.long
def test_results_are_a_folder_or_a_link_to_one(fresh, tmp_path):
    results = fresh.path / "results"
    assert not results.exists()
    refused = "results is no folder, but the run writes its files there: move it away"
    results.write_text("my notes", encoding="utf-8")
    assert fresh.refusal("fig03") == refused
    results.unlink()
    results.symlink_to(tmp_path / "elsewhere")
    assert fresh.refusal("fig03") == refused
    (tmp_path / "elsewhere").mkdir()
    assert {"compute_fig03", "draw_fig03"} <= fresh.planned("fig03")
    # The link is no change of the tree, which the provenance would call dirty.
    assert fresh.git("status", "--porcelain") == ""
    results.unlink()


def test_the_package_of_another_checkout_is_refused(fresh, tmp_path):
    # Run as it would be with that checkout's environment.
    shutil.copytree(fresh.path / "src", tmp_path / "other")
    said = replace(fresh, package=str(tmp_path / "other")).refusal()
    assert said.startswith(f"bouncing_ball is imported from {tmp_path / 'other'}")
    assert str(fresh.path / "src") in said


@pytest.mark.long
def test_a_python_whose_path_has_a_space_runs_the_jobs(fresh, tmp_path):
    venv = tmp_path / "a venv"
    (venv / "bin").mkdir(parents=True)
    (venv / "bin" / "python").symlink_to(Path(sys.executable).resolve())
    shutil.copyfile(Path(sys.prefix, "pyvenv.cfg"), venv / "pyvenv.cfg")
    (venv / "lib").symlink_to(Path(sys.prefix, "lib"))
    replace(fresh, python=f"{venv}/bin/python").run("--cores", "1", "results/figures/fig04.png")


def test_make_refuses_a_path_with_a_space(tmp_path):
    folder = tmp_path / "a checkout"
    folder.mkdir()
    shutil.copyfile(ROOT / "Makefile", folder / "Makefile")
    for options, status in (((), 2), (("VENV=/venv",), 0)):
        command = ["make", "--dry-run", "clean", *options]
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
        assert done.returncode == status
        assert ("the path of this checkout has a space" in done.stderr) == (status == 2)

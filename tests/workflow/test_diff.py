"""The target ``diff``: the results of a run against a record.

The record of the repository was made on another processor, perhaps. So that the
test is the same everywhere, the results are the record here, and are moved on
purpose: first as another processor does it, and then further.
"""

import json
import shutil

from bouncing_ball.compare.drift import span
from bouncing_ball.compare.tolerance_file import read_tolerances
from bouncing_ball.datasets.netcdf import read_dataset, write_dataset


def test_a_run_against_its_record(complete):
    shutil.rmtree(complete.path / "figures")
    shutil.copytree(complete.path / "results" / "figures", complete.path / "figures")
    shutil.copyfile(complete.path / "results" / "paper.md", complete.path / "paper.md")
    # Another processor: half a budget, which no text and no picture shows.
    path = complete.path / "figures" / "fig11.nc"
    data = read_dataset(path)
    rules = read_tolerances(complete.path / "config" / "tolerances.yaml")
    budget = rules.of("fig11", "threshold_amplitude").budget * span(data.threshold_amplitude)
    data.threshold_amplitude.values[7] += budget / 2
    write_dataset(data, path)
    done = complete.run("--cores", "1", "diff")
    lines = done.stdout.splitlines()
    assert lines[-2].split()[:4] == ["fig11", "within", "budget", "50"]
    assert lines[-1].endswith("The new artifacts say what the record says.")
    reports = complete.path / "results" / "diff"
    assert {path.name for path in reports.iterdir()} == {"diff.json", "diff.md", "index.html"}
    content = json.loads((reports / "diff.json").read_text(encoding="utf-8"))
    outcomes = {found["name"]: found["outcome"] for found in content["artifacts"]}
    assert outcomes.pop("fig11") == "within budget" and set(outcomes.values()) == {"identical"}
    files = {part["file"] for found in content["artifacts"] for part in found["parts"]}
    made = complete.contents("results")
    assert files == {name for name in made if name.startswith("figures/") or name == "paper.md"}
    before = {path.name: path.read_bytes() for path in reports.iterdir()}

    # Nothing is to be made, and it compares anew: the record has changed.
    data.threshold_amplitude.values[7] += 1e-3
    write_dataset(data, path)
    (complete.path / "figures" / "fig12.svg").unlink()
    done = complete.run("--cores", "1", "diff", check=False)
    # The record is no input: what has changed there makes nothing again.
    assert done.returncode == 1 and "made results/" not in done.stdout
    lines = done.stdout.splitlines()
    assert [line.split()[0] for line in lines[-3:-1]] == ["fig12", "fig11"]
    assert lines[-1].startswith("1 extra, 1 drifted, ")
    said = [line for line in done.stderr.splitlines() if line.startswith("diff: ")]
    assert said == ["diff: see results/diff/index.html, or diff.md and diff.json beside it"]
    assert "Traceback" not in done.stderr
    # The reports outlive the job that failed, and say what has changed.
    content = json.loads((reports / "diff.json").read_text(encoding="utf-8"))
    assert content["status"] == 1
    after = {path.name: path.read_bytes() for path in reports.iterdir()}
    assert before.keys() == after.keys() and not any(before[n] == after[n] for n in after)
    assert str(complete.path).encode() not in b"".join(after.values())

"""The targets ``diff`` and ``accept``: the results of a run against a record.

The record of the repository was made on another processor, perhaps. So that the
test is the same everywhere, the results are the record here, and are moved on
purpose: first as another processor does it, and then further.
"""

import os
import shutil

import pytest

from bouncing_ball.datasets.files import read_dataset, write_dataset
from bouncing_ball.pipeline.diff.datasets import budget_of, span


@pytest.fixture
def recorded(complete):
    """A run whose record are its own results."""
    shutil.rmtree(complete.path / "figures")
    shutil.copytree(complete.path / "results" / "figures", complete.path / "figures")
    for name in ("paper.md", "supplement.md"):
        shutil.copyfile(complete.path / "results" / name, complete.path / name)
    complete.commit("A record")
    return complete


def drifted(tree, budgets):
    """Move one number of the record of a tree by a multiple of its budget."""
    path = tree.path / "figures" / "fig11.nc"
    data = read_dataset(path)
    size = budget_of(data.threshold_amplitude.attrs).size * span(data.threshold_amplitude)
    data.threshold_amplitude.values[7] += budgets * size
    write_dataset(data, path)


def test_a_drifted_record_turns_diff_red_and_is_replaced_by_accept(recorded, monkeypatch):
    drifted(recorded, 0.5)
    before = recorded.path / "results" / "diff" / "replication.html"
    before.parent.mkdir()
    before.write_text("The results agree with the record.", encoding="utf-8")
    lines = recorded.run("--cores", "1", "diff").stdout.splitlines()
    assert lines[-1].startswith("1 rounding, ") and lines[-1].endswith(
        " identical. The results agree with the record."
    )
    reports = recorded.path / "results" / "diff"
    assert {path.name for path in reports.iterdir()} == {"diff.txt", "index.html"}
    before = recorded.contents("results/diff")

    # Nothing is to be made, and it compares anew: the record has changed.
    drifted(recorded, 1e6)
    (recorded.path / "figures" / "fig12.svg").unlink()
    done = recorded.run("--cores", "1", "diff", check=False)
    # The record is no input: what has changed there makes nothing again.
    assert done.returncode == 1 and "made results/" not in done.stdout
    lines = done.stdout.splitlines()
    first, second = (line for line in lines if line.startswith("fig"))
    assert first.startswith("fig12: a file is not in the record")
    assert second.startswith("fig11: numbers moved; ")
    assert lines[-1].startswith("1 extra, 1 drifted, ")
    last = "diff: the results differ from the record (exit status 1), see results/diff/index.html"
    assert done.stderr.splitlines()[-1] == last and "Error" not in done.stderr
    after = recorded.contents("results/diff")
    assert before.keys() == after.keys() and not any(before[n] == after[n] for n in after)
    assert str(recorded.path).encode() not in b"".join(after.values())

    # The next run is another one. What is refused is said in one line, and nothing is copied.
    readme = recorded.path / "README.md"
    text = readme.read_text(encoding="utf-8")
    readme.write_text("Not committed.\n", encoding="utf-8")
    record = recorded.contents("figures")
    done = recorded.run("--cores", "1", "accept", check=False)
    assert done.returncode == 1 and "Error" not in done.stderr
    assert done.stderr.splitlines()[-1].startswith("accept: some changes are not committed")
    assert recorded.contents("figures") == record
    readme.write_text(text, encoding="utf-8")
    monkeypatch.setitem(os.environ, "ONLY", "fig11,fig12")
    done = recorded.run("--cores", "1", "accept")
    assert "copied figures/fig11.nc" in done.stdout and "git commit" in done.stdout
    assert recorded.git("status", "--porcelain") == ""


@pytest.mark.long
def test_a_study_that_fails_is_listed_and_all_else_is_made_and_compared(recorded):
    page = recorded.path / "results" / "diff" / "index.html"
    page.parent.mkdir()
    page.write_text("2 identical. The results agree with the record.", encoding="utf-8")
    module = "src/bouncing_ball/paper/exhibits/restitution_model.py"
    heading = '-> xr.Dataset:\n    """Ball and table'
    recorded.rewrite(module, heading, heading.replace("\n", "\n    raise ValueError('no orbit')\n"))
    other = "src/bouncing_ball/paper/exhibits/permanent_contact.py"
    recorded.rewrite(other, '("frequency_ratio", curve),', '("frequency_ratio", 1.001 * curve),')
    # What fails and what waits for it has its line, each once, and the rest is made.
    done = recorded.run("--cores", "1", check=False)
    reason = "compute_fig02: no orbit"
    *_, failed, waiting = done.stderr.splitlines()
    assert done.returncode == 1 and failed == f"not made: fig02 ({reason})"
    # Before them, where its log is, which alone has the sources.
    log = "results/logs/compute_fig02.log"
    said = done.stdout + done.stderr
    assert f"{reason} (details in {log})" in said and "src/bouncing_ball" not in said
    assert "src/bouncing_ball" in (recorded.path / log).read_text(encoding="utf-8")
    # Snakemake gives them in an order of its own.
    waiting = waiting.removeprefix("not made: ").removesuffix(" (needs compute_fig02)")
    assert {"witness", "claims", "paper"} <= {*waiting.split(", ")}
    assert "made results/figures/fig11.nc" in done.stdout and not page.exists()

    done = recorded.run("--cores", "1", "diff", check=False)
    lines = done.stdout.splitlines()
    assert done.returncode == 1 and "results/diff/index.html" in done.stderr.splitlines()[-1]
    assert f"fig02: not made, {reason}" in lines
    assert "paper: not made, needs compute_fig02" in lines
    # The file of code that changed is named.
    (line,) = (line for line in lines if line.startswith("fig11: "))
    assert line.startswith(f"fig11: changed code, {other}; +0.1 % in ")
    assert lines[-1].endswith("The results differ from the record.")
    assert "not made" in lines[-1] and "identical" in lines[-1]
    assert reason in page.read_text(encoding="utf-8")

"""Another paper in a folder of its own: `tests/pendulum` uses `paper_replication` from there."""

import re
import shutil
import subprocess

import pytest
from tests.checkout import ROOT, Checkout

from paper_replication.datasets import parameters, read

PAGES = ("index.html", "paper.html", "numbers.html")


def git(there, *arguments):
    author = ["-c", "user.name=A", "-c", "user.email=a@b.c"]
    subprocess.run(["git", "-C", str(there.path), *author, *arguments], check=True)


@pytest.fixture(scope="module")
def accepted(git_of_its_own, tmp_path_factory):
    """A copy of the folder, with its first results as its reference."""
    folder = tmp_path_factory.mktemp("another") / "pendulum"
    there = Checkout(shutil.copytree(ROOT / "tests/pendulum", folder))
    git(there, "init", "-qb", "main")
    git(there, "add", ".")
    git(there, "commit", "-qm", "first")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PYTHONPATH", str(ROOT / "src"))
        status, printed = there.run("--cores", "1", "accept")
        assert status == 0, printed
        yield there


def test_a_dataset_a_claim_and_a_sentence(accepted):
    fig1, claims = (read(accepted.path / f"figures/{name}.nc") for name in ("fig1", "claims"))
    assert parameters(fig1) == {"length": 1.0, "gravity": 9.81}
    assert (claims.verdict == "reproduced").all()
    assert "\nAt 60° a swing takes 2.15 s." in (accepted.path / "paper.md").read_text("utf-8")


def test_a_misnamed_section_is_refused_by_its_name(accepted):
    accepted.edit("config/config.yaml", "periods:", "period:")
    status, _ = accepted.run("--cores", "1")
    accepted.edit("config/config.yaml", "period:", "periods:")
    assert status == "configuration: period: unknown key, did you mean periods?"


def test_its_pages_have_no_links_to_pages_that_it_lacks(accepted):
    folder = accepted.path / "results"
    pages = {name: (folder / name).read_text("utf-8") for name in PAGES}
    for page in pages.values():
        for target in re.findall('(?:href|src)="(.*?)"', page):
            file, _, anchor = target.partition("#")
            assert not file or (folder / file).is_file(), target
            assert not anchor or f'id="{anchor}"' in pages.get(file, page), target
    assert 'src="figures/fig1.svg" alt="Figure\u00a01"' in pages["paper.html"]
    assert "<math" in pages["paper.html"]
    assert '<a class="number" href="numbers.html#paper-0"' in pages["paper.html"]
    assert "fig1.period.sel(angle=60).item()" in pages["numbers.html"]
    assert pages["index.html"].count('<span class="verdict reproduced">') == 2


def test_a_changed_parameter_is_red_and_named_until_it_is_accepted(accepted):
    def compared():
        status, _ = accepted.run("--cores", "1", "diff")
        return status, (accepted.path / "results/diff/report.txt").read_text("utf-8")

    accepted.edit("config/config.yaml", "9.81", "9.80665")
    status, report = compared()
    assert status == 1
    assert "fig1: period 2" in report and "parameter: gravity 9.81 → 9.80665\n" in report
    git(accepted, "commit", "-qam", "second")
    assert accepted.run("--cores", "1", "accept")[0] == 0
    assert compared()[0] == 0


@pytest.mark.parametrize(
    "line, saves, made",
    [
        ('    """The stage."""\n', "pendulum.py", "figures/fig1.nc"),
        ('    if name == "fig1":\n', "results/figures/fig1.nc", "figures/fig1.png"),
    ],
)
def test_a_job_under_which_a_file_changes_leaves_no_result(
    accepted, tmp_path, capfd, line, saves, made
):
    """Code that is saved while a stage computes, and a dataset while it is drawn."""
    there = Checkout(shutil.copytree(accepted.path, tmp_path / "pendulum"))
    save = f'{" " * (8 if "if" in line else 4)}Path("{saves}").open("ab").write(b"\\n")\n'
    there.edit("pendulum.py", line, line + save)
    assert there.run("--cores", "1", "fig1")[0] == 1
    (line,) = capfd.readouterr().err.splitlines()
    assert line.startswith("run again: ") and line.endswith(f"{saves} changed while this job ran")
    assert not (there.path / "results" / made).exists()

"""What may become the record, and how it is replaced: as a whole, or completed by a rerun."""

import contextlib
import csv
import io
import itertools
import json
import os
import runpy
import shutil
import subprocess
import warnings
from pathlib import Path

import numpy as np
import pytest

from bouncing_ball.compare.outcome import Outcome
from bouncing_ball.datasets.atomic import replacing
from bouncing_ball.datasets.netcdf import read_dataset, write_dataset
from bouncing_ball.record.accept import (
    COLUMNS,
    LOG,
    accept,
    chosen,
    commits,
    log_with,
    made_from,
    replace_record,
)
from bouncing_ball.record.proof import RefusedError, check_made, check_versions
from bouncing_ball.record.provenance import LIBRARIES, Provenance, file_digest, versions
from bouncing_ball.record.recipe import Run
from bouncing_ball.record.revision import UNKNOWN, Revision

ROOT = Path(__file__).resolve().parents[2]
SmallRun = runpy.run_path(str(ROOT / "tests" / "attack" / "provenance.py"))["SmallRun"]
REASON = "Why, in a few words"


@pytest.fixture(scope="module")
def template(tmp_path_factory):
    """A small run, with versions that are locked."""
    folder = tmp_path_factory.mktemp("template")
    lock = "\n".join(f"{name}=={version}" for name, version in versions().items())
    with contextlib.chdir(folder):
        (folder / "requirements.lock").write_text(lock, encoding="utf-8")
        SmallRun(folder).create()
    return folder


@pytest.fixture(scope="module")
def recorded(template, tmp_path_factory):
    """The small run, and that it is the record."""
    folder = tmp_path_factory.mktemp("recorded") / "world"
    shutil.copytree(template, folder)
    with contextlib.chdir(folder):
        accepted(SmallRun(folder))
    return folder


def copied(source, folder, monkeypatch):
    shutil.copytree(source, folder)
    monkeypatch.chdir(folder)
    return SmallRun(folder)


@pytest.fixture
def first(template, tmp_path, monkeypatch):
    """A small run without a record in the working directory, that a test may change."""
    return copied(template, tmp_path / "world", monkeypatch)


@pytest.fixture
def world(recorded, tmp_path, monkeypatch):
    """A small run and its record in the working directory, that a test may change."""
    return copied(recorded, tmp_path / "world", monkeypatch)


def nothing_again(name, results, folder):
    """Of a small run nothing can be made once more."""


def accepted(world, reason=REASON, only="", now=None, make_again=nothing_again):
    run = world.run()
    run = Run(run.repository, now or run.now, run.configuration)
    return accept(run, Path("results"), world.recipes(), world.files(), reason, only, make_again)


def contents(*folders):
    paths = [path for folder in folders for path in Path(folder).rglob("*")]
    paths += [Path("paper.md"), Path(LOG)]
    return {str(path): path.read_bytes() for path in paths if path.is_file()}


def entries():
    with open(LOG, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def nudge(variable, name, by):
    """Change one value of a dataset of the results, and make again what is made from it."""

    def change(world):
        path = Path("results/figures", f"{name}.nc")
        data = read_dataset(path)
        data[variable].values.flat[7 % data[variable].size] *= 1 + by
        write_dataset(data, path)
        world.sign(f"figures/{name}.nc")
        world.make(f"{name}.png", f"{name}.csv")
        world.make("paper.md")

    return change


within = nudge("threshold_amplitude", "fig11", 1e-15)
drift = nudge("threshold_amplitude", "fig11", 1e-3)


def refused(world, *parts, **arguments):
    before = contents("figures")
    with pytest.raises(RefusedError) as error:
        accepted(world, **arguments)
    said = str(error.value)
    assert said.isprintable() and all(part in said for part in parts), said
    assert contents("figures") == before


def test_the_first_record_and_then_nothing(first, capsys):
    accepted(first)
    assert contents("figures").keys() == {*first.files(), LOG}
    assert all(
        Path(file).read_bytes() == Path("results", file).read_bytes() for file in first.files()
    )
    [entry] = entries()
    assert (entry["number"], entry["commit"], entry["reason"]) == ("1", "c" * 40, REASON)
    assert entry["changes"] == "fig11 new; paper new; thresholds new"
    before = contents("figures")
    assert accepted(first, reason="Again") == ["nothing to accept"]
    assert "Nothing to accept" in capsys.readouterr().out and contents("figures") == before


def test_what_is_within_its_budget_stays(world):
    before = contents("figures")
    within(world)
    assert Path("results/figures/fig11.nc").read_bytes() != before["figures/fig11.nc"]
    assert accepted(world, reason="Another processor") == ["nothing to accept"]
    assert contents("figures") == before


@pytest.mark.parametrize("only", ["fig11", "all"])
def test_what_is_within_its_budget_moves_if_asked_for(world, only):
    within(world)
    refused(world, "unknown artifact fig99", only="fig11 fig99")
    assert accepted(world, only="moved") == ["nothing to accept"]
    accepted(world, reason="Asked for", only=only)
    assert entries()[-1]["changes"] == "fig11 within budget"
    assert Path("figures/fig11.nc").read_bytes() == Path("results/figures/fig11.nc").read_bytes()


def test_what_has_moved_is_copied_and_named_and_nothing_else(world):
    before = contents("figures")
    drift(world)
    lines = accepted(world, reason="Moved")
    assert entries()[-1]["changes"] == "fig11 drifted"
    after = contents("figures")
    moved = {LOG, *(f"figures/fig11.{kind}" for kind in ("nc", "png", "svg"))}
    assert {name for name in after if after[name] != before.get(name)} == moved
    assert {*lines} == moved - {LOG}


def move_two(world):
    """Two artifacts that have moved, and one that is no more."""
    nudge("relative_error", "thresholds", 1e-2)(world)
    drift(world)
    (Path("figures") / "old.png").write_bytes(b"of an older version")


def test_nothing_is_accepted_in_bulk_by_accident(world):
    move_two(world)
    refused(world, "3 artifacts have moved: fig11, old, thresholds; look at each", "ONLY=moved")
    accepted(world, only="moved")
    assert entries()[-1]["changes"] == "fig11 drifted; old removed; thresholds drifted"


def test_one_artifact_and_the_others_later(world):
    move_two(world)
    before = contents("figures")
    lines = accepted(world, reason="Looked at", only="fig11")
    assert entries()[-1]["changes"] == "fig11 drifted"
    after = contents("figures")
    assert all("fig11" in name or after[name] == before[name] for name in before if name != LOG)
    assert {*lines} == {f"figures/fig11.{kind}" for kind in ("nc", "png", "svg")}
    assert accepted(world, reason="No more", only="old") == ["removed figures/old.png"]
    accepted(world, reason="The last needs no name")
    assert [entry["reason"] for entry in entries()[1:]] == [
        "Looked at", "No more", "The last needs no name"
    ]  # fmt: skip


def test_each_with_its_own_reason(world, capsys):
    move_two(world)
    capsys.readouterr()
    accepted(world, reason="A finer step | Another root", only="fig11 | thresholds, old")
    assert [(entry["number"], entry["reason"], entry["changes"]) for entry in entries()[1:]] == [
        ("2", "A finer step", "fig11 drifted"),
        ("3", "Another root", "old removed; thresholds drifted"),
    ]
    said = capsys.readouterr().out
    assert "Accepted fig11 drifted; reason: A finer step\n" in said


@pytest.mark.parametrize(
    ("only", "reason", "said"),
    [
        ("fig11 | old", "one", "ONLY has 2 groups and REASON has 1: give one reason for each"),
        ("fig11 | old", "one | ", "say why"),
        ("fig11 | old", "one | two | three", "ONLY has 2 groups and REASON has 3"),
        ("fig11 | ", "one | two", "a group in ONLY is empty"),
        ("fig11 | old fig11", "one | two", "fig11 is named twice"),
        ("fig11 | all", "one | two", "fig11 is named twice"),
    ],
)
def test_reasons_and_artifacts_go_together(world, only, reason, said):
    move_two(world)
    refused(world, said, only=only, reason=reason)


def change_text(world):
    """The text moves by a digit that may follow its data."""
    paper = Path("results/paper.md")
    paper.write_text(paper.read_text(encoding="utf-8").replace("0.25", "0.26"), encoding="utf-8")
    world.sign("paper.md")


def test_a_text_moves_with_what_it_is_made_from(world):
    drift(world)
    change_text(world)
    accepted(world, only="fig11")
    names = {part.split()[0] for part in entries()[-1]["changes"].split("; ")}
    assert names == {"fig11", "paper"}


def test_a_text_moves_with_all_that_it_is_made_from_or_not_at_all(world):
    move_two(world)
    change_text(world)
    for only, missed in (
        ("fig11", "thresholds"), ("thresholds", "fig11"), ("paper", "fig11, thresholds"),
    ):  # fmt: skip
        refused(world, f"paper is made from {missed} too, which moved: name", only=only)
    accepted(world, only="fig11 | thresholds", reason="one | two")
    assert [entry["changes"] for entry in entries()[1:]] == [
        "fig11 drifted", "paper drifted; thresholds drifted"
    ]  # fmt: skip


def test_which_artifacts_move():
    outcomes = {
        "fig05": Outcome.WITHIN, "fig08": Outcome.DRIFTED, "evidence": Outcome.WITHIN,
        "claims": Outcome.WITHIN, "witness": Outcome.IDENTICAL, "paper": Outcome.WITHIN,
        "fig99": Outcome.EXTRA, "old": Outcome.MISSING,
    }  # fmt: skip
    reads = {
        "evidence": {"fig08"},
        # By way of what is not published.
        "claims": {"tally"},
        "tally": {"evidence"},
        "witness": {"fig08"},
        "paper": {"fig05"},
    }
    assert chosen(outcomes, reads, [["moved"]]) == [{"fig08", "fig99", "old", "evidence", "claims"}]
    assert chosen(outcomes, reads, [["fig08"], ["old"]]) == [
        {"fig08", "evidence", "claims"}, {"old"}
    ]  # fmt: skip
    assert chosen(dict.fromkeys(outcomes, Outcome.WITHIN), reads, [[]]) == [set()]


def test_what_is_made_from_what(world):
    assert made_from(world.recipes()) == {
        "fig11": set(), "thresholds": set(), "paper": {"fig11", "thresholds"}
    }  # fmt: skip


# What is refused, where it is decided.


@pytest.mark.parametrize(
    ("reason", "said"),
    [("", "say why"), (" \t", "say why"), ("one\ntwo", "one line"), ("\x1b[2J", "one line")],
)
def test_a_reason_is_one_line(world, reason, said):
    refused(world, said, reason=reason)


@pytest.mark.parametrize("reason", ['costs $5: 100 % #1 `x` "q" it\'s', "ϖ → ∞", "- a, b; c"])
def test_a_reason_is_recorded_as_it_is(first, reason):
    accepted(first, reason=reason)
    assert entries()[-1]["reason"] == reason


def test_a_tree_that_is_no_commit(world):
    refused(world, "the tree is dirty: commit first", now=Revision("c" * 40, "yes"))
    refused(world, "no git repository", now=UNKNOWN)


def edit_source(world):
    Path("workflow/scripts/figure.py").write_text("# other\n", encoding="utf-8")


def edit_configuration(world):
    world.configure(fig11=0.7)


def edit_lock(world):
    path = Path("requirements.lock")
    path.write_text(path.read_text(encoding="utf-8") + "\n# other", encoding="utf-8")


def edit_dataset_and_log(world):
    path = Path("results/figures/fig11.nc")
    data = read_dataset(path)
    data.threshold_amplitude.values[7] += 0.1
    write_dataset(data, path)
    world.sign("figures/fig11.nc")


def edit_text(world):
    path = Path("results/figures/thresholds.csv")
    path.write_text(path.read_text(encoding="utf-8").replace("1", "2", 1), encoding="utf-8")


def edit_table_and_log(world):
    path = Path("results/figures/thresholds.md")
    path.write_text(path.read_text(encoding="utf-8").replace("1", "2", 1), encoding="utf-8")
    world.sign("figures/thresholds.md")


def mix_pictures(world):
    picture = Path("results/figures/fig11.svg").read_bytes()
    edit_source(world)
    world.make("fig11.png")
    Path("results/figures/fig11.svg").write_bytes(picture)
    world.sign("figures/fig11.svg")


def make_dirty(world):
    world.make("fig11.png", run=world.run(dirty="yes"))


def make_dirty_text(world):
    world.make("thresholds.csv", run=world.run(dirty="unknown"))


def make_otherwise(world):
    config = {"fig11": 0.7, "table": 1}
    world.make("fig11.nc", run=world.run(config=config), config=config)


def lose_a_log(world):
    Path("results/logs/stages/paper.md.log").unlink()


def lose_a_file(world):
    Path("results/figures/fig11.svg").unlink()


def add_a_file(world):
    Path("results/figures/mine.png").write_bytes(b"")


MADE = "made from other than this commit makes it from: "
TAMPERED = [
    (edit_source, ["fig11.png: ", MADE + "other sources; ", "--force results/figures/fig11.png"]),
    (edit_configuration, ["fig11.nc: ", MADE + "other parameters"]),
    (edit_lock, ["fig11.nc: ", MADE + "another requirements.lock; and 4 more; ", "--forceall"]),
    (edit_dataset_and_log, ["fig11.png: ", MADE + "another results/figures/fig11.nc; and 1 more"]),
    (edit_text, ["thresholds.csv: thresholds.csv is not what its job wrote; make again"]),
    (edit_table_and_log, ["paper.md: ", MADE + "another results/figures/thresholds.md"]),
    (mix_pictures, ["fig11.png: ", "its files are of different jobs"]),
    (make_dirty, ["fig11.png: ", MADE + "the tree was dirty"]),
    (make_dirty_text, ["thresholds.csv: ", MADE + "the commit is unknown"]),
    (make_otherwise, ["fig11.nc: ", MADE + "configuration with another fig11, other parameters"]),
    (lose_a_log, ["paper.md: paper.md is not what its job wrote"]),
    (lose_a_file, ["fig11.png: no file results/figures/fig11.svg"]),
    (add_a_file, ["results/figures/mine.png is not made by this workflow: remove it"]),
]


@pytest.mark.parametrize(
    ("tamper", "said"), TAMPERED, ids=lambda value: getattr(value, "__name__", "")
)
def test_results_that_the_commit_does_not_make(world, tamper, said):
    tamper(world)
    refused(world, *said)
    # As `snakemake --touch` does; or as `cp -p` gives a source its old time.
    for path in Path().rglob("*"):
        os.utime(path, (1e9 + path.is_relative_to("results"), 1e9))
    refused(world, *said)


def test_times_of_files_and_other_commits_count_for_nothing(world):
    for path in Path().rglob("*"):
        os.utime(path, (1e9, 1e9 + path.is_relative_to("workflow")))
    proven = check_made(world.recipes(), Run(world.folder, Revision("d" * 40, "no"), "{}"))
    assert {made.commit for made in proven.values()} == {"c" * 40}


def test_versions_that_are_not_locked(world, one_line):
    found = {name: f"1.{number}" for number, name in enumerate(LIBRARIES)}
    pins = [f"{name.lower()}=={version} \\" for name, version in found.items()]
    one = {"a.png": Provenance(*"abcdefgh", versions=json.dumps({"python": "3.11"} | found))}
    check_versions(one, "\n".join(pins))
    # Another version for another system.
    check_versions(one, "\n".join([*pins, "numpy==0.9 ; sys_platform == 'win32'"]))
    for lock, said in (
        ([*pins[1:], "numpy==1.00"], "a.png made with numpy 1.0, requirements.lock has 1.00: "),
        (pins[:-1], "a.png made with matplotlib 1.4, requirements.lock has none: "),
    ):
        with pytest.raises(RefusedError) as error:
            check_versions(one, "\n".join(lock))
        one_line(error, said, "make setup")
    Path("requirements.lock").write_text(f"numpy=={np.__version__}\n", encoding="utf-8")
    world.make()
    refused(world, "requirements.lock has none")


def test_commits_the_most_frequent_first():
    made = [Provenance(commit, *"bcdefghi") for commit in ("1f0e", "2a2a", "1f0e")]
    assert commits(made, Revision("2a2a", "no")) == [
        "2 files made at commit 1f0e, up to date but not the one checked out",
        "1 files made at commit 2a2a",
    ]


# The record is replaced as a whole, or completed by a rerun.


def test_the_log_grows_and_can_be_read_back():
    reasons = ["First", 'A "quoted" one, with a comma', "  Third "]
    text = ""
    for reason in reasons:
        text = log_with(text, "1f0e", reason, {"fig08": "drifted", "fig03": "within budget"})
    header, *rows = csv.reader(io.StringIO(text))
    assert tuple(header) == COLUMNS
    assert [row[0] for row in rows] == ["1", "2", "3"]
    assert [row[2] for row in rows] == [reason.strip() for reason in reasons]
    assert {row[3] for row in rows} == {"fig03 within budget; fig08 drifted"}


def test_a_copy_that_fails_leaves_the_record_as_it_was(world):
    before = contents("figures")
    missing = Path("results/figures/nothing.png")
    with pytest.raises(FileNotFoundError):
        replace_record(
            Path(), Path("results"), [*world.files(), "figures/nothing.png"], [], "after"
        )
    assert contents("figures") == before and not missing.exists()


def accepted_and_killed(world, at, *arguments):
    """A process that dies at its ``at``-th renaming, nothing cleaned up: as SIGKILL does."""
    with warnings.catch_warnings():
        # Newer Pythons warn of threads, of which the child uses none.
        warnings.simplefilter("ignore", DeprecationWarning)
        child = os.fork()
    if child == 0:
        renamings = itertools.count(1)
        rename = os.replace

        def dying(*arguments, **keywords):
            if next(renamings) == at:
                os._exit(9)
            return rename(*arguments, **keywords)

        os.replace = dying
        with contextlib.suppress(BaseException):
            accepted(world, *arguments)
        os._exit(1)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 9


@pytest.mark.parametrize("at", range(1, 5))
def test_an_acceptance_killed_at_any_rename_is_completed_by_the_next(world, at):
    drift(world)
    before = contents("figures")
    accepted_and_killed(world, at, "Moved")
    assert list(Path("figures").glob(".*.part.*"))
    accepted(world, reason="Moved")
    assert {*contents("figures")} == {*before}
    for file in world.files():
        if "fig11" in file:
            assert Path(file).read_bytes() == Path("results", file).read_bytes()
    # One entry, which names all, however far it came.
    assert [(entry["reason"], entry["changes"]) for entry in entries()[1:]] == [
        ("Moved", "fig11 drifted")
    ]
    assert accepted(world, reason="Moved") == ["nothing to accept"]


def test_two_entries_killed_are_completed_by_the_same_command(world):
    move_two(world)
    typed = ["A finer step | Another root", "fig11 | thresholds old"]
    accepted_and_killed(world, 3, *typed)
    accepted(world, *typed)
    assert [(entry["reason"], entry["changes"]) for entry in entries()[1:]] == [
        ("A finer step", "fig11 drifted"),
        ("Another root", "old removed; thresholds drifted"),
    ]
    assert accepted(world) == ["nothing to accept"] and not Path("figures/old.png").exists()


def test_what_is_halfway_written_is_no_change(tmp_path):
    subprocess.run(["git", "init", "--quiet", str(tmp_path)], check=True)
    shutil.copy(ROOT / ".gitignore", tmp_path)
    for name in (LOG, "paper.md", "figures/fig08.nc"):
        with contextlib.suppress(KeyboardInterrupt), replacing(tmp_path / name) as temporary:
            temporary.write_text("", encoding="utf-8")
            # What a kill at this point leaves.
            shutil.copy(temporary, temporary.with_stem(f".killed{temporary.stem}"))
            raise KeyboardInterrupt
    done = subprocess.run(
        ["git", "status", "--porcelain", "--untracked-files=all"],
        cwd=tmp_path, capture_output=True, text=True, check=True,
    )  # fmt: skip
    assert done.stdout == "?? .gitignore\n"


def test_a_table_changed_together_with_its_log(world):
    """Each checksum is right, but the dataset gives another table."""
    table = Path("results/figures/thresholds.csv")
    honest = table.read_bytes()

    def make_again(name, results, folder):
        if name == "thresholds":
            (folder / table.name).write_bytes(honest)

    log = Path(world.recipes()[3].log)
    before, forged = file_digest(table), honest + b"one more row\n"
    table.write_bytes(forged)
    log.write_text(log.read_text("utf-8").replace(before, file_digest(table)), encoding="utf-8")
    world.make("paper.md")
    record = contents("figures")
    with pytest.raises(RefusedError) as error:
        accepted(world, only="moved", make_again=make_again)
    assert str(error.value) == (
        "figures/thresholds.csv is not what its dataset gives; make again: "
        "snakemake --cores 2 --force results/figures/thresholds.csv"
    )
    assert contents("figures") == record

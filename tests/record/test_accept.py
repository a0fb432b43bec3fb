"""The record is replaced as a whole or not at all."""

import csv
import io
import json
import shutil

import pytest

from bouncing_ball.record import accept as record_module
from bouncing_ball.record.accept import (
    COLUMNS,
    LOG,
    RefusedError,
    check_results,
    check_run,
    check_tree,
    check_versions,
    commits,
    log_with,
    replace_record,
)
from bouncing_ball.record.provenance import LIBRARIES, Provenance
from bouncing_ball.record.revision import UNKNOWN, Revision

FILES = ["figures/fig01.png", "figures/fig02.png", "paper.md"]


@pytest.fixture
def folders(tmp_path):
    """A record and new results of the same files."""
    for folder, text in (("record", "old"), ("results", "new")):
        for file in FILES:
            path = tmp_path / folder / file
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(f"{text} {file}", encoding="utf-8")
    return tmp_path / "record", tmp_path / "results"


def contents(folder):
    return {
        str(path.relative_to(folder)): path.read_text(encoding="utf-8")
        for path in folder.rglob("*")
        if path.is_file()
    }


def test_everything_is_copied_and_what_is_stale_removed(folders):
    record, results = folders
    (record / "figures" / "fig99.png").write_text("stale", encoding="utf-8")
    lines = replace_record(record, results, FILES, FILES, "the log")
    assert contents(record) == contents(results) | {LOG: "the log"}
    assert lines == [*FILES, "removed figures/fig99.png"]


def test_what_has_not_moved_stays(folders):
    record, results = folders
    lines = replace_record(record, results, FILES, FILES[:1], "the log")
    assert lines == FILES[:1]
    for file in FILES:
        side = results if file == FILES[0] else record
        expected = f"{'new' if side is results else 'old'} {file}"
        assert (record / file).read_text(encoding="utf-8") == expected


def test_a_copy_that_fails_leaves_the_record_as_it_was(folders, monkeypatch):
    record, results = folders
    (record / LOG).write_text("before", encoding="utf-8")
    (record / "figures" / "fig99.png").write_text("stale", encoding="utf-8")
    before = contents(record)
    copyfile = shutil.copyfile

    def full(source, target):
        if source.name == "paper.md":
            raise OSError("no space left on device")
        copyfile(source, target)

    monkeypatch.setattr(record_module.shutil, "copyfile", full)
    with pytest.raises(OSError, match="no space left"):
        replace_record(record, results, FILES, FILES, "after")
    assert contents(record) == before


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


def made(commit, dirty="no"):
    return Provenance(commit, dirty, *"cdefgh")


def test_what_is_refused(one_line):
    check_tree(Revision("1f0e", "no"))
    check_results({"fig01.png": made("1f0e")})
    for now, said in ((Revision("1f0e", "yes"), "dirty"), (UNKNOWN, "no git repository")):
        with pytest.raises(RefusedError) as error:
            check_tree(now)
        one_line(error, said)
    for dirty in ("yes", "unknown"):
        with pytest.raises(RefusedError) as error:
            check_results({"a.png": made("1f0e"), "b.png": made("1f0e", dirty)})
        one_line(error, "b.png made from a dirty or unknown tree", "--forceall")


def test_a_run_on_more_than_the_commit_is_refused(tmp_path, one_line):
    with pytest.raises(RefusedError) as error:
        check_run(tmp_path, {})
    one_line(error, "the package is not imported from src/", "accept what the commit alone makes")


def test_versions_that_are_not_locked_are_refused(one_line):
    versions = {name: f"1.{number}" for number, name in enumerate(LIBRARIES)}
    lines = [f"{name.lower()}=={version} \\" for name, version in versions.items()]
    one = {"a.png": Provenance(*"abcdefg", versions=json.dumps({"python": "3.11"} | versions))}
    check_versions(one, "\n".join(lines))
    # Another version for another system.
    check_versions(one, "\n".join([*lines, "numpy==0.9 ; sys_platform == 'win32'"]))
    for lock, said in (
        ([*lines[1:], "numpy==1.00"], "a.png made with numpy 1.0, requirements.lock has 1.00: "),
        (lines[:-1], "a.png made with matplotlib 1.4, requirements.lock has none: "),
    ):
        with pytest.raises(RefusedError) as error:
            check_versions(one, "\n".join(lock))
        one_line(error, said, "make setup")


def test_commits_the_most_frequent_first():
    lines = commits([made("1f0e"), made("2a2a"), made("1f0e")], Revision("2a2a", "no"))
    assert lines == [
        "2 files made at commit 1f0e, up to date but not the one checked out",
        "1 files made at commit 2a2a",
    ]

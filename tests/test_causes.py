"""What a reviewer reads first after an edit: the line on what changed, and why."""

import shutil

import pytest
from tests.repository import commit, git

# The matrix: edits, each of a text in a file, and the first line that a reviewer reads.

EDITS = {
    "code": ("src/study.py", "1 / ratio", "1.4 / ratio"),
    "a model": ("src/model.py", "1.0", "1.4"),
    "verdicts": ("src/judge.py", "LIMIT = 2.0", "LIMIT = 1.2"),
    "drawing": ("src/table.py", 'height"', 'heights"'),
    "template": ("templates/paper.md", "The greatest", "A greatest"),
    "printed table": ("config/printed.csv", "0.255", "0.256"),
    "parameter": ("config/config.yaml", "[1.0, 1.5]", "[1.0, 2.5]"),
    "small parameter": ("config/config.yaml", "[0.5, 1.0]", "[0.5, 1.01]"),
    "curve": ("config/config.yaml", "[1.0, 1.5]", "[1.0, 1.5, 2.5]"),
}
VERDICTS = (
    "claims: verdict is 'contradicted', the reference has 'reproduced' at claim = 'high', "
    "and 1 more"
)
LINES = {
    "code": (VERDICTS, "follows from light: changed: src/study.py ({})"),
    "a model": (VERDICTS, "follows from light: changed: src/model.py ({})"),
    "verdicts": (
        "claims: figures/claims.nc in the reference is not what today's code makes of its data: "
        "verdict is 'contr",
        "; changed: src/judge.py ({})",
    ),
    "drawing": (
        "heavy: figures/heavy.md in the reference is not what today's code makes of its data: "
        "line 1: 'height",
        "; changed: src/table.py ({})",
    ),
    "template": (
        "paper: paper.md in the reference is not what today's code makes of its data: "
        "line 1: 'The gr",
        "; changed: templates/paper.md ({})",
    ),
    "printed table": (
        "light: printed is 0.256, the reference has 0.255",
        "; changed: config/printed.csv ({})",
    ),
    "parameter": (
        VERDICTS,
        "follows from light: changed parameter: amplitude: new 2.5, without 1.5",
    ),
    "small parameter": (
        "heavy: max_height is 1.01, the reference has 1 at",
        "; changed parameter: amplitude: new 1.01, without 1",
    ),
    "curve": (VERDICTS, "follows from light: changed parameter: amplitude: new 2.5"),
}


def reads(line, expected, when=""):
    begin, end = expected
    return line.startswith(begin) and line.endswith(end.format(when))


@pytest.mark.parametrize("kind", EDITS)
def test_the_first_line_after_an_edit_names_its_cause(project, kind):
    """Not committed, on a branch, and on main after a push; of a parameter no time is said."""
    project.edit(*EDITS[kind])
    project.edit("README.md", "read", "do not read")
    project.run()
    lines = project.lines()
    assert reads(lines[0], LINES[kind], "not committed"), lines
    if "{}" in LINES[kind][1]:
        git(project.top, "checkout", "-q", "-b", "feature")
        commit(project.top, "edit")
        committed = git(project.top, "rev-parse", "--short", "HEAD")
        lines = project.lines()
        assert reads(lines[0], LINES[kind], f"on this branch, {committed}"), lines
        git(project.top, "update-ref", "refs/remotes/origin/main", "HEAD")
        lines = project.lines()
        assert reads(lines[0], LINES[kind], committed), lines


# The causes that the first line names after two edits, and those that other lines name.
PAIRS = {
    ("code", "verdicts"): (["src/judge.py"], ["src/study.py"]),
    ("code", "drawing"): (["src/study.py"], ["src/table.py"]),
    ("code", "template"): (["src/study.py"], ["templates/paper.md"]),
    ("code", "printed table"): (["config/printed.csv", "src/study.py"], []),
    ("code", "small parameter"): (["src/study.py"], ["new 1.01, without 1"]),
    ("verdicts", "drawing"): (["src/judge.py"], ["src/table.py"]),
    ("verdicts", "template"): (["src/judge.py"], ["templates/paper.md"]),
    ("verdicts", "printed table"): (["src/judge.py"], ["config/printed.csv"]),
    ("verdicts", "small parameter"): (["src/judge.py"], ["new 1.01, without 1"]),
    ("curve", "small parameter"): (["follows from light: ", "new 2.5"], ["new 1.01, without 1"]),
    ("parameter", "drawing"): (["new 2.5, without 1.5"], ["src/table.py"]),
    ("parameter", "template"): (["new 2.5, without 1.5"], ["templates/paper.md"]),
    ("printed table", "drawing"): (["config/printed.csv"], ["src/table.py"]),
    ("template", "drawing"): (["src/table.py"], ["templates/paper.md"]),
}


@pytest.mark.parametrize("pair", PAIRS, ids="+".join)
def test_of_two_edits_each_is_the_cause_of_what_it_changes(project, pair):
    """The first is committed on a branch, the second is not committed."""
    first, others = PAIRS[pair]
    git(project.top, "checkout", "-q", "-b", "feature")
    project.edit(*EDITS[pair[0]])
    commit(project.top, "edit")
    project.edit(*EDITS[pair[1]])
    project.run()
    lines = project.lines()
    assert all(cause in lines[0] for cause in first), lines
    assert not any(cause in lines[0] for cause in others), lines
    assert all(cause in " ".join(lines[1:-1]) for cause in others), lines


# Data that were edited by hand


def test_a_claim_follows_from_the_dataset_that_decides_it(project):
    """A title is another, and changes no verdict."""
    project.change("heavy", project.results, lambda data: data.assign_attrs(title="another"))
    project.change(
        "light", project.results, lambda data: data.assign(max_height=1.5 * data.max_height)
    )
    project.follow()
    lines = project.lines()
    assert lines[0].startswith(VERDICTS) and f"; follows from light: {NOTHING}" in lines[0], lines
    assert any(reads(line, ("heavy: title heavy -> another", "")) for line in lines)


def test_a_claim_that_only_two_datasets_together_change_follows_from_both(project):
    project.edit("src/judge.py", "max(data", "sum(data")
    project.edit("src/judge.py", "LIMIT = 2.0", "LIMIT = 2.9")
    commit(project.top, "the sum of two heights decides")
    project.run()
    project.accept()
    project.edit("config/config.yaml", "[0.5, 1.0]", "[0.5, 1.3]")
    project.edit("config/config.yaml", "[1.0, 1.5]", "[1.0, 1.8]")
    project.run()
    line = project.lines()[0]
    assert line.startswith("claims: verdict is 'contradicted', the reference has 'reproduced' at")
    assert line.endswith("claim = 'both'; follows from heavy, light"), line


def test_of_datasets_that_make_sense_only_together_all_are_named(project):
    together = "if data['heavy'].sizes != data['light'].sizes:\n        raise ValueError\n"
    project.edit("src/judge.py", "    heights", f"    {together}    heights")
    commit(project.top, "two datasets of one size")
    project.run()
    project.accept()
    project.edit("config/config.yaml", "[0.5, 1.0]", "[0.5, 1.0, 2.1]")
    project.edit("config/config.yaml", "[1.0, 1.5]", "[1.0, 1.5, 1.6]")
    project.run()
    line = project.lines()[0]
    assert line.startswith("claims: verdict is 'contradicted', the reference has 'reproduced' at")
    assert line.endswith("follows from heavy, light"), line


def test_verdicts_that_cannot_be_judged_anew_are_one_line(project):
    project.edit("src/judge.py", "LIMIT = 2.0", "LIMIT = {}['limit']")
    project.change("claims", project.results, lambda data: data.assign_attrs(title="another"))
    (line,) = [each for each in project.lines() if "cannot make it" in each]
    assert line == (
        "claims: today's code cannot make it of the dataset in the reference: KeyError('limit'); "
        "changed: src/judge.py (not committed)"
    )


NOTHING = "no file that it is made from has changed since figures/light.nc"


def test_a_reference_that_was_edited_is_named(project):
    project.change("light", project.top, lambda data: data.assign(max_height=2 * data.max_height))
    (line,) = [line for line in project.lines() if line.startswith("light: max_height")]
    assert line.endswith("; changed: figures/light.nc (not committed)")
    edited = commit(project.top, "edit")[:7]
    (line,) = [line for line in project.lines() if line.startswith("light: max_height")]
    assert line.endswith(f"; {NOTHING} (on this branch, {edited})")
    project.edit("paper.md", "greatest", "largest")
    assert project.lines()[-2].endswith("changed: paper.md (not committed)")


def test_a_reference_elsewhere_has_the_same_causes(project, tmp_path):
    shutil.copytree(project.top, tmp_path / "elsewhere", ignore=shutil.ignore_patterns(".git"))
    project.edit(*EDITS["drawing"])
    project.edit(*EDITS["code"])
    committed = commit(project.top, "edit")[:7]
    project.run()
    project.edit("src/table.py", "heights", "greatest heights")
    lines = project.lines(reference=tmp_path / "elsewhere")
    told = " ".join(lines)
    assert f"changed: src/study.py (on this branch, {committed})" in lines[0]
    assert "changed: src/table.py (not committed)" in told


def test_of_a_copy_without_git_the_files_are_known_and_not_when_they_changed(project):
    shutil.rmtree(project.top / ".git")
    project.edit(*EDITS["code"])
    project.edit(*EDITS["drawing"])
    project.run()
    told = " ".join(project.lines())
    assert "; follows from light: changed: src/study.py " in told
    assert "figures/heavy.md in the reference is not what" in told
    assert "changes of the code are unknown without the history of git" in told

"""What the comparison says of a change, and what becomes the reference.

The project of these tests has one figure, one table of claims and two texts, and a history in git.
"""

import base64
import json
import os
import shutil
import subprocess
import sys
from dataclasses import replace
from functools import partial
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr
from matplotlib.figure import Figure
from PIL import Image
from tests.jobs import Named

from carbonelli2011 import variables
from paper_replication import compare, datasets, provenance
from paper_replication.drawing import save_picture

HIGHER = "max_height 2 → 2.5 at frequency_ratio = 2 (tolerance 1e-09)"
ENTRIES = {"fig14": {"title": "T", "caption": "C", "n": 1}}
CONFIG = {"release": "force", "stage": ENTRIES}
FILES = (
    "src/model.py",
    "src/variables.py",
    "src/drawing.py",
    "src/writing.py",
    "config/config.yaml",
)


def note(project, rule, files, code, data=(), **parameters):
    """Write the record of a job."""
    results = project.top / "results"
    record = results / f"records/{rule}.json"
    made = {file: str(results / file) for file in files}
    inputs = {
        "code": [project.top / code],
        "data": [results / f"figures/{each}.nc" for each in data],
    }
    datasets.save_record(
        SimpleNamespace(
            input=SimpleNamespace(**inputs),
            output=Named(record=str(record), **made),
            params=SimpleNamespace(**parameters),
        )
    )


def make(name, data, folder, form="{:.3g}"):
    """Pictures that show numbers to three digits, or a schematic without data."""
    figure = Figure(figsize=(1, 1))
    numbers = [] if data is None else data.max_height.values
    figure.text(0, 0.5, " ".join(form.format(each) for each in numbers))
    save_picture(figure, folder / f"{name}.png", folder / f"{name}.svg")


@pytest.fixture(autouse=True, scope="module")
def git_of_its_own():
    """Git without the variables of a hook, and without the configuration of a user or a machine.

    A hook exports the index and the repository of its commit. Tests that used them would commit
    their own project into the user's repository.
    """
    asked = ["git", "rev-parse", "--local-env-vars"]
    names = subprocess.run(asked, check=True, capture_output=True, text=True).stdout.split()
    with pytest.MonkeyPatch.context() as patch:
        for name in [*names, "GIT_DEFAULT_HASH", "GIT_TEMPLATE_DIR"]:
            patch.delenv(name, raising=False)
        patch.setenv("GIT_CONFIG_GLOBAL", os.devnull)
        patch.setenv("GIT_CONFIG_NOSYSTEM", "1")
        yield


def project_in(top, patch):
    for module in (provenance, compare):
        patch.setattr(module, "CHECKOUT", top)
    return compare.Project(
        top, ("paper.md", "supplement.md"), make, ("src", "config"), variables.described
    )


@pytest.fixture(scope="module")
def accepted(git_of_its_own, tmp_path_factory):
    """A checkout whose reference is accepted and committed, with results that agree."""
    top = tmp_path_factory.mktemp("accepted") / "checkout"
    for file in FILES:
        (top / file).parent.mkdir(parents=True, exist_ok=True)
        (top / file).write_text(f"{json.dumps(CONFIG)}\n", "utf-8")
    with pytest.MonkeyPatch.context() as patch:
        project = project_in(top, patch)
        run(project)
        git(top, "init", "-qb", "main")
        (top / ".gitignore").write_text("results\n", "utf-8")
        commit(top)
        assert len(compare.accept(project, top / "results")) == 8
        commit(top)
    return top


@pytest.fixture
def project(accepted, tmp_path, monkeypatch):
    """A copy for one test."""
    top = shutil.copytree(accepted, tmp_path / "checkout")
    return project_in(top, monkeypatch)


def git(top, *arguments):
    command = ["git", "-C", str(top), "-c", "user.name=A", "-c", "user.email=a@b.c", *arguments]
    subprocess.run(command, check=True)


def commit(top):
    git(top, "add", ".")
    git(top, "commit", "-qm", "a commit")


def edit(project, *files):
    for file in files:
        with (project.top / file).open("a", encoding="utf-8") as opened:
            opened.write("\n")


def run(project, height=(1.0, 2.0), verdict="reproduced", text="82", entries=ENTRIES, **given):
    """Make results with these numbers, as the code of today would."""
    folder = project.top / "results"
    shutil.rmtree(folder, ignore_errors=True)
    data = xr.Dataset(
        {"max_height": ("frequency_ratio", list(height))}, {"frequency_ratio": [1.0, 2.0]}
    )
    judged = xr.Dataset({"verdict": ("claim", [verdict])}, {"claim": ["high"]})
    code = [project.top / "src/model.py"]
    given = {"n": 1, "release": "force"} | given
    datasets.save(
        data,
        folder / "figures/fig14.nc",
        entries["fig14"]["title"],
        given,
        code,
        variables.described,
    )
    datasets.save(judged, folder / "figures/claims.nc", "Claims", {}, code, variables.described)
    project.make("fig14", data, folder / "figures")
    project.make("fig01", None, folder / "figures")
    for name in project.texts:
        (folder / name).write_text(f"the threshold\nis {text}\n", "utf-8")
    note(project, "stage", ["figures/fig14.nc"], "src/model.py", entries=entries)
    note(project, "claims", ["figures/claims.nc"], "src/model.py", ["fig14"])
    for name, needs in (("fig01", []), ("fig14", ["fig14"])):
        files = [f"figures/{name}.{kind}" for kind in ("png", "svg")]
        note(project, name, files, "src/drawing.py", needs)
    note(project, "article", project.texts, "src/writing.py", ["fig14", "claims"], entries=entries)


def report(project, names=(), config=CONFIG):
    reference = compare.run_in(project.top, "the reference")
    results = compare.run_in(project.top / "results", "the results")
    return compare.compare(project, reference, results, config, names)


def printed(found):
    return found.printed("diff.txt.j2").splitlines()


def lines(project, **given):
    return report(project, **given).lines()


def test_a_hook_that_runs_these_tests_leaves_the_commit_of_its_user_as_it_is(tmp_path):
    """Git exports GIT_INDEX_FILE to its hooks, and in a linked worktree also GIT_DIR."""
    first = tmp_path / "of a user"
    first.mkdir()
    git(first, "init", "-qb", "main")
    for name in ("first", "second"):
        (first / name).write_text("a line\n", "utf-8")
    commit(first)
    hook = first / ".git/hooks/pre-commit"
    test = f"'{sys.executable}' -m pytest -q --noconftest '{__file__}' -k test_equal_results"
    # Once: tests that commit into this repository would start its hook again.
    hook.write_text(f'#!/bin/sh\n[ "$HOOK" ] || HOOK=1 exec {test}\n', "utf-8")
    hook.chmod(0o755)
    top = tmp_path / "linked"
    git(first, "worktree", "add", "-qb", "branch", str(top))
    (top / "first").write_text("another line\n", "utf-8")
    git(top, "commit", "-qam", "another commit")
    told = ["git", "-C", str(top), "log", "--name-only", "--format=%s", "-2"]
    answer = subprocess.run(told, check=True, capture_output=True, text=True).stdout.split("\n")
    assert answer == ["another commit", "", "first", "a commit", "", "first", "second", ""]
    told = ["git", "-C", str(top), "ls-files"]
    assert subprocess.check_output(told, text=True).split() == ["first", "second"]
    told = ["git", "-C", str(top), "config", "core.bare"]
    assert subprocess.check_output(told, text=True).strip() == "false"


def test_equal_results_agree_and_so_do_results_within_the_tolerance(project):
    assert printed(report(project)) == ["All 8 files agree with the reference."]
    run(project, height=(1.0, 2.0 + 1e-9))
    assert lines(project) == []


def test_a_parameter_is_the_cause_and_names_no_file(project):
    entries = {"fig14": ENTRIES["fig14"] | {"n": 2}}
    run(project, height=(1.0, 2.5), verdict="contradicted", text="83", entries=entries, n=2)
    config = {"release": "force", "stage": entries}
    found = report(project, config=config)
    assert found.lines() == [
        f"fig14: {HIGHER}; changed parameter: n 1 → 2",
        "claims: verdict reproduced → contradicted at claim = high; follows from: fig14",
    ]
    changed = [("is 82", "is 83")]
    assert found.following == {
        "figures/fig14.png": [],
        "figures/fig14.svg": [],
        "paper.md": changed,
        "supplement.md": changed,
    }
    assert printed(found)[2:] == [
        *("paper.md, changed sentences: 1", "  − is 82", "  + is 83"),
        *("supplement.md, changed sentences: 1", "  − is 82", "  + is 83"),
        "Not compared, because a dataset differs: figures/fig14.png, figures/fig14.svg.",
        "Differences in claims, fig14.",
    ]
    # With the configuration in git these results are stale.
    assert lines(project)[0] == (
        "fig14: stale, remove it and run again; changed since: n 2 → 1 "
        "(config/config.yaml or the Snakefile)"
    )


STALE = "stale, remove it and run again; changed since:"


@pytest.mark.parametrize(
    "file, names",
    [
        ("src/model.py", ["fig14", "claims"]),
        ("src/drawing.py", ["fig01", "fig14"]),
        ("src/writing.py", ["paper", "supplement"]),
        ("src/variables.py", []),
    ],
)
def test_a_result_of_other_code_is_stale(project, file, names):
    edit(project, file)
    assert lines(project) == [f"{name}: {STALE} {file}" for name in names]
    commit(project.top)
    if names:
        with pytest.raises(ValueError, match="nothing is accepted"):
            compare.accept(project, project.top / "results")


def test_a_picture_is_older_than_its_dataset(project):
    results = project.top / "results/figures"
    before = {path: path.read_bytes() for path in results.glob("fig14.[ps]*")}
    record = (project.top / "results/records/fig14.json").read_bytes()
    run(project, height=(1.0, 2.5))
    for path, content in before.items():
        path.write_bytes(content)
    (project.top / "results/records/fig14.json").write_bytes(record)
    assert lines(project)[1] == f"fig14: {STALE} figures/fig14.nc"


def test_a_caption_of_the_checkout_makes_texts_stale(project):
    config = {"release": "force", "stage": {"fig14": ENTRIES["fig14"] | {"caption": "New"}}}
    since = f"{STALE} fig14.caption C → New (config/config.yaml or the Snakefile)"
    assert lines(project, config=config) == [f"paper: {since}", f"supplement: {since}"]


@pytest.mark.parametrize("left", ["", "<<<<<<< HEAD\n"])
def test_a_result_without_a_record_is_stale(project, left):
    record = project.top / "results/records/fig14.json"
    record.write_text(left, "utf-8")
    assert lines(project) == [f"fig14: {STALE} it has no record"]
    with pytest.raises(ValueError, match="nothing is accepted"):
        compare.accept(project, project.top / "results")


NOTHING = "no parameter, code or version that is recorded has changed"


def changed(project):
    """The line for a changed number of results that are new."""
    run(project, height=(np.nan, 2.0))
    return lines(project)[0].partition("; ")[2]


def test_an_edited_file_is_the_cause_and_no_other(project):
    edit(project, "src/model.py", "src/drawing.py")
    assert changed(project) == "changed: src/model.py"


def test_code_that_is_accepted_or_on_the_main_branch_is_no_cause(project):
    edit(project, "src/model.py")
    commit(project.top)
    # The main branch itself is red.
    assert changed(project) == "changed since the last acceptance: src/model.py"
    git(project.top, "checkout", "-qb", "branch")
    assert changed(project) == "changed since the last acceptance: src/model.py"
    edit(project, "src/model.py")
    commit(project.top)
    assert changed(project) == "changed: src/model.py"
    run(project)
    written = compare.accept(project, project.top / "results")
    assert written == []


@pytest.mark.parametrize("left", ["nothing", "a branch master"])
def test_without_a_main_branch_the_last_acceptance_is_what_is_known(project, left):
    if left == "nothing":
        shutil.rmtree(project.top / ".git")
    else:
        git(project.top, "branch", "-m", "master")
    assert changed(project) == f"cause: {NOTHING}"
    edit(project, "src/model.py")
    assert changed(project) == (
        "changed since the last acceptance (the main branch is not known here): src/model.py"
    )


def test_the_main_branch_of_another_name_is_that_of_origin(project, tmp_path):
    git(project.top, "branch", "-m", "master")
    git(project.top, "clone", "-q", str(project.top), str(tmp_path / "copy"))
    shutil.rmtree(project.top / ".git")
    shutil.move(tmp_path / "copy/.git", project.top / ".git")
    edit(project, "src/drawing.py", "src/model.py")
    assert changed(project) == "changed: src/model.py"


def test_another_version_of_a_library_is_a_cause(project, monkeypatch):
    other = provenance.versions() | {"numpy": "9.9"}
    monkeypatch.setattr(datasets, "versions", lambda: other)
    assert changed(project) == f"other versions: numpy {np.__version__} → 9.9"


def test_a_description_names_the_file_of_descriptions(project, monkeypatch):
    other = {name: replace(each) for name, each in variables.described("fig14").items()}
    other["max_height"] = replace(other["max_height"], long_name="highest")
    edit(project, "src/variables.py")
    (line,) = lines(replace(project, describe=lambda name: other))
    assert "stale" in line and line.endswith(
        "max_height.long_name maximum height of the ball over a cycle → highest"
    )
    project = replace(project, describe=lambda name: other if name == "fig14" else {})
    path = project.top / "results/figures/fig14.nc"
    data = datasets.read(path)
    data.max_height.attrs["long_name"] = "highest"
    data.to_netcdf(path)
    note(project, "stage", ["figures/fig14.nc"], "src/model.py")
    line = lines(project)[0]
    assert line == (
        "fig14: max_height.long_name maximum height of the ball over a cycle → highest; "
        "changed: src/variables.py"
    )


@pytest.mark.parametrize(
    "change, line",
    [
        (lambda data: data.isel(frequency_ratio=[0]), "frequency_ratio.sizes {"),
        (lambda data: data.rename(max_height="phase"), "max_height is missing"),
        (lambda data: data.astype("float32"), "max_height.type float64 → float32"),
        (lambda data: data.assign(max_height=data.max_height * np.inf), "max_height 1 → inf"),
    ],
)
def test_variables_shapes_types_and_infinities_differ(project, change, line):
    path = project.top / "results/figures/fig14.nc"
    data = datasets.read(path)
    change(data).to_netcdf(path)
    assert any(line in each for each in lines(project))


def test_titles_and_captions_are_parameters(project):
    entries = {"fig14": ENTRIES["fig14"] | {"title": "Mine", "caption": "Other"}}
    run(project, text="83", entries=entries)
    found = lines(project, config={"release": "force", "stage": entries})
    assert found == ["fig14: changed parameter: title T → Mine"]
    entries = {"fig14": ENTRIES["fig14"] | {"caption": "Other"}}
    run(project, text="83", entries=entries)
    assert lines(project, config={"release": "force", "stage": entries}) == [
        f"{name}: {name}.md, line 2: is 82 → is 83; changed parameter: fig14.caption C → Other"
        for name in ("paper", "supplement")
    ]


def exchanged(one, other):
    """Exchange two files."""
    before = one.read_bytes()
    one.write_bytes(other.read_bytes())
    other.write_bytes(before)


@pytest.mark.parametrize("side", ["the results", "the reference"])
@pytest.mark.parametrize("newer", ["nothing", "on main", "on a branch", "not committed"])
def test_an_edit_by_hand_is_called_one_and_no_code_is_blamed(project, side, newer):
    """Whether code is newer than the acceptance or not."""
    if newer == "on a branch":
        git(project.top, "checkout", "-qb", "branch")
    if newer != "nothing":
        edit(project, *FILES)
        run(project)
    if newer.startswith("on"):
        commit(project.top)
    assert lines(project) == []
    folder = project.top / ("results" if side == "the results" else "")
    (folder / "paper.md").write_text("the threshold\nis 28\n", "utf-8")
    exchanged(folder / "figures/fig01.png", folder / "figures/fig14.png")
    path = folder / "figures/claims.nc"
    datasets.read(path).assign(verdict=("claim", ["near"])).to_netcdf(path)
    found = report(project).findings
    files = ["figures/claims.nc", "figures/fig01.png", "figures/fig14.png", "paper.md"]
    assert {file: each.causes for file, each in found.items()} == {
        file: {"edited by hand": [f"{file} of {side}"]} for file in files
    }
    if side == "the results":
        if newer == "not committed":
            commit(project.top)
        with pytest.raises(ValueError, match=r"claims: .*edited by hand"):
            compare.accept(project, project.top / "results")


def test_a_change_that_no_record_has_is_not_called_an_edit(project):
    run(project, text="83")
    assert lines(project) == [
        f"{name}: {name}.md, line 2: is 82 → is 83; cause: {NOTHING}"
        for name in ("paper", "supplement")
    ]


def test_an_innocent_change_on_a_branch_is_neither_blamed_nor_called_an_edit(project):
    git(project.top, "checkout", "-qb", "branch")
    edit(project, "src/drawing.py", "src/model.py")
    commit(project.top)
    edit(project, "src/writing.py")
    run(project, text="83")
    assert lines(project) == [
        f"{name}: {name}.md, line 2: is 82 → is 83; changed: src/writing.py"
        for name in ("paper", "supplement")
    ]


def test_a_reference_whose_files_are_not_recorded_is_compared(project):
    """Of a record that an earlier version wrote."""
    path = project.top / compare.ACCEPTED
    accepted = json.loads(path.read_text("utf-8"))
    kept = {key: accepted[key] for key in ("code", "versions")}
    path.write_text(json.dumps(kept), "utf-8")
    assert lines(project) == []
    run(project, text="83")
    assert lines(project)[0].endswith(f"cause: {NOTHING}")
    path.write_text("<<<<<<< HEAD\n", "utf-8")
    assert lines(project)[0].endswith("cause: not known without a record")


def test_the_verdict_of_a_red_run_is_in_its_log(project, capsys):
    results = project.top / "results"
    run(project, text="83")
    assert compare.report_of_run(project, results, CONFIG, []) == 1
    assert "Differences in paper, supplement." in capsys.readouterr().err
    run(project)
    assert compare.report_of_run(project, results, CONFIG, []) == 0
    assert "All 8 files agree" in capsys.readouterr().out


def test_a_picture_of_the_same_data_names_the_code_that_changed(project):
    """The model gave the same dataset again, and is innocent."""
    edit(project, "src/drawing.py", "src/model.py")
    project = replace(project, make=partial(make, form="height {:.3g}"))
    run(project)
    assert lines(project) == ["fig14: the picture differs; changed: src/drawing.py"]


def redrawn(path):
    """Save a picture again, upside down and without the name of its matplotlib."""
    with Image.open(path) as picture:
        picture.transpose(Image.Transpose.FLIP_TOP_BOTTOM).save(path)


def test_a_picture_that_names_no_matplotlib_is_compared_and_so_is_its_svg(project):
    results = project.top / "results/figures"
    redrawn(results / "fig14.png")
    svg = results / "fig01.svg"
    svg.write_text(svg.read_text("utf-8").replace("</svg>", "<g/></svg>"), "utf-8")
    found = report(project)
    assert found.drawn_elsewhere == []
    assert found.lines() == [
        f"{name}: the picture differs; edited by hand: figures/{name}.{kind} of the results"
        for name, kind in (("fig01", "svg"), ("fig14", "png"))
    ]


@pytest.mark.parametrize("side", ["results", "reference"])
@pytest.mark.parametrize("file", ["figures/fig14.png", "figures/fig14.svg", "figures/fig14.nc"])
@pytest.mark.parametrize("content", ["", "version https://git-lfs.github.com/spec/v1\n"])
def test_a_file_that_cannot_be_read_is_named_and_not_accepted(project, side, file, content):
    folder = project.top / ("results" if side == "results" else "")
    (folder / file).write_text(content, "utf-8")
    results = project.top / "results"
    (results / "paper.md").write_text("the threshold\nis 83\n", "utf-8")
    found = lines(project)
    assert found[0].startswith(f"fig14: {file}") and "cannot be compared" in found[0]
    # Without its dataset nothing is said of a text.
    assert file.endswith(".nc") or "paper.md, line 2: is 82 → is 83" in found[1]
    with pytest.raises(ValueError, match="cannot be compared"):
        compare.accept(project, results)


@pytest.mark.parametrize(
    "text, line",
    [
        ("the threshold\nis 82\n\n", "line 4: the end of the text → an empty line"),
        ("the threshold\nis 82", "line 3: an empty line → the end of the text"),
        ("\nthe threshold\nis 82\n", "line 1: the threshold → an empty line"),
        ("the threshold\ris 82\n", r"line 1: the threshold → the threshold\ris 82"),
        ("the threshold\nis\N{NO-BREAK SPACE}82\n", r"line 2: is 82 → is\xa082"),
        (
            "\N{BYTE ORDER MARK}the threshold\nis 82\n",
            r"line 1: the threshold → \ufeffthe threshold",
        ),
        ("", "line 1: the threshold → an empty line"),
    ],
)
def test_ends_of_lines_and_of_texts_are_compared(project, text, line):
    (project.top / "results/paper.md").write_bytes(text.encode())
    (found,) = lines(project)
    assert found.startswith(f"paper: paper.md, {line}; ")


def test_a_text_that_is_not_utf_8_cannot_be_compared(project):
    (project.top / "results/paper.md").write_bytes("das Mädchen".encode("latin-1"))
    assert lines(project)[0].startswith("paper: paper.md cannot be compared: in the results Uni")


def test_pictures_of_another_matplotlib_are_counted_and_not_compared(project, monkeypatch):
    other = provenance.versions() | {"matplotlib": "9.9"}
    monkeypatch.setattr(datasets, "versions", lambda: other)
    run(replace(project, make=partial(make, form="height {:.3g}")))
    agree = "All 8 files agree with the reference."
    assert printed(report(project)) == [
        f"{agree} 2 pictures of another matplotlib were not compared."
    ]
    redrawn(project.top / "results/figures/fig14.png")
    assert lines(project) == [
        "fig14: the picture differs; edited by hand: figures/fig14.png of the results"
    ]


def test_pictures_of_rounded_numbers_must_be_those_that_the_code_draws(project):
    digits = partial(make, form="{!r}")
    other = replace(project, make=digits)
    run(other)
    compare.accept(other, project.top / "results")
    commit(project.top)
    run(other, height=(1.0, 2.0 + 1e-12))
    assert lines(other) == []
    # Two runs are compared without today's code.
    reference = compare.run_in(project.top, "one")
    results = compare.run_in(project.top / "results", "other")
    assert compare.compare(project, reference, results).findings == {}
    edit(project, "src/drawing.py")
    run(replace(other, make=partial(make, form="{:.1f}")))
    assert lines(other) == []
    assert lines(replace(other, make=partial(make, form="{:.1f}")))[0] == (
        "fig14: the picture differs; changed: src/drawing.py"
    )


def test_missing_new_and_damaged_files_are_named(project):
    folder = project.top / "results/figures"
    shutil.copyfile(folder / "fig14.nc", folder / "fig17.nc")
    (folder / "fig14.png").unlink()
    (folder / "claims.nc").write_text("damaged", "utf-8")
    found = lines(project)
    assert found[0] == "fig17: figures/fig17.nc is missing in the reference"
    assert found[1].startswith("claims: figures/claims.nc cannot be compared: in the results")
    assert found[2] == "fig14: figures/fig14.png is missing in the results"
    assert len(lines(project, names=["fig14"])) == 1
    assert lines(project, names=["fig17"]) == found[:1]


def test_the_page_shows_both_pictures_and_replaces_an_earlier_one(project, capsys):
    run(project, height=(1.0, 2.5))
    results = project.top / "results"
    assert compare.report_of_run(project, results, CONFIG, []) == 1
    page = results / "diff/index.html"
    text = page.read_text("utf-8")
    assert "max_height 2 → 2.5" in text
    shown = [
        text.index(base64.b64encode((side / "figures/fig14.png").read_bytes()).decode())
        for side in (project.top, results)
    ]
    assert shown == sorted(shown)
    printed = capsys.readouterr().err
    assert (results / "diff/report.txt").read_text("utf-8") == printed
    assert printed.splitlines()[-2:] == ["Differences in fig14.", str(page)]
    run(project)
    assert compare.report_of_run(project, results, CONFIG, []) == 0
    assert "fig14" not in page.read_text("utf-8")


def test_the_command_prints_the_report_the_page_and_its_status(project, capsys, tmp_path):
    results = str(project.top / "results")
    run(project, text="83")
    assert compare.main(project, [results]) == 1
    printed = capsys.readouterr().out.splitlines()
    assert printed[-2:] == ["Differences in paper, supplement.", f"{results}/diff/index.html"]
    run(project)
    assert compare.main(project, [results]) == 0
    for arguments, status, line in (
        ([], 2, "compare.py: error: "),
        ([str(tmp_path / "nothing")], 2, "compare.py: error: a run cannot be read: there is noth"),
        ([__file__], 2, "compare.py: error: a run cannot be read: "),
        (["--help"], 0, "usage: compare.py "),
    ):
        capsys.readouterr()
        with pytest.raises(SystemExit) as ended:
            compare.main(project, arguments)
        assert ended.value.code == status
        assert "\n" + line in "\n" + "".join(capsys.readouterr())


def two_runs(project, tmp_path):
    """Two runs with different parameters, and their folders."""
    folders = []
    for n, height, text in ((1, 2.0, "82"), (2, 2.5, "83")):
        entries = {"fig14": ENTRIES["fig14"] | {"n": n}}
        run(project, height=(1.0, height), text=text, entries=entries, n=n)
        folders.append(tmp_path / f"run{n}" / "results")
        shutil.copytree(project.top / "results", folders[-1])
    return folders


@pytest.mark.parametrize("kind", ["folder", "folder of the run", "zip", "zip of several folders"])
def test_two_runs_are_compared_by_their_records(project, tmp_path, capsys, kind):
    one, other = two_runs(project, tmp_path)
    page = other / "diff/index.html"
    # Today's code and configuration do not matter.
    edit(project, *FILES)
    if kind == "folder of the run":
        one, other = one.parent, other.parent
        page = other / "diff/index.html"
        # A checkout has the reference beside the results.
        shutil.copytree(project.top / "figures", one / "figures")
    if kind.startswith("zip"):
        base = other.parent if "several" in kind else other
        other = shutil.make_archive(str(tmp_path / "artifact"), "zip", base)
        page = tmp_path / "diff/index.html"
    assert compare.main(project, [str(one), str(other)]) == 1
    assert capsys.readouterr().out.splitlines() == [
        f"fig14: {HIGHER}; changed parameter: n 1 → 2",
        *("paper.md, changed sentences: 1", "  − is 82", "  + is 83"),
        *("supplement.md, changed sentences: 1", "  − is 82", "  + is 83"),
        "Not compared, because a dataset differs: figures/fig14.png, figures/fig14.svg.",
        "Differences in fig14.",
        str(page),
    ]
    text = page.read_text("utf-8")
    assert "changed parameter: n 1 → 2" in text and text.count("data:image/png") == 2
    assert compare.main(project, [str(one), str(one)]) == 0


def test_a_text_with_another_title_has_no_sentences(project):
    run(project, height=(1.0, 2.5), text="83")
    path = project.top / "results/paper.md"
    path.write_text("another run\nis 83\n", "utf-8")
    note(project, "article", project.texts, "src/writing.py", ["fig14"], entries=ENTRIES)
    assert report(project).following["paper.md"] == []
    assert report(project).following["supplement.md"] == [("is 82", "is 83")]


def test_two_runs_of_other_code_and_versions(project, tmp_path, monkeypatch):
    one = two_runs(project, tmp_path)[0]
    other = provenance.versions() | {"numpy": "9.9"}
    monkeypatch.setattr(datasets, "versions", lambda: other)
    edit(project, "src/model.py")
    run(project, height=(1.0, 2.5))
    runs = [compare.run_in(folder, "a run") for folder in (one, project.top / "results")]
    causes = {"changed": ["src/model.py"], "other versions": [f"numpy {np.__version__} → 9.9"]}
    (found,) = compare.compare(project, *runs).findings.values()
    assert found.causes == causes
    shutil.rmtree(one / "records")
    runs[0] = compare.run_in(one, "a run")
    # A dataset has its own provenance, and a text has none without a record.
    (found,) = compare.compare(project, *runs).findings.values()
    assert found.causes == causes
    run(project, text="83")
    runs[1] = compare.run_in(project.top / "results", "another run")
    found = compare.compare(project, *runs).findings
    assert {file: each.causes for file, each in found.items()} == {
        text: {"cause": ["not known without a record"]} for text in project.texts
    }


def test_what_differs_is_accepted_and_what_agrees_stays(project):
    before = (project.top / "figures/fig14.nc").read_bytes()
    edit(project, "src/model.py")
    commit(project.top)
    run(project, height=(1.0, 2.0 + 1e-12), text="83")
    assert compare.accept(project, project.top / "results") == ["paper.md", "supplement.md"]
    assert (project.top / "figures/fig14.nc").read_bytes() == before
    run(project, height=(1.0, 2.5))
    written = compare.accept(project, project.top / "results")
    assert written[:3] == ["figures/fig14.nc", "figures/fig14.png", "figures/fig14.svg"]
    assert lines(project) == []


def test_a_figure_that_is_not_made_any_more_leaves_the_reference(project):
    for kind in ("png", "svg"):
        (project.top / f"results/figures/fig01.{kind}").unlink()
    assert len(compare.accept(project, project.top / "results")) == 2
    assert not (project.top / "figures/fig01.png").exists()


@pytest.mark.parametrize("wrong", ["stale", "damaged", "not committed", "without git"])
def test_nothing_is_accepted_that_cannot_be_made_again(project, wrong):
    before = {path.name: path.read_bytes() for path in (project.top / "figures").iterdir()}
    if wrong in ("stale", "not committed"):
        edit(project, "src/model.py")
    if wrong == "stale":
        commit(project.top)
    if wrong == "damaged":
        (project.top / "results/figures/fig14.nc").write_text("damaged", "utf-8")
    if wrong == "without git":
        shutil.rmtree(project.top / ".git")
    with pytest.raises(ValueError, match="nothing is accepted"):
        compare.accept(project, project.top / "results")
    after = {path.name: path.read_bytes() for path in (project.top / "figures").iterdir()}
    assert after == before

"""What the comparison says of a change, and what becomes the reference.

The project of these tests has one figure, one table of claims and two texts, and a history in git.
"""

import base64
import json
import shutil
import subprocess
from contextlib import suppress
from dataclasses import replace
from functools import cache, partial
from importlib import metadata
from io import BytesIO
from itertools import chain, product
from pathlib import Path
from types import SimpleNamespace

import matplotlib
import numpy as np
import pytest
import xarray as xr
from matplotlib.figure import Figure
from PIL import Image, ImageColor
from tests.checkout import ROOT, without_variables_of_git
from tests.jobs import Named

from carbonelli2011 import variables
from paper_replication import acceptance, compare, datasets, differences, provenance, runs
from paper_replication.drawing import save_picture

pytestmark = pytest.mark.usefixtures("git_of_its_own", "versions_that_are_read_once")

HIGHER = "max_height 2 → 2.5 at frequency_ratio = 2 (tolerance 1e-09)"
ENTRIES = {"fig14": {"title": "T", "caption": "C", "n": 1}}
CONFIG = {"release": "force", "stage": ENTRIES}
MADE = (
    *("figures/claims.nc", "figures/fig14.nc"),
    *("figures/fig01.png", "figures/fig01.svg", "figures/fig14.png", "figures/fig14.svg"),
    *("paper.md", "supplement.md"),
)
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
    record = str(results / f"records/{rule}.json")
    output = Named(record=record, **{file: str(results / file) for file in files})
    paths = [str(results / f"figures/{name}.nc") for name in data]
    job = SimpleNamespace(output=output, params=SimpleNamespace(**parameters))
    datasets.save_record(job, read_by(project, code, paths), project)


def read_by(project, code, data=()):
    """What a job reads."""
    return provenance.sources(SimpleNamespace(code=[str(project.top / code)], data=data))


def make(name, data, folder, form="{:.3g}"):
    """Pictures that show numbers to three digits, or a schematic without data."""
    figure = Figure(figsize=(1, 1))
    numbers = [] if data is None else data.max_height.values
    figure.text(0, 0.5, " ".join(form.format(number) for number in numbers))
    save_picture(figure, folder / f"{name}.png", folder / f"{name}.svg", "a salt")


def png(values):
    """A picture of these grey levels."""
    with BytesIO() as file:
        Image.fromarray(np.array(values, np.uint8)).save(file, "PNG")
        return file.getvalue()


def side_by_side(name, several):
    """Pictures that are as dark as the heights of all datasets are large."""
    return [png([255 - 100 * data.max_height.values]) for data in several]


def project_in(top):
    return datasets.Project(
        top=top,
        checkout=top,
        code=("src", "config"),
        texts=("paper.md", "supplement.md"),
        references="",
        source="",
        license="",
        describe=variables.described,
        described_in=("src/variables.py",),
        side_by_side=side_by_side,
        make=make,
    )


@pytest.fixture(scope="module")
def versions_that_are_read_once():
    """Parsing what each package says of itself takes as long as all else that is done here."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(metadata, "version", cache(metadata.version))
        yield


@pytest.fixture(scope="module")
def accepted(git_of_its_own, versions_that_are_read_once, tmp_path_factory):
    """A checkout whose reference is accepted and committed, with results that agree."""
    top = tmp_path_factory.mktemp("accepted") / "checkout"
    for file in FILES:
        (top / file).parent.mkdir(parents=True, exist_ok=True)
        (top / file).write_text(f"{json.dumps(CONFIG)}\n", "utf-8")
    project = project_in(top)
    run(project)
    git(top, "init", "-qb", "main")
    shutil.copy(ROOT / ".gitignore", top)
    commit(top)
    assert len(accept(project)) == 8
    commit(top)
    return top


@pytest.fixture
def project(accepted, tmp_path):
    """A copy for one test."""
    top = shutil.copytree(accepted, tmp_path / "checkout")
    return project_in(top)


def git(top, *arguments):
    # Newer versions of git tidy up in the background, while a test copies the folder.
    settings = ["user.name=A", "user.email=a@b.c", "maintenance.auto=false"]
    options = chain.from_iterable(("-c", setting) for setting in settings)
    subprocess.run(["git", "-C", str(top), *options, *arguments], check=True)


def commit(top):
    git(top, "add", ".")
    git(top, "commit", "-qm", "a commit", "--allow-empty")


def edit(project, *files):
    for file in files:
        with (project.top / file).open("a", encoding="utf-8") as opened:
            opened.write("\n")


def run(
    project, height=(1.0, 2.0), verdict="reproduced", text="82", reason="", entries=ENTRIES, **given
):
    """Make results with these numbers, as the code of today would."""
    folder = project.top / "results"
    shutil.rmtree(folder, ignore_errors=True)
    data = xr.Dataset(
        {"max_height": ("frequency_ratio", list(height))}, {"frequency_ratio": [1.0, 2.0]}
    )
    decided = {"verdict": ("claim", [verdict]), "reason": ("claim", [reason])}
    judged = xr.Dataset(decided, {"claim": ["high"]})
    sources = read_by(project, "src/model.py")
    given = {"n": 1, "release": "force"} | given
    title = entries["fig14"]["title"]
    datasets.save(data, folder / "figures/fig14.nc", title, given, sources, project)
    datasets.save(judged, folder / "figures/claims.nc", "Claims", {}, sources, project)
    project.make("fig14", data, folder / "figures")
    project.make("fig01", None, folder / "figures")
    # The page is no part of the reference.
    for name in (*project.texts, "index.html"):
        (folder / name).write_text(f"the threshold\nis {text}\n", "utf-8")
    note(project, "stage", ["figures/fig14.nc"], "src/model.py", entries=entries)
    note(project, "claims", ["figures/claims.nc"], "src/model.py", ["fig14"])
    for name, needs in (("fig01", []), ("fig14", ["fig14"])):
        files = [f"figures/{name}.{kind}" for kind in ("png", "svg")]
        note(project, name, files, "src/drawing.py", needs)
    note(
        project,
        "article",
        [*project.texts, "index.html"],
        "src/writing.py",
        ["fig14", "claims"],
        entries=entries,
    )


def report(project, names=(), config=CONFIG, made=MADE):
    reference = runs.run_in(project.top, "the reference")
    results = runs.run_in(project.top / "results", "the results")
    main = provenance.main_branch(project.checkout)
    checkout = runs.Checkout(project, main, config, made)
    return compare.compare(project, reference, results, checkout, names)


def accept(project, made=MADE):
    """Accept the results; the rules make a page, too, which is no part of the reference."""
    results = project.top / "results"
    return acceptance.accept(project, results, [results / file for file in (*made, "index.html")])


def printed(comparison):
    return comparison.printed("diff.txt.j2").splitlines()


def lines(project, **given):
    return report(project, **given).lines()


def test_a_hook_that_runs_these_tests_leaves_the_commit_of_its_user_as_it_is(tmp_path, monkeypatch):
    """Git exports GIT_INDEX_FILE to its hooks, and in a linked worktree also GIT_DIR."""
    first = tmp_path / "of a user"
    first.mkdir()
    git(first, "init", "-qb", "main")
    for name in ("first", "second"):
        (first / name).write_text("a line\n", "utf-8")
    commit(first)
    exported = tmp_path / "exported"
    hook = first / ".git/hooks/pre-commit"
    hook.write_text(f"#!/bin/sh\nenv > '{exported}'\n", "utf-8")
    hook.chmod(0o755)
    top = tmp_path / "linked"
    git(first, "worktree", "add", "-qb", "branch", str(top))
    (top / "first").write_text("another line\n", "utf-8")
    git(top, "commit", "-qam", "another commit")
    lines = exported.read_text("utf-8").splitlines()
    exported = dict(line.split("=", 1) for line in lines if line.startswith("GIT_"))
    assert {"GIT_DIR", "GIT_INDEX_FILE"} <= exported.keys()
    for name, value in exported.items():
        monkeypatch.setenv(name, value)
    with without_variables_of_git():
        (tmp_path / "of a test").mkdir()
        git(tmp_path / "of a test", "init", "-qb", "main")
        commit(tmp_path / "of a test")
        told = ["git", "-C", str(top), "log", "--name-only", "--format=%s", "-2"]
        answer = subprocess.run(told, check=True, capture_output=True, text=True).stdout
    listed = ["another commit", "", "first", "a commit", "", "first", "second", ""]
    assert answer.split("\n") == listed


def test_equal_results_agree_and_so_do_results_within_the_tolerance(project):
    assert printed(report(project)) == ["All 8 files agree with the reference."]
    run(project, height=(1.0, 2.0 + 1e-9))
    assert lines(project) == []


def test_a_page_that_the_reference_does_not_have_is_as_its_record_says(project):
    page = project.top / "results/index.html"
    page.write_text("the threshold is 83\n", "utf-8")
    assert lines(project) == ["index: edited by hand: index.html of the results"]
    with pytest.raises(ValueError, match="edited by hand"):
        accept(project)
    page.unlink()
    assert lines(project) == ["missing in the results: index.html"]
    assert report(project).status == 1
    # A figure was asked for.
    assert lines(project, names=["fig14"]) == []


def test_a_changed_parameter_is_named_with_what_follows_from_it(project):
    entries = {"fig14": ENTRIES["fig14"] | {"n": 2}}
    run(project, height=(1.0, 2.5), verdict="contradicted", text="83", entries=entries, n=2)
    config = {"release": "force", "stage": entries}
    comparison = report(project, config=config)
    assert comparison.lines() == [
        f"fig14: {HIGHER}; changed parameter: n 1 → 2",
        "claims: verdict reproduced → contradicted at claim = high; follows from: fig14",
    ]
    changed = [("is 82", "is 83")]
    following = comparison.those("follows").items()
    assert {file: finding.sentences for file, finding in following} == {
        "figures/fig14.png": [],
        "figures/fig14.svg": [],
        "paper.md": changed,
        "supplement.md": changed,
    }
    assert printed(comparison)[2:] == [
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


def test_a_picture_is_older_than_its_dataset(project):
    files = project.top.glob("results/*/fig14.[psj]*")
    before = {path: path.read_bytes() for path in files}
    run(project, height=(1.0, 2.5))
    for path, content in before.items():
        path.write_bytes(content)
    assert lines(project)[1] == f"fig14: {STALE} figures/fig14.nc"


SAME = "made by: the same parameters, code and versions"


def changed(project):
    """The line for a changed number of results that are new."""
    run(project, height=(np.nan, 2.0))
    return lines(project)[0].partition("; ")[2]


def test_code_that_differs_from_the_acceptance_is_listed_and_marked_if_main_has_it(project):
    assert changed(project) == SAME
    edit(project, "src/model.py")
    assert changed(project) == "changed code: src/model.py"
    commit(project.top)
    assert changed(project) == "changed code: src/model.py (also on main)"
    git(project.top, "checkout", "-qb", "branch")
    edit(project, "src/model.py")
    commit(project.top)
    assert changed(project) == "changed code: src/model.py"
    # Main goes on, and has this content too.
    git(project.top, "branch", "-f", "main")
    assert changed(project) == "changed code: src/model.py (also on main)"
    run(project)
    assert accept(project) == ["figures/fig14.nc", "figures/claims.nc"]
    assert changed(project) == SAME


def test_the_main_branch_may_be_that_of_origin_and_code_is_listed_without_it(project):
    edit(project, "src/model.py")
    commit(project.top)
    git(project.top, "branch", "-m", "master")
    assert changed(project) == "changed code: src/model.py"
    git(project.top, "update-ref", "refs/remotes/origin/main", "master")
    assert changed(project) == "changed code: src/model.py (also on main)"
    shutil.rmtree(project.top / ".git")
    # Records have other hashes than this repository.
    git(project.top, "init", "-qb", "main", "--object-format=sha256")
    commit(project.top)
    assert changed(project) == "changed code: src/model.py"
    accept(project)
    assert lines(project) == []


def test_a_description_names_the_file_of_descriptions(project, monkeypatch):
    other = {name: replace(variable) for name, variable in variables.described("fig14").items()}
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
    described = "fig14: max_height.long_name maximum height of the ball over a cycle → highest"
    assert lines(project)[0] == f"{described}; changed code: src/variables.py"


@pytest.mark.parametrize(
    "change, line",
    [
        (lambda data: data.isel(frequency_ratio=[0]), "frequency_ratio 2 is missing"),
        (lambda data: data.rename(max_height="phase"), "max_height is missing"),
        (lambda data: data.astype("float32"), "max_height.type float64 → float32"),
        (lambda data: data.assign(max_height=data.max_height * np.inf), "max_height 1 → inf"),
    ],
)
def test_variables_shapes_types_and_infinities_differ(project, change, line):
    path = project.top / "results/figures/fig14.nc"
    data = datasets.read(path)
    change(data).to_netcdf(path)
    assert any(line in " ".join(difference.split()) for difference in lines(project))


def test_titles_and_captions_are_parameters(project):
    entries = {"fig14": ENTRIES["fig14"] | {"caption": "New"}}
    config = {"release": "force", "stage": entries}
    since = f"{STALE} fig14.caption C → New (config/config.yaml or the Snakefile)"
    assert lines(project, config=config) == [f"paper: {since}", f"supplement: {since}"]
    run(project, text="83", entries=entries)
    assert lines(project, config=config) == [
        f"{name}: {name}.md, line 2: is 82 → is 83; changed parameter: fig14.caption C → New"
        for name in ("paper", "supplement")
    ]
    entries["fig14"] |= {"title": "Mine"}
    run(project, text="83", entries=entries)
    assert lines(project, config=config) == ["fig14: changed parameter: title T → Mine"]


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
    (difference,) = lines(project)
    assert difference.startswith(f"paper: paper.md, {line}; ")


def test_pictures_of_another_matplotlib_are_counted_if_the_same_code_drew_them(
    project, monkeypatch, tmp_path
):
    first = runs.run_in(shutil.copytree(project.top / "results", tmp_path / "first"), "first")
    other = provenance.versions() | {"matplotlib": "9.9"}
    monkeypatch.setattr(provenance, "versions", lambda: other)
    monkeypatch.setattr(compare, "versions", lambda: other)
    drawn = replace(project, make=partial(make, form="height {:.3g}"))
    run(drawn)
    agree = "6 of 8 files agree with the reference."
    assert printed(report(project)) == [
        f"{agree} 2 pictures of another matplotlib were not compared."
    ]
    assert report(project).status == 0
    # So they are between two runs.
    second = runs.run_in(project.top / "results", "second")
    comparison = compare.compare(project, first, second)
    assert (comparison.status, comparison.those("drawn elsewhere").keys()) == (
        0,
        {"figures/fig14.png", "figures/fig14.svg"},
    )
    edit(project, "src/drawing.py")
    run(drawn)
    cause = f"other versions: matplotlib {matplotlib.__version__} → 9.9"
    assert lines(project) == [f"fig14: the picture differs; changed code: src/drawing.py; {cause}"]
    # The main branch has this code, and was accepted with the other matplotlib.
    commit(project.top)
    assert report(project).status == 0
    assert accept(project) == [f"figures/fig14.{kind}" for kind in ("nc", "png", "svg")]


def test_one_figure_is_compared_and_a_missing_one_is_named(project):
    for folder in (project.top, project.top / "results"):
        (folder / "figures/fig14.png").unlink()
    (project.top / "results/paper.md").write_bytes(b"\xff")
    missing = "figures/fig14.png in the reference, figures/fig14.png in the results"
    assert lines(project, names=["fig14"]) == [f"fig14: missing: {missing}"]
    # What is missing comes last.
    assert lines(project)[0].startswith("paper: cannot be compared: paper.md in the results: ")
    # Rules make two pictures that nobody made.
    pictures = ("figures/fig18.png", "figures/fig18.svg")
    comparison = report(project, names=["fig18"], made=pictures)
    assert ([*comparison.findings], comparison.status) == ([*pictures], 2)


@pytest.mark.parametrize("drawn", [True, False])
def test_the_page_shows_both_pictures(project, capsys, drawn):
    """Datasets that differ are drawn with the same axes, unless this fails."""
    run(project, height=(1.0, 2.5))
    results = project.top / "results"
    sides = (project.top / "figures/fig14.nc", results / "figures/fig14.nc")
    pictures = [path.with_suffix(".png").read_bytes() for path in sides]
    if drawn:
        pictures = side_by_side("fig14", [datasets.read(path) for path in sides])
        (both,) = compare.over_each_other(pictures)
        pictures.insert(0, both)
    else:
        project = replace(project, side_by_side=None)
    job = SimpleNamespace(
        input=[results / file for file in MADE], params=SimpleNamespace(config=CONFIG, names=[])
    )
    assert compare.report_of_run(project, results, job) == 1
    page = results / "diff/index.html"
    text = page.read_text("utf-8")
    assert "max_height<" in text and "<td>2 → 2.5</td><td>frequency_ratio = 2</td>" in text
    # The way back.
    target = text.partition('href="')[2].partition('"')[0]
    assert (page.parent / target).resolve() == results / "index.html"
    shown = [text.index(base64.b64encode(picture).decode()) for picture in pictures]
    assert shown == sorted(shown) and text.count("data:image/png") == len(pictures) + (not drawn)
    printed = capsys.readouterr().err
    assert (results / "diff/report.txt").read_text("utf-8") == printed.removesuffix(f"{page}\n")
    assert printed.splitlines()[-2:] == ["Differences in fig14.", str(page)]


def test_the_command_prints_a_mistake_and_its_status(project, capsys, tmp_path):
    assert compare.main(project, [str(project.top)]) == 0
    for arguments, status, line in (
        ([], 2, "compare.py: error: "),
        ([str(tmp_path / "nothing")], 2, "compare.py: error: a run cannot be read: /"),
        ([__file__], 2, "compare.py: error: a run cannot be read: "),
        (["--help"], 0, "usage: compare.py "),
    ):
        capsys.readouterr()
        with pytest.raises(SystemExit) as ended:
            compare.main(project, arguments)
        assert ended.value.code == status
        assert "\n" + line in "\n" + "".join(capsys.readouterr())


def test_a_mistake_in_yaml_names_its_file_and_a_full_disk_its_folder(project, capsys):
    def full(*_):
        raise OSError(28, "No space left on device")

    data = project.top / "results/figures/fig14.nc"
    with pytest.raises(OSError, match=r"TMPDIR names another folder: .* No space left on device"):
        compare.remade(full, "fig14", data, "")
    (project.top / "config/config.yaml").write_text("caption: a: b", "utf-8")
    with pytest.raises(SystemExit):
        compare.main(project, [str(project.top)])
    assert 'config/config.yaml", line 1' in capsys.readouterr().err


def test_a_new_label_is_named_and_the_values_of_the_others_are_compared():
    about = {"tolerance": 1e-9, "floor": 1e-3}
    old, new = (
        xr.Dataset({"height": ("claim", values, about)}, {"claim": names})
        for names, values in ((["high"], [1.0]), (["high", "low"], [2.0, 3.0]))
    )
    expected = ["claim low is new", "height 1 → 2 at claim = high (tolerance 1e-09)"]
    assert [*map(str, differences.differences("claims.nc", old, new))] == expected


def test_a_table_has_a_row_for_each_variable_and_the_rest_is_named():
    """Of a variable that is undefined in one run, the largest change of its numbers is told."""
    about = {"tolerance": 1e-9, "floor": 1e-3, "long_name": "a height"}
    numbers = [[1.0, 2.0, np.nan, 4.0], [1.0, 2.5, 3.0, 4.1]]
    old, new = (
        xr.Dataset({f"h{n:02}": ("x", values, about) for n in range(12)}, {"x": [1, 2, 4, 8]})
        for values in numbers
    )
    finding = compare.Finding("differs", differences.differences("a.nc", old, new))
    first, *rows = finding.lines("a")
    assert first == "a: 12 differences"
    assert rows[:-1] == [f"  h{n:02}  3 of 4  2 → 2.5 at x = 2" for n in range(10)]
    assert rows[-1] == "  and h10, h11"


def test_the_largest_change_of_whole_numbers_and_undefined_ones():
    old, new = (xr.Dataset({"k": ("x", values)}) for values in ([1, 2, 3], [2, 9, 3]))
    assert [*map(str, differences.differences("a.nc", old, new))] == [
        "k 2 → 9 at x = 1, and 1 more of 3 values"
    ]
    about = {"tolerance": 1e-9, "floor": 1e-3}
    old, new = (xr.Dataset({"k": ("x", [1.0, x], about)}) for x in (np.nan, 2.0))
    assert [*map(str, differences.differences("a.nc", old, new))] == [
        "k nan → 2 at x = 1 (tolerance 1e-09)"
    ]


def test_two_pictures_over_each_other_show_what_only_one_draws():
    """White paper, what both draw, and what is fainter, missing or of another colour in one."""
    both = compare.over_each_other([png([[255, 0, 0, 255, 0]]), png([[255, 0, 255, 0, 3]])])
    paper, grey, *only, faint = np.asarray(Image.open(BytesIO(*both)))[0].tolist()
    assert (paper, len({*grey})) == ([255] * 3, 1)
    assert only == [[*ImageColor.getrgb(colour)] for colour in compare.ONLY]
    assert faint != grey
    red, blue = (png([[[255 * (n == k) for n in range(3)]]]) for k in (0, 2))
    (mixed,) = compare.over_each_other([red, blue])
    assert len({*Image.open(BytesIO(mixed)).getpixel((0, 0))}) > 1
    for others in ([red], [red, png([[0, 0]])], [red, b""]):
        assert compare.over_each_other(others) == []


def test_of_several_workflows_in_a_zip_each_takes_its_own_results(project, tmp_path):
    for folder in ("results/figures", "extras/other/results/figures"):
        (tmp_path / "all" / folder).mkdir(parents=True)
    file = shutil.make_archive(str(tmp_path / "everything"), "zip", tmp_path / "all")
    other = replace(project, top=project.top / "extras/other")
    for workflow, folder in ((project, "results"), (other, "extras/other/results")):
        unpacked = tmp_path / folder.replace("/", "-")
        assert runs.results_of(workflow, Path(file), unpacked) == unpacked / folder


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
        # A checkout has the reference beside the results.
        shutil.copytree(project.top / "figures", one / "figures")
    if kind.startswith("zip"):
        base = other.parent if "several" in kind else other
        other = shutil.make_archive(str(tmp_path / "artifact"), "zip", base)
        page = tmp_path / "artifact.diff/index.html"
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
    assert "changed parameter: n 1 → 2" in text and text.count("data:image/png") == 3
    # One run elsewhere has parameters of its own, and must be what today's code makes.
    if kind == "folder":
        for file in FILES:
            (project.top / file).write_text(f"{json.dumps(CONFIG)}\n", "utf-8")
        assert compare.main(project, [str(other)]) == 1
        assert f"fig14: {HIGHER}; changed parameter: n 1 → 2" in capsys.readouterr().out


def test_names_select_what_is_compared_and_what_a_run_lacks_is_one_line(project, tmp_path, capsys):
    one, other = map(str, two_runs(project, tmp_path))
    for path in Path(other).glob("figures/*"):
        if path.suffix != ".nc":
            path.unlink()
    shutil.rmtree(Path(other) / "diff", ignore_errors=True)
    (Path(other) / "paper.md").unlink()
    fig14 = f"fig14: {HIGHER}; changed parameter: n 1 → 2"
    lacks = f"missing in {other}: "
    differ = "Differences in fig14."

    def told(*arguments):
        status = compare.main(project, [*arguments])
        return status, capsys.readouterr().out.splitlines()[:-1]

    status, printed = told(one, other)
    assert (status, printed[:2]) == (1, [fig14, f"{lacks}5 files of fig01, fig14, paper"])
    assert printed[-1] == f"{differ} 5 files are missing."
    pictures = "figures/fig14.png, figures/fig14.svg"
    assert told(one, other, "fig14") == (
        1,
        [fig14, f"{lacks}{pictures}", f"{differ} 2 files are missing."],
    )
    assert told(one, other, "claims") == (0, ["All 1 files agree with " + one + "."])
    assert told(one, other, "paper") == (1, [f"{lacks}paper.md", "1 file is missing."])
    # One run, with names, is compared with the reference.
    assert told(str(project.top), "claims")[0] == 0
    for names in ([one, other, "fig99"], [one, "fig99"]):
        with pytest.raises(SystemExit) as ended:
            told(*names)
        assert (
            ended.value.code == 2 and "fig99: neither a run nor a name" in capsys.readouterr().err
        )


@pytest.mark.parametrize("left", ["[]", "null", '{"made": null}', "[" * 100_000, "<<<<<<< HEAD"])
def test_a_damaged_record_is_named_and_that_of_the_reference_is_mended(project, left):
    results = project.top / "results"
    record = results / "records/fig14.json"
    before = record.read_text("utf-8")
    record.write_text(left, "utf-8")
    why = "has the marks of a conflict" if left.startswith("<") else "cannot be read"
    assert f"fig14.png in the results, records/fig14.json {why}" in lines(project)[0]
    record.write_text(before, "utf-8")
    (project.top / runs.ACCEPTED).write_text(left, "utf-8")
    assert f"in the reference, figures/accepted.json {why}" in lines(project)[0]
    accept(project)
    assert lines(project) == []


@pytest.mark.parametrize("link", ["results", "results/figures", "results/figures/fig14.png"])
def test_a_run_is_never_the_reference_itself(project, capsys, link):
    path = project.top / link
    path.rename(project.top / "elsewhere")
    with pytest.raises(SystemExit):
        assert compare.main(project, [str(project.top / "figures")]) == 2
    path.symlink_to(project.top / link.removeprefix("results").lstrip("/"))
    assert "it is the file of the reference" in lines(project, names=["fig14"])[-1]


def test_names_are_escaped_and_a_page_that_cannot_be_written_changes_no_verdict(project, capsys):
    run(project, text="83")
    for name in ("<img src=x>", "\x1b[31mred", "a\nAll 8 files agree"):
        (project.top / f"results/figures/{name}.md").write_text("x", "utf-8")
    assert compare.main(project, [str(project.top)]) == 1
    text = capsys.readouterr().out
    page = project.top / "results/diff/index.html"
    for content in (text, page.read_text("utf-8")):
        assert "\x1b" not in content and "\nAll 8 files" not in content
    assert "<img src=x>" in text and "<img src=x>" not in page.read_text("utf-8")
    shutil.rmtree(page.parent)
    page.parent.write_text("a file", "utf-8")
    assert compare.main(project, [str(project.top)]) == 1
    assert "The page cannot be written: " in capsys.readouterr().out


def test_a_text_with_another_title_has_no_sentences(project):
    run(project, height=(1.0, 2.5), text="83")
    path = project.top / "results/paper.md"
    path.write_text("another run\nis 83\n", "utf-8")
    note(project, "article", project.texts, "src/writing.py", ["fig14"], entries=ENTRIES)
    findings = report(project).findings
    assert findings["paper.md"].sentences == []
    assert findings["supplement.md"].sentences == [("is 82", "is 83")]


def test_a_figure_that_is_not_made_any_more_leaves_the_reference(project):
    """A file of the user stays. A figure of another branch is to be removed from the results."""
    (project.top / "figures/mine.md").write_text("mine", "utf-8")
    made = [file for file in MADE if "fig01" not in file]
    left = [project.top / f"results/figures/fig01.{kind}" for kind in ("png", "svg")]
    assert f"fig01: no rule makes it, remove it: {left[0]}" in lines(project, made=made)
    with pytest.raises(
        ValueError, match="; ".join(f"no rule makes it, remove it: {path}" for path in left)
    ):
        accept(project, made)
    for path in left:
        path.unlink()
    assert lines(project, made=made)[-1] == (
        "missing in the results: figures/fig01.png, figures/fig01.svg"
    )
    git(project.top, "rm", "-q", "--cached", "figures/fig01.svg")
    assert accept(project, made) == ["figures/fig01.png"]
    assert [path.name for path in project.top.glob("figures/fig01.*")] == ["fig01.svg"]
    assert (
        "mine: no record names: figures/mine.md in the reference; "
        "missing: figures/mine.md in the results" in lines(project, made=made)
    )


PROCESSORS = (np.array([1.0, 2.0]), np.array([1.0, 2.0 + 1e-12]))
"""The same numbers, rounded differently."""
CHANGES = {
    "nothing": {},
    "a label": {"form": "height {!r}"},
    "a caption": {"caption": "D", "text": "83"},
    "a number": {"add": 0.5},
    "dataset and picture": {"add": 0.5, "form": "height {!r}", "text": "83"},
}


@pytest.mark.parametrize("first, second", [*product((0, 1), repeat=2)])
@pytest.mark.parametrize("what", CHANGES)
def test_what_one_processor_accepts_is_green_on_each(project, tmp_path, what, first, second):
    """One processor made the reference, one accepts a change, and both compare with it."""
    given = {"form": "{!r}", "add": 0.0, "caption": "C", "text": "82"} | CHANGES[what]
    before = replace(project, make=partial(make, form="{!r}"))
    run(before, PROCESSORS[first])
    accept(before)
    today = replace(project, make=partial(make, form=given["form"]))
    entries = {"fig14": ENTRIES["fig14"] | {"caption": given["caption"]}}
    config = {"release": "force", "stage": entries}
    (project.top / "config/config.yaml").write_text(json.dumps(config), "utf-8")
    commit(project.top)
    run(today, PROCESSORS[second] + given["add"], text=given["text"], entries=entries)
    # What agrees stays as it is.
    stays = what in ("nothing", "a caption")
    assert stays == ("figures/fig14.png" not in accept(today))
    for numbers in PROCESSORS:
        run(today, numbers + given["add"], text=given["text"], entries=entries)
        assert lines(today, config=config) == []
    today.make("fig14", datasets.read(project.top / "figures/fig14.nc"), tmp_path)
    for name in ("fig14.png", "fig14.svg"):
        assert (tmp_path / name).read_bytes() == (project.top / "figures" / name).read_bytes()


def test_a_dataset_names_the_code_of_today_and_keeps_each_number_as_it_was_accepted(project):
    path = project.top / "figures/fig14.nc"
    run(project, PROCESSORS[0])
    accept(project)
    before = datasets.read(path)
    edit(project, "src/model.py")
    commit(project.top)
    run(replace(project, license="another"), PROCESSORS[1])
    today = replace(project, license="another")
    assert accept(today) == ["figures/fig14.nc", "figures/claims.nc"]
    after = datasets.read(path)
    xr.testing.assert_equal(after, before)
    assert (after.max_height.values != PROCESSORS[1]).any()
    assert after.license == "another" and after.code != before.code
    assert after.computed_on == before.computed_on
    commit(project.top)
    assert accept(today) == []
    assert lines(today) == []


def reference(project):
    """The files of the reference; git would commit no others."""
    listed = provenance.git(project.top, "ls-files", "--cached", "--others", "--exclude-standard")
    paths = [project.top / file for file in listed.split() if (project.top / file).exists()]
    return {path.relative_to(project.top): path.read_bytes() for path in paths}


def test_another_python_alone_changes_no_record(project, monkeypatch):
    before = reference(project)
    monkeypatch.setattr(provenance.platform, "python_version", lambda: "3.99.0")
    run(project)
    assert accept(project) == [] and reference(project) == before
    edit(project, "src/model.py")
    commit(project.top)
    run(project)
    accept(project)
    assert "3.99.0" in (project.top / runs.ACCEPTED).read_text("utf-8")


@pytest.mark.parametrize("another", [False, True])
def test_an_interrupted_acceptance_is_completed_by_the_next_one(project, tmp_path, another):
    """Each attempt is killed within its third write, until one has nothing more to write. The first
    write is its plan. Attempts may have different results.
    """

    def computed(project, attempt):
        run(project, (1.0, 2.5 + attempt * another), text=f"{83 + attempt * another}")

    whole = project_in(shutil.copytree(project.top, tmp_path / "whole"))
    computed(whole, 7)
    accept(whole)

    def killed(attempt):
        writes = []

        def move(*paths):
            writes.append(paths)
            if len(writes) == 3:
                patch.setattr(acceptance.Path, "unlink", lambda *_, **__: None)
                raise KeyboardInterrupt
            shutil.move(*paths)

        with pytest.MonkeyPatch.context() as patch, suppress(KeyboardInterrupt):
            patch.setattr(datasets.os, "replace", move)
            patch.setattr(datasets.os, "getpid", lambda: attempt)
            accept(project)
        return len(writes) == 3

    for attempt in range(8):
        computed(project, attempt)
        killed(attempt)
    while killed(8):
        pass
    assert [*project.top.glob(acceptance.BEGUN)] == []
    assert reference(project) == reference(whole)


@pytest.mark.parametrize(
    "change, told",
    [
        (lambda top: edited_by_hand(top), "edited by hand: paper.md: .*`git stash -- paper.md`"),
        (lambda top: (top / "figures/fig18.png").write_bytes(b"x"), "move it: figures/fig18.png"),
        # Git has what was committed.
        (lambda top: (edited_by_hand(top), commit(top)), ""),
    ],
)
def test_an_acceptance_never_overwrites_a_file_of_the_user(project, change, told):
    run(project, text="83")
    pictures = ("figures/fig18.png", "figures/fig18.svg")
    project.make("fig18", None, project.top / "results/figures")
    note(project, "fig18", pictures, "src/drawing.py")
    change(project.top)
    before = reference(project)
    if told:
        with pytest.raises(ValueError, match=told):
            accept(project, (*MADE, *pictures))
        assert reference(project) == before
    else:
        assert "paper.md" in accept(project, (*MADE, *pictures))


def test_a_file_that_no_rule_makes_any_more_stays_if_it_was_edited(project):
    edit(project, "figures/fig01.svg")
    for path in project.top.glob("results/*/fig01.*"):
        path.unlink()
    with pytest.raises(ValueError, match=r"edited by hand: figures/fig01.svg: "):
        accept(project, [file for file in MADE if "fig01" not in file])


def edited_by_hand(top):
    with (top / "paper.md").open("a", encoding="utf-8") as file:
        file.write("a sentence of the user\n")


def compared(project, capsys):
    """The status of the rule `diff`, and what it prints."""
    results = project.top / "results"
    job = SimpleNamespace(
        input=[results / file for file in MADE], params=SimpleNamespace(config=CONFIG, names=[])
    )
    status = compare.report_of_run(project, results, job)
    return status, "".join(capsys.readouterr())


def test_results_of_other_versions_are_one_line_on_each_road(project, capsys, monkeypatch):
    numpy = f"numpy {np.__version__}, here is 9.9"
    other = provenance.versions() | {"numpy": "9.9", "python": "3.99"}
    monkeypatch.setattr(compare, "versions", lambda: other)
    line = f"the results, made with {numpy}: remove them and run again\n"
    assert compared(project, capsys) == (2, line)
    with pytest.raises(SystemExit):
        compare.main(project, [str(project.top)])
    assert f"made with {numpy}" in capsys.readouterr().err
    with pytest.raises(ValueError, match=f"made with {numpy}"):
        accept(project)


def test_a_merge_of_two_acceptances_is_named_and_its_way_out_is_walked(project, capsys):
    """The line names the command; both branches changed the code, the numbers and the texts."""
    for branch, height in (("one", 2.5), ("other", 3.0)):
        git(project.top, "checkout", "-q", "-b", branch, "main")
        (project.top / f"src/{branch}.py").touch()
        commit(project.top)
        run(project, (1.0, height), text=f"{80 + height}")
        accept(project)
        commit(project.top)
    with pytest.raises(subprocess.CalledProcessError):
        git(project.top, "merge", "-q", "one")
    status, line = compared(project, capsys)
    assert status == 2 and line.startswith("figures/accepted.json has the marks of a conflict: ")
    way = line.split("`")[1].split()
    git(project.top, *way[1:])
    commit(project.top)
    run(project, (1.0, 3.5), text="84")
    assert "paper.md" in accept(project)
    assert compared(project, capsys)[0] == 0


@pytest.mark.parametrize("kind", ["folder", "link", "zip", "copy"])
def test_a_run_is_not_compared_with_itself(project, tmp_path, capsys, kind):
    results = project.top / "results"
    other = tmp_path / "another"
    if kind == "folder":
        other = project.top
    elif kind == "link":
        other.symlink_to(results)
    elif kind == "zip":
        other = shutil.make_archive(str(other), "zip", results)
    else:
        shutil.copytree(results, other)
    with pytest.raises(SystemExit) as ended:
        compare.main(project, [str(results), str(other)])
    assert ended.value.code == 2 and "are the same run" in capsys.readouterr().err
    run(project)
    assert (
        kind == "folder" or kind == "link" or compare.main(project, [str(results), str(other)]) == 0
    )


def test_a_dataset_that_was_copied_over_a_result_is_named_itself(project, tmp_path):
    """Also if pictures and texts were made again from the copy."""
    run(project, (1.0, 2.0 + 1e-10))
    shutil.copy(project.top / "figures/fig14.nc", project.top / "results/figures/fig14.nc")
    line = "fig14: edited by hand: figures/fig14.nc of the results"
    assert lines(project) == [line]
    note(project, "claims", ["figures/claims.nc"], "src/model.py", ["fig14"])
    assert lines(project) == [line]


@pytest.mark.parametrize("name", ["references", "source", "license"])
def test_results_with_other_attributes_are_stale(project, name):
    today = replace(project, **{name: "another"})
    stale = f"stale, remove it and run again; changed since: {name}  → another"
    assert lines(today) == [f"fig14: {stale}", f"claims: {stale}"]


def untracked(project):
    git(project.top, "config", "status.showUntrackedFiles", "no")
    edit(project, "src/new.py")


def ignored(project):
    (project.top / ".git/info/exclude").write_text("new.py\n", "utf-8")
    edit(project, "src/new.py")
    note(project, "fig01", ["figures/fig01.png", "figures/fig01.svg"], "src/new.py")


def mixed(project):
    path = project.top / "results/records/fig01.json"
    path.write_text(path.read_text("utf-8").replace(np.__version__, "9.9"), "utf-8")


def hidden(project, how):
    git(project.top, "update-index", how, "src/model.py")
    edit(project, "src/model.py")
    run(project)


def with_a_slip(project):
    run(project, reason="its function high raises NameError('below')")


@pytest.mark.parametrize(
    "change, line",
    [
        (lambda project: edit(project, "src/model.py"), "commit first: M src/model.py"),
        (lambda project: shutil.rmtree(project.top / ".git"), "`git status` does not answer"),
        (lambda project: (project.top / ".git/index").write_bytes(b"DIRC"), "does not answer"),
        (lambda project: hidden(project, "--skip-worktree"), "commit first: src/model.py"),
        (lambda project: hidden(project, "--assume-unchanged"), "commit first: src/model.py"),
        (with_a_slip, "correct first: high is not asked, its function high raises NameError"),
        (untracked, r"commit first: \?\? src/new.py"),
        (ignored, "git does not know src/new.py"),
        (mixed, r"made with numpy 9\.9, here is .*: remove them and run again"),
    ],
)
def test_nothing_is_accepted_that_cannot_be_made_again(project, change, line):
    change(project)
    with pytest.raises(ValueError, match=line):
        accept(project)


# All situations


STATES = ("recorded", "unnamed", "edited", "damaged", "missing")
SITUATIONS = {
    # What a run gives for each file, by what is then to be found of its contents.
    ("figures/fig14.nc", "stage", "src/model.py"): {
        "agrees": {},
        "rounded": {"height": (1.0, 2.0 + 1e-12)},
        "differs": {"height": (1.0, 2.5)},
    },
    ("figures/fig14.svg", "fig14", "src/drawing.py"): {
        "agrees": {},
        "rounded": {"height": (1.0, 2.0 + 1e-12)},
        "differs": {"form": "height {!r}"},
        "follows": {"height": (1.0, 2.5)},
        "redrawn": {"height": (1.0, 2.0 + 1e-12), "form": "height {!r}"},
    },
    ("paper.md", "article", "src/writing.py"): {
        "agrees": {},
        "differs": {"text": "83"},
        "follows": {"text": "83", "height": (1.0, 2.5)},
    },
}


def brought(state, path, record=None):
    """Bring a file of one side into a state."""
    if state == "missing":
        path.unlink()
    elif state == "damaged":
        path.write_bytes(b"\xff")
    elif state == "unnamed":
        record.write_text(record.read_text("utf-8").replace(path.name, "another"), "utf-8")
    elif state == "edited":
        # Readers of datasets and pictures pass over what follows.
        path.write_bytes(path.read_bytes() + b"\n")


def wanted(old, new, stale, contents, is_data, with_reference):
    """The verdict on a file in this situation."""
    sides = {old, new}
    if sides & {"damaged", "unnamed"} or sides == {"missing"}:
        return "not comparable"
    stale = stale and with_reference
    if "missing" in sides:
        return "differs" if "edited" in sides or (stale and new != "missing") else "missing"
    if stale:
        return "differs"
    if "edited" in sides and not is_data:
        return "differs"
    if old == "edited" and with_reference:
        return "differs"
    # Records do not tell that this picture is another one; today's code does.
    redrawn = "differs" if with_reference else "agrees"
    return {"rounded": "agrees", "redrawn": redrawn}.get(contents, contents)


@pytest.mark.parametrize("with_reference", [True, False])
@pytest.mark.parametrize(
    "made, contents", [(made, contents) for made in SITUATIONS for contents in SITUATIONS[made]]
)
def test_each_situation_has_its_verdict(project, tmp_path, made, contents, with_reference):
    """Each state of both sides, with fresh and with stale results."""
    file, rule, code = made
    given = dict(SITUATIONS[made][contents])
    form = given.pop("form", "{!r}")
    digits = replace(project, make=partial(make, form="{!r}"))
    run(digits)
    accept(digits)
    today = replace(project, make=partial(make, form=form))
    run(today, **given)
    kept = shutil.copytree(project.top, tmp_path / "kept")
    results = project.top / "results"

    checkout = runs.Checkout(today, {}, CONFIG, MADE) if with_reference else None

    def sides(file):
        old = runs.run_in(project.top, "old")
        return runs.side(old, file), runs.side(runs.run_in(results, "new"), file, checkout)

    data = compare.finding(*sides("figures/fig14.nc"), checkout, ()).verdict
    differing = ["figures/fig14.nc"] if data == "differs" else []
    records = (project.top / runs.ACCEPTED, results / f"records/{rule}.json")
    for old, new, stale in product(STATES, STATES, (False, True)):
        for path in (project.top / file, results / file, *records, project.top / code):
            shutil.copyfile(kept / path.relative_to(project.top), path)
        brought(old, project.top / file, records[0])
        brought(new, results / file, records[1])
        if stale:
            edit(project, code)
        pair = sides(file)
        finding = compare.finding(*pair, checkout, differing)
        situation = (old, new, stale, contents, file.endswith(".nc"), with_reference)
        assert finding.verdict == wanted(*situation), situation
        assert (
            finding.verdict != "differs"
            or "edited" not in (old, new)
            or runs.EDITED in finding.causes
        ), situation
        # Only what is fresh and recorded is accepted.
        assert (not pair[1].wrong) == (new == "recorded" and not (stale and with_reference))


@pytest.mark.parametrize("after, main, n, version", [*product("ab", "ab ", (1, 2), "12")])
def test_all_that_differs_in_what_made_a_file_is_listed(after, main, n, version):
    """A file of code was accepted as "a". Another one stays as it is."""
    old, new = (
        runs.Side(
            ROOT,
            {},
            record={
                "code": {"edited": code, "other": "a"},
                "parameters": {"n": number},
                "versions": {"numpy": numpy},
                "data": {},
            },
        )
        for code, number, numpy in (("a", 1, "1"), (after, n, version))
    )
    checkout = runs.Checkout(project_in(ROOT), {"edited": main, "other": "a"})
    assert compare.what_differs(old, new, checkout, ()) == (
        {
            kind: [text]
            for kind, text, is_told in (
                ("changed parameter", "n 1 → 2", n == 2),
                ("changed code", "edited (also on main)", after == main == "b"),
                ("changed code", "edited", after == "b" and main != "b"),
                ("other versions", "numpy 1 → 2", version == "2"),
            )
            if is_told
        }
        or compare.SAME
    )


OTHERS = {
    "b": np.logical_not,
    "i": partial(np.add, 1),
    "U": lambda texts: np.char.add(texts, "x"),
}


def moved(data, name, share, largest):
    """The values of a variable with one number moved by a share of its tolerance: that with the
    largest scale, or that with the smallest.
    """
    given = data[name].attrs
    scale = np.maximum(abs(data[name].values), given["floor"])
    if "tolerance_scale" in given:
        scale = abs(data[given["tolerance_scale"]].values)
    values = data[name].values.copy()
    known = np.flatnonzero(np.isfinite(values) & (scale > 0))
    if known.size:
        choose = np.argmax if largest else np.argmin
        index = known[choose(scale.flat[known])]
        values.flat[index] += share * given["tolerance"] * scale.flat[index]
    return values


def test_the_reference_declares_a_tolerance_and_gives_its_scale():
    """A coordinate may be named tolerance. A single value is first, however little it differs."""
    data = xr.Dataset({"a": ("tolerance", [1.0], {"tolerance": 0.6, "floor": 0.1})})
    data["tolerance"] = ("tolerance", [5.0], {"tolerance": 0.1, "floor": 1.0})
    data["b"] = ((), 1.0, {"tolerance": 0.1, "floor": 1.0})
    told = ["b 1 → 1.15 (tolerance 0.1)", "a 1 → 2 at tolerance = 5 (tolerance 0.6)"]
    other = data.assign(a=data.a.copy(data=[2.0]), b=data.b.copy(data=1.15))
    assert [*map(str, differences.differences("a.nc", data, other))] == told


@pytest.mark.parametrize(
    "path",
    sorted([*ROOT.glob("figures/*.nc"), *ROOT.glob("extras/beyond/figures/*.nc")]),
    ids=lambda path: path.name,
)
def test_every_number_of_the_reference_is_compared_with_its_tolerance(path):
    """A tenth more than the tolerance is named, and a tenth less is not.

    A variable that gives another one its scale grows with it, and therefore moves apart from it.
    """
    whole = datasets.read(path)
    numbers = [name for name in whole.variables if whole[name].dtype.kind == "f"]
    scales = {whole[name].attrs.get("tolerance_scale") for name in numbers}
    for names in (
        [name for name in numbers if name in whole.coords],
        [name for name in numbers if name in scales],
        [name for name in numbers if name not in whole.coords and name not in scales],
    ):
        needed = {*names, *(whole[name].attrs.get("tolerance_scale") for name in names)}
        data = whole.drop_vars([name for name in whole.data_vars if name not in needed])
        for share, largest in product((1.1, -1.1, 0.9, -0.9), (False, True)):
            other = data.copy(deep=True)
            for name in names:
                scale = data[name].attrs.get("tolerance_scale")
                if scale and abs(share) > 1:
                    other[scale] = other[scale].copy(data=1.4 * data[scale].values)
                other[name] = (data[name].dims, moved(data, name, share, largest), data[name].attrs)
            assert named(path, data, other, names) == {
                name for name in names if abs(share) > 1 and not other[name].equals(data[name])
            }
    for name, variable in whole.variables.items():
        if name not in numbers:
            data = whole.drop_vars([other for other in whole.data_vars if other != name])
            values = OTHERS[variable.dtype.kind](variable.values)
            other = data.assign({name: (variable.dims, values, variable.attrs)})
            assert named(path, data, other, [name]) == {name}


def named(path, data, other, names):
    """Those of the variables that a comparison of two datasets names."""
    return {difference.what for difference in differences.differences(path.name, data, other)} & {
        *names
    }


@pytest.mark.parametrize(
    "path",
    sorted([*ROOT.glob("figures/*.nc"), *ROOT.glob("extras/beyond/figures/*.nc")]),
    ids=lambda path: path.name,
)
def test_what_is_new_along_each_dimension_of_the_reference_is_told_and_the_rest_is_compared(path):
    """One value less or more, and the others rounded: that is the only difference. A number of the
    others that changes is told, too. Values without coordinates belong together by their positions.
    """
    whole = datasets.read(path)
    for dim in map(str, whole.dims):
        gone = (
            1
            if any(dim in coordinate.dims for coordinate in whole.coords.values())
            else whole.sizes[dim] - 1
        )
        less = whole.isel({dim: [n for n in range(whole.sizes[dim]) if n != gone]})
        if whole.sizes[dim] < 3:
            continue
        for name, coordinate in whole.coords.items():
            if coordinate.dtype.kind == "f" and dim in coordinate.dims:
                less = less.assign_coords(
                    {name: (coordinate.dims, less[name].values * (1 + 1e-12), coordinate.attrs)}
                )
        for pair, what in (((whole, less), "missing"), ((less, whole), "new")):
            (told,) = differences.differences(path.name, *pair)
            assert told.what == dim and told.change.endswith(f" is {what}")
        changed = {}
        for name in [name for name in less.data_vars if less[name].dtype.kind == "f"]:
            values = less[name].values.copy()
            known = np.argwhere(np.isfinite(values))
            if known.size and "tolerance_scale" not in less[name].attrs:
                values[tuple(known[-1])] += 1.0
                changed[name] = (less[name].dims, values, less[name].attrs)
        told = [
            difference.what
            for difference in differences.differences(path.name, whole, less.assign(changed))
        ]
        assert told[0] == dim and sorted(told[1:]) == sorted(changed)

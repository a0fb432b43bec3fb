"""Folders that differ in known ways: the outcomes, the causes, and the reports."""

import json
import os
import shutil
import subprocess
from itertools import product
from pathlib import Path

import pytest
from netCDF4 import Dataset
from PIL import Image

from bouncing_ball_beyond.inherited.datasets.files import read_dataset, write_dataset
from bouncing_ball_beyond.inherited.pipeline.diff import causes as module
from bouncing_ball_beyond.inherited.pipeline.diff import compare
from bouncing_ball_beyond.inherited.pipeline.diff.causes import code_in_place_of, touched_files
from bouncing_ball_beyond.inherited.pipeline.diff.compare import compare_folders
from bouncing_ball_beyond.inherited.pipeline.diff.outcome import Outcome
from bouncing_ball_beyond.inherited.pipeline.diff.report import differences_html, to_terminal
from bouncing_ball_beyond.inherited.pipeline.sources import REPOSITORY

ROOT = Path(__file__).resolve().parents[4]
PNG = "figures/fig05.png"


def lines(pair):
    return to_terminal(pair.compare()).splitlines()


def test_equal_folders_are_identical_in_one_line_and_every_file_is_compared(pair):
    comparison = pair.compare()
    assert comparison.outcome is Outcome.IDENTICAL and comparison.outcome.status == 0
    compared = {part.name for found in comparison.parts for part in found.parts}
    paths = (path for path in pair.record.rglob("*") if path.is_file())
    assert compared == {path.relative_to(pair.record).as_posix() for path in paths}
    assert lines(pair) == ["5 identical. The results agree with the record."]
    assert len(differences_html(comparison)) < 20_000


def test_what_is_within_its_budget_is_a_number_in_the_one_line(pair):
    pair.move(by=1e-14)
    assert lines(pair) == ["1 rounding, 4 identical. The results agree with the record."]


def test_a_readme_and_what_is_not_written_completely_are_no_artifacts(pair):
    for name in ("README.md", "figures/README.md", "figures/.fig05.part.nc", "notes.txt"):
        (pair.new / name).write_text("other", encoding="utf-8")
    assert pair.compare().outcome is Outcome.IDENTICAL


def test_a_folder_of_figures_may_have_folders(pair):
    for side in ("record", "new"):
        (getattr(pair, side) / "figures" / "beyond").mkdir()
        pair.write("beyond/ext_height", pair.dataset("fig05"), side)
    assert pair.artifact("ext_height").outcome is Outcome.IDENTICAL


@pytest.mark.parametrize(
    ("file", "old", "new"),
    [
        ("paper.md", "reproduced", "contradicted"),
        ("paper.md", "0.85", "0.86"),
        ("figures/table1.csv", "saddle-node", "saddle node"),
        ("figures/table1.md", "0.255", "0.254"),
        ("figures/fig05.svg", "<!-- $", "<!-- 2$"),
    ],
)
def test_another_word_or_number_in_a_text_has_drifted(pair, file, old, new):
    pair.rewrite(file, old, new)
    row = pair.row(file)
    assert row.outcome is Outcome.DRIFTED and pair.compare().outcome.status == 1
    before, after = row.told.split(" → ")
    assert old.strip("<!- $") in before and new.strip("<!- $") in after
    assert len(lines(pair)) == 2


def test_a_page_is_compared_except_for_its_commit(pair):
    for file, folder in product(("explorer.nc", "explorer.html"), (pair.record, pair.new)):
        shutil.copyfile(ROOT / "figures" / file, folder / "figures" / file)
    pair.rewrite("figures/explorer.html", '{"commit": "', '{"commit": "c0ffee')
    assert pair.file("figures/explorer.html").outcome is Outcome.IDENTICAL
    pair.rewrite("figures/explorer.html", '"spring-damper", 0.5, 80', '"spring-damper", 0.5, 81')
    assert pair.file("figures/explorer.html").outcome is Outcome.DRIFTED


def test_a_last_digit_may_change_only_if_its_data_moved(pair):
    pair.rewrite("figures/table1.md", "1.03830", "1.03831")
    assert pair.file("figures/table1.md").outcome is Outcome.DRIFTED
    pair.move("table1", by=2.0**-48)
    assert pair.artifact("table1").outcome is Outcome.ROUNDING
    # The article is made from all datasets.
    pair.rewrite("paper.md", "0.2547–1.0383 (0", "0.2548–1.0383 (0")
    assert pair.file("paper.md").outcome is Outcome.ROUNDING
    pair.rewrite("figures/table1.md", "1.03831", "1.03833")
    assert pair.artifact("table1").outcome is Outcome.DRIFTED


def test_a_picture_may_move_only_if_its_data_did(pair):
    with Image.open(pair.new / PNG) as picture:
        text = picture.text
        picture.putpixel((100, 100), (250, 250, 250))
        pair.draw(PNG, picture, **text)
    pair.rewrite("figures/fig05.svg", "L 35.755967 34.362986", "L 35.755967 34.363086")
    assert pair.file(PNG).outcome is pair.file("figures/fig05.svg").outcome is Outcome.DRIFTED
    pair.move(by=1e-14)
    assert pair.artifact("fig05").outcome is Outcome.ROUNDING


def test_the_ends_of_lines_of_a_checkout_do_not_count(pair):
    for path in (
        *pair.record.rglob("*.md"),
        *pair.record.rglob("*.csv"),
        *pair.record.rglob("*.svg"),
    ):
        path.write_bytes(path.read_bytes().replace(b"\n", b"\r\n"))
    assert lines(pair) == ["5 identical. The results agree with the record."]


def test_a_file_of_one_folder_alone_is_missing_or_extra(pair):
    (pair.new / PNG).unlink()
    (pair.record / "figures" / "table1.csv").unlink()
    (pair.new / "paper.md").unlink()
    outcomes = {found.name: str(found.outcome) for found in pair.compare().parts}
    assert outcomes.pop("fig05") == outcomes.pop("paper") == "missing"
    assert outcomes.pop("table1") == "extra" and set(outcomes.values()) == {"identical"}


# What makes a file hostile, and what is said about it.


def half(path):
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])


def pipe(path):
    path.unlink()
    os.mkfifo(path)


def folder(path):
    path.unlink()
    path.mkdir()


def nowhere(path):
    path.unlink()
    path.symlink_to("nowhere")


def huge(path):
    with Dataset(path, "w") as data:
        data.createDimension("t", 10**11)
        data.createVariable("x", "f8", ("t",), chunksizes=(1 << 20,))


def other_provenance(text):
    def change(path):
        data = read_dataset(path).assign_attrs(provenance_versions=text)
        write_dataset(data, path)

    return change


@pytest.mark.parametrize("side", ["record", "new"])
@pytest.mark.parametrize(
    ("file", "change", "said"),
    [
        ("figures/fig05.nc", half, "cannot be read: damaged, or not ours"),
        (PNG, half, ""),
        *((file, pipe, "no regular file") for file in ("figures/fig05.nc", PNG, "paper.md")),
        ("figures/fig05.svg", folder, "no regular file"),
        ("figures/table1.csv", nowhere, "no regular file"),
        ("figures/fig05.nc", huge, "is damaged: its arrays have 1.0e+11 numbers"),
        *(
            ("figures/fig05.nc", other_provenance(text), "its provenance is damaged")
            for text in ("{", "[1", "7", "[[1]]")
        ),
    ],
)
def test_a_hostile_file_gives_one_line_and_the_others_are_compared(pair, file, change, said, side):
    change(getattr(pair, side) / file)
    comparison = pair.compare()
    assert comparison.outcome.status == 2
    *_, line, last = lines(pair)
    assert line.startswith(f"{Path(file).stem}: a file could not be compared") and said in line
    assert last == "1 could not be compared, 4 identical. Some artifacts could not be compared."
    assert said in differences_html(comparison)


def test_escape_sequences_of_texts_attributes_and_names_are_shown_and_not_sent(pair):
    pair.move(n="\x1b[2J\u202e")
    (pair.new / "figures" / "a\x1b[31m.nc").write_bytes(b"")
    (pair.new / "figures" / "b\udcff.csv").write_bytes(b"")
    (pair.new / "paper.md").write_text("\x1b]0;title\x07<script>\n", encoding="utf-8")
    comparison = pair.compare()
    page = differences_html(comparison)
    for shown in (to_terminal(comparison), page):
        assert "\x1b" not in shown and "\u202e" not in shown and "\\x1b[2J\\u202e" in shown
        assert shown.encode()
    assert "<script" not in page


# Causes.


def code(digest, *files):
    return "\n".join(f"{digest} {file}" for file in files)


def versions(**libraries):
    return json.dumps({"python": "3.12.1"} | libraries)


@pytest.mark.parametrize(
    ("record", "new", "cause"),
    [
        ({"n": 1, "r": 0.85}, {"n": 1, "r": 0.7}, "parameter changed, r 0.85 → 0.7"),
        ({"n": 1, "r": 0.85}, {"n": 2, "r": 0.7}, "parameters changed, n 1 → 2, r 0.85 → 0.7"),
        # A parameter is the cause by itself.
        (
            {"provenance_code": code("1f0e", "a.py"), "r": 0.85},
            {"provenance_code": code("2a2a", "a.py"), "r": 0.7},
            "parameter changed, r 0.85 → 0.7",
        ),
        (
            {"provenance_code": code("1f0e", "a.py") + "\n0000 b.py"},
            {"provenance_code": code("2a2a", "a.py") + "\n0000 b.py"},
            "changed code, a.py",
        ),
        (
            {"provenance_versions": versions(numpy="2.2.0", scipy="1.15.0")},
            {"provenance_versions": versions(numpy="2.3.1", scipy="1.15.0")},
            "other numpy, 2.2.0 → 2.3.1",
        ),
        ({}, {}, "numbers moved"),
    ],
)
def test_the_cause_is_named_parameters_before_code_before_versions(pair, record, new, cause):
    data = pair.dataset("fig05")
    data.attrs.pop("provenance_code")
    pair.write("fig05", data.assign_attrs(record), "record")
    pair.move(**record | new)
    assert pair.artifact("fig05").cause == cause


@pytest.mark.parametrize(
    ("touched", "files", "cause"),
    [
        ([], 3, "changed code, f0.py, f1.py, f2.py"),
        (["f2.py", "elsewhere.py"], 3, "changed code, f2.py, and 2 more since the record"),
        (["f2.py"], 99, "changed code, f2.py, and 98 more since the record"),
        ([], 99, "changed code, 99 files since the record, which is 250 commits old"),
    ],
)
def test_of_changed_code_the_files_of_the_present_change_are_named(
    pair, monkeypatch, touched, files, cause
):
    names = [f"f{k}.py" for k in range(files)]
    monkeypatch.setattr(compare, "touched_files", lambda: touched)
    monkeypatch.setattr(module, "git", lambda *_: "250\n")
    data = pair.dataset("fig05").assign_attrs(provenance_code=code("1f0e", *names))
    pair.write("fig05", data, "record")
    pair.move(provenance_code=code("2a2a", *names))
    assert pair.artifact("fig05").cause == cause
    *first, line, _ = lines(pair)
    assert line.startswith(f"fig05: {cause}; ")
    # Of many files none is named on the page either, unless it is touched.
    named = cause.removeprefix("changed code, ").split(", ")[0]
    said = f"changed code (artifacts made by it that differ): {named} (1)"
    assert [x[: len(said)] for x in first] == ([said] if files == 3 or touched else [])


def test_the_present_change_is_what_is_not_committed_or_not_in_the_main_branch(
    tmp_path, monkeypatch
):
    monkeypatch.setattr(module, "REPOSITORY", tmp_path)
    assert touched_files() == frozenset()

    def git(*arguments):
        who = ("-c", "user.name=tests", "-c", "user.email=tests")
        subprocess.run(["git", *who, *arguments], cwd=tmp_path, check=True, capture_output=True)

    git("init", "--initial-branch", "main")
    for name in ("old.py", "edited.py", "committed.py"):
        (tmp_path / name).write_text("old", encoding="utf-8")
    git("add", ".")
    git("commit", "-m", "first")
    git("switch", "-c", "change")
    (tmp_path / "committed.py").write_text("new", encoding="utf-8")
    git("commit", "-am", "second")
    for name in ("edited.py", "new one.py"):
        (tmp_path / name).write_text("new", encoding="utf-8")
    assert touched_files() - {""} == {"committed.py", "edited.py", "new one.py"}


def test_where_code_has_changed_and_the_configuration_has_not_its_refusal_names_the_code(
    monkeypatch,
):
    files = [REPOSITORY / "config" / "config.yaml"]
    code = "beyond/src/bouncing_ball_beyond/models/flight.py"
    for touched, said in (
        ({code, "tests/x.py"}, f"The configuration has not changed, but code has: {code}\n"),
        ({code, "config/config.yaml"}, ""),
        ({"tests/x.py"}, ""),
    ):
        monkeypatch.setattr(module, "touched_files", lambda found=touched: frozenset(found))
        assert code_in_place_of(files) == said


def test_a_picture_that_other_code_has_drawn_from_the_same_data_names_this_code(pair):
    for side, digest in (("record", "1f0e"), ("new", "2a2a")):
        picture = Image.new("RGB", (12, 9), "white" if side == "new" else "black")
        pair.draw(PNG, picture, side, provenance_code=f"{digest} drawing/style.py")
    assert pair.artifact("fig05").cause == "changed code, drawing/style.py"


def test_a_picture_of_data_that_other_code_moved_within_their_budgets_names_this_code(pair):
    data = pair.dataset("fig05").assign_attrs(provenance_code=code("1f0e", "orbit.py"))
    pair.write("fig05", data, "record")
    pair.move(by=1e-14, provenance_code=code("2a2a", "orbit.py"))
    pair.draw(PNG, Image.new("RGB", (12, 9), "black"))
    assert pair.artifact("fig05").cause == "changed code, orbit.py"


def test_a_white_picture_is_no_picture_by_another_matplotlib(pair):
    with Image.open(pair.record / PNG) as picture:
        size = picture.size
    for there in ((10, 10), size):
        other = '{"matplotlib": "0.1"}'
        pair.draw(PNG, Image.new("RGB", there, "white"), provenance_versions=other)
        assert not pair.file(PNG).outcome.agrees


def test_pictures_and_tables_of_other_parameters_are_named_as_such(pair):
    pair.move(restitution=0.7)
    shutil.copyfile(pair.record / "figures/fig01.svg", pair.new / "figures/fig05.svg")
    artifact = pair.artifact("fig05")
    assert artifact.outcome is Outcome.PARAMETERS
    assert {part.outcome for part in artifact.moved} == {Outcome.PARAMETERS}
    assert artifact.cause.startswith("parameter changed, restitution ")


def test_what_is_made_from_a_changed_artifact_names_it(pair):
    pair.move()
    claims = pair.dataset("claims")
    claims.verdict.values[:2] = "another"
    pair.write("claims", claims)
    pair.rewrite("paper.md", "*reproduced*", "*contradicted*")
    causes = {artifact.name: artifact.cause for artifact in pair.compare().moved}
    # Verdicts come first, and all of them are told.
    assert list(causes) == ["claims", "fig05", "paper"]
    assert causes["claims"].startswith("made from fig05")
    assert causes["paper"] == "made from claims, fig05"
    first = lines(pair)[0]
    assert first.count("verdict at claim = ") == 2 and first.count("→ another") == 2
    # Only the inputs of the requested artifact are looked at, and none is reported with it.
    (alone,) = pair.compare("claims").parts
    assert alone.cause.startswith("made from fig05")


@pytest.mark.parametrize(
    ("file", "rule", "job"),
    [
        ("figures/fig05.nc", "compute_fig05", "compute_fig05"),
        (PNG, "draw_fig05", "draw_fig05"),
        ("figures/fig05.svg", "draw_fig05", "draw_fig05"),
    ],
)
def test_an_artifact_of_older_code_is_stale_even_if_it_agrees(pair, monkeypatch, file, rule, job):
    read = compare.provenance_in
    made = {Path(file).name: {"rule": rule}}
    monkeypatch.setattr(compare, "provenance_in", lambda x: {**read(x), **made.get(x.name, {})})
    note = pair.new / "code" / job
    note.parent.mkdir()
    path = pair.new / file
    digests = compare.provenance_in(path)["code"]
    for text, outcome in ((digests, Outcome.IDENTICAL), ("2a2a a.py", Outcome.STALE)):
        note.write_text(f"{text}\n\n3.12.1 python", encoding="utf-8")
        assert pair.artifact("fig05").outcome is outcome
    assert pair.artifact("fig05").cause == "made by older code than that of the working tree"


def test_what_was_not_made_has_its_reason_even_if_an_older_version_or_nothing_is_there(pair):
    shutil.rmtree(pair.new / "figures")
    files = {"figures/fig05.nc": "fig05: no orbit", PNG: "needs fig05", "tally.txt": "needs fig05"}
    found = compare_folders(pair.record, pair.new, not_made=files)
    causes = {artifact.name: artifact.cause for artifact in found.moved}
    assert causes["fig05"] == "not made, fig05: no orbit" and "tally" not in causes
    assert causes["table1"] == "a file is missing" and found.outcome.status == 1
    # Nothing at all was made.
    (pair.new / "paper.md").unlink()
    found = compare_folders(pair.record, pair.new, ["fig05"], files)
    assert to_terminal(found).startswith("fig05: not made, fig05: no orbit\n")
    assert "not made, fig05: no orbit" in differences_html(found)


# Reports.


def test_the_reports_name_each_change_once_with_its_cause_and_place(pair):
    pair.move()
    pair.rewrite("figures/fig05.svg", "<!-- $", "<!-- 2$")
    pair.rewrite("paper.md", "*reproduced*", "*contradicted*")
    first, second, last = lines(pair)
    assert first.startswith("fig05: numbers moved; ") and " in phase of the table when" in first
    assert " at case = r = 1, Λ = 0.8, frequency_ratio = " in first and " → " in first
    assert first.endswith("; 1 of 1204 entries moved, 1 beyond the budget")
    assert second.startswith("paper: made from fig05; line ") and "contradicted" in second
    assert last == "2 drifted, 3 identical. The results differ from the record."
    page = differences_html(pair.compare())
    assert page.index(last) < page.index("numbers moved; ") < page.index('id="fig05"')
    assert page.index('id="fig05"') < page.index('id="paper"') and 'id="table1"' not in page
    # Pictures and tables that follow a dataset are not repeated, nor are pictures that agree.
    assert "2$" not in page and "data:image" not in page


def test_a_page_with_pictures_is_small_enough_to_load_at_once(pair):
    with Image.open(pair.record / PNG) as picture:
        pair.draw(PNG, picture.transpose(Image.Transpose.ROTATE_180))
    sizes = [(side / PNG).stat().st_size for side in (pair.record, pair.new)]
    page = differences_html(pair.compare())
    assert page.count("data:image") == 2 and len(page) < 15_000 + sum(sizes)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("record", "empty"), "nothing to compare in empty: neither figures/ nor a text"),
        (("record", "new", "fig99"), "unknown artifact fig99; known: claims, fig01, fig05"),
        (("record", "new", "--against", "none"), "nothing to compare in none"),
        ((), "nothing to compare in results"),
    ],
)
def test_folders_that_cannot_be_compared(pair, monkeypatch, refused, arguments, said):
    monkeypatch.chdir(pair.new.parent)
    (pair.new.parent / "empty").mkdir()
    (pair.new.parent / "paper.md").write_text("A text.\n", encoding="utf-8")
    status, line = refused("diff", *arguments)
    assert status == 2 and said in line


@pytest.mark.parametrize(
    ("arguments", "count"),
    [
        ((), "1 drifted, 4 identical"),
        (("house",), "1 drifted, 4 identical"),
        (("fig05",), "1 drifted."),
        ((".", "results", "fig01", "table1"), "2 identical"),
        # Two runs against each other.
        (("--against", "other"), "5 identical"),
        (("--against", "other/results"), "5 identical"),
    ],
)
def test_the_command_takes_a_house_its_results_and_artifacts(
    pair, tmp_path, monkeypatch, capsys, arguments, count
):
    from bouncing_ball_beyond.inherited.cli.main import main

    pair.move()
    pair.record.rename(tmp_path / "house")
    shutil.copytree(pair.new, tmp_path / "house" / "results")
    (tmp_path / "house" / "other").mkdir()
    pair.new.rename(tmp_path / "house" / "other" / "results")
    monkeypatch.chdir(tmp_path / ("house" if "house" not in arguments else ""))
    with pytest.raises(SystemExit) as ended:
        main(["diff", *arguments])
    assert capsys.readouterr().out.splitlines()[-1].startswith(count)
    assert ended.value.code == int("drifted" in count)

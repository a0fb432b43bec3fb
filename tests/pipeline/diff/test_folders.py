"""Texts, pictures and folders that differ in known ways, the causes, and the reports."""

import json
import re
import shutil
from itertools import product
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from PIL import Image, ImageDraw
from PIL.PngImagePlugin import PngInfo

from bouncing_ball.datasets.files import read_dataset, write_dataset
from bouncing_ball.errors import ModelError
from bouncing_ball.pipeline.diff.budgets import PICTURE, PIXEL
from bouncing_ball.pipeline.diff.folders import compare_folders, compare_pictures
from bouncing_ball.pipeline.diff.outcome import Outcome
from bouncing_ball.pipeline.diff.page import differences_html, greatest_difference, to_terminal
from bouncing_ball.pipeline.diff.texts import compare_texts
from bouncing_ball.pipeline.diff.words import summary_of_changes

ROOT = Path(__file__).resolve().parents[3]


def test_equal_folders_are_identical_and_every_file_is_compared(pair):
    comparison = pair.compare()
    assert comparison.outcome is Outcome.IDENTICAL and comparison.outcome.status == 0
    compared = {part.name for found in comparison.parts for part in found.parts}
    paths = (path for path in pair.record.rglob("*") if path.is_file())
    assert compared == {path.relative_to(pair.record).as_posix() for path in paths}


def test_measurements_of_engines_are_compared_if_both_folders_have_them(pair, refusal):
    for folder in (pair.record, pair.new):
        with refusal(ModelError, "unknown artifact engines"):
            pair.artifact("engines")
        (folder / "config").mkdir()
        shutil.copyfile(ROOT / "config/engines.nc", folder / "config/engines.nc")
    assert pair.artifact("engines").outcome is Outcome.IDENTICAL
    # Another machine and another version: other times, and heights that a step may give.
    moved = read_dataset(pair.new / "config/engines.nc")
    moved.bounce_time.values *= 2
    for off, outcome in ((0.9, Outcome.WITHIN), (0.2, Outcome.DRIFTED)):
        moved.height_error.values += off * moved.step_scatter.values
        write_dataset(moved, pair.new / "config/engines.nc")
        assert pair.artifact("engines").outcome is outcome


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
    part = pair.part(file)
    (row,) = part.parts
    assert row.outcome is Outcome.DRIFTED and pair.compare().outcome.status == 1
    assert old.strip("<!- $") in row.record and new.strip("<!- $") in row.new


def test_a_page_is_compared_except_for_its_commit(pair):
    for file, folder in product(("explorer.nc", "explorer.html"), (pair.record, pair.new)):
        shutil.copyfile(ROOT / "figures" / "beyond" / file, folder / "figures" / "beyond" / file)
    pair.rewrite("figures/beyond/explorer.html", '{"commit": "', '{"commit": "c0ffee')
    assert pair.part("figures/beyond/explorer.html").outcome is Outcome.IDENTICAL
    pair.rewrite(
        "figures/beyond/explorer.html", '"spring-damper", 0.5, 80', '"spring-damper", 0.5, 81'
    )
    assert pair.part("figures/beyond/explorer.html").outcome is Outcome.DRIFTED


def test_a_last_digit_may_change_only_if_its_data_moved(pair):
    pair.rewrite("figures/table1.md", "1.03830", "1.03831")
    assert pair.part("figures/table1.md").outcome is Outcome.DRIFTED
    data = pair.dataset("table1")
    data.computed.values[0, 0, 0] *= 1 + 2.0**-45
    pair.write("table1", data)
    assert pair.part("figures/table1.md").outcome is Outcome.WITHIN
    assert pair.artifact("table1").outcome is Outcome.WITHIN
    # The article is made from all datasets.
    pair.rewrite("paper.md", "0.2547–1.0383 (0", "0.2548–1.0383 (0")
    assert pair.part("paper.md").outcome is Outcome.WITHIN
    pair.rewrite("figures/table1.md", "1.03831", "1.03833")
    assert pair.artifact("table1").outcome is Outcome.DRIFTED


def test_a_line_that_is_new_or_gone_has_no_counterpart():
    record, new = "a 1\nb 2\nc 3", "a 1\nnew\nb 2.5\nc 3"
    found = compare_texts(record, new, None)
    assert [(line.record, line.new) for line in found] == [(None, "new"), ("b 2", "b 2.5")]
    found = compare_texts(new, record, None)
    assert [(line.name, line.record, line.new) for line in found] == [
        ("line 2", "new", None),
        ("line 3", "b 2.5", "b 2"),
    ]


def test_a_line_that_is_added_to_a_long_table_is_the_only_difference():
    rows = [f"| {number} |" for number in range(300)]
    found = compare_texts("\n".join(rows), "\n".join(["| new |", *rows]), None)
    assert [(line.record, line.new) for line in found] == [(None, "| new |")]


def save_png(path, picture: Image.Image, **text: str) -> None:
    info = PngInfo()
    for key, value in text.items():
        info.add_text(key, value)
    picture.save(path, "PNG", pnginfo=info)


def test_a_changed_label_and_a_swapped_picture_have_drifted(pair):
    figures = pair.new / "figures"
    shutil.copyfile(figures / "fig08.png", figures / "fig09.png")
    found = pair.part("figures/fig09.png")
    assert found.outcome is Outcome.DRIFTED and found.share > 1
    assert all(picture.startswith(b"\x89PNG") for picture in found.pictures)
    # A glyph drawn in place of another, in a drawing.
    pair.rewrite("figures/fig05.svg", 'Regular-14"/>', 'Regular-15"/>')
    assert pair.part("figures/fig05.svg").parts[0].new == "STIXGeneral-Regular-15"
    # And one in a picture of full size.
    for folder, label in ((pair.record, "0.5"), (pair.new, "0.6")):
        picture = Image.new("RGB", (1200, 900), "white")
        ImageDraw.Draw(picture).text((500, 400), label, fill="black", font_size=30)
        save_png(folder / "figures" / "fig08.png", picture)
    assert pair.part("figures/fig08.png").outcome is Outcome.DRIFTED


def test_a_picture_may_move_by_one_grey_level_and_keeps_its_size():
    grey = np.full((40, 50, 3), 100, dtype=np.int16)
    assert compare_pictures(grey, grey) == []
    for moved, outcome in ((1, Outcome.WITHIN), (2, Outcome.DRIFTED)):
        (found,) = compare_pictures(grey, grey + moved)
        assert (found.outcome, found.share) == (outcome, moved / PICTURE)
    (found,) = compare_pictures(grey, grey[:, :-1])
    assert (found.outcome, found.record, found.new) == (Outcome.STRUCTURE, "50 × 40", "49 × 40")


def test_without_a_move_of_its_data_a_picture_keeps_its_pixels(pair):
    grey = np.full((40, 50, 3), 100, dtype=np.int16)
    other = grey.copy()
    for change, outcome in ((1, Outcome.WITHIN), (2, Outcome.DRIFTED)):
        # One pixel of two thousand, of which the root mean square says nothing.
        other[7, 7, 1] = grey[7, 7, 1] + change
        (found,) = compare_pictures(grey, other, None)
        assert (found.outcome, found.share) == (outcome, change / PIXEL)
    # In a comparison of folders, with data that did not move and with data that did.
    path = pair.new / "figures" / "fig08.png"
    with Image.open(path) as picture:
        text = picture.text
        picture.putpixel((100, 100), (0, 255, 0))
        save_png(path, picture, **text)
    assert pair.part("figures/fig08.png").outcome is Outcome.DRIFTED
    data = pair.dataset("fig08")
    data.phase.values[0, 4] += 1e-14
    pair.write("fig08", data)
    assert pair.part("figures/fig08.png").outcome is Outcome.WITHIN


def test_a_vector_graphic_is_compared_with_its_curves_and_colours(pair):
    """Its shortest false agreements: no curve, another colour, a program."""
    path = pair.new / "figures" / "fig05.svg"
    text = path.read_text(encoding="utf-8")
    curve = re.search(r'    <path d="[^"]*" clip-path[^>]*/>\n', text)[0]
    colour = re.search("stroke: (#[0-9a-f]{6})", curve)[1]
    changes = {
        "no curve": (curve, ""),
        "recoloured": (colour, "#123456"),
        "a script": ("</svg>", "<script>alert(1)</script></svg>"),
    }
    for what, (old, new) in changes.items():
        path.write_text(text.replace(old, new), encoding="utf-8")
        assert pair.part("figures/fig05.svg").outcome is Outcome.DRIFTED, what
    # Of moved data only the words are judged, and this is said.
    path.write_text(text.replace(colour, "#123456"), encoding="utf-8")
    data = pair.dataset("fig05")
    data.phase.values[1, 40] += 1e-15
    pair.write("fig05", data)
    part = pair.part("figures/fig05.svg")
    assert part.outcome is Outcome.WITHIN and "only its words were compared" in greatest_difference(
        part
    )


def test_generated_names_and_last_digits_of_a_drawing_may_differ(pair):
    path = pair.new / "figures" / "fig05.svg"
    text = path.read_text(encoding="utf-8")
    name = re.search(r'id="(\w*[0-9a-f]{10})"', text)[1]
    number = re.search(r"L (\d+\.\d{6})", text)[1]
    last = f"{float(number) + 1e-6:.6f}"
    path.write_text(
        text.replace(name, f"{name[:-10]}0123456789").replace(number, last), encoding="utf-8"
    )
    assert pair.artifact("fig05").outcome is Outcome.IDENTICAL


@pytest.mark.parametrize(
    ("side", "text"), [("record", "{"), ("new", "[1"), ("record", "7"), ("new", "[[1]]")]
)
def test_a_damaged_provenance_is_named_and_the_rest_is_compared(pair, side, text):
    path = getattr(pair, side) / "figures" / "fig05.nc"
    write_dataset(pair.dataset("fig05").assign_attrs(provenance_versions=text), path)
    comparison = pair.compare()
    first, *others = comparison.parts
    assert first.name == "fig05" and first.outcome is Outcome.UNREADABLE
    assert (
        greatest_difference(pair.part("figures/fig05.nc")) == f"{path}: its provenance is damaged"
    )
    assert {found.outcome for found in others} == {Outcome.IDENTICAL}


def test_a_picture_by_another_matplotlib_is_only_reported(pair):
    path = pair.new / "figures" / "fig08.png"
    with Image.open(path) as picture:
        turned = picture.transpose(Image.Transpose.ROTATE_180)
    save_png(path, turned)
    assert pair.artifact("fig08").outcome is Outcome.DRIFTED
    save_png(path, turned, provenance_versions='{"matplotlib": "0.1"}')
    assert pair.artifact("fig08").outcome is Outcome.WITHIN
    assert "drawn by matplotlib 3." in to_terminal(pair.compare())


def test_a_file_of_one_folder_alone_is_missing_or_extra(pair):
    (pair.new / "figures" / "fig08.png").unlink()
    (pair.record / "figures" / "fig05.svg").unlink()
    (pair.new / "paper.md").unlink()
    outcomes = {found.name: str(found.outcome) for found in pair.compare().parts}
    assert outcomes.pop("fig08") == outcomes.pop("paper") == "missing"
    assert outcomes.pop("fig05") == "extra" and set(outcomes.values()) == {"identical"}


@pytest.mark.parametrize("side", ["record", "new"])
@pytest.mark.parametrize("file", ["figures/fig05.nc", "figures/fig05.png"])
def test_a_damaged_file_could_not_be_compared_and_the_others_are(pair, file, side):
    path = getattr(pair, side) / file
    content = path.read_bytes()
    path.write_bytes(content[: len(content) // 2])
    part = pair.part(file)
    comparison = pair.compare()
    assert part.outcome is Outcome.UNREADABLE and "\n" not in greatest_difference(part)
    assert comparison.outcome.status == 2
    others = {found.outcome for found in comparison.parts[1:]}
    assert others <= {Outcome.IDENTICAL, Outcome.EXTRA, Outcome.MISSING}


def test_markup_in_a_text_is_shown_as_text(pair):
    (pair.new / "paper.md").write_text("<script>\n", encoding="utf-8")
    assert "<script" not in differences_html(pair.compare())


def remade(pair, name, **attributes):
    """A new dataset with other attributes, and one value moved far beyond its budget."""
    data = pair.dataset(name).assign_attrs(attributes)
    data.phase.values[1, 40] += 1e-3
    pair.write(name, data)


def versions(**libraries):
    return json.dumps({"python": "3.12.1"} | libraries)


@pytest.mark.parametrize(
    ("record", "new", "cause"),
    [
        ({"n": 1, "r": 0.85}, {"n": 1, "r": 0.7}, "parameter changed, r 0.85 → 0.7"),
        ({"n": 1, "r": 0.85}, {"n": 2, "r": 0.7}, "parameters changed, n 1 → 2, r 0.85 → 0.7"),
        (
            {"provenance_code": "1f0e", "r": 0.85},
            {"provenance_code": "2a2a", "r": 0.7},
            "parameter changed, r 0.85 → 0.7; other code",
        ),
        (
            {"provenance_code": "1f0e a.py\n0000 b.py"},
            {"provenance_code": "2a2a a.py\n0000 b.py"},
            "other code, a.py",
        ),
        # A record of an earlier day has one digest for all files.
        ({"provenance_code": "1f0e"}, {"provenance_code": "2a2a a.py"}, "other code"),
        (
            {"provenance_versions": versions(numpy="2.2.0", scipy="1.15.0")},
            {"provenance_versions": versions(numpy="2.3.1", scipy="1.15.0")},
            "other numpy, 2.2.0 → 2.3.1",
        ),
        # A record of an earlier day has no digest of its code.
        ({}, {"provenance_code": "2a2a"}, "numbers moved"),
        ({}, {}, "numbers moved"),
    ],
)
def test_the_cause_is_named_parameters_before_code_before_versions(pair, record, new, cause):
    data = pair.dataset("fig05")
    data.attrs.pop("provenance_code")
    write_dataset(data.assign_attrs(record), pair.record / "figures" / "fig05.nc")
    remade(pair, "fig05", **record | new)
    assert pair.artifact("fig05").cause == cause


def test_pictures_and_tables_of_other_parameters_are_named_as_such(pair):
    remade(pair, "fig08", restitution=0.7)
    shutil.copyfile(pair.new / "figures/fig09.png", pair.new / "figures/fig08.png")
    artifact = pair.artifact("fig08")
    assert artifact.outcome is Outcome.PARAMETERS and artifact.share == 0
    outcomes = {part.name: part.outcome for part in artifact.moved}
    changed = {"figures/fig08.nc", "figures/fig08.png"}
    assert outcomes == dict.fromkeys(changed, Outcome.PARAMETERS)


def test_a_picture_that_other_code_has_drawn_from_the_same_data_names_this_code(pair):
    for folder, digest in ((pair.record, "1f0e"), (pair.new, "2a2a")):
        picture = Image.new("RGB", (12, 9), "white" if digest == "1f0e" else "black")
        path = folder / "figures" / "fig08.png"
        save_png(path, picture, provenance_code=f"{digest} drawing/style.py")
    assert pair.artifact("fig08").cause == "other code, drawing/style.py"


def test_what_is_made_from_a_changed_artifact_names_it(pair):
    remade(pair, "fig05", n=2)
    witness = pair.dataset("witness")
    witness.disagreement.values[0, 0] += 1
    pair.write("witness", witness)
    pair.rewrite("paper.md", "reproduced", "contradicted")
    causes = {artifact.name: artifact.cause for artifact in pair.compare().moved}
    assert list(causes) == ["fig05", "witness", "paper"]
    assert causes["witness"] == causes["paper"] == "made from fig05"
    # Only the inputs of the requested artifact are looked at, and none is reported with it.
    alone = compare_folders(pair.record, pair.new, ["witness"])
    assert [(found.name, found.cause) for found in alone.parts] == [("witness", "made from fig05")]


def test_an_artifact_of_older_code_is_stale_even_if_it_agrees(pair):
    for folder in (pair.record, pair.new):
        data = pair.dataset("fig05").assign_attrs(provenance_code="1f0e")
        write_dataset(data, folder / "figures" / "fig05.nc")
    assert pair.artifact("fig05").outcome is Outcome.IDENTICAL
    (pair.new / "code").mkdir()
    for digest, outcome in (("1f0e", Outcome.IDENTICAL), ("2a2a", Outcome.STALE)):
        (pair.new / "code" / "fig05").write_text(digest, encoding="utf-8")
        assert pair.artifact("fig05").outcome is outcome
    assert pair.artifact("fig05").cause == "made by older code than that of the working tree"


def test_the_page_says_first_what_moved_each_thing_once_and_is_small_if_nothing_did(pair):
    assert (
        len(differences_html(pair.compare())) < 20_000 and summary_of_changes(pair.compare()) == []
    )
    data = pair.dataset("table1")
    data.computed.values[0, 0, 0] *= 1.01
    pair.write("table1", data)
    pair.rewrite("figures/table1.md", "1.03830", "1.04830")
    comparison = pair.compare()
    (line,) = summary_of_changes(comparison)
    assert line.startswith("table1: +1 % in end of the stability range") and " → " in line
    page = differences_html(comparison)
    assert page.index(line.partition(" at ")[0]) < page.index('id="table1"')
    # The table follows its dataset; pictures that agree are not embedded.
    assert "1.04830" not in page and "1.04830" not in to_terminal(comparison)
    assert "data:image" not in page


def test_a_page_with_pictures_is_small_enough_to_load_at_once(pair):
    shutil.copyfile(pair.new / "figures" / "fig08.png", pair.new / "figures" / "fig09.png")
    sizes = [
        (folder / "figures" / "fig09.png").stat().st_size for folder in (pair.record, pair.new)
    ]
    page = differences_html(pair.compare())
    assert page.count("data:image") == 2 and len(page) < 0.5 * sum(sizes)


def test_artifacts_with_the_same_change_share_a_line(pair):
    for name in ("fig05", "fig08"):
        for folder, ratio in ((pair.record, 0.125), (pair.new, 0.25)):
            data = xr.Dataset({"damping_ratio": ((), ratio, {"long_name": "damping"})})
            write_dataset(data, folder / "figures" / f"{name}.nc")
    assert summary_of_changes(pair.compare()) == ["fig05, fig08: +100 % in damping: 0.125 → 0.250"]


def test_words_that_changed_are_counted_and_named(pair):
    data = pair.dataset("table1")
    record, new = (
        xr.Dataset({"verdict": ("claim", words)}, {"claim": ["a", "b, c"]})
        for words in (["reproduced"] * 2, ["reproduced", "contradicted"])
    )
    for folder, content in ((pair.record, record), (pair.new, new)):
        write_dataset(content.assign_attrs(data.attrs), folder / "figures" / "claims.nc")
    assert summary_of_changes(pair.compare()) == [
        "claims: 1 changed in verdict: b, c: reproduced → contradicted"
    ]


def test_a_large_relative_change_does_not_hide_in_an_absolute_budget(pair):
    budget = {"budget": 0.1, "scale": "1"}
    for folder, share in ((pair.record, 0.005), (pair.new, 0.045)):
        data = xr.Dataset({"share": ("t", [share, 1.0, 1e-13 * share], budget)})
        write_dataset(data, folder / "figures" / "beyond" / "ext_shares.nc")
    comparison = pair.compare()
    (line,) = summary_of_changes(comparison)
    assert line.startswith("ext_shares: within its budget, +800 % in share at t = 0: ")
    assert comparison.outcome.status == 0


def test_what_was_not_made_has_its_reason_even_if_an_older_version_or_nothing_is_there(pair):
    shutil.rmtree(pair.new / "figures")
    files = {"figures/fig05.nc": "fig05: no orbit", "figures/fig08.png": "needs fig05"}
    found = compare_folders(pair.record, pair.new, not_made=files)
    causes = {artifact.name: artifact.cause for artifact in found.moved}
    assert causes["fig05"] == "not made, fig05: no orbit"
    assert causes["fig08"] == "not made, needs fig05"
    assert causes["fig09"] == "a file is missing" and found.outcome.status == 1
    # Nothing at all was made.
    (pair.new / "paper.md").unlink()
    found = compare_folders(pair.record, pair.new, ["fig05"], files)
    assert to_terminal(found).startswith("fig05: not made, fig05: no orbit\n")
    assert "not made, fig05: no orbit" in differences_html(found)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("record", "none"), "nothing to compare in none: neither figures/ nor paper.md"),
        (("new/figures", "new"), "nothing to compare in"),
        (("record", "new", "fig99"), "unknown artifact fig99; known: fig01, fig05"),
    ],
)
def test_folders_that_cannot_be_compared(pair, monkeypatch, refused, arguments, said):
    monkeypatch.chdir(pair.new.parent)
    status, line = refused("diff", *arguments)
    assert status == 2 and said in line


def test_the_reports_name_the_worst_first_with_its_cause_and_place(pair):
    data = pair.dataset("fig05")
    data.phase.values[1, 40] += 1e-3
    pair.write("fig05", data)
    pair.rewrite("paper.md", "*reproduced*", "*contradicted*")
    comparison = pair.compare()
    lines = to_terminal(comparison).splitlines()
    assert lines[0] == "fig05: numbers moved"
    assert lines[1].startswith("  figures/fig05.nc  drifted ")
    assert " phase at case = 1, frequency_ratio = 2.51189: " in lines[1] and " → " in lines[1]
    assert lines[1].endswith("; entries moved: 1 of 1204, 1 beyond the budget")
    assert lines[2] == "paper: made from fig05"
    assert lines[3].startswith("  paper.md          drifted ") and "contradicted" in lines[3]
    assert lines[4:] == ["2 drifted, 5 identical. The new artifacts differ from the record."]
    page = differences_html(comparison)
    assert "<mark>*contradicted*</mark>" in page and "frequency_ratio = 2.51189" in page
    assert page.index('id="fig05"') < page.index('id="paper"') < page.index('id="fig01"')
    assert compare_folders(pair.record, pair.new, ["fig08"]).outcome is Outcome.IDENTICAL


def test_the_page_names_first_the_code_that_most_of_what_differs_has_in_common(pair):
    changes = {"fig05": "a.py b.py", "fig08": "a.py c.py", "fig09": "b.py c.py"}
    for name, files in changes.items():
        for folder, digest in ((pair.record, "1f0e"), (pair.new, "2a2a")):
            code = "\n".join(f"{digest} {file}" for file in files.split())
            data = pair.dataset(name).assign_attrs(provenance_code=code)
            if folder == pair.new and name != "fig09":
                data.phase.values[1, 40] += 1e-3
            write_dataset(data, folder / "figures" / f"{name}.nc")
    first, *_ = summary_of_changes(pair.compare())
    assert first.startswith("changed code (") and first.endswith(
        "a.py (2, 0), b.py (1, 1), c.py (1, 1)"
    )
    page = differences_html(pair.compare())
    assert page.index(first) < page.index('id="fig05"')

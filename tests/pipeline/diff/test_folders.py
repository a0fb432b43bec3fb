"""Texts, pictures and folders with typical falsifications, and the reports on them."""

import os
import shutil
from itertools import product
from pathlib import Path

import numpy as np
import pytest
from PIL import Image, ImageDraw
from PIL.PngImagePlugin import PngInfo

from bouncing_ball.datasets.files import read_dataset, write_dataset
from bouncing_ball.errors import ModelError
from bouncing_ball.pipeline.diff import folders as parts
from bouncing_ball.pipeline.diff.datasets import PICTURE
from bouncing_ball.pipeline.diff.folders import compare_folders, compare_pictures
from bouncing_ball.pipeline.diff.outcome import Outcome
from bouncing_ball.pipeline.diff.page import note, to_html, to_terminal
from bouncing_ball.pipeline.diff.texts import compare_texts

ROOT = Path(__file__).resolve().parents[3]


def test_equal_folders_are_identical_and_every_file_is_compared(pair):
    comparison = pair.compare()
    assert comparison.outcome is Outcome.IDENTICAL and comparison.outcome.status == 0
    compared = {part.name for found in comparison.parts for part in found.parts}
    paths = (path for path in pair.record.rglob("*") if path.is_file())
    assert compared == {path.relative_to(pair.record).as_posix() for path in paths}


def test_what_engines_gave_is_compared_where_they_ran(pair, refusal):
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
def test_a_falsified_word_or_number(pair, file, old, new):
    pair.rewrite(file, old, new)
    part = pair.part(file)
    (row,) = part.parts
    assert row.outcome is Outcome.DRIFTED and pair.compare().outcome.status == 1
    assert old.strip("<!- $") in row.record and new.strip("<!- $") in row.new


def test_a_page_is_compared_but_for_its_commit(pair):
    for file, folder in product(("explorer.nc", "explorer.html"), (pair.record, pair.new)):
        shutil.copyfile(ROOT / "figures" / file, folder / "figures" / file)
    pair.rewrite("figures/explorer.html", '{"commit": "', '{"commit": "c0ffee')
    assert pair.part("figures/explorer.html").outcome is Outcome.IDENTICAL
    pair.rewrite("figures/explorer.html", '"spring-damper", 0.5, 80', '"spring-damper", 0.5, 81')
    assert pair.part("figures/explorer.html").outcome is Outcome.DRIFTED


def test_a_last_digit_moves_only_with_its_data(pair):
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


def test_lines_that_are_new_or_gone():
    record, new = "a 1\nb 2\nc 3", "a 1\nnew\nb 2.5\nc 3"
    found = compare_texts(record, new, None)
    assert [(line.record, line.new) for line in found] == [(None, "new"), ("b 2", "b 2.5")]
    found = compare_texts(new, record, None)
    assert [(line.name, line.record, line.new) for line in found] == [
        ("line 2", "new", None),
        ("line 3", "b 2.5", "b 2"),
    ]


def save_png(path, picture: Image.Image, **text: str) -> None:
    info = PngInfo()
    for key, value in text.items():
        info.add_text(key, value)
    picture.save(path, "PNG", pnginfo=info)


def test_a_changed_label_and_a_swapped_picture(pair):
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


def test_pictures_by_their_pixels():
    grey = np.full((40, 50, 3), 100, dtype=np.int16)
    assert compare_pictures(grey, grey) == []
    for moved, outcome in ((1, Outcome.WITHIN), (2, Outcome.DRIFTED)):
        (found,) = compare_pictures(grey, grey + moved)
        assert (found.outcome, found.share) == (outcome, moved / PICTURE)
    (found,) = compare_pictures(grey, grey[:, :-1])
    assert (found.outcome, found.record, found.new) == (Outcome.STRUCTURE, "50 × 40", "49 × 40")


def test_a_picture_by_another_matplotlib_is_only_reported(pair):
    path = pair.new / "figures" / "fig08.png"
    with Image.open(path) as picture:
        turned = picture.transpose(Image.Transpose.ROTATE_180)
    save_png(path, turned)
    assert pair.artifact("fig08").outcome is Outcome.DRIFTED
    save_png(path, turned, provenance_versions='{"matplotlib": "0.1"}')
    assert pair.artifact("fig08").outcome is Outcome.WITHIN
    assert "drawn by matplotlib 3." in to_terminal(pair.compare())


def test_missing_and_extra(pair):
    (pair.new / "figures" / "fig08.png").unlink()
    (pair.record / "figures" / "fig05.svg").unlink()
    (pair.new / "paper.md").unlink()
    outcomes = {found.name: str(found.outcome) for found in pair.compare().parts}
    assert outcomes.pop("fig08") == outcomes.pop("paper") == "missing"
    assert outcomes.pop("fig05") == "extra" and set(outcomes.values()) == {"identical"}


def linked(path):
    path.rename(path.with_name("elsewhere"))
    path.symlink_to("elsewhere")


def damaged(path):
    content = path.read_bytes()
    path.write_bytes(content[: len(content) // 2])


def a_pipe(path):
    path.unlink()
    os.mkfifo(path)


def large(path):
    os.truncate(path, parts.MAX_BYTES + 1)


def a_bomb(path):
    save_png(path, Image.new("1", (14_000, 13_000)))


EVERY = ("figures/fig05.nc", "figures/fig05.png", "figures/table1.csv", "paper.md")


@pytest.mark.parametrize(
    ("change", "why", "file"),
    [
        *((linked, "a link", file) for file in EVERY),
        *((a_pipe, "not a regular file", file) for file in EVERY),
        *((large, "larger than", file) for file in EVERY),
        *((damaged, "", file) for file in EVERY[:2]),
        (a_bomb, "exceeds limit", "figures/fig05.png"),
    ],
)
@pytest.mark.parametrize("side", ["record", "new"])
def test_what_cannot_be_read_could_not_be_compared(pair, change, why, file, side):
    change(getattr(pair, side) / file)
    part, comparison = pair.part(file), pair.compare()
    assert part.outcome is Outcome.UNREADABLE and why in note(part) and "\n" not in note(part)
    assert comparison.outcome.status == 2
    # The others are compared all the same.
    others = {found.outcome for found in comparison.parts[1:]}
    assert others <= {Outcome.IDENTICAL, Outcome.EXTRA, Outcome.MISSING}


def test_a_folder_that_is_a_link(pair, refusal):
    linked(pair.new / "figures")
    with refusal(ModelError, "figures: a link; links are not followed"):
        pair.compare()


def test_nothing_is_printed_raw(pair, outcome):
    name = "fig\x1b[2J\n.md"
    (pair.new / "figures" / name).write_text("\x1b]0;\x07", encoding="utf-8")
    (pair.new / "paper.md").write_text("\x1b[2J\u202e<script>\n", encoding="utf-8")
    page = pair.new / "page.html"
    status, out, err = outcome("diff", str(pair.record), str(pair.new), "--html", str(page))
    assert status == 1 and err == ""
    for text in (out, page.read_text(encoding="utf-8")):
        assert text.replace("\n", "").isprintable() and "\\x1b[2J" in text
    assert "<script" not in page.read_text(encoding="utf-8")


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


def test_the_table_and_the_page(pair):
    data = pair.dataset("fig05")
    data.phase.values[1, 40] += 1e-3
    pair.write("fig05", data)
    pair.rewrite("paper.md", "reproduced", "contradicted")
    comparison = pair.compare()
    lines = to_terminal(comparison).splitlines()
    assert lines[0].split() == ["artifact", "outcome", "of", "budget", "what"]
    place = "figures/fig05.nc phase at case = 1, frequency_ratio = 2.51189: "
    assert lines[1].startswith("fig05 ") and place in lines[1] and " → " in lines[1]
    assert lines[1].endswith(": 1 of 1204 entries beyond the budget")
    assert lines[2].startswith("paper ") and "drifted" in lines[2] and "line " in lines[2]
    assert lines[3:] == ["2 drifted, 5 identical. The new artifacts differ from the record."]
    page = to_html(comparison)
    assert "<mark>contradicted</mark>" in page and "frequency_ratio = 2.51189" in page
    assert page.index('id="fig05"') < page.index('id="paper"') < page.index('id="fig01"')
    assert compare_folders(pair.record, pair.new, ["fig08"]).outcome is Outcome.IDENTICAL

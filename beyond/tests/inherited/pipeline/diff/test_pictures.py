"""Pictures and texts that differ in known ways."""

import re
from pathlib import Path

import pytest
from PIL import Image, ImageDraw

from bouncing_ball_beyond.inherited.pipeline.diff.outcome import Outcome
from bouncing_ball_beyond.inherited.pipeline.diff.pictures import compare_drawings, compare_pixels
from bouncing_ball_beyond.inherited.pipeline.diff.texts import compare_texts

SVG = (Path(__file__).with_name("record") / "figures" / "fig05.svg").read_text(encoding="utf-8")
CURVE = re.search(r'    <path d="[^"]*" clip-path[^>]*/>\n', SVG)[0]
COLOUR = re.search("stroke: (#[0-9a-f]{6})", CURVE)[1]
NUMBER = re.search(r"L (\d+\.\d{6})", SVG)[1]
LEVEL = re.search(r"(L [\d.]+ [\d.]+ )\n(L [\d.]+ )", CURVE)


@pytest.fixture
def pixels(tmp_path):
    """``pixels(new, …)``: the outcome of a picture against a figure of two lines and a label."""
    figure = Image.new("RGB", (400, 300), "white")
    draw = ImageDraw.Draw(figure)
    draw.line((20, 280, 380, 30), fill="blue", width=3)
    draw.line((20, 150, 380, 250), fill="black", width=3)
    draw.text((200, 20), "0.5", fill="black", font_size=30)
    figure.save(tmp_path / "record.png")

    def outcome_of(change, *, moved=False, redrawn=False):
        new = change(figure.copy())
        new.save(tmp_path / "new.png")
        files = (tmp_path / "record.png", tmp_path / "new.png")
        rows = compare_pixels(*files, moved=moved, redrawn=redrawn)
        return str(rows[0].outcome) if rows else "identical"

    return outcome_of


def brighter(by):
    return lambda figure: figure.point(lambda level: max(0, level - by))


def patch(size, colour):
    def change(figure):
        ImageDraw.Draw(figure).rectangle((100, 100, 99 + size, 99 + size), fill=colour)
        return figure

    return change


def white(size):
    return lambda figure: Image.new("RGB", size, "white")


def label(figure):
    draw = ImageDraw.Draw(figure)
    draw.rectangle((190, 15, 250, 60), fill="white")
    draw.text((200, 20), "0.6", fill="black", font_size=30)
    return figure


def shifted(figure):
    return figure.transform(
        figure.size, Image.Transform.AFFINE, (1, 0, 1, 0, 1, 1), fillcolor="white"
    )


@pytest.mark.parametrize(
    ("change", "still", "moved", "redrawn"),
    [
        (lambda figure: figure, "identical", "identical", "identical"),
        (brighter(1), "rounding", "rounding", "rounding"),
        (brighter(2), "drifted", "drifted", "rounding"),
        # One pixel of a hundred thousand, of which the mean says nothing.
        (patch(1, (253, 253, 253)), "drifted", "rounding", "rounding"),
        (patch(3, "black"), "drifted", "drifted", "rounding"),
        (label, "drifted", "drifted", "rounding"),
        # As another version of matplotlib does it.
        (shifted, "drifted", "drifted", "rounding"),
        (lambda figure: figure.transpose(Image.Transpose.ROTATE_180), *["drifted"] * 3),
        (white((400, 300)), *["drifted"] * 3),
        (white((10, 10)), *["changed structure"] * 3),
        (lambda figure: figure.crop((0, 0, 399, 300)), *["changed structure"] * 3),
    ],
)
def test_a_picture_keeps_its_pixels_or_moves_by_rounding(pixels, change, still, moved, redrawn):
    assert pixels(change) == still
    assert pixels(change, moved=True) == moved
    assert pixels(change, redrawn=True) == redrawn


@pytest.fixture
def drawn(tmp_path):
    """``drawn(old, new, …)``: the rows of a drawing in which a text is replaced."""

    def rows(old, new, **about):
        files = (tmp_path / "record.svg", tmp_path / "new.svg")
        assert old in SVG
        for path, text in zip(files, (SVG, SVG.replace(old, new)), strict=True):
            path.write_text(text, encoding="utf-8")
        return compare_drawings(*files, **{"moved": False, "redrawn": False} | about)

    return rows


@pytest.mark.parametrize("moved", [False, True])
@pytest.mark.parametrize(
    ("old", "new"),
    [
        (CURVE, ""),
        (COLOUR, "#123456"),
        ("</svg>", "<script>alert(1)</script></svg>"),
        ("<!-- $", "<!-- 2$"),
        # A glyph is drawn in place of another.
        ('Regular-14"/>', 'Regular-15"/>'),
        (NUMBER, f"{float(NUMBER) + 0.01:.6f}"),
    ],
)
def test_a_vector_graphic_is_compared_with_its_words_curves_and_colours(drawn, old, new, moved):
    (row,) = drawn(old, new, moved=moved)
    assert row.outcome is Outcome.DRIFTED and " → " in row.told


def test_numbers_of_a_drawing_move_by_rounding_and_a_little_if_its_data_did(drawn):
    assert drawn("provenance_commit", "provenance_other") == []
    name = re.search(r'id="([a-z][0-9a-f]{10})"', SVG)[1]
    assert drawn(name, f"{name[:1]}0123456789") == []
    for by, outcomes in ((1e-6, ("rounding", "rounding")), (5e-4, ("drifted", "rounding"))):
        new = f"{float(NUMBER) + by:.6f}"
        found = [drawn(NUMBER, new, moved=moved)[0].outcome for moved in (False, True)]
        assert tuple(map(str, found)) == outcomes


def test_a_curve_may_have_another_point_on_it_if_its_data_moved(drawn):
    first, second = LEVEL[1], LEVEL[0]
    (row,) = drawn(second, second.replace("\n", f"\n{first}\n", 1), moved=True)
    assert row.outcome is Outcome.ROUNDING
    # Beside the curve, in two parts, or with another colour it is another one.
    x, y = map(float, first.split()[1:])
    beside = f"\nL {x} {y + 0.01:.6f} \n"
    for new in (beside, f"\n{first.replace('L', 'M')}\n"):
        assert drawn(second, second.replace("\n", new, 1), moved=True)[0].outcome == "drifted"


def test_by_another_matplotlib_a_drawing_keeps_its_size_and_its_words(drawn):
    assert drawn(CURVE, "", redrawn=True) == []
    for old, new in (("<!-- $", "<!-- 2$"), ('width="244.8pt"', 'width="244.9pt"')):
        assert drawn(old, new, redrawn=True)[0].outcome is Outcome.DRIFTED


@pytest.mark.parametrize(
    ("record", "new", "told"),
    [
        ("a 1\nb 2\nc 3", "a 1\nnew\nb 2.5\nc 3", ["nothing → new", "b 2 → b 2.5"]),
        ("a 1\nnew\nb 2.5\nc 3", "a 1\nb 2\nc 3", ["new → nothing", "b 2.5 → b 2"]),
    ],
)
def test_a_line_that_is_new_or_gone_has_no_counterpart(record, new, told):
    found = compare_texts(record, new, moved=False)
    assert [row.told.partition(": ")[2] for row in found] == told


def test_a_line_that_is_added_to_a_long_table_is_the_only_difference():
    rows = [f"| {number} |" for number in range(300)]
    (found,) = compare_texts("\n".join(rows), "\n".join(["| new |", *rows]), moved=False)
    assert found.told == "line 1: nothing → | new |"


def test_a_text_of_many_equal_lines_is_compared_in_a_moment():
    found = compare_texts("a\n" * 20_000, "b\n" + "a\nb\n" * 10_000, moved=False)
    assert len(found) > 10_000

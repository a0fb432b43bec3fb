"""The comparison of pictures: PNG files by their pixels, SVG files by all that they draw.

A picture may move only if its data did, and then by what rounding does to it, which changes a pixel
by two grey levels at most, and no number of an SVG file but for the names that follow from all
numbers (Figs. 1 to 16 with parameters that are moved by units in the last place).

Another version of matplotlib places texts and lines anew. A picture by it must have the same size,
the same words, and its ink at the same places. Between matplotlib 3.10.8 and 3.11.2 the places have
a correlation of 0.84 at the least, and two figures of one size 0.59 at the most.
"""

import re
from itertools import zip_longest
from pathlib import Path

import numpy as np
from PIL import Image

from bouncing_ball_beyond.inherited.pipeline.diff.datasets import to_segments
from bouncing_ball_beyond.inherited.pipeline.diff.outcome import Outcome, Row
from bouncing_ball_beyond.inherited.pipeline.diff.texts import NUMBER, excerpt

PIXEL = 1
"""The largest change of a pixel, in grey levels, if the data of the picture did not move.

A picture is drawn on a grid of 1/256 of a pixel. A rounding error moves a point to the next place
of this grid at most, and this changes a pixel by one grey level."""

PICTURE = 1.0
"""The largest root mean square difference of two pictures whose data moved, in grey levels."""

BLOCK = 10.0
"""The same of each square of 8 × 8 pixels: the next power of ten above ten times the 0.35 that
rounding does."""

POINT = 1e-3
"""The largest change of a number in an SVG file whose data moved, in points: twice 1e-6, the budget
of a branch, of 500 points, the width of a figure."""

LAST_DIGIT = 1.5e-6
"""The same if its data did not move: matplotlib writes six digits."""

INK = 0.75
"""The lowest correlation of the ink in squares of 64 × 64 pixels by two versions of matplotlib."""

# Characters of an element whose lines are compared, each point with each other line.
_LONGEST = 200_000
_PATH = re.compile(r'path d="([ML\s\d.eE+-]+)"(.*)', re.DOTALL)
# A name that matplotlib gives to a path, a clip or a marker; it follows from their contents.
_GENERATED = re.compile(r"\b[a-z][0-9a-f]{10}\b")


def _ink(path: Path) -> np.ndarray:
    """What is not white in a picture, shape (height, width, 3), in grey levels."""
    with Image.open(path, formats=["PNG"]) as picture:
        whole = picture.convert("RGBA")
    ground = Image.new("RGBA", whole.size, "white")
    return 255.0 - np.asarray(Image.alpha_composite(ground, whole).convert("RGB"), dtype=float)


def _squares(values: np.ndarray, side: int) -> np.ndarray:
    """The means of the squares into which an array of two axes is divided; the edges are filled."""
    filled = np.pad(values, [(0, -size % side) for size in values.shape])
    rows, columns = (size // side for size in filled.shape)
    return filled.reshape(rows, side, columns, side).mean(axis=(1, 3))


def compare_pixels(record: Path, new: Path, *, moved: bool, redrawn: bool) -> list[Row]:
    """A row if two PNG files differ.

    Parameters
    ----------
    record, new : Path
    moved : bool
        Whether the data of the picture moved within their budgets.
    redrawn : bool
        Whether the pictures are by two versions of matplotlib.

    Raises
    ------
    OSError
        If a file is damaged.
    """
    sizes = []
    for path in (record, new):
        with Image.open(path, formats=["PNG"]) as picture:
            sizes.append(f"{picture.width} × {picture.height}")
    if sizes[0] != sizes[1]:
        return [Row("pixels", Outcome.STRUCTURE, f"size in pixels: {' → '.join(sizes)}")]
    ink = [_ink(path) for path in (record, new)]
    change = ink[1] - ink[0]
    if not change.any():
        return []
    square = _squares(np.mean(change**2, axis=-1), 8)
    if redrawn:
        squares = [_squares(each.mean(axis=-1), 64).ravel() for each in ink]
        # A white picture has no correlation.
        with np.errstate(invalid="ignore", divide="ignore"):
            agrees = np.corrcoef(squares)[0, 1] >= INK
    elif moved:
        agrees = np.mean(change**2) <= PICTURE**2 and square.max() <= BLOCK**2
    else:
        agrees = np.abs(change).max() <= PIXEL
    row, column = 8 * np.array(np.unravel_index(np.argmax(square), square.shape))
    part = f"{100 * np.any(change != 0, axis=-1).mean():.2g} % of all pixels changed"
    told = f"{part}, most at {column} from the left and {row} from the top"
    return [Row("pixels", Outcome.ROUNDING if agrees else Outcome.DRIFTED, told)]


def _elements(path: Path) -> list[str]:
    """The elements of a vector graphic without its metadata, and its labels, which are comments."""
    head, _, rest = path.read_text(encoding="utf-8").partition("<metadata>")
    text = head + rest.partition("</metadata>")[2]
    names: dict[str, str] = {}
    text = _GENERATED.sub(lambda name: names.setdefault(name[0], f"name {len(names)}"), text)
    return [each.rstrip("\n ") for each in text.split("<")]


def _curves(element: str) -> tuple[str, list[np.ndarray]]:
    """What an element of straight lines is beside its points, and the points of each line."""
    found = _PATH.fullmatch(element)
    if not found or len(element) > _LONGEST:
        return element, []
    parts = (np.array(NUMBER.findall(part), dtype=float) for part in found[1].split("M")[1:])
    return found[2], [part[::2] + 1j * part[1::2] for part in parts]


def _is_near(record: str, new: str, distance: float) -> bool:
    """Whether two elements have the same words, and numbers that differ by a distance at most; or
    are lines as near to each other, with further points on them.

    Examples
    --------
    >>> bent, straight = 'path d="M 0 0 L 4 0.5 L 9 0"', 'path d="M 0 0 L 9 0"'
    >>> _is_near(bent, straight, 0.1), _is_near(bent.replace("0.5", "0.05"), straight, 0.1)
    (False, True)
    """
    if NUMBER.split(record) == NUMBER.split(new):
        numbers = [np.array(NUMBER.findall(each), dtype=float) for each in (record, new)]
        return bool(np.all(np.abs(numbers[1] - numbers[0]) <= distance))
    (rest, old), (new_rest, now) = _curves(record), _curves(new)
    if not old or rest != new_rest or len(old) != len(now):
        return False
    pairs = [*zip(old, now, strict=True), *zip(now, old, strict=True)]
    lines = [(points, np.append(line, line[-1])) for points, line in pairs]
    apart = [to_segments(each, line, np.arange(len(line) - 1)[None]) for each, line in lines]
    return all(np.all(each <= distance) for each in apart)


def compare_drawings(record: Path, new: Path, *, moved: bool, redrawn: bool) -> list[Row]:
    """A row if two SVG files draw something else; the parameters are those of
    :func:`compare_pixels`.

    Raises
    ------
    OSError, UnicodeDecodeError
        If a file is damaged.
    """
    old, now = (_elements(path) for path in (record, new))
    if redrawn:
        # The size of the whole, and the labels.
        kept = ("svg ", "!-- ")
        old, now = (sorted(x for x in each if x.startswith(kept)) for each in (old, now))
    distance = POINT if moved else LAST_DIGIT
    pairs = [pair for pair in zip_longest(old, now, fillvalue="") if pair[0] != pair[1]]
    apart = [pair for pair in pairs if not _is_near(*pair, distance)]
    if apart:
        labels = [pair for pair in apart if pair[0].startswith("!--")]
        told = excerpt(*(labels or apart)[0])
        return [Row("drawing", Outcome.DRIFTED, told, size=0.0, is_words=bool(labels))]
    return [Row("drawing", Outcome.ROUNDING, "numbers moved by rounding")] if pairs else []

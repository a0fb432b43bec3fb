"""Two pictures, pixel by pixel."""

import io
from pathlib import Path

import numpy as np
from PIL import Image, ImageFilter

from bouncing_ball.compare.outcome import Outcome, Row

BUDGET = 1.0
"""Root mean square difference allowed, in grey levels of 255.

Parameters that differ by two units in the last place, which changes every rounding as
another processor does, move the pixels of a figure by 0.092 at most (Fig. 15); of ten times
that, the next power of ten."""

_LEVELS = 255
# The colour of what has changed on the picture of the differences.
_INK = np.array([110, 0, 80])


def read_picture(path: Path) -> np.ndarray:
    """Red, green and blue of a PNG file on white, shape (height, width, 3)."""
    with Image.open(path, formats=["PNG"]) as picture:
        whole = picture.convert("RGBA")
    ground = Image.new("RGBA", whole.size, "white")
    return np.asarray(Image.alpha_composite(ground, whole).convert("RGB"), dtype=np.int16)


def _difference(record: np.ndarray, changed: np.ndarray) -> bytes:
    """The record in light grey, and on it each changed pixel, five wide to be seen."""
    wide = np.asarray(Image.fromarray(changed).convert("L").filter(ImageFilter.MaxFilter(5)))
    ground = _LEVELS - (_LEVELS - record.mean(axis=-1, keepdims=True)) / 4
    file = io.BytesIO()
    drawn = np.where(wide[..., np.newaxis] > 0, _INK, ground)
    Image.fromarray(drawn.astype(np.uint8)).save(file, "PNG")
    return file.getvalue()


def compare_pictures(record: np.ndarray, new: np.ndarray) -> tuple[list[Row], bytes | None]:
    """Two pictures by their pixels, as :func:`read_picture` gives them, and their difference.

    The difference is a PNG file: the record in light grey, and on it what has changed.
    """
    if record.shape != new.shape:
        old, now = (f"{shape[1]} × {shape[0]}" for shape in (record.shape, new.shape))
        return [Row("size in pixels", Outcome.STRUCTURE, old, now)], None
    changed = (new != record).any(axis=-1)
    if not changed.any():
        return [], None
    share = float(np.sqrt(np.mean((new - record).astype(float) ** 2))) / BUDGET
    outcome = Outcome.WITHIN if share <= 1 else Outcome.DRIFTED
    note = f"{changed.sum()} of {changed.size} changed"
    return [Row("pixels", outcome, share=share, note=note)], _difference(record, changed)

"""The comparison of two pictures, pixel by pixel."""

from pathlib import Path

import numpy as np
from PIL import Image

from bouncing_ball.compare.outcome import Outcome, Row

BUDGET = 1.0
"""Root mean square difference allowed, in grey levels of 255.

Parameters that differ by two units in the last place, which change every rounding as another
processor does, move the pixels of a figure by 0.092 at most (Fig. 15). The budget is the power of
ten next above ten times that."""


def read_picture(path: Path) -> np.ndarray:
    """Red, green and blue of a PNG file on white, shape (height, width, 3), as 16-bit integers.

    Raises
    ------
    OSError
        If the file is missing or damaged.
    """
    with Image.open(path, formats=["PNG"]) as picture:
        whole = picture.convert("RGBA")
    ground = Image.new("RGBA", whole.size, "white")
    return np.asarray(Image.alpha_composite(ground, whole).convert("RGB"), dtype=np.int16)


def compare_pictures(record: np.ndarray, new: np.ndarray) -> list[Row]:
    """The difference of two pictures of :func:`read_picture`: no row if all pixels are identical.

    Examples
    --------
    >>> black = np.zeros((1, 2, 3), dtype=np.int16)
    >>> [(row.name, str(row.outcome)) for row in compare_pictures(black, black + 255)]
    [('pixels', 'drifted')]
    """
    if record.shape != new.shape:
        old, now = (f"{shape[1]} × {shape[0]}" for shape in (record.shape, new.shape))
        return [Row("size in pixels", Outcome.STRUCTURE, old, now)]
    changed = (new != record).any(axis=-1)
    if not changed.any():
        return []
    share = float(np.sqrt(np.mean((new - record).astype(float) ** 2))) / BUDGET
    outcome = Outcome.WITHIN if share <= 1 else Outcome.DRIFTED
    return [Row("pixels", outcome, share=share, note=f"{changed.sum()} of {changed.size} changed")]

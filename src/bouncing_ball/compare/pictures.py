"""The comparison of two pictures, pixel by pixel."""

from pathlib import Path

import numpy as np
from PIL import Image

from bouncing_ball.compare.budgets import PICTURE
from bouncing_ball.compare.outcome import Outcome, Row


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


def compare_pictures(record: np.ndarray, new: np.ndarray, budget: float = PICTURE) -> list[Row]:
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
    share = float(np.sqrt(np.mean((new - record).astype(float) ** 2))) / budget
    outcome = Outcome.WITHIN if share <= 1 else Outcome.DRIFTED
    return [Row("pixels", outcome, share=share, note=f"{changed.sum()} of {changed.size} changed")]

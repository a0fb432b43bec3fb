"""Two pictures, pixel by pixel."""

import io
import warnings
from dataclasses import dataclass

import numpy as np
from PIL import Image, ImageFilter, UnidentifiedImageError

from bouncing_ball.compare.files import UnreadableError
from bouncing_ball.compare.outcome import Outcome

BUDGET = 1.0
"""Root mean square difference allowed, in grey levels of 255.

Parameters that differ by two units in the last place, which changes every rounding as
another processor does, move the pixels of a figure by 0.092 at most (Fig. 15); of ten times
that, the next power of ten."""

MAX_PIXELS = 2**23
"""Pixels of a picture, four times those of the largest."""
_LEVELS = 255
# The colour of what has changed on the picture of the differences.
_INK = np.array([110, 0, 80])


@dataclass(frozen=True)
class PictureResult:
    """The result for a picture.

    ``difference`` is a PNG file: the record in light grey, and on it what has changed.
    """

    outcome: Outcome
    share: float | None = None
    note: str = ""
    difference: bytes | None = None


def read_picture(content: bytes) -> np.ndarray:
    """Red, green and blue of a PNG file on white, shape (height, width, 3).

    Raises
    ------
    UnreadableError
        If it is not a whole PNG file, or has more than :data:`MAX_PIXELS`.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            picture = Image.open(io.BytesIO(content), formats=["PNG"])
            # The head is read, and not yet the pixels: a small file may have many.
            if picture.width * picture.height > MAX_PIXELS:
                raise UnreadableError("too large a picture")
            whole = picture.convert("RGBA")
    except (Image.DecompressionBombError, Image.DecompressionBombWarning):
        raise UnreadableError("too large a picture") from None
    except UnidentifiedImageError:
        raise UnreadableError("not a PNG file") from None
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


def compare_pictures(record: np.ndarray, new: np.ndarray) -> PictureResult:
    """Two pictures by their pixels, as :func:`read_picture` gives them."""
    if record.shape != new.shape:
        sizes = " → ".join(f"{shape[1]} × {shape[0]}" for shape in (record.shape, new.shape))
        return PictureResult(Outcome.STRUCTURE, note=f"size in pixels: {sizes}")
    rms = float(np.sqrt(np.mean((new - record).astype(float) ** 2)))
    if rms == 0:
        return PictureResult(Outcome.IDENTICAL, 0.0)
    changed = (new != record).any(axis=-1)
    return PictureResult(
        Outcome.WITHIN if rms <= BUDGET else Outcome.DRIFTED,
        rms / BUDGET,
        f"rms {rms:.2g} of 255, {changed.sum()} of {changed.size} pixels changed",
        _difference(record, changed),
    )

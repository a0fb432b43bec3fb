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
# The colour of what has changed on the picture of the differences, and the least of its cover.
_INK = np.array([110, 0, 80])
_FAINTEST = 128


@dataclass(frozen=True)
class PictureResult:
    """The result for a picture.

    ``difference`` is a PNG file: the record in light grey, and over it what has
    changed, the darker the more.
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


def _difference(record: np.ndarray, distance: np.ndarray) -> bytes:
    """The record in light grey with what has changed on it.

    Every changed pixel is drawn five wide, and so dark that it can be seen in a
    picture that is shown smaller than it is.
    """
    factor = max(1, _LEVELS // int(distance.max()))
    strength = np.where(distance > 0, np.maximum(factor * distance, _FAINTEST), 0)
    wide = Image.fromarray(strength.astype(np.uint8)).filter(ImageFilter.MaxFilter(5))
    cover = np.asarray(wide)[..., None] / _LEVELS
    ground = _LEVELS - (_LEVELS - record.mean(axis=-1, keepdims=True)) / 4
    mixed = (1 - cover) * ground + cover * _INK
    file = io.BytesIO()
    Image.fromarray(mixed.round().astype(np.uint8)).save(file, "PNG")
    return file.getvalue()


def compare_pictures(record: np.ndarray, new: np.ndarray) -> PictureResult:
    """Two pictures by their pixels, as :func:`read_picture` gives them."""
    if record.shape != new.shape:
        sizes = " → ".join(f"{shape[1]} × {shape[0]}" for shape in (record.shape, new.shape))
        return PictureResult(Outcome.STRUCTURE, note=f"size in pixels: {sizes}")
    rms = float(np.sqrt(np.mean((new - record).astype(float) ** 2)))
    if rms == 0:
        return PictureResult(Outcome.IDENTICAL, 0.0)
    distance = np.abs(new - record).max(axis=-1)
    changed = int(np.count_nonzero(distance))
    return PictureResult(
        Outcome.WITHIN if rms <= BUDGET else Outcome.DRIFTED,
        rms / BUDGET,
        f"rms {rms:.2g} of 255, {changed} of {distance.size} pixels changed",
        _difference(record, distance),
    )

"""Two pictures, pixel by pixel."""

import io
from dataclasses import dataclass

import numpy as np
from matplotlib.testing.compare import calculate_rms
from PIL import Image, ImageFilter, UnidentifiedImageError

from bouncing_ball.compare.outcome import Outcome
from bouncing_ball.record.reading import MAX_PIXELS, UnreadableError, reason

# Grey levels of a pixel.
_LEVELS = 255
# What has changed on the picture of the differences: its colour, and the least of its cover.
_INK = np.array([110, 0, 80])
_FAINTEST = 128


@dataclass(frozen=True)
class PictureResult:
    """What became of a picture.

    ``rms`` is the root mean square difference in grey levels of 255, None if
    the sizes differ; ``changed`` the number of pixels that are not the same, of
    ``pixels``. ``difference`` is a PNG file: the record in light grey, and over it
    what has changed, darker the more, the differences multiplied by ``amplified``.
    """

    outcome: Outcome
    rms: float | None = None
    share: float | None = None
    changed: int = 0
    pixels: int = 0
    difference: bytes | None = None
    amplified: int = 1
    note: str = ""


def read_picture(content: bytes) -> Image.Image:
    """A PNG file, decoded; what it says of itself is its ``info``.

    Raises
    ------
    UnreadableError
        If it is not a whole PNG file, or has more than ``MAX_PIXELS``.
    """
    try:
        picture = Image.open(io.BytesIO(content), formats=["PNG"])
        # The head is read, and not yet the pixels: a small file may have many.
        if picture.width * picture.height > MAX_PIXELS:
            raise UnreadableError("too large a picture")
        picture.load()
    except (Image.DecompressionBombError, Image.DecompressionBombWarning):
        raise UnreadableError("too large a picture") from None
    except UnidentifiedImageError:
        # Its own message holds an address in memory.
        raise UnreadableError("not a PNG file") from None
    except (OSError, SyntaxError) as error:
        raise UnreadableError(f"not a whole PNG file: {reason(error)}") from None
    return picture


def _pixels(picture: Image.Image) -> np.ndarray:
    """Red, green and blue on white, shape (height, width, 3)."""
    whole = picture.convert("RGBA")
    ground = Image.new("RGBA", whole.size, "white")
    return np.asarray(Image.alpha_composite(ground, whole).convert("RGB"), dtype=np.int16)


def _difference(record: np.ndarray, distance: np.ndarray) -> tuple[bytes, int]:
    """The record in light grey with what has changed on it, and the factor that shows it.

    Every changed pixel is drawn five wide, and so dark that it can be seen in a
    picture that is shown smaller than it is.
    """
    factor = max(1, _LEVELS // int(distance.max()))
    strength = np.where(distance > 0, np.maximum(factor * distance, _FAINTEST), 0)
    wide = Image.fromarray(strength.astype(np.uint8)).filter(ImageFilter.MaxFilter(5))
    cover = np.asarray(wide)[..., None] / _LEVELS
    ground = _LEVELS - (_LEVELS - record.mean(axis=-1, keepdims=True)) / 4
    file = io.BytesIO()
    mixed = (1 - cover) * ground + cover * _INK
    Image.fromarray(mixed.round().astype(np.uint8)).save(file, "PNG")
    return file.getvalue(), factor


def compare_pictures(record: Image.Image, new: Image.Image, budget: float) -> PictureResult:
    """Two pictures by their pixels; what else is in the files does not count.

    Parameters
    ----------
    record, new : Image
        As :func:`read_picture` gives them.
    budget : float
        Root mean square allowed, in grey levels of 255.
    """
    if new is record:  # the same bytes
        return PictureResult(Outcome.IDENTICAL, 0.0, 0.0)
    before, after = _pixels(record), _pixels(new)
    if before.shape != after.shape:
        sizes = " → ".join(f"{shape[1]} × {shape[0]}" for shape in (before.shape, after.shape))
        return PictureResult(Outcome.STRUCTURE, note=f"size in pixels: {sizes}")
    rms = float(calculate_rms(before, after))
    if rms == 0:
        return PictureResult(Outcome.IDENTICAL, 0.0, 0.0)
    outcome = Outcome.WITHIN if rms <= budget else Outcome.DRIFTED
    distance = np.abs(after - before).max(axis=-1)
    changed = int(np.count_nonzero(distance))
    note = f"rms {rms:.2g} of 255, {changed} of {distance.size} pixels changed"
    drawn = _difference(before, distance)
    return PictureResult(outcome, rms, rms / budget, changed, distance.size, *drawn, note)

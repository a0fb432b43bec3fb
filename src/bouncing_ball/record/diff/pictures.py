"""Two pictures, pixel by pixel."""

import io
import warnings
from dataclasses import dataclass

import numpy as np
from matplotlib.testing.compare import calculate_rms
from PIL import Image, UnidentifiedImageError

from bouncing_ball.record.diff.outcome import Outcome

# Grey levels of a pixel.
_LEVELS = 255
VERSIONS = "provenance_versions"
"""Under which name a file holds the versions of the software it was made with: text
chunk of a picture, global attribute of a dataset."""


class PictureError(ValueError):
    """A file that is no picture, or half of one."""


@dataclass(frozen=True)
class PictureResult:
    """What became of a picture.

    ``rms`` is the root mean square difference in grey levels of 255, None if
    the sizes differ; ``difference`` a PNG file, dark where the two differ,
    the differences multiplied by ``amplified``.
    """

    outcome: Outcome
    rms: float | None = None
    share: float | None = None
    difference: bytes | None = None
    amplified: int = 1
    note: str = ""


def _opened(content: bytes) -> Image.Image:
    try:
        with warnings.catch_warnings():
            # A damaged file is an error here, whatever else is said about it.
            warnings.simplefilter("ignore")
            # A picture so large that to open it may take all memory.
            warnings.simplefilter("error", Image.DecompressionBombWarning)
            picture = Image.open(io.BytesIO(content), formats=["PNG"])
            picture.load()
    except (Image.DecompressionBombError, Image.DecompressionBombWarning):
        raise PictureError("too large a picture") from None
    except UnidentifiedImageError:
        # Its own message holds an address in memory.
        raise PictureError("not a PNG file") from None
    except (OSError, SyntaxError, ValueError) as error:
        raise PictureError(f"not a whole PNG file: {' '.join(str(error).split())[:80]}") from None
    return picture


def _pixels(picture: Image.Image) -> np.ndarray:
    """Red, green and blue on white, shape (height, width, 3)."""
    whole = picture.convert("RGBA")
    ground = Image.new("RGBA", whole.size, "white")
    return np.asarray(Image.alpha_composite(ground, whole).convert("RGB"), dtype=np.int16)


def versions_of(content: bytes) -> str | None:
    """The versions a PNG file says it was made with, None if it does not.

    Raises
    ------
    PictureError
        If it is no PNG file.
    """
    return _opened(content).info.get(VERSIONS)


def _difference(record: np.ndarray, new: np.ndarray) -> tuple[bytes, int]:
    """A grey PNG of the differences and the factor that makes them visible."""
    distance = np.abs(new - record).max(axis=-1)
    factor = max(1, _LEVELS // int(distance.max()))
    file = io.BytesIO()
    Image.fromarray((_LEVELS - factor * distance).astype(np.uint8)).save(file, "PNG")
    return file.getvalue(), factor


def compare_pictures(record: bytes, new: bytes, budget: float) -> PictureResult:
    """Two PNG files as decoded pictures; what else is in the files does not count.

    Parameters
    ----------
    record, new : bytes
        Contents of the files.
    budget : float
        Root mean square allowed, in grey levels of 255.

    Raises
    ------
    PictureError
        If they differ and one of them is no whole PNG file.
    """
    if record == new:
        return PictureResult(Outcome.IDENTICAL, 0.0, 0.0)
    before, after = _pixels(_opened(record)), _pixels(_opened(new))
    if before.shape != after.shape:
        sizes = " → ".join(f"{shape[1]} × {shape[0]}" for shape in (before.shape, after.shape))
        return PictureResult(Outcome.STRUCTURE, note=f"size in pixels: {sizes}")
    rms = float(calculate_rms(before, after))
    if rms == 0:
        return PictureResult(Outcome.IDENTICAL, 0.0, 0.0)
    outcome = Outcome.WITHIN if rms <= budget else Outcome.DRIFTED
    note = f"rms {rms:.2g} of 255"
    return PictureResult(outcome, rms, rms / budget, *_difference(before, after), note)

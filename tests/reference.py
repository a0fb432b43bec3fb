"""The datasets of the reference, which are read once for all tests."""

from functools import cache
from pathlib import Path

import xarray as xr

from bouncing_ball.datasets import read

FIGURES = Path(__file__).resolve().parents[1] / "figures"


@cache
def reference() -> dict[str, xr.Dataset]:
    """All datasets by name. They are not to be changed, but copied first."""
    return {path.stem: read(path) for path in FIGURES.glob("*.nc")}

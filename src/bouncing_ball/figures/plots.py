"""The figure of a labelled dataset, chosen by its kind, in the common style."""

from importlib import import_module
from pathlib import Path

import xarray as xr
from matplotlib.figure import Figure

from bouncing_ball.datasets.files import PICTURES, require_writable
from bouncing_ball.errors import ModelError
from bouncing_ball.figures.files import save
from bouncing_ball.figures.style import style

PLOTS = {
    "history": "histories.over_time",
    "branch": "branches.over_amplitude",
    "orbit": "sweeps.orbits",
    "limits": "sweeps.limits",
    "diagram": "diagram.orbit_diagram",
    "motions": "diagram.motions",
    "exponent": "diagram.exponent",
    "basins": "diagram.basins",
}
"""The function that draws each kind, as ``module.function`` of this package."""


def plot(data: xr.Dataset, path: str | Path | None = None) -> Figure:
    """The figure of a dataset whose attribute ``kind`` is in :data:`PLOTS`.

    If a path is given, the figure is written to this file.

    Raises
    ------
    ModelError
        If the kind has no figure, if the suffix of the path is not that of a picture, or if the
        file cannot be written.
    """
    kind = data.attrs.get("kind")
    if kind not in PLOTS:
        raise ModelError(f"a dataset of the kind {kind!r} has no figure: {', '.join(PLOTS)} have")
    module, name = PLOTS[kind].split(".")
    with style():
        figure = getattr(import_module(f"bouncing_ball.figures.{module}"), name)(data)
        if path is not None:
            write(figure, Path(path), f"bouncing-ball {kind}")
    return figure


def write(figure: Figure, path: Path, title: str) -> None:
    """Write a figure that a user has requested.

    Raises
    ------
    ModelError
        If the suffix of the path is not that of a picture, or the file cannot be written.
    """
    require_writable(path, PICTURES)
    try:
        save(figure, path, {"Title": title})
    except OSError as error:
        raise ModelError(f"{path} cannot be written: {error.strerror}") from None

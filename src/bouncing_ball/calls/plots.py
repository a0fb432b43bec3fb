"""The figure of a labelled dataset, chosen by its kind, in the common style."""

from importlib import import_module
from pathlib import Path

import xarray as xr
from matplotlib.figure import Figure

from bouncing_ball.drawing.files import write
from bouncing_ball.drawing.style import style
from bouncing_ball.errors import ModelError

PLOTS = {
    "history": "calls.figures.over_time",
    "branch": "paper.exhibits.continuation_of_orbits_figures.over_amplitude",
    "orbit": "calls.figures.orbits",
    "limits": "calls.figures.limits",
    "diagram": "calls.figures.orbit_diagram",
    "motions": "calls.figures.motions",
    "exponent": "calls.figures.exponent",
    "basins": "calls.figures.basins",
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
    module, name = PLOTS[kind].rsplit(".", 1)
    with style():
        figure = getattr(import_module(f"bouncing_ball.{module}"), name)(data)
        if path is not None:
            write(figure, Path(path), f"bouncing-ball {kind}")
    return figure

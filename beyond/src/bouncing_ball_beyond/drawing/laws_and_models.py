"""How pictures and tables show contact laws, the corrected model, and errors by quantity."""

import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from bouncing_ball_beyond.inherited.drawing import style
from bouncing_ball_beyond.inherited.drawing.canvas import WIDE, canvas
from bouncing_ball_beyond.inherited.drawing.labels import QUANTITIES
from bouncing_ball_beyond.inherited.drawing.style import COLOURS, Look
from bouncing_ball_beyond.inherited.drawing.tables import Column, text

CORRECTED = "#AA3A00"
MODELS: dict[str, Look] = {
    **style.MODELS,
    "corrected": {"color": CORRECTED, "linewidth": 1.2, "linestyle": (0, (4, 1.5))},
}
# Contact laws differ by their dashes as well as by their colours.
LAWS: dict[str, Look] = {
    "linear": {"color": COLOURS[0], "linestyle": "-"},
    "linear, force release": {"color": COLOURS[0], "linestyle": (0, (5, 1, 1, 1, 1, 1))},
    "hunt-crossley": {"color": COLOURS[1], "linestyle": (0, (4, 1.5))},
    "tsuji": {"color": COLOURS[2], "linestyle": (0, (6, 1.5, 1, 1.5))},
    "kuwabara-kono": {"color": COLOURS[3], "linestyle": (0, (2, 1))},
}
LAW_NAMES = {
    "restitution": "constant r",
    "linear": "linear",
    "linear, force release": "linear, force release",
    "hunt-crossley": "Hunt and Crossley",
    "tsuji": "Tsuji",
    "kuwabara-kono": "Kuwabara and Kono",
}
"""The names of contact laws for readers; a law without one here keeps its own."""


def law_name(name: str) -> Column:
    """The column of a variable with the names of contact laws, for readers.

    Examples
    --------
    >>> from bouncing_ball_beyond.inherited.drawing.tables import text_table
    >>> text_table([xr.Dataset({"law": "hunt-crossley"})], {"law": law_name("law")})[1]
    [['Hunt and Crossley']]
    """
    plain = text(name)
    return lambda part: LAW_NAMES.get(plain(part), plain(part))


def panels_by_quantity(
    data: xr.Dataset, height: float, xlabel: str
) -> tuple[Figure, dict[str, Axes]]:
    """Two rows of three panels, one for the errors of each quantity, with labels at the outside."""
    figure, slots = canvas(WIDE, height, 2, 3, sharex=True, sharey=True)
    for axes in slots.flat:
        axes.set(xlabel=xlabel, ylabel="relative error")
        axes.label_outer()
    quantities = map(str, data["quantity"].values)
    panels = dict(zip(quantities, slots.flat, strict=False))
    for quantity, axes in panels.items():
        axes.set_title(QUANTITIES[quantity])
    return figure, panels

"""The look that all figures share: colours, lines, markers and matplotlib's settings."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from threading import RLock
from typing import Any

import matplotlib
import numpy as np
from matplotlib import colormaps
from matplotlib.colors import to_hex
from matplotlib.patheffects import withStroke

# Read once, because a context that is given the file reads it again and imports matplotlib.style.
_FILE = Path(__file__).with_name("style.mplstyle")
_SETTINGS = matplotlib.rc_params_from_file(_FILE, use_default_template=False)
# The hues of Okabe and Ito, which colour-blind readers can distinguish, darkened to a
# contrast of at least 3:1 with white, in an order in which neighbours differ in
# greyscale too (grey levels 0, 87, 132, 85, 130).
COLOURS = ("#000000", "#0072B2", "#C77C00", "#AA3A00", "#3F96CC")
# Above this share of the colour map the contrast with white is below 3:1.
_DARKEST = 0.55
RESTITUTION = "#000000"
CONTACT = "#0072B2"
TABLE = "#8c8c8c"
Look = dict[str, Any]
"""Keywords of a line or a marker."""

ARROW: Look = {
    "arrowstyle": "-|>",
    "color": "black",
    "linewidth": 0.9,
    "mutation_scale": 9,
    "shrinkA": 0,
    "shrinkB": 0,
}
GUIDE: Look = {"color": "#8c8c8c", "linewidth": 0.7, "linestyle": (0, (1, 1.5))}
# The dashes of curves that are compared, which tell them apart in grey; the guides are dotted.
DASHES = ("-", (0, (7, 2)), (0, (5, 1.5, 1, 1.5)), (0, (2, 1.2)), (0, (5, 1, 1, 1, 1, 1)))
# Branches of orbits, by their stability and admissibility.
LINES: dict[str, Look] = {
    "stable": {"linestyle": "-", "linewidth": 1.3},
    "unstable": {"linestyle": (0, (3.5, 2)), "linewidth": 1.0},
    "inadmissible": {"linestyle": (0, (0.8, 2.2)), "linewidth": 0.8},
}
_HOLLOW: Look = {
    "markersize": 5,
    "linestyle": "none",
    "markerfacecolor": "none",
    "markeredgewidth": 1.0,
}
# Special points of a branch; hollow, so that markers which coincide can all be seen. That of Eq. 8
# is inside that of the exact map.
MARKS: dict[str, Look] = {
    "saddle-node": {"marker": "o", **_HOLLOW},
    "period doubling": {"marker": "s", **_HOLLOW, "markersize": 6},
    "grazing of a flight": {"marker": "^", "markersize": 4.5, "linestyle": "none"},
    "grazing of a release": {"marker": "v", "markersize": 4.5, "linestyle": "none"},
    "period doubling, Eq. 8": {
        "marker": "x",
        "markersize": 2.4,
        "markeredgewidth": 0.8,
        "path_effects": [withStroke(linewidth=2.4, foreground="white")],
        "linestyle": "none",
    },
}
# The line of each model where several are compared; that of the contact is below the others.
MODELS: dict[str, Look] = {
    "spring-damper": {"color": CONTACT, "linewidth": 2.2, "alpha": 0.75},
    "restitution": {"color": RESTITUTION, "linewidth": 1.0},
}
LIMIT: Look = MODELS["restitution"] | {"linestyle": "--"}
"""The value of the restitution model, to which that of the contact tends along ϖ."""


def palette(count: int) -> Sequence[str]:
    """Colours for curves; more than ``COLOURS`` has are steps from dark to light.

    Examples
    --------
    >>> palette(2)
    ('#000000', '#0072B2')
    >>> len(set(palette(9)))
    9
    """
    if count <= len(COLOURS):
        return COLOURS[:count]
    shades = colormaps["viridis"](np.linspace(0.0, _DARKEST, count))
    return [to_hex(shade) for shade in shades]


# The settings of matplotlib belong to the whole process. If two threads changed them and changed
# them back at the same time, the settings of one would remain.
_DRAWING = RLock()


@contextmanager
def style() -> Iterator[None]:
    """The settings of ``style.mplstyle`` beside this module, to draw and save a figure.

    Threads draw one after another.
    """
    with _DRAWING, matplotlib.rc_context(_SETTINGS):
        yield

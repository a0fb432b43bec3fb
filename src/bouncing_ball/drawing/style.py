"""The look that all figures share: colours, lines, markers and matplotlib's settings."""

import tomllib
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Any

import matplotlib

# Read once, because a context that is given the file reads it again and imports matplotlib.style.
_FILE = Path(__file__).with_name("matplotlibrc")
_SETTINGS = matplotlib.rc_params_from_file(_FILE, use_default_template=False)
# The hues of Okabe and Ito, which colour-blind readers can distinguish, darkened to a
# contrast of at least 3:1 with white, in an order in which neighbours differ in
# greyscale too (grey levels 0, 87, 132, 85, 130).
COLOURS = ("#000000", "#0072B2", "#C77C00", "#AA3A00", "#3F96CC")
RESTITUTION = "#000000"
CONTACT = "#0072B2"
CORRECTED = "#AA3A00"
TABLE = "#8c8c8c"
Look = dict[str, Any]
"""Keywords of a line or a marker."""

ARROW: Look = {"arrowstyle": "-|>", "color": "black", "linewidth": 0.9, "mutation_scale": 9}
ARROW |= {"shrinkA": 0, "shrinkB": 0}
GUIDE: Look = {"color": "#8c8c8c", "linewidth": 0.7, "linestyle": (0, (1, 1.5))}


def _look(entry: Look) -> Look:
    return {key: (0, tuple(x)) if isinstance(x, list) else x for key, x in entry.items()}


_TABLES = tomllib.loads(Path(__file__).with_suffix(".toml").read_text(encoding="utf-8"))
LINES, MARKS, MODELS, LAWS = (
    {name: _look(entry) for name, entry in _TABLES[part].items()}
    for part in ("lines", "marks", "models", "laws")
)
"""Looks by name: branches of orbits, special points of a branch, models, contact laws."""


def style() -> AbstractContextManager[None]:
    """The settings of ``matplotlibrc`` beside this module, to draw and save a figure."""
    return matplotlib.rc_context(_SETTINGS)

"""The words on figures: quantities, parameters, notes."""

from typing import Any

import xarray as xr
from matplotlib.axes import Axes

QUANTITIES = {
    "max_height": r"greatest height $\max\,z$",
    "bounce_velocity": r"bouncing-off velocity $z'_b$",
    "phase": r"phase of impact $\varphi$",
    "apparent_restitution": r"apparent restitution $r_a$",
    "saddle_node": r"saddle-node $\Lambda_{SN}$",
    "period_doubling": r"period doubling $\Lambda_{PD}$",
    "permanent_contact": r"permanent contact",
}
"""The quantities compared between the models, as a title names them."""


def number(value: float) -> str:
    """A parameter as a label shows it.

    Examples
    --------
    >>> number(0.85), number(10000.0), number(250000.0)
    ('0.85', '10^{4}', '2.5\\\\times 10^{5}')
    """
    if value >= 1e4:
        mantissa, exponent = f"{value:e}".split("e")
        factor = "" if float(mantissa) == 1 else rf"{float(mantissa):g}\times "
        return f"{factor}10^{{{int(exponent)}}}"
    return f"{value:g}"


_SYMBOLS = {"n": "n", "restitution": "r", "amplitude": r"\Lambda", "frequency_ratio": r"\varpi"}


def parameters(data: xr.Dataset, *names: str, of: str = "") -> str:
    """Parameters of a dataset, as a title shows them; ``of`` begins their attributes' names.

    Examples
    --------
    >>> parameters(xr.Dataset(attrs={"n": 1, "restitution": 0.85}), "n", "restitution")
    '$n=1$, $r=0.85$'
    """
    return ", ".join(f"${_SYMBOLS[name]}={number(data.attrs[of + name])}$" for name in names)


def note(axes: Axes, text: str, point: Any, offset: Any, **look: Any) -> None:
    """A text at an offset in points from a point of the data."""
    axes.annotate(text, point, xytext=offset, textcoords="offset points", **look)

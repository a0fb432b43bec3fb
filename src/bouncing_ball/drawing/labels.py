"""The texts on figures: quantities, parameters, notes."""

from typing import Any

import xarray as xr
from matplotlib.axes import Axes

from bouncing_ball.datasets import CASE

QUANTITIES = {
    "phase": r"phase of impact $\varphi$",
    "max_height": r"greatest height $\max\,z$",
    "bounce_velocity": r"bouncing-off velocity $z′_b$",
    "apparent_restitution": r"apparent restitution $r_a$",
    "saddle_node": r"saddle-node $\Lambda_{SN}$",
    "period_doubling": r"period doubling $\Lambda_{PD}$",
    "permanent_contact": "permanent contact",
}
"""The titles of the quantities compared between the models."""

# Parameters in the order in which a title lists them.
_SYMBOLS = {
    "n": "n",
    "restitution": "r",
    "measured_restitution": "r",
    "amplitude": r"\Lambda",
    "frequency_ratio": r"\varpi",
    "damping_ratio": r"\zeta",
    "duration": "D",
    "height": "h",
    "phase": r"\varphi",
    "velocity": "z′_i",
}


def number(value: float) -> str:
    r"""A parameter as text for a label, with a power of ten in LaTeX from 10⁴ on.

    Examples
    --------
    >>> number(0.85), number(10000.0), number(250000.0)
    ('0.85', '10^{4}', '2.5\\times 10^{5}')
    """
    if value >= 1e4:
        mantissa, exponent = f"{value:e}".split("e")
        factor = "" if float(mantissa) == 1 else rf"{float(mantissa):g}\times "
        return f"{factor}10^{{{int(exponent)}}}"
    return f"{value:g}"


def parameters(data: xr.Dataset, *names: str) -> str:
    """Parameters of a dataset as text for a title.

    Examples
    --------
    >>> parameters(xr.Dataset(attrs={"n": 1, "restitution": 0.85}), "n", "restitution")
    '$n=1$, $r=0.85$'
    """
    return ", ".join(f"${_SYMBOLS[name]}={number(data.attrs[name])}$" for name in names)


def symbol(name: str) -> str:
    """The symbol of a parameter, or its name in words if it has no symbol."""
    return f"${_SYMBOLS[name]}$" if name in _SYMBOLS else name.replace("_", " ")


def title(data: xr.Dataset) -> str:
    """A title of a labelled dataset: its model and its law, and the parameters among its attributes
    and its coordinates without an axis, such as those of a part of a result.
    """
    fixed = {name: each.item() for name, each in data.coords.items() if not each.dims}
    data = data.assign_attrs(fixed)
    known = [name for name in _SYMBOLS if name in data.attrs]
    words = [str(data.attrs[name]) for name in ("model", "law") if name in data.attrs]
    return ", ".join(x for x in (*words, parameters(data, *known)) if x)


def in_a_row(data: xr.Dataset, *kept: str) -> tuple[xr.Dataset, list[str]]:
    """A labelled dataset with the axes of its arguments merged into one, "case", and labels.

    The dimensions ``kept`` remain. The label of a case has its arguments.

    Examples
    --------
    >>> data = xr.Dataset({"ball": (("n", "time"), [[0.0], [1.0]])}, {"n": [1, 2]})
    >>> in_a_row(data, "time")[1]
    ['$n=1$', '$n=2$']
    """
    axes = [dim for dim in data.dims if dim not in kept]
    varied = [name for name in data.coords if name in _SYMBOLS and data[name].dims]
    labels = [name for name in varied if set(data[name].dims) <= {*axes}]
    rows = data.stack({CASE: axes}, create_index=False) if axes else data.expand_dims(CASE)
    told = [{name: rows[name].values[k] for name in labels} for k in range(rows.sizes[CASE])]
    names = [", ".join(f"${_SYMBOLS[x]}={number(v)}$" for x, v in one.items()) for one in told]
    return rows.transpose(CASE, ...), names


def note(axes: Axes, text: str, point: Any, offset: Any, **look: Any) -> None:
    """A text at an offset in points from a point of the data."""
    axes.annotate(text, point, xytext=offset, textcoords="offset points", **look)

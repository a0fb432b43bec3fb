"""Tables of the atlas: how often the rule of thumb holds, and the worst orbits by name."""

import numpy as np
import xarray as xr

from bouncing_ball.figures.tables.formats import Rows

_MODEL = {"restitution": "restitution", "corrected": "corrected"}


def words(name: str) -> str:
    """A quantity as a table has it.

    Examples
    --------
    >>> words("max_height")
    'max height'
    """
    return str(name).replace("_", " ")


def shares(data: xr.Dataset) -> tuple[list[str], Rows]:
    """How the models fare on all nodes, by release rule and quantity; header and rows."""
    rule, percent = float(data.rule_of_thumb), 100 * float(data.summary_tolerance)
    where = {"tolerance": float(data.summary_tolerance), "frequency_ratio": rule}
    header = [
        "release",
        "quantity",
        f"right from ϖ = {rule:g} on",
        f"largest error at ϖ = {rule:g}",
        f"ϖ for {percent:g} %: half of the orbits",
        "99 %",
        "all",
        "all, corrected model",
    ]
    body = []
    for release in data.release.values:
        for quantity in data["quantity"].values:
            part = data.sel(release=release, quantity=quantity).sel(where)
            simple, corrected = (part.sel(model=model) for model in _MODEL)
            # Every n has as many nodes.
            half, most = (float(simple.needed_quantile.sel(share=x).max()) for x in (0.5, 0.99))
            cells = [
                f"{100 * float(simple.holding_share.mean()):.2f} %",
                f"{100 * float(simple.worst_error.max()):.3g} %",
                *(_ratio(x) for x in (half, most, float(simple.needed.max()))),
                _ratio(float(corrected.needed.max())),
            ]
            body.append([str(release), words(quantity), *cells])
        body += [
            _limit_row(data, str(release), quantity) for quantity in data.limit_quantity.values
        ]
    return header, body


def _limit_row(data: xr.Dataset, release: str, quantity: str) -> list[str]:
    """A limit of the families, which has no position in the stable range."""
    where = {"release": release, "limit_quantity": quantity}
    part = data.limit_needed.sel(where | {"tolerance": float(data.summary_tolerance)})
    simple, corrected = (part.sel(model=model).values for model in _MODEL)
    there = simple[np.isfinite(simple)]
    rule = float(data.rule_of_thumb)
    return [
        release,
        words(quantity),
        f"{100 * np.mean(there <= rule):.2f} %",
        "",
        _ratio(float(np.median(there))),
        _ratio(float(np.quantile(there, 0.99))),
        _ratio(float(there.max())),
        _ratio(float(np.nanmax(corrected))),
    ]


def _ratio(value: float) -> str:
    """A frequency ratio, rounded up, so that it is enough."""
    if not np.isfinite(value):
        return "beyond the atlas"
    unit = 10.0 ** (np.floor(np.log10(value)) - 1)
    return f"{np.ceil(value / unit * (1 - 1e-12)) * unit:g}"


def worst(data: xr.Dataset) -> tuple[list[str], Rows]:
    """The orbit with the largest error at the rule of thumb, by rule, model and quantity.

    Each with the command that prints the exact orbit; with ``--model corrected`` it prints
    the corrected one, and with ``--model restitution`` but without ``--frequency-ratio``
    and ``--release`` that of the restitution model.
    """
    header = ["release", "model", "quantity", "error", "n", "r", "Λ", "command"]
    body = []
    for release in data.release.values:
        for model in _MODEL:
            for quantity in data["quantity"].values:
                part = data.sel(release=release, model=model, quantity=quantity)
                one = part.isel(n=int(part.worst_error.values.argmax()))
                r, lam = float(one.worst_restitution), float(one.worst_amplitude)
                cells = [f"{100 * float(one.worst_error):.3g} %", str(int(one.n))]
                numbers = [f"{r:.4g}", f"{lam:.5g}"]
                command = f"`{_command(one, r, lam, str(release))}`"
                body.append([str(release), model, words(quantity), *cells, *numbers, command])
    return header, body


def _command(one: xr.Dataset, r: float, lam: float, release: str) -> str:
    rule = "" if release == "displacement" else f" --release {release}"
    return (
        f"bouncing-ball orbit --n {int(one.n)} --measured-restitution {r!r} "
        f"--frequency-ratio {float(one.rule_of_thumb):g} --amplitude {lam!r}{rule}"
    )

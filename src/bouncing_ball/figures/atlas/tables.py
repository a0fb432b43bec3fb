"""Tables of the atlas: how often the rule of thumb holds, and the worst orbits by name."""

import numpy as np
import xarray as xr

from bouncing_ball.figures.tables.formats import Rows, words

_MODELS = ("restitution", "corrected")


def shares(data: xr.Dataset) -> tuple[list[str], Rows]:
    """How the models fare on all nodes, by release rule and quantity; header and rows.

    A limit of the families has no position in the stable range, and no error at one ϖ.
    """
    rule, tolerance = float(data.rule_of_thumb), float(data.summary_tolerance)
    header = [
        "release",
        "quantity",
        f"right from ϖ = {rule:g} on",
        f"largest error at ϖ = {rule:g}",
        f"ϖ for {100 * tolerance:g} %: half of the orbits",
        "99 %",
        "all",
        "all, corrected model",
    ]
    body = []
    at = data.sel({"tolerance": tolerance})  # the keyword is another argument of sel
    for release in data.release.values:
        for quantity in data["quantity"].values:
            part = at.sel(release=release, quantity=quantity, frequency_ratio=rule)
            simple, corrected = (part.sel(model=model) for model in _MODELS)
            # Every n has as many nodes.
            holding, error = float(simple.holding_share.mean()), float(simple.worst_error.max())
            most = [simple.needed_quantile.sel(share=share).max() for share in (0.5, 0.99)]
            needed = [_ratio(x) for x in (*most, simple.needed.max(), corrected.needed.max())]
            cells = [f"{100 * holding:.2f} %", f"{100 * error:.3g} %", *needed]
            body.append([str(release), words(quantity), *cells])
        for quantity in data.limit_quantity.values:
            part = at.limit_needed.sel(release=release, limit_quantity=quantity)
            simple, corrected = (part.sel(model=model).values for model in _MODELS)
            there = simple[np.isfinite(simple)]
            most = [np.quantile(there, share) for share in (0.5, 0.99, 1.0)]
            needed = [_ratio(x) for x in (*most, np.nanmax(corrected))]
            cells = [f"{100 * np.mean(there <= rule):.2f} %", "", *needed]
            body.append([str(release), words(quantity), *cells])
    return header, body


def _ratio(value: float | xr.DataArray) -> str:
    """A frequency ratio, rounded up, so that it is enough."""
    number = float(value)
    if not np.isfinite(number):
        return "beyond the atlas"
    unit = 10.0 ** (np.floor(np.log10(number)) - 1)
    return f"{np.ceil(number / unit * (1 - 1e-12)) * unit:g}"


def worst(data: xr.Dataset) -> tuple[list[str], Rows]:
    """The orbit with the largest error at the rule of thumb, by rule, model and quantity.

    Each with the command that prints the exact orbit; with ``--model corrected`` it prints
    the corrected one, and with ``--model restitution`` but without ``--frequency-ratio``
    and ``--release`` that of the restitution model.
    """
    header = ["release", "model", "quantity", "error", "n", "r", "Λ", "command"]
    body = []
    for release in data.release.values:
        rule = "" if release == "displacement" else f" --release {release}"
        for model in _MODELS:
            for quantity in data["quantity"].values:
                part = data.sel(release=release, model=model, quantity=quantity)
                one = part.isel(n=int(part.worst_error.values.argmax()))
                n, ratio = int(one.n), float(one.rule_of_thumb)
                r, lam = float(one.worst_restitution), float(one.worst_amplitude)
                command = (
                    f"`bouncing-ball orbit --n {n} --measured-restitution {r!r} "
                    f"--frequency-ratio {ratio:g} --amplitude {lam!r}{rule}`"
                )
                cells = [f"{100 * float(one.worst_error):.3g} %", f"{n}", f"{r:.4g}", f"{lam:.5g}"]
                body.append([str(release), model, words(quantity), *cells, command])
    return header, body

"""The parameters at which a claim is decided, as a text: r, n, Λ, ϖ and ζ of the datasets."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from bouncing_ball.models.damping import Release, damping_ratio
from bouncing_ball.paper.claims.paper_parameters import Data
from bouncing_ball.paper.claims.places import place_of

_SYMBOLS = {
    "pairs": "(r, Λ)",
    "restitution": "r",
    "n": "n",
    "amplitude": "Λ",
    "frequency_ratio": "ϖ",
    "damping_ratio": "ζ",
}
# The parameters of more datasets would fill a page.
_FEW = 3


def _listed(values: Any) -> str:
    """Different values in their order, or a text for them.

    Examples
    --------
    >>> _listed([0.65, 0.65]), _listed([1e4, 10.0]), _listed("1 to 100")
    ('0.65', '10000, 10', '1 to 100')
    """
    if isinstance(values, str):
        return values
    return ", ".join(dict.fromkeys(f"{value:g}" for value in np.ravel(values)))


def parameters_text(data: xr.Dataset, at: Mapping[str, float | str] | None = None) -> str:
    """r, n, Λ, ϖ and ζ of a dataset, as far as it has them.

    Parameters
    ----------
    data : Dataset
        With the parameters of its study as attributes; a grid along ϖ has its ends there. Pairs
        (r, Λ) are coordinates along ``case``. A dataset of random parameters has the number of
        ``samples`` and a ``seed``.
    at : mapping of str to float or str, optional
        Parameters that are told in place of those of the dataset.

    Examples
    --------
    >>> study = xr.Dataset(attrs={"n": 1, "restitution": 0.65, "release": "displacement",
    ...     "frequency_ratio__min": 1.0, "frequency_ratio__max": 1e4})
    >>> parameters_text(study)
    'r = 0.65, n = 1, ϖ = 1 to 10000, ζ = 0.1359'
    >>> parameters_text(study, {"frequency_ratio": 10.0})
    'r = 0.65, n = 1, ϖ = 10, ζ = 0.1359'
    >>> parameters_text(xr.Dataset(attrs={"samples": 64, "seed": 1}))
    '64 random sets of parameters'
    """
    at = at or {}
    if "seed" in data.attrs and not at:
        return f"{data.attrs['samples']} random sets of parameters"
    of_study = {} if "seed" in data.attrs else {**data.attrs}
    if "case" in data.dims:
        of_study |= {name: data[name].values for name in ("restitution", "amplitude")}
    if {"release", "restitution"} <= {*of_study}:
        rule = Release.of(of_study["release"])
        of_study["damping_ratio"] = np.round(damping_ratio(of_study["restitution"], rule), 4)
    if "frequency_ratio__min" in of_study:
        low, high = (of_study[f"frequency_ratio__{end}"] for end in ("min", "max"))
        of_study["frequency_ratio"] = f"{low:g} to {high:g}"
    if np.unique(of_study.get("restitution", 0.0)).size > 1 and not at:
        pairs = zip(of_study.pop("restitution"), of_study.pop("amplitude"), strict=True)
        of_study["pairs"] = ", ".join(f"({r:g}, {lam:g})" for r, lam in pairs)
    of_study |= at
    return ", ".join(
        f"{symbol} = {_listed(of_study[name])}"
        for name, symbol in _SYMBOLS.items()
        if name in of_study
    )


def parameters_of(data: Data, at: Mapping[str, float | str] | None = None) -> str:
    """The parameters of the datasets that decide a claim; of several, with their names."""
    if len(data) > _FEW:
        return "those of the figures"
    texts = {name: parameters_text(one, at) for name, one in data.items()}
    if len(texts) == 1:
        return next(iter(texts.values()))
    return "; ".join(f"{place_of(name)}: {text}" for name, text in texts.items() if text)

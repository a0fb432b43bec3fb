"""Table 1 as the paper prints it: ends of the stability ranges over Λ, r = 0.85.

The exponent of the first frequency ratio is unreadable and taken as 4.
"""

import xarray as xr

from bouncing_ball.periodic.stability import Bifurcation

AXES: dict[str, list] = {
    "frequency_ratio": [1e4, 10.0, 2.0],
    "n": [1, 2, 3],
    "bound": [str(kind) for kind in Bifurcation],
}
_ENTRIES = [
    [["0.255", "1.032"], ["0.509", "1.122"], ["0.764", "1.259"]],
    [["0.238", "1.035"], ["0.495", "1.126"], ["0.750", "1.262"]],
    [["0.187", "1.082"], ["0.463", "1.170"], ["0.733", "1.298"]],
]
_TEXTS = xr.DataArray(_ENTRIES, AXES)
LAST_DIGIT = 0.001
"""Unit of the last printed digit."""

RESTITUTION = 0.85


def printed_text(ratio: float, n: int, bound: str) -> str:
    """The printed digits of an entry.

    Raises
    ------
    KeyError
        If the table has no such entry.

    Examples
    --------
    >>> printed_text(2.0, 2, "period doubling")
    '1.170'
    """
    return _TEXTS.sel(frequency_ratio=ratio, n=n, bound=bound).item()


def printed_table() -> xr.DataArray:
    """The printed Λ as numbers, with dimensions ``frequency_ratio``, ``n`` and ``bound``.

    Examples
    --------
    >>> printed_table().sel(frequency_ratio=10.0, n=1).values.tolist()
    [0.238, 1.035]
    """
    return _TEXTS.astype(float)

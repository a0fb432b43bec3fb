"""Table 1 as the paper prints it: ends of the stability ranges over Λ, r = 0.85; and the ϖ that
it reads off Fig. 16.

The exponent of the first frequency ratio is unreadable and taken as 4.
"""

import numpy as np
import xarray as xr

from bouncing_ball.periodic.orbit import Bifurcation

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
LAST_DIGIT = 0.001
"""Unit of the last printed digit."""

RESTITUTION = 0.85


# Only when it is asked for, because xarray then imports a library that jobs do without.
def _texts() -> xr.DataArray:
    return xr.DataArray(_ENTRIES, AXES)


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
    return _texts().sel(frequency_ratio=ratio, n=n, bound=bound).item()


def printed_table() -> xr.DataArray:
    """The printed Λ as numbers, with dimensions ``frequency_ratio``, ``n`` and ``bound``.

    Examples
    --------
    >>> printed_table().sel(frequency_ratio=10.0, n=1).values.tolist()
    [0.238, 1.035]
    """
    return _texts().astype(float)


PERMANENT_CONTACT = 6.0
"""ϖ at which the thresholds of permanent contact of both models differ by 1 %, "≈ 6" (Fig. 16)."""

_FIGURE_16 = (0.65, 0.01, "displacement")


def printed_contact_ratio(restitution: float, tolerance: float, release: str) -> float:
    """``PERMANENT_CONTACT`` for the parameters of Fig. 16, NaN for others.

    Examples
    --------
    >>> printed_contact_ratio(0.65, 0.01, "displacement")
    6.0
    >>> printed_contact_ratio(0.65, 0.02, "displacement")
    nan
    """
    return PERMANENT_CONTACT if (restitution, tolerance, release) == _FIGURE_16 else np.nan

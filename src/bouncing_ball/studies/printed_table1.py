"""Table 1 as the paper prints it: ends of the stability ranges over Λ, r = 0.85.

The exponent of the first frequency ratio is unreadable, taken as 4.
"""

import xarray as xr

AXES: dict[str, tuple] = {
    "frequency_ratio": (1e4, 10.0, 2.0),
    "n": (1, 2, 3),
    "bound": ("saddle-node", "period doubling"),
}
_ENTRIES = (
    (("0.255", "1.032"), ("0.509", "1.122"), ("0.764", "1.259")),
    (("0.238", "1.035"), ("0.495", "1.126"), ("0.750", "1.262")),
    (("0.187", "1.082"), ("0.463", "1.170"), ("0.733", "1.298")),
)
LAST_DIGIT = 0.001
"""Unit of the last printed digit."""
RESTITUTION = 0.85


def printed_text(ratio: float, n: int, bound: str) -> str:
    """An entry with its digits.

    Examples
    --------
    >>> printed_text(2.0, 2, "period doubling")
    '1.170'
    """
    pairs = zip(AXES.values(), (ratio, n, bound), strict=True)
    row, family, end = (labels.index(place) for labels, place in pairs)
    return _ENTRIES[row][family][end]


def printed_table() -> xr.DataArray:
    """The entries as numbers, over ``frequency_ratio``, ``n`` and ``bound``."""
    numbers = [[[float(text) for text in pair] for pair in row] for row in _ENTRIES]
    return xr.DataArray(numbers, {name: list(labels) for name, labels in AXES.items()})

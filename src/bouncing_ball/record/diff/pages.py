"""A page that computes: its words and scripts as a text, its reference orbits as data.

The commit that the page names is another one in every run, and no difference.
"""

import json
import re
from typing import NamedTuple

import numpy as np
import xarray as xr

from bouncing_ball.record.reading import UnreadableError

_BLOCK = re.compile(
    r'(?<=<script type="application/json" id="references">\n)(.*?)(?=\n</script>)', re.DOTALL
)
_STATE = ("release", "restitution", "frequency_ratio", "n", "amplitude")


class Page(NamedTuple):
    """The page without its reference orbits, and these."""

    text: str
    data: xr.Dataset


def read_page(text: str) -> Page:
    """A page from its text.

    Raises
    ------
    UnreadableError
        If it has not exactly one block of reference orbits, or that is none.
    """
    blocks = _BLOCK.findall(text)
    if len(blocks) != 1:
        raise UnreadableError(f"{len(blocks)} blocks of reference orbits in place of one")
    try:
        held = json.loads(blocks[0])
        columns = list(zip(*(one["state"] for one in held["orbits"]), strict=True))
        data = dict(zip(_STATE, columns, strict=True))
        values = np.array([one["values"] for one in held["orbits"]], dtype=float)
        data |= dict(zip(held["names"], values.T, strict=True))
        found = {name: ("sample", np.array(column)) for name, column in data.items()}
        return Page(_BLOCK.sub("", text), xr.Dataset(found))
    except (ValueError, TypeError, KeyError, RecursionError):
        raise UnreadableError("its reference orbits are no such data") from None

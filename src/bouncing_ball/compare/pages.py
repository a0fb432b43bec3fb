"""A page that computes: its words and scripts as a text, its reference orbits as data.

The commit that the page names is another one in every run, and no difference.
"""

import json
from typing import NamedTuple

import numpy as np
import xarray as xr

from bouncing_ball.record.reading import UnreadableError

_OPENED, _CLOSED = '<script type="application/json" id="references">\n', "\n</script>"
_STATE = ("release", "restitution", "frequency_ratio", "n", "amplitude")
# Letters of the name of a release rule.
_LONGEST = 20


class Page(NamedTuple):
    """The page without its reference orbits, and these."""

    text: str
    data: xr.Dataset


def read_page(text: str) -> Page:
    """A page from its text.

    Raises
    ------
    UnreadableError
        If it has not exactly one block of reference orbits, or there is anything
        else in that block: it is the one part of a page that is not compared by its letters.
    """
    before, *blocks = text.split(_OPENED)
    if len(blocks) != 1:
        raise UnreadableError(f"{len(blocks)} blocks of reference orbits instead of one")
    block, closed, after = blocks[0].partition(_CLOSED)
    # A browser ends the block at any "</script", also within a text.
    if not closed or "<" in block:
        raise UnreadableError("its block of reference orbits holds something else")
    try:
        held = json.loads(block)
        return Page(before + _OPENED + _CLOSED + after, _orbits(**held))
    except (ValueError, TypeError, KeyError, AttributeError, RecursionError):
        raise UnreadableError("its reference orbits are not in the form of this workflow") from None


def _orbits(commit: str, names: list[str], orbits: list[dict[str, list]]) -> xr.Dataset:
    """The block's content as data; what is named otherwise is refused."""
    if len({*names, *_STATE}) != len(names) + len(_STATE):
        raise ValueError("a name twice")
    if any(one.keys() != {"state", "values"} for one in orbits) or not isinstance(commit, str):
        raise ValueError("other keys")
    rules = [one["state"][0] for one in orbits]
    if any(len(rule) > _LONGEST for rule in rules):
        raise ValueError("no release rule")
    # As numbers, however they are written: an array of texts takes the longest one's room for each.
    columns = [rules, *np.array([one["state"][1:] for one in orbits], dtype=float).T]
    data = dict(zip(_STATE, columns, strict=True))
    values = np.array([one["values"] for one in orbits], dtype=float)
    data |= dict(zip(names, values.T, strict=True))
    return xr.Dataset({name: ("sample", np.array(column)) for name, column in data.items()})

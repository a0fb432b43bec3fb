"""What differs in the contents of a file, of which there are two versions.

Numbers of datasets agree within the tolerances that the first version declares. All other files are
compared byte for byte: of a text the changed sentences are listed.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from difflib import SequenceMatcher
from itertools import takewhile, zip_longest
from pathlib import Path
from typing import Any, NamedTuple
from xml.etree import ElementTree

import numpy as np
import xarray as xr
from PIL import Image

from paper_replication.datasets import plain, read, words

PROVENANCE = {"title", "parameters", "code", "versions", "computed_on", "source", "license"}
"""Attributes of a dataset that say how it was made, and how it may be used."""


def content_of(path: Path) -> Any:
    """A dataset, or the lines of a text; nothing of a picture.

    Raises an error if a file is damaged, or is not what its name says. An example is a pointer of
    Git LFS.
    """
    if path.suffix == ".nc":
        return read(path)
    if path.suffix == ".svg":
        ElementTree.parse(path)
        return None
    if path.suffix == ".png":
        with Image.open(path) as picture:
            return picture.verify()
    return path.read_bytes().replace(b"\r\n", b"\n").decode().split("\n")


class Difference(NamedTuple):
    """What differs in a file. For a variable it is the largest change, with its place.

    Attributes
    ----------
    what
        The variable or attribute of a dataset, or the line of a text.
    change, where
        The change, and the coordinates at which it is.
    differing, size
        How many values differ, and how many were compared; 0 for an attribute or a text.
    tolerance, long_name
        Those of the variable, if it has some.
    """

    what: str
    change: str
    where: str = ""
    differing: int = 0
    size: int = 0
    tolerance: str = ""
    long_name: str = ""

    def __str__(self) -> str:
        tolerance = f" (tolerance {self.tolerance})" if self.tolerance else ""
        others = f", and {self.differing - 1} more of {self.size} values"
        return f"{self.what} {self.columns[2]}{tolerance}{others * (self.differing > 1)}"

    @property
    def columns(self) -> tuple[str, str, str]:
        """The row of a report: what differs, how many values, and the largest change."""
        at = f" at {self.where}" * bool(self.where)
        return self.what, f"{self.differing} of {self.size}" * bool(self.size), self.change + at


def differences(name: str, old: Any, new: Any) -> list[Difference]:
    """What differs in the contents of a file, which are those of `content_of`."""
    if isinstance(old, xr.Dataset):
        described = [Difference(*difference) for difference in changed(about(old), about(new))]
        sizes, *both = aligned(old, new)
        return described + sizes + values_that_differ(*both)
    if old is None:
        return [Difference("the picture", "differs")]
    # An empty line follows the last line feed.
    number = common(old, new)
    pair = [[*lines, "the end of the text"][number] or "an empty line" for lines in (old, new)]
    return [Difference(f"{name}, line {number + 1}:", excerpt(*pair))]


def changes(old: Mapping, new: Mapping) -> list[str]:
    """What differs between two mappings, and of lists only the elements that do.

    >>> changes({"grid": {"max": 10.0}, "n": [1, 2]}, {"grid": {"max": 20.0}, "n": [1, 2, 3]})
    ['grid.max 10.0 → 20.0', 'n 3 is new']
    """
    return [" ".join(difference) for difference in changed(old, new)]


def changed(old: Mapping, new: Mapping, above: str = "") -> Iterator[tuple[str, str]]:
    """Yield what differs between two mappings: the key and the change."""
    for key in sorted({*old, *new}):
        before, after = (mapping.get(key, "absent") for mapping in (old, new))
        nested = [isinstance(value, Mapping) for value in (before, after)]
        if all(nested):
            yield from changed(before, after, f"{above}{key}.")
        elif before != after:
            what = "is missing" if nested[0] else "is new" if nested[1] else ""
            if not what and isinstance(before, list) and isinstance(after, list):
                what = elements(before, after)
            yield f"{above}{key}", what or f"{words(before)} → {words(after)}"


def elements(old: list, new: list) -> str:
    """The elements of two lists that only one has; empty if both have the same ones.

    >>> elements([0.5, 0.65], [0.5, 0.7]), elements([1, 2, 5], [1, 3]), elements([1, 2], [2, 1])
    ('0.65 → 0.7', '3 is new, 2, 5 are missing', '')
    """
    came = [x for x in new if x not in old]
    went = [x for x in old if x not in new]
    if came and len(old) == len(new) and len(came) == len(went):
        return f"{words(went)} → {words(came)}"
    return ", ".join(
        f"{words(some[:8])}{f' and {len(some) - 8} more' * (len(some) > 8)} "
        f"{'is' if len(some) == 1 else 'are'} {kind}"
        for some, kind in ((came, "new"), (went, "missing"))
        if some
    )


def about(data: xr.Dataset) -> dict:
    """What a dataset has apart from numbers: attributes, and types and dimensions of variables."""
    attributes = {key: value for key, value in data.attrs.items() if key not in PROVENANCE}
    variables = {
        str(name): variable.attrs
        | {
            "role": "coordinate" if name in data.coords else "variable",
            "type": "text" if variable.dtype.kind in "UO" else str(variable.dtype),
            "dimensions": [*variable.dims],
        }
        for name, variable in data.variables.items()
    }
    return plain(attributes | variables)


def labels(data: xr.Dataset, dim: str) -> list[str]:
    """The coordinates of the values along a dimension, or their positions if it has none.

    >>> orbits = xr.Dataset(coords={"n": ("orbit", [1, 2]), "restitution": ("orbit", [0.5, 0.65])})
    >>> labels(orbits, "orbit"), labels(orbits.swap_dims(orbit="n"), "n")
    (['n = 1, restitution = 0.5', 'n = 2, restitution = 0.65'], ['n = 1', 'n = 2'])
    """
    texts = [[f"{name} = {printable(x)}" for x in data[name].values] for name in along(data, dim)]
    return [", ".join(parts) for parts in zip(*texts, strict=True)]


def along(data: xr.Dataset, dim: str) -> list[str]:
    """The names of the coordinates that tell the values along a dimension apart: its own, or all
    others, or else the dimension, whose values are positions.
    """
    others = [str(name) for name, coordinate in data.coords.items() if coordinate.dims == (dim,)]
    return [dim] if dim in data.coords else others or [dim]


def aligned(old: xr.Dataset, new: xr.Dataset) -> tuple[list[Difference], xr.Dataset, xr.Dataset]:
    """What only one of two datasets has along its dimensions, and the parts that both have.

    Along a dimension of another size, and along one with other texts, values belong together if
    their coordinates agree within the tolerance.

    >>> old, new = (xr.Dataset(coords={"claim": names}) for names in (["high"], ["high", "low"]))
    >>> [str(difference) for difference in (*aligned(old, new)[0], *aligned(new, old)[0])]
    ['claim low is new', 'claim low is missing']
    """
    differing = []
    for dim in sorted({*map(str, old.dims)} & {*map(str, new.dims)}):
        is_as_long = old.sizes[dim] == new.sizes[dim]
        if is_as_long and old[dim].dtype.kind not in "UO":
            continue
        same = np.ones((old.sizes[dim], new.sizes[dim]), bool)
        for name in {*along(old, dim)} & {*along(new, dim)}:
            y, x = (data[name].values for data in (old, new))
            same &= far(x[None, :], y[:, None], old[name].attrs) <= 1
        # Of several equal coordinates, the first of both belong together.
        same &= np.cumsum(same, 0) == np.cumsum(same, 1)
        kept = same.any(1), same.any(0)
        if is_as_long and all(map(np.all, kept)):
            continue
        only = [
            [text.removeprefix(f"{dim} = ") for text in np.array(labels(data, dim))[~both]]
            for data, both in zip((old, new), kept, strict=True)
        ]
        differing.append(Difference(dim, elements(*only)))
        places = np.nonzero(same)
        old, new = (data.isel({dim: place}) for data, place in zip((old, new), places, strict=True))
    return differing, old, new


def values_that_differ(old: xr.Dataset, new: xr.Dataset) -> list[Difference]:
    """The largest change of each variable of two datasets that both have with the same dimensions.

    Single values, such as a threshold, are first, then the variables that changed most.
    """
    distances = {
        str(name): distance(str(name), old, new)
        for name, variable in old.variables.items()
        if name in new.variables and variable.dims == new[name].dims
    }
    ordered = sorted(
        (name for name, far in distances.items() if (far > 1).any()),
        key=lambda name: (distances[name].ndim > 0, -distances[name].max()),
    )
    return [largest_change(old, new, name, distances[name]) for name in ordered]


def largest_change(old: xr.Dataset, new: xr.Dataset, name: str, far: np.ndarray) -> Difference:
    """The value of a variable that changed most, of those that are numbers in both datasets if
    there are some.
    """
    finite = np.where(np.isfinite(far), far, 0.0)
    worst = np.unravel_index(np.argmax(finite if (finite > 1).any() else far), far.shape)
    given = old[name].attrs
    places = zip(map(str, old[name].dims), worst, strict=True)
    return Difference(
        name,
        excerpt(old[name].values[worst], new[name].values[worst]),
        where=", ".join(labels(old, dim)[index] for dim, index in places),
        differing=int(np.count_nonzero(far > 1)),
        size=far.size,
        tolerance=f"{given['tolerance']:g}" if "tolerance" in given else "",
        long_name=given.get("long_name", ""),
    )


def distance(name: str, old: xr.Dataset, new: xr.Dataset) -> np.ndarray:
    """How far a variable is from the reference, as `far` says."""
    given = old[name].attrs
    other = given.get("tolerance_scale")
    scale = abs(old[other].values) if other else None
    return far(new[name].values, old[name].values, given, scale)


def far(x: np.ndarray, y: np.ndarray, given: Mapping, scale: Any = None) -> np.ndarray:
    """How far values x are from y, in multiples of the tolerance that the attributes of y declare.

    Whole numbers that differ are further than their tolerance, one half. A text, NaN or infinity is
    infinitely far from another.
    """
    if x.dtype.kind not in "fi" or y.dtype.kind not in "fi":
        return np.where(x.astype(object) != y.astype(object), np.inf, 0.0)
    unequal = np.where((x != y) & ((x == x) | (y == y)), np.inf, 0.0)
    if y.dtype.kind == "i":
        tolerance: Any = 0.5
    else:
        if scale is None:
            scale = np.maximum(abs(y), given["floor"])
        tolerance = given["tolerance"] * scale
    with np.errstate(all="ignore"):
        ratio = abs(x - y) / tolerance
    return np.where(np.isnan(ratio), unequal, ratio)


def excerpt(old: object, new: object) -> str:
    """Print two values as "old → new"; long texts from 30 characters before the first difference.

    >>> excerpt(82.177, 83.0), excerpt(1.0, 1.000000001)
    ('82.177 → 83', '1.0 → 1.000000001')
    >>> long = "The first 80 characters of this sentence are the same in both texts, and it is "
    >>> excerpt(f"{long}82.", f"{long}83.")
    'ame in both texts, and it is 82. → ame in both texts, and it is 83.'
    """
    texts = [printable(old), printable(new)]
    if texts[0] == texts[1]:
        texts = [str(old), str(new)]
    if max(map(len, texts)) > 80:
        start = max(0, common(*texts) - 30)
        texts = [text[start : start + 80] for text in texts]
    return " → ".join(texts)


def common(one: Sequence, other: Sequence) -> int:
    """How many elements two sequences have in common before the first difference."""
    return len([*takewhile(lambda pair: pair[0] == pair[1], zip(one, other, strict=False))])


def printable(value: object) -> str:
    """A number with six digits; a text with its invisible characters escaped.

    >>> printable(2 / 3), printable("5\N{NO-BREAK SPACE}%")
    ('0.666667', '5\\\\xa0%')
    """
    if isinstance(value, float | np.floating):
        return f"{value:.6g}"
    return "".join(char if char.isprintable() else ascii(char)[1:-1] for char in str(value))


def sentences(old: Sequence[str], new: Sequence[str]) -> list[tuple[str, str]]:
    """The lines of a text that changed, in pairs. A line is a sentence or a row of a table.

    >>> sentences(["At 82.18.", "So it is."], ["At 83.1.", "New.", "So it is."])
    [('At 82.18.', 'At 83.1.'), ('', 'New.')]
    """
    # Sentences that differ in numbers only belong together.
    before, after = ([re.sub(r"\d[\d.]*", "#", line) for line in lines] for lines in (old, new))
    pairs = [
        pair
        for _, i, j, k, m in SequenceMatcher(None, before, after, autojunk=False).get_opcodes()
        for pair in zip_longest(old[i:j], new[k:m], fillvalue="")
    ]
    return [(one, other) for one, other in pairs if one != other]

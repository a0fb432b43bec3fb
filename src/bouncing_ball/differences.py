"""How a dataset, a text or a picture differs from what it is compared with.

Datasets are compared by names, dimensions, types, attributes, texts and places of NaN exactly, and
by numbers within the tolerance that the reference declares beside the variable (`datasets` says
what it means). They are aligned first: if a curve or a claim was added, removed or moved, the
others are compared. Texts are compared exactly, SVG byte for byte and PNG pixel for pixel with
whatever else is in the file, but for the description that names a commit.
"""

import base64
import difflib
import io
import json
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import takewhile, zip_longest
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from PIL import Image, PngImagePlugin

from bouncing_ball import datasets

KINDS = {
    "stale": "Results of other parameters or of other code",
    "file": "Files that are missing, unexpected or unreadable",
    "verdict": "Verdicts that changed",
    "number": "Numbers beyond their tolerance",
    "content": "Names, types, texts and attributes of variables",
    "text": "Texts",
    "picture": "Pictures",
}
"""Kinds of differences with their headings on the page, the most telling first."""


@dataclass(frozen=True)
class Finding:
    """A difference, as the report shows it.

    `text` says what is different in one line, `cause` why, as far as the parameters, the files of
    code or git know. Within a kind, a smaller `order` tells more. `lines` are a unified diff,
    `images` the file, what it should be, and where they differ, `variable` is that of a number or a
    word in a dataset. `of_results` says that the result
    is wrong in itself, whatever the reference is.
    """

    kind: str
    text: str
    order: float = 0.0
    lines: str = ""
    images: tuple[str, ...] = ()
    variable: str = ""
    artifact: str = ""
    cause: str = ""
    of_results: bool = False

    @property
    def line(self) -> str:
        """The finding in a sentence, without characters that would control a terminal."""
        line = f"{self.artifact}: {self.text}{'; ' if self.cause else ''}{self.cause}"
        return "".join(each if each.isprintable() else repr(each)[1:-1] for each in line)

    @property
    def rank(self) -> tuple:
        """The place among other findings: the most telling is the smallest."""
        return list(KINDS).index(self.kind), self.order, self.artifact


# Datasets

PROVENANCE = ("commit", "code", "versions", "computed_on")
"""Attributes of the reference that are shown and not judged."""

STORAGE = ("dtype", "scale_factor", "add_offset", "_FillValue", "missing_value", "_Unsigned")
"""How a file packs a variable; other encodings, such as compression, do not change values."""


def dataset_differences(new: xr.Dataset, old: xr.Dataset) -> list[Finding]:
    """Differences of a dataset from the reference `old`, whose tolerances apply; the most telling
    first.
    """
    moved, new, old = aligned(new, old)
    common = [str(name) for name in old.variables if name in new.variables]
    before = description(old, common)
    after = description(new, common)
    found = [Finding("content", text) for text in changes(before, after)]
    for name in common:
        if all(before[name][key] == after[name][key] for key in ("dimensions", "type")):
            found += value_differences(name, new, old)
    rest = "were compared" if found else "agree"
    found += [Finding("content", f"{text} {rest}", -1.0) for text in moved]
    if not found:
        parameters = changes(record(old, "parameters"), record(new, "parameters"))
        found = [Finding("content", f"parameters.{each}") for each in parameters]
    return sorted(found, key=lambda each: each.rank)


def aligned(new: xr.Dataset, old: xr.Dataset) -> tuple[list[str], xr.Dataset, xr.Dataset]:
    """Both datasets at the labels that they share, in the order of the reference, after what is
    different in these.

    Labels are the values of a coordinate along its own dimension. Numbers, which another processor
    may round otherwise, are taken as labels only if there are more or fewer of them, or if they are
    the same in another order.
    """
    found = []
    for dim in [dim for dim in old.indexes if dim in new.indexes]:
        ours = new.indexes[dim]
        theirs = old.indexes[dim]
        shared = theirs[theirs.isin(ours)]
        rounded = theirs.dtype.kind == "f" and len(ours) == len(theirs) > len(shared)
        unclear = rounded or not ours.is_unique or not theirs.is_unique or not len(shared)
        if unclear or ours.equals(theirs):
            continue
        labels = gained_and_lost([*ours], [*theirs])
        words = [labels] if labels else []
        if not ours[ours.isin(theirs)].equals(shared):
            words.append("the order changed")
        new = new.sel({dim: shared})
        old = old.sel({dim: shared})
        other = "other " if labels else ""
        found.append(f"{dim}: {', and '.join(words)}; the {other}{len(shared)}")
    return found, new, old


def gained_and_lost(new: list, old: list) -> str:
    """What is in one of two lists only, as "new 'a', without 'b', 'c'"; of many the first three."""
    texts = legible([*new, *old])
    sides = {
        "new": [text for text, each in zip(texts, new, strict=False) if each not in old],
        "without": [
            text for text, each in zip(texts[len(new) :], old, strict=True) if each not in new
        ],
    }
    return ", ".join(
        f"{word} {', '.join(some[:3])}" + (f" and {len(some) - 3} more" if len(some) > 3 else "")
        for word, some in sides.items()
        if some
    )


def description(data: xr.Dataset, names: Iterable[str]) -> dict[str, Any]:
    """What a dataset is apart from its numbers and their provenance: its attributes, its variables,
    and of those with the given names dimensions, type, role, storage and attributes.
    """
    judged = data.attrs.keys() - {*PROVENANCE, "parameters"}
    found = {key: data.attrs[key] for key in judged}
    found["variables"] = sorted(map(str, data.variables))
    for name in names:
        variable = data[name].variable
        text = variable.dtype.kind in "UO"
        stored = {} if text else variable.encoding  # That of a text names its length.
        found[name] = variable.attrs | {
            "dimensions": str(dict(variable.sizes)),
            "type": "text" if text else str(variable.dtype),
            "role": "coordinate" if name in data.coords else "variable",
            "storage": {key: str(stored[key]) for key in STORAGE if key in stored},
        }
    return datasets.plain(found)


def value_differences(name: str, new: xr.Dataset, old: xr.Dataset) -> Iterator[Finding]:
    """The place where a variable is furthest from the reference, if beyond the tolerance."""
    x = new[name].values
    y = old[name].values
    missing = new[name].isnull().values & old[name].isnull().values
    # In multiples of the tolerance; a text, a NaN or an infinity is infinitely far from another.
    distance = np.where((x != y) & ~missing, np.inf, 0.0)
    if y.dtype.kind == "f":
        allowed = tolerance(name, old)
        with np.errstate(all="ignore"):
            ratio = abs(x - y) / allowed
        distance = np.where(np.isnan(ratio), distance, ratio)
    count = np.count_nonzero(distance > 1)
    if not count:
        return
    worst = np.unravel_index(np.argmax(distance), y.shape)
    found, expected = excerpts(*legible([x[worst], y[worst]]))
    text = f"{name} is {found}, the reference has {expected}"
    if y.ndim:
        text += f" at {', '.join(places(old[name], worst))}"
    if np.isfinite(distance[worst]):
        text += f" (tolerance {allowed[worst]:.1e}, exceeded {distance[worst]:.2g} times)"
    if count > 1:
        text += f", and {count - 1} more of {y.size} values"
    kind = "verdict" if name == "verdict" else "number" if y.dtype.kind == "f" else "content"
    yield Finding(kind, text, -distance[worst], variable=name)


def places(variable: xr.DataArray, index: tuple) -> Iterator[str]:
    """Where a value of a variable is, as "frequency_ratio = 1.9", by labels where it has them."""
    for dim, position in zip(variable.dims, index, strict=True):
        yield f"{dim} = {legible(variable[dim].values)[position]}"


def tolerance(name: str, old: xr.Dataset) -> np.ndarray:
    """The differences allowed from numbers; zero if no tolerance is declared."""
    attributes = old[name].attrs
    scale = abs(old[attributes.get("tolerance_scale", name)].values)
    if "tolerance_scale" not in attributes:
        scale = np.maximum(scale, attributes.get("floor", 0.0))
    return attributes.get("tolerance", 0.0) * scale


def legible(values: Sequence | np.ndarray) -> list[str]:
    """Values in words: numbers in as few digits, but at least four, as tell them apart."""
    numbers = np.unique([each for each in values if isinstance(each, float)])
    enough = (
        digits
        for digits in range(4, 17)
        if len({f"{each:.{digits}g}" for each in numbers}) == len(numbers)
    )
    digits = next(enough, 17)
    return [
        f"{each:.{digits}g}" if isinstance(each, float) else repr(datasets.plain(each))
        for each in values
    ]


def excerpts(first: str, second: str) -> tuple[str, str]:
    """Two texts; of long ones 80 characters, from shortly before they part."""
    long = max(len(first), len(second)) > 80
    same = len([*takewhile(lambda pair: pair[0] == pair[1], zip(first, second, strict=False))])
    start = max(0, same - 30) if long else 0
    return first[start : start + 80], second[start : start + 80]


def record(data: xr.Dataset, key: str) -> dict:
    """The parameters, versions or files of code that a dataset records.

    Raises ValueError if there is no such record, or if a key is in it twice, of which a reader
    takes the last.
    """
    text = str(data.attrs.get(key, "{}"))
    found = json.loads(text)
    written = [json.dumps(found), json.dumps(found, ensure_ascii=False)]
    if key not in data.attrs or not isinstance(found, dict) or text not in written:
        raise ValueError(f"it does not record its {key}, each of them once")
    return found


def changes(old: Mapping, new: Mapping, above: str = "") -> list[str]:
    """What changed, as "frequency_ratio.max 1000.0 -> 500.0" or "amplitude: new 1.2"."""
    found = []
    for key in sorted({*old, *new}):
        values = old.get(key, "absent"), new.get(key, "absent")
        if all(isinstance(value, Mapping) for value in values):
            found += changes(*values, f"{above}{key}.")
        elif values[0] != values[1]:
            lists = all(isinstance(value, list) for value in values)
            gained = gained_and_lost(values[1], values[0]) if lists else ""
            words = f": {gained}" if gained else f" {values[0]} -> {values[1]}"
            found.append(f"{above}{key}{words}")
    return found


def same_bits(first: xr.Dataset, second: xr.Dataset) -> bool:
    """Whether two datasets differ in nothing but their provenance; -0.0 differs from 0.0."""
    provenance = {key: first.attrs[key] for key in PROVENANCE if key in first.attrs}
    return first.identical(second.assign_attrs(provenance)) and all(
        variable.values.tobytes() == second[name].values.tobytes()
        for name, variable in first.variables.items()
        if variable.dtype.kind == "f"
    )


# Texts and pictures

PICTURES = (".svg", ".png")
COMMIT = r"drawn at commit [0-9a-z+:() ]*"
"""What a picture says of its making: letters that nothing can be drawn with."""


def file_differences(made: Path, path: Path) -> list[Finding]:
    """How a file differs from what is `made` of its datasets.

    An arrow in the text of a finding leads from the file to what is made.
    """
    try:
        if path.suffix == ".nc":
            return dataset_differences(datasets.read(made), datasets.read(path))
        return [*(png_differences if path.suffix == ".png" else text_differences)(made, path)]
    except Exception as error:  # Whatever readers of damaged files raise.
        return [Finding("file", f"it cannot be read: {error!r}")]


def text_differences(made: Path, path: Path) -> Iterator[Finding]:
    """How two texts, which may be pictures as SVG, differ. Line ends may be those of Windows."""
    texts = [file.read_bytes().decode().replace("\r\n", "\n") for file in (path, made)]
    if path.suffix == ".svg":
        description = f"<dc:description>{COMMIT}</dc:description>"
        texts = [re.sub(description, "", text, count=1) for text in texts]
    given, expected = (text.splitlines(keepends=True) for text in texts)
    if given == expected:
        return
    pairs = enumerate(zip_longest(given, expected, fillvalue=""), 1)
    number, pair = next((number, pair) for number, pair in pairs if pair[0] != pair[1])
    words = f"line {number}: {' -> '.join(map(repr, excerpts(*pair)))}"
    if path.suffix != ".svg":
        unified = difflib.unified_diff(given, expected, "the file", "as its datasets give it", n=1)
        yield Finding("text", words, lines="".join(unified))
        return
    # Letters are drawn as curves, with the words in comments.
    before, after = (re.findall("<!-- (.*?) -->", text) for text in texts)
    labels = gained_and_lost(after, before)
    part = re.findall('<g id="(.*?)">', "".join(given[:number]))[-1:]
    yield Finding("picture", f"words: {labels}" if labels else ", ".join([*part, words]))


def png_differences(made: Path, path: Path) -> Iterator[Finding]:
    """How two PNG files differ in pixels, with an image of the difference, or in anything else."""
    contents = [file.read_bytes() for file in (path, made)]
    first, second = (Image.open(io.BytesIO(content)) for content in contents)
    pixels = [np.asarray(image.convert("RGBA")) for image in (first, second)]
    if first.size == second.size and np.any(pixels[0] != pixels[1]):
        unequal = np.any(pixels[0] != pixels[1], axis=-1)
        marked = Image.fromarray(np.where(unequal, 0, 255).astype("uint8"))
        uris = tuple(data_uri(image) for image in (first, second, marked))
        yield Finding("picture", f"{np.count_nonzero(unequal)} pixels differ", 1.0, images=uris)
    differ = changes(beside_pixels(first, contents[0]), beside_pixels(second, contents[1]))
    if differ:
        yield Finding("picture", f"the PNG has other {'; '.join(differ)}", 1.0)


def beside_pixels(image: Image.Image, content: bytes) -> dict[str, str]:
    """What a PNG file has beside its pixels and its description.

    Raises SyntaxError or OSError for a damaged chunk. The same pixels may be cut into several.
    """
    file = io.BytesIO(content)
    file.seek(8)
    chunks = " ".join(kind.decode("latin-1") for kind in PngImagePlugin.ChunkStream(file).verify())
    found = {str(key): str(value) for key, value in image.info.items()}
    if re.fullmatch(COMMIT, found.get("Description", "")):
        del found["Description"]
    found |= {"size": str(image.size), "mode": image.mode, "end": str(file.read())}
    return found | {"chunks": re.sub("IDAT( IDAT)+", "IDAT", chunks)}


def data_uri(image: Image.Image) -> str:
    """An image for a page that needs no other file."""
    file = io.BytesIO()
    image.save(file, "PNG")
    return f"data:image/png;base64,{base64.b64encode(file.getvalue()).decode()}"

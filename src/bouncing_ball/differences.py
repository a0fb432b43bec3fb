"""How a dataset, a text or a picture differs from the reference.

Datasets are compared by names, dimensions, types, attributes, texts and places of NaN exactly, and
by numbers within the tolerance that the reference declares beside the variable (`datasets` says
what it means). If a curve or a claim was added or removed, the others are compared. Texts are
compared exactly, SVG byte for byte but for its description, PNG pixel for pixel.

Another version of matplotlib places texts, and with them everything else, a little differently.
Then SVG files are compared by what they draw: strokes, fills, words and curves. PNG files are not
compared.
"""

import base64
import difflib
import io
import json
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import takewhile, zip_longest
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import xarray as xr
from PIL import Image

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

    `text` says what is different in one line, `cause` why, as far as the parameters or git know.
    Within a kind, a smaller `order` tells more. `lines` are a unified diff, `images` the file, what
    it should be, and where they differ. `of_results` says that the result is wrong in itself,
    whatever the reference is.
    """

    kind: str
    text: str
    order: tuple[float, ...] = (0.0,)
    lines: str = ""
    images: tuple[str, ...] = ()
    artifact: str = ""
    cause: str = ""
    of_results: bool = False

    @property
    def line(self) -> str:
        """The finding in a sentence."""
        return f"{self.artifact}: {self.text}{'; ' if self.cause else ''}{self.cause}"

    @property
    def rank(self) -> tuple:
        """The place among other findings: the most telling is the smallest."""
        return list(KINDS).index(self.kind), self.order, self.artifact


# Datasets

PROVENANCE = ("commit", "code", "versions")
"""Attributes of the reference that are shown and not judged."""

STORAGE = ("dtype", "scale_factor", "add_offset", "_FillValue", "missing_value", "_Unsigned")
"""How a file packs a variable; other encodings, such as compression, do not change values."""


def dataset_differences(new: xr.Dataset, old: xr.Dataset) -> list[Finding]:
    """Differences of a dataset from the reference `old`, whose tolerances apply."""
    labels, *shared = at_shared_labels(new, old)
    found = [*variables_differences(*shared)]
    if labels:
        rest = "were compared" if found else "agree"
        text = "; ".join(f"{each} {rest}" for each in labels)
        found.append(Finding("content", text, (-1.0,)))
    if not found and record(old, "parameters") != record(new, "parameters"):
        found.append(Finding("content", "its parameters changed, and its values did not"))
    return found


def at_shared_labels(new: xr.Dataset, old: xr.Dataset) -> tuple[list[str], xr.Dataset, xr.Dataset]:
    """Both datasets where they have the same labels, and what only one has along each dimension.

    Labels are the values of a coordinate along its own dimension. Numbers, which another processor
    may round otherwise, are taken as labels only if there are more or fewer of them.
    """
    found = []
    for dim in [str(dim) for dim in old.indexes if dim in new.indexes]:
        labels = new.indexes[dim], old.indexes[dim]
        common = labels[0].isin(labels[1]), labels[1].isin(labels[0])
        rounded = labels[1].dtype.kind == "f" and len(labels[0]) == len(labels[1])
        gained = gained_and_lost(labels[0].tolist(), labels[1].tolist())
        if gained and common[1].any() and not rounded:
            new = new.isel({dim: common[0]})
            old = old.isel({dim: common[1]})
            found.append(f"{dim}: {gained}; the other {np.count_nonzero(common[1])}")
    return found, new, old


def gained_and_lost(new: list, old: list) -> str:
    """What is in one of two lists only, as "new 'a', without 'b', 'c'"; of many the first three."""
    sides = {
        "new": [each for each in new if each not in old],
        "without": [each for each in old if each not in new],
    }
    return ", ".join(
        f"{word} {', '.join(map(repr, some[:3]))}"
        + (f" and {len(some) - 3} more" if len(some) > 3 else "")
        for word, some in sides.items()
        if some
    )


def variables_differences(new: xr.Dataset, old: xr.Dataset) -> Iterator[Finding]:
    """Differences in the names of variables, in each of them, and in attributes of the dataset."""
    added = [str(name) for name in new.variables if name not in old.variables]
    for name in old.variables:
        if name in new.variables:
            yield from variable_differences(str(name), new, old)
        else:
            twins = [other for other in added if new[other].variable.equals(old[name].variable)]
            renamed = f"; {twins[0]} has its values: is it renamed?" if twins else ""
            yield Finding("content", f"{name} is missing{renamed}")
    for name in added:
        yield Finding("content", f"{name} is not in the reference")
    judged = [
        {key: value for key, value in data.attrs.items() if key not in (*PROVENANCE, "parameters")}
        for data in (new, old)
    ]
    yield from attribute_differences("the dataset", *judged)


def variable_differences(name: str, new: xr.Dataset, old: xr.Dataset) -> Iterator[Finding]:
    """Differences of one variable in attributes, form and values."""
    yield from attribute_differences(name, new[name].attrs, old[name].attrs)
    forms = form(name, new), form(name, old)
    for what, found in forms[0].items():
        if found != forms[1][what]:
            text = f"{name} has {what} {found}, in the reference {forms[1][what]}"
            yield Finding("content", text)
    if all(forms[0][what] == forms[1][what] for what in ("dimensions", "type")):
        yield from value_differences(name, new, old)


def form(name: str, data: xr.Dataset) -> dict[str, str]:
    """What a variable is apart from its values: dimensions, type, role and storage."""
    variable = data[name]
    text = variable.dtype.kind in "UO"
    packed = {key: str(variable.encoding[key]) for key in STORAGE if key in variable.encoding}
    return {
        "dimensions": str(dict(variable.sizes)),
        "type": "text" if text else str(variable.dtype),
        "role": "coordinate" if name in data.coords else "variable",
        # The storage of a text names its length.
        "storage": "" if text else str(packed),
    }


def attribute_differences(where: str, new: Mapping, old: Mapping) -> Iterator[Finding]:
    """Attributes that are absent on one side, or have another value or type."""
    for key in sorted({*new, *old}):
        found, expected = (repr(attributes.get(key, "absent")) for attributes in (new, old))
        if found != expected:
            text = f"attribute {key} of {where} is {found}, in the reference {expected}"
            yield Finding("content", text, (2.0,))


def value_differences(name: str, new: xr.Dataset, old: xr.Dataset) -> Iterator[Finding]:
    """The place where a variable is furthest from the reference, if beyond the tolerance."""
    x = new[name].values
    y = old[name].values
    numbers = y.dtype.kind == "f"
    allowed = tolerance(name, old)
    multiple = multiples(x, y, allowed) if numbers else np.where(x != y, np.inf, 0.0)
    count = np.count_nonzero(multiple > 1)
    if count == 0:
        return
    worst = np.unravel_index(np.argmax(multiple), y.shape)
    places = [
        f"{dim} = {old[dim].values[index] if dim in old.coords else index}"
        for dim, index in zip(old[name].dims, worst, strict=True)
    ]
    found, expected = legible(x[worst], y[worst])
    text = f"{name} is {found}, the reference has {expected}"
    if places:
        text += f" at {', '.join(places)}"
    if np.isfinite(multiple[worst]):
        text += f" (tolerance {allowed[worst]:.1e}, exceeded {multiple[worst]:.2g} times)"
    if count > 1:
        text += f", and {count - 1} more of {y.size} values"
    kind = "verdict" if name == "verdict" else "number" if numbers else "content"
    yield Finding(kind, text, (-multiple[worst],))


def tolerance(name: str, old: xr.Dataset) -> np.ndarray:
    """The differences allowed from the numbers of a variable; zero if none is declared."""
    attributes = old[name].attrs
    if "tolerance_scale" in attributes:
        scale = abs(old[attributes["tolerance_scale"]].values)
    elif "tolerance" in attributes:
        scale = np.maximum(abs(old[name].values), attributes["floor"])
    else:
        scale = np.zeros(old[name].shape)
    return attributes.get("tolerance", 0.0) * scale


def multiples(x: np.ndarray, y: np.ndarray, allowed: np.ndarray) -> np.ndarray:
    """|x - y| over what is allowed; infinite where one is NaN or infinite and the other is not."""
    equal = (x == y) | (np.isnan(x) & np.isnan(y))
    with np.errstate(all="ignore"):
        ratio = abs(x - y) / allowed
    return np.where(equal, 0.0, np.where(np.isnan(ratio), np.inf, ratio))


def legible(found: Any, expected: Any) -> tuple[str, str]:
    """Two values in as few digits as tell them apart, but at least four."""
    if not isinstance(found, float):
        return excerpts(str(found), str(expected))
    digits = next(
        (digits for digits in range(4, 18) if f"{found:.{digits}g}" != f"{expected:.{digits}g}"), 18
    )
    return f"{found:.{digits}g}", f"{expected:.{digits}g}"


def excerpts(first: str, second: str) -> tuple[str, str]:
    """Two texts; of long ones 80 characters, from shortly before they part."""
    same = len(list(takewhile(lambda pair: pair[0] == pair[1], zip(first, second, strict=False))))
    start = max(0, same - 30) if max(len(first), len(second)) > 80 else 0
    return first[start : start + 80], second[start : start + 80]


def record(data: xr.Dataset, key: str) -> dict:
    """The parameters or versions that a dataset records; none if the record cannot be read."""
    try:
        return dict(json.loads(data.attrs[key]))
    except (KeyError, ValueError, TypeError):
        return {}


def changes(old: Mapping, new: Mapping, above: str = "") -> list[str]:
    """Changed parameters, as "frequency_ratio.max 1000.0 -> 500.0" or "amplitude: new 1.2"."""
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

DESCRIPTION = re.compile(r"<dc:description>[^<]*</dc:description>")
"""The provenance in an SVG; without "<" it can contain nothing that is drawn."""


def file_difference(made: Path, path: Path, loosely: bool) -> Finding | None:
    """How a file differs from what is `made` of its datasets; pictures `loosely` by what they draw.

    An arrow in the text of a finding leads from the file to what is made.
    """
    try:
        if path.suffix == ".nc":
            found = dataset_differences(datasets.read(made), datasets.read(path))
            named = [
                replace(each, text=each.text.replace("the reference", "the file")) for each in found
            ]
            return min(named, key=lambda each: each.rank, default=None)
        if path.suffix == ".png":
            return None if loosely else png_difference(made, path)
        return text_difference(made, path, loosely)
    except Exception as error:  # Whatever readers of damaged files raise.
        return Finding("file", f"it cannot be read: {error!r}")


def text_difference(made: Path, path: Path, loosely: bool) -> Finding | None:
    """How two texts, which may be pictures as SVG, differ."""
    texts = [file.read_text(encoding="utf-8", errors="replace") for file in (path, made)]
    if path.suffix == ".svg":
        texts = [DESCRIPTION.sub("", text, count=1) for text in texts]
    if texts[0] == texts[1]:
        return None
    if path.suffix == ".svg" and loosely:
        return outline_difference(*texts)
    lines = [text.splitlines(keepends=True) for text in texts]
    number, pair = next(
        (number, pair)
        for number, pair in enumerate(zip_longest(*lines, fillvalue=""), 1)
        if pair[0] != pair[1]
    )
    words = " -> ".join(repr(excerpt) for excerpt in excerpts(*pair))
    if path.suffix == ".svg":
        return Finding("picture", f"line {number}: {words}", (1.0,))
    titles = "the file", "as its datasets give it"
    unified = difflib.unified_diff(lines[0], lines[1], *titles, n=1)
    return Finding("text", f"line {number}: {words}", lines="".join(unified))


def png_difference(made: Path, path: Path) -> Finding | None:
    """How two PNG files differ in pixels, with an image of the difference, or in other chunks."""
    files = path, made
    images = [Image.open(io.BytesIO(file.read_bytes())) for file in files]
    chunks = [png_chunks(file.read_bytes()) for file in files]
    if images[0].size != images[1].size:
        return Finding("picture", f"its size: {images[0].size} -> {images[1].size}")
    pixels = [np.asarray(image.convert("RGBA")) for image in images]
    unequal = np.any(pixels[0] != pixels[1], axis=-1)
    if np.any(unequal):
        marked = Image.fromarray(np.where(unequal, 0, 255).astype("uint8"))
        uris = tuple(data_uri(image) for image in (*images, marked))
        return Finding("picture", f"{np.count_nonzero(unequal)} pixels differ", images=uris)
    if chunks[0] != chunks[1]:
        kinds = [" ".join(kind for kind, _ in each) for each in chunks]
        return Finding("picture", f"its chunks: {kinds[0]} -> {kinds[1]}")
    return None


def png_chunks(data: bytes) -> list[tuple[str, bytes]]:
    """Chunks of a PNG file, without its provenance and without its compressed pixels."""
    chunks = []
    start = 8
    while start < len(data):
        length = int.from_bytes(data[start : start + 4], "big")
        kind = data[start + 4 : start + 8].decode("latin-1")
        content = data[start + 8 : start + 8 + length]
        start += 12 + length
        if not content.startswith(b"Description\0"):
            chunks.append((kind, b"" if kind == "IDAT" else content))
    # Pixels may be cut into several chunks.
    return [
        chunk for chunk, before in zip(chunks, [None, *chunks], strict=False) if chunk != before
    ]


def data_uri(image: Image.Image) -> str:
    """An image for a page that needs no other file."""
    file = io.BytesIO()
    image.save(file, "PNG")
    return f"data:image/png;base64,{base64.b64encode(file.getvalue()).decode()}"


# Pictures of another matplotlib

SVG = "{http://www.w3.org/2000/svg}"
NUMBER = re.compile(r"-?\d[\d.]*(?:e[-+]?\d+)?")

HREF = "{http://www.w3.org/1999/xlink}href"
PLACES = {"id", "d", "x", "y", "width", "height", "clip-path", "transform", "viewBox", HREF}
"""Attributes that say where an element is, and what its outline is."""

CURVE_TOLERANCE = 1.0
"""How far something may be off within its axes, in points: about the width of a line."""

LAYOUT_TOLERANCE = 8.0
"""How far axes, labels and legends may be off, in points: the size of a letter."""


@dataclass(frozen=True)
class Shape:
    """An element of an SVG: its look, and its segments, of shape (number, 2, 2), in a box.

    The box, that of the axes to which the element is clipped or that of the picture, is left, top,
    width and height in points; segments are in units of it.
    """

    look: str
    clipped: bool
    box: np.ndarray
    segments: np.ndarray


def outline_difference(old: str, new: str) -> Finding | None:
    """How two SVG files of different versions of matplotlib differ in what they draw.

    Elements must have the same look in the same order, and lie at the same place but for the
    tolerances above. Letters are compared as words, which matplotlib writes in comments.
    """
    for found, expected in zip_longest(drawn(old), drawn(new)):
        if found is None or expected is None or found.look != expected.look:
            looks = [shape.look if shape else "nothing" for shape in (found, expected)]
            return Finding("picture", f"it draws {' -> '.join(excerpts(*looks))}", (1.0,))
        size = expected.box[2:]
        allowed = CURVE_TOLERANCE if expected.clipped else LAYOUT_TOLERANCE
        if distance(found.segments * size, expected.segments * size) > allowed:
            return Finding("picture", f"{found.look} is drawn elsewhere", (1.0,))
    return None


def drawn(svg: str) -> Iterator[Shape]:
    """All elements of an SVG that matplotlib wrote."""
    parser = ElementTree.XMLParser(target=ElementTree.TreeBuilder(insert_comments=True))
    root = ElementTree.fromstring(svg, parser)
    named = {element.get("id"): element for element in root.iter()}
    return shapes(root, named, np.array(root.attrib["viewBox"].split(), float))


def shapes(
    element: ElementTree.Element,
    named: Mapping[str | None, ElementTree.Element],
    box: np.ndarray,
    clipped: bool = False,
) -> Iterator[Shape]:
    """An element and all in it, in order, without metadata and without the letters of words."""
    if "clip-path" in element.attrib:
        rectangle = named[element.attrib["clip-path"][len("url(#") : -1]][0]
        box = np.array([rectangle.attrib[key] for key in ("x", "y", "width", "height")], float)
        clipped = True
    outline = (segments(element, named) - box[:2]) / box[2:]
    yield Shape(look_of(element), clipped, box, outline)
    if element.tag != SVG + "metadata" and "transform" not in element.attrib:
        for child in element:
            yield from shapes(child, named, box, clipped)


def look_of(element: ElementTree.Element) -> str:
    """How an element is drawn: its attributes without places, its words, and if it has letters."""
    attributes = [
        key if key in PLACES else f"{key}={value}" for key, value in sorted(element.attrib.items())
    ]
    turned = re.sub(r"translate\([^)]*\)", "", element.get("transform", ""))
    kind = "words" if callable(element.tag) else element.tag.removeprefix(SVG)
    letters = "" if element.find(SVG + "use") is None else "letters"
    words = [kind, *attributes, turned, letters, (element.text or "").strip()]
    return f"[{' '.join(word for word in words if word)}]"


def segments(element: ElementTree.Element, named: Mapping) -> np.ndarray:
    """The segments of a path or of a copy of it, of curves those between control points.

    Words have a point where they start, and a rectangle has its diagonal.
    """
    parts = [np.empty((0, 2, 2))]
    for piece in element.get("d", "").split("M")[1:]:
        points = np.array(NUMBER.findall(piece), float).reshape(-1, 2)
        parts.append(np.stack([points[:-1], points[1:]], axis=1))
    place = [element.attrib[key] for key in ("x", "y") if key in element.attrib]
    place += NUMBER.findall(element.get("transform", ""))[:2]
    if HREF in element.attrib:
        path = named[element.attrib[HREF].removeprefix("#")]
        return segments(path, named) + np.array(place or ["0", "0"], float)
    if place:
        size = [element.get("width", "0"), element.get("height", "0")]
        corners = np.cumsum(np.array([place, size], float), axis=0)
        parts.append(corners[np.newaxis])
    return np.concatenate(parts)


def distance(first: np.ndarray, second: np.ndarray) -> float:
    """The largest distance of a point of one set of segments from the other set (Hausdorff).

    Points are the ends of segments and three between them.
    """
    if len(first) == 0 or len(second) == 0:
        return 0.0 if len(first) == len(second) else np.inf
    return max(farthest(first, second), farthest(second, first))


def farthest(first: np.ndarray, second: np.ndarray) -> float:
    """The largest distance of a point of the first segments from the second."""
    along = np.linspace(0, 1, 5)[:, np.newaxis, np.newaxis]
    points = (first[:, 0] + along * (first[:, 1] - first[:, 0])).reshape(-1, 1, 2)
    start = second[:, 0]
    step = second[:, 1] - start
    length = np.maximum(np.sum(step**2, axis=-1), np.finfo(float).tiny)
    nearest = np.clip(np.sum((points - start) * step, axis=-1) / length, 0, 1)
    gaps = points - start - nearest[..., np.newaxis] * step
    return float(np.max(np.min(np.linalg.norm(gaps, axis=-1), axis=1)))

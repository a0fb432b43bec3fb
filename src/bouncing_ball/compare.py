"""The comparison of results with the reference, and how results become the reference.

The reference is kept in git: the folder `figures` with datasets, pictures and tables, and the texts
`paper.md` and `supplement.md`. A run writes the same files into a folder of its own, `results`.
Three comparisons are made:

1. Each dataset of the results with that of the reference: names, dimensions, types, attributes,
   texts and places of NaN exactly, numbers within the tolerance that the reference declares beside
   the variable (`datasets` says what it means). A result that records other parameters than those
   of the configuration, or other code than today's, is stale, whatever else it says. Commit, code
   and versions of the reference are shown and not judged.
2. Pictures, tables and texts are functions of datasets. Today's code makes them again from the
   datasets of the *reference*, and they must equal the files of the reference: texts exactly, SVG
   byte for byte but for its description, PNG pixel for pixel. The datasets being the same, there
   is no rounding to forgive.
3. Made from the datasets of the *results*, they must equal the files of the results in the same
   way. Otherwise a picture is older than its dataset, or was edited.

Another version of matplotlib places texts, and with them everything else, a little differently.
Then SVG files are compared by what they draw: strokes, fills, words and curves. PNG files are not
compared, and the report says so.
"""

import base64
import difflib
import io
import json
import os
import re
import shutil
import subprocess
import tempfile
from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import takewhile, zip_longest
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import jinja2
import matplotlib
import netCDF4
import numpy as np
import xarray as xr
from PIL import Image

from bouncing_ball import (
    article,
    claims,
    datasets,
    drawing,
    figures,
    restitution,
    spring_damper,
    tables,
    verdicts,
)

Datasets = Mapping[str, xr.Dataset]
"""Datasets by the names of their artifacts."""

Code = tuple[str | Path, ...]
"""Files of code, templates and numbers that a product is made by."""


# Files, and the datasets that they follow from


@dataclass(frozen=True)
class Product:
    """Files that follow from the datasets `needs`; `make` writes them into a folder by `code`."""

    files: tuple[str, ...]
    needs: tuple[str, ...]
    make: Callable[[Datasets, Path], None]
    code: Code

    @property
    def artifact(self) -> str:
        """The name of the figure, table or text."""
        return Path(self.files[0]).stem


PRINTED = Path(__file__).parents[2] / "config" / "table1_printed.csv"
DRAWING: Code = (figures.__file__, drawing.__file__)
JUDGING: Code = (
    claims.__file__,
    verdicts.__file__,
    restitution.__file__,
    spring_damper.__file__,
    PRINTED,
)
WRITING: Code = (
    article.__file__,
    tables.__file__,
    *JUDGING,
    *sorted(article.TEMPLATES.glob("*.md.j2")),
)


def picture(name: str, *needs: str) -> Product:
    """A figure, drawn from its dataset as PNG and as SVG."""
    files = (f"figures/{name}.png", f"figures/{name}.svg")

    def make(data: Datasets, folder: Path) -> None:
        figure = figures.draw(name, *(data[need] for need in needs))
        png, svg = (folder / file for file in files)
        drawing.save_picture(figure, png, svg, datasets.commit())

    return Product(files, needs, make, DRAWING)


def text(
    file: str,
    needs: tuple[str, ...],
    write: Callable[[Datasets], str],
    code: Code = WRITING,
) -> Product:
    """A file of text."""

    def make(data: Datasets, folder: Path) -> None:
        (folder / file).write_text(write(data), encoding="utf-8", newline="\n")

    return Product((file,), needs, make, code)


def table(name: str, rows: Callable[[xr.Dataset], list[list[str]]]) -> list[Product]:
    """A table of a dataset as Markdown and as CSV."""
    code = (tables.__file__, claims.__file__, verdicts.__file__)
    return [
        text(f"figures/{name}.md", (name,), lambda data: tables.markdown(rows(data[name])), code),
        text(
            f"figures/{name}.csv",
            (name,),
            lambda data: tables.comma_separated(rows(data[name])),
            code,
        ),
    ]


def judge(data: Datasets, folder: Path) -> None:
    """Write the verdicts on the claims, with what the dataset of claims records of itself."""
    judged = claims.judge({name: data[name] for name in STUDIES}, datasets.printed_table(PRINTED))
    title = data["claims"].attrs["title"]
    path = folder / "figures" / "claims.nc"
    datasets.save(judged, path, title, record(data["claims"], "parameters"), code=[])


FIGURES = [f"fig{number:02}" for number in range(1, 17)]
SCHEMATICS = ["fig01", "fig04"]
STUDIES = [name for name in FIGURES if name not in SCHEMATICS]
STUDIES += ["table1", "thresholds", "three_balls", "lowest_doubling", "table1_readings"]
ALL = (*STUDIES, "claims")
"""All datasets. The claims follow from the others, which are computed from the model."""

PRODUCTS = [
    *(picture(name) for name in SCHEMATICS),
    *(picture(name, name) for name in FIGURES if name not in SCHEMATICS),
    *(product for name, rows in tables.TABLES.items() for product in table(name, rows)),
    Product(("figures/claims.nc",), ALL, judge, JUDGING),
    text("figures/claims.md", ("claims",), lambda data: tables.claims_markdown(data["claims"])),
    table("claims", tables.all_claims)[1],
    text("paper.md", ALL, article.paper),
    text("supplement.md", ALL, article.supplement),
    text("figures/README.md", ALL, article.figure_list),
]
"""All files that follow from datasets, and how."""


# Differences

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


# Datasets

PROVENANCE = ("commit", "code", "versions")
"""Attributes of the reference that are shown and not judged."""

STORAGE = ("dtype", "scale_factor", "add_offset", "_FillValue", "missing_value", "_Unsigned")
"""How a file packs a variable; other encodings, such as compression, do not change values."""


def dataset_differences(new: xr.Dataset, old: xr.Dataset) -> Iterator[Finding]:
    """Differences of a dataset from the reference `old`, whose tolerances apply."""
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
    for change in changes(record(old, "parameters"), record(new, "parameters")):
        yield Finding("content", f"parameter {change}", (1.0,))
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
    yield Finding(kind, text, (y.size, -multiple[worst]))


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
    """Changed parameters, as "frequency_ratio.max 1000.0 -> 500.0"."""
    found = []
    for key in sorted({*old, *new}):
        values = old.get(key, "absent"), new.get(key, "absent")
        if all(isinstance(value, Mapping) for value in values):
            found += changes(*values, f"{above}{key}.")
        elif values[0] != values[1]:
            found.append(f"{above}{key} {values[0]} -> {values[1]}")
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
        return known_difference(made, path, loosely)
    except Exception as error:  # Whatever readers of damaged files raise.
        return Finding("file", f"it cannot be read: {error!r}")


def known_difference(made: Path, path: Path, loosely: bool) -> Finding | None:
    """As `file_difference`, of files that can be read."""
    if path.suffix == ".nc":
        difference = next(dataset_differences(datasets.read(made), datasets.read(path)), None)
        words = difference.text.replace("the reference", "the file") if difference else ""
        return difference and replace(difference, text=words)
    if path.suffix == ".png":
        return None if loosely else png_difference(made, path)
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


# Causes


def cause(files: Collection[str | Path], commit: str) -> str:
    """The changed files, as far as git knows, among those that a result is made from.

    First what is not committed, then what this branch changed against the main one; only if there
    is none of these, what changed since `commit`, that of the reference.
    """
    if not files:
        return "causes are unknown"
    paths = [str(Path(file).resolve()) for file in files]
    folder = Path(paths[0]).parent
    if git(folder, "rev-parse", "HEAD") is None:
        return "causes are unknown without git"
    edited = changed_files(folder, paths, "HEAD") or []
    created = git(folder, "ls-files", "--others", "--full-name", "--", *paths) or ""
    uncommitted = sorted({*edited, *created.splitlines()})
    changed = [f"{name} (not committed)" for name in uncommitted]
    main = "origin/main" if git(folder, "rev-parse", "--verify", "origin/main") else "main"
    fork = git(folder, "merge-base", "HEAD", main)
    branch = changed_files(folder, paths, fork, "HEAD") if fork else None
    changed += [f"{name} (on this branch)" for name in branch or [] if name not in uncommitted]
    if changed:
        return f"changed: {', '.join(changed)}"
    since = changed_files(folder, paths, commit[:40], "HEAD")
    if since is None:
        return "causes are unknown: git does not know the commit of the reference"
    if since:
        return f"also changed since the reference was made: {', '.join(since)}"
    return "no file that it is made from has changed"


def changed_files(folder: Path, paths: list[str], *commits: str) -> list[str] | None:
    """Files that differ between two commits, or one and the checkout; none if git fails."""
    revisions = [*commits, "--", *paths]
    names = git(folder, "diff", "--name-only", *revisions)
    return None if names is None else names.splitlines()


def git(folder: Path, *arguments: str) -> str | None:
    """The answer of git in a folder; none if there is no git or it refuses."""
    command = ["git", "-C", str(folder), "-c", "core.quotePath=off", *arguments]
    environment = os.environ | {"GIT_OPTIONAL_LOCKS": "0"}
    try:
        answer = subprocess.run(
            command, capture_output=True, check=False, encoding="utf-8", env=environment
        )
    except OSError:
        return None
    return answer.stdout.strip() if answer.returncode == 0 else None


# The comparison


@dataclass(frozen=True)
class Report:
    """What was found, the most telling first, and what else a reader should know.

    `consequences` are files of the results that differ from those of the reference because their
    datasets do; they are shown and not counted. `provenance` has a line for each dataset of the
    reference, and `notes` say what was not compared.
    """

    findings: list[Finding]
    consequences: list[Finding]
    provenance: list[str]
    notes: list[str]
    files: int

    @property
    def lines(self) -> list[str]:
        """The report on a terminal: the most telling finding of each artifact, then the verdict."""
        first: dict[str, str] = {}
        for finding in self.findings:
            first.setdefault(finding.artifact, finding.line)
        verdict = f"All {self.files} files agree with the reference."
        if first:
            verdict = f"Differences: {len(self.findings)}, in {', '.join(sorted(first))}."
        return [*first.values(), " ".join([verdict, *self.notes])]


@dataclass(frozen=True)
class Side:
    """The folder of the results or of the reference, with the datasets that could be read."""

    name: str
    folder: Path
    data: dict[str, xr.Dataset]

    def other_matplotlib(self, names: Collection[str] = ()) -> set[str]:
        """Versions of matplotlib that made all or some of this side, and are not that of today."""
        made = [self.data[name] for name in names or self.data]
        found = {str(record(data, "versions").get("matplotlib")) for data in made}
        return found - {matplotlib.__version__}


def compare(
    results: str | Path,
    reference: str | Path,
    artifacts: Mapping[str, Mapping],
    names: Collection[str] = (),
) -> Report:
    """Compare the results in a folder with the reference: all, or those with the names given.

    `artifacts` has for each dataset the "parameters" of the configuration and the files of "code"
    that compute it; "settings" are parameters that count where a result records them. Without
    parameters and code it is unknown whether a result is stale, and why it differs. Raises
    ValueError if the results are the reference itself.
    """
    compared, products = chosen(names)
    files = [f"figures/{name}.nc" for name in compared]
    files += [file for product in products for file in product.files if file not in files]
    folders = Path(results), Path(reference)
    refuse_links(*folders, files)
    needed = [name for name in ALL if any(name in product.needs for product in products)]
    new, old = (
        Side(name, folder, load(folder, [*compared, *needed] or STUDIES))
        for name, folder in zip(("results", "reference"), folders, strict=True)
    )
    whole = len(products) == len(PRODUCTS)
    findings = [*file_findings(new, files, whole), *file_findings(old, files, whole)]
    for name in compared:
        if name in new.data and name in old.data:
            artifact = artifacts.get(name, {})
            findings += dataset_findings(name, new.data[name], old.data[name], artifact)
    with tempfile.TemporaryDirectory() as scratch:
        for side in (new, old):
            (Path(scratch) / side.name / "figures").mkdir(parents=True)
        for product in products:
            findings += product_findings(product, new, old, Path(scratch))
    kinds = list(KINDS)
    findings.sort(key=lambda each: (kinds.index(each.kind), each.order, each.artifact))
    red = {finding.artifact for finding in findings}
    return Report(
        findings,
        [
            finding
            for product in products
            if red.intersection(product.needs)
            for finding in consequences(product, new, old)
        ],
        [provenance(name, old.data[name]) for name in compared if name in old.data],
        notes(new, old, artifacts),
        len(files),
    )


def chosen(names: Collection[str]) -> tuple[list[str], list[Product]]:
    """The datasets and products to compare: those named, and those that need no other datasets."""
    if not names:
        return list(ALL), PRODUCTS
    products = [
        product
        for product in PRODUCTS
        if product.artifact in names or (product.needs and set(product.needs) <= set(names))
    ]
    return [name for name in ALL if name in names], products


def refuse_links(results: Path, reference: Path, files: Collection[str]) -> None:
    """Refuse results that are the reference, or lie in it, also by links."""
    inside = results.resolve().is_relative_to((reference / "figures").resolve())
    pairs = [(results / file, reference / file) for file in ["", "figures", *files]]
    same = [
        pair for pair in pairs if all(path.exists() for path in pair) and pair[0].samefile(pair[1])
    ]
    if inside or same:
        path = same[0][0] if same else results
        raise ValueError(f"{path} is a part of the reference: results must be files of their own")


def load(folder: Path, names: Collection[str]) -> dict[str, xr.Dataset]:
    """The datasets of a folder that can be read, without groups that nobody sees."""
    data = {}
    for name in dict.fromkeys(names):
        path = folder / "figures" / f"{name}.nc"
        try:
            with netCDF4.Dataset(path) as file:
                hidden = list(file.groups)
            if not hidden:
                data[name] = datasets.read(path)
        except Exception:  # Whatever readers of damaged files raise; `file_findings` tells.
            continue
    return data


def file_findings(side: Side, files: Collection[str], whole: bool) -> Iterator[Finding]:
    """Files of one side that are missing, unreadable or, in a `whole` comparison, unexpected."""
    folder = side.folder / "figures"
    present = sorted(folder.iterdir()) if whole and folder.is_dir() else []
    texts = {
        file: f"figures/{path.name} of the {side.name} is made by no rule"
        for path in present
        if (file := f"figures/{path.name}") not in files and not path.name.startswith(".")
    }
    for file in files:
        if not (side.folder / file).is_file():
            texts[file] = f"{file} is missing in the {side.name}"
        elif file.endswith(".nc") and Path(file).stem not in side.data:
            texts[file] = f"{file} of the {side.name} cannot be read, or has groups"
    for file, words in texts.items():
        name = Path(file).stem
        yield Finding("file", words, artifact=name, of_results=side.name == "results")


def dataset_findings(
    name: str, new: xr.Dataset, old: xr.Dataset, artifact: Mapping
) -> Iterator[Finding]:
    """Whether a dataset is stale, and where it differs from the reference, with the cause."""
    for words in staleness(new, artifact):
        yield Finding("stale", words, artifact=name, of_results=True)
    try:
        differences = list(dataset_differences(new, old))
    except (KeyError, TypeError, ValueError) as error:
        differences = [Finding("file", f"the datasets cannot be compared: {error!r}")]
    if differences:
        changed = "; ".join(changes(record(old, "parameters"), record(new, "parameters")))
        commit = str(old.attrs.get("commit"))
        why = (
            f"changed parameter: {changed}" if changed else cause(artifact.get("code", ()), commit)
        )
        yield from (replace(each, artifact=name, cause=why) for each in differences)


def staleness(new: xr.Dataset, artifact: Mapping) -> Iterator[str]:
    """Why a result is not that of today's configuration and code."""
    if "parameters" in artifact:
        recorded = record(new, "parameters")
        settings = {
            key: value for key, value in artifact.get("settings", {}).items() if key in recorded
        }
        wanted = datasets.plain({**artifact["parameters"], **settings})
        changed = changes(recorded, wanted)
        if changed:
            yield f"stale: the configuration is another than it was made with: {'; '.join(changed)}"
    if "code" in artifact and new.attrs.get("code") != datasets.digest(artifact["code"]):
        yield "stale: it was made by other code than today's"


def product_findings(product: Product, new: Side, old: Side, scratch: Path) -> Iterator[Finding]:
    """Files of both sides that are not what today's code makes of the datasets of that side."""
    commit = next((str(data.attrs.get("commit")) for data in old.data.values()), "unknown")
    for side in (old, new):
        made = scratch / side.name
        if any(need not in side.data for need in product.needs):
            continue
        if side is new and all(
            need in old.data and same_bits(new.data[need], old.data[need]) for need in product.needs
        ):
            made = scratch / old.name
        else:
            try:
                product.make(side.data, made)
            except Exception as error:  # Whatever a drawing does not find in an older dataset.
                words = f"today's code cannot make it of the dataset in the {side.name}: {error!r}"
                yield Finding("file", words, artifact=product.artifact, of_results=side is new)
                return
        loosely = bool(side.other_matplotlib(product.needs))
        for file in product.files:
            path = side.folder / file
            difference = file_difference(made / file, path, loosely) if path.is_file() else None
            if difference:
                what = f"today's code makes another {file} of the reference"
                if side is new:
                    what = f"{file} in the results is not what its dataset gives"
                why = "" if side is new else cause(product.code, commit)
                words = f"{what}: {difference.text}"
                named = replace(difference, artifact=product.artifact, text=words)
                yield replace(named, cause=why, of_results=side is new)


def consequences(product: Product, new: Side, old: Side) -> Iterator[Finding]:
    """Texts and PNG files in the results that differ from those in the reference."""
    for file in product.files:
        paths = new.folder / file, old.folder / file
        if not file.endswith(".svg") and all(path.is_file() for path in paths):
            difference = file_difference(*paths, loosely=False)
            if difference:
                yield replace(difference, artifact=product.artifact)


def provenance(name: str, old: xr.Dataset) -> str:
    """What a dataset of the reference records of its making."""
    versions = ", ".join(f"{key} {value}" for key, value in record(old, "versions").items())
    commit, code = (old.attrs.get(key, "unknown") for key in ("commit", "code"))
    return f"{name}: commit {commit}, code {code[:12]}, {versions}"


def notes(new: Side, old: Side, artifacts: Mapping[str, Mapping]) -> list[str]:
    """What was not compared."""
    found = []
    other = sorted(new.other_matplotlib() | old.other_matplotlib())
    if other:
        found.append(
            f"Pictures of matplotlib {', '.join(other)} were compared with those of "
            f"{matplotlib.__version__} by strokes, fills, words and curves, and not by pixels."
        )
    known = [{"parameters", "code"} <= set(artifacts.get(name, {})) for name in new.data]
    if not all(known):
        found.append("It is not known whether today's code made the results.")
    return found


def page(report: Report, template: Path) -> str:
    """The report as a page of HTML that needs no other file."""
    environment = jinja2.Environment(autoescape=True, undefined=jinja2.StrictUndefined)
    written = environment.from_string(template.read_text(encoding="utf-8"))
    return written.render(report=report, kinds=KINDS)


# How results become the reference

CODE = ("Snakefile", "config", "src", "workflow")
"""What must be committed, so that the commit that a reference names is the code that made it."""


def accept(
    results: str | Path,
    reference: str | Path,
    artifacts: Mapping[str, Mapping],
    names: Collection[str] = (),
) -> list[str]:
    """Make results the reference: those named, or all that differ; returns the files written.

    Datasets are copied, and name the commit of today. Pictures and texts, of these and of texts
    that depend on them, are made anew from the datasets that are then the reference. Raises
    ValueError, with the reason, if a result is stale, incomplete, or not what its dataset gives,
    and if the code is not committed.
    """
    old_folder = Path(reference)
    commit = datasets.commit(old_folder).removesuffix("+dirty")
    if not re.fullmatch("[0-9a-f]{40}", commit):
        raise ValueError(f"nothing is accepted, because the commit of the code is {commit}")
    edited = git(old_folder, "status", "--porcelain", "--untracked-files=all", "--", *CODE) or ""
    if edited:
        raise ValueError(f"nothing is accepted, commit first: {', '.join(edited.splitlines())}")
    report = compare(results, reference, artifacts, names)
    new = Side("results", Path(results), load(Path(results), ALL))
    unfit = [finding.line for finding in report.findings if finding.of_results]
    unfit += notes(new, new, artifacts)
    if unfit:
        raise ValueError(f"nothing is accepted: {unfit[0]}")
    red = {finding.artifact for finding in report.findings}
    with tempfile.TemporaryDirectory() as scratch:
        stage(red, new, load(old_folder, ALL), Path(scratch), commit)
        return list(replaced(Path(scratch), old_folder))


def stage(red: Collection[str], new: Side, old: Datasets, folder: Path, commit: str) -> None:
    """Write what becomes the reference into a folder: datasets, and what is made from them."""
    (folder / "figures").mkdir()
    data = dict(old)
    for name in red:
        if name in new.data and (
            name not in old
            or any(dataset_differences(new.data[name], old[name]))
            # Its pictures are drawn anew, by the matplotlib of today.
            or record(old[name], "versions").get("matplotlib") != matplotlib.__version__
        ):
            data[name] = stamped(new.folder, folder, name, commit)
    accepted = [name for name in data if data[name] is not old.get(name)]
    for product in PRODUCTS:
        concerned = product.artifact in red or any(need in accepted for need in product.needs)
        if not concerned or any(need not in data for need in product.needs):
            continue
        product.make(data, folder)
        if product.artifact == "claims":
            data["claims"] = fitting_claims(new, old, folder, commit)


def fitting_claims(new: Side, old: Datasets, folder: Path, commit: str) -> xr.Dataset:
    """The claims of the reference or of the results, whichever the accepted datasets give."""
    path = folder / "figures" / "claims.nc"
    judged = datasets.read(path)
    path.unlink()
    if "claims" in old and not any(dataset_differences(judged, old["claims"])):
        return old["claims"]
    if "claims" in new.data and not any(dataset_differences(judged, new.data["claims"])):
        return stamped(new.folder, folder, "claims", commit)
    raise ValueError("nothing is accepted: it changes the claims; make and accept all results")


def stamped(source: Path, folder: Path, name: str, commit: str) -> xr.Dataset:
    """Copy a dataset into a folder, as a result of a commit that has the code that made it."""
    copy = folder / "figures" / f"{name}.nc"
    shutil.copyfile(source / "figures" / copy.name, copy)
    with netCDF4.Dataset(copy, "a") as file:
        file.setncattr("commit", commit)
    return datasets.read(copy)


def replaced(source: Path, folder: Path) -> Iterator[str]:
    """Move the files that differ from one folder into another, each whole or not at all."""
    for path in sorted(path for path in source.rglob("*") if path.is_file()):
        target = folder / path.relative_to(source)
        if path.suffix == ".nc" or not target.is_file() or file_difference(path, target, False):
            target.parent.mkdir(parents=True, exist_ok=True)
            unfinished = target.with_name(f".{target.name}.part.{os.getpid()}")
            shutil.copyfile(path, unfinished)
            os.replace(unfinished, target)
            yield str(path.relative_to(source))

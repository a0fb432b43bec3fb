"""Two vector graphics: elements and words as they are, coordinates within a budget.

A picture in them, one colour for each sample, is compared as any picture is.

matplotlib leaves out a vertex that is nearer than a ninth of a pixel, here of a
point, to the line through its neighbours (``path.simplify_threshold``): what is
drawn of a curve is known to that, and two drawings of one curve to twice that.
"""

import base64
import binascii
import json
import re
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import zip_longest
from xml.parsers import expat

import numpy as np

from bouncing_ball.compare.outcome import Outcome
from bouncing_ball.compare.pictures import compare_pictures, read_picture
from bouncing_ball.compare.texts import Line
from bouncing_ball.record.reading import MAX_PIXELS, UnreadableError, printable

BUDGET = 2 / 9
"""In points, of a coordinate and of the distance of a vertex from the other line."""
_SVG = "http://www.w3.org/2000/svg"
# What matplotlib draws with. Nothing else is let in: neither a script nor an animation
# nor a picture from elsewhere.
_TAGS = {"svg", "metadata", "defs", "style", "g", "path", "use", "clipPath", "rect", "text"}
_TAGS |= {"pattern", "tspan", "circle", "line", "polyline", "polygon", "ellipse", "image"}
_PICTURE = "data:image/png;base64,"
# Named by matplotlib after a checksum of the coordinates.
_CHECKSUM = re.compile(r"\b(?:image|[a-zA-Z])?[0-9a-f]{10}\b")
_NUMBER = re.compile(r"-?[0-9]+(?:\.[0-9]+)?(?:e-?[0-9]{1,3})?")
_PLACES = {"d", "x", "y", "cx", "cy", "x1", "x2", "y1", "y2", "points", "width", "height"}
_TRANSLATE = re.compile(r"translate\([^()]*\)")
# Vertices times segments of two lines, three times those of our longest curve.
_MAX_PAIRS = 2**20


@dataclass(frozen=True)
class Element:
    """A tag with its attributes, or a text; numbers that are places are taken out.

    ``picture`` is the content of a PNG file.
    """

    words: str
    numbers: tuple[float, ...] = ()
    path: str = ""
    picture: bytes = b""


@dataclass(frozen=True)
class Drawing:
    """All elements in their order, and what the drawing says of itself."""

    elements: tuple[Element, ...]
    metadata: dict[str, str]


def _check_attribute(tag: str, name: str, value: str) -> None:
    """Refuse what may run something or fetch something."""
    local = name.rpartition(" ")[2].lower()
    if local.startswith("on"):
        raise UnreadableError(f"it has an event handler: {printable(local, 40)}")
    held = "#" if tag != "image" else _PICTURE
    if local in ("href", "src", "base") and not value.startswith(held):
        raise UnreadableError(f"it refers to another file: {printable(value, 60)}")
    _check_style(value)


def _check_style(text: str) -> None:
    fetched = re.sub(r"url\(#", "", text)
    if re.search(r"url\s*\(|@|\\|expression|javascript:", fetched, re.IGNORECASE):
        raise UnreadableError(f"it has a style that may fetch: {printable(text, 60)}")


def _decoded(value: str) -> bytes:
    """The PNG file in a reference."""
    try:
        return base64.b64decode("".join(value.removeprefix(_PICTURE).split()), validate=True)
    except (ValueError, binascii.Error):
        raise UnreadableError("it has a picture that is not base64") from None


class _Reader:
    """The parser's handlers, and what they have gathered."""

    def __init__(self) -> None:
        self.elements: list[Element] = []
        self.names: dict[str, str] = {}
        self.description: list[str] = []
        self.open: list[str] = []
        # How deep in a block that tells how the drawing was made.
        self.inside = 0
        self.text: list[str] = []
        self.pixels = 0

    def _flush(self) -> None:
        text = "".join(self.text).strip()
        self.text.clear()
        if text and not self.inside:
            _check_style(text)
            self.elements.append(Element(" ".join(text.split())))
        elif text and self.open[-1].endswith(" description"):
            self.description.append(text)

    def start(self, tag: str, attributes: dict[str, str]) -> None:
        self._flush()
        space, _, name = tag.rpartition(" ")
        if (space == _SVG or not self.inside) and not (space == _SVG and name in _TAGS):
            raise UnreadableError(f"a <{printable(name, 40)}> in it")
        for key, value in attributes.items():
            if not self.inside:
                _check_attribute(name, key, value)
        self.open.append(tag)
        if self.inside or name == "metadata":
            self.inside += 1
        else:
            self.elements.append(self._element(name, attributes))

    def end(self, _: str) -> None:
        self._flush()
        self.open.pop()
        if self.inside:
            self.inside -= 1
        else:
            self.elements.append(Element("end"))

    def comment(self, text: str) -> None:
        self._flush()
        if not self.inside:
            self.elements.append(Element(f"comment {text.strip()}"))

    def refuse(self, *_: object) -> None:
        raise UnreadableError("it has a definition or an instruction")

    def doctype(self, _: str, __: str | None, ___: str | None, internal: bool) -> None:
        if internal:
            self.refuse()

    def _element(self, name: str, attributes: dict[str, str]) -> Element:
        words, numbers, path, picture = [name], [], "", b""
        for key, value in sorted(attributes.items()):
            local = key.rpartition(" ")[2]
            if name == "image" and value.startswith(_PICTURE):
                picture, value = _decoded(value), "a picture"
                self._count(picture)
            value = _CHECKSUM.sub(self._renamed, value)
            if local == "d":
                path = " ".join(value.split())
                value = ""
            elif local in _PLACES:
                numbers += _NUMBER.findall(value)
                value = _NUMBER.sub("#", value)
            elif local == "transform":
                for part in _TRANSLATE.findall(value):
                    numbers += _NUMBER.findall(part)
                value = _TRANSLATE.sub("translate", value)
            # With its namespace: an href in another one refers to nothing.
            words.append(f"{key}={' '.join(value.split())!r}")
        return Element(" ".join(words), tuple(map(float, numbers)), path, picture)

    def _count(self, content: bytes) -> None:
        """Refuse what is not a picture, and many small pictures that take long together."""
        picture = read_picture(content)
        self.pixels += picture.width * picture.height
        if self.pixels > MAX_PIXELS:
            raise UnreadableError("its pictures have too many pixels")

    def _renamed(self, found: re.Match[str]) -> str:
        return self.names.setdefault(found[0], f"({len(self.names) + 1})")


def read_drawing(content: bytes) -> Drawing:
    """A vector graphic, without the block that says how it was made.

    Raises
    ------
    UnreadableError
        If it is not a whole SVG file, or holds what no figure of this workflow does: a
        script, an event handler, a reference to elsewhere.

    Examples
    --------
    >>> svg = b'<svg xmlns="http://www.w3.org/2000/svg"><use x="1.5" onload="f()"/></svg>'
    >>> read_drawing(svg)
    Traceback (most recent call last):
    ...
    bouncing_ball.record.reading.UnreadableError: it has an event handler: onload
    >>> read_drawing(svg.replace(b'onload="f()"', b"")).elements[1]
    Element(words="use x='#'", numbers=(1.5,), path='', picture=b'')
    """
    reader = _Reader()
    parser = expat.ParserCreate("utf-8", " ")
    parser.buffer_text = True
    parser.StartElementHandler = reader.start
    parser.EndElementHandler = reader.end
    parser.CharacterDataHandler = reader.text.append
    parser.CommentHandler = reader.comment
    parser.ProcessingInstructionHandler = reader.refuse
    parser.EntityDeclHandler = reader.refuse
    parser.StartDoctypeDeclHandler = reader.doctype
    try:
        parser.Parse(content, True)
    except expat.ExpatError as error:
        raise UnreadableError(f"not a whole SVG file: {error}") from None
    try:
        described = json.loads("".join(reader.description))
    except (ValueError, RecursionError):
        described = None
    metadata = described if isinstance(described, dict) else {}
    return Drawing(tuple(reader.elements), metadata)


def _vertices(path: str) -> list[np.ndarray] | None:
    """The lines of a path, each of shape (vertices, 2); None if it has a curve."""
    if re.search(r"[^MLzZ0-9e.\s-]", path):
        return None
    lines = []
    for part in path.replace("z", "").replace("Z", "").split("M")[1:]:
        numbers = np.array([float(text) for text in _NUMBER.findall(part)])
        if numbers.size % 2 or not np.isfinite(numbers).all():
            return None
        lines.append(numbers.reshape(-1, 2))
    return lines


def _far(points: list[np.ndarray], lines: list[np.ndarray]) -> float:
    """Largest distance of the inner vertices of some lines from the nearest of others.

    Where a line ends is known to one sample, as stability changes between two.
    """
    inner = np.concatenate([part[1:-1] for part in points] or [np.empty((0, 2))])
    starts = np.concatenate([part[:-1] for part in lines] or [np.empty((0, 2))])
    steps = np.concatenate([np.diff(part, axis=0) for part in lines] or [np.empty((0, 2))])
    if not inner.size:
        return 0.0
    if not starts.size or len(inner) * len(starts) > _MAX_PAIRS:
        return np.inf
    square = (steps**2).sum(axis=1)
    away = inner[:, None] - starts
    along = np.clip((away * steps).sum(axis=2) / np.where(square > 0, square, 1.0), 0.0, 1.0)
    return float(np.hypot(*np.moveaxis(away - along[..., None] * steps, 2, 0)).min(axis=1).max())


def _largest(record: Sequence[float], new: Sequence[float]) -> float:
    """Largest difference, ∞ where there is none."""
    distance = np.abs(np.asarray(record) - np.asarray(new))
    return float(np.max(np.nan_to_num(distance, nan=np.inf), initial=0.0))


def _recoloured(record: Element, new: Element, budget: float) -> float:
    """The share of their budget by which the pictures in two elements differ; ∞ in size."""
    if record.picture == new.picture:
        return 0.0
    if not record.picture or not new.picture:
        return np.inf
    found = compare_pictures(read_picture(record.picture), read_picture(new.picture), budget)
    return np.inf if found.share is None else found.share


def _moved(record: Element, new: Element) -> float:
    """How far the places in an element have moved, in points; ∞ for another element."""
    if record == new:
        return 0.0
    if record.words != new.words or len(record.numbers) != len(new.numbers):
        return np.inf
    if _NUMBER.sub("#", record.path) == _NUMBER.sub("#", new.path):
        old, now = (
            [*each.numbers, *map(float, _NUMBER.findall(each.path))] for each in (record, new)
        )
        return _largest(old, now)
    before, after = _vertices(record.path), _vertices(new.path)
    if before is None or after is None:
        return np.inf
    return max(_largest(record.numbers, new.numbers), _far(before, after), _far(after, before))


def _shown(element: Element | None) -> str | None:
    if element is None:
        return None
    numbers = " ".join(f"{number:g}" for number in element.numbers)
    return " ".join(filter(None, (element.words, numbers, element.path)))


def compare_drawings(
    record: Drawing, new: Drawing, picture_budget: float
) -> tuple[float, tuple[Line, ...]]:
    """The largest share of :data:`BUDGET`, and all elements that are not the same.

    ``picture_budget`` is that of the pictures in them, in grey levels of 255.
    """
    share, lines = 0.0, []
    with np.errstate(all="ignore"):
        for number, (old, each) in enumerate(zip_longest(record.elements, new.elements), start=1):
            if old == each:
                continue
            moved = np.inf
            if old is not None and each is not None:
                recoloured = _recoloured(old, each, picture_budget)
                moved = max(_moved(old, each) / BUDGET, recoloured)
            outcome = Outcome.WITHIN if moved <= 1 else Outcome.DRIFTED
            share = max(share, moved)
            lines.append(Line(f"element {number}", outcome, _shown(old), _shown(each)))
    return share, tuple(lines)

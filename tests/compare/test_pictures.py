"""Pictures against the record: pixels, elements and coordinates decide."""

import base64
import io
import json
import re
import struct
import zlib

import numpy as np
import pytest
from PIL import Image
from PIL.PngImagePlugin import PngInfo

from bouncing_ball.compare.drawings import BUDGET, compare_drawings, read_drawing
from bouncing_ball.compare.outcome import Outcome, status
from bouncing_ball.record.reading import UnreadableError

# Most compare whole folders.
pytestmark = pytest.mark.slow


def swap(pair, one, two):
    paths = [pair.new / "figures" / name for name in (one, two)]
    contents = [path.read_bytes() for path in paths]
    for path, content in zip(paths, reversed(contents), strict=True):
        path.write_bytes(content)


def drawn_by(path, versions):
    """Write into a picture with which versions it was drawn."""
    described = json.dumps({"provenance_versions": versions})
    if path.suffix == ".svg":
        text = path.read_text(encoding="utf-8")
        text = re.sub(r"(<dc:description>).*?(</)", lambda m: m[1] + described + m[2], text)
        path.write_text(text, encoding="utf-8")
        return
    text = PngInfo()
    text.add_text("provenance_versions", versions)
    file = io.BytesIO()
    with Image.open(path) as picture:
        picture.info.clear()
        picture.save(file, "PNG", pnginfo=text)
    path.write_bytes(file.getvalue())


@pytest.mark.parametrize("kind", ["png", "svg"])
@pytest.mark.parametrize(
    ("versions", "decides"),
    [
        ('{"matplotlib": "3.0"}', False),
        # What does not name another matplotlib is no excuse.
        ("{}", True),
        ("[" * 100_000, True),
        (None, True),
    ],
)
def test_another_figures_picture(pair, kind, versions, decides):
    swap(pair, f"fig08.{kind}", f"fig09.{kind}")
    if versions is not None:
        for name in ("fig08", "fig09"):
            drawn_by(pair.new / "figures" / f"{name}.{kind}", versions)
    found = pair.artifact("fig08")
    part = next(part for part in found.parts if part.file == f"figures/fig08.{kind}")
    assert part.outcome is Outcome.DRIFTED and part.decides is decides and part.share > 10
    assert found.outcome is (Outcome.DRIFTED if decides else Outcome.WITHIN)
    assert decides or "drawn by matplotlib" in part.note


def test_swapped_figures_of_different_sizes(pair):
    swap(pair, "fig01.png", "fig08.png")
    part = pair.part("figures/fig01.png")
    sizes = []
    for name in ("fig01", "fig08"):
        with Image.open(pair.record / "figures" / f"{name}.png") as picture:
            sizes.append(" × ".join(map(str, picture.size)))
    assert part.outcome is Outcome.STRUCTURE
    assert part.note == f"size in pixels: {' → '.join(sizes)}"
    assert pair.artifact("fig01").outcome is pair.artifact("fig08").outcome is Outcome.STRUCTURE


def test_a_picture_by_half_and_twice_its_budget(pair):
    path = pair.new / "figures" / "fig08.png"
    with Image.open(path) as picture:
        size = picture.size
        pixels = np.array(picture.convert("RGB"), dtype=int)
    for part, outcome in ((0.5, Outcome.WITHIN), (2.0, Outcome.DRIFTED)):
        # So many pixels of the upper edge by 16 levels that the rms is as wanted.
        step = 16
        count = round((part * pair.rules.pictures.budget / step) ** 2 * size[0] * size[1])
        changed = pixels.copy()
        flat = changed.reshape(-1, 3)
        flat[:count] += np.where(flat[:count] > 127, -step, step)
        Image.fromarray(changed.astype(np.uint8)).save(path)
        result = pair.part("figures/fig08.png")
        assert result.outcome is outcome
        assert result.share == pytest.approx(part, rel=1e-2)


@pytest.mark.parametrize("kind", ["png", "svg"])
def test_what_a_picture_says_of_itself_does_not_count(pair, kind):
    drawn_by(pair.new / "figures" / f"fig08.{kind}", '{"matplotlib": "3.0"}')
    paths = [folder / "figures" / f"fig08.{kind}" for folder in (pair.record, pair.new)]
    assert paths[0].read_bytes() != paths[1].read_bytes()
    assert pair.part(f"figures/fig08.{kind}").outcome is Outcome.IDENTICAL


def test_truncated_picture(pair):
    path = pair.new / "figures" / "fig01.png"
    path.write_bytes(path.read_bytes()[:5000])
    part = pair.part("figures/fig01.png")
    assert part.outcome is Outcome.UNREADABLE and "PNG" in part.note
    assert status(pair.compare().outcome) == 2


@pytest.mark.parametrize("content", [b"", b"text", b"\x89PNG\r\n\x1a\n"])
def test_a_picture_that_is_none(pair, content):
    (pair.new / "figures" / "fig01.png").write_bytes(content)
    part = pair.part("figures/fig01.png")
    # Twice the same words: nothing of this process in them.
    assert part.outcome is Outcome.UNREADABLE and part.note == "new: not a PNG file"


@pytest.mark.parametrize("size", [3000, 9400, 20_000])
def test_a_picture_too_large_to_be_opened(pair, size):
    head = b"IHDR" + struct.pack(">IIBBBBB", size, size, 8, 0, 0, 0, 0)
    crc = struct.pack(">I", zlib.crc32(head))
    path = pair.new / "figures" / "fig01.png"
    begun = struct.pack(">I", 1000) + b"IDAT"
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + struct.pack(">I", 13) + head + crc + begun)
    part = pair.part("figures/fig01.png")
    assert part.outcome is Outcome.UNREADABLE and part.note == "new: too large a picture"


SVG = '<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink">{}</svg>'


def drawing(content):
    return read_drawing(SVG.format(content).encode())


@pytest.mark.parametrize(
    ("content", "said"),
    [
        ("<script>f()</script>", "<script>"),
        ("<metadata><script/></metadata>", "<script>"),
        ("<g onclick='f()'/>", "event handler"),
        ("<g ONLOAD='f()'/>", "event handler"),
        ("<use xlink:href='http://a.b/c.svg#d'/>", "refers to another file"),
        ("<use href='javascript:f()'/>", "refers to another file"),
        ("<image href='a.png'/>", "another file"),
        ("<image href='data:image/svg+xml;base64,PHN2Zy8+'/>", "another file"),
        ("<image href='data:image/png;base64,PHN2Zy8+'/>", "not a PNG file"),
        ("<image href='data:image/png;base64,*'/>", "not base64"),
        ("<use href='data:image/png;base64,PHN2Zy8+'/>", "another file"),
        ("<a href='#b'/>", "<a>"),
        ("<foreignObject/>", "<foreignObject>"),
        ("<animate/>", "<animate>"),
        ("<g xmlns='http://www.w3.org/1999/xhtml'/>", "<g>"),
        ("<g style='fill: url(http://a.b/c)'/>", "style"),
        ("<style>@import 'a.css';</style>", "style"),
        ("<style>*{fill: u\\72l(a)}</style>", "style"),
        ("<?xml-stylesheet href='a.css'?>", "instruction"),
    ],
)
def test_what_may_run_or_fetch_is_refused(pair, content, said, one_line):
    with pytest.raises(UnreadableError) as error:
        drawing(content)
    one_line(error, said)
    # On both sides the same: refused all the same.
    for folder in (pair.record, pair.new):
        path = folder / "figures" / "fig08.svg"
        path.write_text(path.read_text().replace("</svg>", content + "</svg>"))
    assert pair.artifact("fig08").outcome is Outcome.UNREADABLE


@pytest.mark.parametrize(
    "text",
    [
        "<!DOCTYPE svg [<!ENTITY a 'b'>]><svg/>",
        "<!DOCTYPE svg [<!ENTITY a SYSTEM 'file:///etc/hostname'>]><svg>&a;</svg>",
        "<svg",
        "",
        "<svg/><svg/>",
    ],
)
def test_a_drawing_that_is_none(text):
    with pytest.raises(UnreadableError):
        read_drawing(text.encode())


def share(record, new):
    return compare_drawings(drawing(record), drawing(new), 2.0)[0]


def raster(levels):
    """An element with a grey picture in it."""
    file = io.BytesIO()
    Image.fromarray(np.array(levels, dtype=np.uint8)).save(file, "PNG")
    content = base64.b64encode(file.getvalue()).decode()
    return f"<image id='image0123456789' xlink:href='data:image/png;base64,\n{content}'/>"


def test_a_picture_in_a_drawing_is_compared_as_a_picture():
    whole = raster([[0, 9], [99, 200]])
    assert share(whole, whole.replace("0123456789", "abcdef0123")) == 0
    # One of four pixels by two levels: rms 1, of the 2 allowed.
    assert share(whole, raster([[0, 9], [99, 202]])) == pytest.approx(0.5)
    assert share(whole, raster([[0, 9], [99, 240]])) == pytest.approx(10)
    assert share(whole, raster([[0, 9, 99], [99, 200, 9]])) == np.inf
    assert share(whole, "<image/>") == np.inf


def test_a_reference_in_another_namespace_refers_to_nothing():
    whole = raster([[0, 9], [99, 200]])
    assert share(whole, whole.replace("xlink:href", "xmlns:a='urn:a' a:href", 1)) == np.inf


def test_many_pictures_that_take_long_together():
    # White is 3 kB of megapixels: two megabytes of text hold thousands of them.
    many = 5 * raster(np.full((1400, 1400), 255))
    with pytest.raises(UnreadableError, match="too many pixels"):
        drawing(many)


@pytest.mark.parametrize(
    ("record", "new", "moved"),
    [
        ("<use x='1'/>", "<use x='1.1'/>", 0.1),
        ("<path d='M 0 0 L 9 0'/>", "<path d='M 0 0 L 9 0.5'/>", 0.5),
        (
            "<g transform='translate(1 2) scale(2)'/>",
            "<g transform='translate(1 2.5) scale(2)'/>",
            0.5,
        ),
        # Another number of vertices on the same line, and beside it.
        ("<path d='M 0 0 L 9 0 L 9 9'/>", "<path d='M 0 0 L 4 0 L 9 0 L 9 9'/>", 0.0),
        ("<path d='M 0 0 L 9 0 L 9 9'/>", "<path d='M 0 0 L 4 1 L 9 0 L 9 9'/>", 1.0),
        # One sample more, at its end.
        ("<path d='M 0 0 L 4 0 L 9 0'/>", "<path d='M 0 0 L 4 0 L 9 0 L 13 0'/>", 0.0),
        # What is no place.
        ("<g transform='scale(2)'/>", "<g transform='scale(3)'/>", np.inf),
        ("<g id='a'/>", "<g id='b'/>", np.inf),
        ("<g style='fill: #000'/>", "<g style='fill: #001'/>", np.inf),
        ("<path d='M 0 0 L 1 1'/>", "<path d='M 0 0 Q 1 1 2 2'/>", np.inf),
        ("<g><g/></g><g/>", "<g><g/><g/></g>", np.inf),
        ("<!-- 1 --><g/>", "<!-- 2 --><g/>", np.inf),
        ("<text>a</text>", "<text>b</text>", np.inf),
        ("<g/>", "<g/><g/>", np.inf),
        ("<use x='1'/>", "<use x='1e999'/>", np.inf),
    ],
)
def test_places_may_move_and_nothing_else(record, new, moved):
    for a, b in ((record, new), (new, record)):
        assert share(a, b) == pytest.approx(moved / BUDGET)
    assert share(record, record) == 0


def test_names_after_checksums_are_names():
    record = (
        "<path id='m0123456789'/><use xlink:href='#m0123456789'/><g style='a: url(#m0123456789)'/>"
    )
    assert share(record, record.replace("0123456789", "abcdef0123")) == 0
    other = (
        "<path id='m0123456789'/><use xlink:href='#mabcdef0123'/><g style='a: url(#m0123456789)'/>"
    )
    assert share(record, other) == np.inf


def test_a_vector_graphic_decides(pair):
    path = pair.new / "figures" / "fig05.svg"
    text = path.read_text(encoding="utf-8")
    path.write_text(text.replace("</svg>", "<g/></svg>"), encoding="utf-8")
    assert pair.artifact("fig05").outcome is Outcome.DRIFTED
    assert pair.part("figures/fig05.svg").share == np.inf

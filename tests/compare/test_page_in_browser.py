"""The page as a real browser shows it: Chromium without a window and without a network.

The page holds no script. Another page, made here, shows it in a frame and
writes down what the browser made of it.
"""

import json
import re
import shutil

import pytest
from PIL import Image

from bouncing_ball.compare.page import to_html

pytestmark = pytest.mark.slow

OBSERVER = """<!doctype html>
<meta charset="utf-8">
<iframe id="page" src="page.html" width="WIDTH" height="3000"></iframe>
<pre id="seen"></pre>
<script>
// Whether a picture has both white and other pixels, as the browser decodes it.
function drawn(image) {
  if (!image.complete || !image.naturalWidth) return false;
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [image.naturalWidth, image.naturalHeight];
  const context = canvas.getContext("2d");
  context.drawImage(image, 0, 0);
  const red = context.getImageData(0, 0, canvas.width, canvas.height).data
    .filter((_, k) => k % 4 === 0);
  return red.includes(255) && red.some(value => value < 128);
}
// What each mode of the first two pictures that differ makes of them: left edge, width,
// whether it is seen, and the name of what moves it.
function modes(page, view) {
  const viewer = [...page.querySelectorAll(".viewer")].find(each => each.querySelector(".before"));
  const seen = {};
  for (const input of viewer.querySelectorAll("input")) {
    input.click();
    seen[input.id.split("/").pop()] = [...viewer.querySelectorAll("figure")].map(figure => {
      const box = figure.getBoundingClientRect();
      return {
        left: box.left, top: box.top, width: box.width, shown: box.width > 0,
        picture: figure.querySelector("img").getBoundingClientRect().width,
        moved: view.getComputedStyle(figure).animationName,
        wide: viewer.getBoundingClientRect().width,
        resize: view.getComputedStyle(figure).resize,
      };
    });
    if (input.type === "checkbox") input.click();
  }
  return seen;
}
addEventListener("load", () => {
  const page = document.getElementById("page").contentDocument;
  const view = document.getElementById("page").contentWindow;
  const seen = {
    images: [...page.images].map(image => ({
      alt: image.alt, drawn: drawn(image),
      width: image.naturalWidth, height: image.naturalHeight,
    })),
    sections: [...page.querySelectorAll("section")].map(section => ({
      name: section.id, outcome: section.dataset.outcome,
      open: section.querySelector("details").open,
      top: section.getBoundingClientRect().top,
    })),
    cells: [...page.querySelectorAll("td")].map(cell => cell.textContent),
    fetched: view.performance.getEntriesByType("resource").map(entry => entry.name),
    overflow: page.documentElement.scrollWidth - page.documentElement.clientWidth,
    modes: modes(page, view),
  };
  document.getElementById("seen").textContent = JSON.stringify(seen);
});
</script>
"""


def observe(browse, folder, width):
    """What the browser made of page.html in a window so wide."""
    observer = folder / "observer.html"
    observer.write_text(OBSERVER.replace("WIDTH", str(width)), encoding="utf-8")
    text = browse(folder, observer, "--virtual-time-budget=20000", "--dump-dom")
    found = re.search(r'<pre id="seen">(\{.*\})</pre>', text, re.DOTALL)
    assert found, "the page did not load"
    unescaped = found[1].replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&")
    return json.loads(unescaped)


@pytest.fixture(scope="module")
def page(kept_pair, tmp_path_factory):
    """A page with a drifted, a missing, a within-budget and a swapped figure."""
    pair = kept_pair
    data = pair.dataset("fig05")
    data.phase.values[1, 40] += 1e-3
    pair.write("fig05", data)
    shutil.copyfile(pair.new / "figures" / "fig08.png", pair.new / "figures" / "fig09.png")
    (pair.new / "figures" / "fig01.svg").unlink()
    folder = tmp_path_factory.mktemp("browser")
    (folder / "page.html").write_text(to_html(pair.compare()), encoding="utf-8")
    return folder


@pytest.fixture(scope="module")
def seen(page, browse):
    return observe(browse, page, 1200)


def test_the_browser_shows_every_picture_and_the_worst_first(seen, kept_pair):
    found = {image["alt"]: image for image in seen["images"]}
    assert set(found) == {
        "fig01, record and new",
        "fig05, record and new",
        "fig08, record and new",
        "fig09, record",
        "fig09, new",
    }
    for image in found.values():
        assert image["drawn"] and image["width"] > 0 and image["height"] > 0, image
    for name in ("fig09, record", "fig09, new"):
        with Image.open(kept_pair.record / "figures" / "fig09.png") as picture:
            assert (found[name]["width"], found[name]["height"]) == picture.size
    sections = [(part["name"], part["outcome"], part["open"]) for part in seen["sections"]]
    assert sections[:3] == [
        ("fig01", "missing", True),
        ("fig05", "drifted", True),
        ("fig09", "drifted", True),
    ]
    assert {outcome for _, outcome, _ in sections[3:]} == {"identical"}
    tops = [part["top"] for part in seen["sections"]]
    assert tops == sorted(tops)
    assert "case = 1, frequency_ratio = 2.51189" in seen["cells"]
    # Nothing came from anywhere but the page itself.
    assert [name for name in seen["fetched"] if not name.startswith("data:")] == []


def test_side_by_side_then_one_upon_the_other(seen):
    modes = seen["modes"]
    assert list(modes) == ["side by side", "record", "new", "blink", "wipe", "large"]
    lefts = [figure["left"] for figure in modes["side by side"]]
    assert lefts == sorted(set(lefts)) and len(lefts) == 2
    shown = {name: [figure["shown"] for figure in found] for name, found in modes.items()}
    assert shown == {
        "side by side": [True, True],
        "record": [True, False],
        "new": [False, True],
        "blink": [True, True],
        "wipe": [True, True],
        # As it was before.
        "large": [True, True],
    }
    for name in ("blink", "wipe"):
        before, after = modes[name]
        assert (before["left"], before["top"]) == (after["left"], after["top"])
        # The same pixel of both pictures is at the same place.
        assert before["picture"] == pytest.approx(after["picture"], abs=0.01) and before["picture"]
    assert [figure["moved"] for figure in modes["blink"]] == ["none", "blink"]
    before, after = modes["wipe"]
    assert after["resize"] == "horizontal"
    assert after["width"] == pytest.approx(before["width"] / 2, abs=1)
    assert modes["large"][0]["wide"] == 1200
    assert modes["large"][0]["picture"] > 1.2 * modes["wipe"][0]["picture"]


def test_the_page_fits_a_telephone(page, browse):
    assert observe(browse, page, 360)["overflow"] == 0

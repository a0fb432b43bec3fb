"""The page in a real browser: Chromium without a window and without a network.

The page holds no script. Another page, made here, shows it in a frame and
writes down how the browser laid it out.
"""

import json
import re
import shutil

import pytest
from PIL import Image

from bouncing_ball_beyond.inherited.pipeline.diff.report import differences_html

pytestmark = pytest.mark.slow

OBSERVER = """<!doctype html>
<meta charset="utf-8">
<iframe id="page" src="page.html" width="WIDTH" height="3000"></iframe>
<pre id="seen"></pre>
<script>
// Whether a picture has both white and other pixels, as the browser decodes it.
function drawn(image) {
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [image.naturalWidth, image.naturalHeight];
  const context = canvas.getContext("2d");
  context.drawImage(image, 0, 0);
  const red = context.getImageData(0, 0, canvas.width, canvas.height).data
    .filter((_, k) => k % 4 === 0);
  return red.includes(255) && red.some(value => value < 128);
}
// What each mode makes of the first two pictures that differ.
function modes(page, view) {
  const viewer = [...page.querySelectorAll(".viewer")].find(each => each.querySelector(".before"));
  return Object.fromEntries([...viewer.querySelectorAll("input")].map(input => {
    input.click();
    const seen = [...viewer.querySelectorAll("figure")].map(figure => ({
      ...figure.getBoundingClientRect().toJSON(),
      picture: figure.querySelector("img").getBoundingClientRect().width,
      moved: view.getComputedStyle(figure).animationName,
      wide: viewer.getBoundingClientRect().width,
      resize: view.getComputedStyle(figure).resize,
    }));
    if (input.type === "checkbox") input.click();
    return [input.id.split("/").pop(), seen];
  }));
}
addEventListener("load", () => {
  const page = document.getElementById("page").contentDocument;
  const view = document.getElementById("page").contentWindow;
  document.getElementById("seen").textContent = JSON.stringify({
    images: [...page.images].map(image => [
      image.alt, [image.naturalWidth, image.naturalHeight, drawn(image)]
    ]),
    sections: [...page.querySelectorAll("section")].map(section => [
      section.id, section.dataset.outcome, Boolean(section.querySelector("details[open]"))
    ]),
    cells: [...page.querySelectorAll("td")].map(cell => cell.textContent),
    fetched: view.performance.getEntriesByType("resource").map(entry => entry.name),
    tables: [...page.querySelectorAll(".wide")].map(each => each.scrollWidth - each.clientWidth),
    // Lines of text in each row of a table.
    rows: [...page.querySelectorAll("tr")].map(row => row.offsetHeight / 20),
    overflow: page.documentElement.scrollWidth - page.documentElement.clientWidth,
    modes: modes(page, view),
  });
});
</script>
"""


def observe(browse, folder, width):
    """The layout of page.html in a window of this width, as the browser reports it."""
    observer = folder / "observer.html"
    observer.write_text(OBSERVER.replace("WIDTH", str(width)), encoding="utf-8")
    text = browse(folder, observer, "--virtual-time-budget=20000", "--dump-dom")
    found = re.search(r'<pre id="seen">(\{.*\})</pre>', text, re.DOTALL)
    assert found, "the page did not load"
    unescaped = found[1].replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&")
    return json.loads(unescaped)


def test_a_browser_shows_all_pictures_and_columns_of_the_page(pair, tmp_path, browse):
    """With a drifted dataset, a missing table and another picture."""
    pair.move()
    shutil.copyfile(pair.new / "figures" / "fig05.png", pair.new / "figures" / "fig01.png")
    (pair.new / "figures" / "table1.csv").unlink()
    (tmp_path / "page.html").write_text(differences_html(pair.compare()), encoding="utf-8")
    seen = observe(browse, tmp_path, 1300)
    # All columns are within the window, in rows as tall as their text.
    assert seen["overflow"] == 0 and seen["tables"] and max(seen["tables"]) == 0
    assert max(seen["rows"]) <= 5
    every_picture_is_there_and_the_worst_first(seen, pair)
    side_by_side_then_one_upon_the_other(seen["modes"])
    # The page fits a telephone.
    assert observe(browse, tmp_path, 360)["overflow"] == 0


def every_picture_is_there_and_the_worst_first(seen, pair):
    images = dict(seen["images"])
    # Of the pictures those that moved.
    expected = {}
    for side in ("record", "new"):
        with Image.open(getattr(pair, side) / "figures" / "fig01.png") as picture:
            expected[f"fig01, {side}"] = [*picture.size, True]
    assert images == expected
    outcomes = ["missing", "changed structure", "drifted"]
    names = ["table1", "fig01", "fig05"]
    assert seen["sections"] == [
        list(each) for each in zip(names, outcomes, [True] * 3, strict=True)
    ]
    assert any("at case = r = 1, Λ = 0.8, frequency_ratio = " in cell for cell in seen["cells"])
    # Nothing came from anywhere but the page itself.
    assert [name for name in seen["fetched"] if not name.startswith("data:")] == []


def side_by_side_then_one_upon_the_other(modes):
    assert list(modes) == ["side by side", "record", "new", "blink", "wipe", "large"]
    lefts = [figure["left"] for figure in modes["side by side"]]
    assert lefts == sorted(set(lefts)) and len(lefts) == 2
    shown = {name: [figure["width"] > 0 for figure in found] for name, found in modes.items()}
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
    assert modes["large"][0]["wide"] == 1300
    assert modes["large"][0]["picture"] > 1.2 * modes["wipe"][0]["picture"]

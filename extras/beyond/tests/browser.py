"""What a browser shows of the explorer, in frames on a page that writes down what is in them."""

import html
import json
import os
import re
import shutil
import subprocess
from pathlib import Path
from typing import NamedTuple

import pytest

BROWSERS = ("chromium", "chromium-browser", "google-chrome")


class Frame(NamedTuple):
    """A page, its address, its main picture, and the size of the screen in CSS pixels."""

    page: str
    address: str = ""
    picture: str = "motion"
    width: int = 1280
    height: int = 900
    states: tuple[str, ...] = ()
    """Addresses that are shown one after the other, each on all tabs with a case."""
    cases: tuple[str, ...] = ()
    """Addresses that are shown one after the other."""
    asked: tuple[str, ...] = ()
    """Expressions of `page`, the document, and `view`, its window, evaluated in this order."""


OBSERVER = """<!doctype html>
<meta charset="utf-8">
FRAMES
<pre id="seen"></pre>
<script>
function look(frame) {
  const page = frame.contentDocument, view = frame.contentWindow, root = page.documentElement;
  const drawings = [...page.querySelectorAll("svg[id]")].filter(svg => svg.clientWidth);
  const letters = drawings.flatMap(svg => [...svg.querySelectorAll("text")]);
  const inside = text => {
    const [one, all] = [text, text.ownerSVGElement].map(part => part.getBoundingClientRect());
    return one.left >= all.left - 1 && one.right <= all.right + 1
      && one.top >= all.top - 1 && one.bottom <= all.bottom + 1;
  };
  const cross = (one, other) => one.left < other.right && other.left < one.right
    && one.top < other.bottom && other.top < one.bottom;
  const boxes = letters.filter(text => text.textContent).map(text => text.getBoundingClientRect());
  const picture = page.getElementById(frame.dataset.picture);
  // What the page fills in when the table and the contact are given by other values.
  const switched = () => {
    for (const [id, way] of [["moves", "acceleration"], ["touch", "stiffness"]]) {
      page.getElementById(id).value = way;
      page.getElementById(id).dispatchEvent(new view.Event("change"));
    }
    return ["acc", "k"].map(name => page.getElementById(name).value);
  };
  return {
    ...answerOf(frame),
    top: picture.getBoundingClientRect().top,
    // Where the picture, the answer and the first slider end.
    ends: [picture, page.getElementById("verdict"),
      [...page.querySelectorAll("input[type=range]")].find(slider => slider.clientWidth)]
      .map(part => part.getBoundingClientRect().bottom),
    curves: picture.querySelectorAll("path, circle").length,
    axes: [...picture.querySelectorAll(".name")].map(text => text.textContent),
    scrolled: view.scrollY, wide: root.scrollWidth,
    letters: Math.min(...letters.map(text => parseFloat(view.getComputedStyle(text).fontSize)
      * text.ownerSVGElement.getScreenCTM().a)),
    outside: letters.map(text => inside(text) ? "" : text.textContent).filter(Boolean),
    crossed: boxes.some((one, k) => boxes.slice(k + 1).some(other => cross(one, other))),
    badge: page.getElementById("badge").className,
    worst: Number(page.getElementById("badge").dataset.worst),
    warned: !page.getElementById("warning").hidden,
    tab: page.querySelector("[role=tab][aria-selected=true]").textContent,
    position: page.getElementById("position").textContent,
    starts: page.getElementById("starts").textContent,
    others: [...page.querySelectorAll("#others button")].map(button => button.textContent),
    switched: switched(),
    states: JSON.parse(frame.dataset.states).map(address => onAllTabs(frame, address)),
    cases: JSON.parse(frame.dataset.cases).map(address => {
      view.explorer.show(address);
      return answerOf(frame);
    }),
    asked: JSON.parse(frame.dataset.asked).map(
      expression => Function("page", "view", `return ${expression}`)(page, view)),
  };
}
function answerOf({contentDocument: page, contentWindow: view}) {
  const text = name => page.getElementById(name).textContent;
  return {
    hash: view.explorer.hash(), call: text("call"), verdict: text("verdict"),
    refused: text("refused"), speed: text("impact-speed"),
    values: Object.fromEntries([...page.querySelectorAll("[data-key]")].map(
      ({dataset: {key, value}}) => [key, isNaN(value) ? value : Number(value)])),
    motions: [...page.querySelectorAll("#stage-ends data")].map(({value}) => JSON.parse(value)),
  };
}
// What each tab with a case answers when its button is pressed, from that of the address on.
function onAllTabs(frame, address) {
  const {contentDocument: page, contentWindow: view} = frame;
  view.explorer.show(address);
  const tabs = [...page.querySelectorAll("[role=tab]:not(#tab-question)")];
  const first = tabs.findIndex(tab => tab.ariaSelected === "true");
  return [0, 1, 2, 3].map(k => {
    if (k) tabs[(first + k) % 3].click();
    return answerOf(frame);
  });
}
addEventListener("load", () => {
  const seen = {};
  for (const frame of document.querySelectorAll("iframe")) frame.contentWindow.explorer.count();
  for (const frame of document.querySelectorAll("iframe")) seen[frame.id] = look(frame);
  document.getElementById("seen").textContent = JSON.stringify(seen);
});
</script>
"""


def shown(frames: dict[str, Frame], folder: Path) -> dict[str, dict]:
    """What one run of the browser shows in each frame.

    Without a browser the test is skipped, and fails in continuous integration.
    """
    browser = next(filter(None, map(shutil.which, BROWSERS)), None)
    if browser is None:
        stop = pytest.fail if os.environ.get("CI") else pytest.skip
        stop(f"no browser: {', '.join(BROWSERS)}")
    texts = []
    for name, frame in frames.items():
        page = folder / f"{hash(frame.page):x}.html"
        page.write_text(frame.page, encoding="utf-8")
        texts.append(
            f'<iframe id="{name}" data-picture="{frame.picture}" width="{frame.width}" '
            f'data-states="{html.escape(json.dumps(frame.states))}" '
            f'data-cases="{html.escape(json.dumps(frame.cases))}" '
            f'data-asked="{html.escape(json.dumps(frame.asked))}" '
            f'height="{frame.height}" style="border: 0" '
            f'src="{page.name}{html.escape(frame.address)}"></iframe>'
        )
    observer = folder / "observer.html"
    observer.write_text(OBSERVER.replace("FRAMES", "\n".join(texts)), encoding="utf-8")
    command = [browser, "--headless=new", "--no-sandbox", "--disable-gpu", "--hide-scrollbars"]
    command += ["--allow-file-access-from-files", f"--user-data-dir={folder / 'profile'}"]
    command += ["--virtual-time-budget=1000", "--dump-dom", observer.as_uri()]
    run = subprocess.run(command, capture_output=True, text=True, encoding="utf-8", timeout=300)
    match = re.search(r'<pre id="seen">(\{.*)</pre>', run.stdout, re.DOTALL)
    assert match, run.stderr
    return json.loads(html.unescape(match[1]))

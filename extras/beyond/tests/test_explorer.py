"""The explorer: one file with its scenes, and what a browser shows of it.

Another page, made here, shows the explorer in frames of the size of a desk's and a telephone's
screen and writes down what the browser made of it.
"""

import html
import json
import math
import re
import shutil
import subprocess
from pathlib import Path

import pytest
from integrated import contact, flight

import bouncing_ball_beyond
from bouncing_ball_beyond import SpringDamper
from bouncing_ball_beyond.error_law import law_errors
from bouncing_ball_beyond.tables import SINE, Table
from paper_replication.datasets import read
from studies.explorer import BOUND, page

BEYOND = Path(__file__).resolve().parents[1]
SCENES = json.loads((BEYOND / "workflow/explorer/scenes.json").read_text(encoding="utf-8"))
BROWSERS = ("chromium", "chromium-browser", "google-chrome")
BROWSER = next(filter(None, map(shutil.which, BROWSERS)), None)

SCREENS = {"desk": (1280, 900), "telephone": (390, 844)}
"""Width and height in CSS pixels."""

LOOSE = "#scene=loose&units=dimensionless"

STIFF = "#r=0.9&w=1000&a=0.5"

MEASURED = {
    release: f"#tab=design&f=15&stroke=2.2&time=0.3&r=0.65&release={release}"
    for release in ("displacement", "force")
}
"""The ball of the replication's README, by what ends the measured contact."""

OUTSIDE = "#tab=design&f=30&stroke=1.5&time=2&r=0.8"
"""A stroke at which the restitution model has no stable orbit with n = 1."""

REFUSED = "#tab=design&r=0.13&release=force"
"""A restitution coefficient below e⁻², which no damping ratio below 1 has without force."""

PICTURES = {
    "": "motion",
    "#r=0.65&w=6&a=1": "motion",
    STIFF: "motion",
    "#scene=contact": "scene",
    LOOSE: "scene",
}
"""The first picture by the address at which the page is opened."""

ON_TELEPHONES = [*MEASURED.values(), OUTSIDE]
"""Further addresses, opened on the small screen only. Their first picture is the motion."""

VIEWS = [(screen, *view) for screen in SCREENS for view in PICTURES.items()]
VIEWS += [("telephone", address, "motion") for address in ON_TELEPHONES]
"""Screens, addresses and first pictures."""

SMALLEST = 12
"""The smallest letters in a drawing, in CSS pixels: those of the tables are not smaller."""

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
  return {
    top: picture.getBoundingClientRect().top,
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
    doubling: page.getElementById("waveform-says").textContent,
    call: page.getElementById("call").textContent,
    verdict: page.getElementById("verdict").textContent,
    position: page.getElementById("position").textContent,
    refused: page.getElementById("refused").textContent,
    values: Object.fromEntries([...page.querySelectorAll("[data-key]")].map(
      ({dataset: {key, value}}) => [key, value === "true" || Number(value)])),
  };
}
addEventListener("load", () => {
  const seen = {};
  for (const frame of document.querySelectorAll("iframe")) seen[frame.id] = look(frame);
  document.getElementById("seen").textContent = JSON.stringify(seen);
});
</script>
"""


@pytest.fixture(scope="module")
def made():
    """The page with the reference orbits of the repository."""
    return page(read(BEYOND / "figures/explorer.nc"))


@pytest.fixture(scope="module")
def seen(made, tmp_path_factory):
    """What one run of the browser shows, by the screen and the address."""
    if BROWSER is None:
        pytest.skip(f"no browser: {', '.join(BROWSERS)}")
    folder = tmp_path_factory.mktemp("explorer")
    (folder / "right.html").write_text(made, encoding="utf-8")
    wrong = made.replace('"max_height", "trace"', '"trace", "max_height"', 1)
    (folder / "wrong.html").write_text(wrong, encoding="utf-8")
    frames = [
        f'<iframe id="{screen} {address}" data-picture="{picture}" width="{SCREENS[screen][0]}" '
        f'height="{SCREENS[screen][1]}" style="border: 0" '
        f'src="right.html{html.escape(address)}"></iframe>'
        for screen, address, picture in VIEWS
    ]
    frames.append('<iframe id="wrong" data-picture="motion" src="wrong.html"></iframe>')
    frames.append(f'<iframe id="refused" data-picture="motion" src="right.html{REFUSED}"></iframe>')
    observer = folder / "observer.html"
    observer.write_text(OBSERVER.replace("FRAMES", "\n".join(frames)), encoding="utf-8")
    command = [BROWSER, "--headless=new", "--no-sandbox", "--disable-gpu", "--hide-scrollbars"]
    command += ["--allow-file-access-from-files", f"--user-data-dir={folder / 'profile'}"]
    command += ["--virtual-time-budget=1000", "--dump-dom", observer.as_uri()]
    run = subprocess.run(command, capture_output=True, text=True, encoding="utf-8", timeout=100)
    found = re.search(r'<pre id="seen">(\{.*)</pre>', run.stdout, re.DOTALL)
    assert found, run.stderr
    return json.loads(html.unescape(found[1]))


@pytest.mark.parametrize(("screen", "address", "_"), VIEWS)
def test_the_picture_comes_first_and_its_letters_are_read(seen, screen, address, _):
    found = seen[f"{screen} {address}"]
    width, height = SCREENS[screen]
    assert found["curves"] >= 2
    assert found["scrolled"] == 0
    assert 0 < found["top"] < height / 3
    assert found["wide"] <= width
    assert found["letters"] >= SMALLEST
    assert found["outside"] == []
    assert not found["crossed"]


@pytest.mark.parametrize("screen", SCREENS)
def test_the_page_opens_in_units_of_the_laboratory(seen, screen):
    opened = seen[f"{screen} "]
    assert opened["tab"] == "Physical units"
    assert opened["axes"] == ["time [ms]", "height [mm]"]
    # An address without a tab is a dimensionless case, as it always was.
    cited = seen[f"{screen} #r=0.65&w=6&a=1"]
    assert cited["tab"] == "Dimensionless"
    assert cited["axes"] == ["time τ = Ωt", "height Ω²z/g"]


@pytest.mark.parametrize("screen", SCREENS)
def test_the_self_check_passes(seen, screen):
    opened = seen[f"{screen} "]
    assert opened["badge"] == "good"
    assert opened["worst"] <= BOUND
    assert not opened["warned"]


def test_a_third_harmonic_changes_the_sign_of_the_shift(seen):
    ball = SpringDamper(1000.0, restitution=0.9)
    # The third harmonic that the page opens with.
    tables = {"third harmonic": Table([(1, 1.0, 0.0), (3, 0.01, -0.87)]), "sine": SINE}
    shift = {
        name: 1000 * float(law_errors(ball, amplitude=1.0, table=table)["period_doubling"])
        for name, table in tables.items()
    }
    assert shift["sine"] < 0 < shift["third harmonic"]
    says = seen[f"desk {STIFF}"]["doubling"]
    assert f"the shift is {shift['third harmonic']:.3g} with the third harmonic" in says
    assert f"{shift['sine']:.3g} on a sine" in says


def test_the_call_computes_what_the_page_shows(seen):
    names = {name: getattr(bouncing_ball_beyond, name) for name in bouncing_ball_beyond.__all__}
    answer = eval(seen["desk "]["call"], names)
    assert f"{answer.error:.1%}".replace("%", " %") in seen["desk "]["verdict"]
    found = eval(seen["desk #r=0.65&w=6&a=1"]["call"], names)
    assert f"{found.max_height:.4g}" in seen["desk #r=0.65&w=6&a=1"]["verdict"]
    for call in seen[f"desk {LOOSE}"]["call"].splitlines():
        impacts = int(eval(call, names).impacts)
        assert f"with {impacts} impacts" in seen[f"desk {LOOSE}"]["verdict"]


@pytest.mark.parametrize("release", MEASURED)
def test_a_stroke_and_a_contact_time_give_the_orbit_of_an_integrated_contact(seen, release):
    found = seen[f"telephone {MEASURED[release]}"]["values"]
    zeta, ratio = found["damping_ratio"], found["frequency_ratio"]
    rate = 2 * math.pi * 15
    assert found["amplitude"] == pytest.approx(1.1e-3 * rate**2 / 9.80665, rel=1e-12)
    angle = math.pi - (2 * math.asin(zeta) if release == "force" else 0)
    assert angle / math.sqrt(1 - zeta**2) / (rate * ratio) == pytest.approx(0.3e-3, rel=1e-12)
    assert math.exp(-zeta * angle / math.sqrt(1 - zeta**2)) == pytest.approx(0.65, rel=1e-12)
    # The page's orbit, followed from its impact by an integrator, comes back to it. The page has
    # heights and times in SI units here; its phase is in rad.
    ball = SpringDamper(ratio, damping_ratio=zeta, release=release)
    amplitude, phase = found["amplitude"], found["spring-damper phase"]
    closing = amplitude * math.cos(phase) - found["spring-damper impact_velocity"]
    end, gap, speed, highest = contact(ball, amplitude, phase, closing)
    landing, again, height = flight(amplitude, end, gap, speed)
    assert landing == pytest.approx(phase + 2 * math.pi, abs=1e-9)
    assert again == pytest.approx(closing, abs=1e-9)
    simple = found["restitution max_height"]
    assert found["errors max_height"] == pytest.approx(max(height, highest) / simple - 1, abs=1e-9)


def test_a_position_outside_of_the_range_is_said(seen):
    found = seen[f"telephone {OUTSIDE}"]
    amplitude = 0.75e-3 * (60 * math.pi) ** 2 / 9.80665
    node = math.pi * (1 - 0.8) / (1 + 0.8)
    doubling = math.hypot(node, 2 * (1 + 0.8**2) / (1 + 0.8) ** 2)
    place = (amplitude - node) / (doubling - node)
    assert f"Position of Λ: {place:.3g}," in found["position"]
    assert "Outside of 0 to 1" in found["position"]
    assert found["values"]["restitution is_stable"] is not True


def test_a_contact_that_no_damping_has_is_refused(seen):
    assert "e⁻²" in seen["refused"]["refused"]
    assert seen["refused"]["verdict"] == ""


def test_a_wrong_number_is_reported_at_the_top(seen):
    assert seen["wrong"]["badge"] == "bad"
    assert seen["wrong"]["warned"]


def test_the_page_is_one_file_without_network(made):
    assert "default-src 'none'; script-src 'sha256-" in made
    assert not re.search(r"https?://(?!www\.w3\.org/2000/svg)", made)
    assert not re.search(r"<link\b|<img\b|<script[^>]*\bsrc=|@import|url\(", made)
    assert set(re.findall(r'\bhref="([^"]*)"', made)) == {f"#scene={name}" for name in SCENES}


def test_the_scenes_of_the_lesson_are_on_the_page(made):
    lesson = (BEYOND / "docs/first-hour.md").read_text(encoding="utf-8")
    linked = set(re.findall(r"explorer\.html#scene=(\w+)", lesson))
    assert linked == set(SCENES)
    stored = re.search(r'id="scenes">\s*(\{.*?)\s*</script>', made, re.DOTALL)
    assert json.loads(stored[1]) == SCENES

"""The explorer: one file with its scenes, and what a browser shows of it.

Another page, made here, shows the explorer in frames of the size of a desk's and a telephone's
screen and writes down what the browser made of it.
"""

import json
import math
import re
from pathlib import Path

import numpy as np
import pytest
from browser import Frame, shown

import bouncing_ball_beyond
from bouncing_ball.spring_damper import contact_of_duration
from paper_replication.datasets import read
from studies.explorer import BOUND, WAYS, page

BEYOND = Path(__file__).resolve().parents[1]
SCENES = json.loads((BEYOND / "workflow/explorer/scenes.json").read_text(encoding="utf-8"))
SCREENS = {"desk": (1280, 900), "laptop": (1366, 768), "telephone": (390, 844)}
"""Width and height in CSS pixels."""

LOOSE = "#scene=loose&units=dimensionless"

STIFF = "#r=0.9&w=1000&a=0.5"

README = "#tab=design&f=15&stroke=2.2&time=0.3&r=0.65"
"""The ball of the replication's README."""

WITH_UNITS = "#tab=design&f=0.015%20kHz&stroke=0.22%20cm&time=300%C2%B5s&r=0.65"
"""The same ball, in other units."""

OTHER_UNIT = "#tab=design&f=20&stroke=0.1%20in&time=0.3&r=0.65"

OUTSIDE = "#tab=design&f=30&stroke=1.5&time=2&r=0.8"
"""A stroke at which the restitution model has no stable orbit with n = 1."""

PICTURES = {
    "": "motion",
    "#tab=design": "motion",
    "#r=0.65&w=6&a=1": "motion",
    STIFF: "motion",
    "#scene=contact": "scene",
    LOOSE: "scene",
}
"""The main picture by the address at which the page is opened."""

ON_TELEPHONES = [README, WITH_UNITS, OTHER_UNIT, OUTSIDE]
"""Further addresses, opened on the small screen only. Their main picture is the motion."""

VIEWS = [(screen, *view) for screen in SCREENS for view in PICTURES.items()]
VIEWS += [("telephone", address, "motion") for address in ON_TELEPHONES]
"""Screens, addresses and main pictures."""

SMALLEST = 12
"""The smallest letters in a drawing, in CSS pixels: those of the tables are not smaller."""


@pytest.fixture(scope="module")
def made():
    """The page with the reference orbits of the repository."""
    return page(read(BEYOND / "figures/explorer.nc"))


@pytest.fixture(scope="module")
def seen(made, tmp_path_factory):
    """What one run of the browser shows, by the screen and the address."""
    wrong = made.replace('"max_height", "trace"', '"trace", "max_height"', 1)
    frames = {
        f"{screen} {address}": Frame(made, address, picture, *SCREENS[screen])
        for screen, address, picture in VIEWS
    }
    return shown(frames | {"wrong": Frame(wrong)}, tmp_path_factory.mktemp("explorer"))


@pytest.mark.parametrize(("screen", "address", "_"), VIEWS)
def test_the_first_view_has_the_picture_the_answer_and_an_input(seen, screen, address, _):
    view = seen[f"{screen} {address}"]
    width, height = SCREENS[screen]
    assert view["curves"] >= 2
    assert view["scrolled"] == 0
    assert 0 < view["top"]
    assert view["wide"] <= width
    assert max(view["ends"]) <= height
    assert view["letters"] >= SMALLEST
    assert view["outside"] == []
    assert not view["crossed"]


@pytest.mark.parametrize("screen", SCREENS)
def test_the_first_tab_with_inputs_is_in_units_of_the_laboratory(seen, screen):
    opened = seen[f"{screen} #tab=design"]
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


def test_the_call_computes_what_the_page_shows(seen):
    names = {name: getattr(bouncing_ball_beyond, name) for name in bouncing_ball_beyond.__all__}
    orbit = eval(seen["desk #r=0.65&w=6&a=1"]["call"], names)
    assert f"{orbit.max_height:.4g}" in seen["desk #r=0.65&w=6&a=1"]["verdict"]
    for call in seen[f"desk {LOOSE}"]["call"].splitlines():
        impacts = int(eval(call, names).impacts)
        assert f"with {impacts} impacts" in seen[f"desk {LOOSE}"]["verdict"]


def test_the_inputs_are_what_people_measure(seen):
    assert seen["desk #tab=design"]["call"].startswith(
        "on_shaker(frequency=20, displacement=1 / 2000, contact_duration=1.4 / 1000, "
    )


def test_a_number_is_read_with_its_unit(seen):
    assert seen[f"telephone {WITH_UNITS}"]["call"] == seen[f"telephone {README}"]["call"]
    assert "stroke = 0.1 in" in seen[f"telephone {OTHER_UNIT}"]["refused"]


def test_what_a_switch_fills_in_is_rounded(seen):
    inputs = seen[f"telephone {README}"]["switched"]
    table = 2 * math.pi * 15
    # A free impact whose contact ends with its force, and takes 0.3 ms, with a ball of 20 g.
    ratio = contact_of_duration(table * 0.3e-3, 0.65, "force").frequency_ratio
    wanted = [1.1e-3 * table**2 / 9.80665, 0.02 * (table * ratio) ** 2]
    assert inputs == [f"{float(f'{value:.6g}'):.15g}" for value in wanted]


@pytest.mark.parametrize("address", ["#tab=design", STIFF])
def test_the_balls_with_other_starts_are_counted_once(seen, address):
    of, *ends = map(int, re.findall(r"(?:^Of|,) (\d+) ", seen[f"desk {address}"]["starts"]))
    assert sum(ends) == of


def test_a_wrong_number_is_reported_at_the_top(seen):
    assert seen["wrong"]["badge"] == "bad"
    assert seen["wrong"]["warned"]


def test_the_page_is_one_file_without_network(made):
    assert "default-src 'none'; script-src 'sha256-" in made
    assert not re.search(r"https?://(?!www\.w3\.org/2000/svg)", made)
    assert not re.search(r"<link\b|<img\b|<script[^>]*\bsrc=|@import|url\(", made)
    links = set(re.findall(r'\bhref="([^"]*)"', made))
    inside = {link for link in links if link.startswith("#")}
    assert inside == {"#tab=design", "#tab=orbit"} | {f"#scene={name}" for name in SCENES}
    assert links - inside == set(WAYS.values())
    assert all((BEYOND / "figures" / link).exists() for link in links - inside)


def visible(selector, what):
    """An expression for a list of what the visible elements of a selector have."""
    all_of = f"[...page.querySelectorAll('{selector}')]"
    return f"{all_of}.filter(one => one.offsetParent).map(one => {what})"


def pressed(which):
    return f"page.querySelector('{which}').click()"


def said(name):
    return f"page.getElementById('{name}').textContent"


def typed(name, text):
    return (
        f"page.getElementById('{name}').value = '{text}',"
        f"page.getElementById('{name}').dispatchEvent(new view.Event('input'))"
    )


def asked(made, folder, *expressions, address="", screen="telephone"):
    """The values of expressions in the page, one after the other."""
    frame = Frame(made, address, "motion", *SCREENS[screen], asked=expressions)
    return shown({"asked": frame}, folder)["asked"]["asked"]


def test_the_page_begins_with_a_guess(made, tmp_path):
    """Then it answers with the numbers of the package."""
    contact = bouncing_ball_beyond.SpringDamper(np.array([5.0, 30.0]), restitution=0.65)
    simple = bouncing_ball_beyond.orbit(bouncing_ball_beyond.Rigid(0.65), amplitude=1.0)
    exact = bouncing_ball_beyond.orbit(contact, amplitude=1.0)
    lower = [f"{100 * (1 - one.max_height / simple.max_height):.3g}% lower" for one in exact]
    threshold = bouncing_ball_beyond.error_thresholds(
        bouncing_ball_beyond.SpringDamper(5.0, restitution=0.65),
        amplitude=1.0,
        quantities=["max_height"],
    )["max_height"].ratio
    inputs = visible("input", "one.id")
    shows = said("verdict")
    answers = asked(
        made,
        tmp_path,
        "view.explorer.show('')",
        *(inputs, shows, said("motion")),
        *(pressed("[data-guess=soft]"), shows, said("motion")),
        *(pressed("[data-guess=rigid]"), shows),
        *("view.explorer.show('#tab=question&stiff=30')", shows),
        *(pressed("#there"), shows),
        "page.getElementById('all-numbers').hash",
    )
    given = [one for one in answers if one is not None]
    assert given[:2] == [["stiff", "slide-stiff"], ""]
    assert "have not been thrown" in given[2]
    assert given[3].startswith(f"No: at ϖ = 5 the ball on the spring flies {lower[0]}")
    assert f"{simple.max_height:.4g} and {exact[0].max_height:.4g}" in given[4]
    assert given[5].startswith("Yes: ")
    assert given[6] == given[5]
    assert f"flies {lower[1]}" in given[7]
    assert f"The difference is 1% at ϖ = {float(threshold):.3g}," in given[7]
    assert given[8].startswith("#tab=orbit&r=0.65&w=30&a=1&n=1&release=displacement")


def test_the_reason_is_that_of_the_readme(made):
    """In the same words, which there have links."""
    readme = (BEYOND.parents[1] / "README.md").read_text(encoding="utf-8").replace("\n", " ")
    why = re.search(r'id="why">.*?<p>(.*?)\.</p>', made)[1]
    assert why in readme


def test_the_question_leaves_the_case_as_it_is(made, tmp_path):
    there = pressed("#tab-question"), pressed("#tab-design"), "view.explorer.hash()"
    opened = asked(made, tmp_path, "view.explorer.show('#tab=design')", "view.explorer.hash()")[1]
    assert asked(made, tmp_path, "view.explorer.show('')", *there)[-1] == opened
    given = "#tab=design&m=3&f=15&stroke=2.2&time=0.3&r=0.65&n=2&release=displacement&t=2"
    assert asked(made, tmp_path, f"view.explorer.show('{given}')", *there)[-1] == given


def test_a_scene_is_marked_and_leads_to_the_next(made, tmp_path):
    marked = "[...page.querySelectorAll('[aria-current=true]')].map(link => link.hash)"
    follow = "view.explorer.show(page.getElementById('next').hash)"
    names = [f"#scene={name}" for name in SCENES]
    first = f"view.explorer.show('{names[0]}')"
    steps = [step for _ in names for step in (marked, follow)]
    answers = asked(made, tmp_path, first, *steps, "view.explorer.hash()")
    assert answers[1::2] == [[name] for name in names] + [answers[-1]]
    assert answers[-1].startswith("#tab=design")


def test_the_focus_stays_on_the_button_that_was_pressed(made, tmp_path):
    button = "[...page.querySelectorAll('#others button')].find(one => one.textContent === 'n = 2')"
    answers = asked(
        made,
        tmp_path,
        f"{button}.focus()",
        f"{button}.click()",
        "page.activeElement.textContent",
        "view.explorer.hash()",
        address="#tab=design",
    )
    assert answers[2] == "n = 2"
    assert "&n=2" in answers[3]


@pytest.mark.parametrize(
    ("text", "ways"),
    [("1,500", "1500 or 1.5"), ("−1,500", "−1500 or -1.5"), ("1,234.5", "1234.5")],
)
def test_a_number_with_commas_is_refused_with_what_to_write(made, tmp_path, text, ways):
    answers = asked(made, tmp_path, typed("f", text), said("refused"), address="#tab=design")
    assert answers[1] == f"frequency of the table [Hz]: instead of {text} write {ways}."


def test_the_sign_of_a_text_is_a_minus(made, tmp_path):
    answers = asked(
        made, tmp_path, typed("v", "−2.5"), "view.explorer.hash()", address="#scene=rest"
    )
    assert "&v=-2.5&" in answers[1]


@pytest.mark.parametrize("address", ["", "#tab=design", "#tab=orbit&r=0.65", "#scene=locked"])
def test_targets_on_a_telephone_are_large_enough(made, tmp_path, address):
    targets = "a, button, summary, select, input:not([type=radio]), label:has(input)"
    heights = visible(targets, "[one.getBoundingClientRect().height, one.outerHTML]")
    measurements = asked(made, tmp_path, heights, address=address)[0]
    assert [text for height, text in measurements if height < 24] == []


def test_the_scenes_of_the_lesson_are_on_the_page(made):
    lesson = (BEYOND / "docs/first-hour.md").read_text(encoding="utf-8")
    linked = set(re.findall(r"explorer\.html#scene=(\w+)", lesson))
    assert linked == set(SCENES)
    stored = re.search(r'id="scenes">\s*(\{.*?)\s*</script>', made, re.DOTALL)
    assert json.loads(stored[1]) == SCENES

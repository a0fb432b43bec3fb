"""The explorer in a real browser: its numbers against the command line, its badge, its manners.

Another page, made here, shows it in frames and writes down what the browser made of it. The
policy of the page keeps its own scripts only; what is asked is asked from outside.
"""

import html
import json
import math
import re
import shlex
from functools import partial
from pathlib import Path
from urllib.parse import parse_qsl, urlencode

import numpy as np
import pytest

import bouncing_ball_beyond as bb
from bouncing_ball_beyond.accuracy.errors import QUANTITIES, as_deviation, relative_errors
from bouncing_ball_beyond.accuracy.simple_models import exact_and_simple_models
from bouncing_ball_beyond.exhibits.explorer_orbits import reference_orbits
from bouncing_ball_beyond.explorer.document import BOUND, to_html
from bouncing_ball_beyond.inherited.pipeline.job import typed
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.damping import LINEAR, Release
from bouncing_ball_beyond.models.history import motion_at
from bouncing_ball_beyond.models.rigid import RestitutionModel
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.motions.motions import Kind

pytestmark = pytest.mark.slow

REFERENCES = {"frequency_ratio": {"min": 1.0, "max": 1e4, "samples": 50}, "seed": 31}
STATES = 7

# The page that looks at the page: what it sees is JSON in its element "seen".
OBSERVER = Path(__file__).with_name("observer.html").read_text(encoding="utf-8")


def states():
    """Random hashes about the stable ranges, and beyond."""
    rng = np.random.default_rng(7)
    for k in range(STATES):
        r = rng.uniform(0.2, 0.99)
        w = 10 ** rng.uniform(0.2, 3.5)
        n = int(rng.integers(1, 5))
        release = ("displacement", "force")[k % 2]
        low = n * math.pi * (1 - r) / (1 + r)
        high = math.hypot(low, 2 * (1 + r * r) / (1 + r) ** 2)
        a = low + rng.uniform(-0.25, 1.3) * (high - low)
        side = "stable" if k % 4 < 3 else "unstable"
        yield f"#r={r:.4f}&w={w:.6g}&a={max(a, 0.01):.5f}&n={n}&release={release}&side={side}"


RELEASES = [rule for rule in LINEAR for _ in range(3)]


def physical_states():
    """A random hash of the physical tab for each of these releases."""
    rng = np.random.default_rng(5)
    for release in RELEASES:
        m = 10 ** rng.uniform(-2, 0)
        r = rng.uniform(0.65, 0.9)
        a = rng.uniform(0.7, 1.1)
        omega = 40 * math.pi * 10 ** rng.uniform(0.7, 2.3)
        state = {"tab": "design", "m": 1000 * m, "f": 20, "acc": a, "k": m * omega**2, "r": r}
        yield "#" + urlencode(state | {"n": 1, "release": release})


# A contact of hours.
TOO_LONG = "#tab=design&m=20&f=50&acc=0.8&k=1e-9&r=0.85&n=1"

# A contact on whose 5-T orbit no ball ends, a contact under each release, and a tolerance of 5 %.
COUNTED = [
    "tab=design&m=50&f=25&acc=2&k=1e6&r=0.8&n=5",
    "tab=design&m=500&f=20&acc=0.8&k=1e5&r=0.75&n=1&release=force",
    "tab=design&m=20&f=50&acc=0.8&k=1e7&r=0.85&n=1&t=5",
    # Of 144 balls nine end on the orbit, 6.25 %, which is rounded to the even digit.
    "tab=design&m=20&f=50&acc=0.57&k=789568&r=0.69&n=1",
]

# A case of which nothing is the page's default.
ROUND_TRIP = "#r=0.65&w=82.18&a=1.03&n=2&release=force&side=unstable&t=3"


def near_threshold():
    """A contact on each side of the last one within 1 %, in both tabs."""
    ball = bb.rigid(restitution=0.65)
    found = bb.error_thresholds(ball, amplitude=1.0, quantities=["max_height"])
    last = found.error_threshold.sel(simple="restitution").item()
    for w in (last * 1.00001, last / 1.00001):
        yield "#" + urlencode({"r": 0.65, "w": w, "a": 1})
        k = 0.02 * (2 * math.pi * 50 * w) ** 2
        yield "#" + urlencode({"tab": "design", "m": 20, "f": 50, "k": k, "acc": 1, "r": 0.65})


@pytest.fixture(scope="module")
def seen(browse, tmp_path_factory):
    """All that is asked of the browser, in one run."""
    folder = tmp_path_factory.mktemp("explorer")
    data = typed(reference_orbits)(REFERENCES).assign_attrs(provenance_commit="c0ffee" * 6 + "c0ff")
    made = partial(to_html, quantities=QUANTITIES)
    right = made(data)
    pages = {
        "right": right,
        # Reference orbits that are not the model's.
        "wrong": made(data.assign(max_height=data.max_height * 1.00000001)),
        "lost": made(data.assign(end_phase=data.end_phase + 1e-10)),
        # A script that was changed in the file, without its checksum.
        "tampered": right.replace("const GRAVITY = 9.80665", "const GRAVITY = 9.81"),
    }
    for name, page in pages.items():
        (folder / f"{name}.html").write_text(page, encoding="utf-8")
    observer = folder / "observer.html"
    script = OBSERVER.replace("STATES", json.dumps(list(states())))
    script = script.replace("PHYSICAL", json.dumps(list(physical_states())))
    script = script.replace("ROUND_TRIP", json.dumps(ROUND_TRIP))
    script = script.replace("NEAR_THRESHOLD", json.dumps(list(near_threshold())))
    script = script.replace("TOO_LONG", json.dumps(TOO_LONG))
    script = script.replace("COUNTED", json.dumps([f"#{one}" for one in COUNTED]))
    observer.write_text(script, encoding="utf-8")
    text = browse(folder, observer, "--virtual-time-budget=30000", "--dump-dom")
    found = re.search(r'<pre id="seen">(.*)</pre>', text, re.DOTALL)
    assert found and found[1].startswith("{"), found and found[1]
    return json.loads(html.unescape(found[1])) | {"folder": folder}


@pytest.fixture
def answered(outcome):
    """The command's own JSON, None where it says that there is no orbit."""

    def answered(command):
        status, out, _ = outcome(*shlex.split(command)[1:], "--json")
        assert status in (0, 1)
        return json.loads(out) if status == 0 else None

    return answered


def close(shown, expected):
    return abs(float(shown) - expected) <= BOUND * max(1.0, abs(expected))


def test_random_states_say_what_their_commands_print(seen, answered):
    absent = 0
    for state in [seen["first"], *seen["states"]]:
        said = answered(state["command"])
        values = state["values"]
        exists = values["spring-damper exists"]
        if said is None:
            absent += 1
            assert exists == "false", state["command"]
            continue
        assert exists == "true", state["command"]
        for name in ("phase", "contact_duration", "impact_velocity", "bounce_velocity",
                     "apparent_restitution", "max_height"):  # fmt: skip
            assert close(values[f"spring-damper {name}"], said[name]), (name, state["command"])
        found = np.array(values["spring-damper multipliers"].split(), dtype=float).reshape(2, 2)
        # The larger one may be steep in Λ next to the saddle-node: its size counts.
        size = max(1.0, np.abs(said["multipliers"]).max())
        assert np.abs(found - said["multipliers"]).max() < 1e-9 * size, state["command"]
        assert values["spring-damper is_stable"] == str(said["is_stable"]).lower()
    assert 0 < absent < STATES / 3


def test_the_badge_is_red_if_a_number_differs_from_the_package(seen):
    right, wrong, tampered = (seen["badges"][name] for name in ("right", "wrong", "tampered"))
    assert right["kind"] == "good" and float(right["worst"]) < BOUND / 20
    assert (
        "100 orbits and 8 balls of the Python package, commit c0ffeec0ff, computed" in right["text"]
    )
    assert wrong["kind"] == "bad" and float(wrong["worst"]) > BOUND
    lost = seen["badges"]["lost"]
    assert lost["kind"] == "bad" and "(end_phase, row " in lost["text"]
    assert wrong["text"].startswith("WRONG") and wrong["colour"] == "rgb(176, 0, 32)"
    # The policy does not let a changed script run, and what was not checked says so.
    assert tampered["kind"] == "" and tampered["text"].startswith("Not checked")


def test_no_request_leaves_the_page(seen):
    assert seen["requests"] == []
    assert {"connect-src", "img-src"} <= set(seen["blocked"])
    text = (seen["folder"] / "right.html").read_text(encoding="utf-8")
    assert "content=\"default-src 'none'; script-src 'sha256-" in text
    assert not re.search(r"https?://(?!www\.w3\.org/2000/svg)", text)


def test_the_address_the_slider_and_typed_values_are_one_state(seen):
    assert seen["refused"] == "Not a value here, and left out: nonsense = 1."
    assert "--restitution 0.65 --frequency-ratio 6 --amplitude 1 " in seen["first"]["command"]
    given = "--restitution 0.5 --frequency-ratio 20 --amplitude 1.2 --n 1 --release force"
    assert given in seen["byAddress"]["command"]
    assert "w=31.62" in seen["bySlider"]["hash"] and seen["bySlider"]["typed"] == "31.62"
    # What is out of range is marked, changes no address, and leaves no answer beside it.
    says = "restitution coefficient r: 1.5 is not a number from 0.001 to 1."
    assert seen["invalid"] == {
        "marked": "true", "hash": seen["bySlider"]["hash"], "refused": says,
        "verdict": "", "command": "", "shown": 0,
    }  # fmt: skip
    assert seen["valid"]["refused"] == "" and seen["valid"]["verdict"] and seen["valid"]["shown"]
    assert "left out: a = 0 (in its place 0.8)." in seen["still"]["refused"]


def test_a_case_is_kept_in_physical_units_and_back(seen):
    design, orbit, stage, again, last = seen["roundTrip"]
    assert orbit["hash"] == last["hash"] == ROUND_TRIP
    assert [one["refused"] for one in seen["roundTrip"]] == [""] * 5
    assert "w=82.18&a=1.03" in stage["hash"] and design["hash"] == again["hash"]
    given = dict(parse_qsl(design["hash"][1:]))
    assert given.items() >= {"acc": "1.03", "r": "0.65", "n": "2", "release": "force"}.items()
    mass, frequency, stiffness = (float(given[name]) for name in ("m", "f", "k"))
    assert math.sqrt(stiffness / (mass / 1000)) / (2 * math.pi * frequency) == pytest.approx(
        82.18, rel=1e-12
    )


def test_a_verdict_is_by_the_error_that_it_names(seen):
    within, by_contact, beyond, beyond_too = seen["nearThreshold"]
    paper = "Errors here are relative to the simple model, as in Eqs. 37 and 38; "
    paper += "relative to the contact, that of the restitution model is +1.01 %."
    for one in (within, beyond):
        assert one["verdict"].endswith(paper)
        assert one["definition"].endswith("relative to the model's q, as in Eqs. 37 and 38")
        words = shlex.split(one["command"])
        ratio = float(words[words.index("--frequency-ratio") + 1])
        contact = SpringDamper.from_restitution(0.65, ratio)
        exact, *simple = exact_and_simple_models(contact)
        errors = relative_errors(exact, simple, 1, 1.0, list(QUANTITIES))
        for k, kind in enumerate(("errors", "corrected_errors")):
            for name, error in zip(QUANTITIES, errors[k], strict=True):
                assert float(one["values"][f"{kind} {name}"]) == pytest.approx(error, abs=1e-10)
    # As many digits as show on which side of the tolerance the error is.
    assert within["good"] == "true" and "-0.99999 %, within 1 %." in within["verdict"]
    assert beyond["good"] == "false" and "-1.00001 %, beyond 1 %" in beyond["verdict"]
    # The same contacts by the deviation, for which a slightly stiffer one is needed.
    design = "Errors here are relative to the contact, as in the command design; "
    for one, same in ((by_contact, within), (beyond_too, beyond)):
        assert one["good"] == "false" and "+1.01 %, beyond 1 %" in one["verdict"]
        assert design in one["verdict"]
        assert one["definition"].endswith("to the contact's q_SD, as in the command design")
        error = float(same["values"]["errors max_height"])
        expected = float(as_deviation(error))
        assert float(one["values"]["errors max_height"]) == pytest.approx(expected, abs=1e-10)


KINDS = {
    "stays": {"permanent contact"}, "repeats": {"orbit", "subharmonic"}, "sticks": {"locked"},
    "goes on": {"chaotic"},
}  # fmt: skip


def test_scenes_end_as_their_commands_say(seen, answered):
    assert set().union(
        *(KINDS[end["kind"]] for one in seen["scenes"] for end in one["ends"])
    ) == set(Kind) - {Kind.UNDECIDED}
    for scene in seen["scenes"]:
        commands = scene["command"].splitlines()
        assert len(commands) == len(scene["ends"]) and scene["look"] != "Balls on one table."
        for command, end in zip(commands, scene["ends"], strict=True):
            said = answered(f"{command} --impacts 500")
            assert said["kind"] in KINDS[end["kind"]], command
            assert (said["periods"], said["impacts"]) == (end["periods"], end["impacts"]), command


def test_balls_on_the_stage_are_where_the_package_has_them(seen):
    for scene in seen["scenes"]:
        given = scene["state"]
        balls = scene["balls"]
        place = np.arange(given.get("balls", 1))
        phase = given["phi"] + place * given.get("dphi", 0)
        velocity = given["v"] + place * given.get("dv", 0)
        for end in scene["ends"]:
            r = given["r"]
            name = end["name"]
            contact = SpringDamper.from_restitution(r, given.get("w", 1.0), Release.DISPLACEMENT)
            model = RestitutionModel(r) if name == "restitution" else ContactModel(contact)
            run = model.simulate(given["a"], phase, velocity, impacts=300)
            for k, ball in enumerate(ball for ball in balls if ball["model"] == name):
                expected = motion_at(run[k], ball["since"]).height
                # Over 100 periods the time itself is known to 1e-13, and a ball is not much faster.
                assert ball["heights"] == pytest.approx(expected, abs=1e-10), (scene["name"], k)


def test_the_stage_steps_plays_and_refuses_a_ball_that_rises(seen):
    # In half a second, of which the browser draws some, less than a period passes.
    assert seen["stepped"] == 0 and 0 < seen["played"] < 2 * math.pi
    assert seen["noBalls"]["refused"] == "balls: 0 is not a whole number from 1 to 9."
    assert seen["noBalls"]["verdict"] == ""
    rising = seen["rising"]
    assert rising["refused"] == (
        "The velocity of ball 1 at its first impact, 2, is above that of the table, "
        "Λ cos φ = 1: it rises, and there is no impact."
    )
    assert rising["verdict"] == rising["command"] == "" and rising["picture"] == 0


def test_the_physical_tab_opens_by_a_key(seen):
    tab = seen["tab"]
    assert tab["selected"] == ["false", "true", "false"] and tab["focused"] == "tab-design"
    assert tab["shown"] and tab["hidden"] == 0 and "tab=design" in tab["hash"]

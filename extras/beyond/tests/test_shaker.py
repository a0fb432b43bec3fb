"""The question of an engineer with a shaker: units, limits and the answer."""

import re
from pathlib import Path

import numpy as np
import pytest
import yaml
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import bouncing_ball_beyond as bb
from bouncing_ball_beyond.errors import shaker
from bouncing_ball_beyond.errors.error_law import contact_values
from bouncing_ball_beyond.errors.shaker import on_shaker
from studies.stages.impacts import ext_contact_time

G = 9.80665
TABLE = {"frequency": 50.0, "acceleration": 0.8 * G, "restitution": 0.85}
CONTACT = {"mass": 0.02, "stiffness": 1e7}
BEYOND = Path(__file__).resolve().parents[1]
STEEL = {"radius": 5e-3, "mass": 4e-3, "youngs_modulus": 210e9}


@pytest.fixture(scope="module")
def answers():
    """The answers for a contact with a spring and for one of Hertz."""
    return {"spring": on_shaker(**TABLE, **CONTACT), "hertz": on_shaker(**TABLE, **STEEL)}


def test_longest_contact_has_the_tolerance_as_its_error():
    answer = on_shaker(**TABLE, **CONTACT, tolerance=0.02)
    there = on_shaker(**TABLE, contact_duration=answer.longest_contact)
    assert there.error == pytest.approx(-0.02, abs=1e-9)
    assert answer.is_good_enough and not there.is_good_enough


def test_longest_contact_of_hertz_is_that_of_a_softer_ball(answers):
    """The duration is in proportion to E to the power of -2/5."""
    answer = answers["hertz"]
    modulus = 210e9 * (answer.contact_duration / answer.longest_contact) ** 2.5
    there = on_shaker(**TABLE, **{**STEEL, "youngs_modulus": modulus})
    assert there.error == pytest.approx(-0.01, abs=1e-9)


def test_duration_of_a_contact_of_hertz():
    """2.9433 (5/4)^(2/5) (m²/(K² v))^(1/5) with K = 4/3 E* √R, if it is nearly elastic."""
    answer = on_shaker(**{**TABLE, "restitution": 0.9999}, **STEEL)
    stiffness = 4 / 3 * 210e9 / (1 - 0.3**2) * np.sqrt(5e-3)
    speed = np.pi * 9.80665 / (100 * np.pi)  # v₀ = 2π/(1 + r)
    lasts = 2.94327507 * (1.25 * 0.004 / stiffness * speed**2) ** 0.4 / speed
    # A loss changes the speed and the duration in proportion to 1 - r.
    assert answer.contact_duration == pytest.approx(lasts, rel=1e-4)


def hertz_factor(r):
    """T (k/m)^(2/5) v^(1/5) of m ẍ + α √(mk) x^(1/4) ẋ + k x^(3/2) = 0, by integration."""
    damping = np.sqrt(5) * -np.log(r) / np.hypot(np.pi, np.log(r))

    def motion(_, state):
        depth = max(state[0], 0.0)
        return state[1], -(depth**1.5) - damping * depth**0.25 * state[1]

    def release(_, state):
        return state[0]

    release.terminal = True
    release.direction = -1
    solution = solve_ivp(motion, (0, 9), (0, 1), events=release, rtol=1e-10, atol=1e-13)
    assert -solution.y[1, -1] == pytest.approx(r, abs=1e-6)
    return solution.t[-1]


def test_the_contact_times_of_the_picture_are_those_of_hertz_at_the_impact_speed():
    given = yaml.safe_load((BEYOND / "config/config.yaml").read_text("utf-8"))
    given = given["impacts"]["ext_contact_time"]
    dataset = ext_contact_time(given)
    assert len(given["balls"]) == 5
    for (name, ball), speeds in zip(given["balls"].items(), dataset.impact_speed, strict=True):
        r = ball["restitution"]
        factor = hertz_factor(r)
        bodies = ball, given["table_material"]
        soft = sum((1 - body["poissons_ratio"] ** 2) / body["youngs_modulus"] for body in bodies)
        mass = ball["density"] * np.pi / 6 * ball["diameter"] ** 3
        stiffness = 4 / 3 / soft * np.sqrt(ball["diameter"] / 2)

        def time(frequency, r=r, scale=factor * (mass / stiffness) ** 0.4):
            return scale * (G / ((1 + r) * frequency)) ** -0.2

        one = dataset.sel(ball_name=name)
        np.testing.assert_allclose(speeds, G / ((1 + r) * dataset.frequency), rtol=1e-12)
        np.testing.assert_allclose(one.contact_time, time(dataset.frequency), rtol=1e-6)
        stiff = brentq(lambda f, time=time: f * time(f) - 1 / 200, 0.1, 1e4)
        assert one.stiff_frequency == pytest.approx(stiff, rel=1e-6)
    np.testing.assert_allclose(dataset.longest_contact_time * dataset.frequency, 1 / 200)


def test_the_ball_of_the_replication_by_hand_is_answered_here(capsys):
    """docs/your-ball.md: the example that needs this package prints what the page shows."""
    page = (BEYOND / "../../docs/your-ball.md").read_text("utf-8")
    ((example, printed),) = re.findall(r"```python\n(from.*?)```\n+```text\n(.*?)```", page, re.S)
    exec(example, {})
    assert capsys.readouterr().out == printed


def test_answers_in_sentences():
    good = str(on_shaker(**TABLE, contact_duration=1e-4))
    assert "The ball bounces once in each period" in good
    assert "stays there" in good
    # 0.8 g over (100π rad/s)².
    assert "The table moves by ±0.07949 mm at 50 Hz, with an acceleration of 0.8 times" in good
    assert good.endswith("A restitution coefficient is good enough.")
    doubled = str(on_shaker(**{**TABLE, "acceleration": 1.2 * G}, contact_duration=1e-5))
    assert "unstable, its period has doubled" in doubled and "has no answer" in doubled
    assert "stays there" not in doubled
    resting = on_shaker(**{**TABLE, "acceleration": 0.2 * G}, contact_duration=1e-5)
    assert "does not bounce" in str(resting) and np.isnan(resting.error)
    assert "2 periods" in str(on_shaker(**TABLE, contact_duration=1e-5, n=2))


@pytest.mark.parametrize(
    ("acceleration", "duration", "verdict"),
    [
        (1.2 * G, 1e-4, "has no answer: the orbit has doubled in both models, so a ball does"),
        (0.8 * G, 3e-4, "is not good enough: the heights of both models differ by more than"),
        (0.2 * G, 1e-4, "has no answer: Λ is below the saddle-node in both models, so there"),
        (0.254 * G, 1.4e-4, "is not good enough: Λ is below the saddle-node in the restitution"),
    ],
)
def test_the_answer_says_why_not(acceleration, duration, verdict):
    answer = on_shaker(**{**TABLE, "acceleration": acceleration}, contact_duration=duration)
    assert verdict in str(answer)
    assert not answer.is_good_enough


def test_error_and_tolerance_are_in_per_cent():
    answer = str(on_shaker(**TABLE, contact_duration=1e-4, tolerance=0.02))
    assert "% lower than" in answer and "within the tolerance of 2%;" in answer


def test_between_the_bifurcations_of_both_models():
    """Where the contact has an orbit and the restitution model has none."""
    answer = on_shaker(**{**TABLE, "acceleration": 0.254 * G}, **CONTACT)
    assert "in one of the two models only" in str(answer)
    assert not answer.bounces
    values = contact_values(answer.ball, amplitude=answer.amplitude)
    assert values["saddle_node"] < answer.amplitude < answer.saddle_node.by_restitution


@pytest.mark.parametrize(
    ("change", "named"),
    [
        ({"acceleration": None}, "exactly one of displacement, acceleration"),
        ({"stiffness": None}, "exactly one of contact_duration, stiffness, youngs_modulus"),
        ({"mass": None}, "mass"),
        ({"mass": "20 g"}, "mass = '20 g': must be a number"),
        ({"restitution": 1.2}, "restitution"),
        ({"restitution": None}, "restitution = None: must be a number"),
        ({"frequency": 0.0}, r"frequency = 0: must be in \(0, ∞\)"),
        ({"n": 1.5}, "n = 1.5: must be a whole number"),
        ({"stiffness": 1.0}, "a contact lasts"),
        ({"stiffness": None, "youngs_modulus": 1e9}, "radius"),
        (
            {"stiffness": None, "youngs_modulus": 1e9, "radius": 0.1, "poissons_ratio": 2},
            "poissons_ratio",
        ),
    ],
)
def test_mistakes_are_one_line(change, named):
    with pytest.raises(ValueError, match=named) as raised:
        on_shaker(**{**TABLE, **CONTACT, **change})
    assert "\n" not in str(raised.value)


def test_a_stroke_in_metres_has_no_height_that_is_no_number():
    given = {"frequency": 25.0, "mass": 0.02, "stiffness": 1e6, "restitution": 0.6}
    words = str(on_shaker(**given, displacement=0.4))
    assert "nan" not in words
    assert "The table moves by ±400 mm" in words


def test_below_the_saddle_node_of_the_restitution_model_no_threshold_is_looked_for(monkeypatch):
    monkeypatch.setattr(shaker, "error_thresholds", None)
    given = {"frequency": 50.0, "restitution": 0.85, "contact_duration": 1e-4}
    answer = on_shaker(acceleration=0.05 * G, **given)
    assert np.isnan([answer.max_height.exact, answer.longest_contact]).all()


def test_measured_pairs_of_speed_and_restitution():
    """Pairs of one r have its answer; with r(v) the doubling is that of the r(v) at v₀."""
    given = {"frequency": 15.0, "acceleration": 0.996 * 9.80665, "contact_duration": 3e-4}
    number = bb.on_shaker(restitution=0.65, **given)
    equal = bb.on_shaker(restitution=[(0.1, 0.65), (0.4, 0.65), (1.0, 0.65)], **given)
    for name in ("saddle_node", "period_doubling", "max_height"):
        assert getattr(equal, name) == pytest.approx(getattr(number, name), rel=1e-6)
    pairs = [(0.1, 0.69), (0.3, 0.65), (1.0, 0.61)]
    falls = bb.on_shaker(restitution=pairs, **given)
    of_speed = bb.restitution_of(pairs)
    rigid = bb.Rigid(lambda u: of_speed(u * 9.80665 / (2 * np.pi * 15)))
    expected = bb.limits(rigid).period_doubling.amplitude
    assert falls.period_doubling.by_restitution == pytest.approx(expected, rel=1e-9)
    with pytest.raises(ValueError, match=r"closes at 0\.332 m/s: measure it there"):
        bb.on_shaker(restitution=[(3.0, 0.6), (4.0, 0.5)], **given)
    with pytest.raises(ValueError, match="restitution_of"):
        bb.Rigid(lambda u: np.interp(u, [0.0, 10.0], [0.9, 0.5]))


def test_measured_pairs_that_no_damper_of_the_release_has():
    pairs = [(0.1, 0.6), (0.2, 0.7), (0.4, 0.8)]
    given = {"frequency": 50.0, "acceleration": 8.5, "mass": 0.02, "stiffness": 1e8}
    with pytest.raises(ValueError, match=r"falls to r = 0\.11 at 0\.0029 m/s, but a damper whose"):
        on_shaker(restitution=pairs, **given)
    assert on_shaker(restitution=pairs, release="displacement", **given).bounces


def test_a_stroke_that_few_shakers_have_is_asked_about():
    given = {"frequency": 50.0, "restitution": 0.85, "contact_duration": 1e-4}
    assert "Were millimetres meant?" in str(on_shaker(displacement=0.1, **given))
    assert "meant" not in str(on_shaker(displacement=1e-4, **given))

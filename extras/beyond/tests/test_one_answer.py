"""One question, one answer: is a contact stiff enough for a restitution coefficient?

Thirty balls are asked in each place that answers: by hand (docs/your-ball.md), `errors` and
`bifurcations` of the replication, `on_shaker`, the explorer in a browser, and the orbits of this
package. All places must give the same numbers and the same verdict, or refuse the ball.
"""

from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from browser import Frame, shown

import bouncing_ball_beyond
from bouncing_ball import restitution
from bouncing_ball.continuation import bifurcations
from bouncing_ball.errors import errors
from bouncing_ball.orbits import NoOrbit
from bouncing_ball.spring_damper import Contact, contact_of_duration, damping_ratio
from bouncing_ball_beyond import OrbitNotFound, Rigid, SpringDamper, limits, on_shaker, orbit
from paper_replication.datasets import read
from studies.explorer import page

FIGURES = Path(__file__).resolve().parents[1] / "figures"
GRAVITY = 9.80665
MEASURES = ("max_height", "bounce_velocity", "apparent_restitution", "phase")
"""Quantities with an error, by their names in the explorer."""
ENDS = ("saddle_node", "period_doubling")
EXACT = 1e-8
"""Largest difference of two codes, relative to the value; errors are differences of such values."""
ROUGH = 1e-3
"""Largest error of the formula for ϖ by hand."""


class Given(NamedTuple):
    """A ball as a person gives it: the contact by its time or its stiffness.

    The amplitude is given as acceleration if n is odd, and as stroke otherwise.
    """

    release: str
    r: float
    n: int
    amplitude: float
    ratio: float
    measured: bool
    frequency: float = 30.0
    mass: float = 0.02

    @property
    def rate(self):
        return 2 * np.pi * self.frequency

    @property
    def stroke(self):
        """In mm, from the lowest to the highest point."""
        return 2000 * self.amplitude * GRAVITY / self.rate**2

    @property
    def stiffness(self):
        return self.mass * (self.ratio * self.rate) ** 2

    @property
    def time(self):
        """Duration of a free impact in ms, from the closed form with its ζ."""
        if self.release == "displacement":
            return 1e3 * np.hypot(np.pi, np.log(self.r)) / (self.ratio * self.rate)
        zeta = damping_ratio(self.r, "force")
        return 1e3 * 2 * np.arccos(zeta) / np.sqrt(1 - zeta**2) / (self.ratio * self.rate)


def balls():
    """Thirty balls, and those of README and of the paper's Fig. 5.

    A place is a position on the range of the restitution model, or the middle between an end of
    both models.
    """
    rng = np.random.default_rng(128)
    columns = (
        ["force", "displacement"] * 15,
        [0.1355, 0.16, 0.25, 0.4, 0.55, 0.65, 0.75, 0.85, 0.94, 1.0] * 3,
        [1, 2, 3, 4, 5, 6] * 5,
        [0.02, 0.4, 0.95, 1.3, -0.3, "saddle-node", "period doubling", 0.7, 0.1, 3] * 3,
        np.geomspace(6, 2000, 30),
        [True, True, False] * 10,
    )
    shuffled = [[column[k] for k in rng.permutation(30)] for column in columns]
    for release, r, n, place, ratio, measured in zip(*shuffled, strict=True):
        low, high = restitution.saddle_node(n, r), restitution.period_doubling(n, r)
        if isinstance(place, str):
            end = low if place == "saddle-node" else high
            bifurcation = bifurcations(n, place, Contact.of_restitution(ratio, r, release))[0]
            amplitude = (end + np.nan_to_num(bifurcation.item())) / 2
        else:
            amplitude = low + place * (high - low)
        # An elastic ball has orbits from Λ = 0.
        yield Given(release, r, n, abs(float(amplitude)) or 0.1, float(ratio), measured)
    readme = 1.1e-3 * (30 * np.pi) ** 2 / GRAVITY
    for time in (0.3e-3, 0.39e-3):
        ratio = contact_of_duration(30 * np.pi * time, 0.65, "force").frequency_ratio
        yield Given("force", 0.65, 1, readme, float(ratio), True, frequency=15.0)
    soft = contact_of_duration(60 * np.pi * 2e-3, 0.8, "force").frequency_ratio
    for n in (1, 5):
        yield Given("force", 0.8, n, 0.5e-3 * (60 * np.pi) ** 2 / GRAVITY, float(soft), True)
    yield Given("displacement", 1.0, 1, 0.8, 100.0, False)
    yield Given("force", 0.65, 1, 1.239, 100.0, False)


BALLS = list(balls())


def state(amplitude, low, high):
    """The word for an amplitude and the ends of a range."""
    return "below" if amplitude < low else "stable" if amplitude < high else "doubled"


def verdict(states, error):
    """The verdict by the definition: the same stable orbit, and an error of at most 1 %."""
    if states[0] == states[1] != "stable":
        return "no answer"
    return "good" if states[0] == states[1] and abs(error) <= 0.01 else "not good"


def by_hand(ball):
    """The recipe of docs/your-ball.md."""
    amplitude = ball.stroke / 2000 * ball.rate**2 / 9.80665
    if ball.measured:
        loss = np.log(ball.r)
        bracket = np.sqrt(np.pi**2 + loss**2)
        if ball.release == "force":
            bracket = np.pi + 2 / np.pi * loss + 0.033 * loss**2
        ratio = bracket / (ball.rate * ball.time / 1000)
    else:
        ratio = np.sqrt(ball.stiffness / ball.mass) / ball.rate
    r, n = ball.r, ball.n
    low = n * np.pi * (1 - r) / (1 + r)
    high = np.sqrt(low**2 + (2 * (1 + r**2) / (1 + r) ** 2) ** 2)
    return {
        "amplitude": amplitude,
        "rough frequency_ratio": ratio,
        "restitution saddle_node": low,
        "restitution period_doubling": high,
        "numbers": " ".join(map(str, stable_numbers(amplitude, r))),
    }


def stable_numbers(amplitude, r):
    """Numbers n up to 20 with a stable orbit in the restitution model."""
    push = 2 * (1 + r**2) / (1 + r) ** 2
    least = np.sqrt(max(amplitude**2 - push**2, 0.0))
    return [n for n in range(1, 21) if least <= n * np.pi * (1 - r) / (1 + r) <= amplitude]


def by_errors(ball):
    """`errors` and `bifurcations`, as in the example of docs/your-ball.md."""
    contact = Contact.of_restitution(ball.ratio, ball.r, ball.release)
    if ball.measured:
        contact = contact_of_duration(ball.rate * ball.time / 1000, ball.r, ball.release)
    ratio = np.asarray(contact.frequency_ratio).item()
    kinds = ("saddle-node", "period doubling")
    ends = [bifurcations(ball.n, kind, contact)[0].item() for kind in kinds]
    simple = restitution.saddle_node(ball.n, ball.r), restitution.period_doubling(ball.n, ball.r)
    if ball.r == 1:
        ends[0] = 0.0
    states = [state(ball.amplitude, *interval) for interval in (simple, ends)]
    names = {name: name for name in MEASURES} | {"phase": "phase_in_periods"}
    given = (ball.n, ball.r, ball.amplitude, np.array([ratio]), ball.release)
    quantities = {"frequency_ratio": ratio}
    quantities |= {f"restitution {end}": value for end, value in zip(ENDS, simple, strict=True)}
    quantities |= {f"contact {end}": value for end, value in zip(ENDS, ends, strict=True)}
    height = np.nan
    if states == ["stable", "stable"]:
        values = errors([*names.values()], *given)
        quantities |= {f"size {name}": values[names[name]].values.item() for name in MEASURES}
        height = quantities["size max_height"]
    else:
        with pytest.raises(NoOrbit, match="orbits of the restitution model need"):
            errors(["max_height"], *given)
    return quantities | {"verdict": verdict(states, height)}


def by_shaker(ball):
    contact = {"mass": ball.mass, "stiffness": ball.stiffness}
    if ball.measured:
        contact = {"contact_duration": ball.time / 1000}
    table = {"displacement": ball.stroke / 2000}
    if ball.n % 2:
        table = {"acceleration": ball.amplitude * GRAVITY}
    given = {"frequency": ball.frequency, "restitution": ball.r, "n": ball.n}
    answer = on_shaker(**given, **table, **contact, release=ball.release)
    words = {True: "good", False: "not good"}[answer.is_good_enough]
    quantities = {"amplitude": answer.amplitude, "frequency_ratio": answer.ball.frequency_ratio}
    for end in ENDS:
        value = getattr(answer, end)
        quantities |= {f"restitution {end}": value.by_restitution, f"contact {end}": value.exact}
    if answer.stable:
        quantities["error max_height"] = answer.error
    assert ("marginally stable" in str(answer)) == (answer.stable and ball.r == 1)
    return quantities | {"verdict": "no answer" if "has no answer" in str(answer) else words}


def by_orbit(ball):
    """The orbits of this package, on the contact and with the restitution coefficient."""
    contact = SpringDamper(ball.ratio, restitution=ball.r, release=ball.release)
    of = {"contact": contact, "restitution": Rigid(ball.r)}
    quantities, orbits, states = {"frequency_ratio": ball.ratio}, {}, []
    for name, package_ball in of.items():
        ends = limits(package_ball, n=ball.n)
        for end in ENDS:
            value = getattr(ends, end)
            quantities[f"{name} {end}"] = getattr(value, "amplitude", np.nan)
        if ball.r == 1:
            quantities[f"{name} saddle_node"] = 0.0
        try:
            orbits[name] = orbit(package_ball, amplitude=ball.amplitude, n=ball.n)
        except OrbitNotFound:
            states.append("below")
            continue
        states.append("stable" if orbits[name].stable else "doubled")
    if states == ["stable", "stable"]:
        for name in MEASURES:
            exact, simple = (float(np.ravel(getattr(orbits[model], name))[0]) for model in of)
            quantities[f"error {name}"] = (exact - simple) / (
                2 * np.pi if name == "phase" else simple
            )
    return quantities | {"verdict": verdict(states, quantities.get("error max_height", np.nan))}


def address(ball):
    """The ball in the explorer: what is typed in its fields."""
    table = f"acc={ball.amplitude}" if ball.n % 2 else f"stroke={ball.stroke}"
    contact = f"time={ball.time}" if ball.measured else f"k={ball.stiffness}&m={1000 * ball.mass}"
    return (
        f"#tab=design&f={ball.frequency}&{table}&{contact}&r={ball.r}&n={ball.n}"
        f"&release={ball.release}"
    )


@pytest.fixture(scope="module")
def explored(tmp_path_factory):
    """What the explorer shows of each ball."""
    text = page(read(FIGURES / "explorer.nc"))
    frames = {str(k): Frame(text, address(ball)) for k, ball in enumerate(BALLS)}
    refused = {"refused": Frame(text, "#tab=design&r=0.13")}
    return shown(frames | refused, tmp_path_factory.mktemp("one answer"))


HEADLINES = {
    "The restitution model is good enough:": "good",
    "The restitution model is not good enough:": "not good",
    "No verdict:": "no answer",
}


def by_explorer(seen, n):
    values = seen["values"]
    words = [name for start, name in HEADLINES.items() if seen["verdict"].startswith(start)]
    quantities = {name: values[name] for name in ("amplitude", "frequency_ratio")}
    for model, column in (("restitution", "restitution"), ("contact", "spring-damper")):
        quantities |= {f"{model} {end}": float(values[f"{column} {end}"]) for end in ENDS}
    states = {values[f"{column} state"] for column in ("restitution", "spring-damper")}
    if states <= {"stable", "marginally stable"}:
        quantities |= {f"error {name}": float(values[f"errors {name}"]) for name in MEASURES}
    numbers = {int(name.removeprefix("n = ")) for name in seen["others"]}
    if values["restitution state"] in ("stable", "marginally stable"):
        numbers.add(n)
    quantities["numbers"] = " ".join(map(str, sorted(numbers)))
    return quantities | {"verdict": words[0] if words else seen["verdict"] or seen["refused"]}


def differences(answers):
    """Quantities in which places differ, with the value in each place that has one."""
    disagreements = {}
    for name in set().union(*answers.values()):
        values = {
            place: quantities[name] for place, quantities in answers.items() if name in quantities
        }
        kind, _, what = name.partition(" ")
        if kind == "rough":
            values["errors"] = answers["errors"][what]
        if kind == "size":
            signed = f"error {what}"
            values |= {
                at: abs(quantities[signed])
                for at, quantities in answers.items()
                if signed in quantities
            }
        first, *others = values.values()
        limit = {"rel": ROUGH if kind == "rough" else EXACT, "abs": EXACT, "nan_ok": True}
        expected = first if isinstance(first, str) else pytest.approx(first, **limit)
        if any(other != expected for other in others):
            disagreements[name] = values
    return disagreements


@pytest.mark.parametrize("k", range(len(BALLS)))
def test_every_place_gives_one_answer(explored, k):
    ball = BALLS[k]
    answers = {
        "by hand": by_hand(ball),
        "errors": by_errors(ball),
        "on_shaker": by_shaker(ball),
        "explorer": by_explorer(explored[str(k)], ball.n),
        "orbit": by_orbit(ball),
    }
    assert not differences(answers), ball
    low, high = (answers["by hand"][f"restitution {end}"] for end in ENDS)
    if ball.r >= 0.5 and 0.1 <= (ball.amplitude - low) / (high - low):
        size = answers["errors"].get("size max_height", 1 / (ball.n * ball.ratio))
        assert 0.55 <= size * ball.n * ball.ratio <= 1.1


def test_a_restitution_that_no_contact_has_is_refused_in_every_place(explored):
    """With the force release r must be above e⁻²."""
    given = (1, 0.13, 2.6, np.array([100.0]), "force")
    with pytest.raises(NoOrbit, match="must be above e⁻²"):
        errors(["max_height"], *given)
    with pytest.raises(ValueError, match=r"restitution = 0.13: must be in \(0.135335, 1\]"):
        on_shaker(frequency=30.0, acceleration=20.0, restitution=0.13, contact_duration=1e-3)
    with pytest.raises(ValueError, match=r"restitution = 0.13: must be in \(0.135335, 1\]"):
        SpringDamper(100.0, restitution=0.13, release="force")
    assert "e⁻²" in explored["refused"]["refused"]
    assert explored["refused"]["verdict"] == ""


def test_the_call_of_the_explorer_computes_what_it_shows(explored):
    """The verdict's number, and the same error, for each ball whose orbits are stable."""
    names = {name: getattr(bouncing_ball_beyond, name) for name in bouncing_ball_beyond.__all__}
    for k in range(0, len(BALLS), 4):
        seen = explored[str(k)]
        answer = eval(seen["call"], names)
        assert answer.amplitude == pytest.approx(seen["values"]["amplitude"], rel=1e-12)
        assert answer.ball.frequency_ratio == pytest.approx(seen["values"]["frequency_ratio"])

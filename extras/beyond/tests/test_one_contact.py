"""The explorer has one contact in all tabs.

Cases are given on each tab and in each unit, shown on all tabs, and compared with the package at
the values that the tab shows.
"""

import itertools
import re
from functools import cache
from pathlib import Path
from urllib.parse import parse_qsl, quote

import numpy as np
import pytest
from browser import Frame, shown

import bouncing_ball_beyond
from bouncing_ball import restitution
from bouncing_ball.spring_damper import damping_ratio
from bouncing_ball_beyond import OrbitNotFound, Rigid, limits
from bouncing_ball_beyond.errors.error_law import free_impact
from paper_replication.datasets import read
from studies.explorer import page

GRAVITY = 9.80665
FREQUENCY, MASS = 20.0, 0.02
RATE = 2 * np.pi * FREQUENCY
CASES = {
    "default": (0.85, 17.9, 0.8),
    "locked on the contact that cannot pull": (0.3, 3.0, 1.4),
    "elastic": (1.0, 100.0, 0.8),
    "smallest r of the force release": (0.1354, 80.0, 2.0),
    "no contact with the force release": (0.13, 80.0, 2.0),
    "at 1 g": (0.5, 40.0, 1.0),
    "slower than the table": (0.7, 0.8, 0.9),
    "rigid": (0.9, 1e5, 0.5),
    "doubled": (0.65, 100.0, 1.3),
}
"""r, ϖ and Λ."""
READ = 1e-10
"""Largest relative difference of Λ and ϖ from what is given: units are converted in 12 digits."""
FILLED_IN = 1e-5
"""Largest change of Λ and ϖ from tab to tab, and back: a tab fills in six digits."""
EXACT = 1e-10
"""Largest difference from the package: a hundred times the largest that was seen."""
OBSERVED = ("phase", "max_height", "bounce_velocity", "impact_velocity", "apparent_restitution")
KINDS = {"stays": "permanent contact", "repeats": "periodic", "sticks": "locked"}
NAMES = {name: getattr(bouncing_ball_beyond, name) for name in bouncing_ball_beyond.__all__}


def given(r, ratio, amplitude, release):
    """Ways to give a case: the tab and its values."""
    stroke = 2 * amplitude * GRAVITY / RATE**2
    stiffness = MASS * (RATE * ratio) ** 2
    common = {"r": r, "release": release}
    physical = common | {"tab": "design", "f": FREQUENCY}
    stage = common | {"tab": "stage", "w": ratio, "a": amplitude, "f": FREQUENCY}
    yield physical | {"acc": amplitude, "k": stiffness, "m": 1e3 * MASS}
    newtons = {"k": f"{stiffness / 1e3} N/mm", "m": f"{MASS} kg"}
    yield physical | newtons | {"acc": f"{amplitude * GRAVITY} m/s²"}
    yield common | {"tab": "orbit", "w": ratio, "a": amplitude}
    yield stage | {"units": "physical"}
    yield stage | {"units": "dimensionless"}
    if release == "displacement" or r > np.exp(-2):
        zeta = damping_ratio(r, release)
        angle = np.pi if release == "displacement" else 2 * np.arccos(zeta)
        time = float(angle / np.sqrt(1 - zeta**2) / (ratio * RATE))
        yield physical | {"stroke": 1e3 * stroke, "time": 1e3 * time}
        lengths = {"stroke": f"{1e2 * stroke} cm", "f": f"{FREQUENCY / 1e3} kHz"}
        yield physical | lengths | {"time": f"{1e6 * time} µs"}


def rows():
    """Cases, releases, n and addresses, over all tabs and units."""
    for name, release, n in itertools.product(CASES, ("displacement", "force"), (1, 3)):
        for values in given(*CASES[name], release):
            if values["tab"] != "stage":
                values["n"] = n
            elif n > 1:
                continue
            address = "#" + "&".join(f"{key}={quote(str(value))}" for key, value in values.items())
            yield name, release, n, address


ROWS = list(rows())


@pytest.fixture(scope="module")
def seen(tmp_path_factory):
    """What each tab answers, for each row."""
    text = page(read(Path(__file__).resolve().parents[1] / "figures/explorer.nc"))
    frame = Frame(text, states=tuple(address for *_, address in ROWS))
    return shown({"all": frame}, tmp_path_factory.mktemp("one contact"))["all"]["states"]


def state_of(answer):
    """The values of the address, and the Λ and ϖ of the tab."""
    state = dict(parse_qsl(answer["hash"].removeprefix("#")))
    if state["tab"] == "design":
        state |= {"a": answer["values"]["amplitude"], "w": answer["values"]["frequency_ratio"]}
    return state


def judged(answers, tab):
    """The answers of a tab with a verdict, of which there are more than cases."""
    with_verdict = [answer for answer in answers if state_of(answer)["tab"] == tab]
    with_verdict = [answer for answer in with_verdict if answer["verdict"]]
    assert len(with_verdict) > len(CASES)
    return with_verdict


@cache
def called(call):
    """What a call of the page returns, or the error that it raises."""
    try:
        return eval(call, NAMES)
    except (OrbitNotFound, ValueError) as error:
        return error


def test_a_case_is_the_same_on_all_tabs(seen):
    motions = {}
    for (name, release, n, address), answers in zip(ROWS, seen, strict=True):
        for k, answer in enumerate(answers):
            state = state_of(answer)
            assert (float(state["r"]), state["release"]) == (CASES[name][0], release), address
            if name.startswith("no contact") and release == "force":
                assert "e⁻²" in answer["refused"]
                continue
            values = [float(state[key]) for key in ("w", "a")]
            assert values == pytest.approx(CASES[name][1:], rel=FILLED_IN if k else READ), address
            if state["tab"] == "stage":
                unused = f"Left out: n = {n} (not used here)." if n > 1 else ""
                assert answer["refused"] == unused
                motion = motions.setdefault((name, release), answer["motions"])
                assert answer["motions"] == motion, address
            else:
                assert answer["refused"] == ""
        first, *_, last = (answer["hash"].partition("&units=")[0] for answer in answers)
        assert last == first


def test_each_tab_has_the_motions_of_the_package(seen):
    """The explorer leaves open what a motion is that does not repeat, or chaotic."""
    for answer in judged(itertools.chain(*seen), "stage"):
        for motion, call in zip(answer["motions"], answer["call"].splitlines(), strict=True):
            package_motion = called(call)
            counts = package_motion.periods.item(), package_motion.impacts.item()
            assert counts == (motion["periods"], motion["impacts"])
            assert package_motion.kind.item() == KINDS.get(motion["kind"], "chaotic")


def test_each_tab_has_the_orbits_of_the_package(seen):
    """Below its saddle-node a contact can have further orbits, which the explorer does not show."""
    for answer in judged(itertools.chain(*seen), "orbit"):
        orbit, values = called(answer["call"]), answer["values"]
        if isinstance(orbit, OrbitNotFound):
            assert values["spring-damper state"] == "below the saddle-node"
        elif values["spring-damper state"] == "below the saddle-node":
            n = int(state_of(answer)["n"])
            assert orbit.amplitude < limits(orbit.ball, n=n).saddle_node.amplitude
        else:
            shows = [values[f"spring-damper {name}"] for name in OBSERVED]
            computed = [np.ravel(getattr(orbit, name))[0] for name in OBSERVED]
            assert shows == pytest.approx(computed, rel=EXACT, abs=EXACT)


def unstable_cases():
    """The issue's case, and 299 others on the unstable side, below the saddle-node, too."""
    yield 0.65, 100.0, 1.0, 2, "displacement"
    rng = np.random.default_rng(157)
    for k in range(299):
        release = ("displacement", "force")[k % 2]
        r = rng.uniform(0.05 if release == "displacement" else 0.14, 1.0)
        n, ratio = int(rng.integers(1, 6)), np.exp(rng.uniform(np.log(2), np.log(1000)))
        ends = [end(n, r) for end in (restitution.saddle_node, restitution.period_doubling)]
        yield r, ratio, rng.uniform(0.3 * ends[0], 1.6 * ends[1]), n, release


def test_the_explorer_refuses_where_python_refuses(tmp_path):
    """Other orbits have the same phase and height, and none of this side gets a verdict."""
    names = ("r", "w", "a", "n", "release")
    addresses = tuple(
        "#tab=orbit&side=unstable&" + "&".join(map("{}={}".format, names, case))
        for case in unstable_cases()
    )
    text = page(read(Path(__file__).resolve().parents[1] / "figures/explorer.nc"))
    answers = shown({"all": Frame(text, cases=addresses)}, tmp_path)["all"]["cases"]
    seen = set()
    for answer in answers:
        orbit, values = called(answer["call"]), answer["values"]
        kinds = {"below the saddle-node", "no orbit"}
        if not isinstance(orbit, OrbitNotFound):
            kinds = {"unstable" if orbit.admissible else "no ball follows it"}
            shows = [values[f"spring-damper {name}"] for name in OBSERVED]
            computed = [np.ravel(getattr(orbit, name))[0] for name in OBSERVED]
            assert shows == pytest.approx(computed, rel=EXACT, abs=EXACT)
        state, _, why = values["spring-damper state"].partition(": ")
        assert state in kinds, answer["call"]
        assert why == getattr(orbit, "obstacle", "")
        assert answer["verdict"].startswith("No verdict: no ball stays on the ")
        seen.add(state)
    assert {"below the saddle-node", "unstable", "no ball follows it"} <= seen


def test_an_orbit_below_the_table_is_not_called_stable(tmp_path):
    """Both multipliers are in the unit circle, in all three models."""
    address = "#tab=orbit&r=0.01&w=1000&a=3.0805&release=displacement"
    text = page(read(Path(__file__).resolve().parents[1] / "figures/explorer.nc"))
    (answer,) = shown({"low": Frame(text, cases=(address,))}, tmp_path)["low"]["cases"]
    orbit = called(answer["call"])
    assert orbit.obstacle == "a flight passes below the table"
    assert answer["values"]["spring-damper state"] == f"no ball follows it: {orbit.obstacle}"
    assert answer["verdict"].startswith("No verdict: no ball stays on the 1-T orbit")
    assert np.isnan(float(answer["values"]["errors max_height"]))


def test_the_physical_tab_says_what_on_shaker_says(seen):
    for answer in judged((answer for answer, *_ in seen), "design"):
        state, values = state_of(answer), answer["values"]
        n, r = int(state["n"]), float(state["r"])
        speed = free_impact(Rigid(r), n).speed.item() * GRAVITY / RATE
        assert f"= {speed:.3g} m/s on the {n}-T orbit" in answer["speed"]
        shaker_answer = called(answer["call"])
        if isinstance(shaker_answer, ValueError):
            assert "is not found" in str(shaker_answer)
            assert "NaN" in (
                values["spring-damper saddle_node"],
                values["spring-damper period_doubling"],
            )
            continue
        for end in ("saddle_node", "period_doubling"):
            shows = [float(values[f"{model} {end}"]) for model in ("restitution", "spring-damper")]
            assert shows == pytest.approx(getattr(shaker_answer, end)[:2], rel=EXACT, abs=EXACT)
        if shaker_answer.stable:
            assert values["errors max_height"] == pytest.approx(
                shaker_answer.error, rel=EXACT, abs=EXACT
            )
            sentence = re.search(
                r"maximum height is .*? the tolerance of [\d.]+%", answer["verdict"]
            )
            assert sentence[0] in str(shaker_answer)

"""What each public function says of an orbit that no ball follows, an unstable one, or one of many.

The three columns of `TABLE` are the three cases. An entry is what the function says, and what it
must say. Functions without an orbit, and those that follow a motion, are listed below the table.
"""

import re
from types import SimpleNamespace

import numpy as np
import pytest
from integrated import leg

import bouncing_ball_beyond as bb

G = 9.80665
BELOW = "a flight passes below the table"
EARLIER = "a contact ends earlier"
BOTH = f"in the simple model: {BELOW}; on the contact: {BELOW}"


def falls(u):
    """This r falls so fast that there are three closing speeds."""
    return 0.9 - 0.3 * (1 + np.tanh(3 * (u - 3.8)))


def shaken(amplitude, **given):
    return bb.on_shaker(frequency=50.0, acceleration=amplitude * G, **given)


def case(ball, contact, amplitude):
    """A ball of instantaneous impacts and a stiff contact of the same r, at one Λ."""
    return SimpleNamespace(ball=ball, contact=contact, given={"amplitude": amplitude})


def creeping(p, v, stiffness, start_speed):
    """The force of a spring and a damper with the r of `falls`."""
    loss = -np.log(falls(start_speed))
    zeta = loss / np.sqrt(np.pi**2 + loss**2)
    return stiffness * p + 2 * zeta * np.sqrt(stiffness) * v


STIFF = {"frequency_ratio": 1e4}
INADMISSIBLE = case(bb.Rigid(0.01), bb.SpringDamper(**STIFF, restitution=0.01), 3.085)
UNSTABLE = case(bb.Rigid(0.5), bb.SpringDamper(**STIFF, restitution=0.5), 1.6)
SEVERAL = case(
    bb.Rigid(falls),
    bb.ForceLaw(creeping, {"stiffness": 1e8}, needs=("start_speed",)),
    0.6,
)
SPEEDS = 3.3923726, 3.6679452, 4.8285755
"""The three closing speeds of `falls`: roots of (1 + r(u)) u = 2π, from a scan."""

R = float(falls(SPEEDS[2]))
"""The r of the orbit whose values are compared: of the speed that `free_impact` finds."""

SHAKEN = {
    "inadmissible": {"restitution": 0.01, "contact_duration": 1e-6, "release": "displacement"},
    "unstable": {"restitution": 0.5, "contact_duration": 1e-5},
}


def branch(one, to):
    return bb.follow(bb.orbit(one.ball, **one.given), to=to)


def curve(one):
    fold = bb.limits(one.ball).saddle_node
    ranges = {"amplitude": (3.0, 3.2), "restitution": (0.005, 0.02)}
    return bb.special_curve(fold, along=("amplitude", "restitution"), ranges=ranges)


def legend(one, to):
    return {text.get_text() for text in bb.plot(branch(one, to)).legends[0].get_texts()}


def named(function, one, **given):
    """What errors, values and thresholds say of their orbits."""
    values = function(one.contact, **one.given, **given)
    values = values.get("max_height") if function is bb.error_thresholds else values
    return str(values.unstable), str(values.inadmissible)


def of_shaker(name, amplitude):
    answer = shaken(amplitude, **SHAKEN[name])
    verdict = str(answer).rpartition("\n")[2].partition("has no answer: ")[2]
    return answer.bounces, answer.stable, answer.is_good_enough, verdict


MEASURED = 3.0, 3.5, 4.0, 4.5, 6.5


def measured():
    """Pairs of a soft drop, whose fit has three closing speeds."""
    unit = G / (100 * np.pi)
    fit = bb.restitution_of([(v * unit, 1 / (1 + (v / 3.9) ** 14)) for v in MEASURED])
    return [(v * unit, float(fit(v * unit))) for v in MEASURED]


TABLE = {
    "orbit": (
        (lambda one: bb.orbit(one.ball, **one.given).obstacle, BELOW),
        (lambda one: bb.orbit(one.ball, **one.given).stable, False),
        (lambda one: bb.orbit(one.ball, **one.given).others[:, 1], [SPEEDS[1]]),
    ),
    "orbits": (
        (lambda one: bb.orbits(one.ball, **one.given), []),
        (lambda one: [orbit.stable for orbit in bb.orbits(one.ball, **one.given)], [False] * 2),
        (
            lambda one: sorted({orbit.speeds[0] for orbit in bb.orbits(one.ball, **one.given)}),
            SPEEDS[:2],
        ),
    ),
    "limits": (
        (lambda one: bb.limits(one.ball).stable_ranges, [(3.0930509, 3.6506560)]),
        (lambda one: bb.limits(one.ball).stable_ranges, [(1.0471976, 1.5268237)]),
        (lambda one: bb.limits(one.ball).others[:, 2], [SPEEDS[0], SPEEDS[2]]),
    ),
    "follow": (
        (lambda one: branch(one, 3.2).admissible[[0, -1]], [False, True]),
        (lambda one: branch(one, 1.2).stable[[0, -1]], [False, True]),
        (lambda one: branch(one, 0.65).orbits[-1].others[:, 1], [SPEEDS[1]]),
    ),
    "special_curve": ((lambda one: curve(one).admissible.any(), False), None, None),
    "normal_form": (
        (lambda one: bb.normal_form(bb.limits(one.ball).saddle_node).obstacle, BELOW),
        None,
        None,
    ),
    "plot": (
        (lambda one: "stable, no ball follows" in legend(one, 3.2), True),
        (lambda one: legend(one, 1.8) >= {"unstable"}, True),
        None,
    ),
    "to_dataset": (
        (lambda one: bb.to_dataset(bb.orbit(one.ball, **one.given)).admissible.item(), False),
        (lambda one: bb.to_dataset(bb.orbit(one.ball, **one.given)).stable.item(), False),
        None,
    ),
    "contact_values": (
        (lambda one: named(bb.contact_values, one), ("", f"on the contact: {BELOW}")),
        (lambda one: named(bb.contact_values, one), ("on the contact", "")),
        (lambda one: bb.contact_values(one.contact, amplitude=1.9)["apparent_restitution"], R),
    ),
    "exact_errors": (
        (lambda one: named(bb.exact_errors, one), ("", BOTH)),
        (lambda one: named(bb.exact_errors, one), ("in both models", "")),
        (lambda one: bb.exact_errors(one.contact, amplitude=1.9)["apparent_restitution"], 0.0),
    ),
    "Corrected": (
        (lambda one: named(bb.exact_errors, one, simple=bb.Corrected), ("", BOTH)),
        (lambda one: named(bb.exact_errors, one, simple=bb.Corrected), ("in both models", "")),
        None,
    ),
    "error_thresholds": (
        (lambda one: named(bb.error_thresholds, one), ("", BOTH)),
        (lambda one: named(bb.error_thresholds, one), ("in both models", "")),
        None,
    ),
    "on_shaker": (
        (
            lambda one: of_shaker("inadmissible", 3.085),
            (False, False, False, f"no ball follows the orbit in both models: {BELOW}."),
        ),
        (
            lambda one: of_shaker("unstable", 1.6),
            (
                True,
                False,
                False,
                "the orbit has doubled in both models, so a ball does not stay on it.",
            ),
        ),
        None,
    ),
}
for law in ("law_errors", "law_coefficients", "law_thresholds"):
    function = getattr(bb, law)
    TABLE[law] = (
        (lambda one, law=function: named(law, one), ("", f"in the simple model: {BELOW}")),
        (lambda one, law=function: named(law, one), ("in the simple model", "")),
        None,
    )

OTHERS = {
    "motions, which a ball follows": (
        "basins drop history lyapunov motion_of orbit_diagram permanent_contact simulate"
    ),
    "of an impact, not of an orbit": "free_impact restitution_of",
    "from orbits of the functions above": "cascade grazing_form",
}
"""Other public functions."""

CASES = {"inadmissible": INADMISSIBLE, "unstable": UNSTABLE, "several": SEVERAL}


ENTRIES = [
    (name, which, *entry)
    for name, entries in TABLE.items()
    for which, entry in zip(CASES, entries, strict=True)
    if entry
]


@pytest.mark.parametrize(("name", "which", "says", "must"), ENTRIES)
def test_what_is_said_of_an_orbit(name, which, says, must):
    one = CASES[which]
    conclusion = says(one)
    if isinstance(must, str | bool) or (isinstance(must, tuple) and isinstance(must[-1], str)):
        assert conclusion == must
    else:
        assert np.shape(conclusion) == np.shape(must)
        np.testing.assert_allclose(conclusion, must, atol=1e-5)


def test_the_table_has_each_public_function():
    functions = {name for name in bb.__all__ if not isinstance(getattr(bb, name), type)}
    laws = {"adams_impact", "hunt_crossley", "kuwabara_kono", "law_of_impact", "linear"}
    laws |= {"simscape_contact", "tsuji"}
    listed = {*TABLE, *" ".join(OTHERS.values()).split()} - {"Corrected"}
    assert functions - laws == listed


def test_a_contact_that_ends_earlier_is_named():
    ball = bb.SpringDamper(1.580803888063078, damping_ratio=0.25853365407092316, release="force")
    start = bb.orbit(ball, amplitude=2.5166920162308033, n=2)
    passed = bb.follow(start, along="frequency", to=0.92)
    assert EARLIER in {orbit.obstacle for orbit in passed.orbits}
    text = next(str(orbit) for orbit in passed.orbits if orbit.obstacle == EARLIER)
    assert f"no, {EARLIER}" in text


def test_the_text_of_limits_names_what_is_not_followed():
    assert f"saddle-node at Λ = 3.079382898 ({BELOW})" in str(bb.limits(INADMISSIBLE.ball))
    assert "other n-T orbits begin near Λ = 0.25078 with u = 3.39237" in str(
        bb.limits(SEVERAL.ball)
    )
    with pytest.raises(bb.OrbitNotFound, match=r"0.526.*; no other that begins near Λ = 0.25078"):
        bb.orbit(SEVERAL.ball, amplitude=0.2)
    assert bb.orbit(SEVERAL.ball, amplitude=0.3).stable


def test_on_shaker_names_other_closing_speeds():
    """They are those of `orbits` for the fit of the pairs, in m/s."""
    answer = shaken(0.9, restitution=measured(), contact_duration=1e-5, release="displacement")
    unit = G / (100 * np.pi)
    fit = bb.restitution_of(measured())
    rigid = bb.Rigid(lambda u: fit(u * unit))
    every = {orbit.speeds[0] * unit for orbit in bb.orbits(rigid, amplitude=0.9)}
    assert len(every) > 1 and len(answer.others) >= 1
    for speed in answer.others:
        assert min(abs(speed - closing_speed) for closing_speed in every) < 1e-9
    assert re.search(r"Other orbits .* close at 0\.\d+.* they are not judged here", str(answer))


@pytest.mark.parametrize("k", range(12))
def test_a_ball_stays_on_what_is_called_stable(k):
    """Tables with a third harmonic, made to cross: a ball is followed by the integrator."""
    rng = np.random.default_rng(k)
    r, size, phase = rng.uniform(0.01, 0.3), rng.uniform(0.02, 0.15), rng.uniform(0, 6.28)
    table = bb.Table([(1, 1.0, 0.0), (3, size, phase)])
    ball = bb.Rigid(r)
    ranges = bb.limits(ball, table=table).stable_ranges
    assert ranges
    for low, high in ranges:
        for amplitude in np.linspace(low, high, 9)[1:-1]:
            near = [
                orbit for orbit in bb.orbits(ball, amplitude=amplitude, table=table) if orbit.stable
            ]
            assert near
            for orbit in near:
                tau, u = orbit.times[0], orbit.speeds[0]
                for turn in (1, 2):
                    tau, u, _ = leg(ball, amplitude, tau, u, tuple(table.harmonics))
                    assert tau == pytest.approx(orbit.times[0] + 2 * np.pi * turn, abs=1e-6)

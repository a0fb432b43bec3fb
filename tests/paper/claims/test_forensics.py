"""Readings of Table 1: the altered equations against an independent return map."""

from functools import partial

import numpy as np
import pytest
from scipy.optimize import brentq, least_squares

from bouncing_ball.models.damping import Release, damping_ratio
from bouncing_ball.models.spring_damper import SpringDamper
from bouncing_ball.paper.claims.claim_tables import forensics as rows
from bouncing_ball.paper.claims.forensics import (
    PRINTED_DAMPING,
    altered_ends,
    altered_monodromy,
    forensics,
    weightless_orbits,
)
from bouncing_ball.periodic import restitution_branch
from bouncing_ball.periodic.continuation import PaperEquations
from bouncing_ball.periodic.explicit import explicit_branch
from bouncing_ball.periodic.orbit import Bifurcation, monodromy
from bouncing_ball.periodic.restitution_branch import ImpactMap
from bouncing_ball.periodic.spring_damper_branch import branch_point

ZETA = float(damping_ratio(0.85))


def orbits_on_branch(*given):
    return branch_point(*given).orbit


WEIGHTLESS, HIGH_BOUNCE = "no gravity in contact", "high-bounce stability"


@pytest.fixture(scope="module")
def study(described):
    return described(forensics())


def cycle(phase, u, orbit, reference, *, weight, rise):
    """One altered cycle, with its events located by Brent's method."""
    omega = float(orbit.model.frequency_ratio)
    zeta = float(orbit.model.damping_ratio)
    lam = float(orbit.amplitude)
    duration = float(orbit.contact_duration)
    flight = float(orbit.flight_time)

    def state(s):
        contact = {"omega": omega, "zeta": zeta}
        held = reference.contact_state(s, d0=0.0, v0=u, phase=phase, lam=lam, **contact)
        sag = reference.contact_state(s, d0=0.0, v0=0.0, phase=0.0, lam=0.0, **contact)
        return np.array(held) - (1 - weight) * np.array(sag)

    s = brentq(lambda s: state(s)[0], 0.97 * duration, 1.03 * duration, xtol=1e-300, rtol=9e-16)
    d, v = state(s)
    height = d + lam * np.sin(phase + s)
    thrown = v + lam * np.cos(phase + s)
    # High bounce: z′_b T - T²/2 keeps the value that it has on the orbit.
    closed = (float(orbit.bounce_velocity) - flight / 2) * flight

    def gap(t):
        flown = thrown * t - t * t / 2
        return height + flown - lam * np.sin(phase + s + t) if rise else flown - closed

    t = brentq(gap, 0.97 * flight, 1.03 * flight, xtol=1e-300, rtol=9e-16)
    return np.array([phase + s + t, thrown - t - lam * np.cos(phase + s + t)])


@pytest.mark.parametrize(("omega", "n"), [(10.0, 1), (2.0, 2)])
@pytest.mark.parametrize(
    ("orbit_at", "linearised", "weight", "rise"),
    [
        (weightless_orbits, partial(altered_monodromy, weight=0.0), 0, True),
        (orbits_on_branch, partial(altered_monodromy, high_bounce=True), 1, False),
        (orbits_on_branch, altered_monodromy, 1, True),
        (orbits_on_branch, monodromy, 1, True),
    ],
)
def test_orbit_and_monodromy_are_those_of_the_altered_return_map(
    reference, omega, n, orbit_at, linearised, weight, rise
):
    orbit = orbit_at(np.array(-0.05), SpringDamper(omega, ZETA), np.array(n))
    start = np.array([float(orbit.phase), float(orbit.relative_impact_velocity)])

    def once(at):
        return cycle(*at, orbit, reference, weight=weight, rise=rise)

    assert once(start) == pytest.approx(start + np.array([2 * np.pi * n, 0]), abs=1e-10)
    # Central differences: 1e-10 of truncation, 1e-10/1e-5 of rounding.
    steps = 1e-5 * np.eye(2)
    expected = np.stack([once(start + h) - once(start - h) for h in steps], axis=-1) / 2e-5
    assert linearised(orbit) == pytest.approx(expected, abs=5e-5)


def test_the_ends_of_an_unaltered_branch_are_those_of_the_model():
    contact = SpringDamper(np.array([2.0, 10.0, 1e4]), ZETA)
    n = np.full(3, 2)
    branch = explicit_branch(contact)
    found = altered_ends(contact, n, orbits_on_branch, monodromy)
    expected = np.stack([branch.bifurcation(kind, n).amplitude for kind in Bifurcation], -1)
    # At a fold Λ is known to rounding; at the other end ε has the digits of D.
    assert found == pytest.approx(expected, abs=1e-10)


def test_the_stiff_limits_are_holmes_map_and_the_restitution_model(study):
    stiff = study.computed.sel(frequency_ratio=1e4)
    n = study.n.values
    for reading, impact_map in (
        (HIGH_BOUNCE, ImpactMap.HOLMES),
        (WEIGHTLESS, ImpactMap.EXACT),
    ):
        doubling = restitution_branch.restitution_period_doubling(n, 0.85, impact_map)
        found = stiff.sel(reading=reading, bound="period doubling").values
        assert found == pytest.approx(doubling, abs=1e-4)  # of the order 1/ϖ
        nodes = stiff.sel(reading=reading, bound="saddle-node").values
        assert nodes == pytest.approx(restitution_branch.restitution_saddle_node(n, 0.85), abs=1e-4)


def test_each_reading_of_the_damping_has_the_saddle_node_of_its_zeta(study):
    for reading, zeta in (
        ("damping as printed", PRINTED_DAMPING),
        ("damping to first order", -np.log(0.85) / np.pi),
        ("equations as they stand", ZETA),
    ):
        branch = explicit_branch(SpringDamper(10.0, zeta))
        node = branch.bifurcation(Bifurcation.SADDLE_NODE, 3).amplitude
        found = study.computed.sel(reading=reading, frequency_ratio=10, n=3, bound="saddle-node")
        assert float(found) == pytest.approx(float(node), rel=1e-14)


def test_distances_are_those_of_the_differences(study):
    assert study.sizes["reading"] == 9
    difference = (study.computed - study.printed) / 0.001
    np.testing.assert_allclose(study.difference, difference, atol=1e-9)
    soft = difference.sel(frequency_ratio=[10.0, 2.0])
    for rows_name, part in (("all rows", difference), ("compliant rows", soft)):
        flat = part.values.reshape(9, -1)
        at = study.sel(rows=rows_name)
        np.testing.assert_allclose(at.rms_difference, np.sqrt((flat**2).mean(1)))
        np.testing.assert_allclose(at.largest_difference, np.abs(flat).max(1))
        assert at.reproduced.values.tolist() == (np.abs(flat) <= 0.5).sum(1).tolist()
        assert at.entries.item() == flat.shape[1]
    order = study.rms_difference.sel(rows="compliant rows").values
    assert (np.diff(order) > 0).all() and study["rank"].values.tolist() == list(range(1, 10))


def test_the_stable_width_tells_which_stability_was_used(study):
    width = study.stable_width
    np.testing.assert_allclose(width.sel(reading="all rows from Eqs. 7-8"), 1, rtol=1e-12)
    exact = 2 * (1 + 0.85**2) / (1 + 0.85) ** 2
    stiff = width.sel(frequency_ratio=1e4)
    np.testing.assert_allclose(stiff.sel(reading="equations as they stand"), exact, rtol=1e-4)
    np.testing.assert_allclose(stiff.sel(reading=HIGH_BOUNCE), 1, rtol=1e-4)
    # Both ends rounded the worst way, that is to opposite sides.
    ends = study.printed.sel(frequency_ratio=2.0, n=3).values
    worst = np.sqrt((ends[1] + 0.0005) ** 2 - (ends[0] - 0.0005) ** 2)
    change = study.printed_stable_width_rounding.sel(frequency_ratio=2.0, n=3).item()
    assert worst - study.printed_stable_width.sel(frequency_ratio=2.0, n=3).item() == (
        pytest.approx(change, rel=1e-2)
    )


def test_the_force_release_at_equal_r_has_the_damping_of_this_release(study):
    zeta = study.attrs["force_damping_ratio"]
    turned = (np.pi - 2 * np.arcsin(zeta)) / np.sqrt(1 - zeta**2)
    assert np.exp(-zeta * turned) == pytest.approx(0.85, rel=1e-12)
    branch = explicit_branch(SpringDamper(10.0, zeta, Release.FORCE))
    node = branch.bifurcation(Bifurcation.SADDLE_NODE, 3).amplitude
    found = study.computed.sel(reading="force release, equal r", bound="saddle-node")
    assert float(found.sel(frequency_ratio=10, n=3)) == pytest.approx(float(node), rel=1e-12)


def test_digits_cut_off_and_what_no_orbit_reaches(study):
    plain, cut = (study.sel(reading=name) for name in ("equations as they stand", "digits cut off"))
    assert ((plain.computed - cut.computed) >= 0).all()
    assert ((plain.computed - cut.computed) < 0.001).all()
    below = (plain.computed - plain.printed).sel(bound="saddle-node") / 0.001
    assert plain.unreachable.item() == int((below > 0.5).sum()) == 3
    assert cut.unreachable.item() == int((below > 1).sum()) == 1


def test_no_orbit_equations_are_met_better_than_by_the_needed_tolerance(study):
    nodes = study.sel(reading="equations as they stand", bound="saddle-node")
    for ratio, n in ((10.0, 1), (10.0, 3), (2.0, 1)):
        one = nodes.sel(frequency_ratio=ratio, n=n)
        equations = PaperEquations(SpringDamper(ratio, ZETA), n)
        node = explicit_branch(equations.contact).bifurcation(Bifurcation.SADDLE_NODE, n)
        start = equations.point(node)[:-1]

        def residual(unknowns, equations=equations, amplitude=one.printed.item()):
            return equations.residual(np.append(unknowns, amplitude))

        # The least norm near the saddle-node, found without its derivatives. It differs from the
        # linear one by the square of the distance, which is below a hundredth of the Λ there.
        least = least_squares(residual, start, xtol=1e-12, ftol=1e-12, gtol=1e-12)
        assert np.linalg.norm(least.fun) == pytest.approx(one.needed_tolerance.item(), rel=1e-4)
    # Where the printed end lies above the fold, orbits have it.
    assert nodes.needed_tolerance.sel(frequency_ratio=2.0, n=[2, 3]).values.tolist() == [0, 0]
    below = nodes.computed > nodes.printed
    assert ((nodes.needed_tolerance > 0) == below).all()


def test_the_table_has_a_row_for_each_reading(study):
    header, body = rows(study)
    assert len(body) == 9 and {len(line) for line in body} == {len(header)}
    stand = next(line for line in body if line[1] == "equations as they stand")
    assert stand[2:] == ["6.30", "3.34", "5.44", "2.88", "4 of 18", "1 of 12", "3"]

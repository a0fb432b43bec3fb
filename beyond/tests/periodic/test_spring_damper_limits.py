"""Saddle-node, period doubling and orbits at a given Λ."""

import numpy as np
import pytest
from random_contacts import drawn_contacts
from scipy.optimize import minimize_scalar

from bouncing_ball_beyond.inherited.errors import ModelError, NoOrbitError
from bouncing_ball_beyond.inherited.periodic.orbit import Bifurcation, Side
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.damping import LINEAR, Release, damping_ratio
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.periodic.one_impact import n_t
from bouncing_ball_beyond.periodic.one_impact.spring_damper_bifurcations import (
    orbit_at,
    orbits_at,
    period_doubling,
    saddle_node,
)
from bouncing_ball_beyond.periodic.one_impact.spring_damper_branch import (
    branch_point,
    orbits_of_points,
)
from bouncing_ball_beyond.periodic.orbits.stability import is_stable

EPS = np.finfo(float).eps

every_release = pytest.mark.parametrize("release", LINEAR)


@pytest.fixture(scope="module", params=LINEAR)
def drawn(request):
    """Random contacts; n, r and shares for Λ.

    A contact of less restitution is in test_a_branch_without_a_fold_has_a_single_side. Nearly
    elastic contacts are tested below.
    """
    omega, r, n, share = drawn_contacts(400)
    return SpringDamper(omega, damping_ratio(r), request.param), n, r, share


def stability(orbit):
    matrix = orbit.monodromy()
    return np.trace(matrix, axis1=-2, axis2=-1), np.linalg.det(matrix)


def stable(orbit):
    return is_stable(*stability(orbit))


def test_the_saddle_node_is_the_lowest_amplitude(drawn):
    contact, n, r, _ = drawn
    excess = saddle_node(contact, n)
    point = branch_point(excess, contact, n)
    # ½ d(Λ²)/dε is a sum of X dX and Y dY, with X and Y from equations of
    # order one: the 3 × 3 solve leaves some tens of their roundings.
    size = (1 + point.amplitude) * np.hypot(point.d_x, point.d_y)
    assert np.all(np.abs(point.fold) <= 200 * EPS * size)
    # Λ rises to both sides, in steps of the fold's own scale.
    steps = np.array([[-2], [-1], [1], [2]]) * 0.05 / contact.frequency_ratio
    around = branch_point(excess + steps, contact, n).amplitude
    assert np.all(around > point.amplitude)
    assert np.all((around[0] > around[1]) & (around[3] > around[2]))
    # Λ vanishes at the fold of an elastic contact, and the phase is then
    # undefined; else a multiplier is one.
    trace, det = stability(orbits_of_points(point, contact, n)[r < 0.999])
    assert np.all(np.abs(Bifurcation.SADDLE_NODE.test(trace, det)) <= 1e-10)


def test_a_required_orbit_that_does_not_exist_is_refused_with_its_reason(refusal):
    contact = SpringDamper(10.0, float(damping_ratio(0.85)))
    # The saddle-node of the model notes' table, 0.2400.
    with refusal(
        NoOrbitError, "no 1-T orbit at Λ = 0.2 for ϖ = 10", "below the saddle-node at Λ = 0.239988"
    ):
        n_t.require_orbit(ContactModel(contact), 1, 0.2)
    # Without a saddle-node Λ ends at permanent contact, 0.97, on its one side.
    soft = SpringDamper(2.592, float(damping_ratio(0.0893)))
    with refusal(NoOrbitError, "no 1-T orbit at Λ = 0.5 for ϖ = 2.592", "does not reach this Λ"):
        n_t.require_orbit(ContactModel(soft), 1, 0.5)
    with refusal(NoOrbitError, "Λ = 2.5", "no saddle-node and therefore no other side"):
        n_t.require_orbit(ContactModel(soft), 1, 2.5, Side.UNSTABLE)
    # The unstable side of r = 0.85, ϖ = 2 turns at Λ = 1.176.
    with refusal(NoOrbitError, "Λ = 1.3", "does not reach this Λ"):
        n_t.require_orbit(
            ContactModel(SpringDamper(2.0, float(damping_ratio(0.85)))), 1, 1.3, Side.UNSTABLE
        )


@every_release
@pytest.mark.parametrize("n", [1, 2, 3])
def test_the_doubling_of_an_undamped_contact_is_at_half_an_oscillation(n, release):
    """Its middle is at the phase ±π/2 there, so that Λ = |1 - 1/ϖ²|/|cos(π/2ϖ)|. There is none if
    half an oscillation is longer than n periods. If it is as long, all multipliers tend to -1 as
    the flight vanishes, and rounding errors decide on the sign of the test function.
    """
    # At ϖ = 1/3 and 1/5 the doubling is at infinity.
    ratio = np.concatenate([np.linspace(0.17, 0.97, 41), [0.5, 0.25, 1 / 6], [1.3, 3.0, 20.0]])
    contact = SpringDamper(ratio, 0.0, release)
    found = branch_point(period_doubling(contact, n), contact, n).amplitude
    exact = np.abs((1 - 1 / ratio**2) / np.cos(np.pi / (2 * ratio)))
    exact[2 * n * ratio < 1 + EPS * 4] = np.nan
    # The cosine is above 0.05.
    assert found == pytest.approx(exact, rel=100 * EPS, nan_ok=True)


def test_a_branch_without_a_fold_has_a_single_side():
    # Strong damping, compliant contact: Λ falls all the way to permanent contact.
    contact = SpringDamper(2.592, float(damping_ratio(0.0893)))
    assert np.isnan(saddle_node(contact, 1))
    orbit = orbit_at(contact, 1, 2.5)
    assert float(orbit.amplitude) == pytest.approx(2.5, rel=1e-13)
    assert stable(orbit)
    assert not stable(orbit_at(contact, 1, 4.0))


@pytest.mark.parametrize(
    ("n", "r", "omega"), [(3, 0.9999700944704891, 6586.302158952978), (1, 0.99999, np.e)]
)
def test_the_saddle_node_of_a_nearly_elastic_contact_is_next_to_zero_amplitude(n, r, omega):
    # The fold is next to that of the displacement release, Λ → 0 as r → 1; the
    # derivative's roundings at vanishing contacts (Λ → ∞) are no fold.
    contact = SpringDamper(omega, float(damping_ratio(r)), Release.FORCE)
    point = branch_point(saddle_node(contact, n), contact, n)
    assert float(point.amplitude) < 1e-3
    assert abs(float(Bifurcation.SADDLE_NODE.test(point.trace, point.determinant))) < 1e-9


@pytest.mark.parametrize("omega", [0.18, 0.32])
def test_the_unstable_side_of_a_very_compliant_contact_has_an_orbit_or_none(omega):
    # None or an orbit, and no numerical warning on the way.
    contact = SpringDamper(omega, float(damping_ratio(0.6)))
    orbit = orbit_at(contact, 1, 40.0, Side.UNSTABLE)
    assert np.isnan(orbit.contact_duration) or 0 < float(orbit.contact_duration) < 2 * np.pi


@pytest.mark.parametrize(
    ("n", "omega", "zeta", "release"),
    [
        (1, 2.0, 0.05, Release.FORCE),
        (2, 2.0, 0.05, Release.DISPLACEMENT),
        (1, 10.0, 0.2, Release.DISPLACEMENT),
        (1, 10.0, 0.2, Release.FORCE),
    ],
)
def test_just_above_the_fold_there_are_two_orbits_and_just_below_none(n, omega, zeta, release):
    # The bracket between the last point of the scan and the fold is one of D's last digits.
    model = ContactModel(SpringDamper(omega, zeta, release))
    fold = float(n_t.saddle_node(model, n).amplitude)
    for excess in (1e-6, 1e-10):
        stable, unstable = (n_t.orbit(model, n, fold * (1 + excess), side) for side in Side)
        assert stable.contact_duration < n_t.saddle_node(model, n).contact_duration
        assert stable.exists and unstable.contact_duration > stable.contact_duration
        assert n_t.orbits(model, n, fold * (1 + excess)).size >= 2
    below = n_t.orbit(model, n, fold * (1 - 1e-10))
    assert not below.exists


def test_the_first_orbit_just_below_the_turn_of_the_unstable_side_is_found():
    # Two orbits next to the top of Λ, between two points of any grid; above it there is none.
    contact = SpringDamper(2.0, float(damping_ratio(0.85)))
    turn = minimize_scalar(
        lambda excess: -float(branch_point(excess, contact, 1).amplitude),
        bounds=(2.5, 3.5),
        method="bounded",
        options={"xatol": 1e-9},
    )
    below, above = orbit_at(contact, 1, -turn.fun * (1 + np.array([-1e-9, 1e-9])), Side.UNSTABLE)
    assert not above.exists
    # On the fold's side of the turn, by a root of 1e-9 times a number of order one.
    excess = below.contact_duration * contact.damped_frequency - contact.free_angle
    assert -1e-3 < excess - turn.x < 0


def test_all_orbits_at_an_amplitude_approach_the_table_and_leave_it():
    # Far up, half of the points of the branch have balls that rise at impact, or fall at release.
    found = n_t.orbits(ContactModel(SpringDamper(3.3, 0.1)), 1, 4.0)
    assert found.size == 2
    assert np.all(found.relative_impact_velocity < 0) and np.all(found.apparent_restitution > 0)


@pytest.mark.parametrize("ratio", [1e-8, 1e-5, 1e-4, 4.9e-4])
@pytest.mark.parametrize("amplitude", [1e-3, 1.0, 1e8])
@every_release
def test_a_contact_that_is_too_soft_for_n_periods_has_no_orbits(ratio, amplitude, release):
    # Even a contact that fills the period is shorter than a thousandth of the free duration.
    assert orbits_at(SpringDamper(ratio, 0.05, release), 1, amplitude).size == 0


@every_release
def test_the_softest_contact_with_an_orbit_is_stiffer_than_the_bound(release):
    # Of contacts with ϖ up to 0.3, those have orbits up to Λ whose branch comes down to it.
    for ratio in (0.02, 0.1, 0.3):
        contact = SpringDamper(ratio, 0.05, release)
        angle = contact.free_angle + np.linspace(-contact.free_angle * 0.999, 0, 2001)[:-1]
        cycle = angle[angle < 2 * np.pi * contact.damped_frequency]
        amplitude = branch_point(cycle - contact.free_angle, contact, 1).amplitude
        theta = 2 * np.pi * ratio
        assert np.nanmin(amplitude) > 1 / (theta * (theta + 0.1)) - 2


def test_the_search_on_a_very_soft_contact_ends_at_once():
    # θ (θ + 2ζ) (2 + Λ) < 1 for θ = 2πnϖ; the scan took 20 s here.
    assert orbits_at(SpringDamper(5.3e-7, 3e-13), 1000, 1.0).size == 0


def test_contacts_beyond_the_searched_angles_are_never_found():
    # The angle beyond half an oscillation is searched in steps of 0.02, up to 200000 of them.
    contact = SpringDamper(781.3162393999957, 0.13815983841837418)
    orbits = orbits_at(contact, 2, 1.2720391140979281)
    angle = orbits.contact_duration * contact.damped_frequency
    assert np.max(angle, initial=0.0) < 2e5 * 0.02 + np.pi


def test_a_side_may_be_given_by_its_name(refusal):
    contact = SpringDamper(10.0, 0.05)
    for side in Side:
        by_name = orbit_at(contact, 1, 0.9, str(side))
        assert by_name.phase == orbit_at(contact, 1, 0.9, side).phase
    with refusal(ModelError, "unknown side 'upper'"):
        orbit_at(contact, 1, 0.9, "upper")

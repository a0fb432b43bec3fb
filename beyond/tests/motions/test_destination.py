"""Motions on which balls end, against orbits, multipliers and motions side by side."""

import inspect
from functools import cache
from itertools import pairwise

import numpy as np
import pytest

import bouncing_ball_beyond
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.corrected.model import CorrectedModel
from bouncing_ball_beyond.models.rigid import RestitutionModel
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.motions.basins import basins
from bouncing_ball_beyond.motions.destination import IMPACTS, final_motions
from bouncing_ball_beyond.motions.motions import Kind, Reason
from bouncing_ball_beyond.motions.orbit_of_motion import of_motion
from bouncing_ball_beyond.periodic.one_impact import n_t

PHASES = np.linspace(-3, 3, 7)


def contact(r, ratio, release="displacement"):
    return SpringDamper.from_restitution(r, ratio, release)


def beside(model, n, amplitude, moved=1e-3):
    """A start beside the n-T orbit."""
    orbit = n_t.orbit(model, n, amplitude)
    phase = orbit.phase + moved
    return phase, amplitude * np.cos(phase) + orbit.relative_impact_velocity


@pytest.mark.parametrize(
    ("model", "amplitude", "periods"),
    [
        (RestitutionModel(0.6), 3.0, 13),
        (ContactModel(contact(0.6, 80.0)), 3.0, 8),
        pytest.param(ContactModel(contact(0.6, 320.0)), 3.0, 43, marks=pytest.mark.long),
        (ContactModel(contact(0.6, 1280.0)), 3.0, 23),
        pytest.param(CorrectedModel.of_contact(contact(0.6, 80.0)), 3.0, 8, marks=pytest.mark.long),
        (RestitutionModel(0.5), 2.5, 6),
        pytest.param(ContactModel(contact(0.5, 1280.0)), 2.5, 6, marks=pytest.mark.long),
        (CorrectedModel.of_contact(contact(0.5, 80.0)), 2.5, 15),
    ],
)
def test_balls_that_stick_repeat_as_another_simulation_saw_it(model, amplitude, periods):
    # The time between stickings, measured with other code before this was written.
    found = final_motions(model, amplitude, PHASES, -9.0, impacts=600)
    locks = found.kind == Kind.LOCKED
    # A ball may be on a chaotic band of flights of two periods instead.
    assert locks.sum() >= 6
    assert set(found.kind) <= {Kind.LOCKED, Kind.CHAOTIC}
    assert set(found.periods[locks]) == {periods}


@pytest.mark.parametrize("r", [0.5, 0.85])
def test_the_first_doublings_have_the_amplitudes_and_periods_of_the_cascade(r):
    # Where the orbits of period 1, 2, 4 and 8 lose stability, by finite differences of the map.
    ends = {
        0.5: [1.526824, 1.667131, 1.696781, 1.703181],
        0.85: [1.038304, 1.199733],
    }[r]
    amplitude = np.array([ends[0] - 0.05, *(0.4 * a + 0.6 * b for a, b in pairwise(ends))])
    found = final_motions(
        RestitutionModel(r), amplitude, *beside(RestitutionModel(r), 1, amplitude), impacts=20_000
    )
    assert found.kind.tolist() == [Kind.ORBIT, *[Kind.SUBHARMONIC] * (len(ends) - 1)]
    assert found.periods.tolist() == found.impacts.tolist() == [1, 2, 4, 8][: len(ends)]


@pytest.mark.parametrize(
    "model",
    [
        RestitutionModel(0.6),
        ContactModel(contact(0.6, 20.0)),
        ContactModel(contact(0.6, 20.0, "force")),
        CorrectedModel.of_contact(contact(0.6, 20.0)),
    ],
)
def test_the_exponent_of_an_orbit_is_that_of_its_multiplier(model):
    amplitude = np.array([0.8, 0.9, 1.0, 1.6])
    n = np.array([1, 1, 1, 2])
    found = final_motions(model, amplitude, *beside(model, n, amplitude))
    assert set(found.kind) == {Kind.ORBIT}
    assert found.periods.tolist() == n.tolist()
    assert set(found.impacts) == {1}
    modulus = np.abs(n_t.orbit(model, n, amplitude).multipliers()).max(axis=-1)
    # At a state that is within 10⁻⁶ of the orbit.
    np.testing.assert_allclose(found.exponent, np.log(modulus) / n, atol=1e-5)


def test_an_answer_does_not_depend_on_the_other_balls():
    rng = np.random.default_rng(2)
    amplitude = rng.uniform(0.5, 4, 60)
    phase = rng.uniform(-3, 3, 60)
    model = ContactModel(contact(rng.uniform(0.2, 0.9, 60), 100.0))
    start = amplitude, phase, -amplitude - 3
    whole = final_motions(model, *start, impacts=150)
    order = rng.permutation(60)
    again = final_motions(model[order], *(x[order] for x in start), impacts=150)
    for name, values in vars(whole).items():
        np.testing.assert_array_equal(getattr(again, name), values[order], err_msg=name)


@pytest.mark.parametrize(
    "law",
    [
        RestitutionModel(0.5),
        ContactModel(contact(0.5, 30.0)),
        CorrectedModel.of_contact(contact(0.5, 30.0)),
    ],
)
def test_a_ball_on_a_slow_table_comes_to_rest(law):
    found = final_motions(law, [0.0, 0.5], 0.3, -3.0)
    assert set(found.kind) == {Kind.PERMANENT_CONTACT}
    assert found.periods.tolist() == [1, 1]


def test_without_dissipation_nothing_is_attracted():
    found = final_motions(RestitutionModel(1.0), [0.0, 0.01, 6.0], 0.3, -7.0, impacts=500)
    assert found.kind.tolist() == [Kind.UNDECIDED, Kind.UNDECIDED, Kind.CHAOTIC]


def test_next_to_a_bifurcation_nothing_is_decided():
    # A multiplier is -1 but for 10⁻⁶ there.
    found = final_motions(
        RestitutionModel(0.5),
        1.526824,
        *beside(RestitutionModel(0.5), 1, 1.526824, 1e-8),
        impacts=500,
    )
    assert (found.kind, found.reason) == (Kind.UNDECIDED, Reason.MARGINAL)


def test_a_ball_that_sticks_twice_is_locked_though_rounding_decides_when():
    # With 250 digits this ball sticks 311 impacts after its lift-off. Here a deviation grows by e²⁰
    # and more between two stickings.
    found = final_motions(RestitutionModel(0.4), 2.1, 2.0, -1.5)
    assert (found.kind, found.reason) == (Kind.LOCKED, Reason.ROUNDING)
    assert (found.periods, found.impacts, found.exponent) == (0, 0, -np.inf)
    assert found.digits_lost > 50 and found.followed < 1000
    assert found.is_unresolved()
    # A ball that starts from the end is at once on the locked motion: it sticks after this impact.
    again = final_motions(RestitutionModel(0.4), 2.1, found.end_phase, found.end_velocity)
    assert (again.kind, again.periods) == (Kind.LOCKED, 0)
    path = RestitutionModel(0.4).simulate(2.1, found.end_phase, found.end_velocity, 2)
    assert path.contact_duration[0] > 0
    # A lap that a double resolves has its period.
    resolved = final_motions(RestitutionModel(0.6), 3.0, 2.0, -1.5)
    assert (resolved.kind, resolved.periods, resolved.reason) == (Kind.LOCKED, 13, Reason.NONE)


def test_a_stiff_contact_that_sticks_again_and_again_has_no_positive_exponent():
    # Sticking shrinks a deviation by e^(-ζϖD), which is more than all laps let it grow.
    lam = 2.1
    phase = np.linspace(-3, 3, 8)
    contacts = ContactModel(contact(0.4, [[1e4], [10.0]]))
    stiff, compliant = final_motions(contacts, lam, phase, -9.0, impacts=600)
    assert stiff.is_unresolved().sum() >= 6
    assert np.all(stiff.exponent[stiff.is_unresolved()] < 0)
    assert not np.any(stiff.kind == Kind.CHAOTIC)
    # On the compliant one a deviation survives the sticking, and the motion repeats as others do.
    assert not compliant.is_unresolved().any()


def test_a_chaotic_motion_says_for_how_long_it_was_followed():
    few, many = (
        final_motions(RestitutionModel(0.85), 2.0, 0.3, -9.0, impacts=impacts)
        for impacts in (300, 700)
    )
    assert few.kind == many.kind == Kind.CHAOTIC
    assert (few.followed, many.followed) == (300, 700)
    # The error of the mean of independent sections falls with their number.
    assert few.exponent_error > many.exponent_error


@pytest.mark.parametrize(
    "law",
    [
        RestitutionModel(0.85),
        ContactModel(contact(0.85, 80.0)),
        pytest.param(CorrectedModel.of_contact(contact(0.85, 80.0)), marks=pytest.mark.long),
    ],
)
def test_chaos_has_the_exponent_of_the_paths_side_by_side(law):
    """Two balls, the distance set back after every impact, by the Poincaré map alone."""
    lam, tiny, balls = 2.0, 1e-7, 400
    rng = np.random.default_rng(7)
    state = np.array([rng.uniform(-3, 3, balls), -rng.uniform(3, 9, balls)])
    moved = state + np.array([[tiny], [0]])
    grown = np.zeros(balls)
    time = np.zeros(balls)
    for k in range(50):
        both = law.dynamics(lam).next_impact(*np.array([state, moved]).swapaxes(0, 1))
        state, there = np.array(both[:2]).swapaxes(0, 1)
        shift = there - state
        shift[0] -= 2 * np.pi * np.rint(shift[0] / (2 * np.pi))
        # One that sticks meets its neighbour, and is left out from then on.
        apart = shift.any(axis=0)
        distance = np.hypot(*shift[:, apart])
        state = state[:, apart]
        moved = state + shift[:, apart] * tiny / distance
        late = k >= 10
        grown = grown[apart] + late * np.log(distance / tiny)
        time = time[apart] + late * both.time[0, apart]
    assert grown.size > 0.9 * balls
    rates = 2 * np.pi * grown / time
    found = final_motions(law, lam, np.linspace(-3, 3, 28), -9.0, impacts=500)
    # A ball that has stuck once has an exponent of its few impacts since then only.
    chaotic = found.kind == Kind.CHAOTIC
    assert chaotic.sum() >= 26 and set(found.kind) <= {Kind.CHAOTIC, Kind.UNDECIDED}
    exponent = found.exponent[chaotic]
    of_one = np.mean(found.exponent_error[chaotic])
    error = np.hypot(np.std(rates) / np.sqrt(rates.size), of_one / np.sqrt(exponent.size))
    assert abs(np.mean(exponent) - 2 * np.pi * grown.sum() / time.sum()) < 5 * error
    # And its error is that by which the balls differ.
    assert 0.4 < np.std(exponent, ddof=1) / of_one < 2


def test_the_last_digit_of_the_start_decides_only_where_the_others_are_lost():
    rng = np.random.default_rng(0)
    r, amplitude, phase = rng.uniform([[0.3], [1.0], [-3]], [[0.95], [5], [3]], (3, 300))
    velocity = amplitude * np.cos(phase) - amplitude * rng.uniform(0, 4, 300)
    found = final_motions(
        RestitutionModel(r), [amplitude, np.nextafter(amplitude, 9)], phase, velocity, impacts=500
    )
    another = (found.kind[0] != found.kind[1]) | (found.impacts[0] != found.impacts[1])
    # An error of 2⁻⁵² that has grown by 10¹² is 2·10⁻⁴; no boundary of this sample is that near.
    kept = found.digits_lost[0] < 12
    assert kept.sum() > 50 and another.any() and not another[kept].any()


def test_all_calls_that_judge_a_motion_have_one_default():
    defaults = {
        inspect.signature(call).parameters["impacts"].default
        for call in (
            bouncing_ball_beyond.motion_of,
            bouncing_ball_beyond.lyapunov_exponent,
            bouncing_ball_beyond.orbit_diagram,
            bouncing_ball_beyond.basins,
            bouncing_ball_beyond.orbit_of_motion,
            of_motion,
            basins,
            final_motions,
        )
    }
    assert defaults == {IMPACTS}


def test_the_error_of_an_exponent_is_told_by_motions_that_have_settled():
    """A nearly elastic ball gains speed for hundreds of impacts: areas contract by e in 25."""
    both = bouncing_ball_beyond.rigid(restitution=[0.98, 0.9])
    found = {
        k: bouncing_ball_beyond.motion_of(both, amplitude=2.0, velocity=-8.0, impacts=k)
        for k in (500, 600, 1000)
    }
    short, some, long = (each.sel(restitution=0.98) for each in found.values())
    assert short.kind.item() == some.kind.item() == long.kind.item() == "chaotic"
    assert np.isnan(short.lyapunov_error) and np.isnan(some.lyapunov_error)
    # The mean of 8000 balls after 1000 impacts, whose standard error is 0.0002.
    assert abs(float(long.lyapunov_exponent) - 0.1900) < 2 * float(long.lyapunov_error) < 0.19
    # An exponent that is settled has its standard error only, which falls as the root.
    some, _, more = (each.sel(restitution=0.9) for each in found.values())
    assert some.kind.item() == more.kind.item() == "chaotic"
    assert 1.0 < float(some.lyapunov_error / more.lyapunov_error) < 2.4


@cache
def exponents_of_forty_balls():
    """Of both restitutions at once, which takes little longer than of one."""
    phases = np.random.default_rng(7).uniform(-3, 3, 40)
    return bouncing_ball_beyond.motion_of(
        bouncing_ball_beyond.rigid(restitution=[0.9, 0.98, 0.99]),
        amplitude=2.0, phase=phases, velocity=-3.0, impacts=2000,
    )  # fmt: skip


@pytest.mark.parametrize("restitution", [0.9, 0.98, 0.99])
def test_intervals_of_exponents_contain_their_common_value(restitution):
    """Forty balls of one chaotic motion; at r = 0.99 the speed changes over a hundred impacts, so
    that one section does not tell the next one, and twice the standard error of independent
    sections has the value for 70 % of the balls only."""
    found = exponents_of_forty_balls().sel(restitution=restitution)
    chaotic = found.isel(phase=found.kind.values == "chaotic")
    assert chaotic.sizes["phase"] > 30
    exponent = chaotic.lyapunov_exponent
    outside = np.abs(exponent - exponent.mean()) > 2 * chaotic.lyapunov_error
    # Of 40 intervals of 95 % more than 6 miss the value with a probability of 0.3 %.
    assert outside.sum() <= 6


def test_a_verdict_says_how_long_the_ball_was_followed():
    ball = bouncing_ball_beyond.rigid(restitution=0.8)
    found = bouncing_ball_beyond.motion_of(ball, amplitude=[0.3, 0.6, 3.0], impacts=200)
    for kind, followed, verdict in zip(found.kind, found.followed, found.in_words, strict=True):
        assert verdict.item().startswith(kind.item())
        assert f"{followed.item()} impacts" in verdict.item()
    assert "more may show a long transient" in found.in_words.values[2]


def test_chaos_on_a_contact_may_stick_again_and_again_but_not_after_an_instant():
    """A contact that lasts long shrinks deviations by a finite factor, an instant forgets."""
    lam = np.linspace(2.8, 4.0, 15)
    stiff = final_motions(ContactModel(contact(0.7, 100.0)), lam, 1.0, -5.0, impacts=600)
    assert (stiff.times_stuck[stiff.kind == "chaotic"] > 2).any()
    rigid = final_motions(RestitutionModel(0.7), lam, 1.0, -5.0, impacts=600)
    assert (rigid.times_stuck[rigid.kind == "locked"] == 2).all()
    assert rigid.times_stuck[rigid.kind == "chaotic"].max() <= 1
    stuck = rigid.times_stuck > 0
    assert np.isfinite(rigid.first_lift_off[stuck]).all()
    assert np.isnan(rigid.first_lift_off[~stuck]).all()
    assert (rigid.first_lift_off[stuck] <= rigid.followed_time[stuck]).any()

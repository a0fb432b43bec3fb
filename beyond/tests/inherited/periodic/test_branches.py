"""Branches as datasets, and the public calls of orbits."""

import numpy as np
import pytest

import bouncing_ball_beyond.inherited
from bouncing_ball_beyond.inherited import branch, limits, orbit, orbits, rigid, spring_damper
from bouncing_ball_beyond.inherited.errors import ModelError, NoOrbitError
from bouncing_ball_beyond.inherited.periodic.branches import restitution_dataset
from bouncing_ball_beyond.inherited.periodic.explicit import explicit_branch
from bouncing_ball_beyond.inherited.periodic.orbit import Bifurcation, trace_and_determinant
from bouncing_ball_beyond.inherited.periodic.restitution_branch import RestitutionBranch


def test_a_branch_of_the_restitution_model_is_that_of_its_formula():
    found = branch(rigid(restitution=0.85), amplitude_max=3.0, points=61)
    lam, phase = found.amplitude.values, found.phase.values
    assert lam * np.cos(phase) == pytest.approx(np.full(61, np.pi * 0.15 / 1.85), abs=1e-12)
    assert lam[[0, -1]] == pytest.approx([3.0, 3.0], abs=1e-12)
    steps = np.hypot(np.diff(phase), np.diff(lam))
    assert steps == pytest.approx(np.full(60, steps.mean()), rel=0.01)
    assert found.residual.max() < 1e-13
    product = found.multiplier_real.prod("multiplier") - found.multiplier_imag.prod("multiplier")
    assert product.values == pytest.approx(np.full(61, 0.85**2), abs=1e-12)
    kinds = found.special_kind.values.tolist()
    assert kinds == ["grazing of a flight", "saddle-node", "period doubling"]
    # Admissible from the grazing flight on, and stable between the bifurcations.
    grazing, fold, doubling = found.special_phase.values
    assert np.array_equal(found.admissible.values, phase > grazing)
    assert np.array_equal(found.stable.values, (phase > fold) & (phase < doubling))
    arc = np.linspace(0, 1, 61)
    assert np.interp(found.special_arclength, arc, phase) == pytest.approx(
        found.special_phase.values, abs=1e-3
    )


@pytest.mark.parametrize("release", ["displacement", "force"])
def test_a_branch_of_a_contact_has_the_places_of_its_special_orbits(release):
    ball = spring_damper(restitution=0.85, frequency_ratio=10.0, release=release)
    found = branch(ball, amplitude_max=3.0, points=101)
    assert float(found.residual.max()) < 1e-11
    for kind, name in zip(Bifurcation, ("saddle-node", "period doubling"), strict=True):
        at = found.special_kind.values.tolist().index(name)
        expected = explicit_branch(ball).bifurcation(kind, 1)
        place = found.isel(special=at)
        assert float(place.special_amplitude) == pytest.approx(float(expected.amplitude), abs=1e-11)
        assert abs(float(kind.test(*trace_and_determinant(expected)))) < 1e-11
    assert found.stable.values.any() and not found.stable.values[[0, -1]].any()
    assert not found.admissible.values[0] and found.admissible.values[-1]


def test_branches_of_an_array_of_balls_are_those_of_each_alone():
    balls = spring_damper(restitution=0.85, frequency_ratio=[5.0, 20.0])
    many = branch(balls, n=[1, 2], amplitude_max=1.4, points=11)
    assert dict(many.sizes)["frequency_ratio"] == 2 and dict(many.sizes)["n"] == 2
    one = branch(
        spring_damper(restitution=0.85, frequency_ratio=20.0), 2, amplitude_max=1.4, points=11
    )
    here = many.sel(frequency_ratio=20.0, n=2)
    assert here.amplitude.values == pytest.approx(one.amplitude.values, abs=1e-9)
    assert (
        here.special_kind.values[: one.sizes["special"]].tolist()
        == one.special_kind.values.tolist()
    )


def test_of_several_branches_one_may_not_exist(refusal):
    found = branch(rigid(restitution=[0.3, 0.85]), amplitude_max=1.2, points=11)
    none = found.sel(restitution=0.3)
    assert np.isnan(none.amplitude).all() and not none.stable.any()
    assert "below the saddle-node" in str(none.end_reason.values[0])
    assert np.isfinite(found.sel(restitution=0.85).amplitude).all()
    with refusal(NoOrbitError, "below the saddle-node at Λ = 1.69163"):
        branch(rigid(restitution=0.3), amplitude_max=1.2)
    with refusal(NoOrbitError, "no 1-T orbit up to Λ = 0.2", "the branch begins at Λ = 0.239988"):
        branch(spring_damper(restitution=0.85, frequency_ratio=10.0), amplitude_max=0.2)


def test_without_a_largest_amplitude_a_branch_ends_beyond_its_period_doubling():
    for ball in (rigid(restitution=0.6), spring_damper(restitution=0.6, frequency_ratio=30.0)):
        doubling = float(limits(ball).period_doubling.amplitude)
        assert float(branch(ball, points=11).amplitude[-1]) == pytest.approx(
            1.4 * doubling, rel=1e-9
        )


def test_an_elastic_branch_passes_the_amplitude_zero():
    found = restitution_dataset(rigid(restitution=1.0), 1, 1.5, 31)
    assert float(found.amplitude.min()) == pytest.approx(0.0, abs=1e-3)
    assert not found.stable.any()
    assert found.special_amplitude.values[-2:] == pytest.approx([0.0, 1.0], abs=1e-12)


def test_orbits_at_an_amplitude_are_labelled_by_their_arguments():
    balls = spring_damper(restitution=0.85, frequency_ratio=[5.0, 20.0])
    found = orbit(balls, amplitude=[0.1, 0.9, 1.0], side="unstable")
    assert dict(found.sizes) == {"amplitude": 3, "frequency_ratio": 2}
    one = orbit(
        spring_damper(restitution=0.85, frequency_ratio=20.0), amplitude=0.9, side="unstable"
    )
    here = found.sel(amplitude=0.9, frequency_ratio=20.0)
    for name in ("phase", "max_height", "apparent_restitution", "stable", "admissible"):
        assert here[name].item() == getattr(one, name)
    assert np.isnan(found.phase.sel(amplitude=0.1)).all()
    both = limits(balls)
    for kind in Bifurcation:
        name = f"{kind.name.lower()}_amplitude"
        alone = explicit_branch(balls[1]).bifurcation(kind, 1).amplitude
        assert float(both[name].sel(frequency_ratio=20.0)) == float(alone)


def test_all_orbits_of_one_ball_come_in_order_of_contact_duration(refusal):
    soft = spring_damper(restitution=0.85, frequency_ratio=2.0)
    found = orbits(soft, amplitude=0.9)
    durations = [float(each.contact_duration) for each in found]
    assert durations == sorted(durations) and len(durations) == 3
    assert [each.phase > 0 for each in orbits(rigid(restitution=0.85), amplitude=1.0)] == [
        True,
        False,
    ]
    with refusal(NoOrbitError, "no 1-T orbit at Λ = 0.01"):
        orbits(soft, amplitude=0.01)
    with refusal(ModelError, "must be a single number"):
        orbits(rigid(restitution=[0.5, 0.6]), amplitude=1.0)


def test_what_is_wrong_is_said_in_one_line(refusal):
    ball = rigid(restitution=0.85)
    for call, part in (
        (lambda: orbit(ball, amplitude="x"), "amplitude"),
        (lambda: orbit(ball, 0, amplitude=1.0), "n"),
        (lambda: orbit(ball, amplitude=1.0, side="upper"), "side"),
        (lambda: orbit(3, amplitude=1.0), "is not a ball"),
        (lambda: limits("x"), "is not a ball"),
        (lambda: branch(ball, points=1), "points"),
    ):
        with refusal(ModelError, part):
            call()
    with refusal(NoOrbitError, "below the saddle-node at Λ = 0.254724"):
        orbit(ball, amplitude=0.1)


def test_the_limits_of_the_restitution_model_are_those_of_its_branch():
    ball = rigid(restitution=0.7)
    found = bouncing_ball_beyond.inherited.limits(ball, 2)
    branch_of = RestitutionBranch(ball)
    for one, kind in zip(found, Bifurcation, strict=True):
        assert one.amplitude == branch_of.bifurcation(kind, 2).amplitude
    assert "saddle-node: Orbit" in repr(found) and "period doubling: Orbit" in repr(found)

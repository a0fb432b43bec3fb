"""Figures 7 and 12: orbits over time."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from bouncing_ball.errors import NoOrbitError
from bouncing_ball.models.damping import damping_ratio
from bouncing_ball.models.spring_damper import SpringDamper
from bouncing_ball.paper.exhibits.time_histories import both_histories, contact_history
from bouncing_ball.periodic.explicit import explicit_branch
from bouncing_ball.periodic.orbit import path
from bouncing_ball.pipeline.job import typed

# As the configuration gives them.
both_histories = typed(both_histories)
contact_history = typed(contact_history)

ONE = {"n": 1, "restitution": 0.85, "amplitude": 1.0, "frequency_ratio": 4.0, "samples": 101}
BOTH = {
    "n": 1,
    "restitution": 0.65,
    "amplitude": 1.0,
    "frequency_ratio": [2.0, 20.0],
    "samples": 60,
}


@pytest.mark.parametrize("release", ["displacement", "force"])
@pytest.mark.parametrize("n", [1, 2])
def test_one_cycle_against_an_integration(described, n, release):
    data = described(contact_history(ONE | {"n": n}, release))
    assert data.ball.dims == ("time",) and data.sizes["time"] == 101
    touching = data.contact.values
    assert touching.sum() == 50 and np.all(np.diff(touching.astype(int)) <= 0)
    assert np.all(np.diff(data.time) > 0)
    assert float(data.time[49]) == float(data.contact_duration)
    assert float(data.time[-1]) == pytest.approx(2 * np.pi * n, rel=1e-15)
    phase = float(data.phase)
    zeta = float(damping_ratio(0.85))
    omega = 4.0

    def field(t, y):
        w = np.sin(t + phase)
        wdot = np.cos(t + phase)
        force = -2 * zeta * omega * (y[1] - wdot) - omega**2 * (y[0] - w)
        return [y[1], -1 + force * (t <= float(data.contact_duration))]

    # In two parts, so that no step runs over the release.
    start = [np.sin(phase), float(data.impact_velocity)]
    states = []
    for part, begin in ((touching, 0.0), (~touching, float(data.contact_duration))):
        times = data.time.values[part]
        run = solve_ivp(
            field if part[0] else lambda t, y: [y[1], -1.0],
            [begin, times[-1]],
            start,
            method="DOP853",
            t_eval=times,
            rtol=1e-13,
            atol=1e-14,
        )
        states.append(run.y)
        start = run.y[:, -1]
    ball, velocity = np.concatenate(states, axis=1)
    # The integrator's tolerance over some hundred steps.
    assert data.ball.values == pytest.approx(ball, abs=1e-10)
    assert data.ball_velocity.values == pytest.approx(velocity, abs=1e-10)
    # It closes, and the scalars are those of the curves.
    assert ball[-1] == pytest.approx(ball[0], abs=1e-10)
    assert velocity[-1] == pytest.approx(velocity[0], abs=1e-10)
    # The last sample of the contact has the velocity of the closed form of the contact.
    assert float(data.bounce_velocity) == pytest.approx(float(data.ball_velocity[49]), abs=1e-13)
    assert data.table.values == pytest.approx(np.sin(data.time.values + phase), abs=1e-15)


@pytest.mark.parametrize(("n", "lam"), [(1, 1.0), (2, 1.5)])
def test_the_histories_of_fig_12_are_those_of_the_orbits_of_both_models(described, n, lam):
    parameters = BOTH | {"n": n, "amplitude": lam}
    data = described(both_histories(parameters, "displacement"))
    # Equal steps, the two ends of each contact, and the impact of the restitution model.
    assert data.ball.dims == ("frequency_ratio", "table_phase") and data.ball.shape == (2, 65)
    turns = 2 * np.pi * n
    phase = data.table_phase.values
    assert np.all(np.diff(phase) > 0) and phase[0] == 0
    assert phase[-1] == pytest.approx(turns, rel=1e-15)
    assert data.table.values == pytest.approx(lam * np.sin(phase), abs=1e-15)
    for ratio in BOTH["frequency_ratio"]:
        row = data.sel(frequency_ratio=ratio)
        # One cycle of the orbit, as in Fig. 7, from the start of its contact.
        model = SpringDamper.from_restitution(parameters["restitution"], ratio)
        orbit = explicit_branch(model).orbit(n, lam)
        touching = row.contact.values
        ends = np.mod([orbit.phase, orbit.phase + orbit.contact_duration], turns)
        assert set(ends) <= set(phase[touching])
        gap = row.ball.values - lam * np.sin(phase)
        assert np.all(gap[touching] <= 1e-13) and np.all(gap[~touching] > 0)
        single = contact_history(parameters | {"frequency_ratio": ratio}, "displacement")
        height, _ = path(orbit, single.time.values)
        assert single.ball.values == pytest.approx(height, abs=1e-13)
        # A plot of all curves over their coordinate is right: the ball flies freely.
        s = np.mod(phase - ends[1], turns)[~touching]
        free = lam * np.sin(ends[1]) + orbit.bounce_velocity * s - s**2 / 2
        assert row.ball.values[~touching] == pytest.approx(free, abs=1e-12)
    # The restitution orbit, by hand: one whole flight, both ends on the table.
    start = float(data.restitution_phase)
    s = np.mod(phase - start, turns)
    flight = lam * np.sin(start) + n * np.pi * s - s**2 / 2
    assert data.restitution_ball.values == pytest.approx(flight, abs=1e-12)
    assert lam * np.cos(start) == pytest.approx(n * np.pi * 0.35 / 1.65, rel=1e-14)
    # The stiffer contact is nearer to it.
    tops = data.ball.max("table_phase").values
    assert tops[0] < tops[1] < flight.max()


def test_no_motion_is_no_history(refusal):
    soft = {"n": 2, "restitution": 0.3, "amplitude": 50.0, "frequency_ratio": 0.8}
    with refusal(NoOrbitError, "is inadmissible: an earlier impact"):
        contact_history(ONE | soft, "displacement")

"""Figures 7 and 12: orbits over time."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from bouncing_ball.errors import NoOrbitError
from bouncing_ball.models.damping import damping_ratio
from bouncing_ball.paper.exhibits.time_histories import both_histories, contact_history
from bouncing_ball.pipeline.configuration import typed

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
    assert data.ball.dims == ("sample",) and data.sizes["sample"] == 101
    touching = data.contact.values
    assert touching.sum() == 50 and np.all(np.diff(touching.astype(int)) <= 0)
    assert float(data.time[49]) == float(data.time[50]) == float(data.contact_duration)
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
    for part in (touching, ~touching):
        times = data.time.values[part]
        run = solve_ivp(
            field if part[0] else lambda t, y: [y[1], -1.0],
            times[[0, -1]],
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
    assert float(data.bounce_velocity) == float(data.ball_velocity[50])
    assert data.table.values == pytest.approx(np.sin(data.time.values + phase), abs=1e-15)


@pytest.mark.parametrize(("n", "lam"), [(1, 1.0), (2, 1.5)])
def test_the_histories_of_fig_12_are_those_of_the_orbits_of_both_models(described, n, lam):
    parameters = BOTH | {"n": n, "amplitude": lam}
    data = described(both_histories(parameters, "displacement"))
    assert data.ball.dims == ("frequency_ratio", "sample") and data.ball.shape == (2, 60)
    for ratio in BOTH["frequency_ratio"]:
        row = data.sel(frequency_ratio=ratio)
        single = contact_history(parameters | {"frequency_ratio": ratio}, "displacement")
        assert np.array_equal(row.ball, single.ball)
        assert np.array_equal(row.contact, single.contact)
        assert np.array_equal(row.table_phase, single.time + single.phase)
    # The restitution orbit, by hand: one whole flight, both ends on the table.
    phase = float(data.restitution_phase)
    s = data.time.values
    assert s[-1] == pytest.approx(2 * np.pi * n, rel=1e-15)
    flight = lam * np.sin(phase) + n * np.pi * s - s**2 / 2
    assert data.restitution_ball.values == pytest.approx(flight, abs=1e-12)
    assert lam * np.cos(phase) == pytest.approx(n * np.pi * 0.35 / 1.65, rel=1e-14)
    # The stiffer contact is nearer to it.
    tops = data.ball.max("sample").values
    assert tops[0] < tops[1] < flight.max()


def test_no_motion_is_no_history(refusal):
    soft = {"n": 2, "restitution": 0.3, "amplitude": 50.0, "frequency_ratio": 0.8}
    with refusal(NoOrbitError, "is inadmissible: an earlier impact"):
        contact_history(ONE | soft, "displacement")

"""Stage: random orbits and balls with which the explorer's page compares what it computes."""

from typing import cast

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from bouncing_ball import restitution
from bouncing_ball_beyond.contacts.balls import Ball, Corrected, Rigid, SpringDamper
from bouncing_ball_beyond.contacts.one_ball import settling
from bouncing_ball_beyond.errors.error_law import contact_values, rows_of_orbits
from bouncing_ball_beyond.motions.simulation import simulate
from bouncing_ball_beyond.periodic.equations import OrbitEquations
from bouncing_ball_beyond.periodic.orbits import OrbitNotFound, orbit
from paper_replication.datasets import grid
from studies.orbits import follow_compliant, random_orbits

# The part of the stable range of the restitution model in which Λ is drawn, from near its
# saddle-node (0) to beyond its period doubling (1).
PLACES = (0.02, 1.2)
# Balls that end at rest, on an orbit, on a doubled orbit, and on an orbit with rests. None is near
# chaos, where the results of two computers differ.
BALL = {"restitution": 0.5, "frequency_ratio": 80.0}
AMPLITUDES = [0.6, 1.2, 1.6, 2.5]
START = {"phase": 1.0, "velocity": -3.0}
IMPACTS = 100
# After these a motion repeats itself up to rounding; none is longer than LONGEST impacts.
SETTLED = 400
LONGEST = 40


def orbits_of(ball: Ball, n: NDArray, amplitude: NDArray, saddle_node: NDArray):
    """Equations of n-T orbits and their rows; those above the saddle-node are searched for if they
    are not near the instants of the corrected model.
    """
    equations = OrbitEquations(ball, 1, n)
    z = rows_of_orbits(equations, amplitude)
    for row in np.flatnonzero(np.isnan(z[:, 0]) & ~(amplitude < saddle_node)):
        one = equations.rows(row).ball
        try:
            z[row] = orbit(one, amplitude=amplitude[row], n=n[row]).z
        except OrbitNotFound:
            continue
    return equations, z


def under(release: str, ratios: NDArray, seed: int) -> xr.Dataset:
    """One random orbit for each ϖ under a release, over `sample`."""
    n, zeta, amplitude, _ = random_orbits(ratios.size, seed, release, PLACES)
    r = SpringDamper(1.0, damping_ratio=zeta, release=release).signature(1.0).restitution
    ball = SpringDamper(ratios, restitution=r, release=release)
    limits = ("saddle_node", "period_doubling")
    exact = contact_values(ball, amplitude=amplitude, n=n, quantities=limits)
    follow_compliant(ball, n, exact)
    equations, z = orbits_of(ball, n, amplitude, exact["saddle_node"])
    lift = np.sqrt(amplitude**2 - restitution.saddle_node(n, r) ** 2)
    corrected = Corrected(ball)
    instant = contact_values(corrected, amplitude=amplitude, n=n)
    of_instants = OrbitEquations(corrected, 1, n)
    instants = at_orbits(traces, of_instants, rows_of_orbits(of_instants, amplitude))
    values = {
        "n": n,
        "restitution": r,
        "frequency_ratio": ratios,
        "amplitude": amplitude,
        **at_orbits(observables, equations, z),
        "saddle_node_amplitude": exact["saddle_node"],
        "period_doubling_amplitude": exact["period_doubling"],
        "restitution_phase": restitution.impact_phase(n, r, amplitude),
        # The trace is 1 + r² at the saddle-node, where Y = 0, and -1 - r² at the period doubling.
        "restitution_trace": 1 + r**2 - (1 + r) ** 2 * lift,
        "restitution_period_doubling": restitution.period_doubling(n, r),
        "corrected_phase": instant["phase"],
        "corrected_max_height": instant["max_height"],
        "corrected_trace": instants["trace"],
        "corrected_saddle_node": instant["saddle_node"],
        "corrected_period_doubling": instant["period_doubling"],
    }
    return xr.Dataset({name: ("sample", value) for name, value in values.items()})


def at_orbits(quantities, equations: OrbitEquations, z: NDArray) -> dict[str, NDArray]:
    """A function of equations and orbits, whose values are NaN in rows without an orbit."""
    known = np.isfinite(z[:, 0])
    columns = {}
    for name, values in quantities(equations.rows(known), z[known]).items():
        columns[name] = np.full(len(z), np.nan)
        columns[name][known] = values
    return columns


def traces(equations: OrbitEquations, z: NDArray) -> dict[str, NDArray]:
    """Traces and determinants of the derivatives of return maps."""
    trace, determinant = equations.linearized(z).trace_and_determinant
    return {"trace": trace, "determinant": determinant}


def observables(equations: OrbitEquations, z: NDArray) -> dict[str, NDArray]:
    """The quantities of orbits, and height and force in the middle of the contact."""
    impacts, _, amplitudes, _ = equations.split(z)
    touch, speed, scaled_duration = impacts[:, 0].T
    amplitude = amplitudes[:, 0]
    ends = equations.ends(z)
    duration = ends.leaves[:, 0] - touch
    bounce = ends.speed[:, 0]
    ball = cast(SpringDamper, equations.ball)
    middle = ball.contact(touch, speed, scaled_duration / 2, amplitude)
    ratio = ball.frequency_ratio
    return {
        "phase": np.pi - (np.pi - touch) % (2 * np.pi),
        "contact_duration": duration,
        "impact_velocity": amplitude * np.cos(touch) - speed,
        "bounce_velocity": amplitude * np.cos(touch + duration) + bounce,
        "apparent_restitution": bounce / speed,
        "max_height": equations.max_height(z),
        **traces(equations, z),
        "ball": amplitude * np.sin(touch + duration / 2) + middle.gap,
        "contact_force": -2 * ball.zeta * ratio * middle.speed - ratio**2 * middle.gap,
    }


def followed(ball: Ball, amplitude: float) -> dict[str, float]:
    """The motion on which a ball ends, and its impact 99 or the last before it rests.

    The motion is given by the numbers of impacts and of periods of the table until it repeats; a
    ball at rest has no impacts. The time is that of the impact, or of the rest that follows it.
    """
    motion = simulate(
        ball,
        amplitude=amplitude,
        phase=START["phase"],
        velocity=START["velocity"],
        impacts=SETTLED,
    )
    times = motion.time.values
    phases = motion.impact_phase.values
    speeds = -motion.relative_impact_velocity.values
    rests = motion.status == "permanent contact"
    last = int(np.isfinite(times).sum()) - 1 if rests else IMPACTS - 1
    end = times[last]
    periods, impacts = 1, 0
    if rests:
        phase = phases[last]
        x = amplitude * np.cos(phase)
        y = amplitude * np.sin(phase)
        # Contacts that last have no time in which they end.
        if isinstance(ball, Rigid):
            end += settling(
                BALL["restitution"] * speeds[last], BALL["restitution"], x, y, amplitude
            )
    else:
        shifts = range(1, LONGEST + 1)
        impacts = next(k for k in shifts if repeats(phases, k) and repeats(speeds, k))
        periods = round((times[-1] - times[-1 - impacts]) / (2 * np.pi))
    return {
        "periods": float(periods),
        "impacts": float(impacts),
        "end_impact": float(last),
        "end_phase": phases[last],
        "end_speed": speeds[last],
        "end_time": end,
    }


def repeats(values: NDArray, impacts: int) -> bool:
    """Whether the last values are those some impacts before."""
    return bool(np.allclose(values[-impacts:], values[-2 * impacts : -impacts], rtol=0, atol=1e-9))


def balls() -> xr.Dataset:
    """How balls start and end, over (model, motion)."""
    models = {
        "restitution": Rigid(BALL["restitution"]),
        "spring-damper": SpringDamper(BALL["frequency_ratio"], restitution=BALL["restitution"]),
    }
    ends = [[followed(ball, amplitude) for amplitude in AMPLITUDES] for ball in models.values()]
    size = len(AMPLITUDES)
    given = {
        "ball_restitution": np.full(size, BALL["restitution"]),
        "ball_frequency_ratio": np.full(size, BALL["frequency_ratio"]),
        "ball_amplitude": np.array(AMPLITUDES),
        "start_phase": np.full(size, START["phase"]),
        "velocity": np.full(size, START["velocity"]),
    }
    return xr.Dataset(
        {name: ("motion", values) for name, values in given.items()}
        | {
            name: (("model", "motion"), [[end[name] for end in row] for row in ends])
            for name in ends[0][0]
        },
        {"model": list(models)},
    )


def explorer(parameters: dict) -> xr.Dataset:
    """One random orbit for each ϖ of a grid, under each release, and some balls.

    Of each orbit the dataset has the contact, the quantities of the orbit, its bifurcations, height
    and force in the middle of the contact, and values of both simple models; NaN where there is no
    orbit or no bifurcation.
    """
    ratios = grid(parameters["frequency_ratio"])
    releases = ["displacement", "force"]
    orbits = [under(release, ratios, parameters["seed"] + k) for k, release in enumerate(releases)]
    data = xr.concat(orbits, "release").assign_coords(release=releases)
    return data.merge(balls())


STAGE = {"explorer": explorer}

"""Stage: which share of starts ends on a stable n-T orbit of a contact."""

import numpy as np
import xarray as xr

from bouncing_ball.restitution import period_doubling, saddle_node
from bouncing_ball_beyond.contacts.balls import SpringDamper
from bouncing_ball_beyond.motions.bounces import Balls, bounce
from bouncing_ball_beyond.periodic.orbits import orbit

NEAR = 1e-3
"""Sum of the distances in phase and in relative speed below which a touch is that of the orbit."""

LAST = 4
"""Touches in a row that are compared with it."""


def random_orbits(parameters: dict, generator: np.random.Generator) -> xr.Dataset:
    """Orbits with random r and places of Λ in the stable range, as many for each n.

    Of those that the contact has, and on which a ball stays, the first ones are taken.
    """
    wanted = parameters["orbits"]
    r_min, r_max = parameters["restitution"]
    first, last = parameters["position"]
    orbits_by_n = []
    for n in parameters["n"]:
        # Next to the period doubling the contact's orbit has doubled: some are drawn in vain.
        r = generator.uniform(r_min, r_max, 2 * wanted)
        place = generator.uniform(first, last, 2 * wanted)
        low = saddle_node(n, r)
        amplitude = low + place * (period_doubling(n, r) - low)
        ball = SpringDamper(parameters["frequency_ratio"], restitution=r)
        orbits = orbit(ball, amplitude=amplitude, n=n)
        stable = [
            i for i, candidate in enumerate(orbits) if candidate.stable and candidate.admissible
        ][:wanted]
        columns = {
            "n": np.full(len(stable), n),
            "restitution": r[stable],
            "position": place[stable],
            "amplitude": amplitude[stable],
            "phase": [orbits[i].phase for i in stable],
            "speed": [orbits[i].speeds[0] for i in stable],
        }
        orbits_by_n.append(
            xr.Dataset({name: ("orbit", column) for name, column in columns.items()})
        )
    return xr.concat(orbits_by_n, "orbit")


def ext_basin(parameters: dict) -> xr.Dataset:
    """The share of starts, with uniform phases and closing speeds, that end on each orbit."""
    generator = np.random.default_rng(parameters["seed"])
    orbits = random_orbits(parameters, generator)
    starts = parameters["starts"]
    orbit_of_start = orbits.isel(orbit=np.repeat(orbits.orbit, starts))
    count = orbit_of_start.sizes["orbit"]
    fastest = parameters["speed_max"] * np.pi
    balls = Balls(
        SpringDamper(
            np.full(count, parameters["frequency_ratio"]),
            restitution=orbit_of_start.restitution.values,
        ),
        orbit_of_start.amplitude.values,
        np.zeros(count),
        generator.uniform(-np.pi, np.pi, count),
        generator.uniform(0, fastest, count),
    )
    on_orbit = np.zeros(count, bool)
    left = np.arange(count)
    for _ in range(parameters["impacts"] // parameters["block"]):
        record, going, balls = bounce(balls, parameters["block"])
        last = record[-LAST:]
        turned = last[:, 1] - orbit_of_start.phase.values[left]
        away = np.abs(np.exp(1j * turned) - 1) + np.abs(
            last[:, 2] / orbit_of_start.speed.values[left] - 1
        )
        arrived = (away < NEAR).all(axis=0)
        on_orbit[left[arrived]] = True
        # The others go on, but for those that stay on the table.
        on = ~arrived[going]
        left = left[going][on]
        balls = balls.take(np.flatnonzero(on))
        if not left.size:
            break
    share = on_orbit.reshape(-1, starts).mean(axis=1)
    kept = orbits[["n", "restitution", "position", "amplitude"]]
    return kept.set_coords(list(kept)).assign(basin_share=("orbit", share))


STAGE = {"ext_basin": ext_basin}

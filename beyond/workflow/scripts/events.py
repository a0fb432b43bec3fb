"""Stage: chaotic balls on a contact, in the restitution model and in the corrected model.

A ball that comes to rest in one of the two models of instants forgets its past. Its later motion
repeats itself, so that the average over one long motion is not that over the chaotic motions. The
averages are therefore over many short motions with random starts.
"""

import sys
from itertools import product

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from bouncing_ball.datasets import save_stage
from bouncing_ball_beyond.balls import Ball, Corrected, Rigid, SpringDamper
from bouncing_ball_beyond.simulation import Balls, follow
from studies.variables import VARIABLES

MODELS = ("contact", "restitution", "corrected")


def touch_speeds(ball: Ball, record: NDArray, amplitude: float) -> NDArray:
    """The closing speeds at the touch, shape (impact, ball).

    The impacts of the corrected model are instants. The flights to them touch the table t_c
    earlier.
    """
    phase = record[:, 1]
    speed = record[:, 2]
    if not isinstance(ball, Corrected):
        return speed
    delay = ball.of.signature(speed).centroid
    return speed - delay - amplitude * (np.cos(phase) - np.cos(phase - delay))


def averages(
    r: float, amplitude: float, ratio: float, parameters: dict, generator: np.random.Generator
) -> dict[str, list]:
    """Mean square of the closing speed at the touch, its standard error, and slow landings."""
    contact = SpringDamper(ratio, restitution=r)
    slow = 4 * float(contact.signature(1.0).centroid) * (1 + amplitude)
    size = parameters["balls"]
    phase = generator.uniform(-np.pi, np.pi, size)
    speed = generator.uniform(2, 12, size)
    found: dict[str, list] = {"mean_square": [], "mean_square_error": [], "slow_share": []}
    for ball in (contact, Rigid(r), Corrected(contact)):
        balls = Balls(ball, np.full(size, amplitude), np.zeros(size), phase, speed)
        _, _, balls = follow(balls, parameters["settling"])
        record, _, _ = follow(balls, parameters["impacts"])
        speeds = touch_speeds(ball, record, amplitude)
        of_ball = np.nanmean(speeds**2, axis=0)
        found["mean_square"].append(of_ball.mean())
        found["mean_square_error"].append(of_ball.std(ddof=1) / np.sqrt(of_ball.size))
        found["slow_share"].append(np.mean(speeds < slow))
    return found


def ext_event(parameters: dict) -> xr.Dataset:
    """Mean squares of impact speeds on a contact and in both models, for each r, Λ and ϖ."""
    generator = np.random.default_rng(parameters["seed"])
    names = ("ball_restitution", "ball_amplitude", "ball_frequency_ratio")
    grids = {name: parameters[name] for name in names}
    found = [averages(*case, parameters, generator) for case in product(*grids.values())]
    shape = [*map(len, grids.values()), len(MODELS)]
    return xr.Dataset(
        {
            key: ((*names, "model"), np.reshape([each[key] for each in found], shape))
            for key in found[0]
        },
        grids | {"model": list(MODELS)},
    )


STAGE = {
    "ext_event": (ext_event, "Impact speeds of chaotic balls on a contact and in both models"),
}

if __name__ == "__main__":
    sys.stderr = open(snakemake.log[0], "w", encoding="utf-8")  # what goes wrong is in the log
    save_stage(
        STAGE, snakemake.params.config, {}, snakemake.output, snakemake.input.code, VARIABLES
    )

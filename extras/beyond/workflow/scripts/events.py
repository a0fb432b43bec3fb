"""Stage: balls from random starts on a contact, in the restitution and in the corrected model.

Each ball is followed until its motion is known: it repeats, the ball rests on the table, or the
largest Lyapunov exponent is positive. The averages are over the balls whose motions are chaotic,
after the impacts in which they settle.

A ball that comes to rest in one of the models of instants forgets its past. If neighbours separate
to the size of the motion before it rests again, rounding decides how long this takes.
"""

import sys

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from bouncing_ball.datasets import save_stage
from bouncing_ball_beyond.balls import Ball, Corrected, Rigid, SpringDamper
from bouncing_ball_beyond.motions import CHAOTIC, ROUNDING, UNDECIDED, ends_of
from bouncing_ball_beyond.simulation import Balls, follow
from studies.variables import VARIABLES

MODELS = ("contact", "restitution", "corrected")

MOST = 0.8
"""The share of chaotic balls from which on there is an average over them."""


def touch_speeds(ball: Ball, record: NDArray, amplitude: NDArray) -> NDArray:
    """The closing speeds at the touch, shape (impact, ball).

    The impacts of the corrected model are instants, and its touches are t_c earlier.
    """
    phase = record[:, 1]
    speed = record[:, 2]
    if not isinstance(ball, Corrected):
        return speed
    delay = ball.of.signature(speed).centroid
    return speed - delay - amplitude * (np.cos(phase) - np.cos(phase - delay))


def settled(ball: Ball, start: dict[str, NDArray], parameters: dict) -> dict[str, NDArray]:
    """By balls: whether the motion is chaotic, whether it repeats or ends at rest, and of a chaotic
    one the mean square speed of touches and the share of slow ones.

    ``start`` has Λ, phases and speeds, and the speeds below which a touch is slow.
    """
    amplitude = start["amplitude"]
    turns = np.zeros(amplitude.size)
    ends = ends_of(
        Balls(ball, amplitude, turns, start["phase"], start["speed"]), parameters["settling"]
    )
    chaotic = ends["kind"] == CHAOTIC
    (some,) = chaotic.nonzero()
    balls = Balls(ball, amplitude, turns, ends["end_phase"], ends["end_speed"]).take(some)
    record, _, _ = follow(balls, parameters["impacts"])
    speeds = touch_speeds(balls.ball, record, balls.amplitude)
    squares, slow = np.full((2, amplitude.size), np.nan)
    squares[some] = np.nanmean(speeds**2, axis=0)
    slow[some] = np.nanmean(speeds < start["slow"][some], axis=0)
    repeats = ~chaotic & (ends["kind"] != UNDECIDED) & (ends["reason"] != ROUNDING)
    return {
        "chaotic_share": chaotic,
        "repeating_share": repeats,
        "mean_square": squares,
        "slow_share": slow,
    }


def averages(r: float, parameters: dict, generator: np.random.Generator) -> xr.Dataset:
    """Means over the balls with one r, by model, Λ and ϖ, and the standard error of ⟨u²⟩."""
    names = ("ball_amplitude", "ball_frequency_ratio")
    grids = {name: parameters[name] for name in names} | {"ball": range(parameters["balls"])}
    amplitude, ratio, _ = map(np.ravel, np.meshgrid(*grids.values(), indexing="ij"))
    contact = SpringDamper(ratio, restitution=np.full(ratio.size, r))
    start = {
        "amplitude": amplitude,
        "phase": generator.uniform(-np.pi, np.pi, ratio.size),
        "speed": generator.uniform(2, 12, ratio.size),
        "slow": 4 * contact.signature(1.0).centroid * (1 + amplitude),
    }
    models = contact, Rigid(np.full(ratio.size, r)), Corrected(contact)
    of_models = [settled(ball, start, parameters) for ball in models]
    shape = len(models), *map(len, grids.values())
    by_ball = xr.Dataset(
        {
            name: (("model", *grids), np.reshape([each[name] for each in of_models], shape))
            for name in of_models[0]
        },
        {name: parameters[name] for name in names} | {"model": list(MODELS)},
    )
    squares = by_ball.mean_square
    found = by_ball.mean("ball")
    found["mean_square_error"] = squares.std("ball", ddof=1) / np.sqrt(squares.count("ball"))
    for name in ("mean_square", "mean_square_error", "slow_share"):
        found[name] = found[name].where(found.chaotic_share >= MOST)
    return found


def ext_event(parameters: dict) -> xr.Dataset:
    """Motions and mean squares of touch speeds on a contact and in both models, by r, Λ and ϖ."""
    generator = np.random.default_rng(parameters["seed"])
    found = [averages(r, parameters, generator) for r in parameters["ball_restitution"]]
    restitution = xr.Variable("ball_restitution", parameters["ball_restitution"])
    order = ("ball_restitution", "ball_amplitude", "ball_frequency_ratio", "model")
    return xr.concat(found, restitution).transpose(*order)


STAGE = {"ext_event": ext_event}

if __name__ == "__main__":
    sys.stderr = open(snakemake.log[0], "w", encoding="utf-8")  # what goes wrong is in the log
    save_stage(
        STAGE,
        snakemake.params.entries,
        snakemake.params.settings,
        snakemake.output,
        snakemake.input.code,
        VARIABLES,
    )

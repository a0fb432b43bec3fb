"""``bouncing-ball law-simulate``: the impacts of one ball."""

import math
from typing import Any

import numpy as np

from bouncing_ball_beyond.cli.impact import add_ball, ball_of
from bouncing_ball_beyond.cli.periodic import Answer, law_values
from bouncing_ball_beyond.inherited.cli.balls import note_on
from bouncing_ball_beyond.inherited.cli.options import Parser, add_number, meanings
from bouncing_ball_beyond.inherited.datasets.arguments import AMPLITUDE, IMPACTS, START, Range
from bouncing_ball_beyond.inherited.models.model import Status
from bouncing_ball_beyond.motions import over_time

_SHOWN = ("time", "phase", "impact_velocity", "contact_duration", "bounce_velocity")


def add_options(parser: Parser) -> None:
    """Add the options of :func:`simulate`."""
    add_start(parser, IMPACTS, meanings(over_time.simulate), impacts=100)
    add_ball(parser)


def add_start(parser: Parser, most: Range, texts: dict[str, str], impacts: int) -> None:
    """Add the options for a first impact and for the number of impacts."""
    add_number(parser, "amplitude", AMPLITUDE, texts["amplitude"], required=True)
    add_number(parser, "phase", START, texts["phase"], default=0.0)
    add_number(parser, "velocity", START, texts["velocity"], default=-math.pi)
    add_number(parser, "impacts", most, texts["impacts"], default=impacts)


def simulate(
    *, amplitude: float, phase: float, velocity: float, impacts: int, **impact: Any
) -> Answer:
    """The sequence of impacts of one ball as lists, with null for an event that does not happen."""
    speed = float(amplitude * np.cos(phase) - velocity)
    model = ball_of(**impact).at_speed(speed)
    found = model.simulate(amplitude, phase, velocity, impacts)
    columns = np.array([getattr(found, name) for name in _SHOWN])
    there = columns[:, np.isfinite(found.time)]
    sequence = [[x if math.isfinite(x) else None for x in column] for column in there.tolist()]
    return {
        **note_on(phase),
        "status": Status(int(found.status)).words,
        **law_values(model.impact_law, -float(found.relative_velocity[0])),
        "sequence": dict(zip(_SHOWN, sequence, strict=True)),
    }

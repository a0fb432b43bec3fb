"""``bouncing-ball motion`` and ``diagram``: the motions on which balls end."""

import math
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np

from bouncing_ball_beyond.cli.impact import add_ball, ball_of
from bouncing_ball_beyond.cli.options import add_file, add_interval
from bouncing_ball_beyond.cli.periodic import Answer
from bouncing_ball_beyond.inherited.cli.balls import note_on
from bouncing_ball_beyond.inherited.cli.options import Parser, add_number, meanings
from bouncing_ball_beyond.inherited.datasets.arguments import AMPLITUDE, SAMPLES, START
from bouncing_ball_beyond.inherited.datasets.files import PICTURES, require_writable
from bouncing_ball_beyond.inherited.errors import ParameterError, count
from bouncing_ball_beyond.models.ball import Ball
from bouncing_ball_beyond.motions import motion_of as library
from bouncing_ball_beyond.motions.destination import FOLLOWED, IMPACTS

_MOTION = ("kind", "periods", "impacts", "reason")
_AMPLITUDES = count(100_000, low=2)
# The start of a ball if none is given: the phase, and the absolute velocity before the impact.
_START = {"phase": 0.0, "velocity": -math.pi}
# Other starts, along each axis.
_OTHER_STARTS = 10


def motion_options(parser: Parser) -> None:
    """Add the options of :func:`motion`."""
    texts = meanings(library.motion_of)
    add_number(parser, "amplitude", AMPLITUDE, texts["amplitude"], required=True)
    add_number(parser, "phase", START, f"{texts['phase']} By default 0.")
    add_number(parser, "velocity", START, f"{texts['velocity']} By default -π.")
    add_number(parser, "impacts", FOLLOWED, texts["impacts"], default=IMPACTS)
    add_ball(parser)


def motion(
    *,
    amplitude: float,
    phase: float | None,
    velocity: float | None,
    impacts: int,
    **impact: Any,
) -> Answer:
    """The motion on which the ball ends, with null for an exponent that is infinite or unknown.

    Without a start, the answer names the start that was taken, and the motions on which balls with
    other starts end, with their shares.
    """
    ball = ball_of(**impact)
    given = {"phase": phase, "velocity": velocity}
    start = _START | {name: x for name, x in given.items() if x is not None}
    found = library.motion_of(ball, amplitude=amplitude, impacts=impacts, **start)
    answer = note_on(start["phase"])
    answer |= {name: x for name in _MOTION if (x := found[name].item()) != ""}
    exponents = {name: float(found[name]) for name in ("lyapunov_exponent", "lyapunov_error")}
    answer |= {name: x if math.isfinite(x) else None for name, x in exponents.items()}
    answer["impacts_followed"] = found.followed.item()
    lost = found.digits_lost.item()
    answer["digits_lost"] = lost if math.isfinite(lost) else None
    if phase is None and velocity is None:
        answer["start"] = _START
        answer["share_of_other_starts"] = _ends_of_other_starts(ball, amplitude, impacts)
    return answer


def _ends_of_other_starts(ball: Ball, amplitude: float, impacts: int) -> Answer:
    """The motions on which balls from an even grid of starts end, with their shares."""
    found = library.basins(ball, amplitude=amplitude, starts=_OTHER_STARTS, impacts=impacts).sortby(
        "share", ascending=False
    )
    shares = {}
    for k in range(found.sizes["motion"]):
        one = found.isel(motion=k)
        period = f" {one.motion_periods.item()}/{one.motion_impacts.item()}"
        name = one.motion_kind.item() + (period if one.motion_impacts.item() else "")
        shares[name] = one.share.item()
    return shares


def diagram_options(parser: Parser) -> None:
    """Add the options of :func:`diagram`."""
    texts = meanings(library.orbit_diagram)
    add_interval(parser, "amplitudes", AMPLITUDE, "First and last excitation amplitude Λ.")
    steps = "Number of amplitudes, at equal steps."
    add_number(parser, "points", _AMPLITUDES, steps, default=300)
    add_file(parser, "plot", "A figure: .pdf, .png or .svg.")
    add_number(parser, "starts", SAMPLES, texts["starts"], default=6)
    add_number(parser, "samples", SAMPLES, texts["samples"], default=64)
    add_number(parser, "impacts", FOLLOWED, texts["impacts"], default=IMPACTS)
    add_ball(parser)


def diagram(
    *,
    amplitudes: tuple[float, float],
    points: int,
    plot: Path | None,
    starts: int,
    samples: int,
    impacts: int,
    **impact: Any,
) -> Answer:
    """The motions at each amplitude with their shares of the starts, and the figure.

    Raises
    ------
    ModelError
        If the range is empty, or the figure has another suffix or cannot be written.
    """
    require_writable(plot, PICTURES)
    low, high = amplitudes
    if not low < high:
        raise ParameterError(f"{{amplitudes}} {low:g} {high:g}: the second must be larger")
    found = library.orbit_diagram(
        ball_of(**impact),
        amplitude=np.linspace(low, high, points),
        starts=starts,
        samples=samples,
        impacts=impacts,
    )
    if plot is not None:
        found.plot(plot)
    # Lists over the amplitudes, because it takes long to select from a dataset hundreds of times.
    ends = zip(*(found[name].values.tolist() for name in _MOTION), strict=True)
    at = zip(found.amplitude.values.tolist(), ends, strict=True)
    return {"diagram": [{"amplitude": lam, "motions": _shares(*end)} for lam, end in at]}


def _shares(*ends: list[Any]) -> list[Answer]:
    """The motions at one amplitude, the most frequent first, with the reason of each that is
    undecided; ``ends`` has a list over the balls for each of :data:`_MOTION`.
    """
    each = Counter(zip(*ends, strict=True))
    return [
        {name: x for name, x in zip(_MOTION, motion, strict=True) if x != ""}
        | {"share": number / each.total()}
        for motion, number in each.most_common()
    ]


def diagram_lines(answer: Answer) -> list[str]:
    """A line for each amplitude: kind, periods/impacts and share of the starts."""
    shown = ((at["amplitude"], ", ".join(map(_words, at["motions"]))) for at in answer["diagram"])
    return [f"{amplitude:<12.8g}{motions}" for amplitude, motions in shown]


def _words(motion: Answer) -> str:
    period = f" {motion['periods']}/{motion['impacts']}" if motion["periods"] else ""
    reason = f", because {motion['reason']}" if "reason" in motion else ""
    return f"{motion['kind']}{period} ({motion['share']:.0%}{reason})"

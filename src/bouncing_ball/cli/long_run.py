"""``bouncing-ball motion`` and ``diagram``: the motions on which balls end."""

import math
from collections import Counter
from pathlib import Path
from typing import Annotated, Any

import numpy as np

from bouncing_ball.calls import long_run
from bouncing_ball.calls.balls import AnyAmplitude
from bouncing_ball.calls.signatures import takes
from bouncing_ball.cli.output import lines as readable
from bouncing_ball.datasets.files import PICTURES, require_writable
from bouncing_ball.datasets.labelled import Labelled
from bouncing_ball.errors import ParameterError, count

Answer = dict[str, Any]
_MOTION = ("kind", "periods", "impacts", "reason")
Interval = tuple[AnyAmplitude, AnyAmplitude]
Points = Annotated[int, count(100_000, low=2)]


@takes(long_run.motion_of)
def motion(amplitude, **given: Any) -> Answer:
    """The motion on which the ball ends, with null for an exponent that is infinite or unknown."""
    found = long_run.motion_of(amplitude, **given)
    exponents = {name: float(found[name]) for name in ("lyapunov_exponent", "lyapunov_error")}
    answer: Answer = {name: x for name in _MOTION if (x := found[name].item()) != ""}
    return answer | {name: x if math.isfinite(x) else None for name, x in exponents.items()}


@takes(long_run.orbit_diagram)
def diagram(
    *, amplitudes: Interval, points: Points = 300, plot: Path | None = None, **given: Any
) -> Answer:
    """The motions at each amplitude with their shares of the starts, and the figure.

    Parameters
    ----------
    amplitudes
        First and last excitation amplitude Λ.
    points
        Number of amplitudes, at equal steps.
    plot
        A figure: .pdf, .png or .svg.

    Raises
    ------
    ModelError
        If the range is empty, or the figure has another suffix or cannot be written.
    """
    require_writable(plot, PICTURES)
    low, high = amplitudes
    if not low < high:
        raise ParameterError(f"{{amplitudes}} {low:g} {high:g}: the second must be larger")
    found = long_run.orbit_diagram(np.linspace(low, high, points), **given)
    if plot is not None:
        found.plot(plot)
    at = (found.isel(amplitude=k) for k in range(points))
    return {"diagram": [{"amplitude": float(x.amplitude), "motions": _shares(x)} for x in at]}


def _shares(at: Labelled) -> list[Answer]:
    """The motions at one amplitude, the most frequent first, with the reason of each that is
    undecided.
    """
    each = Counter(zip(*(at[name].values.tolist() for name in _MOTION), strict=True))
    return [
        {name: x for name, x in zip(_MOTION, motion, strict=True) if x != ""}
        | {"share": number / each.total()}
        for motion, number in each.most_common()
    ]


def _words(motion: Answer) -> str:
    period = f" {motion['periods']}/{motion['impacts']}" if motion["periods"] else ""
    reason = f", because {motion['reason']}" if "reason" in motion else ""
    return f"{motion['kind']}{period} ({motion['share']:.0%}{reason})"


def lines(answer: Answer) -> list[str]:
    """The motion, or a line for each amplitude: kind, periods/impacts and share of the starts."""
    if "diagram" not in answer:
        return readable(answer)
    shown = ((at["amplitude"], ", ".join(map(_words, at["motions"]))) for at in answer["diagram"])
    return [f"{amplitude:<12.8g}{motions}" for amplitude, motions in shown]

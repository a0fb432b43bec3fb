"""``bouncing-ball follow`` and ``curve``: periodic orbits along one parameter and two."""

import math
from pathlib import Path
from typing import Any, get_args

from bouncing_ball_beyond.cli.impact import add_ball, ball_of
from bouncing_ball_beyond.cli.options import add_file
from bouncing_ball_beyond.cli.periodic import Answer
from bouncing_ball_beyond.inherited.cli.options import (
    Parser,
    add_choice,
    add_number,
    meanings,
    option,
)
from bouncing_ball_beyond.inherited.datasets.arguments import (
    AMPLITUDE_OF_ORBIT,
    FAMILY,
    POINTS,
    START,
    SideName,
)
from bouncing_ball_beyond.inherited.datasets.files import PICTURES, require_writable
from bouncing_ball_beyond.inherited.errors import ParameterError, Range
from bouncing_ball_beyond.motions.orbit_of_motion import orbit_of_motion
from bouncing_ball_beyond.periodic import orbits_of_ball as periodic
from bouncing_ball_beyond.periodic.branches import follow as library
from bouncing_ball_beyond.periodic.branches.labelled import FollowedBranch
from bouncing_ball_beyond.periodic.orbits.special import MEANINGS, Special

_DOUBLINGS = Range(0, 8, "[]", whole=True)
_NAME = (
    "Name of a parameter: amplitude, frequency-ratio, restitution, damping-ratio, or one of a law; "
    "or frequency, that of the table at a fixed stroke a, over √(g/a)."
)
_MOTION = (
    "Phase of the first impact of a simulated ball, which ends on the orbit to be followed; by "
    "default the n-T orbit is followed."
)
_TWICE = "Number of period doublings at which the branch of twice the period is taken."
_KINDS = ("saddle-node", "period-doubling", "grazing-flight", "grazing-impact", "grazing-release")


def _add_orbit(parser: Parser) -> None:
    texts = meanings(periodic.orbit)
    add_number(parser, "n", FAMILY, texts["n"], default=1)
    add_number(parser, "amplitude", AMPLITUDE_OF_ORBIT, texts["amplitude"], required=True)
    add_choice(parser, "side", get_args(SideName), texts["side"], default="stable")
    add_number(parser, "phase", START, _MOTION)
    add_number(parser, "velocity", START, "Its absolute velocity before this impact.")
    add_number(parser, "doublings", _DOUBLINGS, _TWICE, default=0)
    parser.add_argument(option("along"), metavar="NAME", default="amplitude", help=_NAME)
    to = "Value at which the branch ends."
    add_number(parser, "to", Range(), to, required=True)
    add_file(parser, "plot", "A figure: .pdf, .png or .svg.")


def follow_options(parser: Parser) -> None:
    """Add the options of :func:`follow`."""
    _add_orbit(parser)
    add_ball(parser)


def follow(
    *,
    n: int,
    amplitude: float,
    side: SideName,
    phase: float | None,
    velocity: float | None,
    doublings: int,
    along: str,
    to: float,
    plot: Path | None,
    **impact: Any,
) -> Answer:
    """The special orbits of a branch, and why the branch ends.

    Raises
    ------
    NoOrbitError
        If there is no orbit to start from.
    """
    require_writable(plot, PICTURES)
    _require_contact("along", along, impact)
    start = _start(n, amplitude, side, phase, velocity, impact)
    found = _branch(start, along, to, doublings)
    if plot is not None:
        found.plot(plot)
    orbits = [
        {
            "kind": kind,
            **state.parameters,
            "phase": float(state.phases[0]),
            "meaning": MEANINGS.get(Special(kind), "") if kind in list(Special) else "",
        }
        for kind, state in found.special_states()
    ]
    size = {"impacts": found.impacts, "periods": found.periods, "points": len(found)}
    return {"orbits": orbits, **size, "end": found.end_reason}


def _range(
    name: str, low: float | None, high: float | None, prefix: str = ""
) -> dict[str, tuple[float, float]]:
    """The range of a parameter of a curve by its name, if it is given."""
    if low is None and high is None:
        return {}
    if low is None or high is None:
        raise ParameterError(f"{{{prefix}low}} and {{{prefix}high}} are needed together")
    return {name: (low, high)}


def _require_contact(name: str, parameter: str, impact: dict[str, Any]) -> None:
    """Raise an error if a parameter of a spring and damper is varied, and there is none."""
    is_of_contact = parameter.replace("-", "_") in ("frequency_ratio", "damping_ratio")
    if is_of_contact and impact["frequency_ratio"] is None and impact["law"] is None:
        raise ParameterError(
            f"{{{name}}} {parameter} needs {{frequency_ratio}} of a contact, from which it starts"
        )


def _start(
    n: int,
    amplitude: float,
    side: SideName,
    phase: float | None,
    velocity: float | None,
    impact: dict[str, Any],
) -> Any:
    """The n-T orbit, or the orbit on which a ball ends."""
    ball = ball_of(**impact)
    if phase is None and velocity is None:
        return periodic.orbit(ball, n, amplitude=amplitude, side=side)
    first_phase = 0.0 if phase is None else phase
    first_velocity = -math.pi if velocity is None else velocity
    return orbit_of_motion(ball, amplitude=amplitude, phase=first_phase, velocity=first_velocity)


def _branch(start: Any, along: str, to: float, doublings: int) -> FollowedBranch:
    """The branch of the orbit whose period has doubled so many times."""
    name = along.replace("-", "_")
    found = library.follow(start, along=name, to=to)
    for _ in range(doublings):
        found = library.follow(found.first("period doubling"), along=name, to=to)
    return found


def curve_options(parser: Parser) -> None:
    """Add the options of :func:`curve`."""
    _add_orbit(parser)
    add_choice(parser, "kind", _KINDS, "Kind of the special orbits.", default="saddle-node")
    parser.add_argument(option("across"), metavar="NAME", required=True, help=_NAME)
    add_number(parser, "low", Range(), "Smallest value of the second parameter.")
    add_number(parser, "high", Range(), "Largest value of the second parameter.")
    add_number(parser, "along_low", Range(), "Smallest value of the first parameter on the curve.")
    add_number(parser, "along_high", Range(), "Largest value of the first parameter on the curve.")
    add_number(
        parser, "points", POINTS, meanings(library.follow)["points"], default=library.MOST_POINTS
    )
    add_ball(parser)


def curve(
    *,
    kind: str,
    across: str,
    low: float | None,
    high: float | None,
    along_low: float | None,
    along_high: float | None,
    points: int,
    along: str,
    to: float,
    doublings: int,
    plot: Path | None,
    **rest: Any,
) -> Answer:
    """The special points of a curve in two parameters, and its ends.

    The curve goes through the first special orbit of the kind between the orbit and the value
    ``to``.

    Raises
    ------
    NoOrbitError
        If there is no such special orbit.
    """
    require_writable(plot, PICTURES)
    _require_contact("along", along, rest)
    _require_contact("across", across, rest)
    if across.replace("-", "_") == along.replace("-", "_"):
        raise ParameterError(f"{{across}} {across} is that of {{along}}: give another parameter")
    orbit = {name: rest.pop(name) for name in ("n", "amplitude", "side", "phase", "velocity")}
    found = _branch(_start(**orbit, impact=rest), along, to, doublings)
    words = str(Special[kind.replace("-", "_").upper()])
    name = across.replace("-", "_")
    special = found.first(words)
    first = along.replace("-", "_")
    ranges = _range(first, along_low, along_high, "along_") | _range(name, low, high)
    traced = library.follow(special, along=(first, name), points=points, ranges=ranges)
    if plot is not None:
        traced.plot(plot)
    places = [{"kind": kind, **state.parameters} for kind, state in traced.special_states()]
    ends = {"start": traced.start_reason, "end": traced.end_reason}
    return {"orbits": places, "points": len(traced), **ends}

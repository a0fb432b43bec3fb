"""The subcommands about balls: the options of a ball, and ``orbit``, ``limits``, ``branch``,
``permanent-contact``, ``thresholds`` and ``simulate``.

Every answer has numbers of Python, and null for a number that does not exist.
"""

import math
from typing import Any, Literal, get_args

import numpy as np

from bouncing_ball_beyond.inherited.accuracy.thresholds import error_thresholds
from bouncing_ball_beyond.inherited.cli.options import Parser, add_choice, add_number, meanings
from bouncing_ball_beyond.inherited.datasets.arguments import (
    AMPLITUDE,
    AMPLITUDE_OF_ORBIT,
    DAMPING_RATIO,
    FAMILY,
    FREQUENCY_RATIO,
    IMPACTS,
    POSITIVE,
    RESTITUTION,
    RIGID_RESTITUTION,
    START,
    TOLERANCE,
    ReleaseName,
)
from bouncing_ball_beyond.inherited.errors import NoOrbitError, ParameterError
from bouncing_ball_beyond.inherited.models import history
from bouncing_ball_beyond.inherited.models.damping import Release, restitution_coefficient
from bouncing_ball_beyond.inherited.models.model import Model, Status
from bouncing_ball_beyond.inherited.models.restitution import rigid
from bouncing_ball_beyond.inherited.models.simulation import impacts_of
from bouncing_ball_beyond.inherited.models.spring_damper import (
    SpringDamper,
    spring_damper,
    the_loss,
)
from bouncing_ball_beyond.inherited.periodic import calls
from bouncing_ball_beyond.inherited.periodic.orbit import (
    OBSERVABLES,
    Bifurcation,
    Orbit,
    defect,
    multipliers,
)

Answer = dict[str, Any]
SideOrAll = Literal["stable", "unstable", "all"]
MODELS = ("restitution", "spring-damper")
_SIDE = (
    'Side of the branch: "stable" or "unstable" next to the saddle-node, or "all" for every orbit '
    "at this amplitude, in order of contact duration."
)
_INDEX = 'Number, from 1, of one orbit in the list of side "all".'
_MODEL = (
    '"restitution" or "spring-damper". By default "spring-damper" if ϖ is given, and otherwise '
    '"restitution".'
)
_SHOWN = ("time", "phase", "impact_velocity", "contact_duration", "bounce_velocity")


# A ball.


def add_loss(parser: Parser) -> None:
    """Add the options for the loss of an impact, of which one is needed."""
    texts = meanings(spring_damper)
    add_number(parser, "restitution", RIGID_RESTITUTION, texts["restitution"])
    add_number(parser, "damping_ratio", DAMPING_RATIO, texts["damping_ratio"])
    add_number(parser, "measured_restitution", RESTITUTION, texts["measured_restitution"])


def add_contact(parser: Parser) -> None:
    """Add the options for the loss of an impact and the release."""
    add_loss(parser)
    add_choice(parser, "release", Release, meanings(spring_damper)["release"])


def add_ball(parser: Parser) -> None:
    """Add the options of :func:`ball_of`."""
    text = meanings(spring_damper)["frequency_ratio"]
    add_number(parser, "frequency_ratio", FREQUENCY_RATIO, text)
    add_contact(parser)
    add_choice(parser, "model", MODELS, _MODEL)


def ball_of(
    *,
    restitution: float | None,
    frequency_ratio: float | None,
    release: ReleaseName | None,
    damping_ratio: float | None,
    measured_restitution: float | None,
    model: str | None,
) -> Model:
    """The ball that the options describe.

    Raises
    ------
    ModelError
        If an option is missing or contradicts another.
    """
    losses: dict[str, Any] = {
        "restitution": restitution,
        "damping_ratio": damping_ratio,
        "measured_restitution": measured_restitution,
    }
    loss = the_loss(restitution, damping_ratio, measured_restitution)
    kind = model or ("restitution" if frequency_ratio is None else "spring-damper")
    if kind == "spring-damper":
        if frequency_ratio is None:
            raise ParameterError("{model} spring-damper needs {frequency_ratio}")
        return spring_damper(
            frequency_ratio=frequency_ratio, release=release or "displacement", **losses
        )
    instead = "needs {frequency_ratio}; {model} restitution takes {restitution}"
    no_contact = "has no meaning for {model} restitution, which has no contact"
    refused = {
        "damping_ratio": (damping_ratio, instead),
        "frequency_ratio": (frequency_ratio, no_contact),
        "release": (release, no_contact),
    }
    for name, (value, why) in refused.items():
        if value is not None:
            raise ParameterError(f"{{{name}}} {why}")
    return rigid(restitution=losses[loss])


def law_of(model: Model) -> Answer:
    """r and ζ of a contact, where r is that of a free impact with its release."""
    if not isinstance(model, SpringDamper):
        return {}
    r = restitution_coefficient(model.damping_ratio, model.release)
    return {"measured_restitution": float(r), "damping_ratio": float(model.damping_ratio)}


# Orbits.


def add_orbit(parser: Parser) -> None:
    """Add the options for one orbit of a ball, or several."""
    texts = meanings(calls.orbit)
    add_number(parser, "n", FAMILY, texts["n"], default=1)
    add_number(parser, "amplitude", AMPLITUDE_OF_ORBIT, texts["amplitude"], required=True)
    add_choice(parser, "side", get_args(SideOrAll), _SIDE, default="stable")
    add_number(parser, "index", FAMILY, _INDEX)


def orbit_options(parser: Parser) -> None:
    """Add the options of :func:`orbit`."""
    add_orbit(parser)
    add_ball(parser)


def orbit(*, n: int, amplitude: float, side: SideOrAll, index: int | None, **impact: Any) -> Answer:
    """The n-T orbit at Λ on one side of the saddle-node, all orbits there, or one of these.

    Raises
    ------
    NoOrbitError
        If there is no such orbit.
    """
    ball = ball_of(**impact)
    if index is not None and side != "stable":
        raise ParameterError("argument {index}: not allowed with argument {side}")
    if index is None and side != "all":
        one: Any = calls.orbit(ball, n, amplitude=amplitude, side=side)
        return _orbit(one) | law_of(ball)
    found = calls.orbits(ball, n, amplitude=amplitude)
    if index is None:
        return {"orbits": [_orbit(each) for each in found]} | law_of(ball)
    if index > len(found):
        raise NoOrbitError(
            f"no orbit {index}: {ball.label} has {len(found)} {n}-T orbits at Λ = {amplitude:g}"
        )
    return _orbit(found[index - 1]) | law_of(ball)


def _orbit(found: Orbit) -> Answer:
    """The observables of an orbit, its stability, and the largest defect of its equations."""
    return {
        **{name: float(getattr(found, name)) for name in OBSERVABLES if name != "amplitude"},
        "multipliers": [[x.real, x.imag] for x in multipliers(found).tolist()],
        "is_stable": bool(found.stable),
        "is_admissible": bool(found.admissible),
        "residual": _known(defect(found)),
    }


def _known(value: Any) -> float | None:
    """A number, or None if it does not exist."""
    return float(value) if np.isfinite(value) else None


def limits_options(parser: Parser) -> None:
    """Add the options of :func:`limits`."""
    add_number(parser, "n", FAMILY, meanings(calls.limits)["n"], default=1)
    add_ball(parser)


def limits(*, n: int, **impact: Any) -> Answer:
    """Saddle-node and period doubling of a family, and whether their orbits are admissible.

    Raises
    ------
    NoOrbitError
        If the branch has no saddle-node or no period doubling.
    """
    ball = ball_of(**impact)
    found: Any = calls.limits(ball, n)
    answer: Answer = {}
    for name, end in found._asdict().items():
        if not end.exists:
            kind = Bifurcation[name.upper()]
            raise NoOrbitError(
                f"no {kind} was found on the branch of {n}-T orbits for {ball.label}"
            )
        answer[name] = {key: float(getattr(end, key)) for key in OBSERVABLES[:3]}
        answer[name]["is_admissible"] = bool(end.admissible)
    return answer | law_of(ball)


def branch_options(parser: Parser) -> None:
    """Add the options of :func:`branch`."""
    from bouncing_ball_beyond.inherited.periodic import (
        branches,  # It needs xarray, and no other command does.
    )

    texts = meanings(branches.branch)
    add_number(parser, "n", FAMILY, texts["n"], default=1)
    add_number(parser, "amplitude_max", POSITIVE, texts["amplitude_max"])
    add_ball(parser)


def branch(*, n: int, amplitude_max: float | None, **impact: Any) -> Answer:
    """The special orbits on a branch in order, from the unstable to the stable side, and its ends.

    Raises
    ------
    NoOrbitError
        If there is no branch up to this Λ, or if it cannot be followed.
    """
    from bouncing_ball_beyond.inherited.periodic import branches

    ball = ball_of(**impact)
    found = branches.branch(ball, n, amplitude_max=amplitude_max)
    special = [
        {
            "kind": str(found.special_kind.values[k]),
            **{name: float(found[f"special_{name}"].values[k]) for name in branches.PLACE},
        }
        for k in range(found.sizes["special"])
    ]
    ends = {str(each.end.item()).replace(" ", "_"): str(each.item()) for each in found.end_reason}
    return {"orbits": special, **ends} | law_of(ball)


# Accuracy and permanent contact.


def permanent_contact_options(parser: Parser) -> None:
    """Add the options of :func:`permanent_contact`."""
    text = meanings(spring_damper)["frequency_ratio"]
    add_number(parser, "frequency_ratio", FREQUENCY_RATIO, text, required=True)
    add_contact(parser)


def permanent_contact(*, release: ReleaseName | None, **contact: Any) -> Answer:
    """The Λ up to which the ball stays on the table."""
    ball = spring_damper(release=release or "displacement", **contact)
    return {"threshold_amplitude": float(ball.permanent_contact_threshold()), **law_of(ball)}


def thresholds_options(parser: Parser) -> None:
    """Add the options of :func:`thresholds`."""
    texts = meanings(error_thresholds)
    add_number(parser, "n", FAMILY, texts["n"], default=1)
    add_number(parser, "amplitude", AMPLITUDE_OF_ORBIT, texts["amplitude"], required=True)
    add_number(parser, "tolerance", TOLERANCE, texts["tolerance"], default=0.01)
    add_number(
        parser, "restitution", RESTITUTION, meanings(spring_damper)["restitution"], required=True
    )


def thresholds(*, n: int, amplitude: float, tolerance: float, restitution: float) -> Answer:
    """The ϖ from which on each error of the restitution model is tolerable, or a status."""
    found = error_thresholds(
        rigid(restitution=restitution),
        n,
        amplitude=amplitude,
        tolerance=tolerance,
    )
    pairs = zip(found.error_threshold.values, found.threshold_status.values, strict=True)
    told = [_known(ratio) if status == "found" else str(status) for ratio, status in pairs]
    return dict(zip(found.quantity.values.tolist(), told, strict=True))


# Balls over time.


def simulate_options(parser: Parser) -> None:
    """Add the options of :func:`simulate`."""
    texts = meanings(history.simulate)
    add_number(parser, "amplitude", AMPLITUDE, texts["amplitude"], required=True)
    add_number(parser, "phase", START, texts["phase"], default=0.0)
    add_number(parser, "velocity", START, texts["velocity"], default=-math.pi)
    add_number(parser, "impacts", IMPACTS, texts["impacts"], default=100)
    add_ball(parser)


def note_on(phase: float) -> Answer:
    """A note if a phase is beyond one turn, because it may have been meant in degrees.

    Examples
    --------
    >>> note_on(400.0)["note"]
    'phase 400 is in radians, 63.66 turns of the table; 400 degrees are 6.981'
    >>> note_on(-6.28)
    {}
    """
    if abs(phase) <= 2 * math.pi:
        return {}
    turns = f"phase {phase:g} is in radians, {phase / (2 * math.pi):.4g} turns of the table"
    return {"note": f"{turns}; {phase:g} degrees are {math.radians(phase):.4g}"}


def simulate(
    *, amplitude: float, phase: float, velocity: float, impacts: int, **impact: Any
) -> Answer:
    """The sequence of impacts of one ball as lists, with null for an event that does not happen."""
    ball = ball_of(**impact)
    found = impacts_of(ball, amplitude, phase, velocity, impacts)
    columns = np.array([getattr(found, name)[:, 0] for name in _SHOWN])
    there = columns[:, np.isfinite(found.time[:, 0])]
    sequence = [[_known(x) for x in column] for column in there.tolist()]
    return {
        **note_on(phase),
        "status": Status(int(found.status[0])).words,
        **law_of(ball),
        "sequence": dict(zip(_SHOWN, sequence, strict=True)),
    }

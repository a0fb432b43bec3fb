"""Types of parameters that need an orbit: amplitudes at which there is one, contacts that have one.

A type looks at the parameters that stand before it in its class: ``n`` and ``restitution``, and for
a contact ``amplitude``.
"""

from collections.abc import Iterable
from typing import Annotated

from pydantic import AfterValidator, Field, ValidationInfo

from bouncing_ball.contacts.spring_damper import SpringDamper
from bouncing_ball.errors import NoOrbitError
from bouncing_ball.orbits.restitution_orbit import period_doubling, saddle_node
from bouncing_ball.orbits.spring_damper_model import SpringDamperModel
from bouncing_ball.parameters import (
    Amplitude,
    AmplitudeMax,
    Family,
    FrequencyRatio,
    Parameters,
    Restitution,
)


def _known(info: ValidationInfo, *names: str) -> bool:
    """Whether the parameters before are right; if not, they are the mistake."""
    return all(name in info.data for name in names)


def _require(amplitude: float, lowest: float, what: str, n: int, restitution: float) -> None:
    if amplitude < lowest:
        raise ValueError(
            f"must be at least {lowest:.6g}, the {what} of the {n}-T restitution orbit at "
            f"r = {restitution:g} (Eqs. 7-8)"
        )


def require_orbit(amplitude: float, n: int, restitution: float) -> float:
    """The amplitude, if the restitution model has its n-T orbit there.

    Raises
    ------
    ValueError
        One line that says from which amplitude on (Eq. 7).

    Examples
    --------
    >>> require_orbit(1.0, 1, 0.85)
    1.0
    """
    _require(amplitude, float(saddle_node(n, restitution)), "saddle-node", n, restitution)
    return amplitude


def _families(info: ValidationInfo) -> list[int]:
    n = info.data["n"]
    return list(n) if isinstance(n, Iterable) else [n]


def _has_an_orbit(amplitude: float, info: ValidationInfo) -> float:
    # What is shown at several Λ shows the orbits that there are.
    if _known(info, "n", "restitution"):
        require_orbit(amplitude, min(_families(info)), info.data["restitution"])
    return amplitude


def _has_all_orbits(amplitude: float, info: ValidationInfo) -> float:
    # The branch of the highest family starts last.
    if _known(info, "n", "restitution"):
        require_orbit(amplitude, max(_families(info)), info.data["restitution"])
    return amplitude


def _has_all_ranges(amplitude: float, info: ValidationInfo) -> float:
    if _known(info, "n", "restitution"):
        n, r = max(_families(info)), info.data["restitution"]
        lowest = 1.1 * float(period_doubling(n, r))
        _require(amplitude, lowest, "period doubling, with a tenth to spare,", n, r)
    return amplitude


def _has_a_motion(ratio: float, info: ValidationInfo) -> float:
    """The ϖ, if the orbit on this contact is a motion of the ball; asked with a release rule."""
    if info.context and _known(info, "n", "restitution", "amplitude"):
        given = info.data
        contact = SpringDamper.from_restitution(
            given["restitution"], ratio, info.context["release"]
        )
        try:
            SpringDamperModel(contact).require_admissible(given["n"], given["amplitude"])
        except NoOrbitError as error:
            raise ValueError(str(error)) from None
    return ratio


OrbitAmplitude = Annotated[Amplitude, AfterValidator(_has_an_orbit)]
"""Λ at which the family, or the lowest of several, has an orbit."""


class OrbitParameters(Parameters):
    """One orbit that the restitution model has too."""

    n: Family
    restitution: Restitution
    amplitude: OrbitAmplitude


BranchEnd = Annotated[AmplitudeMax, AfterValidator(_has_all_orbits)]
"""Λ up to which branches are followed, above where the highest family begins."""
RangeEnd = Annotated[AmplitudeMax, AfterValidator(_has_all_ranges)]
"""Λ up to which branches are followed, above where the highest family loses its stability."""
MotionRatio = Annotated[FrequencyRatio, AfterValidator(_has_a_motion)]
"""ϖ of a contact on which the orbit is a motion of the ball, which can be drawn over time."""
Points = Annotated[
    int,
    Field(
        ge=11, le=20001, description="points along each branch; fewer than 11 do not show its shape"
    ),
]

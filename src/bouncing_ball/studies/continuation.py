"""The continuation of n-T orbits of the spring-damper model, by the method of the paper.

The continuation starts from the orbit of the restitution model at a very stiff contact, follows
the orbit along ϖ to the contact in question, and then follows the branch along Λ to both sides.
"""

from typing import Annotated

import numpy as np

from bouncing_ball.contacts.release import Release
from bouncing_ball.contacts.spring_damper import SpringDamper
from bouncing_ball.continuation.branch import (
    Branch,
    ContinuationError,
    End,
    continue_branch,
    solve_at,
)
from bouncing_ball.continuation.events import Event, fold, parameter_bound
from bouncing_ball.continuation.step_control import StepControl
from bouncing_ball.errors import NoOrbitError
from bouncing_ball.orbits.columns import followed
from bouncing_ball.orbits.restitution_model import RestitutionModel
from bouncing_ball.orbits.spring_damper_model import SpringDamperModel
from bouncing_ball.orbits.spring_damper_system import SpringDamperSystem
from bouncing_ball.parameters import FrequencyRatio, Parameters, listed

_REACHED = End("target reached")


class Continuation(Parameters):
    """Where the continuation starts, and how long its steps are."""

    largest_step: Annotated[float, listed("largest_step")]
    stiff_frequency_ratio: Annotated[FrequencyRatio, listed("stiff_frequency_ratio")]


def _on_the_way(
    n: int, contact: SpringDamper, amplitude: float, continuation: Continuation
) -> np.ndarray:
    """(φ, z′_i, ϖ τ_b) of the orbit at Λ, followed along ln ϖ from a very stiff contact, shape
    (3,).

    Raises
    ------
    ContinuationError
        If there is no orbit near that of the restitution model, or if the branch turns back to
        stiffer contacts or leaves the domain of the equations before ``contact``.
    """
    omega = float(contact.frequency_ratio)
    stiff = max(continuation.stiff_frequency_ratio, omega)
    towards = SpringDamperSystem(n, contact, amplitude)
    y = solve_at(towards, towards.guess(amplitude, stiff))
    if omega == stiff:
        return y[:-1]
    target = parameter_bound(np.log(omega), False, _REACHED.sentence)
    determinant = fold(towards).function
    side = np.sign(determinant(y))
    reason = "the branch turns back to stiffer contacts"
    turn = Event("turn", lambda y: side * determinant(y), terminal=True, reason=reason)
    ends = (event for event in towards.events() if event.terminal)
    way = continue_branch(
        towards,
        y,
        increasing=False,
        events=(*ends, turn, target),
        control=StepControl(largest=continuation.largest_step),
    )
    if way.end != _REACHED:
        raise ContinuationError(
            f"{n}-T orbit at Λ = {amplitude:.4g} followed from ϖ = {stiff:g} ends at "
            f"ϖ = {np.exp(way.points[-1, -1]):.4g}, before {omega:g}: {way.end}"
        )
    return way.points[-1, :-1]


def _start(
    n: int, contact: SpringDamper, restitution: float, top: float, continuation: Continuation
) -> np.ndarray:
    """A point of the branch along Λ of a contact, up to Λ = ``top``.

    Λ is half way between the two bifurcations of the restitution model's orbit, or between the
    saddle-node and ``top`` if ``top`` is below the period doubling. If this orbit cannot be
    followed to the contact, the branch starts from an orbit of the closed form.

    Raises
    ------
    NoOrbitError
        If the closed form has no orbit at any of the Λ that are tried either.
    """
    rigid = RestitutionModel(restitution)
    node, doubling = (float(x.amplitude) for x in (rigid.saddle_node(n), rigid.period_doubling(n)))
    way = (node + min(doubling, top)) / 2
    try:
        return np.append(_on_the_way(n, contact, way, continuation), way)
    except ContinuationError:
        model = SpringDamperModel(contact)
        found = model.orbit(n, np.array([way, (node + top) / 2, top]))
    if not np.any(found.exists):
        raise NoOrbitError(
            f"neither the continuation from the restitution orbit nor the closed form finds a "
            f"{n}-T orbit of {model.label} up to Λ = {top:g}"
        )
    return model.system(n).point(found[np.argmax(found.exists)])


def branch_along_amplitude(
    n: int,
    restitution: float,
    frequency_ratio: float,
    amplitude_max: float,
    release: Release,
    continuation: Continuation,
) -> tuple[SpringDamperSystem, Branch]:
    """The n-T branch from one end to the other, up to Λ = ``amplitude_max``, with its special
    points.

    Parameters
    ----------
    n : int
        Index of the family.
    restitution, frequency_ratio : float
        r, which gives ζ by Eq. 16, and ϖ.
    amplitude_max : float
        Λ at which the branch ends.
    release : Release
    continuation : Continuation

    Returns
    -------
    system : SpringDamperSystem
        The equations, with y = (φ, z′_i, ϖ τ_b, Λ).
    branch : Branch
        Its solutions, from the unstable to the stable side.

    Raises
    ------
    NoOrbitError
        If there is no branch up to ``amplitude_max``.
    ContinuationError
        If the branch is not followed to its end.
    """
    contact = SpringDamper.from_restitution(restitution, frequency_ratio, release)
    system = SpringDamperModel(contact).system(n)
    start = _start(n, contact, restitution, amplitude_max, continuation)
    return system, followed(system, start, 0.0, amplitude_max, continuation.largest_step)

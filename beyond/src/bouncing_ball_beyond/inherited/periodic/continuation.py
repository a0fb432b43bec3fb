"""A branch of n-T orbits of the spring-damper model by continuation, in the paper's unknowns.

The paper solves the six equations :meth:`PaperEquations.residual` for six unknowns φ, z′_i, τ_b,
z′_b, A and B by a predictor and a corrector, with Λ as the parameter (Eqs. 21-26). Here the
unknowns are scaled to order one::

    y = (φ, z′_i, ϖτ_b, z′_b, ϖA, ϖB, Λ)

All equations are smooth also where a contact grazes its release or a flight the table, so that a
branch is followed beyond these points, where no ball follows the orbit. It ends at a given Λ, where
the impact or the release vanishes, or where the flight vanishes: there the orbit merges with
permanent contact, and the equations are singular.

Eq. 12 has no A and B at the undamped resonance, ζ = 0 and ϖ = 1.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from functools import cached_property, partial
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited import datasets
from bouncing_ball_beyond.inherited.errors import NoOrbitError
from bouncing_ball_beyond.inherited.models.damping import damped_frequency
from bouncing_ball_beyond.inherited.models.model import Model
from bouncing_ball_beyond.inherited.models.spring_damper import SpringDamper
from bouncing_ball_beyond.inherited.numerics.arrays import pick
from bouncing_ball_beyond.inherited.numerics.branch import (
    Branch,
    ContinuationError,
    End,
    EndKind,
    resample,
)
from bouncing_ball_beyond.inherited.numerics.events import Event, SpecialPoint, limit
from bouncing_ball_beyond.inherited.numerics.pseudo_arclength import continue_all_both_ways
from bouncing_ball_beyond.inherited.numerics.steps import StepControl, WithEvents
from bouncing_ball_beyond.inherited.periodic.explicit import explicit_branch
from bouncing_ball_beyond.inherited.periodic.orbit import (
    Bifurcation,
    Orbit,
    flight_margin,
    release_margin,
    trace_and_determinant,
)
from bouncing_ball_beyond.inherited.periodic.spring_damper_branch import SpringDamperBranch

LARGEST_STEP = 0.1
"""Default of the largest step in arclength: half of that of the paper's figures, for contacts of
which nothing is known beforehand."""
# The number of unknowns, and the places of φ, z′_i, ϖτ_b and Λ among them.
_COUNT = 7
_MEASURED = [0, 1, 2, 6]
# A branch ends at this speed of the impact or this flight time, and not at 0. Where the orbit
# merges with permanent contact both vanish together, and the equations are singular: rounding
# errors of 1e-16 are divided by both of them, and the margin limits each to about 1e-12.
_MARGIN = 1e-4
# The flight of an orbit that merges with permanent contact is this short where its impact is slow.
_SHORT_FLIGHT = 0.1
_LOWEST = 1e-4
# By default a branch ends at this multiple of the Λ of its period doubling.
_BEYOND_DOUBLING = 1.4
# Number of Λ at which an orbit to start from is sought.
_STARTS = 16


class Special(StrEnum):
    """The kinds of special orbits on a branch, beside the bifurcations."""

    SADDLE_NODE = datasets.SADDLE_NODE
    PERIOD_DOUBLING = datasets.PERIOD_DOUBLING
    GRAZING_FLIGHT = datasets.GRAZING_FLIGHT
    """A flight touches the table: beyond it there is an earlier impact."""
    GRAZING_RELEASE = datasets.GRAZING_RELEASE
    """A contact touches its release: beyond it there is an earlier release."""


_MERGES = "the flight vanishes: the orbit merges with permanent contact"
_GRAZES = "grazing of an impact: the ball lands with the speed of the table: an impact disappears"
_RELEASE_LOST = "release lost: the ball no longer leaves the table as the contact ends"


@dataclass(frozen=True)
class PaperEquations:
    """Eqs. 21-26 as a :class:`~bouncing_ball_beyond.inherited.numerics.corrector.Problem`, for one
    contact or for a row of contacts and families, which broadcasts with the leading shape of y.

    Examples
    --------
    The defects of an orbit that is known in closed form:

    >>> contact = SpringDamper(10.0, 0.05)
    >>> found = SpringDamperBranch(contact).orbit(1, 1.0)
    >>> equations = PaperEquations(contact, 1)
    >>> bool(np.max(np.abs(equations.residual(equations.point(found)))) < 1e-14)
    True
    """

    contact: SpringDamper
    n: Any

    def take(self, which: Any) -> Self:
        """The equations of some contacts of a row; those of a single one are the same."""
        return type(self)(self.contact.take(which), pick(np.asarray(self.n), which))

    @cached_property
    @np.errstate(divide="ignore", invalid="ignore")  # at the undamped resonance
    def _steady(self) -> tuple[Any, Any]:
        """β and χ - 1 of Eq. 12: the steady part of δ is ``Λ [β cos τ + (χ - 1) sin τ]``."""
        omega = self.contact.frequency_ratio
        loss = 2 * self.contact.damping_ratio * omega
        detuning = (omega - 1) * (omega + 1)
        gamma = detuning * detuning + loss * loss
        return -loss / gamma, detuning / gamma

    def _of_table(self, angle: np.ndarray) -> tuple[np.ndarray, ...]:
        """At a phase τ of a table with Λ = 1: cos τ, sin τ, ϖδ and δ′ of the steady part."""
        cosine = np.cos(angle)
        sine = np.sin(angle)
        beta, chi = self._steady
        displacement = self.contact.frequency_ratio * (beta * cosine + chi * sine)
        return cosine, sine, displacement, chi * cosine - beta * sine

    def _transient(self, theta: np.ndarray) -> np.ndarray:
        """The columns by ϖA and ϖB, and rows of ϖδ, of its derivative by ϖτ, and of the second
        derivative, of the transient after the time τ: shape (3, 2, ...).
        """
        zeta = self.contact.damping_ratio
        root = damped_frequency(zeta)
        decay = np.exp(-zeta * theta)
        cosine = decay * np.cos(root * theta)
        sine = decay * np.sin(root * theta)
        value = np.array([cosine, sine])
        rate = np.array([-zeta * cosine - root * sine, root * cosine - zeta * sine])
        return np.array([value, rate, -2 * zeta * rate - value])

    def residual(self, y: np.ndarray) -> np.ndarray:
        """The defects of the six equations, shape (..., 6).

        With the height Z in contact (Eqs. 12-13) and z in flight (Eqs. 14-15), the contact from
        τ_i to τ_b and the next impact at τ_2 the paper has ::

            Z(τ_i, φ, A, B) = Λ sin(τ_i + φ)            (21)  the contact begins on the table
            Z′(τ_i, φ, A, B) = z′_i                     (22)  with the velocity of the impact,
            Z(τ_b, φ, A, B) = Λ sin(τ_b + φ)            (23)  and it ends there
            Z′(τ_b, φ, A, B) = z′_b                     (24)  with the velocity of the bounce;
            z(τ_b, z′_b, φ, τ_2) = Λ sin(τ_2 + φ)       (25)  the flight ends on the table
            z′(τ_b, z′_b, φ, τ_2) = z′_2                (26)  with the velocity of the next impact,

        where τ_i = 0, τ_2 = 2πn and z′_2 = z′_i, because the motion repeats (Eqs. 18-20). With the
        force release Eq. 23 is δ + κ δ′ = 0. Heights in contact are those over the table, times ϖ.
        """
        phase, impact, theta, bounce, a, b, amplitude = np.moveaxis(y, -1, 0)
        omega = self.contact.frequency_ratio
        zeta = self.contact.damping_ratio
        lag = self.contact.lag
        time = theta / omega
        flight = 2 * np.pi * self.n - time
        cosine, sine, swing, swing_rate = self._of_table(phase)
        cosine_b, sine_b, swing_b, swing_rate_b = self._of_table(phase + time)
        (of_a, of_b), (rate_of_a, rate_of_b), _ = self._transient(theta)
        closing = damped_frequency(zeta) * b - zeta * a + amplitude * swing_rate
        leaving = rate_of_a * a + rate_of_b * b + amplitude * swing_rate_b
        gap = of_a * a + of_b * b + amplitude * swing_b - 1 / omega
        left = amplitude * sine_b - lag * (bounce - amplitude * cosine_b)
        return np.stack(
            [
                a + amplitude * swing - 1 / omega,  # (21)
                closing + amplitude * cosine - impact,  # (22)
                gap + omega * lag * leaving,  # (23)
                leaving + amplitude * cosine_b - bounce,  # (24)
                left + bounce * flight - flight * flight / 2 - amplitude * sine,  # (25)
                bounce - flight - impact,  # (26)
            ],
            axis=-1,
        )

    def jacobian(self, y: np.ndarray) -> np.ndarray:
        """The derivatives of the residual by y, shape (..., 6, 7)."""
        phase, _, theta, bounce, a, b, amplitude = np.moveaxis(y, -1, 0)
        omega = self.contact.frequency_ratio
        zeta = self.contact.damping_ratio
        lag = self.contact.lag
        weight = omega * lag
        time = theta / omega
        flight = 2 * np.pi * self.n - time
        cosine, sine, swing, swing_rate = self._of_table(phase)
        cosine_b, sine_b, swing_b, swing_rate_b = self._of_table(phase + time)
        (of_a, of_b), (rate_of_a, rate_of_b), (bend_of_a, bend_of_b) = self._transient(theta)
        # The derivative of the steady ϖδ by the phase is ϖδ′, and that of δ′ is -δ.
        leaving = rate_of_a * a + rate_of_b * b + amplitude * swing_rate_b
        leaving_by_phase = -amplitude * swing_b / omega
        leaving_by_theta = bend_of_a * a + bend_of_b * b + leaving_by_phase / omega
        # The table's height at the release with κ times its velocity.
        level_rate = amplitude * (cosine_b - lag * sine_b)
        matrix = np.zeros((*y.shape[:-1], 6, 7))
        entries: dict[tuple[int, int], Any] = {
            (0, 0): amplitude * omega * swing_rate,
            (0, 4): 1.0,
            (0, 6): swing,
            (1, 0): -amplitude * (swing / omega + sine),
            (1, 1): -1.0,
            (1, 4): -zeta,
            (1, 5): damped_frequency(zeta),
            (1, 6): swing_rate + cosine,
            (2, 0): amplitude * omega * swing_rate_b + weight * leaving_by_phase,
            (2, 2): leaving + weight * leaving_by_theta,
            (2, 4): of_a + weight * rate_of_a,
            (2, 5): of_b + weight * rate_of_b,
            (2, 6): swing_b + weight * swing_rate_b,
            (3, 0): leaving_by_phase - amplitude * sine_b,
            (3, 2): leaving_by_theta - amplitude * sine_b / omega,
            (3, 3): -1.0,
            (3, 4): rate_of_a,
            (3, 5): rate_of_b,
            (3, 6): swing_rate_b + cosine_b,
            (4, 0): level_rate - amplitude * cosine,
            (4, 2): (level_rate - bounce + flight) / omega,
            (4, 3): flight - lag,
            (4, 6): sine_b + lag * cosine_b - sine,
            (5, 1): -1.0,
            (5, 2): 1 / omega,
            (5, 3): 1.0,
        }
        for (row, column), value in entries.items():
            matrix[..., row, column] = value
        return matrix

    def orbit(self, y: np.ndarray) -> Orbit:
        """The orbits at y, of its leading shape."""
        phase, impact, theta, _, _, _, amplitude = np.moveaxis(y, -1, 0)
        duration = theta / self.contact.frequency_ratio
        return Orbit(self.contact, self.n, amplitude, phase, duration, impact)

    def point(self, orbit: Orbit) -> np.ndarray:
        """y of orbits, of their shape with a last axis: A and B of Eq. 12 follow from the start of
        the contact, Eqs. 21 and 22.
        """
        omega = self.contact.frequency_ratio
        zeta = self.contact.damping_ratio
        lam = np.asarray(orbit.amplitude)
        cosine, _, swing, swing_rate = self._of_table(np.asarray(orbit.phase))
        a = 1 / omega - lam * swing
        closing = orbit.impact_velocity - lam * (cosine + swing_rate)
        b = (closing + zeta * a) / damped_frequency(zeta)
        theta = omega * np.asarray(orbit.contact_duration)
        unknowns = orbit.phase, orbit.impact_velocity, theta, orbit.bounce_velocity, a, b, lam
        return np.stack(np.broadcast_arrays(*unknowns), axis=-1)

    def test(self, kind: Bifurcation, y: np.ndarray) -> np.ndarray:
        """The test function of a bifurcation."""
        return kind.test(*trace_and_determinant(self.orbit(y)))


def _events(equations: PaperEquations, top: float, ends: Sequence[str]) -> list[Event]:
    """The special orbits on a branch, and what ends it; also at the bifurcations in ``ends``."""

    def impact_speed(y: np.ndarray) -> np.ndarray:
        return -equations.orbit(y).relative_impact_velocity - _MARGIN

    def opening(y: np.ndarray) -> np.ndarray:
        orbit = equations.orbit(y)
        start = orbit.phase, orbit.relative_impact_velocity, orbit.amplitude
        return equations.contact.opening_rate(orbit.contact_duration, *start)

    def in_a_row(margin: Any) -> Any:
        """A margin of orbits at y of any leading shape."""

        def function(y: np.ndarray) -> np.ndarray:
            orbit = equations.orbit(np.atleast_2d(y))
            return margin(orbit.flat(orbit.shape)).reshape(y.shape[:-1])

        return function

    up = np.eye(_COUNT)[-1]
    return [
        *(
            Event(kind, partial(equations.test, kind), terminal=kind in ends)
            for kind in Bifurcation
        ),
        Event(Special.GRAZING_FLIGHT, in_a_row(flight_margin)),
        Event(Special.GRAZING_RELEASE, in_a_row(release_margin)),
        Event("impact", impact_speed, terminal=True, reason=_GRAZES),
        Event("release", opening, terminal=True, reason=_RELEASE_LOST),
        Event(
            "flight",
            lambda y: equations.orbit(y).flight_time - _MARGIN,
            terminal=True,
            reason=_MERGES,
        ),
        limit("top", -up, -top, f"amplitude = {top:g} is reached"),
        limit("bottom", up, _LOWEST, f"amplitude = {_LOWEST:g} is reached"),
    ]


@dataclass(frozen=True)
class OrbitBranch:
    """A branch of n-T orbits: its equations, and the points and special points found."""

    equations: PaperEquations
    branch: Branch

    @property
    def special(self) -> list[SpecialPoint]:
        """The special orbits in order along the branch."""
        return [each for each in self.branch.special if each.name in list(Special)]

    def measured(self, y: np.ndarray) -> np.ndarray:
        """φ, z′_i, ϖτ_b and Λ, which determine the other unknowns."""
        return y[..., _MEASURED]

    def at_equal_steps(self, count: int) -> np.ndarray:
        """So many points at equal steps of arclength in φ, z′_i, ϖτ_b and Λ, shape (count, 7).

        Raises
        ------
        ContinuationError
            If the steps along the branch were too long for it.
        """
        return resample(self.equations, self.branch, count, self.measured)


NoBranch = NoOrbitError | ContinuationError
"""Why there is no branch, as an error that is a value."""


def follow_branches(
    contacts: SpringDamper,
    n: ArrayLike,
    amplitude_max: float,
    largest_step: float = LARGEST_STEP,
    ends: Sequence[str] = (),
) -> list[OrbitBranch | NoBranch]:
    """The branches of a row of contacts, side by side, from one end to the other.

    Each is followed to both sides from the orbit in the middle of the stable range, or from the
    orbit at the nearest Λ that has one.

    Parameters
    ----------
    contacts : SpringDamper, shape (branches,)
    n : array_like of int, shape (branches,)
        Index of the family of each branch.
    amplitude_max : float
        Λ at which all branches end.
    largest_step : float
        Largest step in arclength.
    ends : sequence of str
        The bifurcations at which a branch is not followed any further.

    Returns
    -------
    list of OrbitBranch
        From the unstable to the stable side, with an error in place of a branch that cannot be
        followed.

    Examples
    --------
    >>> (found,) = follow_branches(SpringDamper([10.0], 0.05), [1], 1.2)
    >>> [(str(each.name), round(float(each.point[-1]), 2)) for each in found.special]
    [('saddle-node', 0.23), ('period doubling', 1.04)]
    >>> str(found.branch.end)
    'amplitude = 1.2 is reached'
    """
    family = np.asarray(n)
    branch = SpringDamperBranch(contacts)
    low = branch.bifurcation(Bifurcation.SADDLE_NODE, family).amplitude
    starts = _starts(branch, family, np.where(low > 0, low, 0.0), amplitude_max)
    equations = PaperEquations(contacts, family)

    def tested(which: Any) -> WithEvents:
        part = equations.take(which)
        return WithEvents(part, _events(part, amplitude_max, ends))

    points = list(equations.point(starts))
    with np.errstate(all="ignore"):
        found = continue_all_both_ways(tested, points, StepControl(largest=largest_step))
    branches: list[OrbitBranch | NoBranch] = []
    for k, each in enumerate(found):
        if not starts.exists[k]:
            none = f"no {family[k]}-T orbit up to Λ = {amplitude_max:g} for {contacts[k].label}"
            begins = f"{none}: the branch begins at Λ = {low[k]:.6g}"
            reason = begins if low[k] >= amplitude_max else f"{none} was found to start from"
            branches.append(NoOrbitError(reason))
        elif isinstance(each, ContinuationError):
            branches.append(each)
        else:
            branches.append(_finished(equations.take(k), each))
    return branches


def _starts(branch: SpringDamperBranch, n: np.ndarray, low: np.ndarray, top: float) -> Orbit:
    """The orbit of each family in the middle of its stable range, or at the nearest of several Λ
    that has one.
    """
    doubling = branch.bifurcation(Bifurcation.PERIOD_DOUBLING, n).amplitude
    stable = np.fmin(doubling, top)
    middle = (low + np.where(stable > low, stable, top)) / 2
    others = np.linspace(low, top, _STARTS + 1, axis=-1)[:, 1:]
    nearest_first = np.argsort(np.abs(others - middle[:, np.newaxis]), axis=-1)
    others = np.take_along_axis(others, nearest_first, axis=-1)
    amplitude = np.concatenate([middle[:, np.newaxis], others], axis=-1)
    amplitude = np.where(low[:, np.newaxis] < top, amplitude, np.nan)
    columns = SpringDamperBranch(branch.model[:, np.newaxis])
    orbits = columns.orbit(n[:, np.newaxis], amplitude)
    first = np.argmax(orbits.exists, axis=-1)
    return orbits[np.arange(n.size), first]


def _finished(equations: PaperEquations, branch: Branch) -> OrbitBranch | ContinuationError:
    """A branch with the reasons for its ends, or an error if it is not followed to its ends."""
    for end in (branch.start, branch.end):
        if end.kind is EndKind.POINTS:
            return ContinuationError(f"the branch is not followed to its end: {end}")
    ends = zip((branch.start, branch.end), branch.points[[0, -1]], strict=True)
    start, end = (_explained(equations, *each) for each in ends)
    return OrbitBranch(
        equations, Branch(branch.points, branch.tangents, branch.special, start, end)
    )


def _explained(equations: PaperEquations, end: End, point: np.ndarray) -> End:
    """An end with its reason: where the impact and the flight vanish together, or nearly, the orbit
    merges with permanent contact.
    """
    flight = float(equations.orbit(point).flight_time)
    singular = end.stuck or end.event == "impact"
    return End(_MERGES, event="flight") if singular and flight < _SHORT_FLIGHT else end


def default_top(model: Model, n: int) -> float:
    """The largest Λ of a branch if none is given: 1.4 times that of its period doubling.

    If there is no period doubling above the saddle-node, the place of its Λ takes twice that of the
    saddle-node, or 1 if this is more.
    """
    branch = explicit_branch(model)
    fold = float(branch.bifurcation(Bifurcation.SADDLE_NODE, n).amplitude)
    doubling = float(branch.bifurcation(Bifurcation.PERIOD_DOUBLING, n).amplitude)
    low = fold if fold > 0 else 0.0
    return _BEYOND_DOUBLING * (doubling if doubling > low else max(2 * low, 1.0))

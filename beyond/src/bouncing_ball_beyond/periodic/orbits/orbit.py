"""A periodic orbit of any model, or an array of orbits.

An orbit has k impacts in m periods of the table; an n-T orbit of the paper has one impact in n
periods. An impact is the start of a contact, at the phase φ of the table. The contact lasts for
D = τ_b, and the flight after it ends at the next impact. Heights and velocities are absolute unless
they are called relative, which means relative to the table: δ = z - w.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from bouncing_ball_beyond.inherited.numerics.arrays import in_words
from bouncing_ball_beyond.inherited.numerics.elementary import reduce_angle
from bouncing_ball_beyond.inherited.periodic.orbit import OBSERVABLES
from bouncing_ball_beyond.periodic.orbits import motion, stability
from bouncing_ball_beyond.periodic.orbits.impacts import (
    OrbitImpacts,
    equations_of,
    flights,
    number_or_row,
    of_existing,
    of_impacts,
)
from bouncing_ball_beyond.periodic.orbits.problem import OrbitEquations
from bouncing_ball_beyond.periodic.orbits.simulation import is_admissible

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from bouncing_ball_beyond.drawing.result import Result

_EPS = np.finfo(float).eps


@dataclass(frozen=True, repr=False, eq=False)
class Orbit(OrbitImpacts):
    """Orbits with k impacts in m periods of one model.

    The quantities of an impact, such as :attr:`phase`, have the shape of the orbits if k = 1, and
    otherwise a last axis with an entry for each impact; those of a single orbit are floats or
    arrays of shape (k,).

    Parameters
    ----------
    model : Model
        A single model, or a model for each orbit.
    amplitude : float or array
        Λ.
    turns : array of int
        The whole turns of the table between the impacts, shape (..., k) or (k,): the impact after
        impact i is later by ``φ_{i+1} - φ_i + 2π turns_i``, and m is their sum.
    phases, velocities, durations : array
        φ, the absolute velocity z′_i of the ball, and D of the contacts, shape (..., k). D is 0 for
        an instantaneous impact, and NaN where there is no orbit.
    resumes : array of bool
        Which contacts resume below the level of the table, shape (k,); by default none.
    kind : str
        The kind of a special orbit, such as "saddle-node"; empty for an ordinary orbit.
    along : tuple of str
        The parameters of the branch or curve from which the orbit comes.

    Examples
    --------
    The restitution model's orbit at φ = π/2, where an elastic ball bounces on the resting table:

    >>> from bouncing_ball_beyond.models.rigid import RestitutionModel
    >>> orbit = Orbit.of(RestitutionModel(1.0), 1, 0.5, np.pi / 2)
    >>> orbit.bounce_velocity == np.pi, orbit.is_stable(), orbit.is_admissible()
    (True, False, True)
    """

    def __repr__(self) -> str:
        counts = ("n",) if self.impacts == 1 else ("impacts", "periods")
        kind = ("kind",) if self.kind else ()
        # Called as in the ball: "restitution", or "law" of a contact.
        law = fields(self.model)[0].name
        named = {law: self.law} | {name: getattr(self, name) for name in OBSERVABLES}
        named = {name: getattr(self, name) for name in (*kind, *counts)} | named
        return "\n".join(
            [type(self).__name__, *(f"  {name:<22}{in_words(x)}" for name, x in named.items())]
        )

    @property
    def bounce_height(self) -> Any:
        """Absolute height z_b of the ball at release."""
        return of_impacts(motion.release_heights(self))

    @property
    def max_height(self) -> Any:
        """Greatest absolute height z over the orbit: max z of Eq. 37.

        As that of the inherited orbit it is the apex of a flight, here of the highest, unless the
        table lifts the ball higher during a long contact.
        """
        return motion.max_height(self)

    path = motion.path

    def history(self, samples: int = 200) -> Result:
        """A single orbit over one repetition, from its first impact on.

        Parameters
        ----------
        samples : int
            Number of samples in each period of the table.

        Returns
        -------
        Result
            The variables of :func:`bouncing_ball_beyond.history`.

        Raises
        ------
        ModelError
            If there are several orbits or none, or if the number of samples is out of range.

        Examples
        --------
        >>> from bouncing_ball_beyond.models.rigid import RestitutionModel
        >>> orbit = Orbit.of(RestitutionModel(1.0), 1, 0.5, np.pi / 2)
        >>> orbit.history(samples=2).ball.values - 0.5 == np.array([0.0, np.pi**2 / 2, 0.0])
        array([ True,  True,  True])
        """
        # Imported here, because a single orbit needs no labels.
        from bouncing_ball_beyond.periodic.orbits.saved import history_of

        return history_of(self, samples)

    def plot(
        self,
        path: str | Path | None = None,
        *,
        ax: Axes | None = None,
        size: tuple[float, float] | None = None,
        font_size: float | None = None,
    ) -> Figure:
        """A single orbit as a figure: the heights of ball and table over one repetition.

        The parameters and the errors are those of the ``plot`` of a result, such as that of
        :meth:`history`.
        """
        return self.history().plot(path, ax=ax, size=size, font_size=font_size)

    def to_dataset(self) -> xr.Dataset:
        """The orbit, or a row of orbits, as a labelled dataset with the model and its parameters.

        :func:`bouncing_ball_beyond.read_orbits` makes equal orbits from it, also from a netCDF file
        of it.

        Examples
        --------
        >>> from bouncing_ball_beyond import read_orbits
        >>> from bouncing_ball_beyond.models.rigid import RestitutionModel
        >>> orbit = Orbit.of(RestitutionModel(0.5), 1, 1.5, 0.7)
        >>> read_orbits(orbit.to_dataset()) == orbit
        True
        """
        # Imported here, because a single orbit needs no labels.
        from bouncing_ball_beyond.periodic.orbits.saved import dataset_of

        return dataset_of(self)

    # Stability and admissibility.

    def monodromy(self) -> np.ndarray:
        """Jacobian of the return map at the first impact, shape (..., 2, 2).

        It is that of the state on the Poincaré section of the model: the phase and δ′ at the start
        of contact, or at the instant of the corrected model. Its eigenvalues are the Floquet
        multipliers.
        """

        def matrix(part: OrbitImpacts) -> np.ndarray:
            problem, y = part.own_equations
            rows = np.stack(problem.monodromy(y), axis=-1)
            return rows if part.shape else rows.reshape(4)

        return of_existing(self, matrix, 4).reshape(*self.shape, 2, 2)

    def trace_and_determinant(self) -> tuple[Any, Any]:
        """Trace and determinant of the monodromy, each with the shape of the orbits; the latter is
        from the contraction of areas in the contacts.
        """

        def both(part: OrbitImpacts) -> np.ndarray:
            problem, y = part.own_equations
            return np.stack(problem.trace_and_determinant(y), axis=-1)

        trace, determinant = np.moveaxis(of_existing(self, both, 2), -1, 0)
        return number_or_row(trace), number_or_row(determinant)

    def multipliers(self) -> np.ndarray:
        """Floquet multipliers, complex, shape (..., 2); that of larger modulus comes first."""
        return stability.multipliers(*self.trace_and_determinant())

    def is_stable(self) -> Any:
        """Whether both multipliers lie inside the unit circle: asymptotic stability."""
        return number_or_row(stability.is_stable(*self.trace_and_determinant()))

    def is_neutral(self) -> Any:
        """Whether both multipliers lie on the unit circle, and are no ±1, up to rounding: an orbit
        of a ball without dissipation, r = 1 or ζ = 0, that is not unstable. It is not stable.
        """
        return number_or_row(stability.is_neutral(*self.trace_and_determinant()))

    def is_admissible(self) -> Any:
        """Whether the simulated ball follows the orbit, without an earlier release or landing.

        The events of the simulation are certified. The result is False where there is no orbit.
        Next to an orbit of which a flight or an impact vanishes, the result is that of rounding:
        there it may change from one point of a branch to the next.
        """

        def judged(part: OrbitImpacts) -> np.ndarray:
            possible = np.all((part.durations >= 0) & (flights(part) > 0), axis=-1)
            return is_admissible(*part.own_equations) & possible

        return number_or_row(np.nan_to_num(of_existing(self, judged)) > 0)

    def defect(self) -> Any:
        """Largest absolute value of the defects of the equations."""

        def largest(part: OrbitImpacts) -> np.ndarray:
            problem, y = part.own_equations
            return largest_defect(problem.residual(y))

        return number_or_row(of_existing(self, largest))

    def digits_left(self) -> Any:
        """The number of decimal digits of the states that are certain; NaN where there is no orbit.

        The defects of the equations, and rounding errors of their terms, move the states by these
        errors over the smallest singular value of the Jacobian. The result is the logarithm of the
        largest state over this distance. An orbit of many impacts, or one next to a saddle-node,
        may have a small defect and few digits. The parameter of a special orbit is one of its
        unknowns.
        """

        def digits(part: OrbitImpacts) -> np.ndarray:
            problem, y = part.own_equations
            if part.kind:
                problem, y = equations_of(part, part.along[0])
            return certain_digits(y, *problem.equations_at(y))

        return number_or_row(of_existing(self, digits))

    def distance(self, other: Orbit) -> Any:
        """Largest difference to other orbits in Λ, φ, z′_i, and in D times π/D, which is about the
        frequency of the contact over that of the table.
        """
        turned = reduce_angle(self.phases - other.phases)
        lasts = np.where(self.durations > 0, self.durations, np.pi)
        longer = (self.durations - other.durations) * np.pi / lasts
        faster = self.velocities - other.velocities
        of_impacts = np.max(np.abs(np.broadcast_arrays(turned, longer, faster)), axis=(0, -1))
        larger = np.abs(np.asarray(self.amplitude) - other.amplitude)
        return number_or_row(np.maximum(of_impacts, larger))


def largest_defect(residual: np.ndarray) -> np.ndarray:
    """Largest absolute value of the defects of the equations, shape (...,) for (..., N)."""
    return np.max(np.abs(residual), axis=-1)


def certain_digits(y: np.ndarray, residual: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    """:meth:`Orbit.digits_left` of points y, with the defects and the Jacobian there."""
    # Next to a release without speed the slopes are infinite.
    with np.errstate(invalid="ignore", over="ignore"):
        matrix = np.nan_to_num(matrix)
        size = np.max(np.abs(matrix) @ np.abs(y)[..., np.newaxis], axis=(-2, -1))
    largest = np.max(np.abs(y), axis=-1)
    error = largest_defect(residual) + _EPS * size
    smallest = np.linalg.svd(matrix, compute_uv=False)[..., -1]
    with np.errstate(divide="ignore"):
        return np.maximum(np.log10(largest * smallest / error), 0.0)


def orbit_of_point(problem: OrbitEquations, y: np.ndarray, kind: str = "") -> Orbit:
    """The orbits at points y of a problem, with phases in [-π, π]."""
    legs = problem.legs(y)
    theta, v = problem.states(y)
    lam = problem.amplitude(y)
    along = problem.remembered
    turns = np.broadcast_to(problem.turns, theta.shape)
    if legs.dynamics is None:
        none = np.full(theta.shape, np.nan)
        return Orbit(problem.balls.model, lam, turns, none, none, none, along=along)
    with np.errstate(invalid="ignore"):
        delay = legs.dynamics.section().delay(legs.impact)
        started = theta - delay.reshape(theta.shape)
        phase = reduce_angle(started)
        whole = np.round((started - phase) / (2 * np.pi))
        of_table = lam[..., np.newaxis] * np.cos(phase)
        velocity = legs.impact.velocity.reshape(v.shape) + of_table
    shift = np.nan_to_num(np.roll(whole, -1, axis=-1) - whole).astype(int)
    balls = problem.at(y)
    return Orbit(
        model=balls.model,
        amplitude=lam if lam.ndim else float(lam),
        turns=turns + shift,
        phases=phase,
        velocities=velocity,
        durations=legs.duration,
        resumes=problem.resuming,
        kind=kind,
        along=along,
    )

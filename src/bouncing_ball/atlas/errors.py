r"""Signed relative errors of the simple models, and what the error law says of them.

The error of a quantity q is exact over simple minus one, as in
:mod:`bouncing_ball.accuracy.errors`. The simple model is asked at the Λ at
which the exact orbit is, its closed form being exact there too.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.accuracy import error_law
from bouncing_ball.accuracy.errors import SIMPLE as MODELS
from bouncing_ball.accuracy.errors import relative
from bouncing_ball.accuracy.quantities import OF_LIMITS, OF_ORBITS, Quantity
from bouncing_ball.atlas.plan import Nodes
from bouncing_ball.contacts.signature import Instant, Signature
from bouncing_ball.orbits import corrected_branch
from bouncing_ball.orbits.corrected_orbit import CorrectedOrbit
from bouncing_ball.orbits.orbit import Orbit
from bouncing_ball.orbits.restitution_model import RestitutionModel
from bouncing_ball.orbits.spring_damper_orbit import SpringDamperOrbit


class Law(NamedTuple):
    """The error law of the restitution model at the nodes, for ϖ = 1.

    The error is ``coefficient/ϖ^order``, with a remainder below
    ``remainder δ/ϖ²`` where ``δ = small/ϖ`` is below :data:`error_law.STATED`. Shapes
    (quantity, nodes), and (nodes,) of ``small``; orders (quantity, 1).
    """

    coefficient: np.ndarray
    order: np.ndarray
    remainder: np.ndarray
    small: np.ndarray


@dataclass(frozen=True, repr=False)
class _Known(Signature):
    """A signature that is known by its numbers, the same at every speed."""

    delay: np.ndarray
    restitution: np.ndarray
    load: np.ndarray
    duration: np.ndarray

    @property
    def is_constant(self) -> bool:
        """At every speed the same."""
        return True

    def __call__(self, speed: ArrayLike) -> Instant:
        return Instant(self.delay, self.restitution, self.load, self.duration)


def orbit_errors(orbit: SpringDamperOrbit, one: Instant, frequency_ratio: ArrayLike) -> np.ndarray:
    """Errors of the quantities of orbits, shape (model, quantity, ...); NaN without orbit.

    Parameters
    ----------
    orbit : SpringDamperOrbit
        The exact orbits.
    one : Instant
        The signature of their contacts at ϖ = 1; its times are in proportion to 1/ϖ.
    frequency_ratio : array_like
        ϖ of the orbits.

    Examples
    --------
    >>> from bouncing_ball.contacts.signature import LinearSignature
    >>> from bouncing_ball.contacts.spring_damper import SpringDamper
    >>> from bouncing_ball.orbits.spring_damper_limits import orbit_at
    >>> one = LinearSignature(SpringDamper(np.ones(1), 0.1))()
    >>> orbit = orbit_at(SpringDamper(np.array([100.0]), 0.1), 1, 1.0)
    >>> orbit_errors(orbit, one, 100.0).round(4)[:, 0].tolist()
    [[-0.0083], [-0.0]]
    """
    n, lam, r = orbit.n, orbit.amplitude, one.restitution
    delay, load, duration = (x / frequency_ratio for x in (one.delay, one.load, one.duration))
    psi = corrected_branch.instant_phase(n, Instant(delay, r, load, duration), lam)
    # Below its own saddle-node, or without exact orbit, a model has no orbit at all.
    simple: tuple[Orbit, Orbit] = (
        RestitutionModel(r).orbit(n, lam),
        CorrectedOrbit.at(n, _Known(delay, r, load, duration), lam, psi),
    )
    found = np.empty((len(MODELS), len(OF_ORBITS), *np.shape(lam)))
    for j, quantity in enumerate(OF_ORBITS):
        exact = getattr(orbit, quantity)
        for i, model in enumerate(simple):
            found[i, j] = relative(exact, getattr(model, quantity))
    return found


def orbit_law(nodes: Nodes) -> Law:
    """The error law of the quantities of orbits."""
    return _law(nodes, nodes.amplitude, OF_ORBITS)


def limit_law(nodes: Nodes, amplitude: np.ndarray) -> Law:
    """The error law of the quantities of the limits, δ at Λ, the period doubling's.

    That of the permanent contact is of the second order and has no stated remainder.
    """
    law = _law(nodes, amplitude, OF_LIMITS[:2])
    still = error_law.permanent_contact_coefficient(nodes.damping_ratio, nodes.release)
    return Law(
        np.concatenate([law.coefficient, [still]]),
        np.array([[1.0], [1.0], [2.0]]),
        np.concatenate([law.remainder, [np.full(still.shape, np.inf)]]),
        law.small,
    )


def _law(nodes: Nodes, amplitude: np.ndarray, quantities: tuple[Quantity, ...]) -> Law:
    arguments = nodes.n, nodes.instant, amplitude
    first, size = error_law.first_order(*arguments), error_law.scale(*arguments)
    remainder = [error_law.REMAINDER[q] * size[q] for q in quantities]
    return Law(
        np.stack([first[q] for q in quantities]),
        np.ones((len(quantities), 1)),
        np.stack(remainder),
        error_law.small_parameter(*arguments),
    )

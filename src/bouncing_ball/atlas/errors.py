"""Signed relative errors of the simple models at exact orbits, and what the law says of them.

The simple models are asked at the Λ at which the exact orbit is, their closed forms being
exact there too.
"""

from typing import NamedTuple

import numpy as np

from bouncing_ball.accuracy import error_law
from bouncing_ball.accuracy.errors import relative
from bouncing_ball.accuracy.quantities import OF_ORBITS
from bouncing_ball.atlas.plan import Nodes
from bouncing_ball.contacts.signature import LinearSignature
from bouncing_ball.orbits import corrected_branch
from bouncing_ball.orbits.corrected_orbit import CorrectedOrbit
from bouncing_ball.orbits.orbit import Orbit
from bouncing_ball.orbits.restitution_model import RestitutionModel
from bouncing_ball.orbits.spring_damper_orbit import SpringDamperOrbit


class Law(NamedTuple):
    """The error law of the restitution model at nodes, for ϖ = 1.

    The error is ``coefficient/ϖ`` with a remainder below ``remainder δ/ϖ`` where
    ``δ = small/ϖ`` is below :data:`~bouncing_ball.accuracy.error_law.STATED`. Shapes
    (quantity, nodes), and (nodes,) of ``small``.
    """

    coefficient: np.ndarray
    remainder: np.ndarray
    small: np.ndarray


def orbit_errors(orbit: SpringDamperOrbit) -> np.ndarray:
    """Errors of the quantities of exact orbits, shape (model, quantity, ...); NaN without orbit.

    As :func:`bouncing_ball.accuracy.errors.errors`, without a search for the corrected orbit:
    the signature of a linear contact is the same at every speed.

    Examples
    --------
    >>> from bouncing_ball.contacts.spring_damper import SpringDamper
    >>> from bouncing_ball.orbits.spring_damper_limits import orbit_at
    >>> orbit_errors(orbit_at(SpringDamper(100.0, 0.1), 1, 1.0)).round(4)[:, 0].tolist()
    [-0.0083, -0.0]
    """
    n, lam, signature = orbit.n, orbit.amplitude, LinearSignature(orbit.contact)
    psi = corrected_branch.instant_phase(n, signature(), lam)
    # Below its own saddle-node, or without exact orbit, a model has no orbit at all.
    simple: tuple[Orbit, Orbit] = (
        RestitutionModel(orbit.contact.restitution).orbit(n, lam),
        CorrectedOrbit.at(n, signature, lam, psi),
    )
    found = np.empty((len(simple), len(OF_ORBITS), *np.shape(lam)))
    for j, quantity in enumerate(OF_ORBITS):
        exact = getattr(orbit, quantity)
        for i, model in enumerate(simple):
            found[i, j] = relative(exact, getattr(model, quantity))
    return found


def orbit_law(nodes: Nodes) -> Law:
    """The error law of the quantities of orbits."""
    arguments = nodes.n, LinearSignature(nodes.contact(1.0))(), nodes.amplitude
    first, size = error_law.first_order(*arguments), error_law.scale(*arguments)
    return Law(
        np.stack([first[q] for q in OF_ORBITS]),
        np.stack([error_law.REMAINDER[q] * size[q] for q in OF_ORBITS]),
        error_law.small_parameter(*arguments),
    )

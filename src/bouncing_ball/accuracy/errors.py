r"""Relative errors of the simple models against the exact contact (Eqs. 37-38).

The error of a quantity is ``(q_SD - q)/q``, where q is the value in a simple model: the
restitution model or the corrected model. The error is signed; the paper uses its modulus.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.accuracy.quantities import OF_IMPACTS, OF_ORBITS, values
from bouncing_ball.contacts.spring_damper import SpringDamper
from bouncing_ball.orbits.corrected_model import CorrectedModel
from bouncing_ball.orbits.model import ImpactModel
from bouncing_ball.orbits.restitution_model import RestitutionModel
from bouncing_ball.orbits.spring_damper_model import SpringDamperModel
from bouncing_ball.orbits.spring_damper_orbit import SpringDamperOrbit

SIMPLE = ("restitution", "corrected")
"""The simple models, which are compared with the exact model."""


def models(contact: SpringDamper) -> tuple[SpringDamperModel, RestitutionModel, CorrectedModel]:
    """The exact model of a contact, and both simple models with the r of a free impact on it.

    Raises
    ------
    ModelError
        If ζ ≥ 1.

    Examples
    --------
    >>> [model.name for model in models(SpringDamper(5.0, 0.0))]
    ['spring-damper', 'restitution', 'corrected']
    """
    return (
        SpringDamperModel(contact),
        RestitutionModel(contact.restitution),
        CorrectedModel.of_contact(contact),
    )


def relative(exact: ArrayLike, simple: ArrayLike) -> np.ndarray:
    """Signed relative errors: the exact value minus the simple value, over the simple value.

    The error is NaN where a value is missing, and for 0/0. It is infinite where the simple value
    is 0, for example for the saddle-node at r = 1.

    Examples
    --------
    >>> relative([1.5, 1.0], [1.0, 0.0]).tolist()
    [0.5, inf]
    """
    exact, simple = np.asarray(exact, dtype=float), np.asarray(simple, dtype=float)
    with np.errstate(divide="ignore", invalid="ignore"):
        return (exact - simple) / simple


def modulus(error: ArrayLike) -> np.ndarray:
    """Modulus of errors; infinite for NaN, because a model that lacks a quantity is not accurate.

    Examples
    --------
    >>> modulus([-0.5, np.nan]).tolist()
    [0.5, inf]
    """
    return np.where(np.isnan(error), np.inf, np.abs(error))


def relative_errors(
    exact: ImpactModel,
    simple: Sequence[ImpactModel],
    n: ArrayLike,
    amplitude: ArrayLike,
    quantities: Sequence[str] = OF_IMPACTS,
) -> np.ndarray:
    """Signed relative errors of simple models, shape (model, quantity, ...).

    Parameters
    ----------
    exact : ImpactModel
    simple : sequence of ImpactModel
    n, amplitude : array_like
        Index of the family and Λ of the stable orbits; they broadcast with the models.
    quantities : sequence of str

    Returns
    -------
    ndarray
        NaN where a model has no such orbit or bifurcation.

    Examples
    --------
    Without damping, Λ_SD = 1 - 1/ϖ² above the resonance:

    >>> stiff = SpringDamperModel(SpringDamper.from_restitution(1.0, np.array([2.0])))
    >>> relative_errors(stiff, [RestitutionModel(1.0)], 1, 1.0, ["permanent_contact"]).tolist()
    [[[-0.25]]]
    """
    shape = np.broadcast_shapes(exact.shape, np.shape(n), np.shape(amplitude))
    wanted, *found = (values(model, n, amplitude, quantities) for model in (exact, *simple))
    pairs = ([relative(*pair) for pair in zip(wanted, each, strict=True)] for each in found)
    return np.stack([[np.broadcast_to(error, shape) for error in each] for each in pairs])


def errors(
    contact: SpringDamper,
    n: ArrayLike,
    amplitude: ArrayLike,
    quantities: Sequence[str] = OF_IMPACTS,
) -> np.ndarray:
    """Signed relative errors of both simple models on contacts, shape (model, quantity, ...).

    The arguments are those of :func:`relative_errors`, and the models those of :func:`models`, in
    the order of :data:`SIMPLE`.

    Examples
    --------
    >>> errors(SpringDamper(100.0, 0.1), 1, 1.0, ["max_height"]).round(4).tolist()
    [[-0.0083], [-0.0]]
    """
    exact, *simple = models(contact)
    return relative_errors(exact, simple, n, amplitude, quantities)


def orbit_errors(orbit: SpringDamperOrbit) -> np.ndarray:
    """Errors of the four quantities of exact orbits, shape (model, quantity, ...); NaN where there
    is no orbit.

    They equal :func:`errors` at the Λ of the orbits.

    Examples
    --------
    >>> from bouncing_ball.contacts.spring_damper import SpringDamper
    >>> from bouncing_ball.orbits.spring_damper_limits import orbit_at
    >>> orbit_errors(orbit_at(SpringDamper(100.0, 0.1), 1, 1.0)).round(4)[:, 0].tolist()
    [-0.0083, -0.0]
    """
    exact = [getattr(orbit, quantity) for quantity in OF_ORBITS]
    simple = (values(x, orbit.n, orbit.amplitude, OF_ORBITS) for x in models(orbit.law)[1:])
    return np.stack([[*map(relative, exact, each)] for each in simple])

r"""The quantities by which models are compared, and the relative errors of simple models.

There are two relative errors of a quantity, with its value q_SD in the exact model, on the contact,
and its value q in a simple model, which is the restitution model in the paper::

    e = (q_SD - q)/q       the paper's error (Eqs. 37-38), positive where the model predicts less
    d = (q - q_SD)/q_SD    the deviation from the contact, positive where the model predicts more

They are :func:`paper_error` and :func:`deviation`. ``d = -e/(1 + e)``, which is
:func:`as_deviation`: to first order they differ in their sign alone.
The paper compares the greatest height (Eq. 37) and the threshold of permanent contact (Eq. 38), and
uses the modulus of the error; here both are signed. The error law, thresholds and studies have the
paper's error. An engineer's contact is the truth for a model, so that its errors and its tolerance
are deviations.
"""

from collections.abc import Iterable, Sequence
from functools import cache

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.accuracy.errors import Quantity
from bouncing_ball_beyond.inherited.periodic.orbit import Bifurcation
from bouncing_ball_beyond.models.model import Model
from bouncing_ball_beyond.periodic.one_impact import n_t

OF_ORBITS = tuple(Quantity)[:4]
"""Quantities of an orbit: functions of the contact, n and Λ."""

OF_LIMITS = tuple(Quantity)[4:]
"""Values of Λ: functions of the contact and of n; the permanent contact does not depend on n."""

OF_IMPACTS = tuple(Quantity)[:6]
"""Quantities that depend on an impact: all except the permanent contact, which has no impact."""

QUANTITIES = {
    Quantity.MAX_HEIGHT: "greatest height",
    Quantity.BOUNCE_VELOCITY: "bouncing-off velocity",
    Quantity.PHASE: "phase of impact",
    Quantity.APPARENT_RESTITUTION: "apparent restitution",
    Quantity.SADDLE_NODE: str(Bifurcation.SADDLE_NODE),
    Quantity.PERIOD_DOUBLING: str(Bifurcation.PERIOD_DOUBLING),
    Quantity.PERMANENT_CONTACT: "threshold of permanent contact",
}
"""The names of the quantities in sentences."""


_BIFURCATIONS = {
    Quantity.SADDLE_NODE: n_t.saddle_node,
    Quantity.PERIOD_DOUBLING: n_t.period_doubling,
}


def values(
    model: Model, n: ArrayLike, amplitude: ArrayLike, quantities: Iterable[str] = OF_IMPACTS
) -> np.ndarray:
    """As :func:`bouncing_ball_beyond.inherited.accuracy.errors.values`, for any model.

    One search for the orbit serves all its quantities.
    """
    orbit = cache(lambda: n_t.orbit(model, n, amplitude))

    def value(quantity: str) -> np.ndarray:
        if quantity == Quantity.PERMANENT_CONTACT:
            return model.permanent_contact_threshold()
        if quantity in OF_LIMITS:
            return _BIFURCATIONS[Quantity(quantity)](model, n).amplitude
        return getattr(orbit(), quantity)

    return np.stack(np.broadcast_arrays(*map(value, quantities)))


def paper_error(*, exact: ArrayLike, simple: ArrayLike) -> np.ndarray:
    """The paper's error ``(q_SD - q)/q`` of simple values q, over the simple value (Eqs. 37-38).

    Of positive values it is positive where the simple model predicts less. It is NaN where a value
    is missing, and for 0/0, and infinite where the simple value is 0, for example for the
    saddle-node at r = 1.

    Examples
    --------
    >>> paper_error(exact=[1.5, 1.0], simple=[1.0, 0.0]).tolist()
    [0.5, inf]
    """
    return _relative(exact, simple)


def deviation(*, exact: ArrayLike, simple: ArrayLike) -> np.ndarray:
    """The deviation ``(q - q_SD)/q_SD`` of simple values q from exact ones, over the exact value.

    Of positive values it is positive where the simple model predicts more. It is NaN where a value
    is missing, and for 0/0, and infinite where the exact value is 0.

    Examples
    --------
    >>> deviation(exact=[1.5, 1.0], simple=[3.0, 0.0]).tolist()
    [1.0, -1.0]
    """
    return _relative(simple, exact)


def as_deviation(error: ArrayLike) -> np.ndarray:
    """The :func:`deviation` d = -e/(1 + e) of which the paper's error (:func:`paper_error`) is e.

    An infinite e, with a simple value of 0, has d = -1.

    Examples
    --------
    >>> as_deviation([-0.5, 1.0, np.inf]).tolist()
    [1.0, -0.5, -1.0]
    """
    paper = np.asarray(error, dtype=float)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(np.isinf(paper), -1.0, -paper / (1 + paper))


def _relative(value: ArrayLike, reference: ArrayLike) -> np.ndarray:
    base = np.asarray(reference, dtype=float)
    with np.errstate(divide="ignore", invalid="ignore"):
        return (np.asarray(value, dtype=float) - base) / base


def relative_errors(
    exact: Model,
    simple: Sequence[Model],
    n: ArrayLike,
    amplitude: ArrayLike,
    quantities: Sequence[str] = OF_IMPACTS,
) -> np.ndarray:
    """The paper's errors of simple models (:func:`paper_error`), shape (model, quantity, ...).

    The errors of ``max_height`` and ``permanent_contact`` are those of Eqs. 37 and 38, with a sign.
    They are NaN where a model has no such orbit or bifurcation.

    Parameters
    ----------
    exact : Model
    simple : sequence of Model
    n, amplitude : array_like
        As in :func:`values`.
    quantities : sequence of str

    Examples
    --------
    Without damping, Λ_SD = 1 - 1/ϖ² above the resonance:

    >>> from bouncing_ball_beyond.models.spring_damper import SpringDamper
    >>> from bouncing_ball_beyond.models.rigid import RestitutionModel
    >>> from bouncing_ball_beyond.models.contact_model import ContactModel
    >>> stiff = ContactModel(SpringDamper.from_restitution(1.0, np.array([2.0])))
    >>> relative_errors(stiff, [RestitutionModel(1.0)], 1, 1.0, ["permanent_contact"]).tolist()
    [[[-0.25]]]
    """
    shape = np.broadcast_shapes(exact.shape, np.shape(n), np.shape(amplitude))
    wanted = values(exact, n, amplitude, quantities)
    errors = np.empty((len(simple), len(quantities), *shape))
    for k, model in enumerate(simple):
        found = values(model, n, amplitude, quantities)
        for q in range(len(quantities)):
            errors[k, q] = paper_error(exact=wanted[q], simple=found[q])
    return errors

r"""Parameters that take back the damping of an implicit step.

A contact ``x″ = -c x′ - k x`` has the rates μ, ``μ² + c μ + k = 0``: its motion is a sum of
``exp(μt)``. Implicit Euler with a step h multiplies each part by ``1/(1 - hμ)`` in place of
``exp(hμ)``, which damps the motion to first order. With the rates ::

    μ′ = (1 - exp(-hμ))/h,   μ = -ln(1 - hμ′)/h

both are equal, so that the computed positions are those of the exact contact with the rates μ.
The two rates are conjugate or real, so that k′ = μ′₁μ′₂ and c′ = -μ′₁ - μ′₂ are real. All k and c
are per unit of mass.
"""

from collections.abc import Callable

import numpy as np


def _with_rates(
    stiffness: float, damping: float, rates: Callable[[np.ndarray], np.ndarray]
) -> tuple[float, float]:
    """k and c of the contact whose rates are a function of the rates of this one."""
    # Real if ζ ≥ 1; the rate of the smaller amount from the product, because the sum would cancel.
    larger = -damping / 2 - np.emath.sqrt(damping * damping / 4 - stiffness)
    found = rates(np.array([larger, stiffness / larger]))
    return float(np.prod(found).real), float(-np.sum(found).real)


def compensated(stiffness: float, damping: float, step: float) -> tuple[float, float]:
    """k′ and c′ with which implicit Euler has the positions of the exact contact.

    If the step alone damps more than the contact, about from h√k = 2ζ on, c′ is 0, because engines
    have no negative damping.

    Examples
    --------
    >>> k, c = compensated(100.0, 2.0, 0.01)
    >>> bool(np.allclose(represented(k, c, 0.01), (100.0, 2.0), rtol=1e-12))
    True
    """
    k, c = _with_rates(stiffness, damping, lambda rate: -np.expm1(-step * rate) / step)
    return k, max(0.0, c)


def represented(stiffness: float, damping: float, step: float) -> tuple[float, float]:
    """k and c of the exact contact that implicit Euler computes with k′ and c′.

    Examples
    --------
    Without a damper the step damps like c = kh, to first order:

    >>> [round(value, 3) for value in represented(100.0, 0.0, 1e-3)]
    [99.996, 0.1]
    """
    return _with_rates(stiffness, damping, lambda rate: -np.log1p(-step * rate) / step)

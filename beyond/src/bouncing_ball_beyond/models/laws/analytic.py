"""Whether the force of a user's law may be differentiated by imaginary steps.

The derivatives of a force come from imaginary steps, which are exact for analytic functions and
wrong without a sign of it for others: the imaginary part of ``np.abs(u + ih)`` is 0. They are
compared with central differences once for each class of laws, when a ball on such a law is made.
"""

from collections.abc import Callable
from typing import Any
from weakref import WeakSet

import numpy as np

from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.models.laws.force_law import ForceLaw
from bouncing_ball_beyond.models.laws.loaded import under

# The steps of the differences relative to the argument, near the optimum ε^(1/3) for a function of
# one scale, and the imaginary step.
_DIFFERENCE = 6e-6
_IMAGINARY = 1e-20
# The relative error of a difference is that of the square of the step, and of rounding, some 1e-10
# of the force over the argument. Derivatives that differ by more than this are different.
_APART = 1e-3
_ROUNDING = 1e-8
# At so many places the derivatives must differ: a difference over a kink is no sign of an error.
_PLACES = 3
_DEPTHS = 0.937 * np.geomspace(1e-4, 1.0, 9)
_RATES = np.array([-4.7, -0.93, -0.11, 0.13, 1.07, 5.3])
_REMEDY = "write it with analytic functions, such as np.sqrt(x * x) or np.where(x > 0, x, -x)"
# The classes that have been found to be analytic.
_FOUND: WeakSet = WeakSet()


def require_analytic(law: ForceLaw) -> None:
    """Raise :class:`ModelError` if the force of a law has other derivatives by imaginary steps than
    by differences; its class is examined once.
    """
    kind = type(law)
    if kind in _FOUND:
        return
    one = under(law.flat(law.shape).take(0), 1.0)
    depth, rate = (x.ravel() for x in np.meshgrid(_DEPTHS, _RATES))
    what = f"the force of {law.name}"
    compare(what, "p", lambda p: one.force(p, rate), depth)
    compare(what, "p′", lambda u: one.force(depth, u), rate)
    _FOUND.add(kind)


def compare(what: str, name: str, function: Callable[[Any], Any], at: np.ndarray) -> None:
    """Raise :class:`ModelError` if a function has other derivatives by an imaginary step than by a
    difference at several of these places.

    Examples
    --------
    >>> compare("r", "v", lambda v: v * np.sqrt(v * v), np.array([1.0, 2.0, 3.0]))
    >>> compare("r", "v", lambda v: v * np.abs(v), np.array([1.0, 2.0, 3.0]))
    Traceback (most recent call last):
    ...
    bouncing_ball_beyond.inherited.errors.ModelError: r is not analytic in v: at v = 1 its \
derivative is 1 by an \
imaginary step and 2 by a difference; write it with analytic functions, such as np.sqrt(x * x) or \
np.where(x > 0, x, -x)
    """
    step = _DIFFERENCE * np.abs(at)
    small = _IMAGINARY * np.abs(at)
    with np.errstate(all="ignore"):
        value = np.abs(function(at))
        try:
            exact = np.imag(function(at + 1j * small)) / small
        except TypeError as error:
            raise ModelError(
                f"{what} refuses complex numbers, by which it is differentiated "
                f"({error}): {_REMEDY}"
            ) from None
        change = (function(at + step) - function(at - step)) / (2 * step)
        allowed = _APART * np.abs(change) + _ROUNDING * value / np.abs(at)
        differs = np.abs(change - exact) > allowed
    wrong = np.flatnonzero(differs & np.isfinite(change))
    if wrong.size >= _PLACES:
        k = wrong[0]
        raise ModelError(
            f"{what} is not analytic in {name}: at {name} = {at[k]:g} its derivative is "
            f"{exact[k]:.6g} by an imaginary step and {change[k]:.6g} by a difference; {_REMEDY}"
        )

r"""The time stepping of an engine for a ball in contact with a spring and a damper.

In a free impact p″ = -p - 2ζ p′, where time is in units of 1/ω, ω = √(k/m). The height x = -p of
the ball above the wall and its velocity v are advanced by a step h in one of two ways. Engines
implement their contacts differently, but each contact is equivalent to one of these maps:

* *semi-implicit Euler*: ``v⁺ = v - h(x + 2ζv)``, ``x⁺ = x + h v⁺``. MuJoCo's Euler integrator
  with its constraint force; also LAMMPS, LIGGGHTS and MercuryDPM, whose velocity Verlet takes
  the damper's speed from the last half step: v is then that of the half steps.
* *implicit Euler*: ``v⁺ = v - h(x⁺ + 2ζv⁺)``, ``x⁺ = x + h v⁺``. Drake's discrete contact.
* *compensated implicit Euler*: the same with parameters that take back the damping of the step, in
  place of 1 and 2ζ. Drake's linear contact (SAP), and Bullet's springs, which are constraints with
  ``cfm`` and ``erp``.
* both with *contacts found ahead*: PhysX' compliant contact.

A ball is in contact during a step if x < 0 before this step. If contacts are found ahead, it is in
contact as well if it would be at x < 0 after a step without contact, x + hv < 0. A contact with the
force release only pushes, and a damper that acts on approach only is left out of the steps that
begin with v ≥ 0.

The compensation follows from the rates μ of a contact ``x″ = -c x′ - k x``, ``μ² + c μ + k = 0``:
its motion is a sum of ``exp(μt)``. Implicit Euler with a step h multiplies each part by
``1/(1 - hμ)`` in place of ``exp(hμ)``, which damps the motion to first order. With the rates ::

    μ′ = (1 - exp(-hμ))/h,   μ = -ln(1 - hμ′)/h

both are equal, so that the computed positions are those of the exact contact with the rates μ. The
two rates are conjugate or real, so that k′ = μ′₁μ′₂ and c′ = -μ′₁ - μ′₂ are real. Here all k and c
are per unit of mass.

The compensated positions are those of an exact contact, which begins in the middle of the step
before the first one in contact: up to half a step before or after the ball meets the wall. The
damper therefore acts for up to half a step more or less, so that r has the errors ``±ζhr``, and a
mean error of second order in h. The force release, where v is greatest, adds a second order only.
A contact that is found ahead begins one step earlier, so that the mean of r has the factor
``1 - 2ζh`` to first order.
"""

from collections.abc import Callable
from enum import StrEnum

import numpy as np


def _with_rates(
    stiffness: float, damping: float, rates: Callable[[np.ndarray], np.ndarray]
) -> tuple[float, float]:
    """k and c of the contact whose rates are a function of the rates of this one."""
    # Real if ζ ≥ 1; the rate of the smaller amount from the product, because the sum would cancel.
    larger = -damping / 2 - np.emath.sqrt(damping * damping / 4 - stiffness)
    found = rates(np.array([larger, stiffness / larger]))
    return float(np.prod(found).real), float(-np.sum(found).real)


def represented(stiffness: float, damping: float, step: float) -> tuple[float, float]:
    """k and c of the exact contact that implicit Euler computes with k′ and c′.

    Examples
    --------
    Without a damper the step damps like c = kh, to first order:

    >>> [round(value, 3) for value in represented(100.0, 0.0, 1e-3)]
    [99.996, 0.1]
    """
    return _with_rates(stiffness, damping, lambda rate: -np.log1p(-step * rate) / step)


class Scheme(StrEnum):
    """The time-stepping scheme of an engine for a ball in contact, and the choice of parameters."""

    SEMI_IMPLICIT = "semi-implicit Euler"
    IMPLICIT = "implicit Euler"
    COMPENSATED = "compensated implicit Euler"
    AHEAD = "implicit Euler with contacts found ahead"
    COMPENSATED_AHEAD = "compensated implicit Euler with contacts found ahead"

    @property
    def is_implicit(self) -> bool:
        """Whether the force is that at the end of the step."""
        return self is not Scheme.SEMI_IMPLICIT

    @property
    def is_compensated(self) -> bool:
        """Whether the parameters take back the damping of the step."""
        return self in (Scheme.COMPENSATED, Scheme.COMPENSATED_AHEAD)

    @property
    def is_ahead(self) -> bool:
        """Whether a ball that would be inside after a step without contact is in contact."""
        return self in (Scheme.AHEAD, Scheme.COMPENSATED_AHEAD)

    @property
    def uncompensated(self) -> "Scheme":
        """The scheme with k and c as they are."""
        if not self.is_compensated:
            return self
        return Scheme.AHEAD if self.is_ahead else Scheme.IMPLICIT

r"""The n-T orbits of the restitution model on a table of several harmonics, with drag or on a spring.

With δ = p - W of :mod:`bouncing_ball.models.suspension` and T = 2πn, a flight that returns to the
height W(φ) after the time T leaves with ``p′ = (q W - b) G/g`` and arrives with
``p′ = -(q W - b) (g - G g′/g)``, where g, g′ and G are the free responses at T. The impact
``v⁺ = -r v⁻`` therefore is ::

    (q W - b) C = (1 + r) W′,     C = G/g - r (g - G g′/g)

With W = Λ U this is one equation for the phase, ``P(φ) = q C U - (1 + r) U′ = b C/Λ``, whose zeros
over one period are bracketed and found. For gravity alone it is w′ = nπ (1 - r)/(1 + r) (Eq. 6).
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq

from bouncing_ball.errors import ModelError
from bouncing_ball.models.rigid import RestitutionModel
from bouncing_ball.models.setting import OtherSetting
from bouncing_ball.models.suspension import responses
from bouncing_ball.models.waveform import turned
from bouncing_ball.periodic.orbits.orbit import Orbit, check_index
from bouncing_ball.periodic.orbits.stability import Bifurcation, Side

# Samples of the equation in one period of the highest harmonic, between which its zeros are found.
_SAMPLES = 64


@dataclass(frozen=True)
class OtherOrbits:
    """The n-T orbits of balls in another setting than that of the paper."""

    model: RestitutionModel

    def orbit(self, n: ArrayLike, amplitude: ArrayLike, side: Side) -> Orbit:
        """The n-T orbits at Λ on one side of the saddle-node; NaN where there is none.

        If several orbits are on this side, as may be with several harmonics, the first one that is
        stable is chosen, and otherwise the first one.
        """
        check_index(n)
        index, lam = np.broadcast_arrays(n, np.asarray(amplitude, dtype=float))
        shape = np.broadcast_shapes(index.shape, self.model.shape)
        index, lam = np.broadcast_to(index, shape), np.broadcast_to(lam, shape)
        phase = np.full(shape, np.nan)
        velocity = np.full(shape, np.nan)
        models = self.model.flat(shape)
        for k, place in enumerate(np.ndindex(shape)):
            model = models.take(k)
            found = _orbits_of(model, int(index[place]), float(lam[place]))
            if found is None:
                continue
            stable_side = Bifurcation.SADDLE_NODE.test(*found.trace_and_determinant()) > 0
            here = np.flatnonzero(stable_side == (side is Side.STABLE))
            if here.size:
                best = here[np.argmax(np.atleast_1d(found.is_stable())[here])]
                phase[place] = found.phase[best]
                velocity[place] = found.impact_velocity[best]
        return Orbit.of(self.model, index, lam, phase, 0.0, velocity)

    def orbits(self, n: int, amplitude: float) -> Orbit:
        """All n-T orbits of a single model at one Λ, in a row, in order of their phases."""
        check_index(n)
        found = _orbits_of(self.model, n, amplitude)
        if found is None:
            none = np.empty(0)
            return Orbit.of(self.model, n, none, none, none, none)
        return found

    def saddle_node(self, n: ArrayLike) -> Orbit:
        """Raise an error: the saddle-nodes are found by :func:`bouncing_ball.follow`."""
        raise ModelError(_NO_LIMITS)

    def period_doubling(self, n: ArrayLike) -> Orbit:
        """Raise an error: period doublings are found by :func:`bouncing_ball.follow`."""
        raise ModelError(_NO_LIMITS)


_NO_LIMITS = (
    "limits and branch are those of a table that moves as a sine, with free flight: use "
    "follow(orbit(…)) for another table or flight"
)


def _orbits_of(model: RestitutionModel, n: int, amplitude: float) -> Orbit | None:
    """All n-T orbits of a single model at one Λ in order of their phases, None if there are none."""
    setting: Any = model.setting
    assert isinstance(setting, OtherSetting)
    waveform = setting.form
    on = setting.suspension
    time = np.asarray(2 * np.pi * n)
    at = responses(time, on.loss, on.stiffness)
    r = float(model.restitution)
    rise = float(at.step / at.impulse)
    fall = float(at.impulse) - rise * float(at.impulse_rate)
    both = rise - r * fall
    orders = waveform.orders
    coefficients = np.ravel(on.coefficients(waveform))
    q = float(on.stiffness)
    level = float(on.load) * both

    def virtual(phase: Any) -> tuple[Any, Any]:
        whole = amplitude * turned(coefficients, orders, phase)
        return whole.imag.sum(axis=-1), (orders * whole.real).sum(axis=-1)

    def equation(phase: Any) -> Any:
        height, velocity = virtual(phase)
        return q * both * height - (1 + r) * velocity - level

    sample = np.linspace(-np.pi, np.pi, _SAMPLES * int(orders[-1]) + 1)
    value = equation(sample)
    turns = np.flatnonzero((value[:-1] < 0) != (value[1:] < 0))
    found = [brentq(equation, sample[k], sample[k + 1], xtol=1e-15) for k in turns]
    if not found:
        return None
    phase = np.array(found)
    height, velocity = virtual(phase)
    arriving = -(q * height - float(on.load)) * fall
    relative = arriving - velocity
    lands = relative < 0
    if not lands.any():
        return None
    phase = phase[lands]
    absolute = relative[lands] + amplitude * waveform.velocity(phase)
    return Orbit.of(model, n, np.full(phase.shape, amplitude), phase, 0.0, absolute)

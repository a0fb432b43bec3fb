r"""The n-T orbits of the restitution model on another table, with drag or on a spring.

With δ = p - W of :mod:`bouncing_ball.models.suspension` and T = 2πn, a flight that returns to the
height W(φ) after the time T leaves with ``p′ = (q W - b) G/g`` and arrives with
``p′ = -(q W - b) (g - G g′/g)``, where g, g′ and G are the free responses at T. The impact
``v⁺ = -r v⁻`` therefore is ::

    (q W - b) C = (1 + r) W′,     C = G/g - r (g - G g′/g)

With W = Λ U this is one equation for the phase, ``P(φ) = q C U - (1 + r) U′ = b C/Λ``, whose zeros
over one period are bracketed and found. The extrema of P are saddle-nodes. For gravity alone it is
w′ = nπ (1 - r)/(1 + r) (Eq. 6).
"""

from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple, Self

import numpy as np
import scipy
from numpy.typing import ArrayLike

from bouncing_ball.errors import ModelError
from bouncing_ball.models.rigid import RestitutionModel
from bouncing_ball.models.suspension import free_responses
from bouncing_ball.models.waveform import Waveform, turned
from bouncing_ball.periodic.orbits.impacts import check_index
from bouncing_ball.periodic.orbits.orbit import Orbit
from bouncing_ball.periodic.orbits.stability import Bifurcation, Side

# Samples of the equation in one period of the highest harmonic, between which its zeros are found.
_SAMPLES = 64


@dataclass(frozen=True)
class OtherOrbits:
    """The n-T orbits of balls in another setting than that of the paper."""

    model: RestitutionModel

    is_complete: ClassVar[bool] = True

    def orbit(self, n: ArrayLike, amplitude: ArrayLike, side: Side) -> Orbit:
        """The n-T orbits at Λ on one side of the saddle-node; NaN where there is none.

        If several orbits are on this side, as may be with several harmonics, the first one that is
        stable is chosen, and otherwise the first one.
        """
        check_index(n)
        index, lam = np.broadcast_arrays(n, np.asarray(amplitude, dtype=float))
        shape = np.broadcast_shapes(index.shape, self.model.shape)
        index = np.broadcast_to(index, shape)
        lam = np.broadcast_to(lam, shape)
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
        """The orbits at the lowest Λ at which n-T orbits exist, a saddle-node; NaN for a spring
        without load, whose orbits exist at every Λ.
        """
        check_index(n)
        shape = np.broadcast_shapes(np.shape(n), self.model.shape)
        index = np.broadcast_to(n, shape)
        models = self.model.flat(shape)
        values = np.full((3, *shape), np.nan)
        for k, place in enumerate(np.ndindex(shape)):
            values[(slice(None), *place)] = _lowest(models.take(k), int(index[place]))
        lam, phase, velocity = values
        return Orbit.of(self.model, index, lam, phase, 0.0, velocity)

    def period_doubling(self, n: ArrayLike) -> Orbit:
        """Raise an error: period doublings are found by :func:`bouncing_ball.follow`."""
        raise ModelError(NO_LIMITS)


NO_LIMITS = (
    "the period doublings of limits are those of a table that moves as a sine, with free flight: "
    "use follow(orbit(…)) for another table or flight"
)


class _Family(NamedTuple):
    """The equation of the n-T orbits of one ball: its table, q, b, and C and g - G g′/g.

    ``coefficients`` are the harmonics of U, and ``waveform`` is the table's shape u.
    """

    waveform: Waveform
    coefficients: np.ndarray
    restitution: float
    stiffness: float
    load: float
    both: float
    fall: float

    @classmethod
    def of(cls, model: RestitutionModel, n: int) -> Self:
        """The equation of the n-T orbits of a single model."""
        setting: Any = model.setting
        on = setting.suspension
        at = free_responses(np.asarray(2 * np.pi * n), on.loss, on.stiffness)
        rise = float(at.step / at.impulse)
        fall = float(at.impulse) - rise * float(at.impulse_rate)
        r = float(model.restitution)
        return cls(
            waveform=setting.form,
            coefficients=np.ravel(on.coefficients(setting.form)),
            restitution=r,
            stiffness=float(on.stiffness),
            load=float(on.load),
            both=rise - r * fall,
            fall=fall,
        )

    def unit(self, phase: Any, order: int = 0) -> Any:
        """U or a derivative of it."""
        k = self.waveform.orders
        whole = turned(self.coefficients, k, phase)
        return np.imag((1j * k) ** order * whole).sum(axis=-1)

    def side(self, phase: Any, order: int = 0) -> Any:
        """P or a derivative of it."""
        pull = self.stiffness * self.both * self.unit(phase, order)
        return pull - (1 + self.restitution) * self.unit(phase, order + 1)

    def samples(self) -> np.ndarray:
        """Phases over one period, so dense that no zero of P is between two of them."""
        return np.linspace(-np.pi, np.pi, _SAMPLES * int(self.waveform.orders[-1]) + 1)

    def arriving(self, amplitude: Any, phase: Any) -> tuple[Any, Any]:
        """The relative velocity and that of the ball before the impact."""
        height = amplitude * self.unit(phase)
        speed = amplitude * self.unit(phase, 1)
        relative = -(self.stiffness * height - self.load) * self.fall - speed
        return relative, relative + amplitude * self.waveform.velocity(phase)


def _lowest(model: RestitutionModel, n: int) -> tuple[float, float, float]:
    """Λ, φ and z′_i of the saddle-node at the lowest Λ; NaN if there is none."""

    family = _Family.of(model, n)
    level = family.load * family.both
    if not level:
        return np.nan, np.nan, np.nan
    sample = family.samples()
    top = int(np.argmax(family.side(sample) / level))
    step = sample[1] - sample[0]
    phase = scipy.optimize.brentq(
        lambda x: family.side(x, 1), sample[top] - step, sample[top] + step, xtol=1e-15
    )
    highest = float(family.side(phase)) / level
    if not highest > 0:
        return np.nan, np.nan, np.nan
    _, velocity = family.arriving(1 / highest, phase)
    return 1 / highest, phase, float(velocity)


def _orbits_of(model: RestitutionModel, n: int, amplitude: float) -> Orbit | None:
    """All n-T orbits of a single model at one Λ in order of phase, None if there are none."""
    family = _Family.of(model, n)
    level = family.load * family.both

    def equation(phase: Any) -> Any:
        return amplitude * family.side(phase) - level

    sample = family.samples()
    value = equation(sample)
    turns = np.flatnonzero((value[:-1] < 0) != (value[1:] < 0))

    found = [scipy.optimize.brentq(equation, sample[k], sample[k + 1], xtol=1e-15) for k in turns]
    phase = np.array(found)
    relative, absolute = family.arriving(amplitude, phase)
    lands = relative < 0
    if not np.any(lands):
        return None
    lam = np.full(int(np.sum(lands)), amplitude)
    return Orbit.of(model, n, lam, phase[lands], 0.0, absolute[lands])

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

from collections.abc import Iterator
from typing import Any, ClassVar, NamedTuple, Self

import numpy as np
import scipy
from numpy.typing import ArrayLike

from bouncing_ball.models.rigid import RestitutionModel
from bouncing_ball.models.suspension import free_responses
from bouncing_ball.models.waveform import Waveform, turned
from bouncing_ball.periodic.one_impact.orbits_of_model import OrbitsOneByOne
from bouncing_ball.periodic.orbits.impacts import check_index
from bouncing_ball.periodic.orbits.orbit import Orbit

# Samples of the equation in one period of the highest harmonic, between which its zeros are found.
_SAMPLES = 64


class OtherOrbits(OrbitsOneByOne):
    """The n-T orbits of rigid balls in another setting than that of the paper.

    If several are on a side, as may be with several harmonics, the first one that is stable is
    chosen, and otherwise the first one.
    """

    is_complete: ClassVar[bool] = True

    def rows(self, model: RestitutionModel, n: int, amplitude: float) -> Iterator[Orbit]:
        """All orbits in order of their phases."""
        family = _Family.of(model, n)
        level = family.load * family.both

        def equation(phase: Any) -> Any:
            return amplitude * family.side(phase) - level

        sample = family.samples()
        value = equation(sample)
        turns = np.flatnonzero((value[:-1] < 0) != (value[1:] < 0))
        brackets = zip(sample[turns], sample[turns + 1], strict=True)
        phase = np.array([scipy.optimize.brentq(equation, *x, xtol=1e-15) for x in brackets])
        relative, absolute = family.arriving(amplitude, phase)
        lands = relative < 0
        lam = np.full(int(np.sum(lands)), amplitude)
        yield Orbit.of(model, n, lam, phase[lands], 0.0, absolute[lands])

    def rank(self, row: Orbit) -> np.ndarray:
        """Stable orbits come first."""
        return row.is_stable()

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

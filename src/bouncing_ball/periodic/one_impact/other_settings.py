r"""The n-T orbits on another table, with drag or on a spring, for one ball after the other.

**Rigid balls.** With δ = p - W of :mod:`bouncing_ball.models.suspension` and T = 2πn, a flight that
returns to the height W(φ) after the time T leaves with ``p′ = (q W - b) G/g`` and arrives with
``p′ = -(q W - b) (g - G g′/g)``, where g, g′ and G are the free responses at T. The impact
``v⁺ = -r v⁻`` therefore is ::

    (q W - b) C = (1 + r) W′,     C = G/g - r (g - G g′/g)

With W = Λ U this is one equation for the phase, ``P(φ) = q C U - (1 + r) U′ = b C/Λ``, whose zeros
over one period are bracketed and found. The extrema of P are saddle-nodes. For gravity alone it is
w′ = nπ (1 - r)/(1 + r) (Eq. 6).

**Contacts of finite duration.** No closed form is known. Newton's method on the equations of the
model starts from the orbits of the rigid ball in the same setting, whose r is that of the model's
impact: with the delay t_c and the duration D of its signature, the contact starts at ψ - t_c,
earlier than the instant at ψ, and lasts for D. Where these starts lead to no orbit, and for all
orbits at one Λ, further starts are at even phases. Such a search may miss an orbit;
:func:`bouncing_ball.orbit_of_motion` and :func:`bouncing_ball.follow` find others.
"""

from abc import abstractmethod
from collections.abc import Iterator
from typing import Any, ClassVar, NamedTuple, Self

import numpy as np
import scipy
from numpy.typing import ArrayLike

from bouncing_ball.errors import ModelError
from bouncing_ball.models.instant import Instant
from bouncing_ball.models.model import Model
from bouncing_ball.models.rigid import RestitutionModel
from bouncing_ball.models.suspension import free_responses
from bouncing_ball.models.waveform import Waveform, turned
from bouncing_ball.numerics.corrector import solve
from bouncing_ball.numerics.elementary import reduce_angle
from bouncing_ball.periodic.one_impact.orbits_of_model import OrbitsOfModel
from bouncing_ball.periodic.one_impact.searched_orbits import restitution_speed
from bouncing_ball.periodic.orbits.impacts import check_index
from bouncing_ball.periodic.orbits.orbit import Orbit, orbit_of_point
from bouncing_ball.periodic.orbits.stability import Bifurcation, Side
from bouncing_ball.periodic.orbits.steps import PATIENT

# Samples of the equation in one period of the highest harmonic, between which its zeros are found.
_SAMPLES = 64
# Starts of Newton's method in one period of the highest harmonic of the table.
_STARTS = 8
# Orbits whose phases and velocities differ by less than this are one.
_SAME = 1e-6
_NO_LIMITS = (
    "the period doublings of limits are those of a table that moves as a sine, with free flight: "
    "use follow(orbit(…)) for another table or flight"
)


class OrbitsOneByOne(OrbitsOfModel):
    """The n-T orbits of balls in another setting than that of the paper, for one ball after the
    other.
    """

    @abstractmethod
    def rows(self, model: Any, n: int, amplitude: float) -> Iterator[Orbit]:
        """The orbits of a single model at one Λ that a first search finds, in a row; then those of
        each further search, together with those before.
        """

    @abstractmethod
    def rank(self, row: Orbit) -> np.ndarray:
        """A number for each orbit of a row: of several on a side the first of the highest number is
        chosen.
        """

    def orbit(self, n: ArrayLike, amplitude: ArrayLike, side: Side) -> Orbit:
        """The n-T orbits at Λ on one side of the saddle-node; NaN where none was found."""
        check_index(n)
        shape = np.broadcast_shapes(np.shape(n), np.shape(amplitude), self.model.shape)
        index = np.broadcast_to(n, shape)
        lam = np.broadcast_to(np.asarray(amplitude, dtype=float), shape)
        columns = np.full((3, *shape), np.nan)
        models = self.model.flat(shape)
        for k, place in enumerate(np.ndindex(shape)):
            if not lam[place] > 0:
                continue
            rows = self.rows(models.take(k), int(index[place]), float(lam[place]))
            columns[(slice(None), *place)] = self._first_on(side, rows)
        phase, duration, velocity = columns
        return Orbit.of(self.model, index, lam, phase, duration, velocity)

    def _first_on(self, side: Side, rows: Iterator[Orbit]) -> tuple[float, float, float]:
        """φ, D and z′_i of the orbit chosen on a side in the first row that has one; NaN if there
        is none.
        """
        for row in rows:
            if not row.size:
                continue
            on_stable_side = Bifurcation.SADDLE_NODE.test(*row.trace_and_determinant()) > 0
            here = np.flatnonzero(on_stable_side == (side is Side.STABLE))
            if here.size:
                k = here[np.argmax(np.atleast_1d(self.rank(row))[here])]
                return row.phase[k], row.contact_duration[k], row.impact_velocity[k]
        return np.nan, np.nan, np.nan

    def orbits(self, n: int, amplitude: float) -> Orbit:
        """The n-T orbits of a single model at one Λ, in a row, in order of contact duration."""
        check_index(n)
        *_, found = self.rows(self.model, n, amplitude)
        return found[np.argsort(found.contact_duration, kind="stable")]

    def period_doubling(self, n: ArrayLike) -> Orbit:
        """Raise an error: period doublings are found by :func:`bouncing_ball.follow`."""
        raise ModelError(_NO_LIMITS)


class OrbitsOfRigidBall(OrbitsOneByOne):
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


class OrbitsOfContact(OrbitsOneByOne):
    """The n-T orbits of balls on contacts in another setting than that of the paper.

    If several are on a side, the first admissible one that is stable is chosen, and otherwise the
    first admissible or the first one.
    """

    def rows(self, model: Model, n: int, amplitude: float) -> Iterator[Orbit]:
        """The orbits to which Newton's method leads from those of the rigid ball, and then also
        from starts at even phases, of which only orbits that a ball follows are taken.
        """
        speed, instant = restitution_speed(n, model)
        rigid = OrbitsOfRigidBall(RestitutionModel(float(instant.restitution), model.place))
        near = rigid.orbits(n, amplitude)
        first = _orbits_near(model, n, amplitude, near.phase, near.impact_velocity, instant)
        yield _distinct(model, n, amplitude, [first])
        count = _STARTS * int(model.place.waveform.orders[-1])
        phase = 2 * np.pi * (np.arange(count) + 0.5) / count - np.pi
        start = amplitude * model.place.waveform.velocity(phase) - float(speed)
        more = _orbits_near(model, n, amplitude, phase, start, instant)
        followed = np.flatnonzero(more.is_admissible()) if more.size else slice(None)
        yield _distinct(model, n, amplitude, [first, more[followed]])

    def rank(self, row: Orbit) -> np.ndarray:
        """Admissible orbits come first, and stable ones among them."""
        return 2 * row.is_admissible() + row.is_stable()

    def saddle_node(self, n: ArrayLike) -> Orbit:
        """No orbit: saddle-nodes are found by :func:`bouncing_ball.follow`."""
        return Orbit.of(self.model, n, np.nan, np.nan)


def _orbits_near(
    model: Model,
    n: int,
    amplitude: float,
    phase: np.ndarray,
    velocity: np.ndarray,
    instant: Instant,
) -> Orbit:
    """The orbits near instants with these phases and velocities of the ball before them, in a
    row.
    """
    delay = float(instant.delay)
    # In the time t_c before the instant the ball falls faster by t_c.
    guess = Orbit.of(
        model,
        n,
        np.full(phase.shape, amplitude),
        phase - delay,
        float(instant.duration),
        velocity + delay,
    )
    if not guess.size:
        return guess
    problem = guess.problem()
    with np.errstate(all="ignore"):
        found = solve(problem.equations_at, guess.point(problem), PATIENT)
    good = np.flatnonzero(found.converged & np.isfinite(found.point).all(axis=-1))
    if not good.size:
        return guess[good]
    orbit = orbit_of_point(problem.take(good), found.point[good])
    lands = (orbit.contact_duration > 0) & (orbit.flight_time > 0)
    lands &= orbit.relative_impact_velocity < 0
    return orbit[np.flatnonzero(lands)]


def _distinct(model: Model, n: int, amplitude: float, rows: list[Orbit]) -> Orbit:
    """The orbits of several rows as one row in which each stands once."""
    names = ("phase", "contact_duration", "impact_velocity")
    columns = [np.concatenate([getattr(row, name) for row in rows]) for name in names]
    kept: list[int] = []
    for k in range(columns[0].size):
        apart = (
            np.abs(reduce_angle(columns[0][j] - columns[0][k]))
            + np.abs(columns[2][j] - columns[2][k])
            for j in kept
        )
        if all(distance > _SAME for distance in apart):
            kept.append(k)
    phase, duration, velocity = (column[kept] for column in columns)
    lam = np.full(len(kept), amplitude)
    return Orbit.of(model, n, lam, phase, duration, velocity)

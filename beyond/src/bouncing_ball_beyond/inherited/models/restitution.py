r"""The restitution model: impacts as instants, chattering, rest on the table (Eqs. 2, 5, 9).

An impact turns the relative velocity δ′ of the ball into -r δ′. With v₀ just after an impact at the
phase τ₀, the flight of Eqs. 3 and 4 for a time s, and the impact that follows, the map from one
impact to the next is ::

    Λ (sin τ₁ - sin τ₀) = s v₀ - s²/2                        τ₁ = τ₀ + s
    v₁ = -r (v₀ - s) + (1 + r) Λ cos τ₁                      (5)

While the relative gravity g = 1 - Λ sin τ is positive, infinitely many ever smaller bounces take a
finite time T: the ball *chatters*. Let v be δ′ after an impact, and ``g′ = -Λ cos τ`` the rate of
change of g. Then ::

    T = T₀ (1 - g′ T₀/(3g) + ...),    T₀ = 2v/(g (1 - r))

This sum replaces the bounces once Λ T₀ and T₀ are below 10⁻⁵ g, where the next term is below 10⁻¹⁵.
The ball then rests on the table until Λ sin τ rises through 1, because the table's downward
acceleration exceeds gravity from there on. For Λ ≤ Λ_CR = 1 it never leaves (Eq. 9).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from bouncing_ball_beyond.inherited.datasets.arguments import RigidRestitutionAxis, checked
from bouncing_ball_beyond.inherited.errors import RIGID_RESTITUTION, suggesting
from bouncing_ball_beyond.inherited.models.damping import check_restitution
from bouncing_ball_beyond.inherited.models.flight import matrix_of, table
from bouncing_ball_beyond.inherited.models.model import Departure, Model, Status
from bouncing_ball_beyond.inherited.models.permanent_contact import RESTITUTION_THRESHOLD
from bouncing_ball_beyond.inherited.numerics.elementary import arctangent, reduce_angle

# Bound of Λ T₀/g and T₀/g below which chattering is summed up.
_CHATTER = 1e-5
# Where g is tiny, with Λ near 1, chattering is also summed up if T₀ is below rounding.
_INSTANT = np.finfo(float).eps
_TURN = 2 * np.pi
# Rounding must not postpone a lift-off at the present phase by a full turn.
_AT_ONCE = 1e-9


def lift_off_phase(amplitude: np.ndarray) -> np.ndarray:
    """The phase arcsin(1/Λ) at which Λ sin τ rises through 1 and a ball at rest leaves the table
    (Eq. 9), for Λ ≥ 1.

    Examples
    --------
    >>> bool(np.isclose(lift_off_phase(2.0), np.pi / 6))
    True
    """
    return arctangent(1.0, np.sqrt((amplitude - 1) * (amplitude + 1)))


def chattering(
    velocity: np.ndarray, restitution: Any, x: np.ndarray, y: np.ndarray, amplitude: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Which balls come to rest on the table after an impact, and the time T of their chattering.

    ``velocity`` is δ′ just after the impact, and ``x``, ``y`` are Λ cos τ and Λ sin τ there. T is 0
    for balls that do not come to rest, because their bounces are not summed up.

    Examples
    --------
    On a table at rest T is the geometric series 2v (1 + r + r² + ...):

    >>> speed, zero = np.array([1e-6, 1e-6, 1.0]), np.zeros(3)
    >>> sticks, time = chattering(speed, np.array([0.5, 0.9, 0.5]), zero, zero, zero)
    >>> sticks.tolist(), time.round(12).tolist()
    ([True, False, False], [4e-06, 0.0, 0.0])
    """
    # T₀ > 2v/g, and g ≤ 1 + Λ: above this speed no ball of any r has a short T₀.
    strongest = 1 + amplitude
    if np.all(velocity > _CHATTER * strongest * strongest):
        return np.zeros(x.shape, dtype=bool), np.zeros(x.shape)
    gravity = 1 - y
    pressed = (gravity > 0) | ((gravity == 0) & (x <= 0))
    loss = gravity * (1 - restitution)
    # T₀ has no meaning where the relative gravity is not positive, or for r = 1.
    usable = pressed & (loss > 0)
    first = np.where(usable, 2 * velocity, 0.0) / np.where(usable, loss, 1.0)
    limit = np.maximum(_CHATTER * gravity / np.maximum(amplitude, 1.0), _INSTANT)
    short = usable & (first <= limit)
    correction = np.where(short, x * first, 0.0) / np.where(short, 3 * gravity, 1.0)
    sticks = short | (pressed & (velocity == 0))
    return sticks, np.where(sticks, first * (1 + correction), 0.0)


@dataclass(frozen=True, repr=False)
class RestitutionModel(Model):
    """A ball whose impacts are instants at which δ′ becomes -r δ′ (Eqs. 1-9).

    Parameters
    ----------
    restitution : float or array
        r in [0, 1].

    Raises
    ------
    ModelError
        If a value of r lies outside [0, 1].

    Examples
    --------
    >>> RestitutionModel([0.5, 0.9])[1]
    RestitutionModel(restitution=0.9)
    """

    restitution: Any

    name: ClassVar[str] = "restitution"

    def __post_init__(self) -> None:
        r = check_restitution(self.restitution, RIGID_RESTITUTION)
        object.__setattr__(self, "restitution", r if r.ndim else float(r))

    @property
    def label(self) -> str:
        return f"r = {self.restitution:g}"

    def impact(
        self,
        phase: np.ndarray,
        velocity: np.ndarray,
        amplitude: np.ndarray,
        displacement: np.ndarray | float = 0.0,
    ) -> Departure:
        """The flight after each impact, or the lift-off after chattering and rest on the table.

        With δ′ = z′ - w′, the impact turns δ′ into -r δ′; in metres and seconds this is
        ``ẏ⁺ - ẇ = -r (ẏ⁻ - ẇ)`` (Eq. 2).

        Examples
        --------
        >>> ball = RestitutionModel(0.5)
        >>> ball.impact(np.zeros(1), np.full(1, -2.0), np.ones(1)).velocity.tolist()
        [1.0]
        """
        x, y = table(phase, amplitude)
        rebound = -self.restitution * velocity
        sticks, settling = chattering(rebound, self.restitution, x, y, amplitude)
        lift = lift_off_phase(np.maximum(amplitude, 1.0))
        wait = np.mod(reduce_angle(lift - (phase + settling)), _TURN)
        wait = np.where(wait > _TURN - _AT_ONCE, 0.0, wait)
        forever = sticks & (amplitude <= RESTITUTION_THRESHOLD)
        rest = np.where(forever, np.inf, settling + wait)
        return Departure(
            duration=np.where(sticks, rest, 0.0),
            displacement=np.where(forever, np.nan, 0.0),
            velocity=np.where(forever, np.nan, np.where(sticks, 0.0, rebound)),
            status=np.where(forever, Status.PERMANENT_CONTACT, Status.BOUNCING),
        )

    def released(
        self, duration: Any, phase: Any, velocity: Any, amplitude: Any
    ) -> tuple[np.ndarray, np.ndarray]:
        """δ = 0 and -r δ′, because the impact is an instant."""
        rebound = -self.restitution * np.asarray(velocity)
        return np.zeros(rebound.shape), rebound

    def derivative(self, duration: Any, phase: Any, velocity: Any, amplitude: Any) -> np.ndarray:
        """The phase stays, and the velocity is multiplied by -r."""
        slope = -self.restitution + 0.0 * np.asarray(velocity)
        return matrix_of(np.ones_like(slope), 0.0 * slope, 0.0 * slope, slope)

    def contraction(self, duration: Any) -> Any:
        """r²."""
        return self.restitution**2 + 0.0 * np.asarray(duration)

    def in_contact(
        self, time: Any, phase: Any, velocity: Any, amplitude: Any, displacement: Any = 0.0
    ) -> tuple[np.ndarray, np.ndarray]:
        """δ = δ′ = 0: the ball rests on the table, apart from the bounces that are summed up."""
        return np.zeros(np.shape(time)), np.zeros(np.shape(time))

    def permanent_contact_threshold(self) -> Any:
        """Λ_CR = 1 (Eq. 9)."""
        return np.full(self.shape, RESTITUTION_THRESHOLD)[()]


@suggesting
def rigid(*, restitution: RigidRestitutionAxis) -> RestitutionModel:
    """A ball of the restitution model, whose impacts are instants (Eqs. 1-9).

    Parameters
    ----------
    restitution : float or array
        Restitution coefficient r in [0, 1]. A ball with r = 0 stays on the table after an impact,
        unless the table falls away faster than the ball.

    Raises
    ------
    ModelError
        If r is no number in its range.

    Examples
    --------
    >>> rigid(restitution=0.85)
    RestitutionModel(restitution=0.85)
    """
    r = checked("restitution", restitution, RIGID_RESTITUTION)
    # An array with a named axis is a row here, and keeps its axis in the results.
    return RestitutionModel(np.ravel(r) if np.ndim(r) else r).labelled({"restitution": r})

r"""n-T orbits and their linearisation, with one equation or another altered.

The baseline is the paper's system (Eqs. 11-26). Every alteration is a number
in :class:`Altered`, so that many of them are solved in one sweep of arrays.
The contact is not that of :mod:`bouncing_ball.contacts.spring_damper` but the paper's
own formula (Eqs. 12-13), in which a slip of the pen can be imitated::

    δ = Re(K e^{μs}) + Im(H (X + iY) e^{is}) - κ/ϖ²,    μ = -ζϖ + iϖ_d
    H = (ϖ² - 1 - 2iζϖ)/γ,    γ = (ϖ² - 1)² + (2ζϖ)²

with X = Λ cos φ, Y = Λ sin φ, u = δ′ at the start, and K from δ = 0, δ′ = u at
s = 0. At a fixed duration D the release, the velocity and the landing are
linear in (X, Y, u) under every alteration, so that one 3×3 solve gives the
orbit, as in :mod:`bouncing_ball.orbits.spring_damper_branch`.

All quantities are dimensionless; all functions broadcast.
"""

from typing import NamedTuple

import numpy as np


class Altered(NamedTuple):
    """The system of equations: the paper's where nothing else is said.

    ``frequency_ratio``, ``damping_ratio``, ``n`` are ϖ, ζ and n. The others,
    0 or 1, are

    * ``weight`` κ: gravity acts during contact (Eq. 11);
    * ``force``: the contact ends where its force vanishes, not at δ = 0 (Eq. 23);
    * ``damped``: the transient oscillates at ϖ_d = ϖ√(1 - ζ²), else at ϖ (Eq. 12);
    * ``squared``: γ holds (2ζϖ)², else 2ζϖ (Eqs. 12-13);
    * ``rise``: the flight knows the table's displacement (Eq. 25); else it is
      Holmes' high bounce, ``z′_b T - T²/2 = 0``;
    * ``linear_rise``: the same in the linearised flight;
    * ``timed``: the linearisation knows that the contact's duration varies.

    ``share`` and ``lift`` are the criterion of the period doubling: Λ sin(φ + share·D)
    equal to ``lift``, or to ``2(1 + r_a²)/(1 + r_a)²`` if lift is 0; 1 + tr + det = 0
    if ``share`` is negative.
    """

    frequency_ratio: np.ndarray
    damping_ratio: np.ndarray
    n: np.ndarray
    weight: np.ndarray | float = 1.0
    force: np.ndarray | float = 0.0
    damped: np.ndarray | float = 1.0
    squared: np.ndarray | float = 1.0
    rise: np.ndarray | float = 1.0
    linear_rise: np.ndarray | float = 1.0
    timed: np.ndarray | float = 1.0
    share: np.ndarray | float = -1.0
    lift: np.ndarray | float = 0.0

    @property
    def transient_frequency(self) -> np.ndarray:
        """ϖ_d, or ϖ where the transient is not damped in frequency."""
        zeta = self.damping_ratio
        root = np.sqrt((1 - zeta) * (1 + zeta))
        return self.frequency_ratio * np.where(self.damped, root, 1.0)

    @property
    def free_angle(self) -> np.ndarray:
        """Angle ϖ_d D at which the free, weightless contact ends."""
        return np.pi - 2 * self.force * np.arcsin(self.damping_ratio)


class AlteredOrbit(NamedTuple):
    """D, X = Λ cos φ, Y = Λ sin φ, u and v: δ′ at the start and the end of contact."""

    contact_duration: np.ndarray
    x: np.ndarray
    y: np.ndarray
    impact: np.ndarray
    bounce: np.ndarray

    @property
    def amplitude(self) -> np.ndarray:
        """Λ."""
        return np.hypot(self.x, self.y)

    @property
    def phase(self) -> np.ndarray:
        """φ in (-π, π]."""
        return np.arctan2(self.y, self.x)

    @property
    def touches(self) -> np.ndarray:
        """Whether the ball comes down on the table and leaves it upwards."""
        return (self.impact < 0) & (self.bounce > 0)


class _Forms(NamedTuple):
    """δ, δ′ and δ″ at time D as coefficients of X, Y, u and 1, and A and B."""

    displacement: list[np.ndarray]
    velocity: list[np.ndarray]
    acceleration: list[np.ndarray]
    transient: list[tuple[np.ndarray, np.ndarray]]


def _forms(time, model: Altered) -> _Forms:
    omega, zeta = model.frequency_ratio, model.damping_ratio
    decay, loss, wave = zeta * omega, 2 * zeta * omega, model.transient_frequency
    detuning = omega * omega - 1
    gamma = detuning * detuning + np.where(model.squared, loss * loss, loss)
    gain = (detuning - 1j * loss) / gamma
    turn, mu = np.exp(1j * time), -decay + 1j * wave
    free = np.exp(mu * time)
    out = _Forms([], [], [], [])
    sag = -model.weight / (omega * omega)
    for steady, level, push in (
        (gain, 0.0, 0.0),
        (1j * gain, 0.0, 0.0),
        (0j, 0.0, 1.0),
        (0j, sag, 0.0),
    ):
        # A cos + B sin from δ = 0 and δ′ = u at the start of contact.
        a = np.asarray(-(np.imag(steady) + level))
        b = (push - np.real(steady) + decay * a) / wave
        k, forced = (a - 1j * b) * free, steady * turn
        out.displacement.append(np.real(k) + np.imag(forced) + level)
        out.velocity.append(np.real(mu * k) + np.real(forced))
        out.acceleration.append(np.real(mu * mu * k) - np.imag(forced))
        out.transient.append((a, b))
    return out


def _apply(form, x, y, u, one):
    return x * form[0] + y * form[1] + u * form[2] + one * form[3]


def altered_orbit(excess: np.ndarray, model: Altered) -> AlteredOrbit:
    """The n-T orbit whose contact lasts ``D = (θ₀ + ε)/ϖ_d``.

    Examples
    --------
    Without damping, an infinitely stiff contact has Λ sin φ = 1 at ε = 0:

    >>> orbit = altered_orbit(np.array(0.0), Altered(np.array(1e5), np.array(0.0), 1))
    >>> round(float(orbit.y), 3), round(float(orbit.impact / np.pi), 3)
    (1.0, -1.0)
    """
    duration = (model.free_angle + excess) / model.transient_frequency
    flight = 2 * np.pi * model.n - duration
    forms = _forms(duration, model)
    d, v = forms.displacement, forms.velocity
    cos, sin = np.cos(duration), np.sin(duration)
    versine = -2 * np.sin(duration / 2) ** 2
    scale, lag = model.frequency_ratio, 2 * model.damping_ratio * model.force
    rise = model.rise
    # Release; z′_b as δ′ + w′ and as z′_i + T; landing. δ_b is 0 unless the force
    # ends the contact.
    rows = np.stack(
        np.broadcast_arrays(
            *(scale * d[k] + lag * v[k] for k in (0, 1, 2)),
            v[0] + cos - 1,
            v[1] - sin,
            v[2] - 1,
            rise * (model.force * d[0] + sin) + flight,
            rise * (model.force * d[1] + versine),
            rise * model.force * d[2] + flight,
        ),
        axis=-1,
    )
    right = np.stack(
        np.broadcast_arrays(
            -scale * d[3] - lag * v[3],
            flight - v[3],
            -flight * flight / 2 - rise * model.force * d[3],
        ),
        axis=-1,
    )
    solution = np.linalg.solve(rows.reshape(*rows.shape[:-1], 3, 3), right[..., np.newaxis])
    x, y, u = np.moveaxis(solution[..., 0], -1, 0)
    return AlteredOrbit(duration, x, y, u, _apply(v, x, y, u, 1.0))


@np.errstate(divide="ignore", invalid="ignore")
def altered_monodromy(orbit: AlteredOrbit, model: Altered) -> np.ndarray:
    """Jacobian of (τ, u) → (τ₁, u₁) over one cycle, shape (2, 2, ...).

    Infinite or not a number where the ball grazes at impact or release.
    """
    duration, x, y, u, bounce = orbit
    forms = _forms(duration, model)
    cos, sin = np.cos(duration), np.sin(duration)
    # The table's velocity and (negative) acceleration at release.
    leaving, lifted = x * cos - y * sin, y * cos + x * sin
    acceleration = _apply(forms.acceleration, x, y, u, 1.0)
    flight = 2 * np.pi * model.n - duration
    lag = 2 * model.damping_ratio * model.force
    slope = model.frequency_ratio * bounce + lag * acceleration
    columns = []
    # Along τ, the phase at the start: X → -Y, Y → X; then along u.
    for direction, moved in (((-y, x, 0.0, 0.0), 1.0), ((0.0, 0.0, 1.0, 0.0), 0.0)):
        displaced = _apply(forms.displacement, *direction)
        thrown = _apply(forms.velocity, *direction)
        stay = -model.timed * (model.frequency_ratio * displaced + lag * thrown) / slope
        phase = moved + stay
        risen = displaced + bounce * stay + leaving * phase
        thrown = thrown + acceleration * stay - lifted * phase
        # High bounce: the landing is where z′_b T - T²/2 keeps its value.
        rise = model.linear_rise
        hang = -(rise * (risen - x * phase) + flight * thrown) / (u + x - rise * x)
        landing = phase + hang
        columns.append((landing, thrown - hang + y * landing))
    return np.array([[columns[0][0], columns[1][0]], [columns[0][1], columns[1][1]]])


def continuation_unknowns(orbit: AlteredOrbit, model: Altered) -> np.ndarray:
    """The paper's unknowns z′_i, z′_b, τ_b, φ, A, B, and Λ, along a first axis.

    A and B are those of Eqs. 12-13, at the start of contact.
    """
    transient = _forms(orbit.contact_duration, model).transient
    a, b = (
        _apply([pair[k] for pair in transient], orbit.x, orbit.y, orbit.impact, 1.0) for k in (0, 1)
    )
    start = orbit.impact + orbit.x
    end = start + 2 * np.pi * model.n - orbit.contact_duration
    return np.stack([start, end, orbit.contact_duration, orbit.phase, a, b, orbit.amplitude])

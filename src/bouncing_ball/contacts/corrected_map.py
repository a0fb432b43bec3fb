r"""The restitution model, corrected: an impact is an instant in the right place.

At the instant the table has the phase ψ and the ball, in its continued flight,
the absolute velocity p. It is below the table by h, and turns its closing
speed v into ``r_c v = r v + σ a`` with the load ``a = 1 - Λ sin ψ``::

    v = Λ cos ψ - p
    z = Λ sin ψ - h,                h = v t_c(v)
    w = Λ cos ψ + r(v) v + σ(v) a

From (ψ, z, w) the ball flies until it is below the table by h again: the
restitution map (Eq. 5) with the table lowered by h(v) and r replaced by
``r_c = r + σ a/v``, and that map itself for t_c = σ = 0. The contact starts t_c
before the instant, at φ = ψ - t_c with z′ = p + t_c, and ends D later; t_c, r, σ
and D are the law's :mod:`signature <bouncing_ball.contacts.signature>`.

All quantities are dimensionless; all functions broadcast.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.contacts.signature import Instant, Signature

# Iterations of ψ = φ + t_c(v), for laws whose delay depends on the speed. Each
# gains a factor a dt_c/dv, of the order of a D/v.
_ITERATIONS = 30
_SETTLED = 1e-15


class Hit(NamedTuple):
    """An instant: phase ψ, velocity p before, and what follows from them.

    ``speed`` is v, ``depth`` h, ``height`` and ``velocity`` the absolute z and w
    just after; ``instant`` the signature at v.
    """

    phase: np.ndarray
    arrival: np.ndarray
    speed: np.ndarray
    depth: np.ndarray
    height: np.ndarray
    velocity: np.ndarray
    instant: Instant


def impact(signature: Signature, amplitude: ArrayLike, phase: ArrayLike, arrival: ArrayLike) -> Hit:
    """The instant at a phase ψ of the table, with absolute velocity p before it.

    Examples
    --------
    An elastic ball on a table at rest, with a contact of duration 1:

    >>> from bouncing_ball.contacts.signature import Signature
    >>> from bouncing_ball.contacts.spring_damper import SpringDamper
    >>> hit = impact(Signature(SpringDamper(np.pi, 0.0)), 0.0, 0.0, -2.0)
    >>> float(hit.velocity), float(hit.depth)
    (2.0, 1.0)
    """
    lam, psi, p = (np.asarray(x, dtype=float) for x in (amplitude, phase, arrival))
    x, y = lam * np.cos(psi), lam * np.sin(psi)
    speed = x - p
    law = signature(speed)
    depth = speed * law.delay
    after = x + law.restitution * speed + law.load * (1 - y)
    return Hit(psi, p, speed, depth, y - depth, after, law)


def meeting(
    signature: Signature, amplitude: ArrayLike, phase: ArrayLike, velocity: ArrayLike
) -> tuple[np.ndarray, np.ndarray]:
    """(ψ, p) of a contact that starts at φ with the absolute velocity z′ of the ball.

    Examples
    --------
    >>> from bouncing_ball.contacts.signature import Signature
    >>> from bouncing_ball.contacts.spring_damper import SpringDamper
    >>> psi, p = meeting(Signature(SpringDamper(np.pi, 0.0)), 0.0, 0.25, -1.5)
    >>> float(psi), float(p)
    (0.75, -2.0)
    """
    lam, phi, z = (np.asarray(x, dtype=float) for x in (amplitude, phase, velocity))
    delay = signature(lam * np.cos(phi) - z).delay
    for _ in range(0 if signature.is_constant else _ITERATIONS):
        before = delay
        delay = signature(lam * np.cos(phi + delay) - (z - delay)).delay
        if np.all((np.abs(delay - before) <= _SETTLED * delay) | np.isnan(delay)):
            break
    return phi + delay, z - delay


def start_of(amplitude: ArrayLike, hit: Hit) -> tuple[np.ndarray, np.ndarray]:
    """(φ, δ′) of the start of contact, t_c before the instant."""
    delay = hit.instant.delay
    phase = hit.phase - delay
    return phase, hit.arrival + delay - np.asarray(amplitude) * np.cos(phase)


def instant_jacobian(amplitude: ArrayLike, hit: Hit, flight_time: ArrayLike, following: Hit):
    """Jacobian of the map (ψ, p) → (ψ₁, p₁) between instants, shape (..., 2, 2).

    Parameters
    ----------
    amplitude : array_like
        Λ.
    hit, following : Hit
        An instant and the next.
    flight_time : array_like
        Time between them.
    """
    lam, time = np.asarray(amplitude, dtype=float), np.asarray(flight_time, dtype=float)
    x, y, d_depth = _at(lam, hit)
    law = hit.instant
    by_speed = law.restitution + law.d_restitution * hit.speed + law.d_load * (1 - y)
    next_x, next_y, next_d_depth = _at(lam, following)
    # Landing: z + w T - T²/2 = Λ sin ψ₁ - h(Λ cos ψ₁ - p₁), ψ₁ = ψ + T, p₁ = w - T.
    by_time = -following.speed - next_d_depth * (next_y - 1)
    columns = []
    for d_psi, d_p in ((1.0, 0.0), (0.0, 1.0)):
        d_speed = -y * d_psi - d_p
        d_height = x * d_psi - d_depth * d_speed
        d_after = by_speed * d_speed - (y + law.load * x) * d_psi
        gap = d_height + time * d_after - next_x * d_psi
        gap = gap - next_d_depth * (next_y * d_psi + d_after)
        d_time = -gap / by_time
        columns.append(np.stack(np.broadcast_arrays(d_psi + d_time, d_after - d_time), axis=-1))
    return np.stack(columns, axis=-1)


def _at(lam, hit: Hit):
    """Λ cos ψ, Λ sin ψ and dh/dv."""
    law = hit.instant
    return lam * np.cos(hit.phase), lam * np.sin(hit.phase), law.delay + law.d_delay * hit.speed


def start_jacobian(amplitude: ArrayLike, hit: Hit) -> np.ndarray:
    """Jacobian of (φ, δ′) in (ψ, p), shape (..., 2, 2)."""
    lam = np.asarray(amplitude, dtype=float)
    y, d_delay = lam * np.sin(hit.phase), np.asarray(hit.instant.d_delay)
    fall = lam * np.sin(hit.phase - hit.instant.delay)
    columns = []
    for d_psi, d_p in ((1.0, 0.0), (0.0, 1.0)):
        later = d_delay * (-y * d_psi - d_p)
        d_phase = d_psi - later
        columns.append(
            np.stack(np.broadcast_arrays(d_phase, d_p + later + fall * d_phase), axis=-1)
        )
    return np.stack(columns, axis=-1)

"""The corrected restitution map: each contact is an instantaneous impact at its centroid.

At this instant the table has the phase ψ, and the ball, on its continued flight, has
the absolute velocity p and is below the table by h. The impact turns the closing
speed v into ``r_c v = r v + σ a`` with the load ``a = 1 - Λ sin ψ``::

    v = Λ cos ψ - p
    z = Λ sin ψ - h,                h = v t_c(v)
    w = Λ cos ψ + r(v) v + σ(v) a

From (ψ, z, w) the ball flies until it is below the table by h again. This is the
restitution map (Eq. 5) with the table lowered by h(v) and r replaced by
``r_c = r + σ a/v``; for t_c = σ = 0 it is Eq. 5. The contact starts t_c
before the instant, at φ = ψ - t_c with z′ = p + t_c, and ends D later; t_c, r, σ
and D are the law's :mod:`signature <bouncing_ball_beyond.models.laws.signature>`.

All quantities are dimensionless; all functions broadcast.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.numerics.elementary import sine_and_versine
from bouncing_ball_beyond.models.instant import Instant
from bouncing_ball_beyond.models.laws.signature import Signature

# Steps of Newton's method for ψ = φ + t_c(v), for laws whose delay depends on the speed.
_ITERATIONS = 30
_SETTLED = 1e-15


class Hit(NamedTuple):
    """An impact at its instant: the table's ``phase`` ψ, and ``arrival``, the velocity p before it.

    ``speed`` is v, ``depth`` is h, ``height`` and ``velocity`` are the absolute z and w
    just after the impact, and ``instant`` is the signature at v.
    """

    phase: np.ndarray
    arrival: np.ndarray
    speed: np.ndarray
    depth: np.ndarray
    height: np.ndarray
    velocity: np.ndarray
    instant: Instant


def impact(
    signature: Callable[[np.ndarray], Instant],
    amplitude: ArrayLike,
    phase: ArrayLike,
    arrival: ArrayLike,
) -> Hit:
    """The impact at a phase ψ of the table, with the absolute velocity p before it.

    Examples
    --------
    An elastic ball on a table at rest, with a contact of duration 1:

    >>> from bouncing_ball_beyond.models.laws.signature import Signature
    >>> from bouncing_ball_beyond.models.spring_damper import SpringDamper
    >>> hit = impact(Signature(SpringDamper(np.pi, 0.0)), 0.0, 0.0, -2.0)
    >>> float(hit.velocity), float(hit.depth)
    (2.0, 1.0)
    """
    lam, psi, p = (np.asarray(x, dtype=float) for x in (amplitude, phase, arrival))
    sine, versine = sine_and_versine(psi)
    cosine = 1 - versine
    x = lam * cosine
    y = lam * sine
    speed = x - p
    instant = signature(speed)
    depth = speed * instant.delay
    after = x + instant.restitution * speed + instant.load * (1 - y)
    return Hit(
        phase=psi,
        arrival=p,
        speed=speed,
        depth=depth,
        height=y - depth,
        velocity=after,
        instant=instant,
    )


def meeting(
    signature: Signature, amplitude: ArrayLike, phase: ArrayLike, velocity: ArrayLike
) -> tuple[np.ndarray, np.ndarray]:
    """ψ and p of the contact that starts at φ, where the ball has the absolute velocity z′.

    Examples
    --------
    >>> from bouncing_ball_beyond.models.laws.signature import Signature
    >>> from bouncing_ball_beyond.models.spring_damper import SpringDamper
    >>> psi, p = meeting(Signature(SpringDamper(np.pi, 0.0)), 0.0, 0.25, -1.5)
    >>> float(psi), float(p)
    (0.75, -2.0)
    """
    lam, phi, z = (np.asarray(x, dtype=float) for x in (amplitude, phase, velocity))
    delay = signature(lam * (1 - sine_and_versine(phi)[1]) - z).delay
    for _ in range(0 if signature.is_constant else _ITERATIONS):
        sine, versine = sine_and_versine(phi + delay)
        cosine = 1 - versine
        instant = signature(lam * cosine - (z - delay))
        # The speed changes by the load.
        slope = 1 - instant.d_delay * (1 - lam * sine)
        step = (instant.delay - delay) / slope
        delay = delay + step
        if np.all((np.abs(step) <= _SETTLED * delay) | np.isnan(delay)):
            break
    return phi + delay, z - delay


def start_of(amplitude: ArrayLike, hit: Hit) -> tuple[np.ndarray, np.ndarray]:
    """φ and δ′ at the start of contact, t_c before the instant: the inverse of :func:`meeting`.

    The velocity is relative to the table.

    Examples
    --------
    >>> from bouncing_ball_beyond.models.laws.signature import Signature
    >>> from bouncing_ball_beyond.models.spring_damper import SpringDamper
    >>> hit = impact(Signature(SpringDamper(np.pi, 0.0)), 0.0, 0.75, -2.0)
    >>> [float(x) for x in start_of(0.0, hit)]
    [0.25, -1.5]
    """
    delay = hit.instant.delay
    phase = hit.phase - delay
    return phase, hit.arrival + delay - np.asarray(amplitude) * (1 - sine_and_versine(phase)[1])

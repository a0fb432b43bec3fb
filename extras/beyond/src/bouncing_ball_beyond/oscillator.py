"""The linear contact: a spring and a damper under the motion of any table.

δ″ + 2ζϖδ′ + ϖ²δ = -1 - w″ (Eq. 11). The motion is a sum of the responses at rest: g(s) to an
impulse, (1 - K)/ϖ² to a constant force, with K = g′ + 2ζϖg, and h = C + iS to e^{iks}::

    h = (e^{iks} - K - ikg)/(ϖ² - k² + 2ikζϖ)

Written with 1 - K and 1 - cos ks, short contacts lose no digits. Where terms cancel, near a
resonance ϖ = k and near ζ = 1, the responses are found by doublings. All functions take arrays;
motions also complex ones. The loops of :mod:`.one_ball` have the same formulas for a sine and for
numbers, because numba compiles them.
"""

from typing import NamedTuple

import numpy as np

from bouncing_ball_beyond.tables import swing

DELICATE = 0.25
"""A contact with |ϖ² - k² + 2ikζϖ| < k DELICATE is near a resonance."""

UNDERDAMPED = 0.99
"""Contacts with a larger ζ are found by doublings when a release is searched for."""


class Motion(NamedTuple):
    """A contact at a time: δ and δ′, and what each harmonic of -w″ and of -w‴ is."""

    gap: np.ndarray
    speed: np.ndarray
    pushes: list
    shoves: list


def resonates(ratio, zeta, orders=(1,)):
    """Whether ϖ is next to a harmonic of the table, and hardly damped."""
    near = False
    for k in orders:
        detuning = ratio * ratio - k * k
        loss = 2 * zeta * ratio * k
        near = near | (detuning * detuning + loss * loss < (k * DELICATE) ** 2)
    return near


def free_responses(s, ratio, zeta):
    """g, g′ and 1 - K, for a ζ that is not next to 1."""
    over = np.real(zeta) > 1
    square = (1 - zeta) * (1 + zeta)
    omega = ratio * np.sqrt(np.where(over, 0.75, square))
    decay = np.where(over, 0.5, zeta) * ratio
    lost = -np.expm1(-decay * s)
    sine, versine = swing(omega * s)
    g = (1 - lost) * sine / omega
    cosine = (1 - lost) * (1 - versine)
    lost = lost + (1 - lost) * versine
    if np.any(over):
        root = np.sqrt(np.where(over, -square, 0.75))
        paces = ratio / (zeta + root), ratio * (zeta + root)
        slow, fast = (np.exp(-pace * s) for pace in paces)
        g = np.where(over, (slow - fast) / (2 * ratio * root), g)
        cosine = np.where(over, (slow + fast) / 2, cosine)
        lost = np.where(over, 1 - cosine, lost)
    return g, cosine - zeta * ratio * g, lost - zeta * ratio * g


def closed_motion(s, gap, u, table, waves, gravity, ratio, zeta):
    """A contact by the closed form (Eqs. 12 and 13), a time s after it started from δ′ = -u."""
    g, slope, lost = free_responses(s, ratio, zeta)
    loss = 2 * zeta * ratio
    stiffness = ratio * ratio
    position = gap * (1 - lost) - u * g - gravity * lost / stiffness
    speed = -u * slope - (gravity + gap * stiffness) * g
    pushes, shoves = [], []
    for k, x, y in table.each_wave(waves):
        sine, versine = swing(s if k == 1 else k * s)
        detuning = (ratio - k) * (ratio + k)
        scale = detuning * detuning + (k * loss) ** 2
        real = lost - versine
        imaginary = sine - k * g
        cosine_part = k * k * (real * detuning + imaginary * (k * loss)) / scale
        sine_part = k * k * (imaginary * detuning - real * (k * loss)) / scale
        position = position + (y * cosine_part + x * sine_part)
        speed = speed + (y * (k * k * g - k * sine_part) + k * x * cosine_part)
        pushes.append(k * k * (y * (1 - versine) + x * sine))
        shoves.append(k**3 * (x * (1 - versine) - y * sine))
    return Motion(position, speed, pushes, shoves)


def doubled_motion(s, gap, u, table, waves, gravity, ratio, zeta):
    """The same by a Taylor series over s/2^m and m doublings.

    Nothing is divided by, so that values and derivatives keep all digits. The responses are g, its
    rate, G to a constant force, and S to sin ks and C to cos ks of each harmonic::

        g″ + 2ζϖg′ + ϖ²g = 0,   g′(0) = 1,    G′ = g,    S′ = kC,    C′ = g - kS
    """
    loss = 2 * zeta * ratio
    stiffness = ratio * ratio
    orders = np.array(table.orders, float).reshape(-1, *(1 for _ in np.shape(s + 0 * loss)))

    size = np.max(np.abs(s) * (max(table.orders) + np.real(ratio) * (1 + 2 * np.real(zeta))))
    doublings = int(np.ceil(np.log2(np.maximum(size, 1.0))))
    part = (s + 0 * loss) / 2.0**doublings
    nothing = 0 * np.asarray(part)
    free = np.array([nothing, 1 + nothing, nothing])
    forced = np.zeros((2, len(orders), *np.shape(nothing)), nothing.dtype)
    term, sines = free, forced
    for j in range(1, 21):
        step = part / j
        g, rate, _ = term
        sine, cosine = sines
        sines = step * np.array([orders * cosine, g - orders * sine])
        term = step * np.array([rate, -loss * rate - stiffness * g, g])
        free = free + term
        forced = forced + sines
    g, rate, load = free
    sine, cosine = forced
    for _ in range(doublings):
        held = rate + loss * g
        a = held + np.cos(orders * part)
        b = orders * g + np.sin(orders * part)
        load = (1 + held) * load + g * g
        sine, cosine = a * sine + b * cosine, a * cosine - b * sine + g * g
        g, rate = g * (held + rate), rate * rate - stiffness * g * g
        part = 2 * part
    position = gap * (rate + loss * g) - u * g - gravity * load
    speed = -gap * stiffness * g - u * rate - gravity * g
    pushes, shoves = [], []
    for (k, x, y), of_sine, of_cosine in zip(table.each_wave(waves), sine, cosine, strict=True):
        position = position + k * k * (y * of_cosine + x * of_sine)
        speed = speed + k * k * (y * (g - k * of_sine) + k * x * of_cosine)
        sin = np.sin(k * s)
        cos = np.cos(k * s)
        pushes.append(k * k * (y * cos + x * sin))
        shoves.append(k**3 * (x * cos - y * sin))
    return Motion(position, speed, pushes, shoves)


def motion(s, gap, u, table, waves, gravity, ratio, zeta):
    """δ and δ′ a time s after an impact, by the formula that keeps all digits for each number."""
    delicate = np.abs(s * s * ratio * ratio * (1 - zeta * zeta)) < 1
    for k in table.orders:
        delicate = delicate | (np.abs(s * s * ((ratio - k) * (ratio - k) + zeta * zeta)) < 1)
    given = s, gap, u, *waves, gravity, ratio, zeta
    if not np.any(delicate):
        return closed_motion(s, gap, u, table, waves, gravity, ratio, zeta)[:2]
    if np.all(delicate):
        return doubled_motion(s, gap, u, table, waves, gravity, ratio, zeta)[:2]
    given = np.broadcast_arrays(*given)
    delicate = np.broadcast_to(delicate, given[0].shape)

    def ordered(values):
        return *values[:3], table, values[3:-3], *values[-3:]

    with np.errstate(all="ignore"):  # of the closed form where it is not used
        gap, speed = (np.array(each) for each in closed_motion(*ordered(given))[:2])
    some = doubled_motion(*ordered([each[delicate] for each in given]))
    gap[delicate], speed[delicate] = some[:2]
    return gap[()], speed[()]


def bounds(motion, table, waves, ratio, zeta, kappa, resonant):
    r"""f = -δ - κδ′, f′, δ″ and δ‴, K and J of the search for a release, and whether there is none.

    What f has besides its steady response and 1/ϖ² is a free oscillation F. Its energy e² = F′² +
    ϖ²F² never grows, so that from then on, with c² = 1 + 4ζ², ::

        \|F\| ≤ e/ϖ,    \|F″\| ≤ ϖ c e,    \|F‴\| ≤ ϖ² c √(1 + c²) e

    Next to a resonance, where ``resonant`` is 1 and not 0, F is all of f besides 1/ϖ², and forced
    by l = Σ|w″|√(1 + κ²k²) at most, so that e grows by 2l/ϖ at most in a time of 2/ϖ.
    """
    position, rate, pushes, shoves = motion
    loss = 2 * zeta * ratio
    stiffness = ratio * ratio
    second = sum(pushes) - 1 - loss * rate - stiffness * position
    third = sum(shoves) - loss * second - stiffness * rate
    f = -position - kappa * rate
    slope = -rate - kappa * second
    free = f - 1 / stiffness
    free_rate = slope
    held = bend_forced = jerk_forced = pushed = jerked = 0.0
    for (k, x, y), push, shove in zip(table.each_wave(waves), pushes, shoves, strict=True):
        detuning = (ratio - k) * (ratio + k)
        share = (1 - resonant) / (detuning * detuning + (k * loss) ** 2 + resonant)
        # The steady response of δ + κδ′.
        a = (detuning + kappa * loss * k * k) * share
        b = (kappa * detuning - loss) * share
        free = free + a * push + b * shove
        free_rate = free_rate + a * shove - k * k * b * push
        force = k * k * np.sqrt(x * x + y * y) * np.sqrt(1 + (kappa * k) ** 2)
        response = force * np.sqrt(share)
        held = held + response
        bend_forced = bend_forced + k * k * response
        jerk_forced = jerk_forced + k**3 * response
        pushed = pushed + force
        jerked = jerked + k * force
    energy = np.sqrt(free_rate * free_rate + stiffness * free * free)
    energy = energy + 2 * resonant * pushed / ratio
    growth = 1 + 4 * zeta * zeta
    bend = ratio * np.sqrt(growth) * energy
    jerk = ratio * np.sqrt(1 + growth) * bend + jerk_forced + resonant * (jerked + pushed * loss)
    bend = bend + bend_forced + resonant * pushed * (1 + loss)
    lasts = energy / ratio + held <= (1 - resonant) / stiffness
    return f, slope, second, third, bend, jerk, lasts

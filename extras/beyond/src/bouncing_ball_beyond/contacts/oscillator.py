"""Contacts of a ball with a spring and a damper, on any table.

The equation of motion is δ″ + 2ζϖδ′ + ϖ²δ = -1 - w″ (Eq. 11). The solution is a sum of responses
of an oscillator that starts at rest:

- g(s): response to an impulse;
- (1 - K)/ϖ²: response to a constant force, where K = g′ + 2ζϖg;
- h = C + iS: response to e^{iks}::

      h = (e^{iks} - K - ikg)/(ϖ² - k² + 2ikζϖ)

The formulas contain 1 - K and 1 - cos ks, so results for short contacts keep all digits. Near a
resonance ϖ = k and near ζ = 1, terms of these formulas cancel. There the responses are computed by
*doublings* (:func:`doubled_motion`). Motions may be complex.
"""

from math import factorial
from typing import Any, NamedTuple

import numpy as np

from bouncing_ball_beyond.tables.table import Table, Values, swing

DELICATE = 0.25
"""Limit of |ϖ² - k² + 2ikζϖ|/k below which a contact is near a resonance.

At half: 7 % faster. At twice: 17 % slower. The results are the same.
"""

UNDERDAMPED = 0.99
"""Damping ratio above which contacts are computed by doublings.

At half and at twice of 1 - ζ: no effect.
"""

TERMS = 20
"""Number of terms of the Taylor series, which are used for times of at most 1.

At half: errors of 3e-11. At twice: 10 % slower.
"""

FACTORS = np.array([[1 / factorial(j + n) for j in range(TERMS)] for n in range(4)])
"""1/(j + n)!: factor of derivative j in the Taylor series of an n-fold integral."""


class Motion(NamedTuple):
    """State of a contact at one time.

    Attributes
    ----------
    gap, speed : array
        δ and δ′.
    pushes, shoves : list of array
        Contributions of the harmonics to -w″ and -w‴, one entry per harmonic.
    """

    gap: np.ndarray
    speed: np.ndarray
    pushes: list
    shoves: list


def resonates(ratio: Values, zeta: Values, orders: tuple[int, ...] = (1,)) -> Values:
    """Whether a contact is near a resonance with a harmonic of the table; see `DELICATE`."""
    near: Values = np.False_
    for k in orders:
        detuning = ratio * ratio - k * k
        loss = 2 * zeta * ratio * k
        near = near | (detuning * detuning + loss * loss < (k * DELICATE) ** 2)
    return near


def free_responses(s: Values, ratio: Values, zeta: Values) -> tuple:
    """Return g, g′ and 1 - K for ζ < 1. ζ must not be close to 1, where terms cancel."""
    omega = ratio * np.sqrt((1 - zeta) * (1 + zeta))
    decay = zeta * ratio
    lost = -np.expm1(-decay * s)
    sine, versine = swing(omega * s)
    envelope = 1 - lost
    g = envelope * sine / omega
    wave = envelope * versine
    drag = decay * g
    return g, envelope - wave - drag, lost + wave - drag


def closed_motion(
    s: Values,
    gap: Values,
    u: Values,
    table: Table,
    waves: list,
    gravity: Values,
    ratio: Values,
    zeta: Values,
    *,
    loads: bool = True,
) -> Motion:
    """Return the state of a contact at the time s after its start, in closed form (Eqs. 12, 13).

    The contact starts with δ = gap and δ′ = -u. ``waves`` represents the motion of the table from
    the start (:meth:`.Table.waves`). If ``loads`` is false, the pushes and shoves stay empty.
    """
    g, slope, lost = free_responses(s, ratio, zeta)
    loss = 2 * zeta * ratio
    stiffness = ratio * ratio
    position = gap * (1 - lost) - u * g - gravity / stiffness * lost
    speed = -u * slope - (gravity + gap * stiffness) * g
    pushes, shoves = [], []
    for k, x, y in table.each_wave(waves):
        damped = loss if k == 1 else k * loss
        detuning = (ratio - k) * (ratio + k)
        scale = detuning * detuning + damped * damped
        sine, versine = swing(s if k == 1 else k * s)
        if k > 1:
            # The load -w″ of harmonic k is k² times its height.
            x, y = k * k * x, k * k * y
        # Divide before multiplying by functions of s: the quotients are a few real numbers.
        in_phase, behind = detuning / scale, damped / scale
        real = lost - versine
        imaginary = sine - (g if k == 1 else k * g)
        of_cosine = real * in_phase + imaginary * behind
        of_sine = imaginary * in_phase - real * behind
        position = position + (y * of_cosine + x * of_sine)
        if k == 1:
            speed = speed + (y * (g - of_sine) + x * of_cosine)
        else:
            speed = speed + (y * (g - k * of_sine) + k * x * of_cosine)
        if loads:
            pushes.append(y * (1 - versine) + x * sine)
            shove = x * (1 - versine) - y * sine
            shoves.append(shove if k == 1 else k * shove)
    return Motion(position, speed, pushes, shoves)


def doubled_motion(
    s: Values,
    gap: Values,
    u: Values,
    table: Table,
    waves: list,
    gravity: Values,
    ratio: Values,
    zeta: Values,
    *,
    loads: bool = True,
) -> Motion:
    """Compute the state of a contact of :func:`closed_motion` by doublings.

    Taylor series give the responses at the time s/2^m, and each of m doublings doubles the time.
    This involves no division, so no digits are lost at resonances. The responses are g and g′ to an
    impulse, G to a constant force, S to sin ks, and C to cos ks::

        g″ + 2ζϖg′ + ϖ²g = 0,   g′(0) = 1,    G′ = g,    S′ = kC,    C′ = g - kS
    """
    loss = 2 * zeta * ratio
    stiffness = ratio * ratio
    size = np.abs(s) * (max(table.orders) + np.real(ratio) * (1 + 2 * np.real(zeta)))
    largest = np.max(size, initial=1.0, where=np.isfinite(size))
    doublings = int(np.ceil(np.log2(largest)))
    part = (s + 0 * loss) / 2.0**doublings
    square = part * part
    # Derivatives j of g′ at 0, times part^j. Below, `bends` contains the derivatives of C″.
    rates = np.empty((TERMS, *np.shape(part)), np.asarray(part).dtype)
    rates[0] = 1.0
    rates[1] = damped = -loss * part
    pulled = stiffness * square
    for j in range(2, TERMS):
        rates[j] = damped * rates[j - 1] - pulled * rates[j - 2]
    rate, g, load = _series(rates, 0, 1, 2)
    g, load = part * g, square * load
    forced = []
    for k in table.orders:
        turned = k * k * square
        bends = rates.copy()
        for j in range(2, TERMS):
            bends[j] -= turned * bends[j - 2]
        of_cosine, of_sine = _series(bends, 2, 3)
        forced += [k * square * part * of_sine, square * of_cosine]
    for _ in range(doublings):
        held = rate + loss * g
        for i, k in enumerate(table.orders):
            sine, cosine = forced[2 * i : 2 * i + 2]
            a = held + np.cos(k * part)
            b = k * g + np.sin(k * part)
            forced[2 * i] = a * sine + b * cosine
            forced[2 * i + 1] = a * cosine - b * sine + g * g
        load = (1 + held) * load + g * g
        g, rate = g * (held + rate), rate * rate - stiffness * g * g
        part = 2 * part
    position = gap * (rate + loss * g) - u * g - gravity * load
    speed = -gap * stiffness * g - u * rate - gravity * g
    pushes, shoves = [], []
    responses = zip(table.each_wave(waves), forced[::2], forced[1::2], strict=True)
    for (k, x, y), of_sine, of_cosine in responses:
        position = position + k * k * (y * of_cosine + x * of_sine)
        speed = speed + k * k * (y * (g - k * of_sine) + k * x * of_cosine)
        if loads:
            sin = np.sin(k * s)
            cos = np.cos(k * s)
            pushes.append(k * k * (y * cos + x * sin))
            shoves.append(k**3 * (x * cos - y * sin))
    return Motion(position, speed, pushes, shoves)


def _series(derivatives: Values, *integrals: int) -> list:
    """Return n-fold integrals of a function, divided by timeⁿ, for several n.

    ``derivatives`` contains timeʲ times the derivative of order j at 0, shape (TERMS, ...).
    """
    flat = derivatives.reshape(TERMS, -1)
    return [(FACTORS[n] @ flat).reshape(derivatives.shape[1:]) for n in integrals]


def motion(
    s: Values,
    gap: Values,
    u: Values,
    table: Table,
    waves: list,
    gravity: Values,
    ratio: Values,
    zeta: Values,
) -> tuple:
    """Return δ and δ′ at the time s after the start of a contact.

    They are computed by doublings if the closed form loses digits for one of the elements.
    """
    time, frequency, damping = np.real(s), np.real(ratio), np.real(zeta)
    square = time * time
    delicate = square * (frequency * frequency * np.abs(1 - damping * damping)) < 1
    for k in table.orders:
        apart = frequency - k
        delicate = delicate | (square * (apart * apart + damping * damping) < 1)
    loses = np.any(damping > UNDERDAMPED) or np.any(delicate)
    method = doubled_motion if loses else closed_motion
    return method(s, gap, u, table, waves, gravity, ratio, zeta, loads=False)[:2]


def forcing(
    table: Table, waves: list, ratio: Values, zeta: Values, kappa: Values, resonant: Values
) -> tuple:
    """Return four numbers for :func:`bounds` that are constant during a contact.

    F is the free oscillation of the release function (docs/impacts.md).

    1. The largest steady response of δ + κδ′ to the table.
    2. The contribution of the table to K: the largest second derivative of this response.
    3. The contribution of the table to J: the largest third derivative of this response.
    4. The largest growth of the energy e of F. It is 0 away from resonances.

    Near a resonance F includes the steady response. The first bound is then 0, and the second and
    the third bound follow from the forces.
    """
    loss = 2 * zeta * ratio
    held = bend = jerk = pushed = jerked = 0.0
    for k, x, y in table.each_wave(waves):
        detuning = (ratio - k) * (ratio + k)
        share = (1 - resonant) / (detuning * detuning + (k * loss) ** 2 + resonant)
        force = k * k * np.sqrt(x * x + y * y) * np.sqrt(1 + (kappa * k) ** 2)
        response = force * np.sqrt(share)
        held = held + response
        bend = bend + k * k * response
        jerk = jerk + k**3 * response
        pushed = pushed + force
        jerked = jerked + k * force
    bend = bend + resonant * pushed * (1 + loss)
    jerk = jerk + resonant * (jerked + pushed * loss)
    return held, bend, jerk, 2 * resonant * pushed / ratio


def bounds(
    motion: Values,
    table: Table,
    forced: Any,
    ratio: Values,
    zeta: Values,
    kappa: Values,
    resonant: Values,
) -> tuple:
    """Return f, f′, δ″, δ‴, K, J and whether the contact is permanent.

    f = -δ - κδ′ is the release function; K and J are bounds of its derivatives (:mod:`.one_ball`).
    These bounds follow from an energy that never grows (docs/impacts.md). ``motion`` is a
    :class:`Motion`, and ``forced`` is the result of :func:`forcing`. ``resonant`` is 1 near a
    resonance, and otherwise 0.
    """
    position, rate, pushes, shoves = motion
    held, bend_forced, jerk_forced, gained = forced
    loss = 2 * zeta * ratio
    stiffness = ratio * ratio
    push, shove = (parts[0] if len(parts) == 1 else sum(parts) for parts in (pushes, shoves))
    second = push - 1 - loss * rate - stiffness * position
    third = shove - loss * second - stiffness * rate
    f = -position - kappa * rate
    slope = -rate - kappa * second
    free = f - 1 / stiffness
    free_rate = slope
    for k, push, shove in zip(table.orders, pushes, shoves, strict=True):
        detuning = (ratio - k) * (ratio + k)
        damped = loss if k == 1 else k * k * loss
        share = (1 - resonant) / (detuning * detuning + damped * loss + resonant)
        # The steady response of δ + κδ′.
        a = (detuning + kappa * damped) * share
        b = (kappa * detuning - loss) * share
        free = free + (a * push + b * shove)
        free_rate = free_rate + (a * shove - (b if k == 1 else k * k * b) * push)
    energy = np.sqrt(free_rate * free_rate + stiffness * free * free) + gained
    growth = 1 + 4 * zeta * zeta
    bend = ratio * np.sqrt(growth) * energy
    jerk = ratio * np.sqrt(1 + growth) * bend + jerk_forced
    stays = energy / ratio + held <= (1 - resonant) / stiffness
    return f, slope, second, third, bend + bend_forced, jerk, stays

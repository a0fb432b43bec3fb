r"""Use scalar loops to follow one ball from impact to impact on a sinusoidal table.

Landings and releases are first zeros of functions f ≥ 0. Bounds of the derivatives, f″ ≥ -K and
\|f‴\| ≤ J, give steps that never pass a zero (docs/impacts.md).

If numba is installed, :func:`compile_loops` compiles the loops. The results stay the same. The
cache of numba only notices changes of the file that contains the called function.

:mod:`.bounces` follows many balls, and balls on other tables.
"""

import math

from numpy.typing import NDArray

from bouncing_ball_beyond.tables.table import PERIOD

REACH = 4.0
"""Reach H in which the parabola with the bound J holds, divided by a step of the other parabola.

The other parabola uses only the bound K (docs/impacts.md). If the zero is later than H, H is
multiplied by this factor again.

At half and at twice: only rounding errors change.
"""
PATIENCE = 100 * PERIOD
"""Duration, multiplied by Ω, above which a contact without a release counts as permanent.

At half: lasting contacts take 35 % less time. At twice: 80 % more.
"""
SLOWEST = 1e-12
"""Closing speed that replaces 0 for a ball that is laid on the table.

At half and at twice: the first contact of a laid ball changes by 3e-11.
"""
CHATTER = 1e-5
"""Limit of T₀ and Λ T₀, divided by the gravity on the table, below which bounces are summed up.

T₀ is the time in which infinitely many bounces end; see :func:`settling`. The relative error of the
sum is of the order of the square of this limit.

At half: bounces are summed up 1 to 3 impacts later. At twice: 1 to 3 sooner.
"""
STEPS = 20_000
"""Maximum number of steps of a search for a zero. A search that needs more returns NaN.

Of 4000 random flights with Λ between 0.1 and 1000, all needed at most 21 steps.
"""
EPS = 2.0**-52
COLUMNS = (
    "turns",
    "phase",
    "speed",
    "scaled_duration",
    "duration",
    "gap",
    "bounce_speed",
    "flight_time",
)
"""Columns of the record of an impact.

- ``turns``, ``phase``: number of turns and phase τ of the table when the impact starts;
- ``speed``: closing speed u;
- ``scaled_duration``: T, the duration of the contact in the time of its equations;
- ``duration``: duration D of the contact;
- ``gap``, ``bounce_speed``: δ and δ′ when the contact ends;
- ``flight_time``: duration of the flight that follows.

For a ball that stays on the table, T and δ′ are NaN, and D is infinite.
"""


def root_of_parabola(f: float, slope: float, bend: float) -> float:
    """Return the first h > 0 at which f + f′h - B h²/2 vanishes, or infinity. f must be ≥ 0."""
    square = slope * slope + 2 * bend * f
    if square < 0:
        return math.inf
    if slope < 0:
        return 2 * f / (math.sqrt(square) - slope)
    if bend > 0:
        return (slope + math.sqrt(square)) / bend
    return math.inf


def safe_step(
    t: float, f: float, slope: float, second: float, bend: float, jerk: float
) -> tuple[float, bool]:
    """Return a step from the time t that passes no zero of f, and whether it ends at the zero.

    ``f``, ``slope`` and ``second`` are f, f′ and f″ at t. The bounds are K = ``bend`` and
    J = ``jerk``.
    """
    step = root_of_parabola(f, slope, bend)
    reach = REACH * step
    closer = root_of_parabola(f, slope, min(bend, jerk * reach / 3 - second))
    while closer > reach and (slope >= 0 or closer < math.inf):
        step = reach
        reach = REACH * step
        closer = root_of_parabola(f, slope, min(bend, jerk * reach / 3 - second))
    step = max(step, min(reach, closer))
    if slope < 0 and jerk * step * step * step <= EPS * -slope * t:
        return root_of_parabola(f, slope, -second), True
    return step, step <= EPS * t


def flight(t: float, gap: float, w: float, x: float, y: float) -> tuple:
    """Return δ, δ′ and δ″ at the time t after a release.

    ``gap`` and ``w`` are δ and δ′ at the release; x = Λ cos τ and y = Λ sin τ there. The formulas
    contain 1 - cos t and t - sin t, so that short flights keep all digits.
    """
    half = math.tan(t / 2)
    sine = 2 * half / (1 + half * half)
    versine = half * sine
    position = gap + t * (w - t / 2) + (y * versine + x * (t - sine))
    rate = (w - t) + (y * sine + x * versine)
    return position, rate, (y - 1) + (x * sine - y * versine)


def resumption(
    gap: float, w: float, x: float, y: float, amplitude: float, kappa: float
) -> tuple[bool, float]:
    """Follow a ball that was released below the level of the table until it rises above the level.

    Returns whether the contact resumes, and a time after the release. The contact resumes if
    δ + κδ′ falls back to zero, and the time is then the time of this zero. Otherwise the ball is
    above the level of the table at the returned time.
    """
    forcing = amplitude * math.sqrt(1 + kappa * kappa)
    t = 0.0
    for _ in range(STEPS):
        position, rate, second = flight(t, gap, w, x, y)
        if position >= 0:
            return False, t
        # The third derivative of δ is Λ cos τ, and the fourth derivative is -Λ sin τ = -(1 + δ″).
        third = x * math.cos(t) - y * math.sin(t)
        f = position + kappa * rate
        slope = rate + kappa * second
        f = max(f, 0.0)
        step, last = safe_step(t, f, slope, second + kappa * third, 1 + forcing, forcing)
        t += step
        if last:
            return True, t
    return True, math.nan


def earliest(w: float, x: float, y: float, amplitude: float) -> float:
    """Return a time before which a ball released at the level of the table cannot land."""
    start = 2 * max(w, 0.0) / (1 + amplitude)
    if y < 1:
        return start
    return max(start, (2 * x + math.sqrt(4 * x * x + 12 * amplitude * (y - 1))) / amplitude)


def landing(
    start: float, gap: float, w: float, x: float, y: float, amplitude: float
) -> tuple[float, float]:
    """Return the time of the first landing after a release, and the closing speed.

    The search begins at the time ``start``. It skips the part of the flight above the highest point
    of the table.
    """
    absolute = w + x
    square = absolute * absolute + 2 * (gap + (y - amplitude))
    aloft = math.sqrt(max(square, 0.0))
    t = start
    for _ in range(STEPS):
        if absolute - aloft <= t < absolute + aloft:
            t = absolute + aloft
        position, rate, second = flight(t, gap, w, x, y)
        position = max(position, 0.0)
        step, last = safe_step(t, position, rate, second, 1 + amplitude, amplitude)
        if last:
            third = x + w - t - rate
            return t + step, max(-rate - step * (second + step * third / 2), 0.0)
        t += step
    return math.nan, math.nan


def contact(
    s: float, gap: float, u: float, x: float, y: float, gravity: float, ratio: float, zeta: float
) -> tuple:
    """Return δ, δ′, w and w′ at the time s after the start of a contact, for ζ < 1.

    The contact starts with δ = gap and δ′ = -u. w and w′ are the height and the velocity of the
    table. The formulas are those of :func:`.oscillator.closed_motion`, for real numbers.
    """
    loss = 2 * zeta * ratio
    stiffness = ratio * ratio
    detuning = (ratio - 1) * (ratio + 1)
    omega = ratio * math.sqrt((1 - zeta) * (1 + zeta))
    half = math.tan(s / 2)
    sine = 2 * half / (1 + half * half)
    cosine = 1 - half * sine
    swing = math.tan(omega * s / 2)
    swung = 2 * swing / (1 + swing * swing)
    lost = -math.expm1(-zeta * ratio * s)
    decay = 1 - lost
    g = decay * swung / omega
    slope = decay * (1 - swing * swung) - zeta * ratio * g
    lost += decay * swing * swung - zeta * ratio * g
    real = lost - half * sine
    imaginary = sine - g
    scale = detuning * detuning + loss * loss
    in_phase = (real * detuning + imaginary * loss) / scale
    quadrature = (imaginary * detuning - real * loss) / scale
    held = gap * (1 - lost) - u * g - gravity * lost / stiffness
    position = held + y * in_phase + x * quadrature
    free_rate = -u * slope - (gravity + gap * stiffness) * g
    rate = free_rate + y * (g - quadrature) + x * in_phase
    return position, rate, y * cosine + x * sine, x * cosine - y * sine


def bounds(motion: tuple, amplitude: float, ratio: float, zeta: float, kappa: float) -> tuple:
    """Return f, f′, δ″, δ‴, K, J and whether the contact is permanent; see `oscillator.bounds`.

    f = -δ - κδ′ is the release function. ``motion`` is the result of :func:`contact`.
    """
    position, rate, push, shove = motion
    loss = 2 * zeta * ratio
    stiffness = ratio * ratio
    detuning = (ratio - 1) * (ratio + 1)
    share = 1 / (detuning * detuning + loss * loss)
    forced = amplitude * math.sqrt((1 + kappa * kappa) * share)
    # The steady response of δ + κδ′ is aΛ sin φ + bΛ cos φ, where φ is the phase of the table.
    a = (detuning + kappa * loss) * share
    b = (kappa * detuning - loss) * share
    second = push - 1 - loss * rate - stiffness * position
    third = shove - loss * second - stiffness * rate
    f = -position - kappa * rate
    slope = -rate - kappa * second
    free = f + a * push + b * shove - 1 / stiffness
    free_rate = slope + a * shove - b * push
    energy = math.sqrt(free_rate * free_rate + stiffness * free * free)
    growth = 1 + 4 * zeta * zeta
    bend = ratio * math.sqrt(growth) * energy
    jerk = ratio * math.sqrt(1 + growth) * bend + forced
    stays = energy / ratio + forced <= 1 / stiffness
    return f, slope, second, third, bend + forced, jerk, stays


def release(
    gap: float,
    u: float,
    x: float,
    y: float,
    amplitude: float,
    ratio: float,
    zeta: float,
    kappa: float,
) -> tuple:
    """Return the duration of a contact up to its first release, and δ′ at the release.

    The release is the zero of f = -δ - κδ′. If the contact is permanent, the duration is infinite
    and δ′ is NaN.
    """
    if u == 0:
        u = SLOWEST
    s = 0.0
    while s < PATIENCE:
        motion = contact(s, gap, u, x, y, 1.0, ratio, zeta)
        f, slope, second, third, bend, jerk, stays = bounds(motion, amplitude, ratio, zeta, kappa)
        if stays:
            break
        step, last = safe_step(s, max(f, 0.0), slope, -second - kappa * third, bend, jerk)
        s += step
        if last:
            return s, motion[1] + step * (second + step * third / 2)
    return math.inf, math.nan


def settling(w: float, r: float, x: float, y: float, amplitude: float) -> float:
    """Return the total time of the infinitely many bounces after an impact with the speed w.

    The time is T₀ (1 - g′T₀/(3g) + ...), where T₀ = 2w/(g (1 - r)). The gravity on the table is
    g = 1 - y, and its rate is g′ = -x. Returns -1 if the bounces are not summed up; see `CHATTER`.
    """
    gravity = 1 - y
    if gravity < 0 or (gravity == 0 and x > 0):
        return -1.0
    if w == 0:
        return 0.0
    whole = 2 * w
    loss = gravity * (1 - r)
    if whole * max(amplitude, 1.0) > CHATTER * gravity * loss:
        return -1.0
    whole /= loss
    return whole * (1 + x * whole / (3 * gravity))


def until_lift_off(phase: float, amplitude: float) -> float:
    """Return the time until a resting ball leaves at Λ sin τ = 1 (Eq. 9); it may be infinite."""
    if amplitude <= 1:
        return math.inf
    wait = (math.asin(1 / amplitude) - phase) % PERIOD
    # Rounding must not postpone the lift-off by a turn.
    return 0.0 if wait > PERIOD - CHATTER**2 else wait


def settle(w: float, restitution: float, phase: float, amplitude: float) -> tuple[float, float]:
    """Return how long a ball stays on the table, and the phase at which it leaves.

    The ball starts with the speed w after an instantaneous impact. The time covers the last bounces
    and the rest after them. It is negative if the bounces are not summed up.
    """
    settled = settling(
        w, restitution, amplitude * math.cos(phase), amplitude * math.sin(phase), amplitude
    )
    end = phase + settled
    if settled < 0 or amplitude * math.sin(end) > 1:
        return settled, end
    lift_off = math.asin(1 / max(amplitude, 1.0))
    return settled + until_lift_off(end, amplitude), lift_off


def reduced(phase: float) -> tuple[float, float]:
    """Split a phase into a number of whole turns and a remainder in [-π, π)."""
    turns = float(math.floor(phase / PERIOD + 0.5))
    return turns, phase - turns * PERIOD


def fly(gap: float, w: float, x: float, y: float, amplitude: float, kappa: float) -> tuple:
    """Return the time of the flight up to the next impact, and the closing speed of this impact.

    If the contact resumes below the table, the closing speed is negative.
    """
    if gap == 0:
        return landing(earliest(w, x, y, amplitude), gap, w, x, y, amplitude)
    resumes, start = resumption(gap, w, x, y, amplitude, kappa)
    if resumes:
        return start, -flight(start, gap, w, x, y)[1]
    return landing(start, gap, w, x, y, amplitude)


def impacts(
    turns: float,
    phase: float,
    u: float,
    amplitude: float,
    restitution: float,
    ratio: float,
    zeta: float,
    kappa: float,
    out: NDArray,
) -> tuple:
    """Compute impacts of a ball. Record them in the rows of ``out``, in the columns `COLUMNS`.

    If the frequency ratio is 0, the impacts are instantaneous. Returns whether the ball stays on
    the table, and the turns, the phase and the closing speed of the next impact.
    """
    for i in range(len(out)):
        x = amplitude * math.cos(phase)
        y = amplitude * math.sin(phase)
        rests = False
        if ratio == 0:
            w = restitution * u
            gap = 0.0
            duration = 0.0
            if w <= CHATTER * (1 + amplitude) * (1 + amplitude):
                stay, leaves = settle(w, restitution, phase, amplitude)
                rests = stay >= 0
            if rests:
                w = 0.0
                duration = stay
        else:
            start = kappa * min(u, 0.0)
            duration, w = release(start, u, x, y, amplitude, ratio, zeta, kappa)
            gap = -kappa * w
        out[i] = turns, phase, u, ratio * duration, duration, gap, w, math.nan
        if duration == math.inf:
            out[i, 3] = math.nan
            return True, turns, phase, u
        passed, phase = reduced(phase + duration)
        turns += passed
        if rests:
            # Assign the exact phase of the lift-off. Motions after equal lift-offs are then equal.
            phase = leaves
        x = amplitude * math.cos(phase)
        y = amplitude * math.sin(phase)
        if rests:
            y = max(y, 1.0)
        flown, u = fly(gap, w, x, y, amplitude, kappa)
        out[i, 7] = flown
        passed, phase = reduced(phase + flown)
        turns += passed
    return False, turns, phase, u


LOOPS = (
    root_of_parabola,
    safe_step,
    flight,
    resumption,
    earliest,
    landing,
    contact,
    bounds,
    release,
    settling,
    until_lift_off,
    settle,
    reduced,
    fly,
    impacts,
)


def compile_loops() -> None:
    """Compile the functions above with numba, if it is installed.

    The compiled functions replace the originals, because numba finds functions by their names.
    """
    try:
        from numba import njit
    except ImportError:
        return
    for function in LOOPS:
        try:
            globals()[function.__name__] = njit(cache=True)(function)
        except RuntimeError:
            # No folder for the cache is writable.
            globals()[function.__name__] = njit(function)

r"""One ball from impact to impact: first landings and first releases as scalar loops, on a sine.

Both are first zeros of functions f ≥ 0 with f″ ≥ -K from now on and \|f‴\| ≤ J, of which no step
passes one (docs/impacts.md). Where numba is installed, :func:`compile_loops` compiles them, which
gives the same numbers; its cache notices only changes of the file of the function that is called.
Many balls, and other tables: :mod:`.bounces`.
"""

import math

from numpy.typing import NDArray

PERIOD = 2 * math.pi
REACH = 4.0
"""The reach H of the second bound, in steps of the first one."""
PATIENCE = 100 * PERIOD
"""A contact without a release for this long is a lasting one."""
SLOWEST = 1e-12
"""The closing speed that is given to a ball without one, which is laid on the table."""
CHATTER = 1e-5
"""Chattering is summed up once Λ T₀ and T₀ are below this multiple of the gravity on the table: the
sum has a relative error of the order of the square.
"""
STEPS = 20_000
"""Maximum number of steps of a search for a zero. A search that needs more is undecided, NaN.

It is only a bound: of 4000 random flights, Λ between 0.1 and 1000, none needed more than 21 steps.
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
"""What is recorded of each impact: the number of turns of the table and its phase τ as the impact
starts, the closing speed u, T, the duration D, δ and δ′ as it ends, and the time of the flight that
follows. T and δ′ are NaN, and D is infinite, for a ball that stays on the table."""


def root_of_parabola(f: float, slope: float, bend: float) -> float:
    """The first h > 0 at which f + f′h - B h²/2 vanishes, for f ≥ 0; infinity if there is none."""
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
    """A step from the time t that passes no zero of f, by K = ``bend`` and J = ``jerk``, and
    whether it ends there.
    """
    step = root_of_parabola(f, slope, bend)
    reach = REACH * step
    step = max(step, min(reach, root_of_parabola(f, slope, min(bend, jerk * reach / 3 - second))))
    if slope < 0 and jerk * step * step * step <= EPS * -slope * t:
        return root_of_parabola(f, slope, -second), True
    return step, step <= EPS * t


def flight(t: float, gap: float, w: float, x: float, y: float) -> tuple:
    """δ, δ′ and δ″ a time t after a release, where the table has Λ cos τ = x and Λ sin τ = y.

    Written with 1 - cos t and t - sin t, short flights lose no digits.
    """
    half = math.tan(t / 2)
    sine = 2 * half / (1 + half * half)
    versine = half * sine
    position = gap + t * (w - t / 2) + (y * versine + x * (t - sine))
    rate = (w - t) + (y * sine + x * versine)
    return position, rate, (y - 1) + (x * sine - y * versine)


def rise(
    gap: float, w: float, x: float, y: float, amplitude: float, kappa: float
) -> tuple[bool, float]:
    """Whether the contact of a ball that was released below the level of the table resumes, where
    δ + κδ′ falls back to zero, and the time of this, or that at which the ball is above the level.
    """
    forcing = amplitude * math.sqrt(1 + kappa * kappa)
    t = 0.0
    for _ in range(STEPS):
        position, rate, second = flight(t, gap, w, x, y)
        if position >= 0:
            return False, t
        # The fourth derivative of δ is -Λ sin τ = -(1 + δ″), and the third one Λ cos τ.
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
    """A time before which a ball that leaves at the level of the table has certainly not landed."""
    start = 2 * max(w, 0.0) / (1 + amplitude)
    if y < 1:
        return start
    return max(start, (2 * x + math.sqrt(4 * x * x + 12 * amplitude * (y - 1))) / amplitude)


def landing(
    start: float, gap: float, w: float, x: float, y: float, amplitude: float
) -> tuple[float, float]:
    """The first landing, which is not before the time ``start``, and the closing speed.

    The part of a flight above the highest point of the table is skipped.
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
    """δ and δ′ at the time s after an impact has started from δ = gap and δ′ = -u, for ζ < 1, and
    the height of the table and its velocity: :func:`.oscillator.closed_motion`, in real numbers.
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
    """f = -δ - κδ′ in a contact, f′, δ″ and δ‴, K and J, and whether it stays for ever, from what
    :func:`contact` returns; see :func:`.oscillator.bounds`.
    """
    position, rate, push, shove = motion
    loss = 2 * zeta * ratio
    stiffness = ratio * ratio
    detuning = (ratio - 1) * (ratio + 1)
    share = 1 / (detuning * detuning + loss * loss)
    forced = amplitude * math.sqrt((1 + kappa * kappa) * share)
    # The steady response of δ + κδ′ is a Λ sin + b Λ cos of the phase of the table.
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
    """The duration of a contact up to its first release, where f = -δ - κδ′ falls to zero, and δ′
    there; infinity if it lasts.
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
    """The time T₀ (1 - g′T₀/(3g) + ...), T₀ = 2w/(g (1 - r)), in which the bounces after an impact
    end on the table, with the gravity g = 1 - Y on it and g′ = -X; -1 if they are not summed up.
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
    """How long a ball rests: until Λ sin τ rises to 1, or for ever (Eq. 9)."""
    if amplitude <= 1:
        return math.inf
    wait = (math.asin(1 / amplitude) - phase) % PERIOD
    # Rounding must not postpone the lift-off by a turn.
    return 0.0 if wait > PERIOD - CHATTER**2 else wait


def settle(w: float, restitution: float, phase: float, amplitude: float) -> tuple[float, float]:
    """How long a ball rests after an instant that leaves it with the speed w, or a negative time,
    and the phase at which it leaves.
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
    """The number of turns of the table in a phase, and what is left of it, from -π to π."""
    turns = float(math.floor(phase / PERIOD + 0.5))
    return turns, phase - turns * PERIOD


def fly(gap: float, w: float, x: float, y: float, amplitude: float, kappa: float) -> tuple:
    """The time of the flight up to the next impact, and its closing speed, which is negative where
    the contact resumes.
    """
    if gap == 0:
        return landing(earliest(w, x, y, amplitude), gap, w, x, y, amplitude)
    resumes, start = rise(gap, w, x, y, amplitude, kappa)
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
    """Impacts of a ball into the rows of ``out``, instants if ϖ is 0.

    Returns whether the ball stays on the table, and the turns, the phase and u of the next impact.
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
            # The state at a lift-off is the same each time, so that later motions are too.
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
    rise,
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
    """Compile the functions above by numba, which finds them by their names, if it is installed."""
    try:
        from numba import njit
    except ImportError:
        return
    for function in LOOPS:
        try:
            globals()[function.__name__] = njit(cache=True)(function)
        except RuntimeError:
            # There is no folder for the cache that can be written to.
            globals()[function.__name__] = njit(function)

"""The stable 1-T orbits with a long contact, into which permanent contact continues.

At Λ_SD permanent contact ends, and a 1-T orbit with a short flight T and a
contact that lasts D = 2π - T begins (``docs/closed-form.md``, section 6); next
to Λ_SD it is stable. Followed along T the orbit is stable and admissible up to
the first of a saddle-node, a period doubling, and a grazing: a second touch of
the table's level, in contact or in flight. The *window* is the range of Λ between these
two ends. Beyond a grazing end there may be stable motion with more flights per period, which is
not followed here.

For a stiff contact the window is short and near Λ = 1. There the ball leaves
near the top of the table, within a time of order 1/ϖ of it. In the time s = ϖτ of the
contact, measured from the top, with δ = x/ϖ⁴ and Λ = 1 + C/ϖ², the motion is ::

    x″ + 2ζx′ + x = C - s²/2   in contact,      x″ = C - s²/2   in flight

which does not contain ϖ. The contact that follows lasts for so many oscillations, of order ϖ,
that the orbit is stable; the window ends where the oscillation after the landing reaches
x = 0 again (:func:`stiff_limit`).
"""

import math
from collections.abc import Callable
from enum import StrEnum
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq

from bouncing_ball.contacts.spring_damper import Release, SpringDamper
from bouncing_ball.errors import ModelError
from bouncing_ball.motion.simulation import simulate
from bouncing_ball.orbits.spring_damper_model import SpringDamperModel
from bouncing_ball.orbits.spring_damper_orbit import SpringDamperOrbit
from bouncing_ball.orbits.stability import Bifurcation

# The branch is followed from the flight time _SHORT/max(ϖ, _SOFT), which is short enough for
# weak damping and long enough for the rounding at ϖ = 200, to _LONG, where the contact is
# nearly an instant.
_SHORT, _LONG = 0.2, 2 * np.pi - 0.05
_SOFT = 10.0
# Orbits along the branch among which the first end is bracketed (ten times as many find the
# same ends), and bisections of the bracket, down to neighbouring floating-point numbers.
_SAMPLES = 150
_BISECTIONS = 52
# Orbits from the saddle-node to Λ_SD that must all be admissible; the inadmissible part
# opens with the root of the distance in ϖ, so that six hundred of them resolve 10⁻⁶.
_JOINT_SAMPLES = 600
# These orbits start so far in time from the saddle-node, on its unstable side.
_TO_SIDE = 1e-3
# Width in ϖ at which the bisection for the joining ratio stops.
_CLOSE = 1e-8
# The kind of an end is determined at the flight time longer by this part, beyond all rounding.
_BEYOND = 1e-8
# Samples of an oscillation, taken again around the highest one: the error of the height is of
# the order of the square of the last step, 1e-15. The second number stands for the height of an
# oscillation without a maximum.
_FINE, _FAR_BELOW = 20_001, -1e3
# A contact that opens before its end is shorter by a considerable part of an oscillation.
_SHORTER = 1e-6


class End(StrEnum):
    """How a window of stable orbits ends."""

    SADDLE_NODE = Bifurcation.SADDLE_NODE
    PERIOD_DOUBLING = Bifurcation.PERIOD_DOUBLING
    CONTACT = "grazing in contact"
    """The contact would open before its end."""
    FLIGHT = "grazing in flight"
    """The ball would land before the end of its flight."""
    NONE = "none"
    """No window was found, or it has no end in the range of flight times."""


class Window(NamedTuple):
    """Upper ends of the windows: Λ, the flight time T, and the :class:`End` as text; shape (m,)
    each.

    Λ and T are NaN where no end was found.
    """

    amplitude: np.ndarray
    flight_time: np.ndarray
    end: np.ndarray


def orbit_with_flight(contact: SpringDamper, flight_time: ArrayLike) -> SpringDamperOrbit:
    """The 1-T orbits with a given time of flight T in (0, 2π).

    Contact and flight times broadcast.

    Examples
    --------
    >>> orbit = orbit_with_flight(SpringDamper.from_restitution(0.85, 2.0), 1.0)
    >>> float(orbit.flight_time.round(12)), bool(orbit.is_stable())
    (1.0, True)
    """
    duration = 2 * np.pi - np.asarray(flight_time)
    excess = duration * contact.damped_frequency - contact.free_angle
    return SpringDamperOrbit.on_branch(excess, contact, 1)


def _usual(contact: SpringDamper, flight_time: np.ndarray) -> np.ndarray:
    """Whether the orbits are stable and admissible; only the stable ones are simulated."""
    orbit = orbit_with_flight(contact, flight_time)
    good = orbit.is_stable()
    if good.any():
        good[good] = orbit[good].is_admissible()
    return good


def _kind(contact: SpringDamper, flight_time: np.ndarray) -> np.ndarray:
    """The kind of an end, from the orbits just beyond it."""
    orbit = orbit_with_flight(contact, flight_time * (1 + _BEYOND))
    trace, determinant = orbit.trace_and_determinant()
    motion = simulate(contact, orbit.amplitude, orbit.phase, orbit.impact_velocity, 1)
    opens = motion.contact_duration[0] < orbit.contact_duration * (1 - _SHORTER)
    grazing = np.where(opens, End.CONTACT, End.FLIGHT)
    kind = np.where(1 + trace + determinant <= 0, End.PERIOD_DOUBLING, grazing)
    return np.where(1 - trace + determinant <= 0, End.SADDLE_NODE, kind)


def _bisected(
    good: Callable, inside: np.ndarray, outside: np.ndarray, times: int
) -> tuple[np.ndarray, np.ndarray]:
    """Bisected points inside, where a condition holds, and outside, where it does not."""
    for _ in range(times):
        middle = (inside + outside) / 2
        here = good(middle)
        inside, outside = np.where(here, middle, inside), np.where(here, outside, middle)
    return inside, outside


def stable_window(contact: SpringDamper) -> Window:
    """The upper ends of the windows of stable orbits that begin at Λ_SD.

    Parameters
    ----------
    contact : SpringDamper
        ϖ and ζ < 1 of shape (m,), and the release rule.

    Raises
    ------
    ModelError
        If a ζ is 1 or more.

    Examples
    --------
    >>> window = stable_window(SpringDamper.from_restitution(0.85, np.array([1.2, 2.0, 10.0])))
    >>> window.amplitude.round(4).tolist()
    [0.3342, 1.0955, 1.0433]
    >>> window.end.tolist()
    ['saddle-node', 'period doubling', 'grazing in contact']
    """
    start = _SHORT / np.maximum(contact.frequency_ratio, _SOFT)
    grid = start * (_LONG / start) ** np.linspace(0.0, 1.0, _SAMPLES)[:, np.newaxis]
    last, going = np.zeros(start.size, dtype=int), np.arange(start.size)
    # A contact leaves the loop at its first end; most windows end early.
    for row in range(_SAMPLES):
        going = going[_usual(contact[going], grid[row, going])]
        last[going] = row + 1
    found = np.flatnonzero((last > 0) & (last < _SAMPLES))
    part = contact[found]
    inside, outside = grid[last[found] - 1, found], grid[last[found], found]
    inside, outside = _bisected(lambda time: _usual(part, time), inside, outside, _BISECTIONS)
    none = np.full(start.size, np.nan)
    window = Window(none, none.copy(), np.full(none.shape, End.NONE, dtype="<U18"))
    window.amplitude[found] = orbit_with_flight(part, inside).amplitude
    window.flight_time[found], window.end[found] = inside, _kind(part, outside)
    return window


def joined(contact: SpringDamper) -> np.ndarray:
    """Whether all orbits from the saddle-node to Λ_SD are admissible, for each contact, shape (m,).

    If they are, the unstable side of the branch with a short contact leads to the orbits
    with a long one. False where the branch has no saddle-node. It is decided on 600 orbits
    between the two, because the inadmissible part opens with the root of the distance in ϖ.

    Examples
    --------
    >>> joined(SpringDamper.from_restitution(0.85, np.array([1.9, 3.0]))).tolist()
    [True, False]
    """
    node = SpringDamperModel(contact).saddle_node(1).contact_duration
    found = np.isfinite(node)
    if found.any():
        longest = 2 * np.pi - node[found] - _TO_SIDE
        times = np.linspace(longest, _SHORT / _SOFT, _JOINT_SAMPLES)
        found[found] = orbit_with_flight(contact[found], times).is_admissible().all(axis=0)
    return found


def joining_ratio(
    damping_ratio: ArrayLike, release: Release, low: float, high: float
) -> np.ndarray:
    """The ϖ above which the families with a short and a long contact are not connected.

    Parameters
    ----------
    damping_ratio : array_like
        ζ.
    release : Release
    low, high : float
        Range of ϖ in which the transition is looked for.

    Returns
    -------
    ndarray
        Of the shape of ζ; NaN unless the families are connected at ``low`` and not at ``high``.
    """
    zeta = np.atleast_1d(np.asarray(damping_ratio, dtype=float))

    def together(ratio: np.ndarray) -> np.ndarray:
        return joined(SpringDamper(ratio, zeta, release))

    below, above = np.full(zeta.shape, low), np.full(zeta.shape, high)
    parting = together(below) & ~together(above)
    if parting.any():
        below, _ = _bisected(together, below, above, math.ceil(math.log2((high - low) / _CLOSE)))
    return np.where(parting, below, np.nan).reshape(np.shape(damping_ratio))


def _highest_after_landing(excess: float, zeta: float) -> float:
    """Highest x that the oscillation after the landing reaches, for C = 2ζ² - 1 + ``excess``.

    Before the flight the ball follows ``p(s) = excess - (s - 2ζ)²/2``, because the preceding
    oscillation has decayed.
    """
    level = 2 * zeta * zeta - 1 + excess
    rate = math.sqrt(2 * excess)
    leaving = 2 * zeta - rate
    # x = t (rate + a t/2 - leaving t²/6 - t³/24), a the acceleration at release.
    acceleration = level - leaving * leaving / 2
    roots = np.roots([-1 / 24, -leaving / 6, acceleration / 2, rate])
    flight = min(root.real for root in roots if abs(root.imag) < 1e-9 and root.real > 0)
    landing = rate + flight * (acceleration - flight * (leaving / 2 + flight / 6))
    after = leaving + flight - 2 * zeta
    omega = math.sqrt((1 - zeta) * (1 + zeta))
    a = after * after / 2 - excess
    b = (landing + after + zeta * a) / omega

    def displacement(time):
        free = np.exp(-zeta * time) * (a * np.cos(omega * time) + b * np.sin(omega * time))
        return excess - (after + time) ** 2 / 2 + free

    # Only the first maximum matters, because later ones follow p far down.
    time = np.linspace(0.0, 3 * np.pi / omega, _FINE)
    x = displacement(time)
    peaks = 1 + np.flatnonzero((x[1:-1] > x[:-2]) & (x[1:-1] >= x[2:]))
    if not peaks.size:
        return _FAR_BELOW
    top = peaks[np.argmax(x[peaks])]
    return float(displacement(np.linspace(time[top - 1], time[top + 1], _FINE)).max())


def stiff_limit(damping_ratio: float) -> float:
    """Width of the window for a stiff contact: ϖ²(Λ_end - Λ_SD) as ϖ → ∞.

    Raises
    ------
    ModelError
        If ζ is not in (0, 0.9], where the oscillation after a landing can be resolved.

    Examples
    --------
    >>> from bouncing_ball.contacts.damping import damping_ratio
    >>> round(stiff_limit(float(damping_ratio(0.85))), 2)
    8.61
    """
    zeta = float(damping_ratio)
    if not 0 < zeta <= 0.9:
        raise ModelError(f"damping ratio ζ = {zeta:g} is not in (0, 0.9]")
    low, high = 1e-3, 1.0
    while _highest_after_landing(high, zeta) < 0:
        low, high = high, 1.25 * high
    return float(brentq(_highest_after_landing, low, high, args=(zeta,), xtol=1e-12))

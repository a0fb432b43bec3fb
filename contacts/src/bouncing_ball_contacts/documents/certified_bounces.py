r"""Bounces of a dropped ball with certified digits: reference numbers for the tests of an engine.

A ball falls from rest from the height h onto a table at rest. With r its impacts are instants:
the k-th rebound rises to r^{2k} h. On a spring and a damper, with gravity in contact and ω² = k/m,
a = c/(2m), ω_d = √(ω² - a²), s = g/ω², its penetration is ::

    x = s + e^{-at} [-s cos ω_d t + (v - a s)/ω_d sin ω_d t]

up to the first zero of x (displacement release) or of k x + c x′ (force release). The zero is
enclosed by a step of Newton's method in ball arithmetic, which proves that there is exactly one
zero in the ball, and the release function is proved to be positive before it. If the damper acts on
approach only, this holds up to x′ = 0 at the depth P, and then ``x = s + (P - s) cos ωt``.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from decimal import Context, Decimal
from typing import Any

import scipy

from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.models.damping import Release
from bouncing_ball_contacts.documents.installed import proofs_extra

with proofs_extra():
    from flint import arb, ctx

DIGITS = 15
"""Digits of the numbers; a number is not written if they are not certain."""
_BITS = 256
# The half-width, over the time, of the ball that Newton's method contracts, and how often the time
# before it is halved at most.
_WIDTH = 1e-12
_HALVES = 40


@dataclass(frozen=True)
class Bounce:
    """A rebound: when the ball meets and leaves the table and is at its top, in s, the speed with
    which it meets it, in m/s, and the height of the top in m. All are balls of ball arithmetic.
    """

    impact: Any
    release: Any
    top: Any
    speed: Any
    height: Any


def hard(restitution: str, height: str, gravity: str, count: int) -> Iterator[Bounce]:
    """The rebounds of a ball with r, all numbers given as decimals.

    Examples
    --------
    >>> [rounded_ball(bounce.height) for bounce in hard("0.5", "1", "9.81", 2)]
    ['0.250000000000000', '0.0625000000000000']
    """
    ctx.prec = _BITS
    r = arb(restitution)
    h = arb(height)
    g = arb(gravity)
    time = (2 * h / g).sqrt()
    for _ in range(count):
        speed = (2 * g * h).sqrt()
        h = r * r * h
        top = time + r * speed / g
        yield Bounce(time, time, top, speed, h)
        time = top + r * speed / g


@dataclass(frozen=True)
class _Contact:
    """x and x′ in a contact after an impact with the speed v, in ball arithmetic."""

    decay: Any
    damped: Any
    sink: Any
    speed: Any

    def state(self, time: Any) -> tuple[Any, Any]:
        a = self.decay
        w = self.damped
        s = self.sink
        v = self.speed
        b = (v - a * s) / w
        shrunk = (-a * time).exp()
        sine = (w * time).sin()
        cosine = (w * time).cos()
        x = s + shrunk * (b * sine - s * cosine)
        rate = shrunk * ((b * w + a * s) * cosine + (w * s - a * b) * sine)
        return x, rate


def enclosed_rebounds(
    release: str, contact: tuple[str, str, str], height: str, gravity: str, count: int
) -> Iterator[Bounce]:
    """The rebounds of a ball on an underdamped spring-damper, all numbers given as decimals.

    Parameters
    ----------
    release : str
        The release rule.
    contact : tuple of str
        m in kg, k in N/m and c in N s/m.
    height, gravity : str
        The height of the drop in m, and g in m/s².
    count : int
        The number of rebounds.

    Raises
    ------
    ModelError
        If a rebound is not proved, because the ball does not leave the table.

    Examples
    --------
    >>> elastic = enclosed_rebounds("force", ("1", "1e4", "0"), "1", "9.81", 2)
    >>> [rounded_ball(bounce.height) for bounce in elastic]
    ['1.00000000000000', '1.00000000000000']
    """
    ctx.prec = _BITS
    rule = Release.of(release)
    m, k, c = (arb(x) for x in contact)
    h = arb(height)
    g = arb(gravity)
    omega = (k / m).sqrt()
    decay = c / (2 * m)
    damped = (omega * omega - decay * decay).sqrt()
    sink = g / (omega * omega)
    lag = c / k if rule is Release.FORCE else arb(0)
    time = (2 * h / g).sqrt()
    for _ in range(count):
        speed = (2 * g * h).sqrt()
        motion = _Contact(decay, damped, sink, speed)
        if rule.is_linear:
            duration = _first_zero(motion, lag, omega, g)
            # At the zero of x + lag x′ the depth is -lag x′.
            away = -motion.state(duration)[1]
            depth = lag * away
        else:
            duration, away = _after_approach(motion, omega, sink)
            depth = arb(0)
        left = time + duration
        h = away * away / (2 * g) - depth
        top = left + away / g
        yield Bounce(time, left, top, speed, h)
        time = top + (2 * h / g).sqrt()


def _after_approach(motion: _Contact, omega: Any, sink: Any) -> tuple[Any, Any]:
    """Duration of a contact with a damped approach, and the speed at its end."""
    a = motion.decay
    w = motion.damped
    s = motion.sink
    v = motion.speed
    b = (v - a * s) / w
    # x′ vanishes first where tan(ω_d t) = (b ω_d + a s)/(a b - ω_d s), in (0, π).
    turn = arb.atan2(b * w + a * s, a * b - w * s) / w
    deepest, _ = motion.state(turn)
    swing = deepest - sink
    away = omega * (swing * swing - sink * sink).sqrt()
    return turn + (-sink / swing).acos() / omega, away


def _first_zero(motion: _Contact, lag: Any, omega: Any, gravity: Any) -> Any:
    """The first zero of x + lag x′ after the impact, proved."""

    def grip(time: Any) -> tuple[Any, Any]:
        x, rate = motion.state(time)
        second = gravity - omega * omega * x - 2 * motion.decay * rate
        return x + lag * rate, rate + lag * second

    half = float(arb.pi() / motion.damped)
    last = 1.5 * half
    first = 0.3 * half
    if not (grip(arb(first))[0] > 0 > grip(arb(last))[0]):
        raise ModelError("the ball does not leave the table")
    middle = float(
        scipy.optimize.brentq(lambda t: float(grip(arb(t))[0].mid()), first, last, xtol=1e-16)
    )
    wide = arb(middle, _WIDTH * half)
    centre = wide.mid()
    slope = grip(wide)[1]
    zero = centre - grip(centre)[0] / slope
    if not (slope < 0 and wide.contains(zero)):
        raise ModelError("a release is not proved")
    start = 1e-3 * half
    rises = grip(arb(start / 2, start / 2))
    if not (rises[0] > 0 or rises[1] > 0):
        raise ModelError("the start of a contact is not proved")
    _require_positive(lambda t: grip(t)[0], start, middle - _WIDTH * half)
    # Each step doubles the digits.
    for _ in range(4):
        centre = zero.mid()
        zero = centre - grip(centre)[0] / grip(zero)[1]
    return zero


def _require_positive(function: Callable[[Any], Any], low: float, high: float) -> None:
    """Prove that a function is positive on an interval, by halving it.

    Raises
    ------
    ModelError
        If it is not proved.
    """
    parts = [(low, high, 0)]
    while parts:
        start, end, halves = parts.pop()
        centre = (start + end) / 2
        if function(arb(centre, (end - start) / 2 * (1 + 1e-15))) > 0:
            continue
        if halves == _HALVES:
            raise ModelError("a contact may end before its release")
        parts += [(start, centre, halves + 1), (centre, end, halves + 1)]


def rounded_ball(ball: Any, digits: int = DIGITS) -> str:
    """The number that a ball encloses, rounded to so many digits.

    Raises
    ------
    ModelError
        If the ball is too wide for them.

    Examples
    --------
    >>> rounded_ball(arb(2).sqrt(), 5)
    '1.4142'
    """
    rounded = Context(prec=digits)
    middle = Decimal(ball.mid().str(3 * digits, radius=False))
    width = Decimal(ball.rad().str(5, radius=False)) * 2 + abs(middle) * Decimal(10) ** (
        -2 * digits
    )
    low = rounded.plus(middle - width)
    high = rounded.plus(middle + width)
    # A number with few digits, such as 1/4, is not between two numbers of so many digits.
    near = rounded.plus(middle)
    if abs(middle - near) > width and low != high:
        raise ModelError(f"{ball} is not known to {digits} digits")
    if near == 0:
        return "0"
    return str(near.quantize(Decimal(10) ** (near.adjusted() - digits + 1)))

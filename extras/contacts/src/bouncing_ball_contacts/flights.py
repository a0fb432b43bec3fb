"""A flight of a ball in air, whose drag goes as the square of the speed.

With the drag D = ρ C A/(2 m) in 1/m the speed v upwards follows v′ = -g - D v |v|. From the top of
a flight on, with a = √(g D), the equation has the solutions::

    on the way up, t < 0:    v = -√(g/D) tan(a t),     y = ln(cos(a t))/D
    on the way down, t > 0:  v = -√(g/D) tanh(a t),    y = -ln(cosh(a t))/D

so that a ball leaves with v = √(g (e^(2 D h) - 1)/D) for a height h, and falls from it to
v = √(g (1 - e^(-2 D h))/D). Without drag these have the limits -g t, -g t²/2 and √(2 g h), with
which they agree for a drag of 1e-30/m.
"""

import math

import numpy as np

from bouncing_ball_contacts.units import STANDARD_GRAVITY, Array, Refused, show

# Of the air: its density in kg/m³ and the drag coefficient of a ball. The densest ball is osmium.
_AIR = 1.2
_DRAG = 0.47
_DENSEST = 22600.0
_NO_DRAG = 1e-30


def drag_of(mass: float, diameter: float) -> float:
    """Return the drag ρ C A/(2 m) of a ball in 1/m; refuse an impossible density."""
    density = mass / (math.pi / 6 * diameter**3)
    if not _AIR < density < _DENSEST:
        raise Refused(
            f"a ball of {show(mass, 'kg')} with a diameter of {show(diameter, 'm')} has a density "
            f"of {density:.3g} kg/m³: is a unit missing, as in '46 g' and '43 mm'?"
        )
    return _AIR * _DRAG * math.pi / 8 * diameter**2 / mass


def heights_of(durations: Array, drag: float) -> Array:
    """Return the heights in m of flights with durations in s.

    A ball that starts with b √(g/D) rises for atan(b)/√(g D) to ln(1 + b²)/(2 D), and falls for
    asinh(b)/√(g D). Newton's method comes from below, because both functions are concave.
    """
    drag = max(drag, _NO_DRAG)
    lasts = math.sqrt(STANDARD_GRAVITY * drag) * durations
    b = lasts / 2
    for _ in range(20):
        slope = 1 / (1 + b**2) + 1 / np.sqrt(1 + b**2)
        b = b + (lasts - np.arctan(b) - np.arcsinh(b)) / slope
    return np.log1p(b**2) / (2 * drag)


def speeds_of(heights: Array, drag: float) -> tuple[Array, Array]:
    """Return the speeds of a ball that falls from heights in m, and that rises to them."""
    both = max(drag, _NO_DRAG) * np.array([-1.0, 1.0])
    down, up = (
        np.sqrt(STANDARD_GRAVITY * np.expm1(2 * signed_drag * heights) / signed_drag)
        for signed_drag in both
    )
    return down, up


def fall_of(since_top: Array, drag: float) -> tuple[Array, Array]:
    """Return -y/g and -v/g at times in s after the top; times on the way up are negative."""
    a = math.sqrt(STANDARD_GRAVITY * max(drag, _NO_DRAG))
    # A ball rises for less than π/2a.
    rise = np.clip(a * since_top, -1.5, 0.0)
    # Beyond it no ball gets faster.
    fall = np.clip(a * since_top, 0.0, 300.0)
    # ln(cosh x) and ln(cos x), also of small x.
    depth = (np.log1p(np.sinh(fall) ** 2) - np.log1p(-(np.sin(rise) ** 2))) / (2 * a**2)
    return depth, (np.tan(rise) + np.tanh(fall)) / a


def meeting_of(start: Array, slope: Array, gravity: float, drag: float) -> tuple[Array, ...]:
    """Return where flights meet: the time, the height, and the speeds down and up, shape (...).

    ``start`` and ``slope``, shape (2, ...), are those at time 0 of parabolas that have the tops of
    the flights before and after an impact; the drag, in 1/m, needs times in s.
    """
    tops = slope / gravity
    heights = start + gravity * tops**2 / 2
    meet = (start[1] - start[0]) / (slope[0] - slope[1])
    # Newton's method, from where the parabolas meet.
    for _ in range(4):
        depths, speeds = fall_of(meet - tops, drag)
        meet = meet + (heights[1] - heights[0] - gravity * (depths[1] - depths[0])) / (
            gravity * (speeds[1] - speeds[0])
        )
    depths, speeds = fall_of(meet - tops, drag)
    floor = np.mean(heights - gravity * depths, axis=0)
    return meet, floor, gravity * speeds[0], -gravity * speeds[1]


def impact_of(track: Array, drag: float = 0.0) -> Array:
    """Fit two flights with one gravity, and return how they meet, shape (7,).

    In units of the track these are the speeds down before and up after the impact, gravity, the
    root mean square of the distances of the positions from the flights, and the time and the
    position of the impact; the last one is the standard error of ln r by these distances.
    ``track`` has the columns time in s, position upwards, and 1 after the
    impact or else 0.

    A flight is a parabola but for what the drag changes, which depends on its top and on gravity:
    parabolas are fitted again to the positions without that until nothing changes any more.
    """
    t, y, after = track.T
    begin = t[after > 0].min()
    since = t - begin
    columns = np.column_stack(
        [-(since**2) / 2, 1 - after, after, (1 - after) * since, after * since]
    )
    by_drag = np.zeros_like(y)
    for _ in range(8):
        coefficients = np.linalg.lstsq(columns, y - by_drag, rcond=None)[0]
        gravity = coefficients[0]
        start, slope = coefficients[1:].reshape(2, 2)
        tops = slope / gravity
        since_top = since - np.where(after > 0, tops[1], tops[0])
        by_drag = gravity * (since_top**2 / 2 - fall_of(since_top, drag)[0])
    meet, floor, down, up = meeting_of(start, slope, gravity, drag)
    misfit = math.sqrt(float(np.mean((columns @ coefficients + by_drag - y) ** 2)))
    # Derivatives of ln r of two parabolas with respect to gravity, the starts and the slopes.
    sum_of_both = 1 / up + 1 / down
    moves = gravity * sum_of_both / np.diff(slope)[0]
    of_meet = np.array([0.0, -moves, moves, -moves * meet, moves * meet])
    of_r = of_meet + [-meet * sum_of_both, 0.0, 0.0, 1 / down, 1 / up]
    spread = np.linalg.norm(of_r @ np.linalg.pinv(columns))
    error = misfit * spread * math.sqrt(len(t) / max(len(t) - len(coefficients), 1))
    return np.array([down, up, gravity, misfit, begin + meet, floor, error])

"""Contact laws with names: functions that return a :class:`.ForceLaw` (docs/named-laws.md).

Give a law in one of two ways: by the parameters of its force, as numbers or arrays; or by the
restitution coefficient, the duration and the speed of a free impact.

All quantities are dimensionless. Let a ball of mass m bounce on a table of frequency Ω under
gravity g. Then p = Ω²x/g is the penetration, and f = F/(mg) is the force per mass. Some laws use
the cubic step s = x²(3 - 2x) with x = p/d, which grows from 0 at the surface to 1 at the depth d.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.optimize import brentq

from bouncing_ball_beyond.contacts.balls import broadcast_named, checked
from bouncing_ball_beyond.contacts.laws import ForceLaw
from bouncing_ball_beyond.tables.table import Values

HERTZ = (1, -0.5, -2)
SPRING = (1, 0, -2)
DAMPER = (1, 0, -1)
NUMBER = (0, 0, 0)
"""Powers of mass, length and time in N/m^{3/2} (`HERTZ`), N/m, N s/m and 1."""

RANGES: dict[str, Any] = {
    "frequency_ratio": {"low": 0, "high": np.inf, "low_allowed": False},
    "stiffness": {"low": 0, "high": np.inf, "low_allowed": False},
    "depth": {"low": 0, "high": np.inf, "low_allowed": False},
    "damping_ratio": {"low": 0, "high": np.inf, "low_allowed": True},
    "damping": {"low": 0, "high": np.inf, "low_allowed": True},
}
"""Lower and upper bound of each parameter, and whether the lower bound is allowed."""

UNITS_OF_RATIOS = {"frequency_ratio": (0, 0, -1), "damping_ratio": NUMBER}
"""Units of ϖ and ζ."""

STEPPED = 0.1
"""Depth d of a law that is given by an impact, divided by the scale P of the penetration."""

MOST_DAMPED = 1e4
"""Maximum damping that is tried for a restitution coefficient, in the unit of each law."""


def law_of_impact(
    law_of: Callable, restitution: Values, duration: Values, speed: Values
) -> ForceLaw:
    """Find the law whose free impact at a speed has a given restitution coefficient and duration.

    Parameters
    ----------
    law_of : callable
        Function ``law_of(damping, length, speed)`` that returns the law with the damping g ≥ 0, the
        scale P of length and the scale v of speed. The equation of motion in x = p/P and s = vt/P
        must depend on g only, not on P and v.
    restitution : array_like
        r in (0, 1].
    duration : array_like
        D > 0.
    speed : array_like
        Closing speed of the impact, > 0.

    Raises
    ------
    ValueError
        If no g up to about 10⁴ gives this r.

    Examples
    --------
    >>> def law_of(damping, length, speed):
    ...     return hunt_crossley(speed**2 / length**2.5, damping / speed)
    >>> signature = law_of_impact(law_of, 0.8, 0.1, 3.5).signature(3.5)
    >>> round(float(signature.restitution), 12), round(float(signature.duration), 12)
    (0.8, 0.1)
    """
    r, duration_of_impact, v = broadcast_named(
        (name, checked(name, value, 0, high, low_allowed=False))
        for name, value, high in (
            ("restitution", restitution, 1),
            ("duration", duration, np.inf),
            ("speed", speed, np.inf),
        )
    )
    damping_and_duration = {
        coefficient: _damping_and_duration(law_of, coefficient) for coefficient in np.unique(r)
    }
    damping, unit = np.moveaxis(
        np.array([damping_and_duration[coefficient] for coefficient in r.flat]), -1, 0
    )
    length = duration_of_impact * v / unit.reshape(r.shape)
    return law_of(damping.reshape(r.shape)[()], length[()], v[()])


def _damping_and_duration(law_of: Callable, restitution: Values) -> tuple[float, float]:
    """Damping g that gives a restitution coefficient, and D of this law for P = v = 1."""

    def impact(damping: Values) -> tuple[float, float]:
        """w and D of a free impact with the speed 1; w = 0 if the ball stays on the table."""
        _, end = law_of(damping, 1.0, 1.0).first_impact(0.0, 1.0, 0.0, 0.0)
        return float(np.nan_to_num(end.speed)), float(end.duration)

    low = damping = 0.0
    if restitution < 1:
        damping = 0.1
        while impact(damping)[0] > restitution and damping < MOST_DAMPED:
            low = damping
            damping = 2 * damping
    if low < damping and impact(damping)[0] < restitution:
        high = damping
        damping = brentq(lambda g: impact(g)[0] - restitution, low, high, xtol=1e-16, rtol=1e-15)
    r, duration = impact(damping)
    if abs(r - restitution) > 1e-9:
        least = max(r, impact(low)[0])
        raise ValueError(
            f"restitution = {restitution:g}: this law has no value between 0 and {least:.4g};"
            f" give a larger value"
        )
    return damping, duration


def _given(
    values: dict[str, Values], impact: dict[str, Values], of_scales: Callable, **kind: Any
) -> ForceLaw:
    """Return a law that is given by the values of its parameters, or by an impact.

    Parameters
    ----------
    values : dict
        Parameters of the force, each None if an impact is given.
    impact : dict
        Restitution, duration and speed, each None if the parameters are given.
    of_scales : callable
        Function ``of_scales(g, P, v)`` that returns the parameters for the damping g and the scales
        P and v, as in `law_of_impact`.
    **kind
        Other arguments of :class:`.ForceLaw`.
    """
    without = [name for name, value in values.items() if value is None]
    lacking = [name for name, value in impact.items() if value is None]
    if not lacking and len(without) == len(values):
        return law_of_impact(lambda *scales: ForceLaw(values=of_scales(*scales), **kind), **impact)
    if without or len(lacking) < len(impact):
        present = [name for name, value in (values | impact).items() if value is not None]
        raise ValueError(
            f"give either {' and '.join(values)}, or restitution, duration and speed;"
            f" given: {', '.join(present) or 'nothing'}"
        )
    values = {name: checked(name, value, **RANGES[name]) for name, value in values.items()}
    return ForceLaw(values=values, **kind)


def linear(
    frequency_ratio: Values = None,
    damping_ratio: Values = None,
    *,
    release: str = "displacement",
    restitution: Values = None,
    duration: Values = None,
    speed: Values = None,
) -> ForceLaw:
    """f = ϖ²p + 2ζϖp′ with ϖ > 0, ζ ≥ 0: a spring and a damper, integrated numerically.

    :class:`.SpringDamper` is this law in closed form. ``release`` determines where contacts end:

    - "displacement": where p = 0;
    - "force": where f = 0;
    - "approach": where p = 0. The damper then acts only while p′ > 0, when the ball approaches.

    Parameters
    ----------
    frequency_ratio : array_like, optional
        ϖ, the natural frequency of the contact divided by Ω.
    damping_ratio : array_like, optional
        ζ.
    release : {"displacement", "force", "approach"}
        What ends a contact.
    restitution, duration, speed : array_like, optional
        Restitution coefficient r in (0, 1], duration D in units of 1/Ω, and closing speed in units
        of g/Ω of a free impact.

    Returns
    -------
    ForceLaw

    Raises
    ------
    ValueError
        Unless either all parameters of the force or all three of the impact are given. If no law
        of this kind has this r.

    Examples
    --------
    >>> ball = linear(20.0, 0.1, release="approach")
    >>> round(float(ball.signature(3.0).restitution), 4)
    0.8626
    """
    kinds: dict[str, Any] = {
        "displacement": {"force": _spring_damper},
        "force": {
            "force": _spring_damper,
            "release": "force",
            "lag": lambda frequency_ratio, damping_ratio: 2 * damping_ratio / frequency_ratio,
        },
        "approach": {"force": _damped_on_approach, "kinks": (lambda p, v, **values: v,)},
    }
    if release not in kinds:
        raise ValueError(f"release = {release!r}: must be 'displacement', 'force' or 'approach'")
    return _given(
        {"frequency_ratio": frequency_ratio, "damping_ratio": damping_ratio},
        {"restitution": restitution, "duration": duration, "speed": speed},
        lambda g, P, v: {"frequency_ratio": v / P, "damping_ratio": g},
        units=UNITS_OF_RATIOS,
        **kinds[release],
    )


def _spring_damper(p: Values, v: Values, frequency_ratio: Values, damping_ratio: Values) -> Values:
    return frequency_ratio * (frequency_ratio * p + 2 * damping_ratio * v)


def _damped_on_approach(
    p: Values, v: Values, frequency_ratio: Values, damping_ratio: Values
) -> Values:
    return _spring_damper(p, np.where(np.real(v) > 0, v, 0.0), frequency_ratio, damping_ratio)


def hunt_crossley(
    stiffness: Values = None,
    damping: Values = None,
    *,
    restitution: Values = None,
    duration: Values = None,
    speed: Values = None,
) -> ForceLaw:
    """f = K p^{3/2} (1 + C p′) with K > 0, C ≥ 0: damping proportional to the force of Hertz.

    The force k x^{3/2} (1 + λẋ) has K = k√g/(mΩ³) and C = λg/Ω. For slow impacts 1 - r = (2/3) C v.

    Source: K. H. Hunt and F. R. E. Crossley, Journal of Applied Mechanics 42 (1975) 440-445, as
    quoted by Simbody (``HuntCrossleyContact.h``).

    Parameters
    ----------
    stiffness : array_like, optional
        K, the stiffness per mass, in units of Ω³/√g.
    damping : array_like, optional
        C, in units of Ω/g.
    restitution, duration, speed : array_like, optional
        Restitution coefficient r in (0, 1], duration D in units of 1/Ω, and closing speed in units
        of g/Ω of a free impact.

    Returns
    -------
    ForceLaw

    Raises
    ------
    ValueError
        Unless either all parameters of the force or all three of the impact are given. If no law
        of this kind has this r.
    """
    return _given(
        {"stiffness": stiffness, "damping": damping},
        {"restitution": restitution, "duration": duration, "speed": speed},
        lambda g, P, v: {"stiffness": v**2 / P**2.5, "damping": g / v},
        force=_hunt_crossley,
        root=2,
        units={"stiffness": HERTZ, "damping": (0, -1, 1)},
    )


def _hunt_crossley(p: Values, v: Values, stiffness: Values, damping: Values) -> Values:
    return stiffness * p * np.sqrt(p) * (1 + damping * v)


def tsuji(
    stiffness: Values = None,
    damping: Values = None,
    *,
    restitution: Values = None,
    duration: Values = None,
    speed: Values = None,
) -> ForceLaw:
    """f = K p^{3/2} + C √K p^{1/4} p′ with K > 0, C ≥ 0: Hertz' contact with a constant r.

    r is the same at all speeds, with C = √5 (-ln r)/√(π² + ln² r). If C ≥ √5, the ball does not
    leave the table. The force k x^{3/2} + α √(mk) x^{1/4} ẋ has C = α.

    Sources: Y. Tsuji, T. Tanaka and T. Ishida, Powder Technology 71 (1992) 239-250, as quoted by
    LAMMPS; D. Antypov and J. A. Elliott, Europhysics Letters 94 (2011) 50004, as quoted by Yade.

    Parameters
    ----------
    stiffness : array_like, optional
        K, the stiffness per mass, in units of Ω³/√g.
    damping : array_like, optional
        C, a number.
    restitution, duration, speed : array_like, optional
        Restitution coefficient r in (0, 1], duration D in units of 1/Ω, and closing speed in units
        of g/Ω of a free impact.

    Returns
    -------
    ForceLaw

    Raises
    ------
    ValueError
        Unless either all parameters of the force or all three of the impact are given. If no law
        of this kind has this r.

    Examples
    --------
    >>> ball = tsuji(restitution=0.85, duration=0.1, speed=3.0)
    >>> round(float(ball.signature(0.5).restitution), 12)
    0.85
    """
    return _given(
        {"stiffness": stiffness, "damping": damping},
        {"restitution": restitution, "duration": duration, "speed": speed},
        lambda g, P, v: {"stiffness": v**2 / P**2.5, "damping": g + 0 * v},
        force=_tsuji,
        root=4,
        units={"stiffness": HERTZ, "damping": NUMBER},
    )


def _tsuji(p: Values, v: Values, stiffness: Values, damping: Values) -> Values:
    root = np.sqrt(p)
    return stiffness * p * root + damping * np.sqrt(stiffness) * np.sqrt(root) * v


def kuwabara_kono(
    stiffness: Values = None,
    damping: Values = None,
    *,
    restitution: Values = None,
    duration: Values = None,
    speed: Values = None,
) -> ForceLaw:
    """f = K (p^{3/2} + C√p p′) with K > 0, C ≥ 0: a viscoelastic sphere that does not adhere.

    The contact ends where the force vanishes, p + C p′ = 0. The surface is still deformed there.
    The force k (x^{3/2} + (3/2) A √x ẋ) has C = (3/2) AΩ. For slow impacts
    1 - r = 1.15 C K^{2/5} v^{1/5}.

    Sources: G. Kuwabara and K. Kono, Japanese Journal of Applied Physics 26 (1987) 1230-1233, as
    quoted by the CGNS standard; N. V. Brilliantov, F. Spahn, J.-M. Hertzsch and T. Pöschel,
    Physical Review E 53 (1996) 5382-5392, as quoted by LAMMPS. For the end of the contact:
    T. Schwager and T. Pöschel, Physical Review E 78 (2008) 051304, as quoted by the toolbox
    Approx-ViscoElastic-CoR.

    Parameters
    ----------
    stiffness : array_like, optional
        K, the stiffness per mass, in units of Ω³/√g.
    damping : array_like, optional
        C, in units of 1/Ω.
    restitution, duration, speed : array_like, optional
        Restitution coefficient r in (0, 1], duration D in units of 1/Ω, and closing speed in units
        of g/Ω of a free impact.

    Returns
    -------
    ForceLaw

    Raises
    ------
    ValueError
        Unless either all parameters of the force or all three of the impact are given. If no law
        of this kind has this r.
    """
    return _given(
        {"stiffness": stiffness, "damping": damping},
        {"restitution": restitution, "duration": duration, "speed": speed},
        lambda g, P, v: {"stiffness": v**2 / P**2.5, "damping": g * P / v},
        force=_kuwabara_kono,
        root=2,
        release="force",
        lag=lambda stiffness, damping: damping,
        units={"stiffness": HERTZ, "damping": (0, 0, 1)},
    )


def _kuwabara_kono(p: Values, v: Values, stiffness: Values, damping: Values) -> Values:
    return stiffness * np.sqrt(p) * (p + damping * v)


def adams_impact(
    stiffness: Values = None,
    damping: Values = None,
    depth: Values = None,
    *,
    restitution: Values = None,
    duration: Values = None,
    speed: Values = None,
) -> ForceLaw:
    """f = max(0, K p^{3/2} + C s p′) with K > 0, C ≥ 0, d > 0: the function IMPACT of Adams.

    The force is 0 where the damper would make it pull. The contact ends at p = 0. The damping
    increases up to the depth d, and is constant at larger depths. Impacts that reach only a small
    part of d therefore lose little energy. If an impact is given, d is a tenth of (v²/K)^{2/5}.

    Sources: the manuals of SolidWorks Motion and Altair MotionSolve.

    Parameters
    ----------
    stiffness : array_like, optional
        K, the stiffness per mass, in units of Ω³/√g.
    damping : array_like, optional
        C, the damping per mass, in units of Ω.
    depth : array_like, optional
        d, in units of g/Ω².
    restitution, duration, speed : array_like, optional
        Restitution coefficient r in (0, 1], duration D in units of 1/Ω, and closing speed in units
        of g/Ω of a free impact.

    Returns
    -------
    ForceLaw

    Raises
    ------
    ValueError
        Unless either all parameters of the force or all three of the impact are given. If no law
        of this kind has this r.
    """
    return _given(
        {"stiffness": stiffness, "damping": damping, "depth": depth},
        {"restitution": restitution, "duration": duration, "speed": speed},
        lambda g, P, v: {"stiffness": v**2 / P**2.5, "damping": g * v / P, "depth": STEPPED * P},
        force=_adams,
        root=2,
        kinks=(_full_depth, _pulls),
        units={"stiffness": HERTZ, "damping": DAMPER, "depth": (0, 1, 0)},
    )


def _step(p: Values, depth: Values) -> Values:
    """Cubic step s at the penetration p."""
    x = p / depth
    return np.where(np.real(x) < 1, x * x * (3 - 2 * x), 1.0)


def _adams(p: Values, v: Values, stiffness: Values, damping: Values, depth: Values) -> Values:
    force = stiffness * p * np.sqrt(p) + damping * _step(p, depth) * v
    return np.where(np.real(force) > 0, force, 0.0)


def _full_depth(p: Values, v: Values, stiffness: Values, damping: Values, depth: Values) -> Values:
    return p - depth


def _pulls(p: Values, v: Values, stiffness: Values, damping: Values, depth: Values) -> Values:
    """Force before its negative values are replaced by 0, divided by p^{3/2}."""
    inside = np.sqrt(p) * (3 - 2 * p / depth) / (depth * depth)
    deep = np.maximum(p, depth)
    step = np.where(np.real(p) < np.real(depth), inside, 1 / (deep * np.sqrt(deep)))
    return stiffness + damping * step * v


def simscape_contact(
    stiffness: Values = None,
    damping: Values = None,
    depth: Values = None,
    *,
    restitution: Values = None,
    duration: Values = None,
    speed: Values = None,
) -> ForceLaw:
    """f = s (K p + C p′) with K > 0, C ≥ 0, d > 0: Spatial Contact Force of Simscape Multibody.

    The forces of spring and damper increase over a transition region of the width d. The contact
    ends where the force vanishes: p + κp′ = 0 with κ = C/K. The manual gives no formula of the
    step, so a cubic is assumed. If an impact is given, d is a tenth of v/√K.

    Parameters
    ----------
    stiffness : array_like, optional
        K, the stiffness per mass, in units of Ω².
    damping : array_like, optional
        C, the damping per mass, in units of Ω.
    depth : array_like, optional
        d, in units of g/Ω².
    restitution, duration, speed : array_like, optional
        Restitution coefficient r in (0, 1], duration D in units of 1/Ω, and closing speed in units
        of g/Ω of a free impact.

    Returns
    -------
    ForceLaw

    Raises
    ------
    ValueError
        Unless either all parameters of the force or all three of the impact are given. If no law
        of this kind has this r.
    """
    return _given(
        {"stiffness": stiffness, "damping": damping, "depth": depth},
        {"restitution": restitution, "duration": duration, "speed": speed},
        lambda g, P, v: {"stiffness": (v / P) ** 2, "damping": g * v / P, "depth": STEPPED * P},
        force=_simscape,
        release="force",
        lag=lambda stiffness, damping, depth: damping / stiffness,
        kinks=(_full_depth,),
        units={"stiffness": SPRING, "damping": DAMPER, "depth": (0, 1, 0)},
    )


def _simscape(p: Values, v: Values, stiffness: Values, damping: Values, depth: Values) -> Values:
    return _step(p, depth) * (stiffness * p + damping * v)

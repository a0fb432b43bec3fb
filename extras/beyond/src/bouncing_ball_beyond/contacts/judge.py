"""Judge whether a force is a law: whether contacts with it can be computed, and are right.

A force is judged where a ball can be: at the depths and rates that the energy of a closing speed
allows. There it must

1. accept arrays of complex numbers (:func:`_check_call`);
2. stop balls without damping (:func:`judge`);
3. be analytic, but for the kinks that the law declares (:func:`_check_lines`);
4. be a function of p^{1/m} at p = 0 to which polynomials converge (:func:`_check_root`);
5. not pull at rest, if contacts end where the force vanishes (:func:`_check_release`);
6. add no energy to free impacts (:func:`_check_energy`).

Points are (p, v, load), arrays of the shape (3, ...).
"""

import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from bouncing_ball_beyond.contacts.balls import H, broadcast_named
from bouncing_ball_beyond.contacts.forces import DEPTHS, Force
from bouncing_ball_beyond.contacts.resolution import MOST_SEGMENTS, divisions

FIRST_SPEED, FIRST_LOAD = 12.0, 6.0
"""Closing speed and load up to which a new law is judged.

Orbits with one impact in one period close at π to 2π. The signatures of such impacts are
polynomials that extend up to 8. Answers do not depend on these numbers: faster impacts and larger
loads are judged when they occur, in steps of a factor of two.
"""

LADDER = 2.0 ** (np.arange(-23, 1) / 2)
"""Closing speeds of the free impacts that must not gain energy, divided by the largest.

They are so close that r changes little from one to the next. A force with c v (1 - v²/9) gains
energy above 3.5, and its free impacts do not end above 4.9.
"""

START_SHARES = 4.0 ** np.arange(-3, 1)
"""Speeds at the start of contacts at which a force that depends on them is judged, divided by the
largest. At each, the ball is as fast. Its energy is asked for on the whole `LADDER`."""

NO_GAIN = 1 + 1e-6
"""Largest ratio of the speeds after and before a free impact that is a rounding error.

Elastic forces with a step have errors of up to 2e-11.
"""

ROUNDED = 1e-11
"""Largest difference of forces within rounding, divided by their size."""

TO_KINK = 3
"""Number of divisions after which a part of a segment contains a kink or a jump.

A smooth step as narrow as 1/30,000 of a segment is accepted. Such steps have right answers: for the
force kp (1 + m tanh(v/w)), r differs from √((1 - m)/(1 + m)) by 0.03 w. The loss σ of an elastic
force with a step at a depth is 0 within 2e-10, and within 7e-8 if the step is as narrow as
accepted.
"""

NARROW = 10.0
"""Ratio of the change of the force to the force on the whole segment above which the change is a
pole. A jump changes the force on the whole segment."""

TOO_FAST = (
    "force: tends to infinity or changes too fast near {}, where the energy of f(p, 0) does not"
    " stop a ball: make a narrow pole or step wider, and give the damping no pole of its own"
)


def check_force(law: Force) -> None:
    """Raise ValueError unless the force of a new law meets the requirements.

    In a row of balls, the balls with an extreme value of a parameter are judged.
    """
    # The entry without a name serves forces without parameters.
    arrays = broadcast_named([*law.values.items(), ("", 0.0)])
    rows = np.stack([np.ravel(np.real(x)) for x in arrays], axis=-1)
    for row in np.unique(np.concatenate([rows.argmin(axis=0), rows.argmax(axis=0)])):
        one = law.at(**dict(zip(law.values, rows[row, :-1], strict=True)))
        _check_call(one)
        judge(one, FIRST_SPEED, FIRST_LOAD)


@np.errstate(all="ignore")
def judge(law: Force, speed: float, load: float) -> None:
    """Raise ValueError unless a force is right for balls up to a closing speed and a load."""
    highest = law.energies[1].max()
    if highest <= 0:
        raise ValueError(
            "force: stops no ball; f(p, 0) must be positive at positive p: check its sign"
        )
    speed = min(speed, 0.999 * np.sqrt(2 * highest))
    if "start_speed" in law.needs:
        for start in speed * START_SHARES:
            _check_force(law, start, load, start)
        _check_energy(law, speed)
        return
    damping, v = _check_force(law, speed, load, 1.0)
    if not np.all(damping * v >= -ROUNDED * np.abs(v) * (1 + np.abs(damping))):
        _check_energy(law, speed)


def _check_force(law: Force, speed: float, load: float, start_speed: float) -> tuple:
    """Check the force for balls up to a closing speed. Return damping forces, and their rates."""
    given = {**law.values, "u": start_speed}

    def force(points: Any) -> NDArray:
        p, v, a = points
        return law.force_at(p, v, a, given)

    rates = speed * np.array([[-0.63], [-0.13], [0.1], [0.57]])
    speeds = np.sqrt(speed**2 - rates**2) * np.geomspace(1e-3, 1.0, 121)
    # Next to a wall, the depths of equal ratios of the speed are close to each other.
    deepest = np.fmax(law.depth(speeds[:, -1:]), law.depth(speeds[:, -1:], load))
    depths = np.hstack([deepest * np.geomspace(1e-3, 1.0, 121), law.depth(speeds)])
    along_p = np.array(np.broadcast_arrays(np.sort(depths), rates, 1.0))
    speeds = speed * np.array([[0.03], [0.3], [0.7], [0.95]])
    rates = np.sqrt(speed**2 - speeds**2) * np.linspace(-1.001, 1.0, 241)
    loaded = np.fmax(law.depth(speeds[2:]), law.depth(speeds[2:], load))
    depths = np.concatenate([law.depth(speeds[:2]), loaded])
    along_v = np.array(np.broadcast_arrays(depths, rates, 1.0))
    lines = {"p": along_p, "v": along_v}
    if "load" in law.needs:
        loads = load * np.linspace(-1, 1.001, 241)
        lines["load"] = np.array(np.broadcast_arrays(depths, 0.3 * speed, loads))
    usual = speed**2 / (2 * law.depth(speed))
    for name, points in lines.items():
        _check_lines(law, force, name, points, usual)
    _check_root(law, force, law.depth(min(1.0, speed)))
    if law.release == "force":
        _check_release(law, force, along_v)
    p, v, a = along_v
    return force(along_v) - force((p, 0 * v, a)), v


def _check_call(law: Force) -> None:
    """Raise ValueError unless the force and its kinks accept arrays of complex numbers."""
    p = np.array([0.5, 1.0, 0.5, 1.0]) + 1j * H
    v = np.array([0.5, 1.0, -0.5, -1.0]) + 1j * H
    functions = {"force": lambda p, v, **own: law.force_at(p, v, 1.0, {**own, "u": 1.0})}
    functions |= {f"kinks[{i}]": kink for i, kink in enumerate(law.kinks)}
    for name, function in functions.items():
        try:
            # SciPy's splines leave out imaginary parts, and only warn.
            with np.errstate(all="ignore"), warnings.catch_warnings():
                warnings.simplefilter("error", np.exceptions.ComplexWarning)
                value = function(p, v, **law.values)
        except Exception as error:
            reason = f"{type(error).__name__}: {error}"
            raise ValueError(
                f"{name}: must accept its parameters by name, and arrays of complex numbers: write"
                " np.where(...) instead of 'if', numpy functions instead of math, and a polynomial"
                " instead of a table or a spline"
                f" ({reason})"
            ) from None
        if not isinstance(value, np.ndarray) or value.shape != p.shape:
            returned = np.shape(value) if isinstance(value, np.ndarray) else type(value).__name__
            raise ValueError(
                f"{name}: must return an array of the shape of p and v, {p.shape}, not {returned}"
            )
        # A deeper point, and the same points in reverse, between two equal calls.
        with np.errstate(all="ignore"):
            function(1e3 * p, v, **law.values)
            again = function(p[::-1], v[::-1], **law.values)[::-1]
        if not np.array_equal(value, again, equal_nan=True):
            raise ValueError(
                f"{name}: has another value when it is asked again, but must not remember other"
                " depths or rates; replace a memory as docs/laws.md shows"
            )


def _check_lines(law: Force, force: Callable, name: str, points: NDArray, usual: float) -> None:
    """Check the force on lines of points, shape (3, lines, points), along which ``name`` changes.

    The change of the force on a segment between neighbouring points must be the integral of its
    derivative (:func:`.resolution.divisions`). A smooth force passes, a kink remains until the
    change of the force is a rounding error, and a jump remains. ``usual`` is the mean force that
    stops a ball: smaller forces count as this one.
    """
    for division, part in enumerate(divisions(force, points, usual)):
        segments, whole = part.segments[..., part.wrong], part.whole[..., part.wrong]
        if division <= TO_KINK:
            broken = whole, segments
        if segments.shape[2] > MOST_SEGMENTS:
            place = _where(*segments[0, :, 0])
            if division > 1:
                raise ValueError(TOO_FAST.format(place))
            slopes = np.array([part.change, part.expected])[:, part.wrong][:, 0]
            slopes = slopes / np.ptp(segments[..., 0], axis=0).max()
            raise ValueError(
                f"force: is not analytic in {name}, or changes too fast, at {place}: its derivative"
                " is {:.4g} by a difference and {:.4g} by a complex step; write it without abs,"
                " real, sign".format(*slopes)
            )
    jumps = part.jumps
    if jumps.size:
        jump = np.abs(part.change[jumps[0]])
        place = _where(*part.segments[0, :, jumps[0]])
        if jump > NARROW * part.size[jumps[0]]:
            raise ValueError(TOO_FAST.format(place))
        raise ValueError(
            f"force: jumps by {jump:.3g} near {place}, but must be continuous; replace the jump by"
            " a smooth step, such as (1 + np.tanh(x / width)) / 2 with a small width"
        )
    _check_kinks(law, force, name, *broken)


def _check_kinks(law: Force, force: Callable, name: str, whole: NDArray, segments: NDArray) -> None:
    """Raise ValueError if there is a kink on segments, and the law does not declare it.

    The segments are parts of the ``whole`` segments.
    """
    declared = np.zeros(segments.shape[2], bool)
    for kink in law.kinks:
        side = [np.sign(kink(p, v, **law.values)) for p, v, _ in segments]
        declared |= side[0] * side[1] <= 0
    if declared.all():
        return
    k = np.flatnonzero(~declared)[0]
    width = np.ptp(segments[..., k], axis=0).max()
    remedy = (
        "give kinks=(kink,), where kink(p, v, **values) changes its sign there; a smooth step must"
        f" be wider than {width:.1g} in {name}"
    )
    if np.any(force(whole[..., k].T) == 0):
        remedy = (
            "if the contact ends where the force vanishes, write the force without this limit and"
            ' give release="force"; otherwise ' + remedy
        )
    raise ValueError(f"force: has a kink near {_where(*segments[0, :, k])}; {remedy}")


def _where(p: float, v: float, load: float) -> str:
    """Text of a point. Rates are rounded, because those of a kink at v = 0 are not quite zero."""
    at = f"p = {p:.2g}, v = {round(v, 4) + 0.0:.2g}"
    return at if load == 1 else f"{at}, load = {round(load, 4) + 0.0:.2g}"


def _check_root(law: Force, force: Callable, depth: float) -> None:
    """Raise ValueError unless polynomials in q = p^{1/m} converge to the force at q = 0.

    If they do, its Legendre coefficients on a short range of q decay geometrically.
    """
    x, _ = legendre.leggauss(24)
    to_coefficients = np.linalg.inv(legendre.legvander(x, 23))

    def last(root: int) -> float:
        """Last coefficients, divided by the middle coefficients or by rounding errors."""
        q = (x + 1) / 2 * (0.01 * depth) ** (1 / root)
        sizes = np.abs(to_coefficients @ force((q**root, 0.5 + 0 * q, 1.0)))
        return sizes[-4:].max() / max(1e-12 * sizes.max(), 1e-3 * sizes[8:12].max())

    if last(law.root) > 1:
        others = [m for m in (1, 2, 4, 6, 8) if last(m) <= 0.01]
        hint = f"; give root={others[0]}, for which they do" if others else ""
        power = f"p^(1/{law.root})" if law.root > 1 else "p"
        raise ValueError(f"force: polynomials in {power} do not converge to it at p = 0{hint}")


def _check_release(law: Force, force: Callable, points: NDArray) -> None:
    """Raise ValueError unless contacts may end where the force vanishes."""
    values = force(points)
    if np.any(values == 0):
        raise ValueError(
            "force: is zero on a part of the contact, but release='force' ends it where the"
            " force changes its sign: write the force without this limit"
        )
    # Slow rates, because the force may have a pole at a depth.
    rates = np.array([-1e-3, 0.0])
    lagging, static = np.abs(force((law.kappa * 1e-3 + 0 * rates, rates, 1.0 + 0 * rates)))
    if law.lag and lagging > ROUNDED * static:
        raise ValueError(
            "lag: must return κ of the line p + κp′ = 0 on which the force vanishes, but the force"
            " does not vanish there"
        )
    depths = np.append(0.0, DEPTHS[DEPTHS < points[0].max()])
    held = force((depths, 0 * depths, 1 + 0 * depths))
    weakest = held.argmin()
    if held[weakest] < -ROUNDED * np.abs(values).max():
        raise ValueError(
            f"force: pulls with {-held[weakest]:.3g} at p = {depths[weakest]:.2g} and v = 0, but"
            " release='force' ends contacts where the force vanishes: a slow ball would leave as it"
            " arrives; write a force that does not pull at rest, or give release='displacement'"
        )


def _check_energy(law: Force, speed: float) -> None:
    """Raise ValueError if the force adds energy to free impacts up to a closing speed.

    A force that opposes the rate everywhere cannot, and need not be asked.
    """
    speeds = speed * LADDER
    ends = law.after_free_impacts(speeds)
    keeps = ends <= NO_GAIN * speeds
    if not keeps.all():
        k = np.argmin(keeps)
        if np.isnan(ends[k]):
            raise ValueError(
                f"force: a ball with the closing speed {speeds[k]:.3g} never leaves: the force is"
                " NaN during its contact, or the contact has no end"
            )
        raise ValueError(
            f"force: adds energy: a ball with the closing speed {speeds[k]:.3g} leaves with"
            f" {ends[k]:.4g}: check the sign of the damping"
        )

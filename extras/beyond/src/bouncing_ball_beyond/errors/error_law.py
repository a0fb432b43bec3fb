"""Compute errors of the restitution model exactly, or by the error law in closed form.

The error of a quantity q is (q_contact - q)/q, where q is its value in the restitution model
(Eqs. 37, 38). docs/error-law.md has the law, its symbols and its accuracy; appendix.md has the
proof.
"""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize.elementwise import find_root

from bouncing_ball_beyond.contacts.balls import (
    Ball,
    H,
    Rigid,
    SpringDamper,
    brief,
    check_ball,
    check_ends,
    check_whole_numbers,
    checked,
    one_number,
    whole_number,
)
from bouncing_ball_beyond.contacts.laws import ForceLaw
from bouncing_ball_beyond.periodic.equations import AT_FOLD, OrbitEquations, are_stable
from bouncing_ball_beyond.periodic.instants import closing_speeds
from bouncing_ball_beyond.periodic.march import newton
from bouncing_ball_beyond.periodic.search import guess_of_instants, rows_of
from bouncing_ball_beyond.tables.table import SINE, Table, Values, check_table

QUANTITIES = (
    "max_height",
    "bounce_velocity",
    "phase",
    "apparent_restitution",
    "saddle_node",
    "period_doubling",
)
"""Quantities of the n-T orbit at an amplitude, and the amplitudes of its two bifurcations."""

BIFURCATIONS = {"saddle_node", "period_doubling"}
"""Quantities that do not belong to the orbit at an amplitude."""


AT_TOLERANCE = 1e-12
"""Relative distance of an error from its tolerance at which a threshold counts as found.

The slope of ln error over ln ϖ is about 1, so thresholds have the same relative error.

At half and at twice: no effect. With 0, twice as many errors are computed.
"""


class FreeImpact(NamedTuple):
    """Signature of a free impact with the closing speed v₀ of n-T orbits, and derivatives.

    Attributes
    ----------
    n : array
        Number of periods of the table in one period of the orbit.
    speed : array
        v₀, the root of (1 + r(v)) v = 2nπ. All other quantities belong to this speed.
    restitution, duration, centroid : array
        r, D and t_c.
    slope, curvature : array
        First and second derivative of r(v) v with respect to v; ``slope`` is r̂.
    centroid_slope : array
        d(v t_c)/dv.
    load : array
        σ.
    load_slope : array
        dσ/dv.
    """

    n: NDArray
    speed: NDArray
    restitution: NDArray
    slope: NDArray
    curvature: NDArray
    duration: NDArray
    centroid: NDArray
    centroid_slope: NDArray
    load: NDArray
    load_slope: NDArray

    def stretched(self, factor: ArrayLike) -> "FreeImpact":
        """Return the free impact on a contact that is stretched by the factor γ.

        The stretched contact has the force f(p/γ, p′)/γ. It lasts γ times as long and has the
        same r. For a spring and a damper ϖ becomes ϖ/γ.
        """
        names = ("duration", "centroid", "centroid_slope", "load", "load_slope")
        return self._replace(**{name: factor * getattr(self, name) for name in names})

    @property
    def half(self) -> NDArray:
        """nπ, the modulus of the velocity of the ball just before and just after an impact."""
        return self.n * np.pi

    @property
    def line(self) -> NDArray:
        """C = v₀ - nπ, the velocity w′ of the table at the impacts of the restitution model.

        On a sine, C is also the Λ of the saddle-node of this model.
        """
        return self.speed - self.half

    @property
    def shift(self) -> NDArray:
        """s = σ/(1 + r̂). On a contact, C - s replaces the C of the restitution model."""
        return self.load / (1 + self.slope)

    @property
    def doubling(self) -> NDArray:
        """2(1 + r r̂)/[(1 + r)(1 + r̂)], the -w″ of the restitution model's doubling (Eq. R8)."""
        return 2 * (1 + self.restitution * self.slope) / ((1 + self.restitution) * (1 + self.slope))


def free_impact(ball: Ball, n: ArrayLike = 1) -> FreeImpact:
    """Compute the free impact of a ball at the speed v₀, a root of (1 + r(v)) v = 2nπ.

    r(v) is that of the ball: of free impacts of a contact, or as given to :class:`.Rigid`. If r
    falls so fast that there are several roots, v₀ is one of them, to which Newton's method leads
    from 1.5 nπ. ``others`` of an orbit names the others.

    Parameters
    ----------
    ball : Ball
        The ball.
    n : array_like
        Number of periods of the table from impact to impact.

    Returns
    -------
    FreeImpact
        Speed in units of g/Ω, times in units of 1/Ω.

    Raises
    ------
    ValueError
        If n is not a whole number from 1, or if free impacts of the ball do not end.
    """
    check_ball(ball)
    check_whole_numbers("n", n)
    half = np.pi * np.asarray(n)
    speed = 1.5 * half
    check_ends("ball", ball, speed)
    step = speed
    # After a step of Newton's method the error is of the order of the square of the step.
    for _ in range(NEWTON):
        if not np.any(np.abs(step) > 1e-8 * speed):
            break
        at = speed + 1j * H
        signature = ball.signature(at)
        bounced = signature.restitution * at
        step = (speed + bounced.real - 2 * half) / (1 + bounced.imag / H)
        # nπ ≤ v ≤ 2nπ, because 0 ≤ r ≤ 1. The duration broadcasts to the shape of all parameters.
        speed = np.clip(speed - step, half, 2 * half) + 0 * np.real(signature.duration)
    else:
        speed = _nearest_root(ball, n, speed, np.abs(step) > 1e-8 * speed)
    aside = 1e-4 * speed
    at = np.stack([speed - aside, speed, speed + aside]) + 1j * H
    values = np.array(np.broadcast_arrays(*ball.signature(at), at))
    restitution, duration, centroid, load, _ = values[:, 1].real
    slopes = (values[0] * at).imag / H
    return FreeImpact(
        n=np.asarray(n),
        speed=speed,
        restitution=restitution,
        slope=slopes[1],
        curvature=(slopes[2] - slopes[0]) / (2 * aside),
        duration=duration,
        centroid=centroid,
        centroid_slope=(values[2] * at).imag[1] / H,
        load=load,
        load_slope=values[3, 1].imag / H,
    )


NEWTON = 60
"""Number of steps of Newton's method after which the speeds are searched by bracketing, because r
changes too fast. Usual balls take about five."""


def _nearest_root(ball: Ball, n: ArrayLike, speed: NDArray, lost: NDArray) -> NDArray:
    """Replace speeds that are ``lost`` by the root of (1 + r(v)) v = 2nπ nearest to 1.5 nπ."""
    row, (periods,), _ = rows_of(ball, n=n)
    speed = np.array(speed)
    for i in np.flatnonzero(lost):
        speeds = closing_speeds(row.rows(i), int(periods[i]))
        speed.flat[i] = speeds[np.abs(speeds - 1.5 * np.pi * periods[i]).argmin()]
    return speed


def off_rounding(impact: FreeImpact, amplitude: ArrayLike, table: Table) -> NDArray:
    """Return Λ, or the saddle-node C/max W′ if Λ is smaller only by rounding errors.

    The Λ of the saddle-node of the restitution model then satisfies C ≤ Λ max W′. Raises ValueError
    for a Λ or a table that is not allowed.
    """
    check_table(table)
    amplitude = np.asarray(checked("amplitude", amplitude, 0, np.inf, low_allowed=False))
    node = impact.line / table.slope
    # C is a difference of numbers as large as the speed, so the error of C is a few eps times the
    # speed.
    rounding = 4 * np.finfo(float).eps * impact.speed / table.slope
    below = (amplitude < node) & (node - amplitude <= rounding)
    return np.where(below, node, amplitude)


def restitution_trace(impact: FreeImpact, push: Values) -> tuple[NDArray, NDArray]:
    """Trace and determinant of the return map of the restitution model, where -w″ = ``push``.

    The determinant is r r̂. The trace is 1 + r r̂ at the saddle-node, where w″ = 0, and -(1 + r r̂) at
    the period doubling.
    """
    r, slope = np.real(impact.restitution), np.real(impact.slope)
    determinant = r * slope + 0 * np.real(push)
    return 1 + determinant - (1 + r) * (1 + slope) * np.real(push), determinant


def restitution_values(impact: FreeImpact, amplitude: ArrayLike, table: Table = SINE) -> dict:
    """Compute the six `QUANTITIES` of the restitution model in closed form (Eqs. 6, 7 and R8)."""
    amplitude = off_rounding(impact, amplitude, table)
    phase, lift, _, _ = table.instant(impact.line, amplitude)
    anywhere = 0 * (impact.line + amplitude)
    return {
        "max_height": lift + impact.half**2 / 2,
        "bounce_velocity": impact.half + 0 * lift,
        "phase": phase - table.steepest,
        "apparent_restitution": impact.restitution + 0 * lift,
        "saddle_node": impact.line / table.slope + anywhere,
        "period_doubling": table.amplitude_at(impact.line, impact.doubling)[0] + anywhere,
    }


class Compared(dict[str, Any]):
    """Values, errors or thresholds by the name of the quantity.

    Attributes
    ----------
    unstable : array of str
        Which of the orbits that are compared is unstable: "", "in the simple model", "on the
        contact" or "in both models". "" if there is no orbit, or none is compared.
    inadmissible : array of str
        Which of these orbits no ball follows, and why, such as "on the contact: a flight passes
        below the table".
    """

    unstable: NDArray
    inadmissible: NDArray

    def __init__(self, values: dict, simple: "Flags", contact: "Flags") -> None:
        super().__init__(values)
        self.unstable, self.inadmissible = _texts(simple, contact)


class Flags(NamedTuple):
    """What is to be known of n-T orbits before something is concluded from them.

    Attributes
    ----------
    unstable : array of bool
        Whether the orbit exists and is unstable.
    obstacle : array of str
        Why no ball follows the orbit; "" if a ball does, or if there is no orbit.
    """

    unstable: NDArray
    obstacle: NDArray


NONE = Flags(np.array(False), np.array(""))
"""Flags if no orbit is asked for."""

UNSTABLE = np.array(["", "in the simple model", "on the contact", "in both models"])
"""Texts by index: 1 if the orbit of the simple model is unstable, plus 2 if that on the contact is.
"""


def _texts(simple: Flags, contact: Flags) -> tuple[NDArray, NDArray]:
    """Texts of :class:`Compared` on unstable and inadmissible orbits."""
    unstable = UNSTABLE[simple.unstable + 2 * contact.unstable]
    pairs = np.broadcast_arrays(simple.obstacle, contact.obstacle)
    texts = [
        "; ".join(
            f"{where}: {why}" for where, why in zip(UNSTABLE[1:3], obstacles, strict=True) if why
        )
        for obstacles in zip(*map(np.ravel, pairs), strict=True)
    ]
    return unstable, np.reshape(texts, pairs[0].shape)[()]


def law_errors(
    impact: Ball | FreeImpact, *, amplitude: ArrayLike, n: ArrayLike = 1, table: Table = SINE
) -> Compared:
    """Use the error law to compute the signed errors of the restitution model.

    An error is (x_c - x)/x, where x_c is the value on the contact and x is the value in the model
    (Eqs. 37 and 38). The error of the phase is (x_c - x)/2π, a share of a period. The remainder of
    the law is of the second order in the duration of contacts, and of the order 3/2 next to the
    saddle-node.

    Parameters
    ----------
    impact : Ball or FreeImpact
        A ball, or its :func:`free_impact` for this n.
    amplitude : array_like
        Λ, which broadcasts with the parameters of the ball.
    n : int or array
        Number of periods of the table in one period of the orbit; it broadcasts, too.
    table : Table
        The waveform. The impacts of the orbits come after the phase at which the table rises
        fastest.

    Returns
    -------
    Compared
        Errors by the names in :data:`QUANTITIES`. They are NaN if a model has no orbit. The law
        does not decide on the orbit on the contact: ``unstable`` and ``inadmissible`` are those of
        the simple model. The function ``contact_values(Rigid(r), …)`` gives the Λ of the period
        doubling.

    Examples
    --------
    >>> from bouncing_ball_beyond import SpringDamper
    >>> ball = SpringDamper(frequency_ratio=82.18, restitution=0.65)
    >>> round(float(law_errors(ball, amplitude=1.0)["max_height"]), 5)
    -0.01
    """
    impact = impact if isinstance(impact, FreeImpact) else free_impact(impact, n)
    amplitude = off_rounding(impact, amplitude, table)
    reference = restitution_values(impact, amplitude, table)
    # r is NaN below the saddle-node.
    r = reference["apparent_restitution"]
    delay = impact.centroid
    shift = impact.shift
    phase, lift, rise, jolt = table.instant(impact.line, amplitude)
    later, turned, push, _ = table.instant(impact.line - shift, amplitude)
    _, _, doubling, _ = _doubling_shift(impact, table)
    with np.errstate(invalid="ignore", divide="ignore"):
        turn = later - phase
        risen = turned - lift - shift * impact.line - impact.speed * delay
        loaded = impact.load - impact.duration + (1 + r) * delay - (impact.slope - r) * shift
        load = 1 - push + shift * jolt
        errors = {
            "max_height": risen / reference["max_height"],
            "bounce_velocity": -(impact.duration - delay) / reference["bounce_velocity"],
            "phase": (turn - shift - delay) / (2 * np.pi),
            "apparent_restitution": loaded * load / (r * impact.speed),
            "saddle_node": np.divide(-shift, impact.line) + 0 * reference["saddle_node"],
            "period_doubling": doubling + 0 * reference["period_doubling"],
        }
    return Compared(errors, _simple_flags(impact, amplitude, table, phase, rise), NONE)


def _simple_flags(
    impact: FreeImpact, amplitude: NDArray, table: Table, phase: NDArray, push: NDArray
) -> Flags:
    """Flags of the orbits of the restitution model, whose impacts have this phase and -w″."""
    trace, determinant = restitution_trace(impact, push)
    unstable = np.isfinite(trace) & ~are_stable(trace, determinant)
    given = np.broadcast_arrays(phase, impact.speed, amplitude, impact.restitution, impact.n)
    tau, u, scale, r, n = (values.ravel() for values in given)
    # r is above 1 by rounding in free impacts without loss.
    equations = OrbitEquations(Rigid(np.clip(r, 0, 1)), 1, n, table=table)
    obstacle = _obstacles(equations, np.stack([tau, u, scale], axis=-1))
    return Flags(unstable, obstacle.reshape(given[0].shape))


def _obstacles(equations: OrbitEquations, z: NDArray) -> NDArray:
    """Why no ball follows orbits, shape (rows,); "" for rows that are NaN."""
    exist = np.flatnonzero(np.isfinite(z[:, 0]))
    obstacles = np.full(len(z), "", object)
    for block in np.array_split(exist, exist.size // BLOCK + 1) if exist.size else []:
        obstacles[block] = equations.rows(block).obstacles(z[block])
    return obstacles.astype(str)


BLOCK = 4096
"""Number of orbits that are computed at once, which limits the memory."""


def _doubling_shift(impact: FreeImpact, table: Table = SINE) -> tuple:
    """First-order shifts of w′, -w″, Λ (relative) and the phase of the period doubling."""
    amplitude, phase = table.amplitude_at(impact.line, impact.doubling)
    jolt = -amplitude * table(phase, 3)
    slope = impact.slope
    half = impact.half
    rise = impact.doubling - 1
    across = impact.shift * rise
    steeper = impact.curvature * across - impact.load_slope * rise
    along = (
        (1 - slope) * across
        + 2 * impact.centroid_slope * rise
        - half * impact.load * jolt
        + steeper * (half * (1 - rise) - impact.speed)
    )
    along = along / (half * (1 + slope))
    share = impact.doubling * along + jolt * across
    share = share / (impact.doubling**2 + impact.line * jolt)
    return across, along, share, (share * impact.line - across) / impact.doubling


def law_coefficients(
    impact: Ball | FreeImpact, *, amplitude: ArrayLike, n: ArrayLike = 1, table: Table = SINE
) -> Compared:
    """Compute coefficients K of errors. A contact that is stretched by γ has the errors Kγ.

    This holds far above the saddle-node. If the given ball has ϖ = 1, errors at other ϖ are K/ϖ. At
    the saddle-node the coefficients of height and phase are infinite. Parameters are as in
    :func:`law_errors`.
    """
    impact = impact if isinstance(impact, FreeImpact) else free_impact(impact, n)
    errors = law_errors(impact.stretched(1j * H), amplitude=amplitude, table=table)
    values = {name: np.imag(error) / H for name, error in errors.items()}
    return _with_flags_of(errors, values)


def _with_flags_of(orbits: Compared, values: dict) -> Compared:
    """Return values that belong to the same orbits as others."""
    compared = Compared(values, NONE, NONE)
    compared.unstable, compared.inadmissible = orbits.unstable, orbits.inadmissible
    return compared


def law_thresholds(
    contacts: SpringDamper | ForceLaw | Callable,
    *,
    amplitude: ArrayLike,
    n: ArrayLike = 1,
    tolerance: float = 0.01,
    table: Table = SINE,
) -> Compared:
    """Use the error law to compute the ϖ above which the restitution model is within a tolerance.

    This ϖ is |K|/ε, except for the height and the phase. The saddle-node changes the errors of
    height and phase in the first order (Eq. R7 of the article).

    Parameters
    ----------
    contacts : SpringDamper, ForceLaw or callable
        One of

        1. a spring and a damper, whose ϖ is ignored;
        2. a contact law with units. The number π/(D + κ) then replaces ϖ, where D is the duration
           of a free impact, and κ is -δ/δ′ at the end of this impact;
        3. a function that returns the ball for a number that replaces ϖ. The duration of a free
           impact must be inversely proportional to this number.
    amplitude, n, table
        As in :func:`law_errors`.
    tolerance : float
        Largest modulus ε of the error.

    Returns
    -------
    Compared
        Threshold values of ϖ. The keys are the names in :data:`QUANTITIES`.

    Examples
    --------
    >>> from bouncing_ball_beyond import SpringDamper
    >>> thresholds = law_thresholds(SpringDamper(1.0, restitution=0.65), amplitude=1.0)
    >>> round(float(thresholds["max_height"]), 2), round(float(thresholds["phase"]), 1)
    (82.18, 17.8)
    """
    impact = free_impact(ball_at_ratio(contacts, n, tolerance)(1.0), n)
    amplitude = off_rounding(impact, amplitude, table)
    coefficients = law_coefficients(impact, amplitude=amplitude, table=table)
    thresholds = {name: np.abs(value) / tolerance for name, value in coefficients.items()}
    for name in ("max_height", "phase"):
        thresholds[name] = 1 / _first_stretch(impact, amplitude, tolerance, name, table)
    return _with_flags_of(coefficients, thresholds)


@np.errstate(invalid="ignore", divide="ignore")
def _first_stretch(
    impact: FreeImpact, amplitude: NDArray, tolerance: float, name: str, table: Table
) -> NDArray:
    """Find the smallest stretch γ at which an error exceeds the tolerance.

    Samples bracket this γ.
    """
    shift = impact.shift
    # The law has orbits if |C - s| is below Λ max W′. It does not apply to contacts as long as 4π.
    end = (impact.line + np.copysign(amplitude * table.slope, shift)) / shift * (1 - 1e-9)
    end = np.fmin(end, 4 * np.pi / impact.duration)
    if table.is_sine:
        # The error is concave. The error of the height is largest if -w″ rises as fast as the depth
        # of the instant. The error of the phase is largest if ψ falls as fast as the delay grows.
        # `turns` has the values of C - s at these maxima.
        deeper = shift * impact.line + impact.speed * impact.centroid
        share = shift / (shift + impact.centroid)
        turns = {
            "max_height": deeper * amplitude / np.hypot(shift, deeper),
            "phase": np.sqrt(np.maximum(np.square(amplitude) - share**2, 0)),
        }
        largest = np.where(shift > 0, np.maximum((impact.line - turns[name]) / shift, 0), 0)
        places = np.array(np.broadcast_arrays(0.0, largest, end))
    else:
        # Next to the saddle-node, errors leave the tolerance at short stretches.
        places = np.multiply.outer(np.linspace(0, 1, 201) ** 3, end)

    def error(stretch: Values, amplitude: Values, *fields: NDArray) -> Values:
        stretched = FreeImpact(*fields).stretched(stretch)
        return law_errors(stretched, amplitude=amplitude, table=table)[name]

    errors = error(places, amplitude, *impact)
    beyond = np.abs(errors) > tolerance
    after = np.maximum(beyond.argmax(axis=0), 1)[np.newaxis]
    low, high = (np.take_along_axis(places, index, axis=0)[0] for index in (after - 1, after))
    value = np.take_along_axis(errors, after, axis=0)[0]
    crossing = find_root(
        lambda stretch, bound, *known: error(stretch, *known) - bound,
        (low, high),
        args=(np.copysign(tolerance, value), amplitude, *impact),
    )
    return np.where(beyond.any(axis=0), crossing.x, end + 0 * errors[-1])


def ball_at_ratio(
    contacts: SpringDamper | ForceLaw | Callable, n: ArrayLike, tolerance: float
) -> Callable:
    """Return a function that maps ϖ, or the number that replaces it, to the ball."""
    one_number("tolerance", tolerance)
    if isinstance(contacts, SpringDamper | ForceLaw):
        impact = free_impact(contacts, n)
        return contacts.at_ratio(impact.restitution, impact.centroid)
    if not callable(contacts):
        raise ValueError(
            f"contacts = {brief(contacts)}: must be a SpringDamper, a ForceLaw, or a function that"
            " returns one of them"
        )
    return contacts


def contact_values(
    ball: Ball,
    *,
    amplitude: ArrayLike,
    n: ArrayLike = 1,
    quantities: Sequence[str] = QUANTITIES,
    table: Table = SINE,
) -> Compared:
    """Compute quantities of the n-T orbit of a ball, and the Λ of its bifurcations.

    The orbit is on the stable side of the saddle-node. If r(v) has several closing speeds, it is
    the orbit that closes near the speed of :func:`free_impact`.

    Parameters
    ----------
    ball : Ball
        The ball.
    amplitude, n, table
        As in :func:`law_errors`. ``amplitude`` and ``n`` broadcast with the parameters of the ball.
    quantities : sequence of str
        Names from :data:`QUANTITIES`.

    Returns
    -------
    Compared
        Arrays by name. They are NaN if there is no orbit. ``unstable`` and ``inadmissible`` name
        orbits that are, as "on the contact". The phase is counted from the phase at
        which the table rises fastest, which is 0 for a sine. A corrected ball has instantaneous
        impacts. Its phase, velocity and apparent restitution belong to contacts that start t_c
        before these impacts and end D - t_c after them.
    """
    values, flags = _contact_values(ball, amplitude, n, quantities, table)
    return Compared(values, NONE, flags)


def _contact_values(
    ball: Ball,
    amplitude: ArrayLike,
    n: ArrayLike,
    quantities: Sequence[str],
    table: Table,
    judged: bool = True,
) -> tuple[dict, Flags]:
    """Values of :func:`contact_values`, and flags of the orbits if they are ``judged``."""
    if isinstance(quantities, str) or not set(quantities) <= set(QUANTITIES):
        raise ValueError(
            f"quantities = {quantities!r}: must be a list of names from {', '.join(QUANTITIES)}"
        )
    checked("amplitude", amplitude, 0, np.inf, low_allowed=False)
    check_table(table)
    check_whole_numbers("n", n)
    row, (amplitudes, periods), shape = rows_of(ball, amplitude=amplitude, n=n)
    check_ends("ball", ball, 1.5 * np.pi * np.asarray(n))
    values_of_rows = {name: np.full(amplitudes.size, np.nan) for name in quantities}
    for name in BIFURCATIONS:
        if name in values_of_rows:
            values_of_rows[name] = _bifurcation(row, periods, name, table)
    of_orbits = [name for name in quantities if name not in BIFURCATIONS]
    unstable = np.zeros(amplitudes.size, bool)
    obstacle = np.full(amplitudes.size, "", object)
    blocks = np.array_split(np.arange(amplitudes.size), amplitudes.size // BLOCK + 1)
    for block in blocks if of_orbits else []:
        equations = OrbitEquations(row, 1, periods, table=table).rows(block)
        z = rows_of_orbits(equations, amplitudes[block])
        good = np.isfinite(z[:, 0])
        if good.any():
            of_block, at = equations.rows(good), block[good]
            values = _values(of_block, z[good])
            for name in of_orbits:
                values_of_rows[name][at] = values[name]
            if judged:
                linear = of_block.linearized(z[good])
                unstable[at] = ~of_block.stable(linear)
                obstacle[at] = of_block.obstacles(z[good], linear)
    flags = Flags(unstable.reshape(shape), obstacle.astype(str).reshape(shape))
    return {name: values.reshape(shape) for name, values in values_of_rows.items()}, flags


APART = 0.02
"""Difference of r, between the orbit and the free impact, from which they count as different."""


def rows_of_orbits(equations: OrbitEquations, amplitude: NDArray) -> NDArray:
    """Find n-T orbits on the stable side of the saddle-node, shape (rows, N), or NaN."""
    ball, table = equations.ball, equations.table
    periods = np.broadcast_to(equations.periods, amplitude.shape)
    guess = guess_of_instants(ball, periods, amplitude, table=table)
    # If there are several closing speeds, the orbit is that of the free impact.
    speed = np.broadcast_to(free_impact(ball, periods).speed, amplitude.shape)
    r, own = (ball.signature(u).restitution for u in (guess[:, 1], speed))
    if np.any(np.abs(r - own) > APART):
        guess = guess_of_instants(ball, periods, amplitude, table=table, start=speed)
    # At a saddle-node each Newton step only halves the error.
    solution = newton(equations, guess, iterations=30)
    good = solution.converged & (equations.turn(solution.linear) < 1 + AT_FOLD)
    # On compliant contacts Newton's method may find a solution that is not an orbit.
    good &= (
        (equations.ends(solution.z).speed[:, 0] > 0)
        & (solution.z[:, 1] > 0)
        & (np.abs(solution.z - guess)[:, 0] < np.pi)
    )
    return np.where(good[:, np.newaxis], solution.z, np.nan)


def _bifurcation(row: Ball, periods: NDArray, name: str, table: Table) -> NDArray:
    """Find amplitudes of a bifurcation, shape (rows,). The error law gives the guess."""
    impact = free_impact(row, periods)
    if name == "saddle_node":
        kind = "saddle-node"
        x = impact.line - impact.shift
        y = impact.shift * impact.line / table.slope * table(table.steepest, 3)
        amplitude = x / table.slope
        phase = table.steepest - impact.shift
    else:
        kind = "period doubling"
        across, along, share, turn = _doubling_shift(impact, table)
        x = impact.line + across
        y = impact.doubling + along
        amplitude, phase = table.amplitude_at(impact.line, impact.doubling)
        amplitude = amplitude * (1 + share)
        phase = phase + turn
    if table.is_sine:
        # On a sine the velocity x and -w″ = y determine amplitude and phase.
        amplitude, phase = table.amplitude_at(x, y)
    equations = OrbitEquations(row, 1, periods, table=table, kind=kind)
    delay = impact.centroid + row.start(impact.speed) / impact.speed
    speed = impact.half + x - (1 - y) * delay
    # From the release of the actual contact, Newton's method may pass saddle-nodes in circles.
    actual = row.first_release(phase - delay, speed, amplitude, table=table)
    T = row.free(speed) if kind == "saddle-node" else actual
    guess = [phase - delay, speed, T][: equations.unknowns]
    rows = np.stack(np.broadcast_arrays(*guess, amplitude), axis=-1)
    solution = newton(equations, rows, iterations=20)
    amplitude = solution.z[:, -1]
    return np.where(solution.converged & (amplitude > 0), amplitude, np.nan)


def _values(equations: OrbitEquations, z: NDArray) -> dict:
    """Height, velocity, phase and apparent restitution of orbits with one impact, (rows,) each."""
    impacts, _, amplitudes, _ = equations.split(z)
    touch, speed = impacts[:, 0, :2].T
    amplitude = amplitudes[:, 0]
    ends = equations.ends(z)
    leaves = ends.leaves[:, 0]
    table = equations.table
    velocity = ends.speed[:, 0] + amplitude * table(leaves, 1)
    # An instantaneous impact replaces a contact that starts earlier and ends later.
    ball = equations.ball
    before = -ball.start(speed) / speed
    after = ball.signature(speed).duration - before if ball.below_table else 0.0
    approach = amplitude * table(touch, 1) - speed + before
    touch = touch - before
    leaves = leaves + after
    velocity = velocity - after
    speed = amplitude * table(touch, 1) - approach
    return {
        "max_height": equations.max_height(z),
        "bounce_velocity": velocity,
        "phase": touch - table.steepest,
        "apparent_restitution": (velocity - amplitude * table(leaves, 1)) / speed,
    }


def exact_errors(
    ball: Ball,
    *,
    amplitude: ArrayLike,
    n: int = 1,
    simple: Callable[[Ball], Ball] | None = None,
    quantities: Sequence[str] = QUANTITIES,
    table: Table = SINE,
) -> Compared:
    """Use exact orbits to compute the signed errors of a simple model, as in :func:`law_errors`.

    Parameters
    ----------
    ball, amplitude, n, quantities, table
        As in :func:`contact_values`.
    simple : callable, optional
        Function that maps the ball to the ball of the simple model, such as ``Corrected``. The
        default is the restitution model with the r(v) of the ball.

    Returns
    -------
    Compared
        Arrays by the names in ``quantities``. ``unstable`` and ``inadmissible`` name orbits on
        which no ball stays.

    Examples
    --------
    >>> from bouncing_ball_beyond import Corrected, SpringDamper
    >>> ball = SpringDamper(20.0, restitution=0.65)
    >>> error = exact_errors(ball, amplitude=1.0, simple=Corrected, quantities=["max_height"])
    >>> round(float(error["max_height"]), 6)
    -0.000121

    Above the period doubling, unstable orbits are compared:

    >>> str(exact_errors(ball, amplitude=1.6).unstable)
    'in both models'
    """
    errors, flags = _exact_errors(ball, amplitude, n, simple, quantities, table)
    return Compared(errors, *flags)


def _exact_errors(
    ball: Ball,
    amplitude: ArrayLike,
    n: ArrayLike,
    simple: Callable | None,
    quantities: Sequence[str],
    table: Table,
    judged: bool = True,
) -> tuple[dict, tuple[Flags, Flags]]:
    """Return errors, and the flags of the orbits of the simple model and of the contact."""
    if not (simple is None or callable(simple)):
        raise ValueError(f"simple = {brief(simple)}: must map a ball to a ball, such as Corrected")
    judged = judged and not set(quantities) <= BIFURCATIONS
    given = amplitude, n, quantities, table, judged
    exact, of_contact = _contact_values(ball, *given)
    of_simple = NONE
    if simple is not None:
        reference, of_simple = _contact_values(simple(ball), *given)
    else:
        impact = free_impact(ball, n)
        reference = restitution_values(impact, amplitude, table)
        if judged:
            scale = off_rounding(impact, amplitude, table)
            phase, _, push, _ = table.instant(impact.line, scale)
            of_simple = _simple_flags(impact, scale, table, phase, push)
    with np.errstate(invalid="ignore", divide="ignore"):
        scales = {name: reference[name] for name in quantities} | {"phase": 2 * np.pi}
        errors = {name: (exact[name] - reference[name]) / scales[name] for name in quantities}
    return errors, (of_simple, of_contact)


class ErrorThreshold(NamedTuple):
    """Frequency ratios above which an error is within a tolerance, as arrays of the same shape.

    Attributes
    ----------
    ratio : array
        Frequency ratios, NaN unless the status is "found".
    status : array of str
        - "found";
        - "within": the error is within the tolerance at all ratios;
        - "exceeded": the error exceeds the tolerance at the largest ratio;
        - "first orbit": it is within the tolerance from the first ratio with an orbit on;
        - "no orbit": there is no orbit at the largest ratio.
    unstable, inadmissible : array of str
        Which orbit is unstable or followed by no ball, as in :class:`Compared`: at ``ratio``, or at
        the largest ratio if ``ratio`` is NaN.
    """

    ratio: NDArray
    status: NDArray
    unstable: NDArray
    inadmissible: NDArray


def error_thresholds(
    contacts: SpringDamper | ForceLaw | Callable,
    *,
    amplitude: ArrayLike,
    n: ArrayLike = 1,
    tolerance: float = 0.01,
    simple: Callable[[Ball], Ball] | None = None,
    quantities: Sequence[str] = QUANTITIES,
    low: float = 1.0,
    high: float = 1e6,
    samples: int = 49,
    table: Table = SINE,
) -> dict:
    """Find the ϖ above which the error of a simple model is within a tolerance.

    Parameters
    ----------
    contacts : SpringDamper, ForceLaw or callable
        As in :func:`law_thresholds`. A function must accept an array.
    amplitude, n, simple, quantities, table
        As in :func:`exact_errors`.
    tolerance : float
        Largest modulus of the error.
    low, high : float
        Range of ϖ.
    samples : int
        Number of samples in this range. The ratio of neighbouring samples is constant. If the error
        crosses the tolerance twice between neighbouring samples, these crossings are missed.

    Returns
    -------
    dict of ErrorThreshold
        Thresholds by the names in ``quantities``.

    Examples
    --------
    >>> from bouncing_ball_beyond import SpringDamper
    >>> ball = SpringDamper(1.0, restitution=0.65)
    >>> thresholds = error_thresholds(ball, amplitude=1.0, quantities=["max_height", "phase"])
    >>> [f"{threshold.ratio:.3f} {threshold.status}" for threshold in thresholds.values()]
    ['82.177 found', '18.054 found']

    Above the period doubling, unstable orbits are compared:

    >>> threshold = error_thresholds(ball, amplitude=1.6, quantities=["max_height"])["max_height"]
    >>> round(float(threshold.ratio), 2), str(threshold.unstable)
    (75.79, 'in both models')
    """
    if not one_number("low", low) < one_number("high", high):
        raise ValueError(f"low = {low!r}, high = {high!r}: must be positive, and low below high")
    whole_number("samples", samples, 2)
    path = ball_at_ratio(contacts, n, tolerance)
    given = amplitude, n, simple
    shape = rows_of(path(high), amplitude=amplitude)[2]
    grid = np.geomspace(low, high, samples)
    ratios = grid.reshape(-1, *(1 for _ in shape))
    errors, _ = _exact_errors(path(ratios), *given, quantities, table, judged=False)
    # The thresholds of quantities of one orbit are found together. Each bifurcation is found alone.
    alone = [name for name in quantities if name in BIFURCATIONS]
    together = [name for name in quantities if name not in alone]
    thresholds: dict[str, ErrorThreshold] = {}
    for names in filter(None, [together, *([name] for name in alone)]):

        def excess(logarithms: Values, places: Values, names: Any = names) -> Values:
            # `path` gets the ratios of all rows, because it may depend on the index in an array.
            ratio = np.full((len(logarithms), len(names), *shape), float(high))
            rows = ratio.reshape(len(logarithms), -1)
            rows[:, places] = np.exp(logarithms)
            there, _ = _exact_errors(path(ratio), *given, names, table, judged=False)
            error = np.stack([there[name][:, j] for j, name in enumerate(names)], axis=1)
            # The error is nearly proportional to 1/ϖ, so its logarithm is nearly linear in ln ϖ.
            return np.log(np.abs(error.reshape(rows.shape)[:, places]) / tolerance)

        scan = np.stack([np.abs(errors[name]) for name in names], axis=1).reshape(samples, -1)
        beyond = ~(scan <= tolerance)
        last = samples - 1 - beyond[::-1].argmax(axis=0)
        places = np.arange(last.size)
        is_last = last == samples - 1
        no_orbit = np.isnan(scan[last, places])
        cases = [~beyond.any(axis=0), no_orbit & is_last, no_orbit, is_last]
        status = np.select(cases, ["within", "no orbit", "first orbit", "exceeded"], "found")
        places = places[status == "found"]
        ratio = np.full(last.size, np.nan)
        if places.size:
            bracket = np.log(grid[last[places]]), np.log(grid[last[places] + 1])
            at = find_root(
                lambda x, at: excess(x[np.newaxis], at)[0],
                bracket,
                args=(places,),
                tolerances={"fatol": AT_TOLERANCE},
            )
            ratio[places] = np.exp(at.x)
        of_names = ratio.reshape(-1, *shape), status.reshape(-1, *shape)
        for name, ratio, status in zip(names, *of_names, strict=True):
            of_orbit = [name] if name not in alone else []
            there = path(np.where(np.isfinite(ratio), ratio, high))
            _, flags = _exact_errors(there, *given, of_orbit, table)
            thresholds[name] = ErrorThreshold(ratio, status, *_texts(*flags))
    return {name: thresholds[name] for name in quantities}

"""From the bounce that is wanted to the numbers of an engine.

The engine's own scheme is stepped over all instants of the impact within a step
(:mod:`.schemes`), and the damping is found by a secant rule in ln r. Implicit steps, gravity during
the contact and strong damping therefore need no formulas of their own.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from html import escape
from typing import Any

import numpy as np

from bouncing_ball_contacts import units
from bouncing_ball_contacts.engines import (
    Engine,
    Setting,
    engine_named,
    filled,
    text_of,
)
from bouncing_ball_contacts.schemes import (
    MOST_STEPS,
    Array,
    Drops,
    Law,
    OfSolver,
    Solved,
    Trials,
    drop,
    exact,
    nearby,
    offsets,
)
from bouncing_ball_contacts.units import (
    STANDARD_GRAVITY,
    Refused,
    density_of,
    in_si,
    positive,
    show,
    span,
    within,
)

Quantity = Any
"""A number in SI units, a text with a unit, or a pint quantity."""

TOLERANCE = 0.02
"""The default of the largest deviation of r at a step."""
LEAST_RESTITUTION = 0.01
"""The r that stands for less, which lifts no body visibly: r² is 10⁻⁴ of the height."""
WANTED = "what you want"
YOURS = "your step"
IMPULSE = "impulse"

# For the mean r, for the search of a contact, and for what a row shows.
_MEAN = exact(offsets(21))
_COARSE = nearby(3, 21)
_FINE = nearby(9, 201)
# Steps in a contact without damping: first those that most designs need, then finer ones, in groups
# because a group costs as much as its finest one.
_STEPS = (
    np.array([4.0, 5, 6, 8, 10, 12, 14, 17, 20, 25, 32, 40, 50]),
    np.array([65.0, 85, 120]),
    np.array([170.0, 250]),
    np.array([400.0, 600]),
)
_AT_STEP = (
    np.geomspace(2.5, 100, 14),
    np.array([120.0, 150, 190]),
    np.array([240.0, 300, 380]),
    np.array([480.0, 600, 760]),
    np.array([950.0, 1200, 1500]),
)
# A solver with error control is as good as this many steps in a contact.
_CONTROLLED = 1000
# Ratios of damping for an r of about 0.
_STRONG = np.geomspace(0.03, 30.0, 40)
# ln r is found to this error, a tenth of the last printed digit of r.
_LN_R = 1e-4
_DIGITS = 6
# Of what a bounce is given by, in the order in which it is said.
_UNITS = {
    "mass": "kg",
    "restitution": "",
    "drop_height": "m",
    "speed": "m/s",
    "radius": "m",
    "penetration": "m",
    "stiffness": "N/m",
    "contact_time": "s",
    "other_mass": "kg",
    "density": "kg/m^3",
    "friction": "",
    "gravity": "m/s^2",
}
# Of each of these at most one is given.
_ALTERNATIVES = (
    ("drop height", "speed"),
    ("radius", "density"),
    ("penetration", "stiffness", "contact time"),
)


class Page:
    """A result that a notebook shows as it is printed."""

    def _repr_html_(self) -> str:
        return f"<pre>{escape(str(self))}</pre>"


@dataclass(frozen=True)
class Bounce:
    """A bounce that is wanted: a body falls on a surface, or meets another free body.

    Quantities are numbers in SI units, texts with units or pint quantities; they are numbers in SI
    units afterwards.

    Parameters
    ----------
    mass, restitution : Quantity
        The restitution coefficient is √(h′/h) of the drop, 0 to 1.
    drop_height, speed : Quantity, optional
        One of both; by default a drop from 1 m.
    radius, density : Quantity, optional
        Of the body; the density may be the name of a material. By default a solid ball of steel.
    penetration, stiffness, contact_time : Quantity, optional
        At most one of them: the depth that must not be exceeded, or the contact itself. By default
        the penetration is at most a tenth of the radius and a fifth of the drop height.
    points : int
        The number of contact points that share the force, 4 for the face of a box. Without a radius
        a body with several points is a cube.
    other_mass : Quantity, optional
        Of a second free body, in an impact without gravity.
    friction : Quantity, optional
        The coefficient of friction, for the snippet and a word of warning; r is computed without.
    gravity : Quantity
        0 for an impact without gravity, as on a vertical wall; it needs the speed.

    Raises
    ------
    Refused
        If a quantity cannot be read, is out of its range, or contradicts another one.
    """

    mass: Quantity = None
    restitution: Quantity = None
    drop_height: Quantity = None
    speed: Quantity = None
    radius: Quantity = None
    density: Quantity = None
    penetration: Quantity = None
    stiffness: Quantity = None
    contact_time: Quantity = None
    points: int = 1
    other_mass: Quantity = None
    friction: Quantity = None
    gravity: Quantity = STANDARD_GRAVITY
    given: Mapping[str, str] = field(init=False, default_factory=dict, repr=False, hash=False)

    def __post_init__(self) -> None:
        if self.mass is None:
            raise Refused("the mass is missing: --mass '50 g' or mass='50 g'")
        shown: dict[str, str] = {}
        for name, unit in _UNITS.items():
            value = getattr(self, name)
            if value is None:
                continue
            words = name.replace("_", " ")
            if name in ("restitution", "friction"):
                value = within(words, value, 0, 1 if name == "restitution" else math.inf)
            elif name == "density":
                value = density_of(value)
            elif name == "gravity":
                value = in_si(words, value, unit)
            else:
                value = positive(words, value, unit)
            object.__setattr__(self, name, value)
            if name != "gravity" or value != STANDARD_GRAVITY:
                shown[words] = show(value, unit, 4 if unit else 6)
        if self.gravity < 0 or (self.gravity == 0 and self.speed is None):
            raise Refused(
                f"gravity = {show(self.gravity, 'm/s^2')} is not positive; without any, give "
                "the speed, --speed '2 m/s'"
            )
        for names in _ALTERNATIVES:
            given = [name for name in names if name in shown]
            if len(given) > 1:
                raise Refused(f"give either the {given[0]} or the {given[1]}, not both")
        if not (isinstance(self.points, int) and self.points >= 1):
            raise Refused(f"points = {self.points!r} is no whole number from 1 on")
        if self.points > 1:
            shown["points"] = str(self.points)
        if self.penetration is not None and self.penetration > self.size:
            raise Refused(
                f"the penetration of {shown['penetration']} is deeper than the {self.size_name} of "
                f"{show(self.size, 'm')}"
            )
        if self.other_mass is not None and self.speed is None:
            raise Refused(
                "two free bodies need the speed at which they approach each other: --speed '2 m/s'"
            )
        object.__setattr__(self, "given", shown)

    @property
    def reduced_mass(self) -> float:
        """m, or m M/(m + M) of two free bodies, in kg."""
        if self.other_mass is None:
            return float(self.mass)
        return float(self.mass * self.other_mass / (self.mass + self.other_mass))

    @property
    def load(self) -> float:
        """The gravity that acts during the contact in m/s², which is none between free bodies."""
        return 0.0 if self.other_mass is not None else float(self.gravity)

    @property
    def impact_speed(self) -> float:
        """In m/s."""
        if self.speed is not None:
            return float(self.speed)
        height = 1.0 if self.drop_height is None else self.drop_height
        return math.sqrt(2 * self.gravity * height)

    @property
    def size(self) -> float:
        """The radius of the body in m, or half the height of a box; by its density if not given."""
        if self.radius is not None:
            return float(self.radius)
        density = density_of("steel") if self.density is None else self.density
        shape = 4 * math.pi / 3 if self.points == 1 else 8.0
        return float((self.mass / (shape * density)) ** (1 / 3))

    @property
    def size_name(self) -> str:
        """What the size is."""
        return "radius" if self.points == 1 else "half height"

    @property
    def other_size(self) -> float:
        """The size of a second free body of the same density in m, infinite of the ground."""
        if self.other_mass is None:
            return math.inf
        return self.size * float(self.other_mass / self.mass) ** (1 / 3)

    @property
    def reduced_radius(self) -> float:
        """R of a contact of spheres in m."""
        return 1 / (1 / self.size + 1 / self.other_size)

    @property
    def limit(self) -> float:
        """The penetration in m that must not be exceeded."""
        if self.penetration is not None:
            return float(self.penetration)
        if not self.load:
            return self.size / 10
        return min(self.size / 10, self.impact_speed**2 / (10 * self.load))

    @property
    def assumed_body(self) -> list[str]:
        """What was not given of the drop and of the body, in words."""
        found = []
        if self.drop_height is None and self.speed is None:
            found.append("a drop from 1 m (--drop-height or --speed)")
        if self.radius is None:
            of = "steel (give its size or --density)" if self.density is None else "this density"
            body = "ball" if self.points == 1 else "cube"
            found.append(f"a solid {body} of {of}, {self.size_name} {show(self.size, 'm')}")
        return found

    @property
    def assumed(self) -> list[str]:
        """What was not given of a design, in words."""
        found = self.assumed_body
        if (self.penetration, self.stiffness, self.contact_time) == (None, None, None):
            by = f"a tenth of the {self.size_name}"
            if self.limit < self.size / 10:
                by = "a fifth of the drop height"
            found.append(f"it may sink {show(self.limit, 'm')}, {by} (--penetration)")
        return found


@dataclass(frozen=True)
class Outcome:
    """What a contact does in the steps of an engine, over all instants of the impact.

    Pairs are least and greatest values; ``depth`` and ``rest`` are in m, ``force`` in N, and
    ``restitution`` has the least, the mean and the greatest value.
    """

    depth: tuple[float, float]
    rest: float
    force: tuple[float, float]
    restitution: tuple[float, float, float]

    @property
    def error(self) -> float:
        """The largest distance of r from its mean."""
        return self.deviation(self.restitution[1])

    def deviation(self, wanted: float) -> float:
        """Return the largest distance of r from the wanted one."""
        return max(abs(r - wanted) for r in self.restitution)

    @property
    def around(self) -> str:
        """r as it is printed: mean ± largest distance from it, or the range if r reaches 0."""
        low, mean, high = self.restitution
        if self.error > mean:
            return f"{low:.3f} to {high:.3f}"
        return f"{mean:.3f} ± {self.error:.3f}"


@dataclass(frozen=True)
class Row:
    """A contact at a time step.

    ``stiffness`` is k of all points together in N/m (of a Hertz contact in N/m^1.5, NaN of an
    impulse), ``parameters`` are those that are written, and ``step`` is in s.
    """

    step: float
    stiffness: float
    outcome: Outcome
    parameters: dict[str, Any]


@dataclass(frozen=True)
class Problem:
    """A bounce in an engine, for which contacts are tried."""

    bounce: Bounce
    engine: Engine
    one_body: bool = False
    drag: float = 0.0

    @property
    def deepest(self) -> float:
        """The depth in m from which on the engine loses the body, or two bodies change places."""
        of_engine = self.engine.deepest * self.bounce.size
        return min(of_engine, self.bounce.size + self.bounce.other_size)

    @property
    def lost(self) -> str:
        """What happens beyond the deepest depth."""
        deepest = show(self.deepest, "m")
        if self.bounce.other_mass is None:
            return f"{self.engine.name} loses a body that sinks more than {deepest}"
        return f"bodies that sink more than {deepest} pass through each other"

    def miss(self, row: "Row") -> float:
        """Return the largest distance of r from the wanted one."""
        return row.outcome.deviation(self.bounce.restitution)

    def setting(self, step: float) -> Setting:
        """Return where a contact is used at a time step in s."""
        bounce = self.bounce
        points = bounce.points if self.engine.points_share else 1
        both_free = bounce.other_mass is not None
        return Setting(bounce.reduced_mass, step, points, bounce.reduced_radius, both_free)

    def law(self, depth: Array, ratio: Array) -> Law:
        """Return contacts by their undamped depths in m and ratios of damping."""
        return self.engine.of_depth(depth, ratio, self.bounce.impact_speed)

    def drops(self, law: Law, step: Array | float, trials: Trials = _COARSE) -> Drops:
        """Return the drops of contacts at time steps in s."""
        scheme = OfSolver() if isinstance(law, Solved) else self.engine.scheme
        speed = self.bounce.impact_speed
        return drop(law, scheme, step, speed, self.bounce.load, trials, drag=self.drag)

    def outcome(self, law: Law, step: float, trials: Trials = _FINE) -> Outcome:
        """Return what one contact does at a time step in s."""
        # With error control it does not matter where in a step an impact begins.
        found = self.drops(law, step, trials if self.engine.fixed_steps else _COARSE)
        force = self.bounce.reduced_mass * found.peak
        r = found.restitution
        return Outcome(
            depth=(float(found.depth.min()), float(found.depth.max())),
            rest=float(law.rest(self.bounce.load)) if self.bounce.load else 0.0,
            force=(float(force.min()), float(force.max())),
            restitution=(float(r.min()), float(r.mean()), float(r.max())),
        )

    def row(self, law: Law, step: float) -> Row:
        """Return a contact with the parameters as they are written, and what these do."""
        step = _rounded(step)
        combined = {**self.engine.write(law, self.setting(step)), **self.engine.beside}
        of_body = self.engine.of_one if self.one_body else self.engine.of_each
        parameters = {name: _rounded(value) for name, value in of_body(combined).items()}
        stiffness = float(law.stiffness) * self.bounce.reduced_mass
        outcome = self.outcome(self.law_of(parameters, step), step)
        return Row(step, stiffness, outcome, parameters)

    def law_of(self, parameters: Mapping[str, Any], step: float) -> Law:
        """Return the contact of written parameters at a time step in s."""
        one = {**self.engine.defaults, **parameters}
        other = self.engine.defaults if self.one_body else one
        return self.engine.read(self.engine.combined(one, other), self.setting(step))

    def ratios(self, depth: Array, step: Array, start: Array | None = None) -> Array:
        """Return the ratios of damping with which the mean r is the wanted one.

        If r may be 0 within the tolerance, it is the ratio with the least error among many: a
        contact that no body leaves does not depend on where in a step it begins, and too much
        damping throws the body away.
        """
        if self.bounce.restitution > TOLERANCE:
            return self._ratios_of_mean(depth, step, start)
        tried = np.broadcast_to(_STRONG, (*np.shape(depth), len(_STRONG)))
        if self.bounce.restitution >= LEAST_RESTITUTION:
            mean = self._ratios_of_mean(depth, step, start)
            tried = np.concatenate([tried, mean[..., None]], axis=-1)
        law = self.law(np.broadcast_to(depth[..., None], tried.shape), tried)
        steps = np.broadcast_to(step[..., None], tried.shape)
        error = self.drops(law, steps).error(self.bounce.restitution)
        best = np.argmin(error, axis=-1, keepdims=True)
        return np.take_along_axis(tried, best, axis=-1)[..., 0]

    def _ratios_of_mean(self, depth: Array, step: Array, start: Array | None) -> Array:
        """Return the ratios by the secant rule in ln r, which is nearly linear in the ratio.

        It stays within a bracket. Where the steps or gravity alone take more, the ratio is 0.
        """
        goal = math.log(self.bounce.restitution)
        x = np.full(np.shape(depth), 0.05 - goal / 4) if start is None else start
        low = np.zeros(x.shape)
        high = np.full(x.shape, np.inf)
        best = x
        least = np.full(x.shape, np.inf)
        slope = np.full(x.shape, np.nan)
        x_before = x
        y_before = np.full(x.shape, np.nan)
        for _ in range(12):
            r = self.drops(self.law(depth, x), step, _MEAN).mean
            y = np.log(np.maximum(r, 1e-3)) - goal
            best = np.where(np.abs(y) < least, x, best)
            least = np.minimum(np.abs(y), least)
            # An r above the target at ratio 0 means that the damping has to grow from there.
            low = np.where(y > 0, np.maximum(low, x), low)
            high = np.where(y <= 0, np.minimum(high, x), high)
            if np.all((least < _LN_R) | (high < 1e-5)):
                break
            with np.errstate(divide="ignore", invalid="ignore"):
                secant = (y - y_before) / (x - x_before)
            # Without damping r is about 1, which gives the first slope.
            first = np.minimum(y + goal, -1e-2) / np.maximum(x, 1e-6)
            slope = np.where(np.isfinite(slope), slope, first)
            slope = np.where(np.isfinite(secant) & (secant < -1e-2), secant, slope)
            x_before = x
            y_before = y
            guess = x - y / slope
            middle = np.where(np.isfinite(high), (low + high) / 2, 2 * x + 0.1)
            inside = (guess > low) & (guess < np.minimum(high, 4 * x + 0.3))
            x = np.where(inside, guess, middle)
            x = np.where(least < _LN_R, best, x)
        return np.where((low == 0) & (least > _LN_R), 0.0, best)


def _rounded(value: Any) -> Any:
    if isinstance(value, tuple):
        return tuple(_rounded(each) for each in value)
    return float(f"{value:.{_DIGITS}g}")


def design(
    bounce: Bounce,
    engine: str | Engine = "generic",
    time_step: Quantity = None,
    *,
    tolerance: Quantity = TOLERANCE,
    one_body: bool = False,
    pick: str | None = None,
) -> "Design":
    """Return the contacts of an engine with which a body bounces as wanted, and what they do.

    Parameters
    ----------
    bounce : Bounce
    engine : str or Engine
        One of :data:`.ENGINES`, or its name.
    time_step : Quantity, optional
        Of the engine. The second row is the contact that is wanted at this step; if its r is not
        within the tolerance, it is the stiffest contact whose r is.
    tolerance : Quantity
        The largest deviation of r.
    one_body : bool
        Whether the parameters of one body are written, and the other one keeps its defaults.
    pick : str, optional
        The row that is written, by default the one that keeps what was given.

    Raises
    ------
    Refused
        If there is no such contact.
    """
    if not isinstance(bounce, Bounce):
        raise Refused("give a bounce: design(Bounce(mass='50 g', restitution=0.8), 'mujoco')")
    if bounce.restitution is None:
        raise Refused("the restitution is missing: --restitution 0.8 or restitution=0.8")
    row = engine_named(engine)
    problem = Problem(bounce, row, one_body)
    largest = within("tolerance", tolerance, 1e-4, 1)
    step = None if time_step is None else units.time_step(time_step)
    if step is not None and not row.fixed_steps:
        raise Refused(f"{row.name} chooses its steps itself: leave the time step out")
    kept = _undamped_depth(problem)
    rows = {WANTED: _wanted(problem, largest, kept)}
    chosen = WANTED
    keeps = False
    if step is not None:
        # The r of a shorter step is nearer, unless it is about 0.
        if step <= rows[WANTED].step and bounce.restitution > TOLERANCE:
            yours: Row | None = _kept(
                problem, kept or bounce.limit, step, is_fixed=kept is not None
            )
        else:
            yours = _keeping(problem, step, largest, kept)
        keeps = yours is not None
        yours = yours or _at_step(problem, step, largest)
        if yours is not None:
            rows[YOURS] = yours
            keeps = keeps or (not kept and _is_good(problem, yours, largest, bounce.limit))
            if keeps or (bounce.penetration, kept) == (None, None):
                chosen = YOURS
        if bounce.points == 1 and (row.number or yours is None):
            rows[IMPULSE] = _impulse(problem, step)
    if pick is not None:
        chosen = _picked(pick, rows, problem)
    notes = [] if step is None or keeps else _too_long(problem, step, rows, largest, chosen)
    notes += _notes(problem, rows[chosen], largest, chosen == WANTED)
    return Design(
        bounce=bounce,
        engine=row.name,
        one_body=one_body,
        time_step=step,
        rows=rows,
        chosen=chosen,
        notes=tuple(notes),
    )


def _is_good(problem: Problem, row: Row, tolerance: float, limit: float) -> bool:
    """Return whether a row keeps the tolerance and a limit of the penetration in m."""
    return problem.miss(row) <= tolerance and row.outcome.depth[1] <= limit


def _keeping(problem: Problem, step: float, tolerance: float, kept: float | None) -> Row | None:
    """Return the most compliant contact that keeps what was given and the tolerance at a step."""
    depth = kept or problem.bounce.limit
    _, error, _ = _tried(problem, np.array([depth]), step)
    # Damped, the contact becomes more compliant, and its r better.
    if not np.any(error <= 2 * tolerance):
        return None
    row = _kept(problem, depth, step, is_fixed=kept is not None)
    limit = math.inf if kept else depth
    return row if _is_good(problem, row, tolerance, limit) else None


def _picked(pick: str, rows: Mapping[str, Row], problem: Problem) -> str:
    name = pick.strip().lower()
    if name == IMPULSE and not text_of(f"{problem.engine.name}-impulse"):
        raise Refused(f"no impulse is written for {problem.engine.name}: only for pybullet")
    if name not in rows:
        raise Refused(f"row {pick!r} is none of this answer: {', '.join(map(repr, rows))}")
    if name == IMPULSE and problem.one_body:
        raise Refused("pybullet multiplies the restitution of both bodies: one body has none alone")
    return name


def _undamped_depth(problem: Problem) -> float | None:
    """Return the depth in m, without damping, of a contact that is given; None if none is."""
    bounce = problem.bounce
    unit = problem.law(np.asarray(1.0), np.asarray(0.0))
    if bounce.stiffness is not None:
        if problem.engine.unit != "N/m":
            raise Refused(f"{problem.engine.name} has no stiffness in N/m: give the penetration")
        # The stiffness of an undamped depth d is proportional to 1/d².
        return math.sqrt(float(unit.stiffness) * bounce.reduced_mass / bounce.stiffness)
    if bounce.contact_time is not None:
        # A contact lasts a time that is proportional to the depth.
        return float(bounce.contact_time / unit.duration(bounce.impact_speed))
    return None


def _wanted(problem: Problem, tolerance: float, kept: float | None) -> Row:
    """Return the contact that keeps the limit, at the longest step with half of the tolerance."""
    limit = problem.bounce.limit
    if not problem.engine.fixed_steps:
        step = math.pi * (kept or limit) / problem.bounce.impact_speed / _CONTROLLED
        return _kept(problem, kept or limit, step, is_fixed=kept is not None)
    for counts in _STEPS:
        depth = np.full(counts.shape, kept or limit)
        ratio: Array | None = None
        for _ in range(1 if kept else 3):
            step = math.pi * depth / problem.bounce.impact_speed / counts
            ratio = problem.ratios(depth, step, ratio)
            found = problem.drops(problem.law(depth, ratio), step)
            if kept is None:
                depth = depth * 0.998 * limit / found.depth.max(axis=-1)
        good = np.flatnonzero(found.error(problem.bounce.restitution) <= tolerance / 2)
        if good.size:
            break
    best = int(good[0]) if good.size else int(np.argmin(found.error(problem.bounce.restitution)))
    step_of = math.pi * float(depth[best]) / problem.bounce.impact_speed / counts[best]
    return _kept(problem, float(depth[best]), step_of, is_fixed=kept is not None)


def _kept(problem: Problem, depth: float, step: float, *, is_fixed: bool) -> Row:
    """Return the contact at a step that keeps the limit, or that has the depth if it `is_fixed`."""
    limit = problem.bounce.limit
    ratio: Array | None = None
    for _ in range(20):
        ratio = problem.ratios(np.array([depth]), np.array([step]), ratio)
        law = problem.law(np.asarray(depth), ratio[0])
        row = problem.row(law, step)
        sinks = row.outcome.depth[1]
        if is_fixed or 0.99 * limit <= sinks <= limit:
            break
        depth *= 0.998 * limit / sinks
    return row


def _at_step(problem: Problem, step: float, tolerance: float) -> Row | None:
    """Return the stiffest contact within the tolerance at a step in s.

    If none is within the tolerance it is the one with the least error. None if no spring works:
    if all miss r by more than twice the tolerance, or if the body would lie deeper than its radius
    or be lost by the engine.
    """
    per_step = problem.bounce.impact_speed * step / math.pi
    rows = []
    stiffer = None
    for counts in _AT_STEP:
        depth, error, ratio = _tried(problem, counts * per_step, step)
        if not depth.size:
            break
        # The tolerance holds over all trials, and not only over those of the search.
        for i in dict.fromkeys([*np.flatnonzero(error <= tolerance), np.argmin(error)]):
            row = problem.row(problem.law(depth[i], ratio[i]), step)
            rows.append(row)
            if problem.miss(row) <= tolerance:
                before = depth[i - 1] if i else stiffer
                finer = before and _between(problem, before, depth[i], step, tolerance)
                return finer or row
        stiffer = depth[-1]
    nearest = min(rows, key=problem.miss, default=None)
    if nearest is None or problem.miss(nearest) > 2 * tolerance:
        return None
    return nearest


def _between(
    problem: Problem, fails: float, holds: float, step: float, tolerance: float
) -> Row | None:
    """Return the stiffest of some contacts between two depths that is within the tolerance."""
    depth, error, ratio = _tried(problem, np.geomspace(fails, holds, 7)[1:-1], step)
    for i in np.flatnonzero(error <= tolerance):
        row = problem.row(problem.law(depth[i], ratio[i]), step)
        if problem.miss(row) <= tolerance:
            return row
    return None


def _tried(problem: Problem, depth: Array, step: float) -> tuple[Array, Array, Array]:
    """Return those depths that work, with the errors of r and the ratios of damping."""
    steps = np.full(depth.shape, step)
    ratio = problem.ratios(depth, steps)
    law = problem.law(depth, ratio)
    found = problem.drops(law, steps)
    seen = found.depth.max(axis=-1) < problem.deepest
    seen &= law.rest(problem.bounce.load) < problem.bounce.size
    return depth[seen], found.error(problem.bounce.restitution)[seen], ratio[seen]


def _impulse(problem: Problem, step: float) -> Row:
    """Return the restitution by number with which the mean r is the wanted one at a step in s.

    It is the engine's own, or PyBullet's if the engine has none.
    """
    engine = problem.engine if problem.engine.number else engine_named("pybullet")
    own = replace(problem, engine=engine, one_body=False)
    step = _rounded(step)
    law: Any = own.law_of({**engine.undisturbed, engine.number: 0.0}, step)
    numbers = np.linspace(0.0, 1.0, 21)
    mean = own.drops(replace(law, restitution=numbers), step, _MEAN).mean
    best = float(np.interp(problem.bounce.restitution, mean, numbers))
    each = _rounded(engine.rules[engine.number].alike(best))
    parameters = {engine.number: each, **engine.undisturbed}
    return Row(step, math.nan, own.outcome(own.law_of(parameters, step), step), parameters)


def _too_long(
    problem: Problem, step: float, rows: Mapping[str, Row], tolerance: float, chosen: str
) -> list[str]:
    """Return what a step that is too long for the wanted contact costs."""
    bounce = problem.bounce
    wanted = rows[WANTED]
    what = f"at {show(wanted.step, 's')} it sinks {show(wanted.outcome.depth[1], 'm')}"
    way = f"it moves {show(bounce.impact_speed * step, 'm')} in a step"
    if YOURS not in rows:
        depth = f"lies less deep than the {bounce.size_name} of {show(bounce.size, 'm')}"
        if bounce.other_mass is not None:
            depth = f"sinks less than {show(problem.deepest, 'm')}"
        return [
            f"at {show(step, 's')} no spring works in {problem.engine.name}: none keeps r within "
            f"{2 * tolerance:g} and {depth}, because {way}; {what}"
        ]
    sinks = rows[YOURS].outcome.depth[1]
    found = []
    if sinks > bounce.limit:
        how = f"{100 * sinks / bounce.size:.0f} % of its {bounce.size_name}"
        if sinks > bounce.size:
            how = "its centre passes the surface"
        reason = f", because {way}" if bounce.impact_speed * step > bounce.limit else ""
        found.append(f"at your step it sinks {show(sinks, 'm')}, {how}{reason}; {what}")
    if problem.miss(rows[YOURS]) > tolerance:
        found.append(f"at your step no spring has r within {tolerance:g}: the nearest one is shown")
    if bounce.penetration is not None or _undamped_depth(problem) is not None:
        other = YOURS if chosen == WANTED else WANTED
        found.append(
            f"your step of {show(step, 's')} cannot keep what you gave: the row for "
            f"{show(rows[chosen].step, 's')} is written (--pick {other!r} for the other one)"
        )
    return found


def _notes(problem: Problem, row: Row, tolerance: float, is_wanted: bool) -> list[str]:
    """Return what a user of a row has to know."""
    bounce = problem.bounce
    found = []
    law = problem.law_of(row.parameters, row.step)
    low, mean, high = row.outcome.restitution
    # Half of the last printed digit.
    if bounce.restitution < LEAST_RESTITUTION and mean > 5e-4:
        found.append(
            f"r = {bounce.restitution:g}: the damping leaves about {mean:.3f}, by which a body "
            f"rises {mean**2:.1g} of its height"
        )
    elif is_wanted and problem.miss(row) > tolerance:
        found.append(f"r is {span(low, high)}: no damping of this contact is nearer")
    if float(law.damping) == 0 and mean < bounce.restitution - 5e-4:
        found.append(
            f"this contact has no damping, and r is still {mean:.3f} at most, because the steps "
            "damp by themselves: a shorter step has more"
        )
    if high > 1.0005:
        found.append(f"r is up to {high:.3f}: at some instants the body gains energy")
    sinks = row.outcome.depth[1]
    if sinks > problem.deepest:
        found.append(problem.lost)
    elif sinks > bounce.size and (bounce.stiffness or bounce.contact_time):
        found.append(f"it sinks deeper than its {bounce.size_name} of {show(bounce.size, 'm')}")
    if law.duration(bounce.impact_speed) > MOST_STEPS * row.step:
        found.append(
            f"a contact takes more than {MOST_STEPS} of these steps; finer ones than that were "
            "not computed, and change r by less than 0.001"
        )
    if bounce.load:
        slow = replace(bounce, drop_height=None, speed=math.sqrt(0.1) * bounce.impact_speed)
        slower = replace(problem, bounce=slow).outcome(law, row.step)
        if slower.deviation(bounce.restitution) > max(tolerance, 2 * row.outcome.error):
            found.append(f"from a tenth of the height r is {slower.around}")
    if bounce.friction:
        found.append(problem.engine.friction)
        if "@friction@" not in text_of(problem.engine.name):
            found.append(f"a friction of {bounce.friction:g} is not in what is pasted")
    return found


@dataclass(frozen=True, repr=False)
class Design(Page):
    """The contacts that answer a question, by the names of their rows, and the one written.

    Its ``repr`` is the table with its notes; printed it also has the snippet and what was assumed.
    """

    bounce: Bounce
    engine: str
    one_body: bool
    time_step: float | None
    rows: dict[str, Row]
    chosen: str
    notes: tuple[str, ...]

    @property
    def row(self) -> Row:
        """The row that is written."""
        return self.rows[self.chosen]

    @property
    def parameters(self) -> dict[str, Any]:
        """The parameters that are written, by their names in the engine."""
        return self.row.parameters

    @property
    def snippet(self) -> str:
        """What is pasted into the engine."""
        name = self.engine
        if self.chosen == IMPULSE:
            name = f"{name}-impulse"
        elif self.bounce.other_mass is not None and text_of(f"{name}-pair"):
            name = f"{name}-pair"
        values = {
            "step": self.row.step,
            "mass": show(self.bounce.mass, "kg", 4),
            "friction": self.bounce.friction or 0,
            "bodies": "one of both bodies" if self.one_body else "both bodies alike",
            "names": "(one,)" if self.one_body else "(one, other)",
        }
        return filled(text_of(name), values | self.parameters).rstrip()

    @property
    def table(self) -> list[list[str]]:
        """The cells of the table, the headings first."""
        engine = engine_named(self.engine)
        rows = [
            [
                f"{name} *" if name == self.chosen else name,
                show(row.step, "s") if engine.fixed_steps else "–",
                show(row.stiffness, engine.unit),
                show(row.outcome.depth[1], "m"),
                show(row.outcome.rest, "m") if self.bounce.load else "–",
                show(row.outcome.force[1], "N"),
                row.outcome.around,
            ]
            for name, row in self.rows.items()
        ]
        return [["", "step", "k", "sinks", "at rest", "force", "r"], *rows]

    @property
    def remarks(self) -> list[str]:
        """The lines below the snippet: what was given and assumed, and what the engine needs."""
        row = engine_named(self.engine)
        given = dict(self.bounce.given)
        if self.time_step is not None:
            given["time step"] = show(self.time_step, "s", 4)
        # So that a wrong unit is seen.
        lines = [f"Given: {', '.join(f'{name} {value}' for name, value in given.items())}."]
        if self.bounce.assumed:
            lines.append(f"Assumed: {'; '.join(self.bounce.assumed)}.")
        if self.bounce.other_mass is not None:
            reduced = show(self.bounce.reduced_mass, "kg", 4)
            lines.append(f"Two free bodies act as one of the reduced mass {reduced}.")
        if IMPULSE in self.rows:
            how = "PyBullet's, because this engine has none"
            if row.number:
                values = self.rows[IMPULSE].parameters
                how = ", ".join(f"{name} = {value:g}" for name, value in values.items())
                how += f" ({row.rules[row.number].text})"
            if text_of(f"{self.engine}-impulse"):
                how = f"{how}; --pick impulse writes it"
            lines.append(f"The row of the impulse is a restitution by number: {how}.")
        if not row.ran:
            lines.append(f"The row of {row.name} was never run in its engine.")
        lines += [f"{note}." for note in row.notes]
        if row.box and self.bounce.points > 1:
            lines.append(f"{row.box}.")
        if row.floor and self.bounce.other_mass is None:
            lines.append(f"{row.floor}.")
        return lines

    def __repr__(self) -> str:
        return "\n".join([*aligned(self.table), *(f"! {note}" for note in self.notes)])

    def __str__(self) -> str:
        return "\n".join([repr(self), "", self.snippet, "", *self.remarks])


def aligned(table: list[list[str]]) -> list[str]:
    """Return the lines of a table with columns of equal width."""
    widths = [max(map(len, column)) + 2 for column in zip(*table, strict=True)]
    return [
        "".join(cell.ljust(width) for cell, width in zip(line, widths, strict=True)).rstrip()
        for line in table
    ]

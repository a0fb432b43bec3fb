"""Engines whose restitution is a number, and the bounce that they make of it.

Such an engine reverses the velocity of a body within one step, by a rule of its own
(:mod:`.step_rules`), and so r = √(h′/h) is not the number.

r depends on where in a step the ball meets the surface, by about g h/v, the speed that a step h of
gravity adds over that of the impact. It is given as its least, mean and greatest value over all
instants.
"""

import itertools
import math
from bisect import bisect_left
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import islice
from typing import Any, NamedTuple

import numpy as np

from bouncing_ball_contacts.answers import TOLERANCE, Answer, Outcome, Range
from bouncing_ball_contacts.bounces import Bounce, Quantity
from bouncing_ball_contacts.engines import (
    LARGER,
    MEAN,
    MODES,
    OF_PAIR,
    PAIR,
    PIXELS,
    ByNumber,
    Rule,
    as_compared,
    one_of,
    parameters_of,
    ran_in,
)
from bouncing_ball_contacts.rows import BY_NUMBER, ENGINES
from bouncing_ball_contacts.schemes import Array
from bouncing_ball_contacts.step_rules import Fall, Steps
from bouncing_ball_contacts.units import (
    LONGEST_STEP,
    Refused,
    holding,
    in_si,
    positive,
    refuse,
    show,
    step_in_si,
    within,
)

SETTLED = 1.1
"""Thresholds over the least with which a body comes to rest: near it, that takes many bounces."""
INSTANTS = 24
"""Of the impact within a step, in a search; a sixth of them if gravity hardly acts in a step."""
SHORTEST_STEP = 1e-4
"""Step in s below which no other step is tried: at shorter ones an answer takes minutes, and few
users run so many steps."""
MOST_INSTANTS = 192
"""Of the impact within a step, in an answer."""
# Steps without a move after which a ball has come to rest: no rebound takes so long to begin.
_LYING = 50


def _flight(engine: ByNumber, at: Fall, v: Array, steps: float) -> tuple[Array, Array]:
    """Return heights above the start, and velocities, after the steps of free flights."""
    n = np.arange(math.ceil(steps) + 10)
    if engine.free is None or not at.settings["linearDamping"]:
        # A step far above the surface.
        pull = -next(engine.rule(at, 1e6, 0.0))[1]
        left = at.keeps**n
        speeds = left * v - pull * (n if at.keeps == 1 else (1 - left) / (1 - at.keeps))
    else:
        free = engine.free
        velocities = itertools.accumulate(n[1:], lambda u, _: free(at, u), initial=v)
        speeds = np.concatenate(list(velocities), axis=-1)
    moves = speeds + (1 - engine.sinks) * at.added
    return at.step * (np.cumsum(moves, axis=-1) - moves[..., :1]), speeds


def _after(steps: Steps, z: float, way: float, reach: float = 0.0) -> tuple[float, float]:
    """Return height and velocity of a ball that flies up again above `reach`; 0 if it stays.

    It stays if it moves by less than 1e-4 of the `way` of the impact in a step, many times in a
    row.
    """
    rises = False
    lies = 0
    for z_next, v in steps:
        if rises and z_next < z:
            return z, 0.0
        rises |= z_next > z
        lies = lies + 1 if abs(z_next - z) < 1e-4 * way else 0
        if lies == _LYING:
            break
        z = z_next
        if v > 0 and z > reach and rises:
            return z, v
    # It lies still, or is pushed out slowly.
    return 0.0, 0.0


def _rebounds(engine: ByNumber, at: Fall, z: Array, v: Array, speed: float) -> tuple[Array, Array]:
    """Return heights and velocities of balls that fly up again, from those of their falls."""
    way = speed * at.step
    reach = _reach(engine, at)
    most = 2000 + math.ceil(6 * (reach + 4 * way) / way)
    after = [
        _after(islice(engine.rule(at, *start), most), start[0], way, reach)
        for start in zip(z.tolist(), v.tolist(), strict=True)
    ]
    z, v = np.array(after).T
    return z, v


def _reach(engine: ByNumber, at: Fall) -> float:
    """Return the height in m below which a contact may be found."""
    # PyBullet finds large balls farther ahead.
    return max(engine.reach, at.settings.get("ahead", 0.0))


def drops(engine: ByNumber, at: Fall, heights: Array, starts: Array) -> Array:
    """Return √(h′/h) of drops from heights in m above the floor.

    A drop starts after a share of a step, for which it has fallen already.

    >>> at = Fall(number=0.8, step=1 / 60, gravity=9.81, threshold=1.0, radius=0.1)
    >>> drops(BY_NUMBER["jolt"], at, np.array([0.1, 0.1]), np.array([0.0, 0.5])).round(2)
    array([0.82, 0.84])
    """
    speed = math.sqrt(2 * at.gravity * heights.mean())
    # As far as a ball falls in a number of steps.
    z = heights - at.added * at.step * starts * ((starts - 1) / 2 + engine.sinks)
    v = -at.added * starts
    # Down to where a contact may be found the ball flies freely, longer if it is damped.
    near = _reach(engine, at) + 4 * speed * at.step
    ways, speeds = _flight(engine, at, v[:, None], 2 * speed / at.added)
    n = np.argmax(ways < near - z[:, None], axis=1) - 1 - engine.remembers
    last_step = np.arange(len(n)), np.maximum(n, 0)
    z, v = _rebounds(engine, at, z + ways[last_step], speeds[last_step], speed)
    # And so it flies up to its top.
    ways, _ = _flight(engine, at, v[:, None], v.max() / at.added)
    return np.sqrt(np.maximum(z + ways.max(axis=1), 0.0) / heights)


def restitutions(engine: ByNumber, at: Fall, speed: float, instants: int | None = None) -> Array:
    """Return √(h′/h) of impacts with a speed in m/s, at instants within a step.

    A fall meets the surface at another instant from another height, or if it starts at another one.
    Without gravity r is the ratio of the speeds.
    """
    way = speed * at.step
    # Within a step r changes by about g h/v.
    is_short = 0 < at.added < 1e-3 * speed
    instants = instants or (INSTANTS // 6 if is_short else INSTANTS)
    height = speed**2 / (2 * at.gravity) if at.gravity else math.inf
    refuse(
        [
            (
                not 1e-6 < way < 1e3,
                f"a ball with {show(speed, 'm/s')} moves {show(way, 'm')} in a step of "
                f"{show(at.step, 's')}: between 1 µm and 1 km are computed",
            ),
            (
                height <= engine.skin,
                f"a drop from {show(height, 'm')} ends in the skin of {show(engine.skin, 'm')}: "
                "give a greater height",
            ),
            (
                height <= way / 2 + engine.skin,
                f"a step of {show(at.step, 's')} is longer than the fall: give a shorter one, or a "
                "greater height",
            ),
        ]
    )
    places = np.arange(instants) / instants
    if not at.gravity:
        z = _reach(engine, at) + way * (places + 0.5)
        return _rebounds(engine, at, z, np.full(instants, -speed), speed)[1] / speed
    half = places[::2]
    of_heights = drops(engine, at, height + way * (half - 0.5), 0 * half)
    return np.concatenate([of_heights, drops(engine, at, np.full(len(half), height), half)])


def _number(value: float) -> str:
    """Return a number with a decimal point, as C++ wants before an f, or with a power of ten."""
    return f"{value:g}" if value >= 1e6 else str(float(value))


def _snippet(case: "Case", number: float) -> str:
    """Return the lines to paste: the number, the step, and settings that differ from defaults."""
    row = case.engine
    own = BY_NUMBER[row.name]
    alike = "one of both bodies" if row.pair is LARGER else "both bodies"
    one = f"one body, with {case.other or 0:g} of the other one"
    bodies = alike if case.other is None else one
    changed = {name: value for name, value in case.settings.items() if value != own.settings[name]}
    if case.threshold != row.threshold or not row.has_defaults:
        changed[row.set_by] = float(f"{case.threshold / row.unit:.2g}")
    gravity = case.bounce.gravity * row.pixels
    if row.pixels and not math.isclose(gravity, PIXELS):
        changed["gravity"] = float(f"{gravity / 1e6:.6g}")
    rate = 1 / case.step
    values = {row.parameter: float(f"{number:.4g}"), **changed, "step": float(f"{case.step:.6g}")}
    # In the order of the lines.
    return "\n".join(
        line.format(name=name, value=_number(values[name]), bodies=bodies, rate=f"{rate:.6g}")
        for name, line in row.lines.items()
        if name in values
    )


class Case(NamedTuple):
    """Ball in an engine.

    Attributes
    ----------
    engine, bounce, step
        Rule, bounce, and time step in s.
    threshold, settings
        Threshold in m/s, and the other parameters that change r.
    other
        Number of the other body; None if both bodies have the same number.
    """

    engine: ByNumber
    bounce: Bounce
    step: float
    threshold: float
    settings: Mapping[str, float]
    other: float | None = None

    @property
    def is_own_scale(self) -> bool:
        """Whether the gravity of the engine sets how many pixels a metre has."""
        return self.engine.pixels == BY_NUMBER[self.engine.name].scaled(self.bounce.gravity).pixels

    @property
    def speed(self) -> float:
        """Speed in m/s at which the ball touches, above the floor if there is a skin."""
        bounce = self.bounce
        return math.sqrt(max(bounce.impact_speed**2 - 2 * bounce.gravity * self.engine.skin, 0.0))

    def number(self, written: float) -> float:
        """Return the combined number of both bodies."""
        return self.engine.pair.of(written, written if self.other is None else self.other)

    def settling(self, written: float) -> float:
        """Return the threshold in m/s above which every body comes to rest; 0 if each one does."""
        row = self.engine
        is_restless = row.is_restless and not self.settings.get(row.calmed_by)
        return is_restless * self.bounce.gravity * self.step / max(1 - self.number(written), 1e-9)

    def restitutions(self, written: float, speed: float, instants: int | None = None) -> Array:
        """Return r of impacts with a speed in m/s, at instants within a step."""
        row = self.engine
        bounce = self.bounce
        settings = {**self.settings, "pixels": row.pixels}
        if row.free and not bounce.gravity:
            settings["linearDamping"] = 0.0
        if row.ahead:
            settings["ahead"] = row.ahead(settings, bounce.size, bounce.points)
        at = Fall(
            number=self.number(written),
            step=self.step,
            gravity=bounce.gravity,
            threshold=self.threshold,
            radius=bounce.size,
            keeps=row.kept(settings.get(row.damped_by, 0.0), self.step),
            mass=bounce.mass or 1.0,
            settings=settings,
        )
        falls = [replace(at, settings={**settings, **variant}) for variant in row.either]
        return np.concatenate([restitutions(row, fall, speed, instants) for fall in falls])

    def slower(self, written: float) -> Range:
        """Return r at a third of the speed; NaN if the step is too long for it."""
        try:
            return Range.of(self.restitutions(written, self.bounce.impact_speed / 3))
        except Refused:
            return Range(math.nan, math.nan, math.nan)

    def tried(self, written: float) -> "Tried":
        """Return a number with the range of its r."""
        speed = self.bounce.impact_speed
        return Tried(self, written, Range.of(self.restitutions(written, speed, MOST_INSTANTS)))

    def nearest(self) -> "Tried":
        """Return the number whose mean r is nearest to the wanted one, by bisection."""
        speed = self.bounce.impact_speed
        if self.restitutions(1.0, speed).mean() < self.bounce.restitution:
            return self.tried(1.0)
        place = bisect_left(
            range(10_000),
            self.bounce.restitution,
            key=lambda place: self.restitutions(place / 10_000, speed).mean(),
        )
        return self.tried(place / 10_000)

    def with_threshold(self) -> "Tried":
        """Return the nearest number, with another threshold if r needs it.

        Lower the threshold to a quarter of the speed, or raise it until the ball comes to rest.
        """
        best = self.nearest()
        row = self.engine
        speed = self.speed
        if row.is_constant or not row.set_by:
            return best
        if best.deviation > TOLERANCE and speed < 1.5 * self.threshold:
            lower = self._replace(threshold=float(f"{speed / 4:.2g}"))
            best = min(best, lower.nearest(), key=Tried.rank)
        settled = SETTLED * best.case.settling(best.number)
        if best.case.threshold < settled < 0.9 * speed:
            best = best.case._replace(threshold=float(f"{settled:.2g}")).nearest()
        return best

    def wanted(self) -> "Tried":
        """Return the number that keeps r, with other settings if r needs them."""
        best = self.with_threshold()
        for designed in self.engine.designed:
            other = self._replace(settings={**self.settings, **designed})
            if best.deviation > TOLERANCE and other != self:
                best = min(best, other.with_threshold(), key=Tried.rank)
        return best


class Tried(NamedTuple):
    """Number in a case, and the range of r that it gives."""

    case: Case
    number: float
    restitution: Range

    @property
    def deviation(self) -> float:
        """Largest distance of r from the wanted one."""
        return self.restitution.deviation(self.case.bounce.restitution)

    @property
    def has_mean(self) -> bool:
        """Whether the mean of r is the wanted one."""
        return abs(self.restitution.mean - self.case.bounce.restitution) <= TOLERANCE

    def rank(self) -> tuple[bool, float]:
        """Order of numbers: first those with the wanted mean, and then those nearer to it."""
        return not self.has_mean, self.deviation

    @property
    def does_it(self) -> bool:
        """Whether the mean of r is the wanted one, and the ball bounces at every instant."""
        return self.has_mean and self.restitution.low >= self.case.bounce.restitution / 2

    def answer(self) -> Answer:
        """Return the answer for the number."""
        case, number, r = self
        row = case.engine
        bounce = case.bounce
        settings = {
            name: value
            for name, value in case.settings.items()
            if value != BY_NUMBER[row.name].settings[name]
        }
        if case.threshold != row.threshold:
            settings[row.set_by] = case.threshold / row.unit
        phrases = [f" and {name} = {value:.2g}" for name, value in settings.items()]
        named = "".join(phrases) if len(phrases) < 3 else f" with {len(phrases)} settings"
        step = show(case.step, "s")
        return Answer(
            engine=row.name,
            ran=ran_in(row),
            bounce=bounce,
            time_step=case.step,
            parameters={row.parameter: number, **settings},
            outcome=Outcome(r),
            snippet=_snippet(case, number),
            warnings=tuple(_warnings(case, number, r)),
            not_for=row.not_for,
            remarks=tuple(_remarks(case, number, r)),
            gives=f"{row.parameter} = {number:.4g}{named} at {step} gives r = {r}",
            numbers={"number": case.number(number), "threshold": case.threshold},
        )


def _warnings(case: Case, written: float, r: Range) -> list[str]:
    """Return what changes r, the severest first."""
    row = case.engine
    bounce = case.bounce
    speed = case.speed
    number = case.number(written)
    slower = case.slower(written)
    slowest = case.threshold / (max(number, 1e-9) if row.is_of_rebound else 1.0)
    is_slow = 0 < speed <= slowest
    lowest = slowest**2 / (2 * bounce.gravity) + row.skin if bounce.gravity else 0.0
    slow = f"drops under {show(lowest, 'm')}" if lowest else f"impacts below {show(slowest, 'm/s')}"
    way = speed * case.step
    settling = case.settling(written)
    hops = bounce.gravity and 0 < number < 1 and slowest < settling
    height = settling**2 / (2 * bounce.gravity) if hops else 0.0
    rests = (
        f"below a step of {show(case.step * slowest / settling, 's')}"
        if hops and row.is_constant
        else f"above a threshold of {show(settling, 'm/s')}"
    )
    limit = row.limit(case.threshold)
    return holding(
        [
            (row.ignored_by, f"{row.ignored_by} ignores this number"),
            (
                number == 0 < written,
                f"nothing bounces: the other body has {case.other or 0:g}, and the numbers are "
                f"{row.pair.text}",
            ),
            (
                number > 0 and is_slow and r.high < 0.1,
                f"it does not bounce: {show(speed, 'm/s')} is not above the threshold of "
                f"{limit}{'; it is a constant: no number helps' * row.is_constant}",
            ),
            (
                r.low < 0.1 <= r.high and r.low < r.mean / 2 and speed < 2 * slowest,
                f"at some instants it does not bounce: {show(speed, 'm/s')} is near the threshold "
                f"of {limit}",
            ),
            *((True, said) for said in _by_assumptions(case, written, r)),
            (r.high >= 1.0005, f"at some instants the ball gains energy: r is up to {r.high:.3f}"),
            (
                speed / 3 > slowest and abs(slower.mean - r.mean) > TOLERANCE / 2,
                f"at a third of the speed r is {slower}",
            ),
            (
                hops,
                f"it may hop for ever, by about {show(height, 'm', 2)}: {rests} it comes to rest",
            ),
            (
                number > 0 and not is_slow and slowest > 0,
                f"{slow} do not bounce: threshold {limit}",
            ),
            (
                way > bounce.size,
                f"it moves {show(way, 'm')} in a step, farther than its radius: it may pass a thin "
                "table",
            ),
        ]
    )


def _by_assumptions(case: Case, written: float, r: Range) -> Iterator[str]:
    """Yield what was assumed, and r with another value if that is outside of the range."""
    row = case.engine
    bounce = case.bounce
    smaller = replace(bounce, radius=bounce.size / 5)
    light = replace(bounce, mass=0.05, radius=bounce.size)
    fewer = replace(row.scaled(bounce.gravity, row.pixels / 6), pair=row.pair)
    others = [
        (
            row.pixels and case.is_own_scale,
            f"{row.pixels:.3g} pixels per metre; with {fewer.pixels:.3g}",
            case._replace(engine=fewer, threshold=6 * case.threshold),
        ),
        (
            bounce.radius is bounce.density is None,
            f"a radius of {show(bounce.size, 'm')}; with {show(smaller.size, 'm')}",
            case._replace(bounce=smaller),
        ),
        (
            row.depends_on_mass and bounce.mass is None,
            "a mass of 1 kg; with 50 g",
            case._replace(bounce=light),
        ),
    ]
    for is_assumed, assumed, other in others:
        r_other = Range.of(other.restitutions(written, bounce.impact_speed)) if is_assumed else r
        if max(r.low - r_other.low, r_other.high - r.high) > TOLERANCE / 2:
            yield f"r is for {assumed} it is {r_other}"


def _remarks(case: Case, written: float, r: Range) -> list[str]:
    """Return remarks, what was given, and what was assumed."""
    row = case.engine
    bounce = case.bounce
    damping = case.settings.get(row.damped_by, 0.0)
    given = [f"{name} {value}" for name, value in bounce.given.items()]
    pixels = f"a metre of {row.pixels:.3g} pixels (--pixels, or pixels=… in a diagnosis)"
    given += holding([(not case.is_own_scale, f"{row.pixels:g} pixels in a metre")])
    weighs = row.depends_on_mass and bounce.mass is None
    others = [(weighs, "a mass of 1 kg (--mass)"), (row.pixels and case.is_own_scale, pixels)]
    assumed = bounce.assumed + holding(others)
    defaults = {
        name: value
        for name, value in case.settings.items()
        if value == BY_NUMBER[row.name].settings[name] and name != row.damped_by
    }
    defaulted = ", ".join(f"{name} = {value:g}" for name, value in defaults.items())
    bodies = "alike" if case.other is None else f"and {case.other:g} of the other body"
    # Share of the drop that is within the skin.
    skin = 2 * bounce.gravity * row.skin / bounce.impact_speed**2
    of_skin = Range(*(math.sqrt(max(restitution**2 - skin, 0.0) / (1 - skin)) for restitution in r))
    return holding(
        [
            (
                damping and bounce.gravity,
                f"The flights are damped by {row.damped_by} = {damping:g}, which lowers r: it "
                "holds for this height only",
            ),
            (
                skin,
                f"A ball lies up to {show(row.skin, 'm')} above a polygon, and a polygon up to "
                f"{show(2 * row.skin, 'm')} above another one: from there r is "
                f"{of_skin}",
            ),
            *((True, note) for note in row.notes),
            (
                True,
                f"The numbers of both bodies, {bodies}, are combined: {row.pair.text}; together "
                f"{case.number(written):.4g}",
            ),
            (True, f"r is √(h′/h) over all instants within a step, by the rule of {row.ran}"),
            (
                bounce.friction is not None,
                "Friction acts along the surface only: r is computed without it, and it is not in "
                "what is pasted",
            ),
            (given, f"Given: {', '.join(given)}"),
            (assumed, f"Assumed: {'; '.join(assumed)}"),
            (defaulted, f"The defaults: {defaulted}"),
        ]
    )


def _causes(case: Case, written: float, r: float) -> Iterator[str]:
    """Yield the settings that change r visibly: set one after the other as designs do."""
    designed = case.engine.designed[-1] if case.engine.designed else {}
    for name, value in designed.items():
        was = case.settings[name]
        case = case._replace(settings={**case.settings, name: value})
        less = case.tried(written).restitution.mean
        if abs(r - less) > TOLERANCE / 2:
            how = "lowers" if r < less else "raises"
            yield f"{name} = {was:g} {how} r from {less:.3f} to {r:.3f}; {value:g} if r needs it"
        r = less


def _refuse_ignored(bounce: Bounce, engine: ByNumber, is_other: bool = False) -> None:
    """Refuse quantities of springs, and another body of an engine that has one number of both."""
    springs = ("penetration", "stiffness", "contact_time")
    place = f"has no place in {engine.name}, where the restitution is a number"
    refuse(
        [
            *(
                (getattr(bounce, name) is not None, f"--{name.replace('_', '-')} {place}")
                for name in springs
            ),
            # Boxes were run where the engine has springs as well.
            (bounce.points != 1 and not engine.springs, f"--points {place}: a ball is dropped"),
            (is_other and engine.pair is PAIR, f"{engine.name} {OF_PAIR}"),
        ]
    )


def design_number(
    bounce: Bounce, engine: ByNumber, time_step: Quantity, pixels: Quantity = None
) -> Answer:
    """Return the restitution number with which a ball bounces as wanted, for both bodies alike.

    Raises
    ------
    Refused
        If the step is missing, or no number bounces.
    """
    _refuse_ignored(bounce, engine)
    scale = None if pixels is None else positive("pixels", pixels, "")
    engine = engine.scaled(bounce.gravity, scale)
    is_free = time_step is None and not engine.own_step and bool(engine.springs)
    if is_free:
        # The body moves by less than it may sink, and gravity adds less than the tolerance.
        speed = bounce.impact_speed
        slow = TOLERANCE * speed / bounce.gravity if bounce.gravity else math.inf
        asked = float(f"{min(0.9 * bounce.limit / speed, slow, LONGEST_STEP):.3g}")
    else:
        asked = _step(time_step, engine)
    step = asked
    # A body that moves farther than its radius passes a table.
    while engine.springs and bounce.impact_speed * step > bounce.size:
        step /= 2
    case = Case(engine, bounce, step, engine.threshold, engine.settings)
    best = case.wanted()
    also = _other_step(best)
    if is_free and also:
        # No step was asked for.
        return also[0]
    answer = best.answer()
    way = show(bounce.impact_speed * asked, "m")
    far = f"at {show(asked, 's', 4)} it moves {way} in a step, farther than its radius"
    warnings = (*answer.warnings, *holding([(step != asked, far)]))
    answer = replace(answer, asked_step=asked, warnings=warnings, also=also)
    if best.does_it:
        return answer
    nothing = f"at {show(step, 's')} no number gives this r"
    rises = (bounce.restitution * bounce.impact_speed) ** 2 < 2 * bounce.gravity * engine.skin
    nothing += f", because a ball rises to the skin of {show(engine.skin, 'm')}" * rises
    nothing += "" if also else ": nothing is written to paste"
    return replace(answer, snippet="", parameters={}, warnings=(nothing, *warnings))


def _other_step(tried: Tried) -> tuple[Answer, ...]:
    """Return the answer at another step that keeps r, if this one does not.

    It is a half, a quarter, … of the step, or else 2, 4, … times a step below 1 ms. The search ends
    if the mean of r is right, and two steps in succession leave its range as it is.
    """
    if tried.deviation <= TOLERANCE:
        return ()
    asked = tried.case.step
    shorter = [asked / 2**n for n in range(1, 8) if asked / 2**n >= SHORTEST_STEP]
    longer = [asked * 2**n for n in range(1, 5) if asked * 2**n <= 1e-3]
    deviations = [tried.deviation] if tried.has_mean else []
    for step in (*shorter, *longer):
        case = tried.case._replace(step=step)
        # The range of r hardly depends on the number: no search where it is too wide.
        half = np.ptp(case.restitutions(tried.number, case.bounce.impact_speed)) / 2
        if half > 1.5 * TOLERANCE:
            deviations.append(half)
        else:
            best = case.wanted()
            if best.deviation <= TOLERANCE:
                return (best.answer(),)
            if best.has_mean:
                deviations.append(best.deviation)
        if len(deviations) > 2 and deviations[-1] >= 0.95 * min(deviations[-3:-1]):
            break
    return ()


def diagnose_number(
    bounce: Bounce,
    engine: ByNumber,
    parameters: Mapping[str, Any],
    time_step: Quantity,
    other: Mapping[str, Any] | None = None,
) -> Answer:
    """Return the bounce that a restitution number gives, and the least change for the one wanted.

    Parameters
    ----------
    bounce : Bounce
        Its restitution is the one that is wanted, and may be left out.
    engine : ByNumber
    parameters : mapping
        The number by its name in the engine or as "restitution", and the threshold by its name or
        as "threshold", if it can be set.
    time_step : Quantity
    other : mapping, optional
        The number of the other body, by default that of the engine; without it both are alike.

    Raises
    ------
    Refused
        If a parameter or the step is missing, unknown or out of its range.
    """
    _refuse_ignored(bounce, engine, other is not None)
    given = _given(engine, parameters)
    differs = _given(engine, other or {}, is_other=True)
    step = _step(time_step, engine)
    if "number" not in given and not engine.springs:
        raise Refused(f"{engine.parameter} is missing: give {engine.parameter}=0.8")
    engine = replace(
        engine.scaled(bounce.gravity, given.get("pixels")),
        pair=_later(engine, [given, differs]),
    )
    if "threshold in pixels" in given:
        given["threshold"] = engine.unit * given["threshold in pixels"]
    settings = {name: given.get(name, value) for name, value in engine.settings.items()}
    case = Case(
        engine=engine,
        bounce=bounce,
        step=step,
        threshold=given.get("threshold", engine.threshold),
        settings=settings,
        other=None if other is None else differs.get("number", engine.default),
    )
    number = given.get("number", engine.default)
    if case.number(number) < 0:
        raise Refused(
            f"{engine.name}: a negative {engine.parameter} needs a positive one of the other body "
            f"(--other): {engine.pair.text}"
        )
    answer = case.tried(number).answer()
    causes = tuple(_causes(case, number, answer.outcome.restitution.mean))
    # Nothing is to be pasted of what is given.
    answer = replace(answer, snippet="", not_for=(), warnings=causes + answer.warnings)
    if answer.is_kept:
        return answer
    best = case.wanted()
    if other is not None and best.deviation > TOLERANCE:
        # The number of one body may not be enough.
        tried = best, case._replace(other=None).wanted()
        best = min(tried, key=Tried.rank)
    # What is given already is no change, nor is what does not do it.
    is_change = (best.case, best.number) != (case, given.get("number")) and best.does_it
    change = best.answer() if is_change else None
    if change and best.case.other is None and other is not None:
        change = replace(change, gives=f"{change.gives} (of both bodies)")
    beyond = (f"no number keeps r within {TOLERANCE:g} at this step",)
    warnings = answer.warnings + beyond * (best.deviation > TOLERANCE)
    return replace(answer, change=change, warnings=warnings, also=_other_step(best))


def _later(engine: ByNumber, bodies: Sequence[Mapping[str, Any]]) -> Rule:
    """Return how numbers are combined; for PhysX the later mode of both materials."""
    if not engine.is_physx:
        return engine.pair
    return max((body.get("combine", MEAN) for body in bodies), key=list(MODES.values()).index)


def _step(time_step: Quantity, engine: ByNumber) -> float:
    """Return the time step in s, by default that of the engine."""
    if time_step is None and not engine.own_step:
        raise Refused("the time step is missing: --time-step 1/60 or time_step='2 ms'")
    return engine.own_step if time_step is None else step_in_si(time_step)


_READ: Mapping[str, Callable[[str, Any], Any]] = {
    "threshold": lambda name, value: within(name, in_si(name, value, "m/s"), 0, math.inf),
    "pixels": lambda name, value: positive(name, value, ""),
    "combine": lambda name, value: MODES[one_of(name, value, MODES)],
    "contactEquationRelaxation": lambda name, value: positive(name, value, ""),
    "contactEquationStiffness": lambda name, value: positive(name, value, "N/m"),
    "soft_cfm": lambda name, value: positive(name, value, "m/N/s"),
    "kp": lambda name, value: positive(name, value, "N/m"),
    **{
        name: lambda name, value: abs(in_si(name, value, "m"))
        for name in ("contactSlop", "contactProcessingThreshold")
    },
}
"""How a number that is typed is read; others are not negative."""


def _given(engine: ByNumber, typed: Mapping[str, Any], is_other: bool = False) -> dict[str, Any]:
    """Return what was typed: the number, the threshold, settings, and how numbers are combined.

    The other body has the number and how it is combined; all else is of the pair or of the world.
    """
    known = {
        name: what
        for name, what in engine.names.items()
        if not is_other or what in ("number", "combine")
    }
    row = ENGINES.get(engine.springs)
    parameters = parameters_of(
        engine.name + is_other * ", the other body",
        known,
        [
            name
            for name in (engine.parameter, engine.set_by, "combine", *engine.settings)
            if as_compared(name) in known
        ],
        typed,
        [
            name
            for name in ((*row.rules, *row.spring) if row and not is_other else ())
            if as_compared(name) not in known
        ],
    )
    read = {"number": lambda name, value: within(name, value, engine.lowest, 1), **_READ}
    return {
        what: read.get(what, lambda name, value: within(name, value, 0, math.inf))(
            engine.parameter if what == "number" else what, value
        )
        for what, value in parameters.items()
    }

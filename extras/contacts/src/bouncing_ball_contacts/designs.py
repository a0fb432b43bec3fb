"""From the bounce that is wanted to the stiffness and damping of an engine.

A contact is known by its undamped depth δ, to which it sinks without damping and gravity, and by a
ratio of damping (:mod:`.schemes`). Without damping it lasts T ∝ δ/v, and a step h makes n = T/h
steps of it. Two of δ, h and n are given in each question, and the third follows:

* *Short step.* δ keeps a permitted depth, or is that of a given stiffness or contact time; n is the
  least number of steps with which r is within half of the tolerance. If none is, the weight
  matters, which goes as g δ/v², and δ keeps a sixteenth of that depth.
* *Your step.* δ is the same, and h is yours. If r leaves the tolerance, h is yours, and n is the
  least one, which is the stiffest contact, with which r does not.
* *A step between.* If the body sinks too deep at your step, it is the longest of its half, its
  quarter, … at which the stiffest contact sinks no deeper than the size of the body allows.

The ratio of damping is always the one with which the mean r is the wanted one. It is read from a
scan: the engine's own scheme is stepped for many ratios at once, over all instants of the impact
within a step. Implicit steps, gravity and strong damping therefore need no formulas of their own.
"""

import functools
import math
from bisect import bisect_left
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from bouncing_ball_contacts.answers import TOLERANCE, Answer, Outcome, Range
from bouncing_ball_contacts.bounces import Bounce, Quantity
from bouncing_ball_contacts.engines import (
    Engine,
    Parameters,
    Setting,
    ran_in,
    snippet_of,
)
from bouncing_ball_contacts.schemes import (
    Array,
    Drops,
    Impedance,
    Implicit,
    Law,
    Trials,
    drop,
    nearby,
)
from bouncing_ball_contacts.units import LONGEST_STEP, Refused, holding, refuse, show, span

LEAST_RESTITUTION = 0.01
"""Below it a damping, and what it makes of a depth, hardly depend on r."""

# Steps in a contact: of those that choose the step, and of those that choose the stiffness.
_COUNTS = (2.5, 4, 6, 8, 10, 13, 17, 20, 25, 32, 40, 50, 65, 85, 120, 170, 250)
_FINE_COUNTS = tuple(np.geomspace(2.5, 250, 98))
_BESIDE = np.linspace(0.65, 1.5, 17)
_SEARCH = nearby(2, 15)
_ALL = nearby(9, 201)
# Of the permitted depth, where the weight changes r too much.
_SHARE = 1 / 16
# A permitted depth is aimed at from below: it is found to within half a percent.
_AIM = 0.995


class Candidate(NamedTuple):
    """Contact at a step in s, with its outcome before its numbers are rounded.

    It has an undamped depth in m and a ratio of damping.
    """

    depth: float
    ratio: float
    law: Law
    step: float
    outcome: Outcome


def _written(value: Any) -> Any:
    """Return a number, or a tuple of numbers, with the digits of a snippet."""
    if isinstance(value, tuple):
        return tuple(map(_written, value))
    return float(f"{value:.6g}")


def _up_to(most: float) -> Array:
    """Return ratios of damping from 0 to `most`."""
    return np.concatenate([[0.0], np.geomspace(1e-3, most, 31)])


@dataclass(frozen=True)
class Problem:
    """Search for the contact of an engine that bounces as wanted.

    Attributes
    ----------
    bounce, engine
        What is wanted, and where.
    tolerance
        Largest deviation of r.
    """

    bounce: Bounce
    engine: Engine
    tolerance: float = TOLERANCE

    def __post_init__(self) -> None:
        missing = "the mass is missing: --mass '50 g' or mass='50 g'"
        refuse([(self.bounce.mass is None, missing)])

    @property
    def deepest(self) -> float:
        """Depth in m above which the engine loses the body."""
        return self.engine.deepest * self.bounce.size

    @property
    def lost(self) -> str:
        """Message for depths above the deepest one."""
        return f"{self.engine.name} loses a body that sinks more than {show(self.deepest, 'm')}"

    def setting(self, step: float) -> Setting:
        """Return the setting of a contact at a time step in s."""
        return Setting(
            mass=self.bounce.mass,
            step=step,
            points=self.bounce.points,
            radius=self.bounce.size,
        )

    def law(self, depth: Any, ratio: Any) -> Law:
        """Return contacts with undamped depths in m and ratios of damping."""
        return self.engine.of_depth(depth, ratio, self.bounce.impact_speed)

    def law_of(self, parameters: Parameters, step: float) -> Law:
        """Return the contact of two bodies with the same parameters, at a time step in s."""
        body = {**self.engine.defaults, **parameters}
        return self.engine.read(self.engine.combined(body, body), self.setting(step))

    def drops(self, law: Law, step: float, trials: Trials = _ALL) -> Drops:
        """Return the drops of contacts at a time step in s."""
        bounce = self.bounce
        return drop(law, self.engine.scheme, step, bounce.impact_speed, bounce.gravity, trials)

    def outcome(self, law: Law, step: float, trials: Trials = _ALL) -> Outcome:
        """Return the outcome of a contact at a time step in s."""
        drops = self.drops(law, step, trials)
        force = drops.peak * self.bounce.mass
        rest = float(np.max(law.rest(self.bounce.gravity))) if self.bounce.gravity else 0.0
        # A contact of MuJoCo hardly feels gravity: the body hops by what this moves it in a step.
        hop = self.bounce.gravity * step**2 if isinstance(law, Impedance) else 0.0
        is_resolved = rest == 0 or rest >= max(self.engine.resolution * self.bounce.size, hop)
        return Outcome(
            # A body that creeps is not followed until it is at rest.
            depth=(float(drops.depth.min()), max(float(drops.depth.max()), rest)),
            rest=rest if is_resolved else None,
            force=(float(force.min()), float(force.max())),
            restitution=Range.of(drops.restitution),
        )

    def at_rest(self, law: Law, step: float, outcome: Outcome) -> tuple[str, bool]:
        """Return what a body at rest does, and whether it hops by more than 1 % of its size.

        A contact of MuJoCo throws back the speed g h of each step of gravity. A rebound keeps r of
        a speed, so the body leaves with up to g h/(1 - r). In MuJoCo 4.0.0 bodies lie still if they
        lie deeper than 8 g h², and some also above.
        """
        lies = "" if outcome.rest is None else f"at rest it lies {show(outcome.rest, 'm')} deep"
        fall = self.bounce.gravity * step
        if not fall:
            return "", False
        if not isinstance(law, Impedance) or (outcome.rest or 0.0) >= 8 * fall * step:
            return lies, False
        speed = fall / max(1 - outcome.restitution.mean, LEAST_RESTITUTION)
        height = speed**2 / (2 * self.bounce.gravity)
        hops = f"hops by up to about {show(height, 'm', 2)}: less at a shorter step"
        said = f"{lies}, or {hops}" if lies else f"at rest it {hops}"
        return said, height > self.bounce.size / 100

    @property
    def duration(self) -> float:
        """Duration of an undamped contact divided by its depth, T/δ in s/m."""
        return float(self.law(1.0, 0.0).duration(self.bounce.impact_speed))

    @property
    def given_depth(self) -> float | None:
        """Undamped depth δ in m of a contact that was given; None without one."""
        time = self.bounce.contact_time
        if self.bounce.stiffness is not None:
            time = math.pi * math.sqrt(self.bounce.mass / self.bounce.stiffness)
        return None if time is None else time / self.duration

    def ratio(self, depth: float, step: float, guess: float = 0.0) -> float:
        """Return the ratio of damping with which the mean r is the wanted one.

        It is looked for beside a `guess`, if there is one, and then among all.

        The ratio is interpolated where r falls below the wanted one. If r may be 0 within the
        tolerance, or never falls below, it is the middle of the ratios with the smallest error. A
        contact that no body leaves does not depend on where in a step it begins, and too much
        damping throws the body away.
        """
        # A linear damper needs about 1/(2 √r), and no law more than 1/r, to which that of Hunt and
        # Crossley tends. With the largest ratios a body takes long to come out.
        most = 1 / max(self.bounce.restitution, LEAST_RESTITUTION)
        scans = [_up_to(math.sqrt(most)), _up_to(most)]
        if guess:
            scans.insert(0, guess * _BESIDE)
        # A first scan needs at most 80 steps in a contact.
        coarse = max(step, self.duration * depth / 80)
        for ratios in scans:
            ratio, falls = self._scanned(depth, ratios, coarse)
            # Before the first ratio of a scan r may have fallen already.
            if falls and (ratio > ratios[0] or ratio == 0):
                break
        # Its neighbours in the scan are not farther off.
        return self._scanned(depth, ratio * _BESIDE, step)[0]

    def _scanned(self, depth: float, ratios: Array, step: float) -> tuple[float, bool]:
        """Return the ratio of damping of a scan, and whether r falls to the wanted one in it."""
        wanted = self.bounce.restitution
        drops = self.drops(self.law(depth, ratios), step, _SEARCH)
        falling = np.minimum.accumulate(drops.mean)
        falls = bool(falling[-1] <= wanted)
        if falls and wanted > self.tolerance:
            return float(np.interp(-wanted, -falling, ratios)), falls
        errors = drops.error(wanted)
        # r is printed with three digits.
        return float(np.median(ratios[errors <= errors.min() + 1e-3])), falls

    def candidate(self, depth: float, ratio: float, step: float) -> Candidate:
        """Return a contact with its outcome."""
        law = self.law(depth, ratio)
        return Candidate(depth, ratio, law, step, self.outcome(law, step))

    def at(self, depth: float, step: float) -> Candidate:
        """Return the contact of an undamped depth in m at a time step in s."""
        return self.candidate(depth, self.ratio(depth, step), step)

    @property
    def permitted(self) -> float:
        """Maximum depth in m; infinite for a contact that was given."""
        return self.bounce.limit if self.given_depth is None else math.inf

    def keeps(self, outcome: Outcome, depth: float) -> bool:
        """Return whether r is within the tolerance, and the depth at most `depth`."""
        deviation = outcome.restitution.deviation(self.bounce.restitution)
        return deviation <= self.tolerance and outcome.depth[1] <= depth

    def step_of(self, count: float) -> Callable[[float], float]:
        """Return the step, as a function of the undamped depth, of a contact of `count` steps."""
        return lambda depth: _written(min(self.duration * depth / count, LONGEST_STEP))

    def keeping(
        self, step_of: Callable[[float], float], share: float = 1.0, near: Candidate | None = None
    ) -> Candidate:
        """Return the contact with a share of the depth, or the stiffness or time that is given.

        The search of its undamped depth begins at that of a contact `near` it.
        """
        if self.given_depth is not None:
            return self.at(self.given_depth, step_of(self.given_depth))
        limit = share * self.bounce.limit
        # A contact that is stopped by its damper sinks about √r times its undamped depth.
        damped = math.sqrt(max(self.bounce.restitution, LEAST_RESTITUTION))
        depth = limit / damped if near is None else near.depth
        ratio = 0.0 if near is None else near.ratio
        for _ in range(8):
            ratio = self.ratio(depth, step_of(depth), ratio)
            contact = self.candidate(depth, ratio, step_of(depth))
            sunk = max(contact.outcome.depth[1], limit / 100)
            change = _AIM * limit / sunk
            if abs(change - 1) <= 1 - _AIM:
                break
            # Between δ, of a fast body, and δ², of one that its weight presses in.
            depth *= change**0.75
        return contact

    def wanted(self) -> Candidate:
        """Return the contact that keeps what is given at the longest step within the tolerance.

        If no contact does, return the contact with the nearest r.
        """
        tried = []
        shares = (1.0, _SHARE) if self.bounce.gravity and self.given_depth is None else (1.0,)
        for share in shares:
            contact = None
            for count in _COUNTS:
                contact = self.keeping(self.step_of(count), share, contact)
                if self.keeps(contact.outcome, self.permitted):
                    return contact
                tried.append(contact)
        return min(
            tried,
            key=lambda candidate: (
                candidate.outcome.depth[1] > self.permitted,
                candidate.outcome.restitution.deviation(self.bounce.restitution),
            ),
        )

    def stiffest(self, step: float, deepest: float) -> Candidate:
        """Return the stiffest contact at a time step in s with which r is within the tolerance.

        Bisect the number of steps of a contact: more steps have a smaller error of r, as long as
        the body does not sink too far. If no contact keeps r down to the depth `deepest` in m,
        return one that does not.
        """

        @functools.cache
        def contact(count: float) -> Candidate:
            return self.at(count * step / self.duration, step)

        def is_enough(count: float) -> bool:
            outcome = contact(count).outcome
            return self.keeps(outcome, math.inf) or outcome.depth[1] > deepest

        place = bisect_left(_FINE_COUNTS, True, key=is_enough)
        return contact(_FINE_COUNTS[min(place, len(_FINE_COUNTS) - 1)])

    def written(self, contact: Candidate) -> Parameters:
        """Return the parameters of a contact as they are written."""
        setting = self.setting(contact.step)
        combined = {**self.engine.write(contact.law, setting), **self.engine.beside}
        return {name: _written(value) for name, value in self.engine.of_each(combined).items()}

    def between(self, step: float, short: Candidate) -> Candidate:
        """Return the contact at the longest of a step, its half, … that is not too deep.

        Bisect the number of halvings: at the half of a step the same contact has a smaller error of
        r. If every one is too deep, return the contact of the short step.
        """

        @functools.cache
        def contact(halvings: int) -> Candidate:
            shorter = _written(step / 2**halvings)
            # With the fewest steps a contact is the least deep.
            candidate = self.at(_FINE_COUNTS[0] * shorter / self.duration, shorter)
            if candidate.outcome.depth[1] <= self.bounce.size:
                candidate = self.keeping(lambda _: shorter, near=short)
                if not self.keeps(candidate.outcome, self.permitted):
                    candidate = self.stiffest(shorter, self.bounce.size)
            return candidate

        def is_held(halvings: int) -> bool:
            outcome = contact(halvings).outcome
            # A ball that sinks by more than its radius may leave a table on its other side.
            return (
                self.keeps(outcome, self.bounce.size) and (outcome.rest or 0.0) < self.bounce.size
            )

        longer = max(math.ceil(math.log2(step / short.step)), 1)
        place = bisect_left(range(longer), True, key=is_held)
        return short if place == longer else contact(place)

    def promised(self, outcome: Outcome, speed: float | None = None) -> tuple[float, float]:
        """Return the smallest and the largest r of bodies that slide at up to `speed`.

        The speed is in units of the speed of the fall; by default it is the smallest one for which
        the engine has a range.
        """
        low, _, high = outcome.restitution
        sliding = self.engine.sliding
        if self.bounce.friction == 0 or not sliding.speeds:
            return low, high
        more = sliding.adds(self.bounce.restitution, speed or sliding.speeds[0])
        return max(low - sliding.takes, 0.0), high + more


def design_spring(bounce: Bounce, engine: Engine, time_step: Quantity = None) -> Answer:
    """Return the stiffness and damping with which a body bounces as wanted.

    Raises
    ------
    Refused
        If there is no such contact.
    """
    problem = Problem(bounce, engine)
    refuse(
        [
            (
                bounce.stiffness is not None and engine.units.get(engine.names[0]) == "Pa",
                f"{engine.name} has no stiffness in N/m: give the penetration",
            ),
        ]
    )
    asked = None if time_step is None else _written(bounce.step(time_step))
    # Half of the tolerance is left for what is known of the body.
    short = replace(problem, tolerance=problem.tolerance / 2).wanted()
    chosen = short
    if asked is not None:
        yours = problem.keeping(lambda _: asked)
        if problem.keeps(yours.outcome, problem.permitted):
            chosen = yours
        elif not bounce.gives_contact:
            chosen = problem.between(asked, short)
    design = answer(problem, chosen, asked)
    deepest = design.outcome.depth[1]
    if bounce.contact_time and deepest > bounce.size:
        raise Refused(
            f"this contact sinks {show(deepest, 'm')}, deeper than the {bounce.size_name} of "
            f"{show(bounce.size, 'm')}: give a shorter one, or the size"
        )
    # A row for what is given, or one that is not deeper than permitted.
    also: tuple[Answer, ...] = ()
    if short.step < chosen.step and not problem.keeps(design.outcome, problem.permitted):
        # Its step alone is typed, which asks for the whole depth that is permitted.
        less = problem.keeping(lambda _: short.step)
        if problem.keeps(less.outcome, min(problem.permitted, 0.9 * design.outcome.depth[1])):
            also = (answer(problem, less, asked),)
    if asked is not None and bounce.gives_contact and chosen is short:
        stiffest = problem.stiffest(asked, problem.deepest)
        if problem.keeps(stiffest.outcome, problem.deepest):
            also = (answer(problem, stiffest, asked),)
    return replace(design, also=also)


def answer(problem: Problem, contact: Candidate, asked: float | None) -> Answer:
    """Return the answer for a contact, with rounded parameters."""
    bounce = problem.bounce
    engine = problem.engine
    step = contact.step
    parameters = problem.written(contact)
    law = problem.law_of(parameters, step)
    deep = law.deep
    outcome = problem.outcome(law, step)
    return Answer(
        engine=engine.name,
        ran=ran_in(engine),
        bounce=bounce,
        time_step=step,
        asked_step=asked,
        parameters=parameters,
        outcome=outcome,
        snippet=snippet(problem, parameters, step, asked),
        warnings=tuple(_warnings(problem, law, step, asked, outcome)),
        not_for=not_for(problem, outcome),
        remarks=tuple(_remarks(problem, law, step, asked, outcome)),
        numbers={
            "stiffness": float(deep.stiffness) * bounce.mass,
            "damping_ratio": float(deep.damping / deep.stiffness**0.5 / 2),
        },
    )


def snippet(problem: Problem, parameters: Parameters, step: float, asked: float | None) -> str:
    """Return what to paste; the parameters of an engine that has no snippet here."""
    engine = problem.engine
    bounce = problem.bounce
    template = snippet_of(engine.name)
    if not template:
        return "\n".join(f"{name} = {value}" for name, value in parameters.items())
    mu = bounce.friction or 0.0
    law = problem.law_of(parameters, step)
    values = {
        "step": step,
        "k": float(law.stiffness) * bounce.mass / bounce.points,
        "c": float(law.damping) * bounce.mass / bounce.points,
        "friction": mu,
        "rubs": engine.rubs.format(mu=mu, root=math.sqrt(mu))
        if bounce.friction is not None
        else "",
        "condim": 1 if bounce.friction == 0 else 3,
    }
    return template.format(**values, **parameters).rstrip()


def not_for(problem: Problem, outcome: Outcome) -> tuple[str, ...]:
    """Return the scenes in which r of a contact is another one."""
    bounce = problem.bounce
    engine = problem.engine
    low, high = problem.promised(outcome)
    is_wider = max(outcome.restitution.low - low, high - outcome.restitution.high) > TOLERANCE
    # The widest range is that of the largest speed.
    low, high = problem.promised(outcome, max(engine.sliding.speeds, default=None))
    return tuple(
        holding(
            [
                (is_wider, f"bodies that slide (r = {span(low, high)})"),
                (bounce.points > 1, "boxes off flat or that slide fast"),
                *((True, text) for text in engine.not_for),
                *((bounce.points == 1, text) for text in engine.not_of_one_point),
            ]
        )
    )


def _warnings(
    problem: Problem, law: Law, step: float, asked: float | None, outcome: Outcome
) -> list[str]:
    """Return warnings: on r, then on the depth, the severest first."""
    bounce = problem.bounce
    r = outcome.restitution
    slower = replace(bounce, drop_height=None, speed=bounce.impact_speed / 3)
    slow = replace(problem, bounce=slower).outcome(law, step).restitution
    is_undamped = float(law.damping) == 0 and r.mean < bounce.restitution
    rests, hops = problem.at_rest(law, step, outcome)
    size = f"{bounce.size_name} of {show(bounce.size, 'm')}"
    moves = f"it moves {show(bounce.impact_speed * (asked or step), 'm')} in a step"
    is_other = asked is not None and step != asked
    depth = outcome.depth[1]
    return holding(
        [
            (depth > problem.deepest, problem.lost),
            (r.high >= 1.0005, f"at some instants the body gains energy: r is up to {r.high:.3f}"),
            (
                is_undamped,
                f"without damping r is still {r.mean:.3f}, because the steps damp: less at a "
                "shorter step",
            ),
            (
                r.deviation(bounce.restitution) > problem.tolerance and not is_undamped,
                "no contact with a nearer r was found",
            ),
            (
                abs(slow.mean - r.mean) > TOLERANCE / 2,
                f"at a third of the speed r is {slow}",
            ),
            (
                is_other and bounce.gives_contact,
                f"at {show(asked or 0, 's', 4)} no contact keeps what you gave",
            ),
            (
                is_other and not bounce.gives_contact,
                f"at {show(asked or 0, 's', 4)} a contact with this r is too deep: {moves}",
            ),
            (depth > bounce.size, f"it sinks deeper than its {size}"),
            (hops, rests),
        ]
    )


def _remarks(
    problem: Problem, law: Law, step: float, asked: float | None, outcome: Outcome
) -> list[str]:
    """Return remarks on a contact, what was given, and what was assumed."""
    bounce = problem.bounce
    engine = problem.engine
    given = [f"{name} {value}" for name, value in bounce.given.items()]
    if asked is not None:
        given.append(f"time step {show(asked, 's', 4)}")
    is_tenth = bounce.limit == bounce.size / 10
    share = f"a tenth of the {bounce.size_name}" if is_tenth else "a fifth of the drop height"
    depth = f"it may sink {show(bounce.limit, 'm')}, {share}, unless a penetration is given"
    assumed = bounce.assumed + holding([(not bounce.gives_contact, depth)])
    rests, hops = problem.at_rest(law, step, outcome)
    ranges = [
        f"{span(*problem.promised(outcome, speed))} at up to {speed:g} times the speed of the fall"
        for speed in engine.sliding.speeds
    ]
    is_sliding = ranges and bounce.friction != 0
    is_pasted = "{rubs}" in snippet_of(engine.name)
    return holding(
        [
            (rests and not hops, rests[:1].upper() + rests[1:]),
            (True, f"The largest force is {show(outcome.force[1], 'N')}"),
            (is_sliding, f"Of bodies that slide r is {', '.join(ranges)}"),
            (bounce.friction and engine.friction, engine.friction),
            (
                bounce.friction and not is_pasted,
                f"The friction of {bounce.friction or 0:g} is not in what is pasted",
            ),
            *((True, note) for note in engine.notes),
            (
                isinstance(engine.scheme, Implicit),
                "The numbers take back what this time step damps, and hold for it only",
            ),
            (bounce.points > 1 and engine.box, engine.box),
            (True, f"Given: {', '.join(given)}"),
            (assumed, f"Assumed: {'; '.join(assumed)}"),
        ]
    )

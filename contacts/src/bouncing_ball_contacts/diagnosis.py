"""From the parameters of an engine to the bounce that they give, and to the least change."""

import difflib
import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from bouncing_ball_contacts import units
from bouncing_ball_contacts.designs import (
    IMPULSE,
    LEAST_RESTITUTION,
    TOLERANCE,
    Bounce,
    Outcome,
    Page,
    Problem,
    Quantity,
    design,
)
from bouncing_ball_contacts.engines import (
    ENGINES,
    MODES,
    UNDISTURBED,
    Engine,
    engine_named,
    text_of,
)
from bouncing_ball_contacts.schemes import (
    Bullet,
    ContactJoint,
    Impedance,
    Implicit,
    Law,
    Linear,
    Solved,
)
from bouncing_ball_contacts.units import Refused, in_si, show

# With as many steps in a contact each scheme is within 0.003 of its limit of short steps.
_SHORT = 1000
# Fewer steps than these are named as a reason.
_FEW = 10
# Parameters from 0 to 1 with which r rises.
_SHARES = (
    "e",
    "coefficientRestitution",
    "restitution",
    "restitution_coefficient",
    "bounce",
    "soft_erp",
    "contactERP",
)
# The units of a stiffness and a damping per unit of mass.
_PER_MASS = ("1/s^2", "1/s")


@dataclass(frozen=True)
class Change:
    """One parameter, and the step in s, with which the contact has the wanted r."""

    name: str
    value: Any
    step: float
    outcome: Outcome


@dataclass(frozen=True, repr=False)
class Diagnosis(Page):
    """What the parameters of an engine do.

    ``limit`` is r in the limit of short steps and ``free`` the same without gravity; ``stiffness``
    in N/m and ``damping_ratio`` are those of all points together, NaN if the contact is none of a
    spring and a damper. ``given`` are those of the ``parameters`` that are no defaults, and
    ``other`` the same of another body that differs.
    """

    engine: str
    bounce: Bounce
    time_step: float
    parameters: Mapping[str, Any]
    given: Mapping[str, Any]
    other: Mapping[str, Any] | None
    outcome: Outcome
    limit: float
    free: float
    stiffness: float
    damping_ratio: float
    reasons: tuple[str, ...]
    change: Change | None

    @property
    def lines(self) -> list[str]:
        """The answer, line by line."""
        found = self.outcome
        wanted = self.bounce.restitution
        aim = "" if wanted is None else f"; {wanted:g} is wanted"
        lines = [f"{self.engine} at a step of {show(self.time_step, 's')}: r = {found.around}{aim}"]
        force = show(found.force[1], "N")
        rest = f", and lies {show(found.rest, 'm')} deep" if self.bounce.load else ""
        lines.append(f"It sinks {show(found.depth[1], 'm')} under at most {force}{rest}.")
        if math.isfinite(self.damping_ratio):
            lines.append(
                f"The contact has k = {show(self.stiffness, 'N/m')} and a damping ratio of "
                f"{self.damping_ratio:.3g}; in short steps r is {self.limit:.3f}."
            )
        lines += [f"! {reason}" for reason in self.reasons]
        if self.change is not None:
            is_here = math.isclose(self.change.step, self.time_step)
            step = "" if is_here else f" and a step of {show(self.change.step, 's')}"
            misses = self.change.outcome.deviation(wanted) > TOLERANCE
            leaves = f", which leaves the tolerance of {TOLERANCE:g}" if misses else ""
            lines.append(
                f"Least change: {_listed({self.change.name: self.change.value})}{step} gives r = "
                f"{self.change.outcome.around}{leaves}."
            )
        if wanted is None:
            lines.append("With --restitution there is a least change, for the r that is wanted.")
        row = engine_named(self.engine)
        given = [_listed(self.given)] if self.given else []
        if self.other is not None:
            given.append(f"of the other body {_listed(self.other) or 'the defaults'}")
        given.append(", ".join(f"{name} {value}" for name, value in self.bounce.given.items()))
        lines.append(f"Given: {'; '.join(given)}.")
        names = self.parameters.keys() - self.given.keys()
        defaults = {name: self.parameters[name] for name in row.defaults if name in names}
        assumed = [f"the defaults {_listed(defaults)}"] if defaults else []
        assumed += self.bounce.assumed_body
        if assumed:
            lines.append(f"Assumed: {'; '.join(assumed)}.")
        if not row.ran:
            lines.append(f"The row of {row.name} was never run in its engine.")
        return lines

    def __repr__(self) -> str:
        return "\n".join(self.lines[:2])

    def __str__(self) -> str:
        return "\n".join(self.lines)


def _typed(value: Any) -> str:
    """Return a value as it is typed on the command line."""
    if isinstance(value, tuple):
        return '"' + " ".join(f"{each:.6g}" for each in value) + '"'
    return value if isinstance(value, str) else f"{value:.6g}"


def _listed(parameters: Mapping[str, Any]) -> str:
    return ", ".join(f"{name} = {_typed(value)}" for name, value in parameters.items())


def _spelled(name: str) -> str:
    """Return a name as compliant_contact_stiffness, SetKn and kn are spelled alike."""
    return name.replace("_", "").replace(" ", "").lower().removeprefix("set")


def parameters_of(engine: Engine, given: Mapping[str, Any]) -> dict[str, Any]:
    """Return the parameters of a body in an engine as numbers, without those that are not given.

    Raises
    ------
    Refused
        If a name is unknown, a value is no number or out of its range, or one is missing.
    """
    names = list(engine.rules)
    known = {_spelled(name): name for name in names}
    values: dict[str, Any] = {}
    for typed, value in given.items():
        name = known.get(_spelled(typed))
        if name is None:
            raise Refused(_unknown(engine, typed, names))
        values[name] = _value(engine, name, value)
    found = {**engine.defaults, **values}
    missing = [name for name in names if name not in found]
    if missing:
        raise Refused(
            f"{missing[0]} is missing: give {' and '.join(names)}; {engine.name} has no defaults"
        )
    if engine.name == "pybullet" and (found[names[0]] < 0) != (found[names[1]] < 0):
        raise Refused(f"PyBullet refuses {names[0]} or {names[1]} alone: give both")
    return values


def _unknown(engine: Engine, typed: str, names: list[str]) -> str:
    """Return what is said of a parameter that an engine does not have."""
    text = f"{engine.name} has no {typed!r}: it has {', '.join(names)}"
    family = engine.name.split("-")[0]
    others = [name for name in ENGINES if name.startswith(family) and typed in ENGINES[name].names]
    near = difflib.get_close_matches(typed, names, 1, 0.6)
    if others:
        text += f"; {' and '.join(others)} has it"
    elif near:
        text += f"; did you mean {near[0]}?"
    return text


def _value(engine: Engine, name: str, value: Any) -> Any:
    if name in ("solref", "solimp"):
        return _numbers(name, value)
    if name == "restitutionCombineMode":
        if str(value).lower() not in MODES:
            raise Refused(f"{name} = {value} is none of {', '.join(MODES)}")
        return str(value).lower()
    number = in_si(name, value, engine.units.get(name, ""))
    is_default = number == engine.defaults.get(name)
    if number < 0 and not is_default:
        raise Refused(f"{name} = {number:g} is negative")
    if name in ("soft_cfm", "soft_erp") and number == 0:
        raise Refused(f"{name} = 0 is not computed: give a small number")
    if name == engine.names[0] and number == 0 and not is_default:
        raise Refused(f"{name} = 0 is no contact")
    if name in _SHARES and number > 1:
        raise Refused(f"{name} = {number:g} is not between 0 and 1")
    return number


def _numbers(name: str, value: Any) -> tuple[float, ...]:
    texts = (
        value.strip("\"'()[] ").replace(",", " ").split()
        if isinstance(value, str)
        else list(np.atleast_1d(value))
    )
    numbers = tuple(in_si(name, each, "") for each in texts)
    if name == "solimp":
        if not 1 <= len(numbers) <= 5:
            raise Refused(f"solimp has up to five numbers, and not {len(numbers)}")
        return numbers
    if len(numbers) != 2:
        raise Refused(f"solref has two numbers, as in '0.02 1' or '-1000 -20', not {len(numbers)}")
    first, second = numbers
    if not (first > 0 and second > 0 or first < 0 and second <= 0):
        raise Refused(
            f"solref = '{first:g} {second:g}' is neither two negative numbers, -k/m and -c/m, nor "
            "two positive ones, a time constant and a damping ratio"
        )
    if first > 100:
        raise Refused(
            f"solref = '{first:g} {second:g}' is a time constant of {first:g} s: -k/m and -c/m are "
            f"written '-{first:g} -{second:g}'"
        )
    return numbers


def diagnose(
    bounce: Bounce,
    engine: str | Engine,
    parameters: Mapping[str, Any] | None = None,
    time_step: Quantity = None,
    *,
    other: Mapping[str, Any] | None = None,
    one_body: bool = False,
) -> Diagnosis:
    """Return the bounce that parameters give at a step, and the least change for the one wanted.

    Parameters
    ----------
    bounce : Bounce
        Its restitution is the one that is wanted, and may be left out.
    engine : str or Engine
    parameters : mapping
        Those of one body by their names; without any, the engine's defaults.
    time_step : Quantity
    other : mapping, optional
        Those of the other body, by default the same.
    one_body : bool
        Whether the other body has the engine's defaults.

    Raises
    ------
    Refused
        If a parameter or the step is missing, unknown or out of its range.
    """
    row = engine_named(engine)
    if time_step is None and row.fixed_steps:
        raise Refused("the time step is missing: --time-step '2 ms' or time_step='2 ms'")
    given = parameters_of(row, parameters or {})
    if one_body and other:
        raise Refused("give either the parameters of the other body or --one-body, not both")
    other_given = parameters_of(row, other or {}) if other or one_body else None
    of_one = {**row.defaults, **given}
    of_other = of_one if other_given is None else {**row.defaults, **other_given}
    problem = Problem(bounce, row, drag=of_one.get("linearDamping", 0.0))
    pair = _Pair(problem, of_one, of_other)
    if time_step is None:
        step = float(pair.law(1.0).duration(bounce.impact_speed)) / _SHORT
    else:
        step = units.time_step(time_step)
    law = pair.law(step)
    outcome = problem.outcome(law, step)
    limit = free = outcome.restitution[1]
    if not law.is_number:
        short = min(float(law.duration(bounce.impact_speed)) / _SHORT, step)
        limit = float(replace(problem, drag=0.0).drops(law, short).mean)
        weightless = replace(bounce, drop_height=None, speed=bounce.impact_speed, gravity=0.0)
        free = float(Problem(weightless, row).drops(law, short).mean)
    stiffness, ratio = _spring(problem, law)
    reasons = tuple(_reasons(pair, step, law, outcome, limit, free))
    change = None
    if bounce.restitution is not None and outcome.deviation(bounce.restitution) > TOLERANCE:
        change = _least_change(pair, step)
        is_enough = (
            change is not None
            and change.outcome.deviation(bounce.restitution) <= TOLERANCE
            and math.isclose(change.step, step)
        )
        if not is_enough:
            reasons += (_another(pair, step),)
    return Diagnosis(
        engine=row.name,
        bounce=bounce,
        time_step=step,
        parameters=of_one,
        given=given,
        other=other_given,
        outcome=outcome,
        limit=limit,
        free=free,
        stiffness=stiffness,
        damping_ratio=ratio,
        reasons=reasons,
        change=change,
    )


@dataclass(frozen=True)
class _Pair:
    """The parameters of two bodies."""

    problem: Problem
    one: dict[str, Any]
    other: dict[str, Any]

    def law(self, step: float) -> Law:
        engine = self.problem.engine
        return engine.read(engine.combined(self.one, self.other), self.problem.setting(step))

    def changed(self, name: str, value: Any) -> "_Pair":
        """Return the pair with another value, of both bodies if they are alike."""
        one = self.one | {name: value}
        other = one if self.one == self.other else self.other
        return _Pair(self.problem, one, other)

    def mean(self, step: float) -> float:
        """Return the mean r."""
        return float(self.problem.drops(self.law(step), step).mean)


def _spring(problem: Problem, law: Law) -> tuple[float, float]:
    """Return k in N/m and ζ of a spring and a damper."""
    if isinstance(law, Impedance):
        law = law.deep
    if not isinstance(law, Linear | Solved) or law.is_number:
        return math.nan, math.nan
    k = float(law.stiffness)
    return k * problem.bounce.reduced_mass, float(law.damping) / (2 * math.sqrt(k))


def _reasons(
    pair: _Pair, step: float, law: Law, outcome: Outcome, limit: float, free: float
) -> Iterator[str]:
    """Yield what keeps r from the wanted one, and what else is wrong with this contact."""
    problem = pair.problem
    bounce = problem.bounce
    _, mean, high = outcome.restitution
    if problem.drag:
        dragged = mean
        mean = replace(problem, drag=0.0).outcome(law, step).restitution[1]
        if mean - dragged > 5e-4:
            yield (
                f"linearDamping = {problem.drag:g} lowers r from {mean:.3f} to {dragged:.3f}; "
                "designs set it to 0, and PyBullet's default is 0.04"
            )
    if problem.engine.caution:
        yield problem.engine.caution
    if problem.engine.floor and bounce.other_mass is None:
        yield problem.engine.floor
    if isinstance(law, ContactJoint) and law.fastest < bounce.impact_speed:
        yield f"max_vel caps the rebound at {law.fastest:g} m/s; designs lift it"
    if isinstance(law, Solved) and law.is_number:
        number = problem.engine.number
        rule = problem.engine.rules[number].text
        spring = "no spring is set" if np.isinf(law.stiffness) else "a restitution beside a spring"
        yield f"{spring}: this is an impact by the number {number}, {rule}"
        alike = replace(problem, drag=0.0).outcome(Bullet(restitution=law.restitution), step)
        if isinstance(law, Bullet) and alike.around != outcome.around:
            sees = f"sees the surface {show(law.ahead, 'm')} ahead and " if law.ahead > 0 else ""
            yield (
                f"PyBullet {sees}pushes the body out; with {_listed(UNDISTURBED)} r is "
                f"{alike.around}"
            )
        elif outcome.deviation(alike.restitution[1]) > TOLERANCE / 2:
            yield f"the step and the other parameters change r: {number} alone has {alike.around}"
        return
    if isinstance(law, Bullet) and law.ahead > 0:
        touching = problem.outcome(replace(law, ahead=0.0), step).restitution[1]
        if abs(outcome.restitution[1] - touching) > TOLERANCE / 2:
            yield (
                f"PyBullet sees the surface {show(law.ahead, 'm')} ahead: with "
                f"contactProcessingThreshold = 0 r is {touching:.3f}"
            )
    steps = float(law.duration(bounce.impact_speed)) / step
    if high > 1.02:
        yield f"unstable: a contact takes {steps:.2g} steps, and the body leaves faster than before"
    elif steps < _FEW:
        yield f"a contact takes {steps:.2g} steps: r depends on where in a step it begins"
    if abs(mean - limit) > TOLERANCE / 2 and high <= 1.02:
        yield f"the step changes r by {mean - limit:+.3f}, from {limit:.3f} in short steps"
    if abs(free - limit) > TOLERANCE / 2:
        yield f"gravity during the contact changes r by {limit - free:+.3f}, from {free:.3f}"
    _, ratio = _spring(problem, law)
    if ratio >= 1:
        yield f"the damping ratio of {ratio:.3g} is that of a contact without oscillation"
    if outcome.depth[1] > bounce.size:
        yield f"it sinks deeper than its {bounce.size_name} of {show(bounce.size, 'm')}"
    if isinstance(law, Impedance):
        yield from _of_mujoco(pair, step, law)
    if bounce.restitution is not None:
        yield from _mistaken(pair, step, free, ratio)


def _of_mujoco(pair: _Pair, step: float, law: Impedance) -> Iterator[str]:
    combined = pair.problem.engine.combined(pair.one, pair.other)
    time = combined["solref"][0]
    if 0 < time < 2 * step and combined.get("refsafe", 1):
        yield (
            f"MuJoCo raises the time constant of {time:g} s to {2 * step:g} s, two steps (refsafe)"
        )
    if law.high > 0.01 and pair.problem.bounce.load:
        yield (
            f"with the impedance {law.high:g} a contact feels {1 - law.high:.2g} of gravity; a "
            "spring and a damper feel all of it with solimp = 1e-4 1e-4 0.001"
        )


def _mistaken(pair: _Pair, step: float, free: float, ratio: float) -> Iterator[str]:
    """Yield the usual mistakes of formulas that explain the parameters."""
    problem = pair.problem
    wanted = float(problem.bounce.restitution)
    engine = problem.engine
    mass = problem.bounce.reduced_mass
    if abs(free - wanted) < TOLERANCE:
        return
    names = [name for name in engine.names if engine.units.get(name) in _PER_MASS]
    if engine.name == "mujoco":
        names = ["solref"]
    divided = pair
    for name in names:
        values = tuple(value / mass for value in np.atleast_1d(pair.one[name]))
        divided = divided.changed(name, values if name == "solref" else values[0])
    mean = divided.mean(step)
    is_near = abs(mean - wanted) < min(TOLERANCE, 0.3 * abs(free - wanted))
    # A positive solref is a time constant and a damping ratio.
    if names and is_near and mass != 1 and np.all(np.asarray(pair.one.get("solref", -1)) <= 0):
        yield (
            f"{' and '.join(names)} is per unit of mass in {engine.name}: divided by {mass:g} kg, "
            f"r is {mean:.3f}"
        )
    if ratio < 1:
        pulling = math.exp(-math.pi * ratio / math.sqrt(1 - ratio**2))
        if abs(pulling - wanted) < 0.005:
            yield (
                "this damping is that of a contact whose damper pulls until the end, "
                f"r = exp(-πζ/√(1 - ζ²)); in {engine.name} it ends earlier"
            )


def _another(pair: _Pair, step: float) -> str:
    """Return what has r at this step if no damping of the given contact has it."""
    problem = pair.problem
    engine = problem.engine
    is_number = pair.law(step).is_number
    what = engine.number if is_number else "damping of this contact"
    text = f"no {what} keeps r within {TOLERANCE:g} at this step"
    if isinstance(engine.scheme, Implicit) and not is_number:
        name = engine.names[1]
        most = pair.changed(name, 1.0 if name in _SHARES else 0.0).mean(step)
        text += f", which damps by itself: r is {most:.3f} at most"
    try:
        found = design(problem.bounce, engine.name, step)
    except Refused:
        return text
    row = found.row
    at = "" if math.isclose(row.step, step, rel_tol=1e-4) else f", at {show(row.step, 's')}"
    text += f"; {_listed(row.parameters)} has {row.outcome.around}{at}"
    if text_of(f"{engine.name}-impulse") and IMPULSE in found.rows:
        impulse = found.rows[IMPULSE]
        text += f"; {_listed(impulse.parameters)} without a spring has {impulse.outcome.around}"
    return text


def _least_change(pair: _Pair, step: float) -> Change | None:
    """Return the damping with the wanted r, at this step or at the longest shorter one."""
    problem = pair.problem
    law = pair.law(step)
    if law.is_number:
        return _damping(pair, step, problem.engine.number)
    if isinstance(law, ContactJoint) and law.fastest < problem.bounce.impact_speed:
        return None
    for halvings in range(7 if problem.engine.fixed_steps else 1):
        found = _damping(pair, step / 2**halvings, problem.engine.names[1])
        if found is not None:
            return found
    return None


def _damping(pair: _Pair, step: float, name: str) -> Change | None:
    """Return the value of the parameter with the wanted r at a step; None if none has it."""
    problem = pair.problem
    target = max(float(problem.bounce.restitution), LEAST_RESTITUTION)
    rises = name in _SHARES

    def of(value: float) -> Any:
        if name != "solref":
            return value
        first, second = pair.one["solref"]
        return (first, -value if first < 0 else value)

    def mean(value: float) -> float:
        return pair.changed(name, of(value)).mean(step)

    bracket: tuple[float, float] | None = (1e-4, 1.0)
    if not rises:
        given = np.abs(np.atleast_1d(pair.one[name])[-1])
        bracket = _damped(mean, target, float(given) or 1.0)
    if bracket is None:
        return None
    low, high = bracket
    for _ in range(18):
        middle = (low + high) / 2
        if (mean(middle) > target) == rises:
            high = middle
        else:
            low = middle
    value = float(f"{(low + high) / 2:.5g}")
    outcome = problem.outcome(pair.changed(name, of(value)).law(step), step)
    # A mean that hides large errors is no change for the better.
    misses = abs(outcome.restitution[1] - target) > TOLERANCE or outcome.error > 3 * TOLERANCE
    if misses or outcome.restitution[2] > 1.02:
        return None
    return Change(name, of(value), step, outcome)


def _damped(
    mean: Callable[[float], float], target: float, start: float
) -> tuple[float, float] | None:
    """Return neighbouring values between which r falls below the target, from small ones on."""
    low = 0.0
    high = start / 4096
    if mean(high) < target:
        # A damping this small changes nothing: the steps alone damp more, or nearly so.
        return (low, high) if mean(high * 1e-6) >= target else None
    for _ in range(30):
        low = high
        high = 2 * high
        if mean(high) < target:
            return low, high
    return None

"""From the parameters of an engine to the bounce that they give, and to the least change.

The row of an engine reads the parameters of two bodies as a contact (:class:`Contact`). The bounce
of this contact is computed as in a design. Three questions are answered.

* *What changes r?* One thing after another is taken away: the parameters that a design sets
  otherwise, the steps, and gravity. What remains is r of the spring and the damper alone. Each
  thing that changes r visibly is named.
* *What may have been meant?* If the numbers had another meaning, r might be as wanted. The
  answer names this meaning.
* *What is the least change?* The damping with which r is as wanted at the given
  step. If r leaves the tolerance there, the step is halved until r keeps it.
"""

import math
import re
from bisect import bisect_left
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from bouncing_ball_contacts.answers import TOLERANCE, Answer, Outcome
from bouncing_ball_contacts.bounces import Bounce, Quantity
from bouncing_ball_contacts.designs import LEAST_RESTITUTION, Problem
from bouncing_ball_contacts.engines import (
    MODES,
    OF_PAIR,
    PAIR,
    Engine,
    Parameters,
    Setting,
    as_compared,
    one_of,
    parameters_of,
    ran_in,
)
from bouncing_ball_contacts.rows import CONES, ENGINES
from bouncing_ball_contacts.schemes import (
    MOST_STEPS,
    SHORT_STEPS,
    Impedance,
    Law,
    Linear,
    SemiImplicit,
    Trials,
    drop,
    exact,
    offsets,
)
from bouncing_ball_contacts.units import Refused, holding, in_si, refuse, show, within

_SHARES = ("e", "soft_erp")
"""Parameters from 0 to 1, which raise r where a damping lowers it."""
_DIVISORS = ("dampratio", "soft_erp")
"""Parameters that cannot be 0, besides the stiffness of each engine."""
_VECTORS = {
    "solref": (1, 2, "one or two numbers, as in '0.02 1' or '-1000 -20'"),
    "solimp": (1, 5, "up to five numbers"),
    "friction": (1, 3, "up to three numbers"),
}
"""Minimum and maximum count of the numbers of parameters, and both as text."""
_WORDS = {"restitutionCombineMode": MODES, "cone": CONES, "condim": ("1", "3", "4", "6")}
"""Parameters that are one of several words."""
_WHY = {
    "contactProcessingThreshold": "PyBullet sees the surface ahead, and ",
    "max_vel": "max_vel caps the rebound, and ",
}
"""What parameters do that change r."""

_VISIBLE = TOLERANCE / 2
# With so few steps in a contact r depends on the instant of the impact.
_FEW = 10
_MEAN = exact(offsets(21))
# At a step and at half of it.
_BOTH = Trials(np.tile(_MEAN.at, 2), np.repeat([1.0, 0.5], 21), np.ones(42))
# Between numbers that are tried for a least change.
_FINE = 1 + 2e-4


@dataclass(frozen=True)
class Contact:
    """Contact of two bodies.

    Attributes
    ----------
    problem
        Bounce and engine.
    one, other
        Parameters of each body; the other body has the same ones if `other` is None.
    step
        Time step in s.
    """

    problem: Problem
    one: Parameters
    other: Parameters | None
    step: float

    @property
    def combined(self) -> dict[str, Any]:
        """Combined parameters of both bodies."""
        return self.problem.engine.combined(
            self.one, self.one if self.other is None else self.other
        )

    @property
    def law(self) -> Law:
        return self.problem.engine.read(self.combined, self.problem.setting(self.step))

    @property
    def steps(self) -> float:
        """Number of steps of a contact."""
        return float(self.law.duration(self.problem.bounce.impact_speed)) / self.step

    @property
    def damper(self) -> str:
        """Name of the parameter that sets r."""
        return self.problem.engine.names[1]

    @property
    def is_ratio(self) -> bool:
        """Whether the damper is a damping ratio, next to a time constant."""
        return self.damper == "dampratio" or self.one.get("solref", (0.0,))[0] > 0

    @property
    def diverges(self) -> bool:
        """Whether the damper reverses the speed within an explicit step."""
        longest = self.step * max(1.0, self.steps / MOST_STEPS)
        explicit = isinstance(self.problem.engine.scheme, SemiImplicit) and not self.is_ratio
        return explicit and float(self.law.damping) * longest > 1

    def outcome(self, *trials: Trials) -> Outcome:
        """Return the outcome of the contact."""
        return self.problem.outcome(self.law, self.step, *trials)

    def damped(self, value: float) -> "Contact":
        """Return the contact with another damping of the first body."""
        number: Any = value
        if self.damper == "solref":
            number = (self.one["solref"][0], math.copysign(value, self.one["solref"][0]))
        return replace(self, one={**self.one, self.damper: number})


@dataclass(frozen=True)
class Behaviour:
    """Behaviour of a contact.

    Attributes
    ----------
    outcome : Outcome
    limit, free
        r in the limit of short steps, and the same without gravity.
    stiffness, damping_ratio
        Of all points together, in N/m; NaN if the contact has no spring with a constant k.
    """

    outcome: Outcome
    limit: float
    free: float
    stiffness: float
    damping_ratio: float


def diagnose_spring(
    bounce: Bounce,
    engine: Engine,
    parameters: Mapping[str, Any],
    time_step: Quantity,
    other: Mapping[str, Any] | None = None,
) -> Answer:
    """Return the bounce of a stiffness and a damping, and the least change for the one wanted.

    Raises
    ------
    Refused
        If a parameter or the step is missing, unknown or out of its range.
    """
    # The mass is looked at first.
    problem = Problem(bounce, engine)
    has_friction = bounce.friction is not None and "friction" in engine.rules
    rubs = {"friction": bounce.friction} if has_friction else {}
    refuse(
        [
            (
                other is not None and all(rule is PAIR for rule in engine.rules.values()),
                f"{engine.name} {OF_PAIR}",
            )
        ]
    )
    given = _given(engine, {**rubs, **parameters})
    differs = None if other is None else _given(engine, other, is_other=True)
    refuse(
        [
            (
                time_step is None,
                "the time step is missing: --time-step '2 ms' or time_step='2 ms'",
            )
        ]
    )
    given = _converted(engine, given, problem.setting(bounce.step(time_step)))
    contact = Contact(
        problem=problem,
        one={**engine.defaults, **given},
        other=None if differs is None else {**engine.defaults, **differs},
        step=bounce.step(time_step),
    )
    spring = _spring(contact.law)
    behaviour = Behaviour(
        outcome=contact.outcome(),
        limit=_in_short_steps(contact, bounce.gravity),
        free=_in_short_steps(contact, 0.0),
        stiffness=float(spring.stiffness) * bounce.mass,
        damping_ratio=float(spring.damping / spring.stiffness**0.5 / 2),
    )
    wanted = bounce.restitution
    lost = problem.lost * (behaviour.outcome.depth[1] > problem.deepest)
    change = None
    is_off = wanted is not None and behaviour.outcome.restitution.deviation(wanted) > TOLERANCE
    meant = _guesses(contact, behaviour) if is_off and not lost else []
    causes = [] if lost else [*_friction(contact, behaviour), *_causes(contact, behaviour)]
    of_r = [*_dangers(contact, behaviour), *meant, *causes]
    if is_off and not lost:
        change = _least_change(contact)
        if change is None or change.time_step != contact.step:
            of_r.append(
                f"no damping of this contact keeps r within {TOLERANCE:g} at this step; 'bounce "
                f"design' may have a contact that does; the nearest: {_nearest(contact).gives}"
            )
    return Answer(
        engine=engine.name,
        ran=ran_in(engine),
        bounce=bounce,
        time_step=contact.step,
        parameters=contact.one,
        outcome=behaviour.outcome,
        warnings=(*of_r, *_facts(contact, behaviour)),
        remarks=tuple(_remarks(contact, behaviour, given, differs)),
        change=change,
        lost=lost,
        numbers={
            name: value
            for name, value in {
                "stiffness": behaviour.stiffness,
                "damping_ratio": behaviour.damping_ratio,
                "limit": behaviour.limit,
                "free": behaviour.free,
            }.items()
            if not math.isnan(value)
        },
    )


def _remarks(
    contact: Contact, behaviour: Behaviour, given: Parameters, differs: Parameters | None
) -> list[str]:
    """Return what was given and assumed, and what else is known of a contact."""
    engine = contact.problem.engine
    bounce = contact.problem.bounce
    defaults = {name: engine.defaults[name] for name in engine.defaults if name not in given}
    others = differs or {}
    rest = {name: engine.defaults[name] for name in engine.defaults if name not in others}
    of_body = ", ".join(f"{name} {value}" for name, value in bounce.given.items())
    of_other = f"of the other body {_assigned(others) or 'the defaults'}"
    known = [_assigned(given), of_other * (differs is not None), of_body]
    assumed = holding(
        [
            (defaults, f"the defaults {_assigned(defaults)}"),
            (others and rest, f"of the other body the defaults {_assigned(rest)}"),
            *((True, assumption) for assumption in bounce.assumed),
        ]
    )
    rests, hops = contact.problem.at_rest(contact.law, contact.step, behaviour.outcome)
    return holding(
        [
            (
                math.isfinite(behaviour.stiffness),
                f"The contact has k = {show(behaviour.stiffness, 'N/m')} and a damping ratio of "
                f"{behaviour.damping_ratio:.3g}; in short steps r is {behaviour.limit:.3f}",
            ),
            (rests and not hops, rests[:1].upper() + rests[1:]),
            *((True, note) for note in engine.notes),
            (bounce.points > 1 and engine.box, engine.box),
            (
                bounce.restitution is None,
                "With --restitution there is a least change, for the r that is wanted",
            ),
            (True, f"Given: {'; '.join(filter(None, known))}"),
            (assumed, f"Assumed: {'; '.join(assumed)}"),
        ]
    )


def _given(engine: Engine, typed: Mapping[str, Any], is_other: bool = False) -> dict[str, Any]:
    """Return the parameters that were typed for a body as numbers, by their names in the engine.

    The other body has none of the pair.

    Raises
    ------
    Refused
        If a name is unknown, missing or given twice, or a value is no number or out of its range.
    """
    known = [
        *(name for name, rule in engine.rules.items() if not (is_other and rule is PAIR)),
        *engine.spring,
    ]
    raw = parameters_of(
        engine.name + is_other * ", the other body",
        {as_compared(name): name for name in known},
        known,
        typed,
    )
    given = {name: _value(engine, name, value) for name, value in raw.items()}
    body = {**engine.defaults, **given}
    missing = [name for name in engine.rules if name not in body]
    refuse(
        [
            (
                missing,
                f"{''.join(missing[:1])} is missing: give {' and '.join(missing)}; {engine.name} "
                "has no default",
            ),
            (
                engine.name == "pybullet" and len(given.keys() & set(engine.names)) == 1,
                f"{engine.name} refuses {' or '.join(engine.names)} alone: give both",
            ),
        ]
    )
    return given


def _converted(engine: Engine, given: dict[str, Any], at: Setting) -> dict[str, Any]:
    """Return parameters with a spring and a damper as the engine has them at a step."""
    springs = given.keys() & set(engine.spring)
    both = " and ".join(engine.spring)
    refuse(
        [
            (
                springs and len(given) != 2 or len(springs) == 1,
                f"give {both}, and nothing beside them",
            )
        ]
    )
    if not springs:
        return given
    k, c = (np.asarray(given[name] * at.points / at.mass) for name in engine.spring)
    return engine.write(Linear(k, c), at)


def _value(engine: Engine, name: str, value: Any) -> Any:
    """Return a parameter as a number, as several numbers or as a word."""
    if name in _WORDS:
        word = one_of(name, f"{value:g}" if isinstance(value, float) else value, _WORDS[name])
        return float(word) if word.isdigit() else word
    if name in _VECTORS:
        value = _vector(name, value)
        # Of several numbers of friction the first one acts along the surface.
        return value if name != "friction" else within(name, value[0], 0, math.inf)
    number = in_si(name, value, engine.units.get(name, ""))
    if number == engine.defaults.get(name):
        return number
    if name == "min_depth":
        raise Refused(f"min_depth = {value} is not computed: a min_depth above 0 lowers r")
    if number == 0 and name in (engine.names[0], *engine.spring[:1], *_DIVISORS):
        raise Refused(f"{name} = 0 is not computed: give a small number")
    return within(name, number, 0, 1 if name in _SHARES else math.inf)


def _vector(name: str, value: Any) -> tuple[float, ...]:
    """Return the numbers of a text, which may have brackets, commas or quotes."""
    if isinstance(value, str):
        value = re.findall(r"[^\s,()\[\]\"']+", value)
    numbers = tuple(in_si(name, number, "") for number in np.atleast_1d(np.asarray(value, object)))
    least, most, words = _VECTORS[name]
    refuse([(not least <= len(numbers) <= most, f"{name} has {words}, not {len(numbers)}")])
    if name != "solref":
        return numbers
    first, second = numbers + ENGINES["mujoco"].defaults["solref"][len(numbers) :]
    # Numbers that lack their signs, such as 20000 86, would be a time constant of hours.
    is_either = (first < 0 and second <= 0) or (0 < first <= 1 and second > 0)
    neither = (
        f"solref = '{first:g} {second:g}' is neither two negative numbers, -k/m and -c/m, such as "
        f"'{-abs(first):g} {-abs(second):g}', nor a time constant up to 1 s and a damping ratio, "
        "both positive"
    )
    refuse([(not is_either, neither)])
    return first, second


def _spelled(value: Any) -> str:
    """Return a value as it is typed."""
    if isinstance(value, tuple):
        return f'"{" ".join(map(_spelled, value))}"'
    return value if isinstance(value, str) else f"{value:g}"


def _assigned(values: Parameters) -> str:
    return ", ".join(f"{name} = {_spelled(value)}" for name, value in values.items())


def _spring(law: Law) -> Law:
    """Return the spring and the damper of a law; they are NaN if it has others."""
    if isinstance(law, Impedance):
        return law.deep
    if not isinstance(law, Linear):
        return Linear(np.asarray(math.nan), np.asarray(math.nan))
    return Linear(law.stiffness, law.damping)


def _in_short_steps(contact: Contact, gravity: float) -> float:
    """Return r of the spring and the damper alone, in the limit of short steps.

    Extrapolate from a step and its half, because the error of r is proportional to the step. Steps
    are semi-implicit also for implicit engines, because their error is smaller.
    """
    law = contact.law
    law = _spring(law) if isinstance(law, Linear) else law
    speed = contact.problem.bounce.impact_speed
    step = np.minimum(law.duration(speed) / SHORT_STEPS, contact.step)
    scheme = contact.problem.engine.scheme
    explicit = scheme if isinstance(scheme, SemiImplicit) else SemiImplicit()
    # A damper may be too strong for explicit steps.
    for integrator in (explicit, scheme):
        whole, half = drop(law, integrator, step, speed, gravity, _BOTH).restitution.reshape(2, -1)
        if max(whole.mean(), half.mean()) <= 1 + TOLERANCE:
            break
    return max(float(2 * half.mean() - whole.mean()), 0.0)


def _causes(contact: Contact, behaviour: Behaviour) -> Iterator[str]:
    """Yield what changes r visibly, by taking away one thing after another."""
    row = contact.problem.engine
    # MuJoCo's impedance is a part of its spring, and stays.
    designed = {name: value for name, value in row.beside.items() if name != "solimp"}
    without = []
    for name, value in designed.items():
        what = _assigned({name: contact.one[name]})
        other = contact.other and {**contact.other, name: value}
        contact = replace(contact, one={**contact.one, name: value}, other=other)
        instead = f"; {_WHY.get(name, '')}designs have {_spelled(value)}"
        without.append((what, contact.outcome().restitution.mean, instead))
    without += [
        ("the step", behaviour.limit, ""),
        ("gravity during the contact", behaviour.free, ""),
    ]
    r = behaviour.outcome.restitution.mean
    for what, less, instead in without:
        if abs(r - less) > _VISIBLE:
            how = "lowers" if r < less else "raises"
            yield f"{what} {how} r from {less:.3f} to {r:.3f}{instead}"
        r = less


def _dangers(contact: Contact, behaviour: Behaviour) -> list[str]:
    """Return what makes a contact useless in a scene."""
    bounce = contact.problem.bounce
    high = behaviour.outcome.restitution.high
    law = contact.law
    typed = contact.one.get("solimp", ())
    ends = (law.low, law.high) if isinstance(law, Impedance) else ()
    is_clipped = any(not 0 <= impedance <= 1 for impedance in typed[:2])
    is_wide = isinstance(law, Impedance) and law.low != law.high and law.width > bounce.size
    return holding(
        [
            (
                is_clipped,
                f"the impedances of solimp = {_spelled(typed)} are shares from 0 to 1: the engine "
                f"takes {' and '.join(f'{impedance:.4f}' for impedance in ends)}",
            ),
            (
                is_wide,
                f"the third number of solimp, {_spelled(typed)}, is a depth in m, and the body has "
                f"a {bounce.size_name} of {show(bounce.size, 'm')}",
            ),
            (
                high > 1 + TOLERANCE,
                f"unstable: the body leaves up to {high:.3g} times as fast as it came",
            ),
            (
                behaviour.outcome.depth[1] > bounce.size,
                f"it sinks deeper than its {bounce.size_name} of {show(bounce.size, 'm')}",
            ),
        ]
    )


def _friction(contact: Contact, behaviour: Behaviour) -> list[str]:
    """Return by how much friction changes r in MuJoCo."""
    law = contact.law
    if not isinstance(law, Impedance):
        return []
    # Of a friction pyramid without friction, and of an elliptic cone.
    smooth, cone = (
        contact.problem.outcome(replace(law, edges=edges), contact.step, _MEAN).restitution.mean
        for edges in (0.0, 1.0)
    )
    solimp = _spelled(contact.problem.engine.beside.get("solimp", ""))
    changes = max(abs(smooth - cone), abs(smooth - behaviour.outcome.restitution.mean))
    said = (
        f"friction changes r: r is {smooth:.3f} with the pyramidal cone and no friction, and "
        f"{cone:.3f} with the elliptic cone at every friction; with the solimp of designs, "
        f"{solimp}, friction does not change r"
    )
    return holding([(changes > _VISIBLE, said)])


def _facts(contact: Contact, behaviour: Behaviour) -> list[str]:
    """Return further warnings."""
    row = contact.problem.engine
    rests, hops = contact.problem.at_rest(contact.law, contact.step, behaviour.outcome)
    time = contact.combined.get("timeconst", contact.combined.get("solref", (0.0,))[0])
    raised = max(time, 2 * contact.step)
    return holding(
        [
            (
                contact.steps < _FEW,
                f"a contact takes {contact.steps:.2g} steps: r depends on where in a step it "
                "begins",
            ),
            (
                0 < time < raised and contact.combined.get("refsafe", True),
                f"{row.name} raises the time constant of {time:g} s to {raised:g} s, two steps",
            ),
            (
                behaviour.damping_ratio >= 1,
                f"the damping ratio of {behaviour.damping_ratio:.3g} is that of a contact without "
                "oscillation",
            ),
            (hops, rests),
        ]
    )


def _guesses(contact: Contact, behaviour: Behaviour) -> list[str]:
    """Return what the numbers may have been meant to be: r would then be the wanted one."""
    row = contact.problem.engine
    bounce = contact.problem.bounce
    wanted = bounce.restitution
    # The numbers of solref are 1/s² and 1/s, if they are not a time constant and a ratio.
    units_of = {**row.units, "solref": "" if contact.is_ratio else "1/s"}
    divided = {
        name: np.divide(contact.one[name], bounce.mass)
        for name in row.names
        if units_of.get(name) in ("1/s", "1/s^2")
    }
    r = replace(contact, one={**contact.one, **divided}).outcome().restitution.mean
    ratio = min(behaviour.damping_ratio, 1 - 1e-9)
    pulled = math.exp(-math.pi * ratio / math.sqrt(1 - ratio**2))
    guesses = [
        (
            abs(r - wanted) < TOLERANCE <= abs(behaviour.outcome.restitution.mean - wanted),
            f"{' and '.join(divided)} is per unit of mass in {row.name}: divided by "
            f"{bounce.mass:g} kg, r is {r:.3f}",
        ),
        (
            # A formula is followed to two digits.
            abs(behaviour.free - wanted) >= TOLERANCE and abs(pulled - wanted) < 0.005,
            "this damping is that of a contact whose damper pulls until the end, "
            f"r = exp(-πζ/√(1 - ζ²)); in {row.name} it ends earlier",
        ),
    ]
    return holding(guesses)


def _nearest(contact: Contact) -> Answer:
    """Return the damping with which the mean r is nearest to the wanted one at this step.

    Bisect: a damping lowers r, and a share raises it.
    """
    raises = contact.damper in _SHARES
    bounce = contact.problem.bounce
    target = max(bounce.restitution, LEAST_RESTITUTION)
    # Ratios beyond these are springs that throw the body away, or hardly act.
    low, high = (1e-3, 1e2) if contact.is_ratio else (1e-12, 1.0 if raises else 1e12)

    def is_beyond(place: int) -> bool:
        tried = contact.damped(low * _FINE**place)
        drops = contact.problem.drops(tried.law, contact.step, _MEAN)
        is_above = not tried.diverges and bool(drops.mean > target)
        return is_above == raises

    count = math.floor(math.log(high / low, _FINE))
    place = bisect_left(range(count), True, key=is_beyond)
    # The least damping is as good as none, but no ratio is 0.
    is_some = place > 0 or contact.is_ratio
    nearest = contact.damped(float(f"{low * _FINE**place:.4g}") if is_some else 0.0)
    # A spring in N/m is replaced by both parameters, because nothing is given beside it.
    changed = {
        name: nearest.one[name]
        for name in contact.problem.engine.names
        if name == contact.damper or contact.problem.engine.spring
    }
    outcome = nearest.outcome()
    return Answer(
        engine=contact.problem.engine.name,
        ran=ran_in(contact.problem.engine),
        bounce=bounce,
        time_step=contact.step,
        parameters=changed,
        outcome=outcome,
        gives=f"{_assigned(changed)} at {show(contact.step, 's')} gives r = {outcome.restitution}",
    )


def _least_change(contact: Contact) -> Answer | None:
    """Return the damping that keeps r within the tolerance, at the longest step that has one."""
    deviations: list[float] = []
    for halvings in range(12):
        change = _nearest(replace(contact, step=contact.step / 2**halvings))
        wanted = contact.problem.bounce.restitution
        deviations.append(change.outcome.restitution.deviation(wanted))
        if deviations[-1] <= TOLERANCE:
            return change
        # If a quarter of a step that is short does not help, shorter ones do not.
        is_short = contact.steps * 2**halvings > _FEW
        if halvings > 1 and is_short and deviations[-1] > 0.9 * deviations[-3]:
            break
    return None

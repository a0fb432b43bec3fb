"""The question and its answer, as frozen dataclasses in SI units."""

from collections.abc import Sequence
from dataclasses import dataclass

from bouncing_ball.calculator.case import Case
from bouncing_ball.calculator.family import Family, family
from bouncing_ball.calculator.judgement import Judgement
from bouncing_ball.calculator.needed import Needed
from bouncing_ball.contacts.permanent_contact import RESTITUTION_THRESHOLD
from bouncing_ball.contacts.release import Release
from bouncing_ball.errors import NoOrbitError
from bouncing_ball.orbits.spring_damper_model import SpringDamperModel

STEPS = 50
"""Steps in one contact."""
STEP_RULE = (
    f"a contact takes {STEPS} steps, the default of MFiX-Exa (mfix.tcoll_ratio = {STEPS}) and the "
    "step of MercuryDPM's tutorials"
)
# Families looked at if none is asked for: as many as the paper shows, and some more.
_FAMILIES = 8


@dataclass(frozen=True)
class Corrected:
    """The three numbers of the corrected restitution model, in SI units.

    The impact is an instant t_c = ``delay`` after the ball touches, with the
    restitution ``r + σ a/v``: σ = ``load`` is a time, a the acceleration that
    presses the ball to the table and v the impact speed.
    """

    delay: float
    restitution: float
    load: float


@dataclass(frozen=True)
class TimeStep:
    """The largest time step that resolves the contact, in s, and where the rule is from."""

    largest: float
    rule: str


@dataclass(frozen=True)
class PermanentContact:
    """Λ up to which the ball stays down, in the contact and in the restitution model.

    None of a Hertz contact, whose stiffness at rest is that of its static deflection.
    """

    threshold: float | None
    restitution_threshold: float
    margin: float | None
    """Share by which Λ may fall to the threshold; below zero the ball may stay down."""


@dataclass(frozen=True)
class Design:
    """What an engineer needs to know of a contact; times in s, lengths in m, forces in N.

    ``frequency_ratio``, ``damping_ratio`` and ``amplitude`` are ϖ, ζ and Λ;
    ``restitution`` is that of a free impact by the release rule.
    """

    frequency_ratio: float
    damping_ratio: float
    amplitude: float
    contact_time: float
    stiffness: float
    damping: float
    static_deflection: float
    restitution: dict[str, float]
    corrected: Corrected
    time_step: TimeStep
    permanent_contact: PermanentContact
    orbits: tuple[Family, ...]
    needed: Needed
    is_good_enough: bool
    verdict: str
    reason: str
    notes: tuple[str, ...]
    case: Case
    n: int
    """The family of the verdict."""


def families(case: Case, n: int | None) -> tuple[Family, ...]:
    """The family asked for, or all of the first few that some model has.

    Raises
    ------
    NoOrbitError
        If no model has any of them, with the acceleration that the lowest needs.
    """
    asked: Sequence[int] = range(1, _FAMILIES + 1) if n is None else (n,)
    of, lam = case.models(), case.table.amplitude
    # Below all their saddle-nodes no model has an orbit, and the search for it is saved.
    reached = (k for k in asked if any(not m.saddle_node(k).amplitude > lam for m in of.values()))
    found = tuple(
        one
        for one in (family(case, k) for k in reached)
        if any(standing.exists for standing in one.standing.values())
    )
    if not found:
        model = next(iter(of.values()))
        lowest = float(model.saddle_node(asked[0]).amplitude)
        which = f"{n}-T orbit" if n else "n-T orbit"
        raise NoOrbitError(
            f"no {which} in any model: the table's acceleration is Λ = "
            f"{case.table.amplitude:.4g} of gravity, and the {asked[0]}-T orbit needs {lowest:.4g}"
        )
    return found


def judged(found: Sequence[Family]) -> Family:
    """The family that a verdict is about: the first stable one, or the first there is."""
    steady = [one for one in found if one.exists and one.is_stable and one.is_admissible]
    return (steady or [one for one in found if one.exists] or list(found))[0]


def _notes(case: Case, one: Family) -> tuple[str, ...]:
    notes = []
    if one.exists and not (one.is_stable and one.is_admissible):
        what = "unstable" if one.is_admissible else "inadmissible: another impact comes first"
        notes.append(f"the {one.n}-T orbit is {what}, and no ball will keep to it")
    contact = case.contact
    if float(contact.frequency_ratio) < 1:
        notes.append("the contact is slower than the table: no impact, but a ball on a spring")
    linear = case.law is None
    if linear and case.release is Release.DISPLACEMENT and float(contact.damping_ratio) > 0:
        notes.append(
            "the contact pulls before it is released at δ = 0; one that cannot pull has the other r"
        )
    return tuple(notes)


def _permanent_contact(case: Case) -> PermanentContact:
    if case.law is not None:
        return PermanentContact(None, RESTITUTION_THRESHOLD, None)
    threshold = float(SpringDamperModel(case.contact).permanent_contact_threshold())
    return PermanentContact(threshold, RESTITUTION_THRESHOLD, 1 - threshold / case.table.amplitude)


def describe(
    case: Case,
    found: tuple[Family, ...],
    one: Family,
    need: Needed,
    verdict: Judgement,
    notes: Sequence[str],
) -> Design:
    """Everything about a contact that is known; `one` is the family of the verdict."""
    contact, table = case.contact, case.table
    instant = case.instant(one.n)
    others = {str(rule): type(contact)(1.0, contact.damping_ratio, rule) for rule in Release}
    return Design(
        frequency_ratio=float(contact.frequency_ratio),
        damping_ratio=float(contact.damping_ratio),
        amplitude=table.amplitude,
        contact_time=case.contact_time,
        stiffness=case.stiffness,
        damping=case.damping,
        static_deflection=case.static_deflection,
        restitution={rule: float(other.restitution) for rule, other in others.items()},
        corrected=Corrected(
            delay=float(instant.delay) * table.time,
            restitution=float(instant.restitution),
            load=float(instant.load) * table.time,
        ),
        time_step=TimeStep(case.contact_time / STEPS, STEP_RULE),
        permanent_contact=_permanent_contact(case),
        orbits=found,
        needed=need,
        is_good_enough=verdict.is_good_enough,
        verdict=verdict.sentence,
        reason=verdict.reason,
        notes=(*notes, *_notes(case, one)),
        case=case,
        n=one.n,
    )

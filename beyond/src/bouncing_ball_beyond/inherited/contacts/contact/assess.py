"""The first question: is a restitution coefficient good enough for a contact on a table?

The contact is the truth: the error of a model is its deviation from the contact,
``(q - q_SD)/q_SD`` with the value q_SD on the contact
(:func:`~bouncing_ball_beyond.accuracy.errors.deviation`).
"""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Annotated, ClassVar

from bouncing_ball_beyond.accuracy.errors import OF_ORBITS
from bouncing_ball_beyond.inherited.contacts.contact.choose import Choice
from bouncing_ball_beyond.inherited.contacts.contact.contact import Contact
from bouncing_ball_beyond.inherited.contacts.contact.describe import require_short
from bouncing_ball_beyond.inherited.contacts.contact.families import ComparedOrbit, families
from bouncing_ball_beyond.inherited.contacts.contact.judgement import (
    MotionJudgement,
    OrbitJudgement,
)
from bouncing_ball_beyond.inherited.contacts.contact.motion import FinalMotion, of_family
from bouncing_ball_beyond.inherited.contacts.contact.needed import Needed, finite, needed
from bouncing_ball_beyond.inherited.contacts.contact.notes import notes
from bouncing_ball_beyond.inherited.contacts.contact.numbers_of_contact import NumbersOfImpact
from bouncing_ball_beyond.inherited.contacts.contact.quantities import check_kinds
from bouncing_ball_beyond.inherited.contacts.contact.question import Question
from bouncing_ball_beyond.inherited.contacts.contact.remarks import remarks
from bouncing_ball_beyond.inherited.contacts.contact.resolve import resolve
from bouncing_ball_beyond.inherited.contacts.contact.resolved import ResolvedContact
from bouncing_ball_beyond.inherited.contacts.contact.rows import Listed
from bouncing_ball_beyond.inherited.contacts.contact.starts import (
    FEW,
    SharesOfStarts,
    ends_of_starts,
)
from bouncing_ball_beyond.inherited.contacts.contact.table import Table
from bouncing_ball_beyond.inherited.contacts.contact.verdict import (
    Sentences,
    aside,
    headline,
    judged_choice,
    said_of_motion,
    said_of_orbit,
)
from bouncing_ball_beyond.inherited.errors import ModelError, NoOrbitError, require, suggesting
from bouncing_ball_beyond.models.damping import LINEAR

STEPS = 50
"""Time steps in one contact, for the rule of the largest time step."""

STEP_RULE = f"a contact takes {STEPS} steps, the default of MFiX-Exa (mfix.tcoll_ratio)"
# Beyond this limit the square of ϖ leaves no digits. The other calls have the same limit.
_LARGEST = 1e8


@dataclass(frozen=True)
class LargestTimeStep:
    """The largest time step that resolves the contact, in s, and the rule that it follows from."""

    largest: Annotated[float, Listed("largest time step", "s")]
    rule: str


@dataclass(frozen=True)
class Corrected:
    """The three numbers of the corrected restitution model, in SI units.

    The impact is instantaneous and happens t_c = ``delay`` after the ball touches the table. Its
    restitution coefficient is ``r + σ a/v``, where σ = ``load`` is a time, a the acceleration that
    presses the ball to the table and v the impact speed.
    """

    delay: float
    restitution: float
    load: float


@dataclass(frozen=True, repr=False)
class Assessment(NumbersOfImpact):
    """The assessment of a contact on a table; times are in s, lengths in m, forces in N.

    Those of the contact are read from ``case``. ``restitution`` has the r of a free impact for each
    release rule, of a law for its rule only. ``n`` is the family of the verdict. ``chosen`` is the
    family for which the contact was chosen, None for a contact that was given. ``no_orbit`` says
    that no model has an orbit; it is empty if one has. ``hint`` is what may have been meant in that
    case.
    """

    KEYS: ClassVar[tuple[str, ...]] = (
        "frequency_ratio", "damping_ratio", "amplitude", "stiffness", "damping", "contact_time",
        "time_step", "static_deflection", "restitution", "measured_restitution", "slowed_speed",
        "permanent_contact", "law", "corrected", "orbits", "needed", "motion", "headline",
        "is_good_enough", "verdict", "reason", "starts", "notes", "case", "n",
    )  # fmt: skip

    time_step: LargestTimeStep
    corrected: Corrected
    orbits: tuple[ComparedOrbit, ...]
    needed: Needed
    motion: FinalMotion
    case: ResolvedContact
    n: int
    ends: SharesOfStarts
    chosen: int | None = None
    no_orbit: str = ""
    hint: str = ""

    def __repr__(self) -> str:
        """The verdict, and no numbers, of which there are hundreds."""
        good = self.is_good_enough
        return f"Assessment(n={self.n}, is_good_enough={good}, verdict={self.verdict!r})"

    @property
    def amplitude(self) -> Annotated[float, Listed("table's acceleration over gravity, Λ")]:
        """Λ."""
        return self.case.table.amplitude

    @property
    def static_deflection(self) -> Annotated[float, Listed("static deflection", "m")]:
        """How deep the ball lies at rest, in m."""
        return self.case.static_deflection

    @property
    def restitution(self) -> dict[str, float | None]:
        """r of a free impact for each release rule; None for the rule that a law does not have."""
        contact = self.case.equivalent
        if self.case.is_linear:
            return {str(rule): float(replace(contact, release=rule).restitution) for rule in LINEAR}
        at_surface = contact.release.at_surface
        r = float(contact.restitution)
        return {str(rule): r if rule.at_surface == at_surface else None for rule in LINEAR}

    @property
    def permanent_contact(self) -> Annotated[float | None, Listed("permanent contact up to Λ")]:
        """Λ up to which a ball may stay on the table; None if no such threshold was found."""
        return finite(self.case.permanent_contact)

    @property
    def judged(self) -> ComparedOrbit:
        """The result for the family of the verdict."""
        return next(one for one in self.orbits if one.n == self.n)

    @cached_property
    def on_orbit(self) -> OrbitJudgement:
        """The judgement by the orbit of the family of the verdict."""
        return OrbitJudgement(self.judged, self.needed)

    @cached_property
    def on_motion(self) -> MotionJudgement | None:
        """The judgement by the motion on which a ball ends; None where the orbit is judged."""
        # A threshold, such as that of permanent contact, is not a property of one orbit.
        if self.needed.quantity not in OF_ORBITS or self.motion.restitution_kind is None:
            return None
        share = self.ends.of_orbit(self.n) if self.motion.is_common else None
        return MotionJudgement(self.motion, self.needed.tolerance, self.n, share, self.amplitude)

    @property
    def is_good_enough(self) -> bool:
        """Whether the restitution model is good enough; for a chosen contact on its motion."""
        if self.on_motion is not None:
            return self.on_motion.is_good_enough
        return self.chosen is not None or self.on_orbit.is_good_enough

    @cached_property
    def _said(self) -> Sentences:
        """The judgement in words, or the contact that was chosen."""
        if self.chosen is None:
            case = self.case
            found = said_of_orbit(self.on_orbit, case.equivalent.linear, case.integrated_law)
        else:
            found = judged_choice(self.case, self.needed, self.chosen)
        if self.on_motion is not None:
            end = said_of_motion(self.on_motion)
            before = "" if self.chosen is None else f"{found.verdict} "
            return Sentences(before + end.verdict, self.no_orbit or end.reason)
        if self.needed.quantity not in OF_ORBITS:
            return found
        also = aside(self.motion, self.amplitude)
        return found._replace(verdict=f"{found.verdict[:-1]}{also}.")

    @property
    def verdict(self) -> str:
        """The verdict on the restitution model, or the contact that was chosen, in a sentence."""
        return self._said.verdict

    @property
    def reason(self) -> str:
        """The reason of the verdict, and what may have been meant if no model has an orbit."""
        exists = any(each.exists for each in self.judged.standing.values())
        why = self._said.reason
        return why if exists or not self.hint else f"{why}; {self.hint}"

    @property
    def headline(self) -> str:
        """The motion of the ball, in one sentence."""
        return headline(self.motion, self.judged, self.ends.of_orbit(self.n))

    @property
    def starts(self) -> dict[str, float]:
        """The shares of an even grid of starts that end on each motion, the greatest first."""
        return self.ends.by_text

    @property
    def notes(self) -> tuple[str, ...]:
        """Sentences that a user should read in addition to the verdict."""
        return remarks(self.case) + notes(self.case, self.judged, self.motion)


@suggesting
def assess_contact(table: Table, contact: Contact, question: Question | None = None) -> Assessment:
    """Whether the restitution model is good enough for a contact on a vibrating table.

    The tolerance and all errors of the answer are relative to the values on the contact; those of
    the paper, and of :func:`bouncing_ball_beyond.error_thresholds`, are relative to the restitution
    model.

    Parameters
    ----------
    table : Table
    contact : Contact
        With its stiffness and its loss, or the parameters of a physics engine.
    question : Question, optional
        By default the greatest height within 1 %, of the first family with a stable orbit.

    Raises
    ------
    ModelError
        If a parameter is missing, out of range or contradicts another.
    NoOrbitError
        If no model has the orbit of the ``n`` that is asked for.

    Examples
    --------
    >>> found = assess_contact(
    ...     Table(frequency="50 Hz", acceleration="0.8 g"),
    ...     Contact(mass="20 g", stiffness="1e7 N/m", restitution=0.85),
    ...     Question(tolerance="5 %"),
    ... )
    >>> found.n, found.is_good_enough, round(found.judged.errors["max_height"], 4)
    (1, True, 0.0122)
    """
    asked = Question() if question is None else question
    of = {"table": (table, Table), "contact": (contact, Contact), "question": (asked, Question)}
    check_kinds("assess_contact", **of)
    with table.hinting():
        found = assess(resolve(contact, table.motion, asked.families), asked)
    return replace(found, hint=table.hint)


def assess(case: ResolvedContact, question: Question, choice: Choice | None = None) -> Assessment:
    """The assessment of a contact on a table that moves, or with ``choice`` of the one chosen.

    If no model has an orbit and no n is asked for, it is about a ball laid on the table.

    Raises
    ------
    ModelError
        If ζ ≥ 1, or a number is beyond what is computed.
    NoOrbitError
        If no model has the orbit of the ``n`` that is asked for.
    """
    contact = case.equivalent
    amplitude = case.table.amplitude
    ratio = float(contact.frequency_ratio)
    only = "below 1: on a vibrating table only underdamped contacts are computed"
    require(contact.damping_ratio < 1, contact.damping_ratio, "damping ratio ζ", only)
    require_short(case.contact_time)
    if amplitude > case.effort.amplitude:
        raise ModelError(
            f"Λ = {amplitude:g} is above {case.effort.amplitude:g}, up to which a contact law "
            "is followed: give a lower acceleration, or a spring and a damper, which are faster"
        )
    if not 1 / _LARGEST < ratio < _LARGEST:
        raise ModelError(
            f"ϖ = {ratio:.4g}, the natural frequency of the contact over that of the table, is not "
            f"between {1 / _LARGEST:g} and {_LARGEST:g}: check the units of both"
        )
    no_orbit = ""
    try:
        found = families(case, question.families)
    except NoOrbitError as error:
        if question.n is not None:
            raise
        choice = None
        no_orbit = str(error)
        found = families(case, question.families, or_first=True)
    ends = ends_of_starts(case)
    one = _judged(found, choice, None if question.n is not None else ends)
    is_rare = question.n is None and one.attracts and ends.of_orbit(one.n) < FEW
    if choice is None:
        need = needed(question.quantity, question.tolerance, contact.linear, one.n, amplitude)
    else:
        need = choice.needed
    signature = case.instant(one.n)
    return Assessment(
        time_step=LargestTimeStep(case.contact_time / STEPS, STEP_RULE),
        corrected=Corrected(
            delay=float(signature.delay) * case.table.time,
            restitution=float(signature.restitution),
            load=float(signature.load) * case.table.time,
        ),
        orbits=found,
        needed=need,
        motion=of_family(case, one, ends.first if is_rare else None),
        case=case,
        n=one.n,
        ends=ends,
        chosen=None if choice is None else choice.n,
        no_orbit=no_orbit,
    )


def _judged(
    found: tuple[ComparedOrbit, ...], choice: Choice | None, ends: SharesOfStarts | None
) -> ComparedOrbit:
    """The family of the verdict: that of the choice, or the first whose orbit is stable and
    admissible, and on which not few balls end, or else is stable, or exists.
    """

    def rank(one: ComparedOrbit) -> tuple[bool, ...]:
        is_common = ends is None or ends.of_orbit(one.n) >= FEW
        return one.exists, one.attracts, one.attracts and is_common

    first = max(found, key=rank)
    if choice is None:
        return first
    return next((each for each in found if each.n == choice.n), first)

"""The results of the calculator; each is defined once, with its description and its unit.

JSON has all results under their names; the text and the page list those with a description.
"""

from abc import ABC, abstractmethod
from dataclasses import dataclass, is_dataclass, replace
from typing import Annotated, Any, NamedTuple, get_type_hints

from bouncing_ball.beyond.calculator.case import Case
from bouncing_ball.beyond.calculator.units import shown
from bouncing_ball.beyond.engines.choice import engine_named
from bouncing_ball.beyond.engines.engine import EngineSettings, Physical
from bouncing_ball.paper.orbits.stability import Bifurcation

Errors = dict[str, float | None]
"""Relative errors by quantity; None where one of the values does not exist, or the simple one is
zero."""


class Row(NamedTuple):
    """How a result is listed: its description, and its unit for :func:`~.units.shown`."""

    words: str
    unit: str = ""


def rows(result: Any) -> list[tuple[str, str]]:
    """Description and value, as texts, of each result that is listed, including nested results.

    Examples
    --------
    >>> rows(TimeStep(2e-6, "a rule"))
    [('largest time step', '2 µs')]
    """
    found = []
    for name, hint in get_type_hints(type(result), include_extras=True).items():
        value = getattr(result, name)
        values = value.values() if isinstance(value, dict) else [value]
        for row, each in zip(getattr(hint, "__metadata__", ()), values, strict=False):
            text = ("no", "yes")[each] if isinstance(each, bool) else shown(each, row.unit)
            found.append((row.words, text))
        found += rows(value) if is_dataclass(value) else []
    return found


@dataclass(frozen=True)
class Standing:
    """The place of a case in its family, in one model.

    ``saddle_node`` and ``period_doubling`` are the Λ of the bifurcations. The margins are relative
    changes of Λ: ``1 - Λ_SN/Λ`` is the fall down to the saddle-node, and ``Λ_PD/Λ - 1`` the rise
    up to the period doubling. They are None if there is no such bifurcation.
    """

    exists: Annotated[bool, Row("exists")]
    is_stable: Annotated[bool, Row("stable")]
    is_admissible: bool
    saddle_node: Annotated[float | None, Row(f"{Bifurcation.SADDLE_NODE} at Λ")]
    saddle_node_margin: Annotated[float | None, Row("  Λ may fall by", "%")]
    period_doubling: Annotated[float | None, Row(f"{Bifurcation.PERIOD_DOUBLING} at Λ")]
    period_doubling_margin: Annotated[float | None, Row("  Λ may rise by", "%")]


@dataclass(frozen=True)
class Family:
    """The n-T orbit of a case, in SI units, and the errors of the simple models.

    ``exists``, ``is_stable`` and ``is_admissible`` refer to the orbit of the exact model, which
    comes first in ``standing``. All errors are moduli of relative errors: ``errors`` are those of
    the restitution model, ``corrected_errors`` those of the corrected model, and ``law_errors``
    those that the error law gives for the restitution model; ``law_holds`` tells whether the law
    holds.
    """

    n: int
    exists: bool
    is_stable: bool
    is_admissible: bool
    standing: dict[str, Standing]
    max_height: Annotated[float | None, Row("greatest height", "m")]
    impact_speed: Annotated[float | None, Row("impact speed", "m/s")]
    contact_duration: Annotated[float | None, Row("duration of contact", "s")]
    greatest_compression: Annotated[float | None, Row("greatest compression", "m")]
    peak_force: Annotated[float | None, Row("peak force", "N")]
    peak_force_over_weight: Annotated[float | None, Row("peak force over weight")]
    errors: Errors
    corrected_errors: Errors
    law_errors: Errors
    law_holds: bool


@dataclass(frozen=True)
class Mean:
    """A mean, and half the width of its confidence interval of 95 %, in SI units."""

    value: float
    half_width: float


@dataclass(frozen=True)
class Motion:
    """The motion on which a ball ends that starts on the orbit of the verdict, or beside it.

    ``kind`` is the kind of this motion in the exact model: "orbit", "subharmonic", "locked",
    "permanent contact", "chaotic" or "undecided". The periods of the table and the impacts after
    which the motion repeats follow; they are 0 if it does not repeat. ``laid`` is the kind for a
    ball laid on the table, None if it is the same. If the orbit is not stable, there are the same
    three values for the restitution model. For motions that repeat in the same way in both models
    there is then the ``greatest`` height in each model; for other motions there are means over
    time of the height and of the power that the table transfers, with the moduli of their relative
    errors.
    """

    kind: str
    periods: int
    impacts: int
    laid: str | None = None
    restitution_kind: str | None = None
    restitution_periods: int | None = None
    restitution_impacts: int | None = None
    greatest: dict[str, float] | None = None
    mean_height: dict[str, Mean | None] | None = None
    mean_power: dict[str, Mean | None] | None = None
    mean_error: dict[str, Mean] | None = None


@dataclass(frozen=True)
class Needed:
    """The frequency ratio above which the error of a quantity stays within a tolerance ε.

    ``frequency_ratio`` is the largest ϖ at which the error of the restitution model crosses the
    tolerance, and ``corrected`` that of the corrected model. ``by_law`` is the ϖ that the error
    law gives, |K|/ε, or √(|K₂|/ε) for the permanent contact. A value that does not exist is None,
    and ``status`` or ``corrected_status``, otherwise "found", gives the reason.
    """

    quantity: str
    tolerance: float
    frequency_ratio: float | None
    by_law: float | None
    corrected: float | None
    status: str
    corrected_status: str


@dataclass(frozen=True)
class TimeStep:
    """The largest time step that resolves the contact, in s, and the rule that it follows from."""

    largest: Annotated[float, Row("largest time step", "s")]
    rule: str


@dataclass(frozen=True)
class Corrected:
    """The three numbers of the corrected restitution model, in SI units.

    The impact is instantaneous and happens t_c = ``delay`` after the ball touches the table. Its
    restitution coefficient is ``r + σ a/v``, where σ = ``load`` is a time, a the acceleration that
    presses the ball to the table and v the impact speed.
    """

    delay: Annotated[float, Row("corrected model, delay t_c", "s")]
    restitution: Annotated[float, Row("corrected model, restitution r")]
    load: Annotated[float, Row("corrected model, load σ", "s")]


class _ForEngines(ABC):
    """An answer of the calculator that can be repeated for a physics engine."""

    question: dict[str, Any]

    def engine(self, name: str, release: str | None = None) -> EngineSettings:
        """The settings to write into an engine, see :mod:`bouncing_ball.beyond.engines.choice`, and their effect.

        A restitution that was given holds under the release of the engine, even if the release of
        this answer is different.

        Raises
        ------
        ModelError
            If there is no such engine, or the engine does not have this release or this contact.
        NoOrbitError
            If no model has an orbit with the contact of the engine.
        """
        # Imported here, because that module imports this one.
        from bouncing_ball.beyond.calculator.design import design

        asked = {"engine": name} | ({"release": release} if release else {})
        found = self if self.question.items() >= asked.items() else design(**self.question | asked)
        return found.engine_settings()

    @abstractmethod
    def engine_settings(self) -> EngineSettings:
        """The settings of the engine for which this design was made."""

    def _settings(
        self, contact: Physical, release: str, law: dict[str, Any] | None = None
    ) -> EngineSettings:
        engine, error = engine_named(self.question["engine"]), self.question["restitution_error"]
        return (engine.with_law(law) if law else engine).settings(contact, release, error)


@dataclass(frozen=True)
class Contact(_ForEngines):
    """A contact without a table, in SI units.

    ``natural_frequency`` is ω = √(k/m) in rad/s: on a table that moves with Ω it gives ϖ = ω/Ω.
    ``question`` holds the arguments of the call. What depends on the impact speed is None.
    """

    mass: Annotated[float, Row("mass in kg")]
    stiffness: Annotated[float, Row("stiffness", "N/m")]
    damping: Annotated[float | None, Row("damping", "N s/m")]
    damping_ratio: Annotated[float | None, Row("damping ratio ζ")]
    natural_frequency: Annotated[float, Row("natural frequency ω = ϖΩ", "rad/s")]
    contact_time: Annotated[float | None, Row("contact time", "s")]
    release: str
    measured_restitution: Annotated[float | None, Row("restitution of a free impact")]
    notes: tuple[str, ...]
    question: dict[str, Any]

    def engine_settings(self) -> EngineSettings:
        # A contact whose damping depends on the speed has no settings.
        contact = Physical(self.mass, self.stiffness, self.damping or 0.0)
        return self._settings(contact, self.release)


@dataclass(frozen=True)
class Design(_ForEngines):
    """The answer of the calculator about a contact; times are in s, lengths in m, forces in N.

    ``frequency_ratio``, ``damping_ratio`` and ``amplitude`` are ϖ, ζ and Λ. ``restitution`` has the
    r of a free impact for each release rule, and ``measured_restitution`` is that for the rule of
    this contact. ``n`` is the family of the verdict, and ``question`` holds the arguments of the
    call. Up to Λ = ``permanent_contact`` a ball may stay on the table; None if no such threshold
    was found. ``law`` has the ``name`` of a contact law and its parameters, whose units are powers
    of kg, m and s.
    """

    frequency_ratio: Annotated[float, Row("frequency ratio ϖ")]
    damping_ratio: Annotated[float, Row("damping ratio ζ")]
    amplitude: Annotated[float, Row("excitation amplitude Λ")]
    stiffness: Annotated[float, Row("stiffness", "N/m")]
    damping: Annotated[float, Row("damping", "N s/m")]
    contact_time: Annotated[float, Row("contact time", "s")]
    time_step: TimeStep
    static_deflection: Annotated[float, Row("static deflection", "m")]
    restitution: Annotated[
        dict[str, float],
        Row("restitution, released at δ = 0"),
        Row("restitution, released without force"),
    ]
    measured_restitution: float
    permanent_contact: Annotated[float | None, Row("permanent contact up to Λ")]
    law: dict[str, Any] | None
    corrected: Corrected
    orbits: tuple[Family, ...]
    needed: Needed
    motion: Motion
    headline: str
    is_good_enough: bool
    verdict: str
    reason: str
    notes: tuple[str, ...]
    case: Case
    n: int
    question: dict[str, Any]

    def engine_settings(self) -> EngineSettings:
        contact, one = Physical(self.case.mass, self.stiffness, self.damping), self.judged
        return replace(
            self._settings(contact, self.case.contact.release, self.law),
            max_height=one.max_height,
            contact_duration=one.contact_duration,
            penetration=one.greatest_compression,
        )

    @property
    def judged(self) -> Family:
        """The result for the family of the verdict."""
        return next(one for one in self.orbits if one.n == self.n)

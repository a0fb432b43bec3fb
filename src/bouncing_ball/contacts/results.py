"""The results of the calculator; each is defined once, with its description and its unit.

A result is a field of a dataclass, in SI units. The text and the page list those that are annotated
with a :class:`~.rows.Listed`, in the order of their definition; JSON has all of them
(:mod:`bouncing_ball.contacts.rows`). No result holds the call that made it.
"""

from dataclasses import dataclass
from typing import Annotated, Any

from bouncing_ball.contacts.case import PhysicalCase
from bouncing_ball.contacts.engines.engine import EngineSettings
from bouncing_ball.contacts.engines.given_step import AtStep
from bouncing_ball.contacts.rows import Listed
from bouncing_ball.periodic.stability import Bifurcation

Errors = dict[str, float | None]
"""Relative errors by quantity, (q - q_SD)/q_SD with the value q_SD of the contact; None where one
of the values does not exist, or that of the contact is zero."""


@dataclass(frozen=True)
class Standing:
    """The place of a case in its family, in one model.

    ``saddle_node`` and ``period_doubling`` are the Λ of the bifurcations. The margins are relative
    changes of Λ: ``1 - Λ_SN/Λ`` is the fall down to the saddle-node, and ``Λ_PD/Λ - 1`` the rise
    up to the period doubling. They are None if there is no such bifurcation.
    """

    exists: Annotated[bool, Listed("exists")]
    is_stable: Annotated[bool, Listed("stable")]
    is_admissible: bool
    saddle_node: Annotated[float | None, Listed(f"{Bifurcation.SADDLE_NODE} at Λ")]
    saddle_node_margin: Annotated[float | None, Listed("  Λ may fall by", "%")]
    period_doubling: Annotated[float | None, Listed(f"{Bifurcation.PERIOD_DOUBLING} at Λ")]
    period_doubling_margin: Annotated[float | None, Listed("  Λ may rise by", "%")]


@dataclass(frozen=True)
class Family:
    """The n-T orbit of a case, in SI units, and the errors of the simple models.

    ``exists``, ``is_stable`` and ``is_admissible`` refer to the orbit of the exact model, which
    comes first in ``standing``. ``values`` has each quantity in every model, the exact one first,
    in m, in m/s or without a unit. All errors are relative to the exact value and have a sign,
    positive where the model predicts too much: ``errors`` are those of the restitution model,
    ``corrected_errors`` those of the corrected model, and ``law_errors`` those that the error law
    gives for the restitution model; ``law_holds`` tells whether the law holds.
    """

    n: int
    exists: bool
    is_stable: bool
    is_admissible: bool
    standing: dict[str, Standing]
    max_height: Annotated[float | None, Listed("greatest height", "m")]
    impact_speed: Annotated[float | None, Listed("impact speed", "m/s")]
    contact_duration: Annotated[float | None, Listed("duration of contact", "s")]
    greatest_compression: Annotated[float | None, Listed("greatest compression", "m")]
    peak_force: Annotated[float | None, Listed("peak force", "N")]
    peak_force_over_weight: Annotated[float | None, Listed("peak force over weight")]
    values: dict[str, dict[str, float | None]]
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
class FinalMotion:
    """The motion on which a ball ends that starts on the orbit of the verdict, or beside it.

    ``kind`` is the kind of this motion in the exact model: "orbit", "subharmonic", "locked",
    "permanent contact", "chaotic" or "undecided". The periods of the table and the impacts after
    which the motion repeats follow; they are 0 if it does not repeat. ``laid`` is the kind for a
    ball laid on the table, None if it is the same. If the orbit is not stable, there are the same
    three values for the restitution model. For motions that repeat in the same way in both models
    there is then the ``greatest`` height in each model; for other motions there are means over
    time of the height and of the power that the table transfers, over a number of ``balls``, with
    the signed relative errors of the restitution model.
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
    balls: int | None = None


@dataclass(frozen=True)
class Needed:
    """The frequency ratio above which the error of a quantity stays within a tolerance ε.

    The error is relative to the value on the contact.

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

    largest: Annotated[float, Listed("largest time step", "s")]
    rule: str


@dataclass(frozen=True)
class Corrected:
    """The three numbers of the corrected restitution model, in SI units.

    The impact is instantaneous and happens t_c = ``delay`` after the ball touches the table. Its
    restitution coefficient is ``r + σ a/v``, where σ = ``load`` is a time, a the acceleration that
    presses the ball to the table and v the impact speed.
    """

    delay: Annotated[float, Listed("corrected model, delay t_c", "s")]
    restitution: Annotated[float, Listed("corrected model, restitution r")]
    load: Annotated[float, Listed("corrected model, load σ", "s")]


@dataclass(frozen=True)
class Dropped:
    """A ball that is dropped onto a table at rest, in SI units.

    ``restitution`` is √(h′/h), the square root of the height of the rebound over that of the drop.
    It is smaller than the r of a free impact, because gravity acts in the contact. A ball that does
    not rebound has 0.
    """

    speed: Annotated[float, Listed("impact speed of a drop", "m/s")]
    drop_height: Annotated[float, Listed("  dropped from", "m")]
    rebound_height: Annotated[float, Listed("  rises to", "m")]
    restitution: Annotated[float, Listed("  restitution √(h′/h) with gravity")]
    at_half: Annotated[float, Listed("  the same at half the speed")]
    at_tenth: Annotated[float, Listed("  the same at a tenth of the speed")]


@dataclass(frozen=True)
class LoneContact:
    """A contact without a table, in SI units.

    ``natural_frequency`` is ω = √(k/m) in rad/s: on a table that moves with Ω it gives ϖ = ω/Ω.
    What depends on the impact speed is None. The r of a free impact holds at speeds above
    ``slowed_speed``: there, on a table at rest, gravity lowers √(h′/h) by 1 %, and at slower
    impacts by more. It is None without damping. ``dropped`` is a drop with the speed that was
    asked for, ``engine`` the contact written for an engine, and ``at_step`` what it does with the
    time step that is given; they are None if nothing was asked about them.
    """

    mass: Annotated[float, Listed("mass in kg")]
    stiffness: Annotated[float, Listed("stiffness", "N/m")]
    damping: Annotated[float | None, Listed("damping", "N s/m")]
    damping_ratio: Annotated[float | None, Listed("damping ratio ζ")]
    natural_frequency: Annotated[float, Listed("natural frequency ω = ϖΩ", "rad/s")]
    contact_time: Annotated[float | None, Listed("contact time", "s")]
    release: str
    measured_restitution: Annotated[float | None, Listed("restitution of a free impact")]
    slowed_speed: Annotated[float | None, Listed("gravity lowers r by 1 % at", "m/s")]
    notes: tuple[str, ...]
    dropped: Dropped | None = None
    engine: EngineSettings | None = None
    at_step: AtStep | None = None


@dataclass(frozen=True)
class Choice:
    """The most compliant contact whose restitution model is within a tolerance, in SI units.

    ``n`` is the family of the orbit, and ``needed`` the ϖ that the tolerance needs. The verdict
    says what a simulation needs, and ``reason`` gives the reason.
    """

    mass: Annotated[float, Listed("mass in kg")]
    stiffness: Annotated[float, Listed("stiffness", "N/m")]
    damping: Annotated[float, Listed("damping", "N s/m")]
    frequency_ratio: Annotated[float, Listed("frequency ratio ϖ")]
    damping_ratio: Annotated[float, Listed("damping ratio ζ")]
    contact_time: Annotated[float, Listed("contact time", "s")]
    release: str
    measured_restitution: Annotated[float, Listed("restitution of a free impact")]
    n: int
    needed: Needed
    verdict: str
    reason: str
    notes: tuple[str, ...]
    case: PhysicalCase


@dataclass(frozen=True)
class Assessment:
    """The assessment of a contact on a table; times are in s, lengths in m, forces in N.

    ``frequency_ratio``, ``damping_ratio`` and ``amplitude`` are ϖ, ζ and Λ. ``restitution`` has the
    r of a free impact for each release rule, and ``measured_restitution`` is that for the rule of
    this contact; it holds at impacts faster than ``slowed_speed``, at which, on a table at rest,
    gravity lowers √(h′/h) by 1 %, None without damping or for another law. ``n`` is the family of
    the verdict. Up to Λ = ``permanent_contact`` a ball may stay on the table; None if no such
    threshold was found. ``law`` has the ``name`` of a contact law and its parameters, whose units
    are powers of kg, m and s.
    """

    frequency_ratio: Annotated[float, Listed("frequency ratio ϖ")]
    damping_ratio: Annotated[float, Listed("damping ratio ζ")]
    amplitude: Annotated[float, Listed("excitation amplitude Λ")]
    stiffness: Annotated[float, Listed("stiffness", "N/m")]
    damping: Annotated[float, Listed("damping", "N s/m")]
    contact_time: Annotated[float, Listed("contact time", "s")]
    time_step: TimeStep
    static_deflection: Annotated[float, Listed("static deflection", "m")]
    restitution: Annotated[
        dict[str, float],
        Listed("restitution, released at δ = 0"),
        Listed("restitution, released without force"),
    ]
    measured_restitution: float
    slowed_speed: Annotated[float | None, Listed("gravity lowers r by 1 % at", "m/s")]
    permanent_contact: Annotated[float | None, Listed("permanent contact up to Λ")]
    law: dict[str, Any] | None
    corrected: Corrected
    orbits: tuple[Family, ...]
    needed: Needed
    motion: FinalMotion
    headline: str
    is_good_enough: bool
    verdict: str
    reason: str
    notes: tuple[str, ...]
    case: PhysicalCase
    n: int

    @property
    def judged(self) -> Family:
        """The result for the family of the verdict."""
        return next(one for one in self.orbits if one.n == self.n)


@dataclass(frozen=True)
class Design(Assessment):
    """The answers to all questions of one call: an assessment, and what else was asked.

    ``dropped``, ``engine`` and ``at_step`` are as in a :class:`LoneContact`; with an engine, the
    time step is that of the engine.
    """

    dropped: Dropped | None = None
    engine: EngineSettings | None = None
    at_step: AtStep | None = None

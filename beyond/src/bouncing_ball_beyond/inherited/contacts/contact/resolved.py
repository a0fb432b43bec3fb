"""A contact with numbers: the dimensionless model of a contact, and its SI scales."""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.contacts.contact import effort
from bouncing_ball_beyond.inherited.contacts.contact.contact import Contact
from bouncing_ball_beyond.inherited.contacts.contact.rebounds import slowed
from bouncing_ball_beyond.inherited.contacts.contact.table import TableMotion
from bouncing_ball_beyond.inherited.contacts.engines.engine import without_step
from bouncing_ball_beyond.inherited.contacts.engines.physical import Physical
from bouncing_ball_beyond.models.instant import Instant
from bouncing_ball_beyond.models.laws.contact_law import ContactLaw
from bouncing_ball_beyond.models.laws.hertzian import Tsuji
from bouncing_ball_beyond.models.laws.scales import rest
from bouncing_ball_beyond.models.laws.steady_contact import known_threshold
from bouncing_ball_beyond.models.model import Model
from bouncing_ball_beyond.models.spring_damper import SpringDamper

# Restitution coefficients that differ by less are taken for equal, because a contact law is fitted
# to a free impact, and its signature interpolated, to 1e-12.
_SAME = 1e-9
# The loss 1 - r below which a contact law is hardly damped.
_HARDLY = 1e-6
# A speed, in units of the contact's own scales, at which gravity changes r by a thousandth of a
# percent.
_FAST = 1e5
_NOTHING = Contact()


@dataclass(frozen=True)
class ResolvedContact:
    """A ball on a table with a contact between them: what a :class:`~.contact.Contact` resolves to.

    In units of 1/Ω, g/Ω² and m the model has the Λ of the table and the ϖ, ζ and release rule of
    the contact. The models are built on first use.

    Two questions divide the contacts. If one :attr:`is_linear`, its motion on a vibrating table has
    a closed form; otherwise it has an :attr:`integrated_law`, and balls are followed with less
    :attr:`effort`. If one :attr:`is_spring_damper`, k and c are its own; otherwise they are those
    of the equivalent. Only the answers for a damper that acts on approach differ: its law is
    integrated, with its own k and c.

    It has two contacts. ``plain`` is what is computed. ``given`` is what was asked about: the
    sentences name its engine, its drop test and its radius. At first ``plain`` follows from
    ``given``; but it is replaced where the law of an engine or a given time step leads to another k
    and c, whereas the sentences stay those on ``given``.

    Parameters
    ----------
    plain : Contact
        The contact by its mass, its stiffness and its loss
        (:meth:`.contact.Contact.by_stiffness_and_loss`). It has k and c if they were given, because
        mω² and 2ζmω differ from them by rounding.
    table : TableMotion
        The table, which may be at rest.
    law : ContactLaw
        The law of the contact, such as a spring and a damper.
    equivalent : SpringDamper
        The law itself if it is a spring and a damper. For another law the one with the same
        restitution coefficient and duration as this law has at the impact speed of the orbit, or
        with the parameters of an engine.
    given : Contact
        The contact as it was given.
    written : str, optional
        Name of the engine for which it is written.
    impact_speed : float, optional
        On a table at rest, the speed in m/s of the impact at which a law has the r of its
        equivalent.

    Examples
    --------
    >>> spring = SpringDamper(10.0, 0.1)
    >>> case = ResolvedContact(Contact(mass=1.0), TableMotion(1.0, 1.0, 1.0), spring, spring)
    >>> case.stiffness, case.damping
    (100.0, 2.0)
    """

    KEYS: ClassVar[dict[str, str]] = {
        "mass": "mass",
        "table": "table",
        "contact": "equivalent",
        "law": "integrated_law",
    }

    plain: Contact
    table: TableMotion
    law: ContactLaw
    equivalent: SpringDamper
    given: Contact = _NOTHING
    written: str | None = None
    impact_speed: float | None = None

    @property
    def is_spring_damper(self) -> bool:
        """Whether the contact is a spring and a damper, which may act on approach only."""
        return self.law is self.equivalent

    @property
    def is_linear(self) -> bool:
        """Whether the contact is a spring and a damper that acts from the impact to the release."""
        return self.is_spring_damper and self.law.release.is_linear

    @property
    def holds(self) -> bool:
        """Whether the damper of an engine's parameters pulls and holds the ball."""
        return self.is_linear and self.physical.holds(self.equivalent.release)

    @property
    def integrated_law(self) -> ContactLaw | None:
        """The law that is integrated in time; None for a linear contact."""
        return None if self.is_linear else self.law

    @property
    def effort(self) -> effort.Effort:
        """How many balls and impacts are followed on the contact."""
        return effort.LINEAR if self.is_linear else effort.OF_LAW

    @property
    def mass(self) -> float:
        """m in kg."""
        return self.plain.mass

    @property
    def omega(self) -> float:
        """ω = ϖΩ in rad/s."""
        return float(self.equivalent.frequency_ratio) * self.table.angular_frequency

    @property
    def stiffness(self) -> float:
        """k = mω² in N/m."""
        if self.plain.stiffness is not None:
            return self.plain.stiffness
        return self.mass * self.omega**2

    @property
    def damping(self) -> float:
        """c = 2ζmω in N s/m."""
        if self.plain.damping is not None:
            return self.plain.damping
        return 2 * float(self.equivalent.damping_ratio) * self.mass * self.omega

    @property
    def physical(self) -> Physical:
        """m, k and c."""
        return Physical(self.mass, self.stiffness, self.damping)

    @property
    def contact_time(self) -> float:
        """Duration of a free impact in s, for a law with an impact speed at that speed.

        Raises
        ------
        ModelError
            If ζ ≥ 1.
        """
        impact = self._impact
        duration = self.equivalent.free_duration if impact is None else impact.duration
        return float(duration) * self.table.time

    @property
    def restitution(self) -> float:
        """r of a free impact, for a law with an impact speed at that speed; 0 if none ends."""
        if self.holds:
            return 0.0
        impact = self._impact
        return float(self.equivalent.restitution if impact is None else impact.restitution)

    @cached_property
    def _impact(self) -> Instant | None:
        """The free impact of a law at the impact speed, if one is given."""
        if self.is_linear or self.impact_speed is None:
            return None
        return self.law.signature(self.impact_speed * self.table.time / self.table.length)

    @property
    def static_deflection(self) -> float:
        """mg/k in m; for a contact law the deflection at which its force at rest is the weight.

        The k of an engine's parameters is the one that they have at rest, whatever contact they are
        at a time step.
        """
        engine = self.given.engine
        if self.is_linear and engine is not None and self.written is None:
            # Implicit steps do not damp a ball at rest.
            at_rest = engine.read(without_step(self.given.engine_parameters), self.mass)
            return self.mass * self.table.gravity / at_rest.stiffness
        if self.is_linear:
            return self.table.gravity / self.omega**2
        return rest(self.law) * self.table.length

    @property
    def slowed_speed(self) -> float | None:
        """The impact speed in m/s at which gravity lowers r by 1 %, in drops on this contact: 0 if
        it does at no speed, as without damping or without a bounce, and None if it lowers r by more
        at every speed.
        """
        if self.holds:
            return 0.0
        if self.is_linear:
            zeta = float(self.equivalent.damping_ratio)
            # In units of 1/ω and g/ω² the contact has ϖ = 1.
            found = slowed(SpringDamper(1.0, zeta, self.equivalent.release), _FAST)
            unit = self.table.gravity / self.omega
        else:
            found = slowed(self.law, _FAST * rest(self.law) * self.omega * self.table.time)
            unit = self.unit_speed
        return None if found is None else found * unit

    @property
    def unit_speed(self) -> float:
        """The unit of speeds, g/Ω, in m/s."""
        return self.table.length / self.table.time

    @property
    def law_speed(self) -> float:
        """The impact speed in m/s at which a law has the r of its equivalent: that of the drop, or
        of the 1-T orbit of the restitution model.
        """
        if self.impact_speed is not None:
            return self.impact_speed
        # Imported here, because orbits are imported for longer than most recipes are computed.
        from bouncing_ball_beyond.periodic.one_impact.restitution_branch import rigid_speed

        return float(rigid_speed(1, self.equivalent.restitution)) * self.unit_speed

    @property
    def lacks_speed(self) -> bool:
        """Whether r depends on the speed, as for the parameters of some engines, and there is
        neither a table that moves nor an impact with a speed.
        """
        engine = self.given.engine
        has_speed = not self.table.is_at_rest or self.impact_speed is not None
        return engine is not None and engine.needs_speed and not has_speed

    @property
    def law_in_si(self) -> dict[str, Any] | None:
        """The name of a contact law and its parameters in SI units; None for a spring and damper,
        whose k and c are known.
        """
        if self.is_spring_damper:
            return None
        numbers = self.law.in_si(self.mass, self.table.length, self.table.time)
        return {"name": self.law.name, **numbers}

    @cached_property
    def models(self) -> dict[str, Model]:
        """The models by name: first the exact model, then the two simple models, in which r is
        that of a free impact.
        """
        from bouncing_ball_beyond.accuracy.simple_models import SIMPLE, models_of_law

        models = models_of_law(self.law, self.equivalent.restitution)
        of_law = "hertz" if isinstance(self.law, Tsuji) else self.law.name
        exact = models[0].name if self.is_linear else of_law
        return dict(zip((exact, *SIMPLE), models, strict=True))

    def instant(self, n: ArrayLike) -> Instant:
        """Signature of the contact at the impact speeds of the restitution model's n-T orbits."""
        # The r of a contact law is interpolated, and may exceed 1 by rounding.
        return self._interpolated_instant(n)._replace(restitution=self.equivalent.restitution)

    def _interpolated_instant(self, n: ArrayLike) -> Instant:
        from bouncing_ball_beyond.periodic.one_impact.restitution_branch import rigid_speed

        corrected: Any = self.models["corrected"]
        return corrected.signature(rigid_speed(n, self.equivalent.restitution))

    def has_its_restitution(self, n: ArrayLike) -> np.ndarray:
        """Whether the contact law has the r of its equivalent at the impact speed of n-T orbits."""
        r = float(self.equivalent.restitution)
        return np.abs(self._interpolated_instant(n).restitution - r) < _SAME

    @cached_property
    def permanent_contact(self) -> float:
        """Λ up to which the ball stays on the table; NaN if no such threshold was found.

        It is not searched for under a law that is hardly damped, because its oscillation on the
        table would have to be integrated over millions of periods.
        """
        if not self.is_linear and 1 - float(self.equivalent.restitution) < _HARDLY:
            return math.nan
        return known_threshold(self.law)

"""A ball, a vibrating table and a contact between them, in SI units."""

import math
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from bouncing_ball.accuracy.errors import models
from bouncing_ball.contacts.contact_law import ContactLaw
from bouncing_ball.contacts.contact_scales import rest
from bouncing_ball.contacts.laws.tsuji import Tsuji
from bouncing_ball.contacts.permanent_contact import permanent_contact
from bouncing_ball.contacts.signature import Instant, Signature
from bouncing_ball.contacts.spring_damper import SpringDamper
from bouncing_ball.errors import ModelError
from bouncing_ball.orbits.corrected_model import CorrectedModel
from bouncing_ball.orbits.law_model import LawModel
from bouncing_ball.orbits.model import ImpactModel
from bouncing_ball.orbits.restitution_model import RestitutionModel
from bouncing_ball.orbits.restitution_orbit import rigid_speed

# Two restitution coefficients are one: the law is found, and interpolated, to 1e-12.
_SAME = 1e-9


@dataclass(frozen=True)
class Table:
    """The table's motion A sin Ωt, and gravity.

    Parameters
    ----------
    angular_frequency, table_amplitude : float
        Ω in rad/s and the amplitude A of the table in m.
    gravity : float
        g in m/s²; in a gear pair the drag torque over the inertia.

    Examples
    --------
    >>> Table(angular_frequency=2.0, table_amplitude=2.0, gravity=8.0).amplitude
    1.0
    """

    angular_frequency: float
    table_amplitude: float
    gravity: float

    @property
    def amplitude(self) -> float:
        """Λ = AΩ²/g, the amplitude of the table's acceleration over gravity."""
        return self.table_amplitude * self.angular_frequency**2 / self.gravity

    @property
    def time(self) -> float:
        """Unit of time, 1/Ω, in s."""
        return 1 / self.angular_frequency

    @property
    def length(self) -> float:
        """Unit of length, g/Ω², in m."""
        return self.gravity / self.angular_frequency**2


@dataclass(frozen=True)
class Case:
    """A case to design for; its models are built once.

    Parameters
    ----------
    mass : float
        m in kg.
    table : Table
    contact : SpringDamper
        ϖ, ζ and the release rule.
    law : ContactLaw, optional
        A Hertz contact; the linear one then has its restitution coefficient, and its
        duration at the orbit's impact speed.

    Examples
    --------
    >>> case = Case(1.0, Table(1.0, 1.0, 1.0), SpringDamper(10.0, 0.1))
    >>> case.in_si()["stiffness"], case.in_si()["damping"]
    (100.0, 2.0)
    """

    mass: float
    table: Table
    contact: SpringDamper
    law: ContactLaw | None = None

    @cached_property
    def models(self) -> dict[str, ImpactModel]:
        """The models by name: the exact one first, then the simple ones with the r of a free
        impact.
        """
        if self.law is None:
            return {model.name: model for model in models(self.contact)}
        return {
            "hertz" if isinstance(self.law, Tsuji) else self.law.name: LawModel(self.law),
            "restitution": RestitutionModel(self.contact.restitution),
            "corrected": CorrectedModel(Signature(self.law)),
        }

    def instant(self, n: int) -> Instant:
        """The signature of the contact at the impact speed of the restitution model's n-T orbit."""
        r = self.contact.restitution
        # The r of a law is interpolated, and may exceed 1 by rounding.
        return self.models["corrected"].signature(rigid_speed(n, r))._replace(restitution=r)

    def has_its_restitution(self, n: int) -> bool:
        """Whether the r of the contact is that of the law at the impact speed of the n-T orbit."""
        r = float(self.contact.restitution)
        own = self.models["corrected"].signature(rigid_speed(n, r)).restitution
        return abs(float(own) - r) < _SAME

    def in_si(self) -> dict[str, float]:
        """Stiffness k = mω² and damping c = 2ζmω with ω = ϖΩ, contact time, and static deflection
        mg/k.

        They are in N/m, N s/m, s and m. For a Hertz contact the deflection is that at which K
        p^{3/2} = 1.
        """
        omega = float(self.contact.frequency_ratio) * self.table.angular_frequency
        deflection = self.table.gravity / omega**2
        if self.law is not None:
            deflection = rest(self.law) * self.table.length
        return {
            "stiffness": self.mass * omega**2,
            "damping": 2 * float(self.contact.damping_ratio) * self.mass * omega,
            "contact_time": float(self.contact.free_duration) * self.table.time,
            "static_deflection": deflection,
        }

    @property
    def law_in_si(self) -> dict[str, Any] | None:
        """The name of a contact law and its parameters in SI units; None for a linear contact."""
        if self.law is None:
            return None
        numbers = self.law.in_si(self.mass, self.table.length, self.table.time)
        return {"name": self.law.name, **numbers}

    @cached_property
    def permanent_contact(self) -> float:
        """Λ up to which the ball stays down; NaN if no such threshold was found."""
        with suppress(ModelError):
            return permanent_contact(self.contact if self.law is None else self.law)
        return math.nan

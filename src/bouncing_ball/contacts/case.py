"""A ball, a vibrating table and a contact between them, in SI units."""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.accuracy.corrected_errors import exact_and_simple_models
from bouncing_ball.models.corrected.model import CorrectedModel
from bouncing_ball.models.instant import Instant
from bouncing_ball.models.laws.contact_law import ContactLaw
from bouncing_ball.models.laws.hertzian import Tsuji
from bouncing_ball.models.laws.model import LawModel
from bouncing_ball.models.laws.permanent_contact import known_threshold
from bouncing_ball.models.laws.scales import rest
from bouncing_ball.models.laws.signature import Signature
from bouncing_ball.models.model import Model
from bouncing_ball.models.rigid import RestitutionModel
from bouncing_ball.models.spring_damper import SpringDamper
from bouncing_ball.periodic.restitution_branch import rigid_speed

# Restitution coefficients that differ by less are taken for equal, because a contact law is fitted
# to a free impact, and its signature interpolated, to 1e-12.
_SAME = 1e-9
# The loss 1 - r below which a contact law is hardly damped.
_HARDLY = 1e-6


@dataclass(frozen=True)
class TableMotion:
    """The table with its motion A sin Ωt, and the acceleration of gravity.

    Parameters
    ----------
    angular_frequency, table_amplitude : float
        Ω in rad/s and the amplitude A of the table in m.
    gravity : float
        g in m/s²; for a gear pair, the deceleration that the drag torque causes.

    Examples
    --------
    >>> TableMotion(angular_frequency=2.0, table_amplitude=2.0, gravity=8.0).amplitude
    1.0
    """

    angular_frequency: float
    table_amplitude: float
    gravity: float

    @property
    def amplitude(self) -> float:
        """Excitation amplitude Λ = AΩ²/g, the greatest acceleration of the table over gravity."""
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
class PhysicalCase:
    """A ball on a vibrating table with a contact between them, and the models of this contact.

    The models are built on first use. In units of 1/Ω, g/Ω² and m the case has the Λ of the table
    and the ϖ, ζ and release rule of the contact.

    Parameters
    ----------
    mass : float
        m in kg.
    table : TableMotion
    contact : SpringDamper
        ϖ, ζ and the release rule.
    law : ContactLaw, optional
        A nonlinear contact law. ``contact`` is then the linear contact with the same restitution
        coefficient and duration as this law has at the impact speed of the orbit.

    Examples
    --------
    >>> case = PhysicalCase(1.0, TableMotion(1.0, 1.0, 1.0), SpringDamper(10.0, 0.1))
    >>> case.in_si()["stiffness"], case.in_si()["damping"]
    (100.0, 2.0)
    """

    mass: float
    table: TableMotion
    contact: SpringDamper
    law: ContactLaw | None = None

    @cached_property
    def models(self) -> dict[str, Model]:
        """The models by name: first the exact model, then the two simple models, in which r is
        that of a free impact.
        """
        if self.law is None:
            return {model.name: model for model in exact_and_simple_models(self.contact)}
        return {
            "hertz" if isinstance(self.law, Tsuji) else self.law.name: LawModel(self.law),
            "restitution": RestitutionModel(self.contact.restitution),
            "corrected": CorrectedModel(Signature(self.law)),
        }

    def instant(self, n: ArrayLike) -> Instant:
        """Signature of the contact at the impact speeds of the restitution model's n-T orbits."""
        # The r of a contact law is interpolated, and may exceed 1 by rounding.
        return self._interpolated_instant(n)._replace(restitution=self.contact.restitution)

    def _interpolated_instant(self, n: ArrayLike) -> Instant:
        corrected: Any = self.models["corrected"]
        return corrected.signature(rigid_speed(n, self.contact.restitution))

    def has_its_restitution(self, n: ArrayLike) -> np.ndarray:
        """Whether the contact law has the r of ``contact`` at the impact speed of n-T orbits."""
        r = float(self.contact.restitution)
        return np.abs(self._interpolated_instant(n).restitution - r) < _SAME

    def in_si(self) -> dict[str, float]:
        """Stiffness k = mω² in N/m, damping c = 2ζmω in N s/m, where ω = ϖΩ, contact time in s,
        and static deflection mg/k in m.

        For a contact law the deflection is the one at which its force at rest is the weight.
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

    @property
    def exact_law(self) -> ContactLaw:
        """The contact law of the exact model."""
        return self.contact if self.law is None else self.law

    @cached_property
    def permanent_contact(self) -> float:
        """Λ up to which the ball stays on the table; NaN if no such threshold was found.

        It is not searched for under a law that is hardly damped, because its oscillation on the
        table would have to be integrated over millions of periods.
        """
        if self.law is not None and 1 - float(self.contact.restitution) < _HARDLY:
            return math.nan
        return known_threshold(self.exact_law)

"""The corrected restitution model, whose impacts are instants at the centroid of a contact."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

from numpy.typing import ArrayLike

from bouncing_ball_beyond.models.corrected.motion import CorrectedDynamics
from bouncing_ball_beyond.models.instant import Instant
from bouncing_ball_beyond.models.laws.contact_law import ContactLaw
from bouncing_ball_beyond.models.laws.signature import Signature
from bouncing_ball_beyond.models.model import Model


@dataclass(frozen=True, repr=False)
class CorrectedModel(Model):
    """A ball whose impacts are instants at the centroid of the contact force.

    Parameters
    ----------
    law : Signature
        Delay, restitution, load sensitivity and duration of the impact as functions of its speed.

    Examples
    --------
    >>> from bouncing_ball_beyond.models.spring_damper import SpringDamper
    >>> model = CorrectedModel.of_contact(SpringDamper.from_restitution(0.65, 10.0))
    >>> round(float(model.signature(3.0).restitution), 12)
    0.65
    """

    law: Signature

    name: ClassVar[str] = "corrected"

    @cached_property
    def parameters(self) -> Mapping[str, Any]:
        """The parameters of the contact by name, and the name of this model of it."""
        return {**super().parameters, "model": self.name}

    @classmethod
    def of_contact(cls, contact: ContactLaw) -> CorrectedModel:
        """The corrected model of a contact.

        Raises
        ------
        ModelError
            If the contact has no signature, as a linear one for ζ ≥ 1, or is a row of laws that
            have no table in common.
        """
        return cls(Signature(contact))

    def dynamics(self, amplitude: ArrayLike) -> CorrectedDynamics:
        """The impacts and flights of these balls on a table of amplitude Λ."""
        return CorrectedDynamics.of(self.law, amplitude)

    def signature(self, speed: ArrayLike) -> Instant:
        """The signature at impact speeds v > 0."""
        return self.law(speed)

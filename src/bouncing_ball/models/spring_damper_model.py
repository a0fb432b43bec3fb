"""The spring-damper model: balls on a linear contact (Eqs. 10-15)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.errors import ModelError, ParameterError, shortened
from bouncing_ball.models.damping import Release
from bouncing_ball.models.dynamics import Dynamics
from bouncing_ball.models.held_contact import held_by, held_threshold
from bouncing_ball.models.instant import Instant
from bouncing_ball.models.laws.contact_law import ContactLaw
from bouncing_ball.models.laws.model import LawModel
from bouncing_ball.models.model import Model
from bouncing_ball.models.setting import PAPER, Setting, require_setting
from bouncing_ball.models.spring_damper import SpringDamper


@dataclass(frozen=True, repr=False)
class SpringDamperModel(Model):
    """A ball on a table with a spring-damper contact (Eqs. 10-27).

    Parameters
    ----------
    contact : SpringDamper
        ϖ, ζ < 1 and the release rule of a linear contact.
    setting : Setting, optional
        The motion of the table and what moves the ball in flight, by default those of the paper.

    Raises
    ------
    ModelError
        If the contact is not linear, or overdamped (ζ ≥ 1): it is then a law of
        :class:`.LawModel`.

    Examples
    --------
    A parameter can vary; of r and ζ the other one follows (Eq. 16):

    >>> model = SpringDamperModel(SpringDamper.from_restitution(1.0, 2.0))
    >>> {name: float(x) for name, x in model.numbers().items()}
    {'frequency_ratio': 2.0, 'damping_ratio': 0.0, 'restitution': 1.0}
    """

    contact: SpringDamper
    setting: Setting = PAPER

    name: ClassVar[str] = "spring-damper"

    def __post_init__(self) -> None:
        if not isinstance(self.contact, SpringDamper):
            raise ParameterError("contact = {} is not a SpringDamper", shortened(self.contact))
        release = self.contact.release
        if release is Release.DISPLACEMENT:
            # A contact that does not oscillate never comes back to the level of the table.
            self.contact.require_underdamped()
        elif not self.contact.is_linear_and_underdamped:
            fault = "does not oscillate for ζ ≥ 1" if release.is_linear else "is not linear"
            raise ModelError(
                f"a contact with the release {release} {fault}: make its ball with "
                f'contact_law("linear", frequency_ratio=…, damping_ratio=…, release="{release}")'
            )
        require_setting(self.setting)
        if not self.setting.is_paper:
            held_by(self.contact, self.setting).check(self.setting.waveform)

    @property
    def label(self) -> str:
        contact = self.contact
        return f"ϖ = {float(contact.frequency_ratio):g}, ζ = {float(contact.damping_ratio):.4g}"

    def dynamics(self, amplitude: ArrayLike) -> Dynamics:
        """The contacts and flights of these balls on a table of amplitude Λ, in closed form."""
        return self.contact.dynamics(amplitude, self.place)

    def signature(self, speed: ArrayLike) -> Instant:
        """The signature in closed form, which is the same at every speed."""
        return self.contact.signature(speed)

    def permanent_contact_threshold(self) -> Any:
        """Λ up to which the ball stays on the table, of the model's shape.

        It is Λ_SD(ϖ) for the displacement release and Λ_F(ϖ) for the force release, and
        :func:`.held_threshold` in another setting than that of the paper.
        """
        contact = self.contact
        paper = self.setting.is_paper
        found: Any = contact.permanent_contact if paper else held_threshold(contact, self.setting)
        return np.broadcast_to(found, self.shape).astype(float)[()]


def model_of_law(law: ContactLaw, setting: Setting = PAPER) -> SpringDamperModel | LawModel:
    """The ball on a contact of any law: that of the closed forms for linear contacts with ζ < 1.

    Examples
    --------
    >>> [type(model_of_law(SpringDamper(10.0, zeta))).__name__ for zeta in (0.5, 1.5)]
    ['SpringDamperModel', 'LawModel']
    """
    if isinstance(law, SpringDamper) and law.is_linear_and_underdamped:
        return SpringDamperModel(law, setting)
    return LawModel(law, setting)

"""Balls on a contact of any law."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.errors import ParameterError, Range
from bouncing_ball.models.dynamics import Dynamics
from bouncing_ball.models.instant import Instant
from bouncing_ball.models.laws.analytic import require_analytic
from bouncing_ball.models.laws.contact_law import ContactLaw
from bouncing_ball.models.laws.signature import Signature
from bouncing_ball.models.laws.steady_contact import permanent_contact
from bouncing_ball.models.model import Model
from bouncing_ball.models.setting import PAPER, Setting, require_setting


@dataclass(frozen=True, repr=False)
class LawModel(Model):
    """A ball on a contact of any law.

    A :class:`.SpringDamper` is such a law for every ζ and release. For ζ < 1 and a linear release
    :class:`.SpringDamperModel` has the same contacts, flights beside gravity, and the closed form
    of the branch, so that n-T orbits are those of this ball, which :func:`.model_of_law` makes.

    Parameters
    ----------
    law : ContactLaw
        One law, or an array of laws.
    setting : Setting, optional
        The motion of the table, by default that of the paper.

    Raises
    ------
    ModelError
        If the derivatives of the force by imaginary steps are not those by differences.

    Examples
    --------
    >>> from bouncing_ball.models.laws.hertzian import Tsuji, tsuji_damping
    >>> round(float(LawModel(Tsuji(500.0, tsuji_damping(0.85))).signature(3.0).restitution), 12)
    0.85
    """

    law: ContactLaw
    setting: Setting = PAPER

    name: ClassVar[str] = "contact-law"

    def __post_init__(self) -> None:
        require_setting(self.setting)
        require_analytic(self.law.started(1.0))
        if not self.setting.is_free:
            raise ParameterError(
                "{flight} is known for rigid and spring_damper, and not for contact laws"
            )

    @cached_property
    def parameters(self) -> Mapping[str, Any]:
        """The parameters of the law by name, and the name of the law."""
        return {"law": self.law.name, **super().parameters}

    def numbers(self) -> dict[str, Any]:
        """The numerical parameters of the law, all of which can vary; the flight is free."""
        return {name: x for name, x in super().numbers().items() if name != "drag"}

    def range_of(self, name: str) -> Range:
        """As for every model, but that an overdamped contact stays overdamped: the unknowns of its
        orbits are others than those below ζ = 1.
        """
        if name == "damping_ratio" and np.all(np.asarray(self.numbers()[name]) >= 1):
            return Range(1, np.inf, "[)")
        return super().range_of(name)

    def dynamics(self, amplitude: ArrayLike) -> Dynamics:
        """The contacts and flights of these balls on a table of amplitude Λ."""
        return self.law.dynamics(amplitude, self.place)

    def signature(self, speed: ArrayLike) -> Instant:
        """The signature of free impacts with speeds v > 0.

        Raises
        ------
        ModelError
            If the law does not release the ball.
        """
        law = self.law
        # One table serves all laws of such a kind; otherwise a few speeds cost less than a table.
        at = law.signature if law.scaled(np.ones(1)) is None else Signature(law)
        return at(speed)

    def permanent_contact_threshold(self) -> Any:
        """Λ up to which a steady contact never releases the ball, of the shape of the laws."""
        laws = self.law.flat(self.law.shape)
        table = self.setting.waveform
        found = [permanent_contact(laws.take(k), table) for k in range(self.law.size)]
        return np.array(found).reshape(self.law.shape)[()]

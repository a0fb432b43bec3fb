"""Balls on a contact of any law, of which the paper's spring and damper is one (Eqs. 10-15)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.errors import ParameterError, Range, shortened
from bouncing_ball_beyond.models.dynamics import Dynamics
from bouncing_ball_beyond.models.instant import Instant
from bouncing_ball_beyond.models.laws.analytic import require_analytic
from bouncing_ball_beyond.models.laws.contact_law import ContactLaw
from bouncing_ball_beyond.models.laws.signature import Signature
from bouncing_ball_beyond.models.laws.steady_contact import permanent_contact
from bouncing_ball_beyond.models.model import Model


@dataclass(frozen=True, repr=False)
class ContactModel(Model):
    """A ball on a table with a contact of finite duration between them (Eqs. 10-27).

    The law says which of its numbers have a closed form. A :class:`.SpringDamper` with ζ < 1 and a
    linear release has all of them, also that of the branch of n-T orbits.

    Parameters
    ----------
    law : ContactLaw
        One law, or an array of laws: for the paper's contact ϖ, ζ and the release rule of a
        :class:`.SpringDamper`.

    Raises
    ------
    ModelError
        If the law is none, or if the derivatives of its force by imaginary steps are not those by
        differences.

    Examples
    --------
    A parameter can vary; of r and ζ the other one follows (Eq. 16):

    >>> from bouncing_ball_beyond.models.spring_damper import SpringDamper
    >>> model = ContactModel(SpringDamper.from_restitution(1.0, 2.0))
    >>> {name: float(x) for name, x in model.numbers().items()}
    {'frequency_ratio': 2.0, 'damping_ratio': 0.0, 'restitution': 1.0}

    >>> from bouncing_ball_beyond.models.laws.hertzian import Tsuji, tsuji_damping
    >>> hertzian = ContactModel(Tsuji(500.0, tsuji_damping(0.85)))
    >>> round(float(hertzian.signature(3.0).restitution), 12)
    0.85
    """

    law: ContactLaw

    def __post_init__(self) -> None:
        if not isinstance(self.law, ContactLaw):
            raise ParameterError("law = {} is not a law of a contact", shortened(self.law))
        if not self.law.is_linear_and_underdamped:
            require_analytic(self.law.started(1.0))

    @property
    def name(self) -> str:
        """The name of the paper's model, or "contact-law" for all other contacts."""
        return "spring-damper" if self.law.is_linear_and_underdamped else "contact-law"

    @cached_property
    def parameters(self) -> Mapping[str, Any]:
        """The parameters of the law by name, and the name of a law that is not the paper's."""
        found = super().parameters
        return found if self.law.is_linear_and_underdamped else {"law": self.law.name, **found}

    def range_of(self, name: str) -> Range:
        """As for every model, but that an overdamped contact stays overdamped: the unknowns of its
        orbits are others than those below ζ = 1.
        """
        if name == "damping_ratio" and np.all(np.asarray(self.numbers()[name]) >= 1):
            return Range(1, np.inf, "[)")
        return super().range_of(name)

    def dynamics(self, amplitude: ArrayLike) -> Dynamics:
        """The contacts and flights of these balls on a table of amplitude Λ."""
        return self.law.dynamics(amplitude)

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
        """Λ up to which a steady contact never releases the ball, of the model's shape.

        It is Λ_SD(ϖ) or Λ_F(ϖ) for the paper's contact, depending on its release.

        Raises
        ------
        ModelError
            If a law has no closed form of it, and no such contact was found.
        """
        found: Any = self.law.permanent_contact
        if found is None:
            laws = self.law.flat(self.law.shape)
            found = np.reshape(
                [permanent_contact(laws.take(k)) for k in range(laws.size)], laws.shape
            )
        return np.broadcast_to(found, self.shape).astype(float)[()]

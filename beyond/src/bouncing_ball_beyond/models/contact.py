"""The interface of a contact of finite duration that the simulation uses.

The contact of the paper is the :class:`~bouncing_ball_beyond.models.spring_damper.SpringDamper`.
The simulation, the sequences of impacts and the histories use it by this interface only.
"""

from typing import Any, NamedTuple, Protocol, Self

import numpy as np


class ContactSpan(NamedTuple):
    """Contacts from their start to their release, arrays with one entry per contact.

    ``displacement`` δ, ``velocity`` δ′ and ``phase`` φ are those at the start, ``amplitude`` is Λ,
    ``duration`` is D, and ``release_displacement`` and ``release_velocity`` are δ and δ′ at the
    release.
    """

    displacement: np.ndarray
    velocity: np.ndarray
    phase: np.ndarray
    amplitude: np.ndarray
    duration: np.ndarray
    release_displacement: np.ndarray
    release_velocity: np.ndarray


class FiniteContact(Protocol):
    """A contact of finite duration, or a row of contacts with an entry for each ball."""

    @property
    def lag(self) -> Any:
        """κ of a contact that ends where δ + κ δ′ = 0; None if its end has no such form."""

    def during(self, span: ContactSpan, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """δ and δ′ at times 0 ≤ s ≤ D after the starts of contacts, one time for each contact."""

    def take(self, which: Any) -> Self:
        """The contacts with these indices; a single contact is unchanged."""

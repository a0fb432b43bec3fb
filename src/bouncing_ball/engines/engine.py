"""What every engine has: parameters from k, c and m, a release, a scheme, a text to paste."""

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

from bouncing_ball.contacts.damping import restitution_coefficient
from bouncing_ball.contacts.release import Release
from bouncing_ball.contacts.spring_damper import SpringDamper
from bouncing_ball.engines.scheme import Scheme, steps_for
from bouncing_ball.errors import ModelError, require

ERROR = 0.001
"""What a time step may leave of error in the restitution of a free impact."""

Parameters = Mapping[str, float | list[float]]


class Physical(NamedTuple):
    """A ball of mass m and the linear contact k p + c p′ between it and a wall, in SI units.

    Examples
    --------
    >>> contact = Physical(mass=2.0, stiffness=200.0, damping=4.0)
    >>> contact.angular_frequency, contact.damping_ratio
    (10.0, 0.1)
    """

    mass: float
    stiffness: float
    damping: float

    @property
    def angular_frequency(self) -> float:
        """ω = √(k/m), in rad/s."""
        return math.sqrt(self.stiffness / self.mass)

    @property
    def damping_ratio(self) -> float:
        """ζ = c/(2mω)."""
        return self.damping / (2 * self.mass * self.angular_frequency)

    def restitution(self, release: Release) -> float:
        """r of a free impact.

        Raises
        ------
        ModelError
            If ζ ≥ 1: the ball does not come back.
        """
        return float(restitution_coefficient(self.damping_ratio, release))

    def contact_time(self, release: Release) -> float:
        """Duration of a free impact, in s."""
        return float(
            SpringDamper(self.angular_frequency, self.damping_ratio, release).free_duration
        )


@dataclass(frozen=True)
class EngineSettings:
    """What to write into an engine, and what it will do.

    ``parameters`` are in the engine's units, under its names. ``time_step`` is in s: ``steps``
    of it in a contact leave the ``restitution`` of a free impact within ``error``. Of the orbit
    that a design is about are ``max_height`` and ``penetration`` in m and ``contact_duration``
    in s; None where there is no orbit.
    """

    name: str
    parameters: Parameters
    time_step: float
    release: str
    restitution: float
    steps: int
    error: float
    scheme: str
    snippet: str
    max_height: float | None = None
    contact_duration: float | None = None
    penetration: float | None = None


class Engine(ABC):
    """A physics engine and its linear contact between a ball and a wall at rest or moved.

    A subclass says its ``name``, its ``releases``, the one it has by default first, and the
    ``scheme`` that moves a ball in contact.
    """

    name: ClassVar[str]
    releases: ClassVar[tuple[Release, ...]]
    scheme: ClassVar[Scheme]

    @abstractmethod
    def parameters(self, contact: Physical) -> Parameters:
        """What the engine calls the contact, in its own units."""

    @abstractmethod
    def snippet(self, contact: Physical, release: Release, time_step: float) -> str:
        """The text to paste, with units in its comments."""

    @abstractmethod
    def read(self, parameters: Mapping[str, Any], mass: float | None) -> Physical:
        """The contact of parameters in the engine's own units and of a mass in kg."""

    def remarks(self, parameters: Mapping[str, Any]) -> tuple[str, ...]:
        """What a spring and a damper would do otherwise than the engine with these parameters."""
        return ()

    def release(self, asked: str | None = None) -> Release:
        """The release that is asked for, or that of the engine's default.

        Raises
        ------
        ModelError
            If the engine has no such release.
        """
        if asked is None:
            return self.releases[0]
        release = Release.of(asked)
        if release not in self.releases:
            has = " and ".join(self.releases)
            raise ModelError(f"{self.name} has no {release} release: its contacts end by {has}")
        return release

    def settings(
        self, contact: Physical, release: str | None = None, error: float = ERROR
    ) -> EngineSettings:
        """What to write into the engine for a contact, and what comes out of a free impact.

        Raises
        ------
        ModelError
            If the engine has no such release, or the contact does not bounce.
        """
        rule = self.release(release)
        # To twelve digits: those of a product are not written.
        contact = Physical(*(float(f"{value:.12g}") for value in contact))
        restitution = contact.restitution(rule)
        steps = steps_for(self.scheme, contact.damping_ratio, rule, error)
        step = float(f"{contact.contact_time(rule) / steps:.12g}")
        text = self.snippet(contact, rule, step)
        found = self.parameters(contact)
        return EngineSettings(
            self.name, found, step, str(rule), restitution, steps, error, str(self.scheme), text
        )

    def _given(
        self, parameters: Mapping[str, Any], mass: float | None, *names: str
    ) -> tuple[float, ...]:
        """The mass and then the parameters, all that the engine has and no other."""
        values = dict(parameters)
        if mass is None:
            raise ModelError(f"the mass is missing: {self.name}'s parameters do not have it")
        require(0 < mass < math.inf, mass, "mass", "a positive number of kg")
        if unknown := set(values) - set(names):
            all_of = " and ".join(names)
            raise ModelError(f"{self.name} has no {sorted(unknown)[0]!r}: its contact has {all_of}")
        for name in names:
            if name not in values:
                raise ModelError(f"{name} of {self.name} is missing")
            value = values[name]
            require(0 <= value < math.inf, value, name, "a number of at least 0")
        return (mass, *(float(values[name]) for name in names))

    def __repr__(self) -> str:
        return f"{type(self).__name__}()"


class Proportional(Engine):
    """An engine whose two parameters are a k and b c, with factors that know the mass alone.

    The factors are 1 where a subclass has no others.
    """

    names: ClassVar[tuple[str, str]]

    def factors(self, mass: float) -> tuple[float, float]:
        """The factors a and b, by which k and c are multiplied."""
        return 1.0, 1.0

    def parameters(self, contact: Physical) -> Parameters:
        stiff, lossy = self.factors(contact.mass)
        values = (stiff * contact.stiffness, lossy * contact.damping)
        return dict(zip(self.names, values, strict=True))

    def read(self, parameters: Mapping[str, Any], mass: float | None) -> Physical:
        m, *values = self._given(parameters, mass, *self.names)
        require(values[0] > 0, values[0], self.names[0], "positive")
        stiff, lossy = self.factors(m)
        return Physical(m, values[0] / stiff, values[1] / lossy)

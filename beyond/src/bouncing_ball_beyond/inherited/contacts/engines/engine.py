"""An engine is a row of a table: how its parameters give k and c."""

import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from bouncing_ball_beyond.inherited.contacts.engines.physical import Physical
from bouncing_ball_beyond.inherited.contacts.engines.scheme import Scheme, represented
from bouncing_ball_beyond.inherited.errors import ModelError, did_you_mean, require
from bouncing_ball_beyond.models.damping import Release
from bouncing_ball_beyond.models.laws.contact_law import ContactLaw

EngineParameters = Mapping[str, float | list[float]]
"""The parameters of an engine by name, in its units."""

_UNDERSCORE = re.compile("_([a-z])")
_STEP = "time_step"
_LIMIT = (
    "k, c and r are those in the limit of small time steps, which damp less; with the parameter "
    "time_step, in s, they are those of this step"
)


def twelve_digits(value: float) -> float:
    """A number with twelve digits, so that the rounding errors of products are not written."""
    return float(f"{value:.12g}")


def at_speeds(law: ContactLaw, speeds: np.ndarray) -> str:
    """The restitution of a law's free impacts at these speeds in m/s, in words."""
    found = zip(law.signature(speeds).restitution, speeds, strict=True)
    return "r = " + ", ".join(f"{r:.4f} at {v:.3g} m/s" for r, v in found)


class LawInSI(NamedTuple):
    """A contact law in SI units, with its stiffness per unit of mass.

    Engines also need the ``speed`` in m/s of an impact, the ``radius`` in m of the ball, and E and
    ν of both ``materials``, as far as they are known.
    """

    law: Any
    speed: float | None = None
    radius: float | None = None
    materials: tuple[float, ...] | None = None


@dataclass(frozen=True, eq=False, repr=False)
class Engine:
    """A physics engine and its contact between a ball and a wall, at rest or moving.

    Parameters
    ----------
    name : str
    names : tuple of str
        The names of its parameters, that of the stiffness first.
    releases : tuple of Release
        The default first.
    scheme : Scheme
        How it moves a ball in contact.
    parameters : callable
        The parameters in the engine's units, of a :class:`.Physical` and for another law than the
        spring and damper of its :class:`LawInSI`.
    contact_of : callable
        k and c of a mass in kg and the two numbers of the parameters.
    numbers : callable, optional
        These two numbers of the parameters, by default those under the two ``names``.
    law : callable, optional
        The contact law of the parameters, dimensionless with units of mass in kg, time in s and
        length in m; None if the contact is a spring and a damper.
    remarks : callable, optional
        Sentences on how the contact with these parameters differs from a spring and a damper.
    instant : callable, optional
        How impacts that are instants with a given r are set, in words, if r is a number beside
        those of the contact.
    defaults : mapping, optional
        The parameters that a contact has in the engine if none are set, by name; empty if it then
        has no contact that lasts, or one that this row does not describe.
    laws : mapping, optional
        The rows of the engine's other contact laws, by the names that users may give.
    written_law : type of ContactLaw, optional
        The law of such a row.
    needs_speed : bool, optional
        Whether the damping depends on the impact speed, so that :meth:`read` returns c = 0.
    has_mass : bool, optional
        Whether the mass in kg is one of the parameters.
    """

    name: str
    names: tuple[str, ...]
    releases: tuple[Release, ...]
    scheme: Scheme
    parameters: Callable[..., EngineParameters]
    contact_of: Callable[[float, float, float], tuple[float, float]]
    numbers: Callable[["Engine", Mapping[str, Any]], tuple[float, float]] | None = None
    law: Callable[..., Any] = lambda *_: None
    remarks: Callable[[Mapping[str, Any]], tuple[str, ...]] = lambda _: ()
    instant: Callable[[float], str] | None = None
    defaults: Mapping[str, Any] = field(default_factory=dict)
    laws: Mapping[str, "Engine"] = field(default_factory=dict)
    written_law: type[ContactLaw] | None = None
    needs_speed: bool = False
    has_mass: bool = False

    @property
    def names_of_laws(self) -> dict[str, str]:
        """The names of the engine's other laws, by the names that users may give."""
        rows = self.laws.items()
        return {name: row.written_law.name for name, row in rows if row.written_law is not None}

    def release(self, asked: str | None = None) -> Release:
        """The release with this name, or the engine's default.

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

    def read(self, parameters: Mapping[str, Any], mass: float | None) -> Physical:
        """The contact with these parameters, in the engine's units, and with a mass in kg.

        Raises
        ------
        ModelError
            If a parameter or the mass is missing, unknown, or outside its range.
        """
        given = {name: value for name, value in parameters.items() if value is not None}
        # Isaac Lab writes the names of PhysX with underscores.
        joined = {name: _UNDERSCORE.sub(lambda found: found[1].upper(), name) for name in given}
        values = {
            joined[name] if joined[name] in self.names else name: value
            for name, value in given.items()
        }
        if self.has_mass:
            mass = values.pop("mass", mass)
        if unknown := set(values) - set(self.names):
            names = " and ".join(self.names)
            # The dampings of the engine's other laws, whose parameters are read as well.
            others = [row.names[1] for row in self.laws.values() if row.needs_speed]
            names = " or ".join([names, *others])
            first = sorted(unknown)[0]
            if first == _STEP:
                names += ", and the step of any engine is given by --time-step or time_step"
            known = (*self.names, *others)
            longer = [name for name in known if first.casefold() in name.casefold()]
            meant = f"; did you mean {longer[0]}?" if longer else did_you_mean(first, known)
            raise ModelError(f"{self.name} has no {first!r}: its parameters are {names}{meant}")
        if mass is None:
            raise ModelError(
                f"the mass is missing: the parameters of {self.name} do not contain it"
            )
        require(0 < mass < math.inf, mass, "mass", "a positive number of kg")
        first, second = (self.numbers or two_numbers)(self, values)
        return Physical(float(mass), *self.contact_of(float(mass), first, second))

    def contact(self, parameters: Mapping[str, Any], mass: float | None) -> Physical:
        """The contact that the engine computes with these parameters, and a ``time_step`` in s.

        The time step is a parameter of engines with implicit steps only. Without it the contact is
        the limit of small steps.

        Raises
        ------
        ModelError
            See :meth:`read`; or if the time step is not positive.
        """
        if not self.scheme.is_implicit or _STEP not in parameters:
            return self.read(parameters, mass)
        step = parameters[_STEP]
        require(0 < step < math.inf, step, _STEP, "a positive number of s")
        found = self.read(without_step(parameters), mass)
        if not self.scheme.is_compensated:
            return found
        m, k, c = found
        return Physical(m, *(value * m for value in represented(k / m, c / m, step)))

    def notes(self, parameters: Mapping[str, Any]) -> tuple[str, ...]:
        """Sentences on how the contact with these parameters differs from a spring and damper."""
        if _STEP in parameters:
            return ()
        limit = (_LIMIT,) if self.scheme.is_compensated else ()
        return (*limit, *self.remarks(parameters))


def without_step(parameters: Mapping[str, Any]) -> dict[str, Any]:
    """The parameters of an engine without a ``time_step``."""
    return {name: value for name, value in parameters.items() if name != _STEP}


def two_numbers(engine: Engine, parameters: Mapping[str, Any]) -> tuple[float, float]:
    """The engine's parameters of stiffness, which must be positive, and of damping, in its units.

    Raises
    ------
    ModelError
        If one is missing or outside its range.
    """
    for name in engine.names:
        if name not in parameters:
            both = " and ".join(engine.names)
            raise ModelError(f"{name} is missing: the parameters of {engine.name} are {both}")
        value = float(parameters[name])
        require(0 <= value < math.inf, value, name, "a number of at least 0")
    stiffness, damping = (float(parameters[name]) for name in engine.names)
    require(stiffness > 0, stiffness, engine.names[0], "positive")
    return stiffness, damping


def proportional(
    name: str,
    names: tuple[str, str],
    releases: tuple[Release, ...],
    scheme: Scheme,
    factors: Callable[[float], tuple[float, float]] = lambda mass: (1.0, 1.0),
    **more: Any,
) -> Engine:
    """An engine with two parameters a·k and b·c, whose ``factors`` a and b depend on the mass.

    Examples
    --------
    >>> rule = (Release.FORCE,)
    >>> halves = proportional("e", ("a", "b"), rule, Scheme.IMPLICIT, lambda m: (2.0, 0.5))
    >>> halves.parameters(Physical(mass=1.0, stiffness=100.0, damping=4.0))
    {'a': 200.0, 'b': 2.0}
    >>> halves.read({"a": 200.0, "b": 2.0}, 1.0)
    Physical(mass=1.0, stiffness=100.0, damping=4.0)
    """

    def parameters(contact: Physical, law: LawInSI | None = None) -> EngineParameters:
        a, b = factors(contact.mass)
        return dict(zip(names, (a * contact.stiffness, b * contact.damping), strict=True))

    def contact_of(mass: float, stiffness: float, damping: float) -> tuple[float, float]:
        a, b = factors(mass)
        return stiffness / a, damping / b

    return Engine(name, names, releases, scheme, parameters, contact_of, **more)

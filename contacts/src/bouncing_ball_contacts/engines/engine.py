"""An engine is a row of a table; and a contact as it is written for one."""

import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from importlib.resources import files
from typing import Any, NamedTuple

import numpy as np

from bouncing_ball_beyond.inherited.errors import ModelError, did_you_mean, require
from bouncing_ball_beyond.models.damping import Release
from bouncing_ball_beyond.models.laws.contact_law import ContactLaw
from bouncing_ball_beyond.models.laws.hertzian import LinearHuntCrossley
from bouncing_ball_contacts.engines.drop_in_steps import (
    MOST_STEPS,
    DropInSteps,
    drop_in_steps,
    restitutions_in_steps,
)
from bouncing_ball_contacts.engines.given_step import AtStep, at_step, retuned_damping
from bouncing_ball_contacts.engines.hunt_crossley_steps import (
    at_step_of_law,
    missing_speed,
    retuned_damping_of_law,
)
from bouncing_ball_contacts.engines.impacts import steps_for
from bouncing_ball_contacts.engines.least_error import (
    damping_of_least_error,
    stiffness_of_least_error,
)
from bouncing_ball_contacts.engines.physical import Physical
from bouncing_ball_contacts.engines.scheme import Scheme, compensated, represented
from bouncing_ball_contacts.engines.settings import EngineParameters, EngineSettings
from bouncing_ball_contacts.engines.steps import LinearStep, Step, step_of_law

ERROR = 0.001
"""The default of the largest error of a free impact's r that the time step may cause."""

# A whole number of steps is not rounded down.
_ALMOST = 1 + 1e-9
_PLACE = re.compile(r"@([\w.]+)@")
_UNDERSCORE = re.compile("_([a-z])")
_STEP = "time_step"
_LIMIT = (
    "k, c and r are those in the limit of small time steps, which damp less; with the parameter "
    "time_step, in s, they are those of this step"
)


def twelve_digits(value: float) -> float:
    """A number with twelve digits, so that the rounding errors of products are not written."""
    return float(f"{value:.12g}")


def text_to_paste(name: str) -> str:
    """The text to paste of an engine, from its file, with placeholders for the numbers."""
    return files(__package__).joinpath(f"snippets/{name}.txt").read_text("utf-8")


def filled(text: str, numbers: Mapping[str, str]) -> str:
    """A text with numbers for its placeholders; lines with a number not given are left out."""
    lines = (line for line in text.splitlines() if numbers.keys() >= {*_PLACE.findall(line)})
    return _PLACE.sub(lambda place: numbers[place[1]], "\n".join(lines))


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
    kept_stable : callable, optional
        The parameters as the engine changes them at a time step in s, and sentences on it.
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
    text : str, optional
        The file of the text to paste, ``snippets/TEXT.txt``, by default that with its name.
    half_steps : bool, optional
        Whether velocities are those of half steps, so that free flights are exact.
    was_run : bool, optional
        Whether the text to paste was run in the engine.
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
    kept_stable: Callable[[Mapping[str, Any], float], tuple[Any, tuple[str, ...]]] = (
        lambda parameters, _: (parameters, ())
    )
    instant: Callable[[float], str] | None = None
    defaults: Mapping[str, Any] = field(default_factory=dict)
    laws: Mapping[str, "Engine"] = field(default_factory=dict)
    written_law: type[ContactLaw] | None = None
    text: str = ""
    half_steps: bool = False
    was_run: bool = True
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

    def at_step_of(
        self,
        parameters: Mapping[str, Any],
        mass: float | None,
        time_step: float,
        error: float = ERROR,
        release: str | None = None,
        speed: float | None = None,
    ) -> tuple["Written", AtStep]:
        """The contact that the engine computes with parameters and a time step in s, and what it
        does there, at an impact speed in m/s if r depends on it.

        Parameters that are not made for this step are damped by it: r is then compared with the
        limit of small steps.

        Raises
        ------
        ModelError
            See :meth:`read`; or if r depends on the speed and none is given.
        """
        rule = self.release(release)
        asked = Written(self, self.read(parameters, mass), rule)
        values, remarks = self.kept_stable(parameters, time_step)
        if self.scheme.is_compensated:
            values = {**values, _STEP: time_step}
        contact = self.contact(values, mass)
        law = self.law(values, contact.mass)
        found = Written(self, contact, rule, None if law is None else LawInSI(law, speed))
        at = found.at_step(time_step, error, asked)
        tuned = None if at.is_within else found.retuned(at, asked)
        return found, replace(at, remarks=remarks, retuned=tuned)

    def settings(
        self,
        contact: Physical,
        release: str | None = None,
        error: float = ERROR,
        time_step: float | None = None,
        law: LawInSI | None = None,
    ) -> EngineSettings:
        """The settings for a contact, with a time step that changes r by at most ``error``.

        With a ``time_step`` in s they are for this step, whatever r the contact then has.

        Raises
        ------
        ModelError
            If the engine has no such release, the contact does not bounce, or the error is not
            positive.

        Examples
        --------
        >>> from bouncing_ball_contacts.engines.choice import ENGINES
        >>> mujoco = ENGINES["mujoco"]
        >>> found = mujoco.settings(Physical(1.0, 1e6, 200.0), error=0.01, time_step=2e-4)
        >>> found.at_step.is_within, found.time_step, found.parameters["solref"]
        (False, 0.0002, [-1000000.0, -200.0])
        """
        rule = self.release(release)
        written = Written(self, Physical(*map(twelve_digits, contact)), rule, law)
        if time_step is not None:
            return written.settings(written.at_step(time_step, error))
        steps = steps_for(self.scheme, written.contact.damping_ratio, rule, error)
        step = twelve_digits(written.contact.contact_time(rule) / steps)
        return written._settings(error, step, steps, None)


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


@dataclass(frozen=True)
class Written:
    """A contact as it is written for an engine: its linear contact, and its law if it is another.

    Examples
    --------
    >>> from bouncing_ball_contacts.engines.choice import ENGINES
    >>> written = Written(ENGINES["mujoco"], Physical(1.0, 100.0, 2.0), Release.FORCE)
    >>> written.with_stiffness(400.0).contact
    Physical(mass=1.0, stiffness=400.0, damping=4.0)
    """

    engine: Engine
    contact: Physical
    release: Release
    of_law: LawInSI | None = None

    @property
    def _by_speed(self) -> LawInSI | None:
        """The law, if r depends on the speed under it and its steps are known."""
        of = self.of_law
        return of if of is not None and isinstance(of.law, LinearHuntCrossley) else None

    def step(self, time_step: float) -> Step:
        """A time step in s of a ball in this contact."""
        found = None if self.of_law is None else step_of_law(self.of_law.law, time_step)
        if found is not None:
            return found
        m, k, c = self.contact
        return LinearStep.of(self.engine.scheme, k / m, c / m, self.release, time_step)

    def at_step(self, time_step: float, error: float, asked: "Written | None" = None) -> AtStep:
        """What the contact does with a time step in s, in place of the one that was asked for."""
        of = self._by_speed
        if of is None:
            given = self.engine.name, self.engine.scheme, self.contact, self.release
            return at_step(*given, time_step, error, None if asked is None else asked.contact)
        if of.speed is None:
            raise missing_speed()
        wanted = None if asked is None or asked.of_law is None else asked.of_law.law
        return at_step_of_law(self.engine.name, of.law, of.speed, time_step, error, wanted)

    def retuned(self, at: AtStep, asked: "Written") -> float | None:
        """The damping of :meth:`with_damping` with which the mean r at the step of ``at`` is that
        of the contact that was asked for; None if there is none.
        """
        of = self._by_speed
        if of is not None:
            return retuned_damping_of_law(at, of.law)
        scheme = self.engine.scheme
        # A compensated scheme is told the contact that was asked for, with another damping.
        contact = asked.contact if scheme.is_compensated else self.contact
        return retuned_damping(at, scheme, contact, self.release)

    def with_damping(self, damping: float) -> "Written":
        """The same with another damping, in N s/m, or in s/m if it is that of the law."""
        of = self._by_speed
        if of is None:
            return replace(self, contact=self.contact._replace(damping=damping))
        return replace(self, of_law=of._replace(law=replace(of.law, damping=damping)))

    def with_stiffness(self, stiffness: float) -> "Written":
        """The same with another stiffness in N/m, and with the same r, at each speed."""
        m, k, c = self.contact
        factor = stiffness / self.stiffness
        linear = Physical(m, twelve_digits(k * factor), twelve_digits(c * math.sqrt(factor)))
        of = self._by_speed
        if of is None:
            return replace(self, contact=linear)
        law = replace(of.law, stiffness=stiffness / m)
        return replace(self, contact=linear, of_law=of._replace(law=law))

    @property
    def stiffness(self) -> float:
        """The stiffness in N/m that is written, without what compensates a step."""
        of = self._by_speed
        return self.contact.stiffness if of is None else of.law.stiffness * self.contact.mass

    def parameters(self, time_step: float) -> EngineParameters:
        """The engine's parameters with which it has this contact at a time step in s."""
        contact = self.contact
        if self.engine.scheme.is_compensated:
            m, k, c = contact
            both = compensated(k / m, c / m, time_step)
            contact = Physical(m, *(twelve_digits(x * m) for x in both))
        return self.engine.parameters(contact, self.of_law)

    def restitutions(self) -> dict[str, float]:
        """r of a free impact under the release, and under those other releases of the engine under
        which the ball rebounds.

        Raises
        ------
        ModelError
            If ζ ≥ 1 and the release is the displacement release.
        """
        slow = self.contact.damping_ratio < 1
        rules = [rule for rule in self.engine.releases if rule is self.release or slow]
        return {str(rule): self.contact.restitution(rule) for rule in rules}

    def snippet(self, time_step: float, at: AtStep | None = None) -> str:
        """The text to paste for a time step in s; its comments give the units, and r, at a step
        that does not resolve the contact as it is there.

        A line of ``snippets/NAME.txt`` that is for one release only begins with the release's name.
        There is no line about a release under which the ball would not rebound.
        """
        values: dict[str, Any] = {**self.contact._asdict(), _STEP: time_step}
        if self.of_law is not None:
            values["radius"] = twelve_digits(self.of_law.radius or math.nan)
        for name, value in self.parameters(time_step).items():
            numbers = [twelve_digits(x) for x in np.ravel(value).tolist()]
            values |= {f"{name}.{k}": x for k, x in enumerate(numbers)}
            values[name] = numbers[0]
        texts = {name: repr(value) for name, value in values.items()}
        if at is None or at.is_within:
            texts |= {rule: f"{r:.4f}" for rule, r in self.restitutions().items()}
        else:
            texts[str(self.release)] = f"{at.span} at this step"
        lines = text_to_paste(self.engine.text or self.engine.name).splitlines()
        parts = (line.rpartition("|") for line in lines)
        ours = ("", str(self.release))
        return filled("\n".join(line for rule, _, line in parts if rule in ours), texts)

    def settings(self, at: AtStep) -> EngineSettings:
        """The settings at a time step that is given."""
        duration = self.contact.contact_time(self.release)
        steps = math.floor(duration / at.time_step * _ALMOST)
        return self._settings(at.allowed, at.time_step, steps, at)

    def _settings(self, error: float, step: float, steps: int, at: AtStep | None) -> EngineSettings:
        return EngineSettings(
            name=self.engine.name,
            contact=self.contact,
            parameters=self.parameters(step),
            time_step=step,
            release=str(self.release),
            restitution=self.contact.restitution(self.release),
            restitutions=self.restitutions(),
            steps=steps,
            error=error,
            scheme=str(self.engine.scheme),
            snippet=self.snippet(step, at),
            at_step=at,
        )

    @property
    def damping(self) -> float:
        """The damping that :meth:`with_damping` replaces."""
        of = self._by_speed
        return self.contact.damping if of is None else of.law.damping

    def tuned(
        self, at: AtStep, restitution: float, height: float, gravity: float
    ) -> tuple["Written", AtStep]:
        """The contact with another damping, with which √(h′/h) of a drop is nearest to a
        restitution at the step of ``at``, and what it does there.
        """

        def error(damping: float) -> float:
            step = self.with_damping(damping).step(at.time_step)
            half = self.engine.half_steps
            found = restitutions_in_steps(step, height, gravity, at.steps, half_steps=half)
            # A ball that rises higher than it fell is farther off than one that stays.
            gains = found.max() >= 1 > restitution
            return float(np.abs(found - restitution).max()) + gains

        found = self.with_damping(damping_of_least_error(error, self.damping))
        return found, found.at_step(at.time_step, at.allowed, self)

    def suited(
        self, at: AtStep, restitution: float, height: float, gravity: float
    ) -> tuple["Written", AtStep]:
        """The contact with the free r of ``at`` and another stiffness, with which √(h′/h) of a drop
        is nearest to a restitution at the step of ``at``, and what it does there.
        """
        half = self.engine.half_steps

        def found(stiffness: float, steps: float) -> np.ndarray:
            step = self.with_stiffness(stiffness).step(at.time_step)
            return restitutions_in_steps(step, height, gravity, steps, half_steps=half)

        best = stiffness_of_least_error(found, restitution, self.stiffness * at.steps**2)
        other = self.with_stiffness(best)
        return other, other.at_step(at.time_step, at.allowed)

    def drop(
        self,
        time_step: float,
        steps: float,
        height: float,
        gravity: float,
        restitution: float,
        *,
        is_stable: bool = True,
    ) -> DropInSteps | None:
        """A drop at a time step in s of which so many are in a contact; None if these are too many.

        ``restitution`` is the r that was asked for.
        """
        if steps > MOST_STEPS:
            return None
        return drop_in_steps(
            self.step(time_step),
            self.contact.mass,
            height,
            gravity,
            steps,
            restitution,
            half_steps=self.engine.half_steps,
            is_stable=is_stable,
        )

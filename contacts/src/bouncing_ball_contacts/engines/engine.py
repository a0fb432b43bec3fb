"""The interface of an engine: parameters from k, c and m, release rules, a time-stepping scheme,
and a text to paste."""

import math
import re
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import replace
from importlib.resources import files
from typing import Any, ClassVar

import numpy as np

from bouncing_ball.errors import ModelError, did_you_mean, require
from bouncing_ball_beyond.models.damping import Release
from bouncing_ball_beyond.models.laws.contact_law import ContactLaw
from bouncing_ball_contacts.engines.drop_in_steps import (
    MOST_STEPS,
    DropInSteps,
    drop_in_steps,
    restitutions_in_steps,
)
from bouncing_ball_contacts.engines.given_step import AtStep, at_step
from bouncing_ball_contacts.engines.impacts import steps_for
from bouncing_ball_contacts.engines.least_error import stiffness_of_least_error
from bouncing_ball_contacts.engines.physical import Physical
from bouncing_ball_contacts.engines.scheme import Scheme, compensated, represented
from bouncing_ball_contacts.engines.settings import EngineParameters, EngineSettings
from bouncing_ball_contacts.engines.steps import LinearStep, Step

ERROR = 0.001
"""The default of the largest error of a free impact's r that the time step may cause."""

# A whole number of steps is not rounded down.
_ALMOST = 1 + 1e-9
_PLACE = re.compile(r"@([\w.]+)@")


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


class Engine(ABC):
    """A physics engine and its linear contact between a ball and a wall, at rest or moving.

    A subclass defines its ``name``, the ``names`` of its parameters, its ``releases`` with the
    default first, and the ``scheme`` by which it moves a ball in contact. Its text to paste is
    ``snippets/NAME.txt``, where NAME may be another ``text``.
    """

    name: ClassVar[str]
    names: ClassVar[tuple[str, ...]]
    releases: ClassVar[tuple[Release, ...]]
    scheme: ClassVar[Scheme]
    laws: ClassVar[dict[str, str]] = {}
    """The names of the engine's other contact laws, by the names that users may give."""
    text: ClassVar[str] = ""
    has_steps_of_law: ClassVar[bool] = False
    """Whether it is known what the engine's law does at a time step that is given."""
    half_steps: ClassVar[bool] = False
    """Whether velocities are those of half steps, so that free flights are exact."""
    was_run: ClassVar[bool] = True
    """Whether the text to paste was run in the engine."""
    needs_speed: ClassVar[bool] = False
    """Whether the damping depends on the impact speed, so that :meth:`read` returns c = 0."""

    @abstractmethod
    def parameters(self, contact: Physical) -> EngineParameters:
        """The parameters of a contact, in the units and under the names of the engine."""

    def for_step(self, contact: Physical, time_step: float) -> Physical:
        """The contact whose parameters let the engine compute a contact with a time step in s."""
        if self.scheme is not Scheme.COMPENSATED:
            return contact
        m, k, c = contact
        return Physical(m, *(twelve_digits(x * m) for x in compensated(k / m, c / m, time_step)))

    def contact(self, parameters: Mapping[str, Any], mass: float | None) -> Physical:
        """The contact that the engine computes with these parameters, and a ``time_step`` in s.

        The time step is a parameter of engines with a compensated scheme only. Without it the
        contact is the limit of small steps.

        Raises
        ------
        ModelError
            See :meth:`read`; or if the time step is not positive.
        """
        if self.scheme is not Scheme.COMPENSATED or "time_step" not in parameters:
            return self.read(parameters, mass)
        values = dict(parameters)
        step = values.pop("time_step")
        require(0 < step < math.inf, step, "time_step", "a positive number of s")
        m, k, c = self.read(values, mass)
        return Physical(m, *(value * m for value in represented(k / m, c / m, step)))

    def numbers(self, contact: Physical) -> dict[str, float]:
        """The parameters of a contact as single numbers; an entry of a list is named NAME.INDEX."""
        found: dict[str, float] = {}
        for name, value in self.parameters(contact).items():
            many = {f"{name}.{k}": x for k, x in enumerate(np.ravel(value).tolist())}
            found |= many if isinstance(value, list) else {name: value}
        return found

    def template(self, release: Release) -> str:
        """The text to paste for a release, with placeholders ``@name@`` for the numbers.

        A line of ``snippets/NAME.txt`` that is for one release only begins with the release's name.
        """
        lines = (
            line.rpartition("|") for line in text_to_paste(self.text or self.name).splitlines()
        )
        return "\n".join(line for rule, _, line in lines if rule in ("", release))

    def snippet(
        self, contact: Physical, release: Release, time_step: float, at: AtStep | None = None
    ) -> str:
        """The text to paste for a contact and a time step in s; its comments give the units, and r,
        at a step that does not resolve the contact as it is there.

        It has no line about a release under which the ball would not rebound.
        """
        values = {**contact._asdict(), "time_step": time_step}
        values |= self.numbers(self.for_step(contact, time_step))
        texts = {name: repr(value) for name, value in values.items()}
        texts |= {rule: f"{r:.4f}" for rule, r in self.restitutions(contact, release).items()}
        if at is not None and not at.is_within:
            texts = {name: text for name, text in texts.items() if name not in list(Release)}
            texts[release] = f"{at.span} at this step"
        return filled(self.template(release), texts)

    @abstractmethod
    def read(self, parameters: Mapping[str, Any], mass: float | None) -> Physical:
        """The contact with these parameters, in the engine's units, and with a mass in kg.

        Raises
        ------
        ModelError
            If a parameter or the mass is missing, unknown, or outside its range.
        """

    def reader(self, parameters: Mapping[str, Any]) -> "Engine":
        """The engine, or the part of it to which these parameters belong."""
        return self

    def law(
        self, parameters: Mapping[str, Any], mass: float = 1, time: float = 1, length: float = 1
    ) -> ContactLaw | None:
        """The contact law with these parameters for a mass in kg, dimensionless with units of time
        in s and length in m.

        None if the contact is the spring and damper of :meth:`read`.
        """
        return None

    def at_depth(self, parameters: Mapping[str, Any], depth: float) -> str:
        """A clause on what distinguishes the law of :meth:`law` from the spring and damper of
        :meth:`read` at a depth in m.
        """
        return "where the contact is not a spring and a damper"

    def with_law(self, law_in_si: Mapping[str, Any]) -> "Engine":
        """The engine for a contact law, which has a ``name`` and its parameters in SI units, also
        the ``radius`` in m of the ball and the ``speed`` in m/s of an impact, if they are known.

        Its settings are made from the linear contact with the same restitution and duration.

        Raises
        ------
        ModelError
            If the engine has no such law.
        """
        raise ModelError(f"{law_in_si['name']} is not written for {self.name}")

    def remarks(self, parameters: Mapping[str, Any]) -> tuple[str, ...]:
        """Sentences on how the contact with these parameters differs from a spring and damper."""
        if self.scheme is not Scheme.COMPENSATED or "time_step" in parameters:
            return ()
        limit = "k, c and r are those in the limit of small time steps, which damp less"
        return (f"{limit}; with the parameter time_step, in s, they are those of this step",)

    def instant(self, restitution: float, time_step: float) -> Step | None:
        """The step of impacts that are instants, for engines in which r is a number beside those of
        the contact; None without such a number.
        """
        return None

    def instant_in_words(self, restitution: float) -> str:
        """How such an impact is set; empty without one."""
        return ""

    def stiffness_at_rest(self, parameters: Mapping[str, Any], mass: float | None) -> float:
        """The stiffness in N/m that carries a ball at rest.

        Steps that are implicit do not damp a ball at rest, so that it is that of the parameters,
        whatever contact they are at a step.
        """
        values = {name: value for name, value in parameters.items() if name != "time_step"}
        return self.read(values, mass).stiffness

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

    def restitutions(self, contact: Physical, release: Release) -> dict[Release, float]:
        """r of a free impact under a release, and under those other releases of the engine under
        which the ball rebounds.

        Raises
        ------
        ModelError
            If ζ ≥ 1 and ``release`` is the displacement release.
        """
        slow = contact.damping_ratio < 1
        rules = [rule for rule in self.releases if rule is release or slow]
        return {rule: contact.restitution(rule) for rule in rules}

    def settings(
        self,
        contact: Physical,
        release: str | None = None,
        error: float = ERROR,
        time_step: float | None = None,
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
        >>> from bouncing_ball_contacts.engines.mujoco import MuJoCo
        >>> found = MuJoCo().settings(Physical(1.0, 1e6, 200.0), error=0.01, time_step=2e-4)
        >>> found.at_step.is_within, found.time_step, found.parameters["solref"]
        (False, 0.0002, [-1000000.0, -200.0])
        """
        rule = self.release(release)
        contact = Physical(*map(twelve_digits, contact))
        if time_step is None:
            steps = steps_for(self.scheme, contact.damping_ratio, rule, error)
            step = twelve_digits(contact.contact_time(rule) / steps)
            return self._settings(contact, rule, error, step, steps)
        return self._at(contact, rule, self.at_step(contact, rule, time_step, error))

    def retuned(
        self, contact: Physical, release: Release, at: AtStep
    ) -> tuple["Engine", EngineSettings] | None:
        """The engine and the settings of a contact with the damping that restores the mean r at the
        step of ``at``; None if no damping does.
        """
        if at.retuned is None:
            return None
        engine, tuned = self._retuned(contact, twelve_digits(at.retuned), at.restitution)
        again = engine.at_step(tuned, release, at.time_step, at.allowed, contact)
        return engine, engine._at(tuned, release, again)

    def suited(
        self,
        contact: Physical,
        release: Release,
        at: AtStep,
        restitution: float,
        height: float,
        gravity: float,
    ) -> tuple["Engine", EngineSettings]:
        """The engine and the settings of the contact with the free r of ``at`` and another
        stiffness, with which √(h′/h) of a drop is nearest to a restitution at the step of ``at``.
        """

        def found(stiffness: float, steps: float) -> np.ndarray:
            engine, other = self.with_stiffness(contact, stiffness)
            step = engine.step(other, release, at.time_step)
            return restitutions_in_steps(step, height, gravity, steps, half_steps=self.half_steps)

        one = self.stiffness(contact) * at.steps**2
        best = stiffness_of_least_error(found, restitution, one)
        engine, other = self.with_stiffness(contact, best)
        again = engine.at_step(other, release, at.time_step, at.allowed)
        return engine, engine._at(other, release, again)

    def stiffness(self, contact: Physical) -> float:
        """The stiffness in N/m that is written for a contact, without what compensates a step."""
        return contact.stiffness

    def with_stiffness(self, contact: Physical, stiffness: float) -> tuple["Engine", Physical]:
        """The engine and the contact with a stiffness in N/m and the same r.

        Examples
        --------
        >>> from bouncing_ball_contacts.engines.mujoco import MuJoCo
        >>> MuJoCo().with_stiffness(Physical(1.0, 100.0, 2.0), 400.0)
        (MuJoCo(), Physical(mass=1.0, stiffness=400.0, damping=4.0))
        """
        m, k, c = contact
        return self, Physical(m, stiffness, twelve_digits(c * math.sqrt(stiffness / k)))

    def drop(
        self, settings: EngineSettings, height: float, gravity: float, restitution: float
    ) -> DropInSteps | None:
        """A drop with settings of this engine; None if a contact takes too many steps.

        ``restitution`` is the r that was asked for.
        """
        if settings.steps > MOST_STEPS:
            return None
        step = self.step(settings.contact, Release(settings.release), settings.time_step)
        return drop_in_steps(
            step,
            settings.contact.mass,
            height,
            gravity,
            settings.steps,
            restitution,
            half_steps=self.half_steps,
            is_stable=settings.at_step is None or settings.at_step.is_stable,
        )

    def _retuned(
        self, contact: Physical, damping: float, restitution: float
    ) -> tuple["Engine", Physical]:
        """The engine and the contact with the damping that restores the mean r at a step."""
        return self, contact._replace(damping=damping)

    def _at(self, contact: Physical, release: Release, at: AtStep) -> EngineSettings:
        """The settings of a contact at a time step that is given."""
        steps = math.floor(contact.contact_time(release) / at.time_step * _ALMOST)
        return self._settings(contact, release, at.allowed, at.time_step, steps, at)

    def _settings(
        self,
        contact: Physical,
        release: Release,
        error: float,
        step: float,
        steps: int,
        at: AtStep | None = None,
    ) -> EngineSettings:
        by_rule = {str(one): r for one, r in self.restitutions(contact, release).items()}
        return EngineSettings(
            name=self.name,
            contact=contact,
            parameters=self.parameters(self.for_step(contact, step)),
            time_step=step,
            release=str(release),
            restitution=contact.restitution(release),
            restitutions=by_rule,
            steps=steps,
            error=error,
            scheme=str(self.scheme),
            snippet=self.snippet(contact, release, step, at),
            at_step=at,
        )

    def step(self, contact: Physical, release: Release, time_step: float) -> Step:
        """A time step in s of a ball in a contact that is written for the engine."""
        m, k, c = contact
        return LinearStep.of(self.scheme, k / m, c / m, release, time_step)

    def at_step(
        self,
        contact: Physical,
        release: Release,
        time_step: float,
        error: float,
        asked: Physical | None = None,
    ) -> AtStep:
        """What a contact that is written for the engine does with a time step in s, in place of the
        one that was asked for.
        """
        given = self.name, self.scheme, contact, release
        return at_step(*given, time_step=time_step, error=error, asked=asked)

    def at_step_of(
        self,
        parameters: Mapping[str, Any],
        mass: float | None,
        time_step: float,
        error: float = ERROR,
        release: str | None = None,
        speed: float | None = None,
    ) -> AtStep:
        """What the engine does with parameters and a time step in s, at an impact speed in m/s if r
        depends on it.

        Parameters that are not made for this step are damped by it: r is then compared with the
        limit of small steps.

        Raises
        ------
        ModelError
            See :meth:`read`.
        """
        rule = self.release(release)
        asked = self.read(parameters, mass)
        contact, remarks = self.stepped(parameters, mass, time_step)
        found = at_step(self.name, self.scheme, contact, rule, time_step, error, asked=asked)
        return replace(found, remarks=remarks)

    def stepped(
        self, parameters: Mapping[str, Any], mass: float | None, time_step: float
    ) -> tuple[Physical, tuple[str, ...]]:
        """The contact that the engine computes with parameters and a time step in s, and sentences
        on it.
        """
        if self.scheme is not Scheme.COMPENSATED:
            return self.read(parameters, mass), ()
        return self.contact({**parameters, "time_step": time_step}, mass), ()

    def at_parameters(
        self, parameters: Mapping[str, Any], mass: float | None, time_step: float
    ) -> tuple["Engine", Physical]:
        """The engine and the contact that it computes with parameters and a time step in s, whose
        :meth:`step` is that of their law.
        """
        return self, self.stepped(parameters, mass, time_step)[0]

    def _given(self, parameters: Mapping[str, Any], mass: float | None) -> float:
        """The mass in kg, after a check of it and of the names of all parameters."""
        if unknown := set(parameters) - set(self.names):
            names = " and ".join(self.names)
            first = sorted(unknown)[0]
            if first == "time_step":
                names += ", and the step of any engine is given by --time-step or time_step"
            meant = did_you_mean(first, self.names)
            raise ModelError(f"{self.name} has no {first!r}: its parameters are {names}{meant}")
        if mass is None:
            raise ModelError(
                f"the mass is missing: the parameters of {self.name} do not contain it"
            )
        require(0 < mass < math.inf, mass, "mass", "a positive number of kg")
        return float(mass)

    def _two(self, parameters: Mapping[str, Any], mass: float | None) -> tuple[float, float, float]:
        """The mass in kg, and the engine's parameters of stiffness, which must be positive, and of
        damping, in the engine's units.
        """
        m = self._given(parameters, mass)
        for name in self.names:
            if name not in parameters:
                both = " and ".join(self.names)
                raise ModelError(f"{name} is missing: the parameters of {self.name} are {both}")
            value = float(parameters[name])
            require(0 <= value < math.inf, value, name, "a number of at least 0")
        stiffness, damping = (float(parameters[name]) for name in self.names)
        require(stiffness > 0, stiffness, self.names[0], "positive")
        return m, stiffness, damping

    def __repr__(self) -> str:
        return f"{type(self).__name__}()"

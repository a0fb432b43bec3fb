"""Drake: point contact with the relaxation time τ = c/k, f = k (p + τ p′) ≥ 0, or with the
dissipation d of Hunt and Crossley, f = k p (1 + d p′) ≥ 0.
"""

import math
from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np

from bouncing_ball.errors import require
from bouncing_ball_beyond.models.damping import Release
from bouncing_ball_beyond.models.laws.hertzian import LinearHuntCrossley
from bouncing_ball_contacts.engines.engine import (
    ERROR,
    Engine,
    EngineParameters,
    Physical,
    at_speeds,
    twelve_digits,
)
from bouncing_ball_contacts.engines.given_step import AtStep
from bouncing_ball_contacts.engines.hunt_crossley_steps import at_step_of_law, missing_speed
from bouncing_ball_contacts.engines.scheme import Scheme
from bouncing_ball_contacts.engines.steps import HuntCrossleyStep


class Drake(Engine):
    """A discrete plant with the approximation "sap", whose contact is the linear spring-damper.

    Drake combines the parameters of two bodies: their springs are in series, and their relaxation
    times are added. If ball and table have the same parameters, these are 2k in N/m and
    τ/2 = c/(2k) in s. The other approximations are :class:`HuntCrossleyDrake`.

    Examples
    --------
    >>> found = Drake().parameters(Physical(mass=2.0, stiffness=200.0, damping=4.0))
    >>> found
    {'point_contact_stiffness': 400.0, 'relaxation_time': 0.01}
    >>> Drake().read(found, 2.0)
    Physical(mass=2.0, stiffness=200.0, damping=4.0)
    """

    name = "drake"
    names = ("point_contact_stiffness", "relaxation_time")
    releases = (Release.FORCE,)
    scheme = Scheme.COMPENSATED
    laws: ClassVar[dict[str, str]] = {"hunt-crossley": "hunt-crossley-linear"}

    def parameters(self, contact: Physical) -> EngineParameters:
        time = contact.damping / contact.stiffness / 2
        return dict(zip(self.names, (2 * contact.stiffness, time), strict=True))

    def read(self, parameters: Mapping[str, Any], mass: float | None) -> Physical:
        m, double, half_time = self._two(parameters, mass)
        return Physical(m, double / 2, double * half_time)

    def reader(self, parameters: Mapping[str, Any]) -> Engine:
        return HuntCrossleyDrake() if HuntCrossleyDrake.names[1] in parameters else self

    def with_law(self, law_in_si: Mapping[str, Any]) -> Engine:
        return HuntCrossleyDrake(law_in_si)


class HuntCrossleyDrake(Drake):
    """The approximations with the damping of Hunt and Crossley, f = k p (1 + d p′).

    If ball and table are alike, the contact has half of their stiffness, and d in s/m is the
    ``hunt_crossley_dissipation`` of each. This damper grows with the penetration, so that it cannot
    take back that of the time step. In slow impacts it vanishes: :meth:`read` returns c = 0.

    Parameters
    ----------
    law_in_si : mapping, optional
        The stiffness k in N/m and the damping d that :meth:`parameters` gives, and the ``speed`` in
        m/s of the impact whose r is asked for at a time step.
    asked : float, optional
        This r, if it is another one than that of the law.

    Examples
    --------
    >>> found = {"point_contact_stiffness": 400.0, "hunt_crossley_dissipation": 0.5}
    >>> HuntCrossleyDrake().law(found, mass=2.0).parameters()
    {'stiffness': 100.0, 'damping': 0.5}
    """

    names = ("point_contact_stiffness", "hunt_crossley_dissipation")
    scheme = Scheme.IMPLICIT
    has_steps_of_law = True
    needs_speed = True
    text = "drake-hunt-crossley"

    def __init__(self, law_in_si: Mapping[str, Any] | None = None, asked: float | None = None):
        self._law_in_si = law_in_si or {}
        self._asked = asked

    def contact(self, parameters: Mapping[str, Any], mass: float | None) -> Physical:
        """The contact of small time steps: a ``time_step`` changes its r, and no other number."""
        values = dict(parameters)
        step = values.pop("time_step", None)
        if step is not None:
            require(0 < step < math.inf, step, "time_step", "a positive number of s")
        return self.read(values, mass)

    def at_step_of(
        self,
        parameters: Mapping[str, Any],
        mass: float | None,
        time_step: float,
        error: float = ERROR,
        release: str | None = None,
        speed: float | None = None,
    ) -> AtStep:
        """What Drake does with parameters and a time step in s, at an impact speed in m/s.

        Raises
        ------
        ModelError
            See :meth:`read`; or if there is no speed.

        Examples
        --------
        >>> given = {"point_contact_stiffness": 2e5, "hunt_crossley_dissipation": 0.5}
        >>> HuntCrossleyDrake().at_step_of(given, 0.5, 1e-3, speed=1.0).span
        '0.4218 to 0.5201'
        """
        self.release(release)
        m, _, _ = self._two(parameters, mass)
        if speed is None:
            raise missing_speed()
        return at_step_of_law(self.law(parameters, m), speed, time_step, error)

    def at_parameters(
        self, parameters: Mapping[str, Any], mass: float | None, time_step: float
    ) -> tuple[Engine, Physical]:
        contact = self.read(parameters, mass)
        _, double, dissipation = self._two(parameters, mass)
        return HuntCrossleyDrake({"stiffness": double / 2, "damping": dissipation}), contact

    def step(self, contact: Physical, release: Release, time_step: float) -> HuntCrossleyStep:
        law = self._of_mass(contact.mass)
        return HuntCrossleyStep(float(law.stiffness), float(law.damping), time_step)

    def at_step(
        self,
        contact: Physical,
        release: Release,
        time_step: float,
        error: float,
        asked: Physical | None = None,
    ) -> AtStep:
        law = self._of_mass(contact.mass)
        speed = self._law_in_si["speed"]
        return at_step_of_law(law, speed, time_step, error, self._asked)

    def _of_mass(self, mass: float) -> LinearHuntCrossley:
        """The law that is written, with the stiffness per unit of mass."""
        return LinearHuntCrossley(self._law_in_si["stiffness"] / mass, self._law_in_si["damping"])

    def _retuned(
        self, contact: Physical, damping: float, restitution: float
    ) -> tuple[Engine, Physical]:
        return HuntCrossleyDrake({**self._law_in_si, "damping": damping}, restitution), contact

    def stiffness(self, contact: Physical) -> float:
        return self._law_in_si["stiffness"]

    def with_stiffness(self, contact: Physical, stiffness: float) -> tuple[Engine, Physical]:
        # r is the same at each speed, whatever the stiffness is.
        factor = stiffness / self._law_in_si["stiffness"]
        m, k, c = contact
        linear = Physical(m, twelve_digits(k * factor), twelve_digits(c * math.sqrt(factor)))
        return HuntCrossleyDrake({**self._law_in_si, "stiffness": stiffness}), linear

    def parameters(self, contact: Physical) -> EngineParameters:
        values = (
            twelve_digits(2 * self._law_in_si["stiffness"]),
            twelve_digits(self._law_in_si["damping"]),
        )
        return dict(zip(self.names, values, strict=True))

    def read(self, parameters: Mapping[str, Any], mass: float | None) -> Physical:
        m, double, _ = self._two(parameters, mass)
        return Physical(m, double / 2, 0.0)

    def _given(self, parameters: Mapping[str, Any], mass: float | None) -> float:
        values = {name: value for name, value in parameters.items() if name != "time_step"}
        return super()._given(values, mass)

    def law(
        self, parameters: Mapping[str, Any], mass: float = 1, time: float = 1, length: float = 1
    ) -> LinearHuntCrossley:
        _, double, dissipation = self._two(parameters, mass)
        return LinearHuntCrossley(double / 2 / mass * time**2, dissipation * length / time)

    def remarks(self, parameters: Mapping[str, Any]) -> tuple[str, ...]:
        law = self.law(parameters)
        if "time_step" in parameters:
            return ()
        impacts = at_speeds(law, np.array([0.1, 1, 10]) / (law.damping or 1))
        return (f"in the limit of small time steps a free impact has {impacts}",)

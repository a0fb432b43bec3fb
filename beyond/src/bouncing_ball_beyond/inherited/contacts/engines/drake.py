"""Drake: point contact with the relaxation time τ = c/k, f = k (p + τ p′) ≥ 0, or with the
dissipation d of Hunt and Crossley, f = k p (1 + d p′) ≥ 0.

Drake combines the parameters of two bodies: their springs are in series, and their relaxation times
are added. If ball and table have the same parameters, these are 2k in N/m, and τ/2 = c/(2k) in s or
d in s/m. The defaults of a body are those of ``SceneGraphConfig`` in Drake 1.51.

A discrete plant with the approximation "sap" has the linear spring-damper, the other approximations
have Hunt and Crossley's damper. This damper grows with the penetration, so that it cannot take back
that of the time step. In slow impacts it vanishes: c = 0 is read.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np

from bouncing_ball_beyond.inherited.contacts.engines.engine import (
    Engine,
    EngineParameters,
    LawInSI,
    at_speeds,
    twelve_digits,
    two_numbers,
)
from bouncing_ball_beyond.inherited.contacts.engines.physical import Physical
from bouncing_ball_beyond.inherited.contacts.engines.scheme import Scheme
from bouncing_ball_beyond.models.damping import Release
from bouncing_ball_beyond.models.laws.hertzian import LinearHuntCrossley


def _by_dissipation(contact: Physical, law: LawInSI) -> EngineParameters:
    return {
        "point_contact_stiffness": twelve_digits(2 * law.law.stiffness * contact.mass),
        "hunt_crossley_dissipation": twelve_digits(law.law.damping),
    }


def _law(
    parameters: Mapping[str, Any], mass: float = 1, time: float = 1, length: float = 1
) -> LinearHuntCrossley:
    """The law f = k p (1 + d p′), of which k is half of that of each body.

    Examples
    --------
    >>> found = {"point_contact_stiffness": 400.0, "hunt_crossley_dissipation": 0.5}
    >>> _law(found, mass=2.0).parameters()
    {'stiffness': 100.0, 'damping': 0.5}
    """
    double, dissipation = two_numbers(HUNT_CROSSLEY, parameters)
    return LinearHuntCrossley(double / 2 / mass * time**2, dissipation * length / time)


def _remarks(parameters: Mapping[str, Any]) -> tuple[str, ...]:
    law = _law(parameters)
    impacts = at_speeds(law, np.array([0.1, 1, 10]) / (law.damping or 1))
    return (f"in the limit of small time steps a free impact has {impacts}",)


HUNT_CROSSLEY = Engine(
    name="drake",
    names=("point_contact_stiffness", "hunt_crossley_dissipation"),
    releases=(Release.FORCE,),
    scheme=Scheme.IMPLICIT,
    parameters=_by_dissipation,
    contact_of=lambda mass, double, dissipation: (double / 2, 0.0),
    law=_law,
    remarks=_remarks,
    written_law=LinearHuntCrossley,
    needs_speed=True,
)
"""The approximations with the damping of Hunt and Crossley."""


def _by_relaxation_time(contact: Physical, law: LawInSI | None = None) -> EngineParameters:
    """2k and τ/2.

    Examples
    --------
    >>> _by_relaxation_time(Physical(mass=2.0, stiffness=200.0, damping=4.0))
    {'point_contact_stiffness': 400.0, 'relaxation_time': 0.01}
    """
    time = contact.damping / contact.stiffness / 2
    return {"point_contact_stiffness": 2 * contact.stiffness, "relaxation_time": time}


DRAKE = Engine(
    name="drake",
    names=("point_contact_stiffness", "relaxation_time"),
    releases=(Release.FORCE,),
    scheme=Scheme.COMPENSATED,
    parameters=_by_relaxation_time,
    contact_of=lambda mass, double, half_time: (double / 2, double * half_time),
    defaults={"point_contact_stiffness": 1_000_000, "relaxation_time": 0.1},
    laws={"hunt-crossley": HUNT_CROSSLEY},
)
"""A discrete plant with the approximation "sap"."""

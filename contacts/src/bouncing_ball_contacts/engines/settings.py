"""What is written into an engine, and what the engine then does."""

from collections.abc import Mapping
from dataclasses import dataclass

from bouncing_ball_contacts.engines.given_step import AtStep

EngineParameters = Mapping[str, float | list[float]]


@dataclass(frozen=True)
class EngineSettings:
    """The settings to write into an engine, and the restitution that they produce.

    ``parameters`` have the names and units of the engine; those of a compensated scheme hold for
    the time step only. ``time_step`` is in s; with ``steps`` such steps in a contact the
    ``restitution`` of a free impact is met within ``error``. ``restitutions`` has the r of the same
    contact under each release that the engine has.
    ``max_height`` and ``penetration`` in m and ``contact_duration`` in s belong to the orbit of a
    design; they are None if there is no orbit. ``at_step`` is what the contact does at a time step
    that is given, None if the time step follows from the contact. If the given step does not keep
    the r of the contact within the error, ``retuned`` has the settings of the same stiffness with
    the damping that restores the mean r, None if no damping does, and ``softer`` those of the
    stiffest contact with the same ζ that the step resolves: what to write for the contact of
    ``AtStep.stiffest``. ``instant`` then says how the engine has this r without a contact that
    lasts, if it can.
    """

    name: str
    parameters: EngineParameters
    time_step: float
    release: str
    restitution: float
    restitutions: dict[str, float]
    steps: int
    error: float
    scheme: str
    snippet: str
    max_height: float | None = None
    contact_duration: float | None = None
    penetration: float | None = None
    at_step: AtStep | None = None
    instant: str = ""
    retuned: "EngineSettings | None" = None
    softer: "EngineSettings | None" = None

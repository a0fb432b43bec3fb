"""What is written into an engine, and what the engine then does."""

from collections.abc import Mapping
from dataclasses import dataclass

from bouncing_ball_contacts.engines.drop_in_steps import DropInSteps
from bouncing_ball_contacts.engines.given_step import AtStep
from bouncing_ball_contacts.engines.physical import Physical

EngineParameters = Mapping[str, float | list[float]]


@dataclass(frozen=True)
class EngineSettings:
    """The settings to write into an engine, and the restitution that they produce.

    ``parameters`` have the names and units of the engine; those of a compensated scheme hold for
    the time step only. ``time_step`` is in s; with ``steps`` such steps in a contact the
    ``restitution`` of a free impact is met within ``error``. ``restitutions`` has the r of the same
    contact under each release that the engine has. ``max_height`` and ``penetration`` in m and
    ``contact_duration`` in s belong to the orbit of a design; they are None if there is no orbit.
    ``contact`` has m, k and c of the contact, which for a law is the linear one with the same
    impact. ``at_step`` is what it does at a time step that is given, None if the time step follows
    from the contact. If the step does not keep the r of the contact that was asked for within the
    error, these are the settings of the contact with the least error in a drop: ``changed`` says
    whether its damping or its stiffness differs, and ``asked`` what the step does to the contact
    that was asked for. ``wanted`` is the √(h′/h) by which a drop is judged, r or that of a drop
    test. ``drop`` is what the engine does in this drop, None if a contact takes too many steps, and
    ``taken_by_gravity`` by how much gravity lowers √(h′/h) there; ``instant`` says how the engine
    comes closer without a contact that lasts, if it can, and ``instant_drop`` has that drop.
    """

    name: str
    contact: Physical
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
    changed: str = ""
    asked: AtStep | None = None
    wanted: float | None = None
    drop: DropInSteps | None = None
    taken_by_gravity: float = 0.0
    instant: str = ""
    instant_drop: DropInSteps | None = None

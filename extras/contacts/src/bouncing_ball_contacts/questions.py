"""The two questions: which parameters give a bounce, and which bounce parameters give."""

import difflib
import re
from collections.abc import Mapping
from typing import Any

from bouncing_ball_contacts.answers import Answer
from bouncing_ball_contacts.bounces import Bounce, Quantity
from bouncing_ball_contacts.designs import design_spring
from bouncing_ball_contacts.engines import ByNumber, Engine, as_compared
from bouncing_ball_contacts.rebounds import design_number, diagnose_number
from bouncing_ball_contacts.rows import BY_NUMBER, ENGINES, NAMES
from bouncing_ball_contacts.units import Refused, refuse


def rows_of(name: str) -> tuple[Engine | None, ByNumber | None]:
    """Return the row of an engine for springs, and the row for a restitution by number.

    Raises
    ------
    Refused
        If there is none; the message has the nearest name.
    """
    rows = {re.sub(r"\W", "", row_name): row_name for row_name in (*ENGINES, *BY_NUMBER)}
    known = rows | NAMES
    plain = re.sub(r"[\W_]", "", str(name).lower())
    # A version at the end, and words such as "engine", belong to no name.
    bare = re.sub(r"(physics|engine|system|js)*(v?\d+d?)?$", "", plain)
    key = next((form for form in (plain, bare) if form in known), "")
    row_name = known.get(key, "")
    near = difflib.get_close_matches(plain, known, 1, 0.85)
    meant = f"did you mean {known[near[0]] or near[0]}? " if near else ""
    refuse(
        [
            (not key, f"engine {name!r} is not known; {meant}'bounce engines' lists the engines"),
            (
                row_name not in rows.values(),
                f"{name} was not run{f', but {row_name}' * bool(row_name)}",
            ),
        ]
    )
    row = BY_NUMBER.get(row_name)
    return ENGINES.get(row.springs if row else row_name), row


def design(
    bounce: Bounce,
    engine: str | Engine = "generic",
    time_step: Quantity = None,
    *,
    pixels: Quantity = None,
) -> Answer:
    """Return what to write into an engine for a bounce, and what it does there.

    Parameters
    ----------
    bounce : Bounce
    engine : str or Engine
        Name of an engine, or a row of :data:`.ENGINES`. If an engine has both, a restitution by
        number is written, unless the bounce has a penetration, a stiffness or a contact time, or a
        restitution that no number gives, as 0.
    time_step : Quantity, optional
        Time step of the engine. By default the longest step that the contact allows.
    pixels : Quantity, optional
        Pixels in a metre, of an engine whose lengths are pixels. By default its gravity sets them.

    Returns
    -------
    Answer

    Raises
    ------
    Refused
        If there is no such contact, or a quantity is missing.

    >>> answer = design(Bounce(mass=1, radius=0.1, restitution=0.8), "mujoco", "1 ms")
    >>> sorted(answer.parameters), round(answer.outcome.restitution.mean, 2)
    (['solimp', 'solref'], 0.8)
    """
    if not isinstance(bounce, Bounce):
        raise Refused("give a bounce: design(Bounce(mass='50 g', restitution=0.8), 'mujoco')")
    if bounce.restitution is None:
        raise Refused(
            "the restitution is missing: --restitution 0.8 or restitution=0.8; 'bounce fit' "
            "measures it"
        )
    springs, number = (engine, None) if isinstance(engine, Engine) else rows_of(engine)
    if pixels is not None and not (number and number.pixels):
        raise Refused("--pixels is of matter-js, whose lengths are pixels: here they are metres")
    is_spring = bounce.gives_contact or bounce.restitution == 0
    if number is None or (springs is not None and is_spring):
        return design_spring(bounce, springs or ENGINES["generic"], time_step)
    answer = design_number(bounce, number, time_step, pixels)
    if answer.snippet or answer.also or springs is None or bounce.mass is None:
        return answer
    return design_spring(bounce, springs, time_step)


def diagnose(
    bounce: Bounce,
    engine: str | Engine,
    parameters: Mapping[str, Any] | None = None,
    time_step: Quantity = None,
    *,
    other: Mapping[str, Any] | None = None,
) -> Answer:
    """Return the bounce that parameters give at a step, and the least change for the one wanted.

    Parameters
    ----------
    bounce : Bounce
        Its restitution is the one that is wanted, and may be left out.
    engine : str or Engine
    parameters : mapping
        Parameters of one body by their names; without any, the defaults of the engine.
    time_step : Quantity
        Of the engine.
    other : mapping, optional
        Parameters of the other body beside the engine's defaults; if it is left out, both are
        alike.

    Returns
    -------
    Answer

    Raises
    ------
    Refused
        If a parameter or the step is missing, unknown or out of its range.

    >>> answer = diagnose(Bounce(drop_height=1), "rapier", {"restitution": 0.8}, "1/60", other={})
    >>> answer.numbers["number"], round(answer.outcome.restitution.mean, 2)
    (0.4, 0.39)
    """
    # Importing it takes longer than a design, which does not need it.
    from bouncing_ball_contacts.diagnosis import diagnose_spring

    if not isinstance(bounce, Bounce) or not all(
        isinstance(body or {}, Mapping) for body in (parameters, other)
    ):
        raise Refused(
            "give a bounce, an engine and parameters by their names: "
            "diagnose(Bounce(mass='50 g'), 'mujoco', {'solref': '0.02 1'}, '2 ms')"
        )
    typed = parameters or {}
    if isinstance(engine, Engine):
        return diagnose_spring(bounce, engine, typed, time_step, other)
    springs, number = rows_of(engine)
    # A stiffness or a damping is one of springs, unless a number is given as well, and so are names
    # that only springs have.
    compared = set(map(as_compared, [*typed, *(other or {})]))
    of_number = number.names if number else {}
    of_springs = set(map(as_compared, springs.rules)) - of_number.keys() if springs else set()
    of_springs |= set(map(as_compared, [*springs.names, *springs.spring])) if springs else set()
    is_number = "number" in {of_number.get(name) for name in compared}
    if number is None or (springs and not is_number and compared & of_springs):
        return diagnose_spring(bounce, springs or ENGINES["generic"], typed, time_step, other)
    return diagnose_number(bounce, number, typed, time_step, other)

"""How the settings for an engine are written as text, and what it does at a given time step.

The sentences are in ``templates/engine.txt.j2``.
"""

from typing import TYPE_CHECKING

from bouncing_ball_contacts.cli.design_answer import DesignAnswer
from bouncing_ball_contacts.cli.options import option
from bouncing_ball_contacts.contact import rows
from bouncing_ball_contacts.contact.describe import Description
from bouncing_ball_contacts.contact.drops import deep
from bouncing_ball_contacts.contact.hertz import rayleigh_time
from bouncing_ball_contacts.contact.texts import lines, shown
from bouncing_ball_contacts.engines.choice import engine_named
from bouncing_ball_contacts.engines.drop_in_steps import Range
from bouncing_ball_contacts.engines.engine import ERROR, EngineParameters, Written, without_step

# It imports orbits, for longer than most recipes are computed.
if TYPE_CHECKING:
    from bouncing_ball_contacts.contact.assess import Assessment

# The row that has a range if parameters contain a time step.
_FREE = "restitution of a free impact"
# More time steps in a contact than simulations have.
_MANY = 100_000


def line(name: str, *columns: str) -> str:
    """A name with what stands in the columns beside it."""
    return f"{name:<38}" + "".join(f"{column + ' ':<18}" for column in columns).rstrip()


def contact_numbers(given: DesignAnswer) -> list[tuple[str, str]]:
    """The numbers of the contact and of a drop, by name."""
    dropped = [] if given.dropped is None else rows.texts(given.dropped)
    found = rows.texts(given.found)
    at = given.at_step
    if at is not None and at.is_of_parameters and not at.is_within:
        found = [(name, f"{at.span} at this step" if name == _FREE else x) for name, x in found]
    return found + dropped


def law_lines(found: "Assessment | Description") -> list[str]:
    """The parameters of a contact law, with their units."""
    values = dict(found.law or {})
    name = values.pop("name", "")
    units = found.case.law.units
    # With units, ϖ is the natural frequency ϖΩ.
    words = {"frequency_ratio": "natural frequency"}
    return [
        line(
            f"{name}, {words.get(key, key.replace('_', ' '))}",
            shown(x, units[key].name),
        )
        for key, x in values.items()
    ]


def ends(found: Range, unit: str) -> str:
    """A range in words; one number if its ends are alike in three digits.

    Examples
    --------
    >>> ends(Range(0.0051, 0.0062), "m"), ends(Range(1.0001, 1.0002), "N")
    ('5.1 to 6.2 mm', '1 N')
    """
    least, most = (shown(float(f"{end:.3g}"), unit) for end in found)
    if least == most:
        return most
    number, _, of = least.partition(" ")
    return f"{number if most.endswith(f' {of}') else least} to {most}"


def engine_lines(given: DesignAnswer) -> list[str]:
    """What is written into an engine, if one is named, and what it does; or what parameters of an
    engine do at a time step.
    """
    engine = given.engine
    at = given.at_step
    orbit = (
        ()
        if engine is None
        else (
            ("orbit, greatest height", engine.max_height, "m"),
            ("orbit, duration of contact", engine.contact_duration, "s"),
            ("orbit, penetration", engine.penetration, "m"),
        )
    )
    # A drop that was asked for has its own remarks.
    too_deep: tuple[str, ...] = ()
    if engine is not None and engine.drop is not None and given.dropped is None:
        most = engine.drop.compression.most
        too_deep = deep(most, given.found.case.given.radius, "in this drop")
    return lines(
        "engine",
        given=given,
        engine=engine,
        at=at,
        orbit=orbit,
        too_deep=too_deep,
        retuned=_retuned(given),
        rayleigh=rayleigh_time(given.found.case.given),
        was_run=engine is None or engine_named(engine.name).was_run,
        many=_MANY,
        error=ERROR,
        ends=ends,
        line=line,
        option=option,
    )


def _retuned(given: DesignAnswer) -> EngineParameters:
    """The parameters with the retuned damping, of an engine whose steps damp."""
    case = given.found.case
    engine = case.given.engine
    at = given.at_step
    if engine is None or at is None or at.retuned is None or not engine.scheme.is_compensated:
        return {}
    if at.speed is not None:
        return {}
    parameters = without_step(case.given.engine_parameters)
    contact = engine.read(parameters, case.mass)._replace(damping=at.retuned)
    return Written(engine, contact, case.equivalent.release).parameters(at.time_step)

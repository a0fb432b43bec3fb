r"""From the parameters of a contact to its model: the way of every contact that is given.

With ω² = k/m and c = 2ζmω, a free impact ends at the angle ω√(1 - ζ²) t = π - 2α
(:mod:`bouncing_ball_beyond.models.damping`). The loss gives ζ
(:mod:`bouncing_ball_beyond.inherited.contacts.contact.loss`), and stiffness or contact time then
give ω. A contact law has the r and the duration of the free impact at the impact speed of the
orbit; the elastic data of both bodies determine the law of Hertz and Tsuji
(:mod:`bouncing_ball_beyond.inherited.contacts.contact.hertz`). The parameters of an engine are
first translated (:meth:`.contact.Contact.by_stiffness_and_loss`). A contact that is chosen for a
tolerance (:mod:`bouncing_ball_beyond.inherited.contacts.contact.choose`) is found with its model.
"""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from bouncing_ball_beyond.inherited.contacts.contact.contact import STIFF, Contact
from bouncing_ball_beyond.inherited.contacts.contact.diagnose import diagnosis
from bouncing_ball_beyond.inherited.contacts.contact.hertz import hertz, reduced_modulus
from bouncing_ball_beyond.inherited.contacts.contact.loss import (
    loss,
    omega_of_penetration,
    omega_of_time,
    same_omega,
)
from bouncing_ball_beyond.inherited.contacts.contact.quantities import given, single
from bouncing_ball_beyond.inherited.contacts.contact.resolved import ResolvedContact
from bouncing_ball_beyond.inherited.contacts.contact.table import TableMotion
from bouncing_ball_beyond.inherited.errors import ModelError, ParameterError
from bouncing_ball_beyond.models.damping import Release
from bouncing_ball_beyond.models.instant import Instant
from bouncing_ball_beyond.models.laws.contact_law import ContactLaw
from bouncing_ball_beyond.models.laws.law_of_impact import law_of_impact
from bouncing_ball_beyond.models.spring_damper import SpringDamper

# What a contact of a law is not given by, because its parameters follow from a free impact.
_NOT_OF_A_LAW = (
    "stiffness",
    "penetration",
    "damping",
    "damping_ratio",
    "reduced_modulus",
    "youngs_modulus",
)

# The last Newton step for the impact speed of an orbit, relative to this speed. The error is of the
# order of its square.
_LAST_STEP = 1e-8


def resolve(
    contact: Contact,
    table: TableMotion,
    families: Sequence[int] = (1,),
    written: str | None = None,
    speed: float | None = None,
) -> ResolvedContact:
    """The model of a contact that is given with its stiffness, and its SI scales.

    Parameters
    ----------
    contact : Contact
    table : TableMotion
        The table. On a table at rest a law needs an impact speed.
    families : sequence of int
        Families n. The impact speed of a nonlinear contact is that of the first stable family.
    written : str, optional
        Name of the engine for which the contact is written. It then ends as in this engine, with
        the spring and damper in place of the law of the engine whose parameters were given.
    speed : float, optional
        Speed of an impact on a table at rest, in m/s.

    Raises
    ------
    ModelError
        If parameters do not suffice or contradict each other.

    Examples
    --------
    >>> contact = Contact(mass=1.0, stiffness=4.0, damping=0.4)
    >>> resolve(contact, TableMotion(1.0, 1.0, 1.0)).equivalent.damping_ratio
    0.1
    """
    plain = contact.by_stiffness_and_loss(written)
    kind = law_type(plain)
    is_stiff = single(given(plain), STIFF, "the stiffness of the contact") != ""
    modulus = reduced_modulus(plain)
    if speed is not None and not table.is_at_rest:
        speed = None
    if not is_stiff:
        instead = "" if written is None else f", or the {{time_step}} of {written}"
        raise ParameterError(f"no stiffness: give {{stiffness}}, or {{contact_time}}{instead}")
    held = _held(contact, plain, table) if written is None else None
    if held is not None:
        found = ResolvedContact(plain, table, held, held)
    elif kind is None and modulus is None:
        found = _spring_damper(plain, table, speed)
    else:
        found = _of_law(plain, table, families, kind, modulus, speed)
    found = replace(found, given=contact, written=written, impact_speed=speed)
    return _with_law_of_engine(found, families)


def _held(contact: Contact, plain: Contact, table: TableMotion) -> SpringDamper | None:
    """The spring and damper of an engine's parameters with which the damper pulls and holds the
    ball; None if it does not.

    Raises
    ------
    ModelError
        If the table moves; with the least change after which the ball bounces.
    """
    engine = contact.engine
    if engine is None or engine.needs_speed:
        return None
    ball = engine.contact(contact.engine_parameters, contact.mass)
    if not ball.holds(plain.rule):
        return None
    if not table.is_at_rest:
        raise ModelError("; ".join(diagnosis(contact)))
    ratio = ball.angular_frequency / table.angular_frequency
    return SpringDamper(ratio, ball.damping_ratio, plain.rule)


def law_type(contact: Contact) -> type[ContactLaw] | None:
    """The type of the contact law that is named; None for the linear contact.

    Raises
    ------
    ModelError
        If there is no such law, or if it is given by other parameters than those of an impact.

    Examples
    --------
    >>> law_type(Contact(law="hunt-crossley", contact_time="1 ms")).name
    'hunt-crossley'
    """
    kind = contact.law_unless_spring_damper
    if kind is None:
        return None
    for other in _NOT_OF_A_LAW:
        if getattr(contact, other) is not None:
            instead = "give {contact_time} and {restitution}"
            raise ParameterError(
                f"{{{other}}} is not allowed with {{law}} {contact.law}: {instead}"
            )
    if contact.contact_time is None:
        raise ParameterError(
            f"{{law}} {contact.law} needs {{contact_time}}, the duration of a free impact"
        )
    return kind


def _spring_damper(contact: Contact, table: TableMotion, speed: float | None) -> ResolvedContact:
    """A linear contact by its stiffness, duration or greatest compression, with its loss."""
    rule = contact.rule
    if contact.stiffness is not None:
        omega = same_omega(math.sqrt(contact.stiffness / contact.mass))
    elif contact.penetration is not None:
        if speed is None and contact.drop_height is not None:
            speed = math.sqrt(2 * table.gravity * contact.drop_height)
        if speed is None:
            raise ParameterError("{penetration} needs {speed} of an impact on a table at rest")
        omega = omega_of_penetration(contact.penetration, speed, table.gravity, rule)
    else:
        omega = omega_of_time(contact.contact_time, rule)
    zeta = loss(contact, omega, table.gravity)
    spring = SpringDamper(omega(zeta) / table.angular_frequency, zeta, rule)
    return ResolvedContact(contact, table, spring, spring)


def _of_law(
    contact: Contact,
    table: TableMotion,
    families: Sequence[int],
    kind: type[ContactLaw] | None,
    modulus: float | None,
    speed: float | None,
) -> ResolvedContact:
    """A contact law with its r and duration at the impact speed of the first stable family, or on a
    table at rest at the speed that is given: of a kind, or the Hertz contact of a reduced modulus.
    """
    # The parameters of a law follow from a free impact, so that r counts as measured.
    measured = contact if kind is None else contact.with_measured_restitution()
    rule = contact.rule
    unit = SpringDamper(1.0, loss(measured), rule)
    if modulus is not None and rule is not Release.DISPLACEMENT:
        raise ModelError("a Hertz contact with Tsuji's damping has the displacement release only")
    r = float(unit.restitution)
    if not table.is_at_rest:
        # Imported here, because orbits are imported for longer than most recipes are computed.
        from bouncing_ball_beyond.periodic.one_impact.restitution_branch import rigid_speed

        at = float(rigid_speed(first_stable_family(families, r, table.amplitude), r))
    elif speed is None:
        what = "{radius}" if kind is None else "{law}"
        why = "the contact time" if kind is None else "r"
        raise needs_table(what, why)
    else:
        at = speed * table.time / table.length
    if modulus is not None:
        law: ContactLaw = hertz(contact.mass, modulus, contact.radius, r, table)
        duration = float(law.signature(at).duration)
    else:
        assert kind is not None
        duration = contact.contact_time / table.time
        law = law_of_impact(kind, r, duration, at)
    linear = SpringDamper.of_duration(duration, unit.damping_ratio, rule)
    return ResolvedContact(contact, table, law, linear)


def needs_table(what: str, why: str) -> ParameterError:
    needs = "a table, such as {frequency} and {acceleration}, or {speed} of an impact"
    return ParameterError(f"{what} needs {needs}: {why} depends on the speed")


def _with_law_of_engine(case: ResolvedContact, families: Sequence[int]) -> ResolvedContact:
    """The case with the law that the parameters of an engine give, if they give one."""
    engine = case.given.engine
    if engine is None:
        return case
    table = case.table
    law = engine.law(case.given.engine_parameters, case.mass, table.time, table.length)
    if law is None:
        return case
    if case.lacks_speed:
        return case
    if engine.needs_speed:
        case = with_law(case, law, families)
    # For another engine the spring and damper is written in place of the law.
    return case if case.written is not None else replace(case, law=law)


def first_stable_family(
    asked: Sequence[int], restitution: float | np.ndarray, amplitude: float
) -> int:
    """The first of the families whose orbit is stable in the restitution model.

    If none of these orbits is stable, it is the first family.

    Examples
    --------
    With r = 0.85 and Λ = 1.1 the 1-T orbit is beyond its period doubling:

    >>> first_stable_family([1, 2, 3], 0.85, 1.1)
    2
    """
    # Imported here, because orbits are imported for longer than most recipes are computed.
    from bouncing_ball_beyond.models.rigid import RestitutionModel
    from bouncing_ball_beyond.periodic.one_impact import n_t

    orbits = n_t.orbit(RestitutionModel(restitution), np.array(asked), amplitude)
    return asked[int(np.argmax(orbits.exists & orbits.is_stable()))]


def with_law(case: ResolvedContact, law: ContactLaw, asked: Sequence[int]) -> ResolvedContact:
    """The case with the linear contact that has the r and duration of a law at the impact speed.

    Here the law is known, and its r and duration are sought: at the speed v = 2πn/(1 + r(v)) of the
    first stable family of the restitution model.

    Examples
    --------
    >>> from bouncing_ball_beyond.models.laws.hertzian import Tsuji, tsuji_damping
    >>> spring = SpringDamper(1.0, 0.0)
    >>> case = ResolvedContact(Contact(mass=1.0), TableMotion(1.0, 1.0, 1.0), spring, spring)
    >>> found = with_law(case, Tsuji(50.0, tsuji_damping(0.8)), [1])
    >>> round(float(found.equivalent.restitution), 12)
    0.8
    """
    if case.impact_speed is not None:
        at = case.impact_speed * case.table.time / case.table.length
        return _with_impact(case, law.signature(at))
    from bouncing_ball_beyond.models.contact_model import ContactModel
    from bouncing_ball_beyond.periodic.one_impact.searched_orbits import restitution_speed

    speed, impact = restitution_speed(asked, ContactModel(law), _LAST_STEP)
    n = first_stable_family(asked, impact.restitution, case.table.amplitude)
    return _with_impact(case, law.signature(float(speed[asked.index(n)])))


def _with_impact(case: ResolvedContact, impact: Instant) -> ResolvedContact:
    """The case with the linear contact that has the r and the duration of an impact."""
    r = float(impact.restitution)
    linear = SpringDamper.of_impact(r, float(impact.duration), case.equivalent.release)
    return replace(case, plain=Contact(mass=case.mass), law=linear, equivalent=linear)

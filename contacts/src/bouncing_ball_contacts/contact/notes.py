"""Sentences that a user should read in addition to the numbers of a contact and the verdict."""

import math

import numpy as np

from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.laws.hertzian import Tsuji
from bouncing_ball_beyond.periodic.one_impact import n_t
from bouncing_ball_contacts.contact.families import ComparedOrbit
from bouncing_ball_contacts.contact.motion import FinalMotion
from bouncing_ball_contacts.contact.resolved import ResolvedContact
from bouncing_ball_contacts.contact.texts import lines, shown
from bouncing_ball_contacts.engines.engine import Engine

# Shakers reach some hundred times gravity.
_MOST = 500.0


def remarks(case: ResolvedContact) -> tuple[str, ...]:
    """Sentences on how a contact was read: from the parameters of an engine, or a drop test."""
    return (*_on_engine(case), *on_drop_test(case))


def _on_engine(case: ResolvedContact) -> tuple[str, ...]:
    """How the contact of an engine's parameters differs from a spring and a damper, and how r
    changes if it is written for another engine.
    """
    engine = case.given.engine
    if engine is None:
        return ()
    found = engine.notes(case.given.engine_parameters)
    contact = engine.contact(case.given.engine_parameters, case.given.mass)
    own = engine.release()
    release = case.equivalent.release
    same = case.written is None or own is release
    if same or not 0 < contact.damping_ratio < 1:
        return found
    before = f"{contact.restitution(own):.4f}"
    after = f"{contact.restitution(release):.4f}"
    why = f"contacts end by {own} in {engine.name}, and by {release} in {case.written}"
    return (*found, f"r changes from {before} to {after}, because {why}")


# The forces of the laws whose constants have other meanings elsewhere, over their stiffness k; x is
# the depth and ẋ its rate.
_FORCES = {
    "hunt-crossley": "k x^1.5 (1 + C ẋ)",
    "hunt-crossley-linear": "k x (1 + C ẋ)",
    "tsuji": "k x^1.5 + C √(m k) x^0.25 ẋ",
    "kuwabara-kono": "k (x^1.5 + C √x ẋ)",
}


def force_formula(case: ResolvedContact) -> tuple[str, ...]:
    """The force of a law, in which its stiffness and its damping stand."""
    force = _FORCES.get(case.law.name)
    if force is None:
        return ()
    return (f"the force of {case.law.name} with stiffness k and damping C is {force}, of depth x",)


def on_drop_test(case: ResolvedContact) -> tuple[str, ...]:
    """A sentence on the drop test that was given, if one was, and on its restitution."""
    drop = case.given.drop_height
    height = case.given.rebound_height
    if drop is None or height is None:
        return ()
    r = math.sqrt(height / drop)
    if not case.is_spring_damper:
        return (f"the drop test is read without gravity, as r = √(h′/h) = {r:.4g}, for this law",)
    arrives = shown(math.sqrt(2 * case.table.gravity * drop), "m/s")
    free = float(case.equivalent.restitution)
    return (
        f"dropped from {shown(drop, 'm')} onto a table at rest, at {arrives}, the ball rises to "
        f"{shown(height, 'm')}: √(h′/h) = {r:.4g}, and r = {free:.4g} without gravity",
    )


def _cost_of_law(engine: Engine, case: ResolvedContact, family: ComparedOrbit) -> str:
    """A sentence on the change of the greatest height that the law of an engine causes in place of
    the spring and damper of its parameters.
    """
    of = engine.names[0]
    about = f"stiffness, damping, ϖ and ζ are those of the spring and damper of this {of}"
    spring = n_t.orbit(ContactModel(case.equivalent), family.n, case.table.amplitude)
    if family.greatest_compression is None or family.max_height is None or not spring.exists:
        return about
    law = engine.law(case.given.engine_parameters)
    depth = np.array(family.greatest_compression)
    where = f"where the impedance is {float(law.impedance(depth)):.3g}"
    without = spring.max_height * case.table.length
    off = float((family.max_height - without) / without)
    return (
        f"{about}: at the orbit's depth of {shown(family.greatest_compression, 'm')}, {where}, "
        f"the ball bounces {shown(abs(off), '%')} {'higher' if off > 0 else 'lower'} than with them"
    )


def notes(case: ResolvedContact, family: ComparedOrbit, motion: FinalMotion) -> tuple[str, ...]:
    """Sentences that a user should read in addition to the verdict."""
    engine = case.given.engine
    cost = None
    if not case.is_spring_damper and engine is not None and not engine.needs_speed:
        cost = _cost_of_law(engine, case, family)
    is_tsuji = isinstance(case.law, Tsuji)
    law = "Hertz contact with Tsuji's damping" if is_tsuji else f"{case.law.name} contact"
    of = {"law": law, "cost": cost, "most": _MOST}
    found = lines("notes", case=case, family=family, motion=motion, **of)
    return (*found, *force_formula(case))

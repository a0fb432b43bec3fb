"""Sentences on how a contact was read: from the parameters of an engine, a law, or a drop test."""

import math

from bouncing_ball_beyond.inherited.contacts.contact.resolved import ResolvedContact
from bouncing_ball_beyond.inherited.contacts.contact.texts import shown


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
    if defaults := case.given.defaults:
        numbers = ", ".join(f"{name} = {value}" for name, value in defaults.items())
        found = (f"these are the defaults of {engine.name}: {numbers}", *found)
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


def force_formula(case: ResolvedContact) -> tuple[str, ...]:
    """The force of a law, in which its stiffness and its damping stand."""
    law = case.law
    if not law.formula:
        return ()
    return (f"the force of {law.name} with stiffness k and damping C is {law.formula}, of depth x",)


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

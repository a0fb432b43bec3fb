"""Sentences that a user should read in addition to the verdict on a contact on a table."""

import numpy as np

from bouncing_ball_beyond.inherited.contacts.contact.families import ComparedOrbit
from bouncing_ball_beyond.inherited.contacts.contact.motion import FinalMotion
from bouncing_ball_beyond.inherited.contacts.contact.remarks import force_formula
from bouncing_ball_beyond.inherited.contacts.contact.resolved import ResolvedContact
from bouncing_ball_beyond.inherited.contacts.contact.texts import lines, shown
from bouncing_ball_beyond.inherited.contacts.engines.engine import Engine
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.laws.hertzian import Tsuji
from bouncing_ball_beyond.periodic.one_impact import n_t

# Shakers reach some hundred times gravity.
_MOST = 500.0


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

"""An engineer's contact: units, physics engines, measured impacts.

For engineers; it stands on ``bouncing_ball_beyond``. Whether a restitution coefficient is good
enough for a contact, how stiff it must be, and what one writes into a physics engine are three
questions::

    table = bouncing_ball_contacts.Table(frequency="50 Hz", acceleration="0.8 g")
    contact = bouncing_ball_contacts.Contact(
        mass="20 g", stiffness="1e7 N/m", restitution=0.85
    )
    bouncing_ball_contacts.assess_contact(table, contact)

Measured restitution coefficients and contact times determine a contact::

    fit = bouncing_ball_contacts.fit_contact(
        [0.5, 2.0, 6.0], [0.857, 0.825, 0.795], 0.75e-3, mass="454 g"
    )
    bouncing_ball_contacts.assess_contact(table, fit.best.contact_on(table))
"""

from typing import TYPE_CHECKING

from bouncing_ball_beyond.inherited.first_use import first_use

# What type checkers, editors and the linter of imports see.
if TYPE_CHECKING:
    from bouncing_ball_contacts.contact.assess import assess_contact as assess_contact
    from bouncing_ball_contacts.contact.choose import choose_contact as choose_contact
    from bouncing_ball_contacts.contact.contact import Contact as Contact
    from bouncing_ball_contacts.contact.describe import describe_contact as describe_contact
    from bouncing_ball_contacts.contact.question import EngineSetup as EngineSetup
    from bouncing_ball_contacts.contact.question import Question as Question
    from bouncing_ball_contacts.contact.table import Table as Table
    from bouncing_ball_contacts.contact.write import write_contact as write_contact
    from bouncing_ball_contacts.measured.fit import fit_contact as fit_contact

__version__ = "0.1.0"

# The public names and the modules in which they are defined.
_MODULES = {
    "Contact": "contact.contact",
    "EngineSetup": "contact.question",
    "Question": "contact.question",
    "Table": "contact.table",
    "assess_contact": "contact.assess",
    "choose_contact": "contact.choose",
    "describe_contact": "contact.describe",
    "fit_contact": "measured.fit",
    "write_contact": "contact.write",
}

__all__ = list(_MODULES)

__getattr__, __dir__ = first_use(__name__, _MODULES, globals())

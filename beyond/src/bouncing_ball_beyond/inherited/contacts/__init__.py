"""An engineer's contact on a vibrating table: is a restitution coefficient enough?

Whether a restitution coefficient is good enough for a contact, and how stiff it must be for that,
are two questions, in SI units::

    from bouncing_ball_beyond.inherited.contacts import Contact, Table, assess_contact

    table = Table(frequency="50 Hz", acceleration="0.8 g")
    contact = Contact(mass="20 g", stiffness="1e7 N/m", restitution=0.85)
    assess_contact(table, contact)

What one writes into a physics engine, and what measured impacts say, is in the package
``bouncing_ball_contacts``, on which this one does not depend.
"""

from typing import TYPE_CHECKING

from bouncing_ball_beyond.inherited.first_use import first_use

# What type checkers, editors and the linter of imports see.
if TYPE_CHECKING:
    from bouncing_ball_beyond.inherited.contacts.contact.assess import (
        assess_contact as assess_contact,
    )
    from bouncing_ball_beyond.inherited.contacts.contact.choose import (
        choose_contact as choose_contact,
    )
    from bouncing_ball_beyond.inherited.contacts.contact.contact import Contact as Contact
    from bouncing_ball_beyond.inherited.contacts.contact.describe import (
        describe_contact as describe_contact,
    )
    from bouncing_ball_beyond.inherited.contacts.contact.question import Question as Question
    from bouncing_ball_beyond.inherited.contacts.contact.table import Table as Table

# The public names and the modules in which they are defined.
_MODULES = {
    "Contact": "contact.contact",
    "Question": "contact.question",
    "Table": "contact.table",
    "assess_contact": "contact.assess",
    "choose_contact": "contact.choose",
    "describe_contact": "contact.describe",
}

__all__ = list(_MODULES)

__getattr__, __dir__ = first_use(__name__, _MODULES, globals())

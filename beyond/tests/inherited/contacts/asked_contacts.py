"""What is asked of a contact by all parameters together, as the command ``design`` asks it."""

from typing import Any

from bouncing_ball_beyond.inherited.contacts.cli.design import answer_design
from bouncing_ball_beyond.inherited.contacts.cli.design_answer import DesignAnswer
from bouncing_ball_beyond.inherited.contacts.contact.assess import Assessment
from bouncing_ball_beyond.inherited.contacts.contact.describe import Description


def answered(**given: Any) -> DesignAnswer:
    """The whole answer: the contact, and a drop."""
    return answer_design(given)


def assessed(**given: Any) -> Assessment:
    """The assessment of a contact on a table, given or chosen."""
    found = answer_design(given).found
    assert isinstance(found, Assessment)
    return found


def described(**given: Any) -> Description:
    """The description of a contact without a table."""
    found = answer_design(given).found
    assert isinstance(found, Description)
    return found

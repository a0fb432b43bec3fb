"""The contact laws by their names: those of ``bouncing_ball_beyond``, and MuJoCo's impedance."""

from bouncing_ball_beyond.models import named_laws as named
from bouncing_ball_beyond.models.laws.contact_law import ContactLaw
from bouncing_ball_contacts.engines.impedance import Impedance

LAWS = named.LAWS | named.by_name(Impedance)
"""The laws by their names on the command line and in calls."""


def law_named(name: str) -> type[ContactLaw]:
    """The class of the contact law with this name.

    Raises
    ------
    ModelError
        If there is no such law.

    Examples
    --------
    >>> law_named("tsuji").__name__, law_named("impedance").__name__
    ('Tsuji', 'Impedance')
    """
    return named.law_named(name, LAWS)

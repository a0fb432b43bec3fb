"""The contact laws by their names.

A law is registered in one place, :data:`LAWS`. A house above this one that has further laws makes a
registry of both, by :func:`by_name`, and hands it to :func:`law_named`.
"""

from collections.abc import Mapping

from bouncing_ball_beyond.inherited.errors import one_of
from bouncing_ball_beyond.models.laws.contact_law import ContactLaw
from bouncing_ball_beyond.models.laws.elasto_backlash import ElastoBacklash
from bouncing_ball_beyond.models.laws.hertzian import (
    HuntCrossley,
    KuwabaraKono,
    LinearHuntCrossley,
    Tsuji,
)
from bouncing_ball_beyond.models.laws.start_speed import Flores, LankaraniNikravesh
from bouncing_ball_beyond.models.laws.stepped import (
    AdamsImpact,
    LinearAdamsImpact,
    SimscapeContact,
)
from bouncing_ball_beyond.models.spring_damper import SpringDamper


def by_name(*laws: type[ContactLaw]) -> dict[str, type[ContactLaw]]:
    """Laws by their names.

    Raises
    ------
    ModelError
        If a law does not declare the units of all its parameters.
    """
    for law in laws:
        law.require_units()
    return {law.name: law for law in laws}


_HERTZ = (HuntCrossley, LinearHuntCrossley, Tsuji, KuwabaraKono)
_STEPPED = (AdamsImpact, LinearAdamsImpact, SimscapeContact)
LAWS = by_name(*_HERTZ, LankaraniNikravesh, Flores, SpringDamper, ElastoBacklash, *_STEPPED)
"""The laws by their names on the command line and in calls."""


def law_named(name: str, laws: Mapping[str, type[ContactLaw]] = LAWS) -> type[ContactLaw]:
    """The class of the contact law with this name in a registry, by default that of this house.

    Raises
    ------
    ModelError
        If there is no such law.

    Examples
    --------
    >>> law_named("tsuji").__name__
    'Tsuji'
    """
    return one_of("contact law", name, laws)

"""The type of the configuration of beyond: the parameters of each artifact, and the release."""

from bouncing_ball_beyond.exhibits.cascade_of_flights import Flights
from bouncing_ball_beyond.exhibits.contact_laws import LawErrors
from bouncing_ball_beyond.exhibits.corrected_model import OneContact, Orders
from bouncing_ball_beyond.exhibits.explorer_orbits import References
from bouncing_ball_beyond.exhibits.release_rules import FreeImpacts, ReleaseRules
from bouncing_ball_beyond.exhibits.stiffness_map import StiffnessMap
from bouncing_ball_beyond.inherited.datasets.parameters import Parameters
from bouncing_ball_beyond.models.damping import Release


class Beyond(Parameters):
    """What goes past the paper."""

    ext_release: ReleaseRules
    ext_flights: Flights
    ext_impact: FreeImpacts
    ext_instant: OneContact
    ext_orders: Orders
    ext_map: StiffnessMap
    explorer: References
    ext_laws: LawErrors


# It converts values, because YAML has no release rules.
class Configuration(Parameters, strict=False):
    """The keys of ``config/config.yaml`` in beyond."""

    release: Release
    beyond: Beyond

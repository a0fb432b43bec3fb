"""The type of the configuration: the parameters of each figure, table and check, and settings."""

from bouncing_ball.datasets.parameters import Parameters
from bouncing_ball.models.damping import Release
from bouncing_ball.paper.claims.formulas import Formulas
from bouncing_ball.paper.exhibits.apparent_restitution import Cases, Sweep
from bouncing_ball.paper.exhibits.continuation_of_orbits import (
    BothDomains,
    Continuation,
    Domains,
    Ranges,
)
from bouncing_ball.paper.exhibits.error_thresholds import ErrorThresholds, OrbitErrors
from bouncing_ball.paper.exhibits.kinds_of_motion import BallsAlike
from bouncing_ball.paper.exhibits.lowest_period_doubling import FamiliesAlongRatio
from bouncing_ball.paper.exhibits.orbit_parameters import FamilyBranches
from bouncing_ball.paper.exhibits.permanent_contact import PermanentContact, PermanentContactError
from bouncing_ball.paper.exhibits.restitution_model import RestitutionHistory
from bouncing_ball.paper.exhibits.time_histories import ContactHistory, Histories


class Paper(Parameters):
    """The figures and tables of the paper, and the audit of its formulas."""

    fig02: RestitutionHistory
    fig03: FamilyBranches
    fig05: Cases
    fig06: Cases
    fig07: ContactHistory
    fig08: Domains
    fig09: Domains
    fig10: Sweep
    fig11: PermanentContact
    fig12: Histories
    fig13: Sweep
    fig14: OrbitErrors
    fig15: BothDomains
    fig16: PermanentContactError
    table1: Ranges
    thresholds: ErrorThresholds
    lowest_doubling: FamiliesAlongRatio
    three_balls: BallsAlike
    formulas: Formulas


# It converts values, because YAML has no release rules.
class Configuration(Parameters, strict=False):
    """The keys of ``config/config.yaml``."""

    release: Release
    continuation: Continuation
    paper: Paper

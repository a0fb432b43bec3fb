"""Past the paper: how stiff is stiff enough, for any orbit and any contact law.

It has what the paper does not ask for: contacts of other laws, the corrected restitution model,
periodic orbits with any number of impacts, which are followed along any parameter, and the motions
on which balls end.

A ball is made once and handed to functions::

    ball = bouncing_ball_beyond.contact_law("tsuji", restitution=0.85, duration=0.1)
    one = bouncing_ball_beyond.orbit(ball, n=1, amplitude=1.0)
    bouncing_ball_beyond.follow(one, along="amplitude", to=1.3).plot()
    bouncing_ball_beyond.motion_of(ball, amplitude=1.1)

A list or an array in place of a number becomes an axis of the result. All quantities are
dimensionless.
"""

from typing import TYPE_CHECKING

from bouncing_ball_beyond.inherited.first_use import first_use

# What type checkers, editors and the linter of imports see.
if TYPE_CHECKING:
    from bouncing_ball_beyond.accuracy.error_thresholds import error_thresholds as error_thresholds
    from bouncing_ball_beyond.drawing.result import Result as Result
    from bouncing_ball_beyond.models.ball import Ball as Ball
    from bouncing_ball_beyond.models.contact_model import ContactModel as ContactModel
    from bouncing_ball_beyond.models.laws.contact_law import ContactLaw as ContactLaw
    from bouncing_ball_beyond.models.laws.start_speed import Flores as Flores
    from bouncing_ball_beyond.models.laws.start_speed import (
        LankaraniNikravesh as LankaraniNikravesh,
    )
    from bouncing_ball_beyond.models.makers import corrected as corrected
    from bouncing_ball_beyond.models.makers import rigid as rigid
    from bouncing_ball_beyond.models.makers import spring_damper as spring_damper
    from bouncing_ball_beyond.models.rigid import RestitutionModel as RestitutionModel
    from bouncing_ball_beyond.models.spring_damper import SpringDamper as SpringDamper
    from bouncing_ball_beyond.motions.motion_of import basins as basins
    from bouncing_ball_beyond.motions.motion_of import lyapunov_exponent as lyapunov_exponent
    from bouncing_ball_beyond.motions.motion_of import motion_of as motion_of
    from bouncing_ball_beyond.motions.motion_of import orbit_diagram as orbit_diagram
    from bouncing_ball_beyond.motions.orbit_of_motion import orbit_of_motion as orbit_of_motion
    from bouncing_ball_beyond.motions.over_time import drop as drop
    from bouncing_ball_beyond.motions.over_time import history as history
    from bouncing_ball_beyond.motions.over_time import simulate as simulate
    from bouncing_ball_beyond.periodic.branches.follow import follow as follow
    from bouncing_ball_beyond.periodic.branches.grazing import GrazingForm as GrazingForm
    from bouncing_ball_beyond.periodic.branches.grazing import grazing_form as grazing_form
    from bouncing_ball_beyond.periodic.branches.labelled import BranchDataset as BranchDataset
    from bouncing_ball_beyond.periodic.branches.labelled import FollowedBranch as FollowedBranch
    from bouncing_ball_beyond.periodic.branches_of_ball import branch as branch
    from bouncing_ball_beyond.periodic.law_balls import contact_law as contact_law
    from bouncing_ball_beyond.periodic.orbits.normal_form import NormalForm as NormalForm
    from bouncing_ball_beyond.periodic.orbits.normal_form import normal_form as normal_form
    from bouncing_ball_beyond.periodic.orbits.orbit import Orbit as Orbit
    from bouncing_ball_beyond.periodic.orbits.paths import ParameterPath as ParameterPath
    from bouncing_ball_beyond.periodic.orbits_of_ball import TwoLimits as TwoLimits
    from bouncing_ball_beyond.periodic.orbits_of_ball import limits as limits
    from bouncing_ball_beyond.periodic.orbits_of_ball import orbit as orbit
    from bouncing_ball_beyond.periodic.orbits_of_ball import orbit_near as orbit_near
    from bouncing_ball_beyond.periodic.orbits_of_ball import orbits as orbits
    from bouncing_ball_beyond.periodic.orbits_of_ball import permanent_contact as permanent_contact
    from bouncing_ball_beyond.periodic.read_orbits import open as open
    from bouncing_ball_beyond.periodic.read_orbits import read_orbits as read_orbits

__version__ = "0.1.0"

# The public names and the modules in which they are defined.
_MODULES = {
    "Ball": "models.ball",
    "BranchDataset": "periodic.branches.labelled",
    "ContactLaw": "models.laws.contact_law",
    "ContactModel": "models.contact_model",
    "Flores": "models.laws.start_speed",
    "FollowedBranch": "periodic.branches.labelled",
    "GrazingForm": "periodic.branches.grazing",
    "LankaraniNikravesh": "models.laws.start_speed",
    "NormalForm": "periodic.orbits.normal_form",
    "Orbit": "periodic.orbits.orbit",
    "ParameterPath": "periodic.orbits.paths",
    "RestitutionModel": "models.rigid",
    "Result": "drawing.result",
    "SpringDamper": "models.spring_damper",
    "TwoLimits": "periodic.orbits_of_ball",
    "basins": "motions.motion_of",
    "branch": "periodic.branches_of_ball",
    "contact_law": "periodic.law_balls",
    "corrected": "models.makers",
    "drop": "motions.over_time",
    "error_thresholds": "accuracy.error_thresholds",
    "follow": "periodic.branches.follow",
    "grazing_form": "periodic.branches.grazing",
    "history": "motions.over_time",
    "limits": "periodic.orbits_of_ball",
    "lyapunov_exponent": "motions.motion_of",
    "motion_of": "motions.motion_of",
    "normal_form": "periodic.orbits.normal_form",
    "open": "periodic.read_orbits",
    "orbit": "periodic.orbits_of_ball",
    "orbit_diagram": "motions.motion_of",
    "orbit_near": "periodic.orbits_of_ball",
    "orbit_of_motion": "motions.orbit_of_motion",
    "orbits": "periodic.orbits_of_ball",
    "permanent_contact": "periodic.orbits_of_ball",
    "read_orbits": "periodic.read_orbits",
    "rigid": "models.makers",
    "simulate": "motions.over_time",
    "spring_damper": "models.makers",
}

__all__ = list(_MODULES)

# Of the names that are known already, only the version is public.
__getattr__, __dir__ = first_use(__name__, _MODULES, {"__version__": __version__})

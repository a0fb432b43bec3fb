"""The end of a ball: the kind of the motion that it reaches, and the impacts of this motion."""

from typing import NamedTuple

import numpy as np

from bouncing_ball.contacts.resolved import ResolvedContact
from bouncing_ball.long_run.basins import MotionName
from bouncing_ball.long_run.destination import final_motions
from bouncing_ball.long_run.motions import Kind
from bouncing_ball.long_run.sampled_means import Starts
from bouncing_ball.periodic.one_impact import n_t


class FirstImpact(NamedTuple):
    """A first impact: phase of the table and absolute velocity of the ball."""

    phase: float
    velocity: float


class Ending(NamedTuple):
    """The name of the motion on which a ball ends, impacts of this motion in order, and whether
    rounding errors decide on its period.
    """

    motion: MotionName
    impacts: Starts
    is_unresolved: bool = False

    @property
    def is_sampled(self) -> bool:
        """Whether the means of the motion are those of a sample of balls."""
        return self.motion.impacts == 0 and not self.is_unresolved


def end_of(case: ResolvedContact, name: str, first: FirstImpact) -> Ending:
    """The motion on which a ball of a model ends."""
    lam = case.table.amplitude
    path = np.empty((3, case.effort.impacts))
    found = final_motions(case.models[name], lam, *first, impacts=path.shape[1], path=path)
    motion = MotionName(Kind(str(found.kind)), int(found.periods), int(found.impacts))
    followed = int(found.followed)
    seen = path[1:, :followed]
    unresolved = bool(found.is_unresolved())
    if unresolved:
        # The motion begins with the impact after which the ball forgot what was before.
        began = np.flatnonzero(seen[0] == found.end_phase)
        of_motion = seen[:, began[0] if began.size else followed // 2 :]
    else:
        last = np.array([[found.end_phase], [found.end_velocity]])
        of_motion = np.concatenate([seen[:, followed // 2 :], last], axis=1)
    return Ending(motion, Starts.of_path(of_motion, lam), unresolved)


def on_orbit(case: ResolvedContact, n: int) -> Ending:
    """The n-T orbit of the restitution model."""
    orbit = n_t.orbit(case.models["restitution"], n, case.table.amplitude)
    impact = Starts(np.atleast_1d(orbit.phase), np.atleast_1d(orbit.impact_velocity))
    return Ending(MotionName(Kind.ORBIT, n, 1), impact)

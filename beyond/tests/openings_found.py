"""Openings of long contacts, on orbits that begin at permanent contact."""

from dataclasses import replace

import numpy as np

from bouncing_ball_beyond.exhibits.cascade_of_flights import stiff_openings
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.damping import damping_ratio
from bouncing_ball_beyond.models.permanent_contact import permanent_contact_threshold
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.motions.destination import IMPACTS, final_motions
from bouncing_ball_beyond.motions.orbit_of_motion import of_motion
from bouncing_ball_beyond.periodic.branches.following import branch_from
from bouncing_ball_beyond.periodic.orbits.special import Special
from bouncing_ball_beyond.periodic.orbits.steps import STEPS


def threshold(r, ratio):
    """Λ_SD."""
    return permanent_contact_threshold(ratio, damping_ratio(r))


def set_down(r, ratio, excess):
    """Contact, Λ, φ and z′ of a ball that is set down slowly behind the top of the table, at E."""
    lam = threshold(r, ratio) + np.asarray(excess) / np.square(ratio)
    phase = np.pi / 2 + 3 / ratio
    model = ContactModel(SpringDamper(ratio, damping_ratio(r)))
    return model, lam, phase, lam * np.cos(phase) - 0.1 / np.square(ratio)


def motions(r, ratio, excess, impacts=IMPACTS):
    """What such a ball ends on."""
    return final_motions(*set_down(r, ratio, excess), impacts=impacts)


def opening(r, ratio, k, start=None):
    """Opening k of a contact with ϖ, on the branch of orbits with k flights from a start E on, by
    default in the middle between the limits of both openings.
    """
    limits = np.array([0.0, *stiff_openings(float(damping_ratio(r)), k)])
    below = (limits[-2] + limits[-1]) / 2 if start is None else start
    model, lam, phase, velocity = set_down(r, ratio, below)
    orbit = of_motion(model, float(lam), phase, float(velocity))
    assert (orbit.impacts, orbit.periods) == (k, 1)
    top = threshold(r, ratio) + 1.5 * limits[-1] / ratio**2
    steps = replace(STEPS, initial=1e-3)
    found = branch_from(orbit, to=float(top), control=steps)
    return next(each for each in found.special if each.kind == Special.GRAZING_RELEASE)

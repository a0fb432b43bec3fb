"""A free impact of a spring-damper contact, by the damping ratio (beyond the paper).

Without gravity the impact depends on k, c and m only through ω = √(k/m) and ζ = c/(2√(km)), which
users of physics engines need to know. Times are ωt, which are the times of a contact with ϖ = 1.
"""

import numpy as np
import xarray as xr

from bouncing_ball.contacts.damping import damping_ratio
from bouncing_ball.contacts.oscillator import responses
from bouncing_ball.contacts.spring_damper import Release, SpringDamper
from bouncing_ball.datasets.variables import described
from bouncing_ball.parameters import LossyRestitution, Parameters, Samples


class FreeImpacts(Parameters):
    """The contact whose force is drawn over time, and the smallest r of the curves over ζ."""

    restitution: LossyRestitution
    restitution_min: LossyRestitution
    samples: Samples


def free_impacts(parameters: FreeImpacts) -> xr.Dataset:
    """Free impacts by release rule and ζ, and the force during one contact.

    The dataset has ``restitution`` and ``contact_duration``, in units of 1/ω, over (release,
    damping_ratio); ``free_force`` over ``time``, for the contact with r by the displacement
    release, divided by mω times the impact speed; ``contact_end``, the time at which each release
    ends that contact, and ``end_restitution``, over ``release``.
    """
    zeta = np.linspace(0.0, damping_ratio(parameters.restitution_min), parameters.samples)
    shown = float(damping_ratio(parameters.restitution))
    along, ones = ([SpringDamper(1.0, z, rule) for rule in Release] for z in (zeta, shown))
    time = np.linspace(0.0, float(ones[0].free_duration), parameters.samples)
    penetration, rate = responses(time, 1.0, shown).impulse
    dims = ("release", "damping_ratio")
    return described(
        {
            "restitution": (dims, [one.restitution for one in along]),
            "contact_duration": (dims, [one.free_duration for one in along]),
            "free_force": ("time", ones[0].force(penetration, rate)),
            "contact_end": ("release", [float(one.free_duration) for one in ones]),
            "end_restitution": ("release", [float(one.restitution) for one in ones]),
        },
        coords={"release": [str(rule) for rule in Release], "damping_ratio": zeta, "time": time},
    )

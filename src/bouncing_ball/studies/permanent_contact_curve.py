"""Threshold of permanent contact along ϖ (Fig. 11)."""

import xarray as xr

from bouncing_ball.contacts.damping import damping_ratio
from bouncing_ball.contacts.permanent_contact import permanent_contact_minimum
from bouncing_ball.contacts.release import Release
from bouncing_ball.contacts.spring_damper import permanent_contact_threshold
from bouncing_ball.datasets.variables import described
from bouncing_ball.orbits.model import RESTITUTION_THRESHOLD
from bouncing_ball.parameters import Parameters, Restitution, Span


class PermanentContact(Parameters):
    """The threshold of permanent contact of one restitution coefficient along ϖ.

    It has a minimum where ζ < 1/√2 (Eq. 36), which is r > e^-π = 0.0432.
    """

    restitution: Restitution
    frequency_ratio: Span


def permanent_contact(parameters: PermanentContact, release: Release) -> xr.Dataset:
    """The threshold of permanent contact along ϖ, in both models (Fig. 11, Eqs. 33 and 36).

    The dataset has ``threshold_amplitude`` (ϖ,), a value of Λ, and the numbers
    ``minimum_threshold`` and ``minimum_frequency_ratio`` of its minimum, ``restitution_threshold``
    = Λ_CR, and ``damping_ratio`` ζ.

    Raises
    ------
    ModelError
        If the damping is too strong for a minimum to exist.
    """
    ratios = parameters.frequency_ratio.grid()
    zeta = float(damping_ratio(parameters.restitution))
    curve = permanent_contact_threshold(ratios, zeta, release)
    lowest = permanent_contact_minimum(zeta, release)
    return described(
        {
            "threshold_amplitude": ("frequency_ratio", curve),
            "minimum_threshold": ((), float(lowest.threshold)),
            "minimum_frequency_ratio": ((), float(lowest.frequency_ratio)),
            "restitution_threshold": ((), RESTITUTION_THRESHOLD),
            "damping_ratio": ((), zeta),
        },
        coords={"frequency_ratio": ratios},
    )

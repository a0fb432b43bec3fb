"""Thresholds of permanent contact along ϖ (Figs. 11 and 16)."""

import xarray as xr

from bouncing_ball.accuracy.errors import Quantity
from bouncing_ball.datasets.parameters import Parameters, Restitution, Span, Tolerance
from bouncing_ball.datasets.variables import Variable, describe, described
from bouncing_ball.models.damping import Release, damping_ratio
from bouncing_ball.models.permanent_contact import (
    RESTITUTION_THRESHOLD,
    permanent_contact_minimum,
    permanent_contact_threshold,
)
from bouncing_ball.paper.exhibits.errors_along_ratio import errors_along_ratio

VARIABLES = {
    "minimum_threshold": Variable(
        "lowest threshold of permanent contact", symbol="2ζ√(1-ζ²)", equation="Eq. 36"
    ),
    "minimum_frequency_ratio": Variable(
        "where the lowest threshold is", symbol="1/√(1-2ζ²)", equation="Eqs. 34-36"
    ),
    "restitution_threshold": Variable(
        "threshold of permanent contact, restitution model", symbol="Λ_CR", equation="Eq. 9"
    ),
}


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
        variables=VARIABLES,
    )


class PermanentContactError(PermanentContact):
    """The threshold of permanent contact along ϖ, and its tolerated relative error."""

    tolerance: Tolerance


def permanent_contact_error(parameters: PermanentContactError, release: Release) -> xr.Dataset:
    """Permanent contact along ϖ in both models, and ϖ_PC for the tolerance (Eq. 38, Fig. 16).

    The dataset has ``relative_error`` (ϖ,), the numbers ``error_threshold`` and
    ``threshold_status`` (see :func:`~.errors_along_ratio.errors_along_ratio`), and the variables of
    :func:`permanent_contact`.

    Raises
    ------
    ModelError
        If the damping is too strong for a minimum of the threshold to exist.
    """
    error = errors_along_ratio(
        parameters.restitution,
        release,
        # The threshold of permanent contact depends neither on n nor on Λ.
        n=1,
        amplitude=1.0,
        ratios=parameters.frequency_ratio.grid(),
        quantities=[Quantity.PERMANENT_CONTACT],
        tolerances=[parameters.tolerance],
    ).squeeze(["quantity", "tolerance"], drop=True)
    return describe(permanent_contact(parameters, release).merge(error), variables=VARIABLES)

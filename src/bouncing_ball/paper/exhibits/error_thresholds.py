"""How stiff a contact must be for the restitution model to be accurate (Eqs. 37-38, Fig. 14)."""

from typing import Annotated

import xarray as xr
from pydantic import Strict

from bouncing_ball.accuracy.errors import Quantity
from bouncing_ball.datasets.parameters import Many, Tolerance
from bouncing_ball.datasets.variables import Variable, describe
from bouncing_ball.models.damping import Release
from bouncing_ball.models.restitution import RestitutionModel
from bouncing_ball.models.spring_damper import SpringDamper
from bouncing_ball.paper.exhibits.errors_along_ratio import errors_along_ratio
from bouncing_ball.paper.exhibits.orbit_parameters import (
    OrbitErrors,
    OrbitsAlongRatio,
    require_any_orbit,
)
from bouncing_ball.periodic.explicit import explicit_branch

VARIABLES = {
    "restitution_max_height": Variable(
        "greatest height, restitution model", symbol="max z_CR", equation="Eq. 37"
    ),
}


class ErrorThresholds(OrbitsAlongRatio):
    """One orbit along ϖ, the quantities compared on it and the tolerated relative errors."""

    quantities: Many[Annotated[Quantity, Strict(False)]]
    tolerances: Many[Tolerance]


def error_thresholds(parameters: ErrorThresholds, release: Release) -> xr.Dataset:
    """Errors of the restitution model along ϖ, and the ϖ above which each is tolerable.

    The dataset has ``relative_error`` (quantity, ϖ), the modulus, infinite where a model lacks the
    quantity; ``error_threshold`` (quantity, tolerance), a ϖ, NaN where there is none; and
    ``threshold_status`` (quantity, tolerance), a text.
    """
    dataset = errors_along_ratio(
        parameters.restitution,
        release,
        n=parameters.n,
        amplitude=parameters.amplitude,
        ratios=parameters.frequency_ratio.grid(),
        quantities=parameters.quantities,
        tolerances=parameters.tolerances,
    )
    return describe(dataset, variables=VARIABLES)


def height_error(parameters: OrbitErrors, release: Release) -> xr.Dataset:
    """Greatest height along ϖ in both models, and ϖ_h for the tolerance (Eq. 37, Fig. 14).

    The dataset has ``relative_error`` (ϖ,), the numbers ``error_threshold`` and
    ``threshold_status`` (see :func:`error_thresholds`), and
    ``max_height``, ``phase`` in rad, ``contact_duration``, ``impact_velocity`` and ``admissible``
    of the exact orbit, shape (ϖ,), NaN where there is none; ``restitution_max_height`` is a number.

    Raises
    ------
    NoOrbitError
        If there is no exact orbit on any of the contacts.
    """
    n = parameters.n
    lam = parameters.amplitude
    ratios = parameters.frequency_ratio.grid()
    error = errors_along_ratio(
        parameters.restitution,
        release,
        n=n,
        amplitude=lam,
        ratios=ratios,
        quantities=[Quantity.MAX_HEIGHT],
        tolerances=[parameters.tolerance],
    ).squeeze(["quantity", "tolerance"], drop=True)
    contact = SpringDamper.from_restitution(parameters.restitution, ratios, release)
    orbit = explicit_branch(contact).orbit(n, lam)
    require_any_orbit(orbit.exists, n, lam, ratios)
    rigid = explicit_branch(RestitutionModel(parameters.restitution)).orbit(n, lam)
    names = ("max_height", "phase", "contact_duration", "impact_velocity", "admissible")
    heights = xr.Dataset(
        {name: ("frequency_ratio", getattr(orbit, name)) for name in names},
        coords={"frequency_ratio": ratios},
    ).assign(restitution_max_height=rigid.max_height)
    return describe(heights.merge(error), variables=VARIABLES)

"""Every formula of the paper that can be wrong, against a second computation.

Each row of the dataset gives the largest disagreement over a sample of
parameters and what rounding accounts for. The formulas are those of
:mod:`bouncing_ball.claims.as_printed`; what they are compared with uses none of
them.
"""

from collections.abc import Callable
from typing import Annotated

import numpy as np
import xarray as xr

from bouncing_ball.claims.formulas.contact_equations import (
    Static,
    damping_checks,
    motion_checks,
    orbit_checks,
    points_with_one_impact,
    static_error,
)
from bouncing_ball.claims.formulas.disagreement import Check
from bouncing_ball.claims.formulas.permanent_contact_equations import permanent_contact_checks
from bouncing_ball.claims.formulas.restitution_equations import restitution_checks
from bouncing_ball.datasets.variables import described
from bouncing_ball.parameters import Parameters, Seed, number

# In the order of the paper.
_PARTS: tuple[Callable[..., dict[str, Check]], ...] = (
    restitution_checks,
    motion_checks,
    damping_checks,
    orbit_checks,
    permanent_contact_checks,
)


class Formulas(Parameters):
    """The random parameters on which the formulas are tried, and an impact on a table at rest."""

    samples: Annotated[int, number("random parameters for each formula", ge=8, le=1000)]
    curve_points: Annotated[int, number("random points of the explicit curve", ge=8, le=100_000)]
    seed: Seed
    static: Static


def formulas(parameters: Formulas) -> xr.Dataset:
    """Disagreement of every printed formula, over ``samples`` random parameters, (formula,)."""
    rng = np.random.default_rng(parameters.seed)
    checks: dict[str, Check] = {}
    for part in _PARTS:
        checks |= part(rng, parameters.samples)
    points = parameters.curve_points
    admissible = points_with_one_impact(rng, points)
    disagreement, budget, comparison = zip(*checks.values(), strict=True)
    return described(
        {
            "disagreement": ("formula", np.array(disagreement)),
            "budget": ("formula", np.array(budget)),
            "compared_with": ("formula", np.array(comparison)),
            "static_error": static_error(parameters.static),
            "curve_points": ((), points),
            "curve_points_admissible": ((), admissible),
        },
        coords={"formula": list(checks)},
    )

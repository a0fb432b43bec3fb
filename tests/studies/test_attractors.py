"""Maps of what balls end on, against orbits, an independent trial, and a changed rounding."""

import numpy as np
import pytest
from scipy.stats import norm

from bouncing_ball.attractors.mapper import label
from bouncing_ball.compare.data import compare_datasets
from bouncing_ball.configuration.study import typed
from bouncing_ball.contacts.release import Release
from bouncing_ball.studies.attractors import GROUPS, agreement, locking, models

START = {"phase": 1.0, "impact_speed": 10.0, "impacts": 2000, "confidence": 0.95}


def study(ratio, lam, r, **changed):
    """The map of a few nodes; ends and number of amplitudes and restitution coefficients."""
    grids = ({"min": x[0], "max": x[1], "samples": x[2]} for x in (lam, r))
    given = dict(zip(("amplitude", "restitution"), grids, strict=True)) | START | changed
    return typed(locking)(given | {"frequency_ratio": [ratio]}, Release.DISPLACEMENT)


@pytest.mark.parametrize(
    ("ratio", "periods"), [(80.0, (13, 8, 8)), (320.0, (13, 20, 43)), (1280.0, (13, 25, 23))]
)
def test_locked_periods_are_those_of_an_independent_simulation(ratio, periods):
    """At (r, Λ) = (0.6, 3.0), where a trial counted the time from one sticking to the next."""
    one = study(ratio, (2.5, 3.0, 2), (0.5, 0.6, 2)).sel(restitution=0.6, amplitude=3.0)
    assert set(one.kind.values) == {"locked"} and tuple(one.periods.values) == periods


def test_exponents_of_orbits_are_those_of_their_multipliers():
    data = study(100.0, (1.3, 1.5, 3), (0.5, 0.6, 2))
    for model, name in zip(models(data.restitution.values[:, None], 100.0, Release.DISPLACEMENT),
                           data["model"].values, strict=True):  # fmt: skip
        one = data.sel(model=name)
        orbit = model.orbit(1, data["amplitude"].values)
        larger = np.abs(orbit.multipliers).max(axis=-1)
        there = ((one.kind == "orbit") & (one.periods == 1) & (one.impacts == 1)).values
        assert there.any() and np.all(larger[there] < 1)
        exponent = one.lyapunov_exponent.values[there]
        assert np.allclose(exponent, np.log(larger[there]), atol=one.lyapunov_error.values.min())
        # The sum of both exponents is that of the area.
        assert np.all(exponent >= np.log(orbit.determinant[there]) / 2 - 1e-12)


def test_a_model_agrees_with_itself_and_wilsons_limits_are_closed_forms():
    balls = label(0.5, np.linspace(1.2, 3.2, 9), 1.0, -9.0)
    nodes, share, low, high = agreement(balls, balls, 0.95)
    known, z = nodes > 0, norm.ppf(0.975)
    assert nodes[GROUPS.index("all")] == np.sum(balls.kind != "undecided")
    assert np.all(share[known] == 1) and np.all(high[known] == 1)
    assert np.allclose(low[known], nodes[known] / (nodes[known] + z**2))


def drifted(record, new):
    return {
        row.name for row in compare_datasets("ext_locking", record, new) if not row.outcome.agrees
    }


def test_a_changed_rounding_is_within_the_budget_and_a_changed_model_is_not():
    sizes = {"lam": (1.5, 4.5, 24), "r": (0.3, 0.7, 10), "impacts": 300}
    first, again, stiffer = (
        study(ratio, **sizes, phase=phase).assign_attrs({})
        for ratio, phase in ((100.0, 1.0), (100.0, 1.0 + 1e-15), (50.0, 1.0))
    )
    assert not first.identical(again) and drifted(first, again) == set()
    stiffer = stiffer.assign_coords(frequency_ratio=first.frequency_ratio)
    assert {"kind", "periods", "lyapunov_exponent"} <= drifted(first, stiffer)

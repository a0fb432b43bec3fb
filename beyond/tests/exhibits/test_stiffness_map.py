"""The map of the ϖ that the greatest height needs, against other routes to its thresholds."""

import numpy as np
import pytest

from bouncing_ball_beyond.accuracy.error_law import (
    law_errors,
    remainder_scale,
    small_parameter,
)
from bouncing_ball_beyond.accuracy.simple_models import errors, search
from bouncing_ball_beyond.exhibits.stiffness_map import (
    Nodes,
    StiffnessMap,
    height_errors,
    stiffness_map,
)
from bouncing_ball_beyond.exhibits.stiffness_map_figures import stiffness_map as drawn
from bouncing_ball_beyond.inherited.accuracy.errors import Quantity
from bouncing_ball_beyond.inherited.accuracy.thresholds import RATIOS
from bouncing_ball_beyond.inherited.drawing.style import style
from bouncing_ball_beyond.models.damping import Release, damping_ratio
from bouncing_ball_beyond.models.laws.signature import Signature
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.periodic.one_impact.spring_damper_bifurcations import orbit_at

HEIGHT = [Quantity.MAX_HEIGHT]
GIVEN = {
    "n": [1, 2, 3],
    "restitution": {"min": 0.05, "max": 0.99, "samples": 12},
    "positions": 9,
    "frequency_ratio": {"min": 2.0, "max": 1e5, "samples": 61},
    "tolerance": 0.01,
}


@pytest.fixture(scope="module")
def data():
    return stiffness_map(StiffnessMap(**GIVEN))


@pytest.fixture(scope="module")
def row(data):
    """All nodes in one row, with their thresholds."""
    return data.stack(node=data.amplitude.dims)


def nodes_of(row):
    return Nodes(row.n.values, row.restitution.values, row.amplitude.values)


def contacts(row, ratio):
    return SpringDamper(ratio, damping_ratio(row.restitution.values), Release.DISPLACEMENT)


def test_every_variable_is_described(data, described):
    described(data)


def test_the_thresholds_are_those_of_the_search_for_any_quantity(row):
    """That search brackets each orbit, and scans other ϖ."""
    # At the saddle-node itself the height changes with the root of Λ, so that a rounding error of Λ
    # moves the threshold in the seventh digit.
    known = row.isel(node=(row.error_threshold.notnull() & (row.position > 0)).values)
    some = known.isel(node=np.random.default_rng(64).choice(known.sizes["node"], 60))
    zeta = damping_ratio(some.restitution.values)
    found = search(
        zeta,
        Release.DISPLACEMENT,
        some.n.values,
        some.amplitude.values,
        ratios=RATIOS,
        tolerance=GIVEN["tolerance"],
        quantities=HEIGHT,
    )
    assert np.abs(found.threshold[0, 0] / some.error_threshold.values - 1).max() < 1e-9


def test_the_law_has_the_thresholds_of_the_branch(data):
    apart = np.abs(data.threshold_by_law / data.error_threshold - 1)
    # Elsewhere the error only just reaches the tolerance with one of both signs.
    assert float((apart > data.law_differs_above).sum() / apart.notnull().sum()) < 0.01
    # At the saddle-node, too, and there ϖ is in the thousands.
    node = apart.sel(n=1, position=0).where(data.error_threshold.sel(n=1, position=0) > 500)
    assert node.notnull().sum() >= 3 and node.max() < 1e-3


def test_from_the_threshold_on_the_error_stays_within_the_tolerance(row):
    known = row.isel(node=row.error_threshold.notnull().values)
    nodes = nodes_of(known)
    for above in (1 + 1e-6, *np.geomspace(1.01, 100, 40)):
        error = height_errors(nodes, above * known.error_threshold.values)
        assert np.abs(error).max() <= GIVEN["tolerance"]
    below = height_errors(nodes, (1 - 1e-6) * known.error_threshold.values)
    assert np.abs(below).min() > GIVEN["tolerance"]


def test_without_a_stable_and_admissible_orbit_there_is_no_threshold(row):
    lacking = row.error_threshold.isnull().values
    assert 0 < lacking.sum() < lacking.size / 2
    known = row.isel(node=~lacking)
    orbits = orbit_at(
        contacts(known, known.error_threshold.values), known.n.values, known.amplitude.values
    )
    assert orbits.is_stable().all() and orbits.is_admissible().all()
    # The others are next to the period doubling: on contacts that are stiff enough to move it by
    # less than they are below it, they are stable again.
    others = row.isel(node=lacking)
    assert others.position.min() > 0.5
    inner = others.isel(node=(others.position < 1).values)
    stiff = orbit_at(contacts(inner, np.full(inner.sizes["node"], 1e5)), inner.n, inner.amplitude)
    assert stiff.is_stable().all()


def test_the_errors_are_those_of_the_error_law_within_its_remainder(row):
    # Rounding of r puts Λ below the saddle-node itself.
    known = row.isel(node=(row.error_threshold.notnull() & (row.position > 0)).values)
    contact = contacts(known, known.error_threshold.values)
    n = known.n.values
    error = known.rule_product.values / (n * known.error_threshold.values)
    assert np.abs(np.abs(error) / GIVEN["tolerance"] - 1).max() < 1e-9
    instant = Signature(contact)()
    orbits = n, instant, known.amplitude.values
    left = np.abs(error - law_errors(*orbits)[Quantity.MAX_HEIGHT])
    assert np.all(left < remainder_scale(*orbits)[Quantity.MAX_HEIGHT] * small_parameter(*orbits))


def test_the_rule_of_thumb_fails_next_to_saddle_nodes_of_small_restitution_only(data):
    fails = np.abs(data.rule_product) > 1
    assert fails.sel(n=1, restitution=0.05, position=0.0) and not fails.sel(n=3).any()
    where = data.stack(node=data.amplitude.dims).isel(
        node=fails.stack(node=data.amplitude.dims).values
    )
    assert where.restitution.max() < 0.55 and where.position.max() < 0.1
    # There the contact, whose saddle-node is lower, bounces higher.
    assert (where.rule_product > 0).all()


def test_for_an_elastic_ball_the_rule_of_thumb_is_nearly_needed(data):
    """As r → 1, nK tends to -1/(1 + 2Λ sin φ/(nπ)²) (docs/error-law.md)."""
    elastic = data.sel(restitution=0.99).isel(position=slice(1, None))
    n = elastic.n.values[:, np.newaxis]
    fold = n * np.pi * (1 - 0.99) / (1 + 0.99)
    lift = np.sqrt(elastic.amplitude.values**2 - fold**2)
    away = elastic.rule_product.values + 1 / (1 + 2 * lift / (n * np.pi) ** 2)
    # Both 1 - r and 1/ϖ are about 0.01.
    assert np.nanmax(np.abs(away)) < 0.01
    assert not (np.abs(data.rule_product.sel(restitution=0.99)) > 1).any()


@pytest.mark.parametrize(
    ("smallest", "largest", "is_admissible"), [(1.5, 1.51, False), (2.5, 100.0, True)]
)
def test_a_stable_orbit_that_is_inadmissible_does_not_count(smallest, largest, is_admissible):
    """With so compliant a contact and five periods in a flight the ball meets the table earlier."""
    given = {"n": [5], "restitution": {"min": 0.05, "max": 0.06, "samples": 2}, "positions": 9}
    ratio = {"min": smallest, "max": largest, "samples": 41}
    # The error is within this tolerance at every ϖ, so that the smallest is enough.
    found = stiffness_map(StiffnessMap(**given, frequency_ratio=ratio, tolerance=0.5))
    row = found.sel(n=5, restitution=0.05).isel(position=slice(1, 5))
    contact = SpringDamper(smallest, damping_ratio(0.05))
    orbits = orbit_at(contact, 5, row.amplitude.values)
    assert orbits.is_stable().all() and (orbits.is_admissible() == is_admissible).all()
    expected = smallest if is_admissible else np.nan
    assert np.array_equal(row.error_threshold, np.full(4, expected), equal_nan=True)


@pytest.mark.parametrize(("n", "ratio"), [(2, 1.0), (3, 0.8), (5, 1.5), (20, 5.0)])
def test_orbits_that_newtons_method_does_not_reach_are_bracketed(n, ratio):
    """Of some there is no orbit."""
    r, position = np.meshgrid(np.linspace(0.1, 0.9, 7), np.linspace(0.1, 0.9, 3))
    nodes = Nodes.at(np.full(r.size, n), r.ravel(), position.ravel())
    ratios = np.full(r.size, ratio)
    contact = SpringDamper(ratios, damping_ratio(nodes.restitution))
    expected = errors(contact, nodes.n, nodes.amplitude, HEIGHT)[0, 0]
    found = height_errors(nodes, ratios)
    assert np.isfinite(expected).any() and np.array_equal(np.isnan(found), np.isnan(expected))
    assert np.nanmax(np.abs(found - expected)) < 1e-12


def test_an_error_that_is_always_or_never_tolerated():
    ratio = {"min": 40.0, "max": 50.0, "samples": 5}
    few = GIVEN | {"n": [1], "restitution": {"min": 0.6, "max": 0.7, "samples": 2}, "positions": 3}
    loose = stiffness_map(StiffnessMap(**few | {"frequency_ratio": ratio, "tolerance": 0.1}))
    inside = loose.error_threshold.isel(position=1)
    assert (inside == 40.0).all() and (np.abs(loose.rule_product.isel(position=1)) < 4).all()
    strict = stiffness_map(StiffnessMap(**few | {"frequency_ratio": ratio, "tolerance": 1e-4}))
    assert strict.error_threshold.isnull().all()


@pytest.mark.parametrize("families", [[1], [3], [1, 2, 3]])
def test_the_map_is_drawn_with_a_panel_for_each_family(data, families):
    part = data.sel(n=families).assign_attrs(tolerance=GIVEN["tolerance"])
    with style():
        figure = drawn(part)
        labels = [[float(text.get_text()) for text in axes.texts] for axes in figure.axes]
    titles = [axes.get_title() for axes in figure.axes]
    assert titles == [f"$n={n}$" for n in families] + len(families) * [""]
    # Each contour is labelled once, by a ϖ of the map: by the branch above, by the law below.
    maps = [
        data[name].sel(n=n) for name in ("error_threshold", "threshold_by_law") for n in families
    ]
    for names, needed in zip(labels, maps, strict=True):
        assert names and len(set(names)) == len(names)
        assert float(needed.min()) < min(names) and max(names) < float(needed.max())

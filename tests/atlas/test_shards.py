"""Answers of tiles, whatever the pieces they are computed in."""

import numpy as np
import pytest
import xarray as xr

from bouncing_ball.atlas import shards
from bouncing_ball.atlas.answers import LAW_BINS, PER_DECADE, threshold_bins
from bouncing_ball.atlas.errors import orbit_errors
from bouncing_ball.atlas.merge import merge
from bouncing_ball.atlas.summary import summary
from bouncing_ball.atlas.walk import walk
from bouncing_ball.errors import ModelError


def whole(plan, limits):
    return merge(plan, (shards.shard(plan, k) for k in range(plan.shards)), limits)


@pytest.fixture(scope="module")
def limits(small):
    return shards.limit_shard(small())


@pytest.fixture(scope="module")
def parts(small):
    return [shards.shard(small(), k) for k in range(3)]


@pytest.fixture(scope="module")
def atlas(small, parts, limits):
    return merge(small(), iter(parts), limits)


def same(one, other):
    """Whether all arrays have the same bytes."""
    assert list(one.variables) == list(other.variables)
    return [
        name
        for name in one.variables
        if (one[name].dtype, one[name].values.tobytes())
        != (other[name].dtype, other[name].values.tobytes())
    ] == []


def test_every_variable_is_described(atlas, described):
    described(atlas)


def test_the_shards_do_not_change_a_byte(small, atlas, limits):
    assert same(whole(small(shards=10), limits), atlas)


# A tile has 8 nodes: a tile in pieces, and two tiles at a time.
@pytest.mark.slow
@pytest.mark.parametrize("block", [5, 17])
def test_the_blocks_do_not_change_an_answer(small, atlas, limits, block, monkeypatch):
    monkeypatch.setattr(shards, "BLOCK", block)
    assert same(whole(small(), limits), atlas)


def test_the_order_of_the_shards_is_of_no_account(small, atlas, parts, limits):
    assert same(merge(small(), iter([parts[k] for k in (2, 0, 1)]), limits), atlas)


@pytest.mark.parametrize("chosen", [(0, 1), (0, 1, 2, 1)])
def test_a_shard_too_few_or_too_many_is_refused(small, parts, limits, one_line, chosen):
    with pytest.raises(ModelError) as error:
        merge(small(), (parts[k] for k in chosen), limits)
    one_line(error, "of the atlas is in", "shards, not in one")


def test_the_answers_are_those_of_all_errors_at_once(small, atlas):
    # Without any piece: the errors of all nodes of a row kept, and asked directly.
    plan = small()
    row = plan.rows[4]
    nodes = plan.nodes(row)
    rule, n, r = (
        plan.releases[row.release],
        plan.families[row.n],
        atlas.restitution[row.restitution],
    )
    there = atlas.sel(release=str(rule), n=n, restitution=r)
    for step in walk(nodes, plan.ratios):
        error = orbit_errors(step.orbit, nodes.instant, step.frequency_ratio[:, np.newaxis])
        for k in np.nonzero(np.isin(step.frequency_ratio, plan.examined))[0]:
            at = there.sel(frequency_ratio=step.frequency_ratio[k])
            compare_with_all(plan, nodes, error[:, :, k], at)


def compare_with_all(plan, nodes, error, at):
    """The answers of a row of three tiles at one ϖ against the errors of all its nodes."""
    tiles = np.abs(error).reshape(*error.shape[:2], 3, -1)
    assert np.array_equal(at.largest_error.values, np.moveaxis(tiles.max(-1), -1, 0))
    for k, limit in enumerate(plan.tolerances):
        count = np.moveaxis((tiles > limit).sum(-1), -1, 0)
        assert np.array_equal(at.exceeding.values[..., k], count)
    worst = np.take_along_axis(
        nodes.amplitude.reshape(3, -1)[np.newaxis, np.newaxis],
        tiles.argmax(-1)[..., np.newaxis],
        -1,
    )[..., 0]
    assert np.array_equal(at.worst_amplitude.values, np.moveaxis(worst, -1, 0))


def test_counts_add_up(small, atlas):
    plan = small()
    nodes = (atlas.threshold_counts.sum("threshold_bin")).values
    reached = np.zeros(nodes.shape[:3], bool)
    reached[tuple(np.array(plan.rows).T)] = True
    assert np.all(nodes[reached] == plan.nodes_per_tile) and np.all(nodes[~reached] == 0)
    # The histogram has the extremes in its first and last bins that are not empty.
    filled = (atlas.threshold_counts > 0).values
    bins, last = atlas.threshold_bin.values, filled.shape[-1] - 1
    low, high = filled.argmax(-1), last - filled[..., ::-1].argmax(-1)
    smallest, largest = atlas.smallest_threshold.values, atlas.largest_threshold.values
    assert np.all((bins[low] <= smallest)[reached])
    assert np.all((bins[high] <= largest)[reached])
    bound = np.append(bins[1:], np.inf)
    # The first bin holds what is always tolerated, the last what never is.
    below = (largest < bound[high]) | (high == last) | (high == 0)
    assert np.all(below[reached])
    # What is tolerated from a ϖ on is tolerated there.
    assert int((atlas.holding + atlas.exceeding).max()) <= plan.nodes_per_tile


def test_the_law_is_kept_where_it_is_stated(atlas):
    assert int(atlas.law_stated.sum()) > 500
    assert int(atlas.law_exceeding.sum()) == 0
    assert int(atlas.limit_law_stated.sum()) > 30
    assert int(atlas.limit_law_exceeding.sum()) == 0
    stiff = atlas.law_counts.sel(frequency_ratio=100.0).sum(("release", "n", "position"))
    velocity = stiff.sel(quantity="bounce_velocity").sum("restitution")
    assert LAW_BINS[velocity.values.argmax()] == 0.99


def test_bins_are_even_in_the_logarithm():
    bins = threshold_bins(np.array([3.0, 1e5]))
    assert bins[0] == 0 and bins[-1] == np.inf and bins[-2] == pytest.approx(1e5)
    assert np.allclose(np.diff(np.log10(bins[1:-1])), 1 / PER_DECADE)
    assert bins[1] <= 3.0 < bins[2]


@pytest.fixture(scope="module")
def short(small, atlas):
    return summary(small(), atlas, 0.01, 100.0)


def test_the_summary_is_described(short, described):
    described(short)
    assert all(isinstance(short[name], xr.DataArray) for name in short.data_vars)


def test_shares_of_the_summary(small, atlas, short):
    plan, where = small(), {"release": "displacement", "n": 1, "model": "restitution"}
    height = where | {"quantity": "max_height", "tolerance": 0.01, "frequency_ratio": 100.0}
    nodes = plan.nodes_per_tile * 9
    expected = int(atlas.exceeding.sel(height).sum()) / nodes
    assert float(short.exceeding_share.sel(height)) == expected
    # Shares fall from the largest threshold down.
    levels = short.needed_quantile.transpose(..., "share").values
    assert np.all(np.diff(levels[..., :-1], axis=-1) >= 0)
    holds = short.holding_share.sel(height)
    assert float(holds) <= 1 - expected


def test_the_worst_nodes_of_the_summary(small, atlas, short):
    where = {"release": "force", "n": 3, "model": "corrected", "quantity": "phase"}
    tiles = atlas.largest_error.sel(where | {"frequency_ratio": 100.0})
    assert float(short.worst_error.sel(where)) == float(tiles.max())
    r, lam = (float(short[f"worst_{x}"].sel(where)) for x in ("restitution", "amplitude"))
    plan = small()
    row = next(x for x in plan.rows if plan.edges[x.restitution + 1] > r)
    assert r in plan.nodes(row).restitution
    assert lam in plan.nodes(row._replace(release=1, n=1)).amplitude


def test_the_corners_of_the_tiles_enclose_their_nodes(small, short):
    plan = small()
    corners = short.corner_amplitude.sel(n=3).values
    for row in (row for row in plan.rows if plan.families[row.n] == 3):
        lam = plan.nodes(row).amplitude
        around = corners[row.restitution : row.restitution + 2]
        assert around.min() < lam.min() and lam.max() < around.max()

"""Answers of tiles, whatever the pieces they are computed in."""

import numpy as np
import pytest

from bouncing_ball.accuracy.errors import errors, modulus, orbit_errors
from bouncing_ball.accuracy.quantities import OF_LIMITS
from bouncing_ball.atlas import answers, shards
from bouncing_ball.atlas.crossings import last_crossings
from bouncing_ball.atlas.walk import walk
from bouncing_ball.errors import ModelError


def same(one, other):
    """Whether all arrays have the same bytes."""
    assert list(one.variables) == list(other.variables)
    return all(one[name].values.tobytes() == other[name].values.tobytes() for name in one.variables)


def test_every_variable_is_described(atlas, described):
    described(atlas)


# A row has 24 nodes, a tile 8: blocks that end in the middle of tiles.
@pytest.mark.parametrize(
    ("order", "block"), [([0], 64), (range(10), 64), ([2, 0, 1], 64), ([0], 5), ([0], 17)]
)
def test_neither_shards_nor_blocks_change_a_byte(small, atlas, limits, order, block, monkeypatch):
    monkeypatch.setattr(answers, "BLOCK", block)
    plan = small(shards=len(order))
    assert same(shards.merge(plan, (shards.shard(plan, k) for k in order), limits), atlas)


@pytest.mark.parametrize("chosen", [(0, 1), (0, 1, 2, 1)])
def test_a_shard_too_few_or_too_many_is_refused(small, parts, limits, one_line, chosen):
    with pytest.raises(ModelError) as error:
        shards.merge(small(), (parts[k] for k in chosen), limits)
    one_line(error, "of the atlas is in", "shards, not in one")


def test_the_answers_are_those_of_all_errors_at_once(small, atlas, every_node):
    # Without any piece: the errors of all nodes of a row kept, and asked directly.
    plan = small()
    row = plan.rows[4]
    rule, family, tile = np.unravel_index(row, plan.shape)
    there = atlas.isel(release=rule, n=family, restitution=tile)
    nodes = every_node(plan, row)
    steps = list(walk(nodes, plan.ratios))
    ratios = np.concatenate([step.frequency_ratio for step in steps])
    found = np.concatenate([orbit_errors(step.orbit) for step in steps], axis=2)
    stable = np.concatenate([step.stable for step in steps])
    for ratio in plan.examined:
        k, at = int(np.flatnonzero(ratios == ratio)[0]), there.sel(frequency_ratio=ratio)
        tiles = modulus(found[:, :, k]).reshape(*found.shape[:2], 3, -1)
        assert np.array_equal(at.largest_error.values, np.moveaxis(tiles.max(-1), -1, 0))
        for m, limit in enumerate(plan.tolerances):
            count = np.moveaxis((tiles > limit).sum(-1), -1, 0)
            assert np.array_equal(at.exceeding.values[..., m], count)
        assert np.array_equal(at.unstable, (~stable[k]).reshape(3, -1).sum(-1))
        for name in ("restitution", "amplitude"):
            values = np.broadcast_to(getattr(nodes, name).reshape(3, -1), tiles.shape)
            worst = np.take_along_axis(values, tiles.argmax(-1)[..., np.newaxis], -1)[..., 0]
            assert np.array_equal(at[f"worst_{name}"].values, np.moveaxis(worst, -1, 0))


def test_counts_add_up(small, atlas):
    plan = small()
    nodes = atlas.threshold_counts.sum("threshold_bin").values
    reached = np.isin(np.arange(np.prod(plan.shape)), plan.rows).reshape(plan.shape)
    # The force release does not reach the first range of r: nothing is known of it.
    assert np.array_equal(nodes > 0, np.broadcast_to(reached.T, nodes.T.shape).T)
    assert np.all(nodes[reached] == plan.nodes_per_tile) and (~reached).sum() == 2
    for name in ("largest_threshold", "largest_error", "limit_needed"):
        assert np.all(np.isnan(atlas[name].values[~reached])), name
    # The histogram has the largest threshold in its last bin that is not empty.
    bins, largest = atlas.threshold_bin.values, atlas.largest_threshold.values[reached]
    last = len(bins) - 1 - (atlas.threshold_counts.values[reached] > 0)[..., ::-1].argmax(-1)
    assert np.all(bins[last] <= largest)
    above = largest >= np.append(bins[1:], np.inf)[last]
    assert np.all(~above | (last == len(bins) - 1) | (last == 0))
    # What is tolerated from a ϖ on is tolerated there, and from any larger one on.
    assert int((atlas.holding + atlas.exceeding).max()) == plan.nodes_per_tile
    assert np.all(atlas.holding.diff("frequency_ratio") >= 0)


def test_the_law_is_kept_where_it_is_stated(atlas):
    assert int(atlas.law_stated.sum()) > 500 and int(atlas.law_exceeding.sum()) == 0


def test_the_limits_of_a_row_are_the_largest_of_its_r(small, limits):
    plan, found = small(), []
    row, down = plan.rows[-1], plan.ratios[::-1]
    for r in plan.restitutions(row):
        one = plan.placed(row, np.array([r]), np.zeros(1))
        error = errors(one.contact(down[:, np.newaxis]), one.n, one.amplitude, OF_LIMITS)
        threshold = last_crossings(down, np.moveaxis(error, 2, 0), np.array(plan.tolerances))
        found.append(np.moveaxis(threshold[..., 0], 0, -1))
    np.testing.assert_allclose(limits.limit_needed[-1], np.max(found, axis=0), rtol=1e-9)

"""Answers of tiles do not depend on the pieces in which they are computed."""

import numpy as np
import pytest

from bouncing_ball.accuracy import error_law
from bouncing_ball.accuracy.errors import OF_LIMITS, OF_ORBITS
from bouncing_ball.accuracy.simple_models import errors
from bouncing_ball.beyond.atlas import answers, shards
from bouncing_ball.beyond.atlas.answers import last_crossings
from bouncing_ball.beyond.atlas.walk import walk
from bouncing_ball.errors import ModelError
from bouncing_ball.models.laws.signature import Signature


def same(one, other):
    """Whether all arrays have the same bytes."""
    assert list(one.variables) == list(other.variables)
    return all(one[name].values.tobytes() == other[name].values.tobytes() for name in one.variables)


def test_every_variable_is_described(atlas, described):
    described(atlas)


# A row has 24 nodes, a tile 8: blocks that end in the middle of tiles.
@pytest.mark.parametrize(
    ("order", "block"),
    [
        ([2, 0, 1], 17),
        *(pytest.param(*x, marks=pytest.mark.long) for x in ((range(10), 64), ([0], 5))),
    ],
)
def test_neither_shards_nor_blocks_change_a_byte(small, atlas, limits, order, block, monkeypatch):
    monkeypatch.setattr(answers, "BLOCK", block)
    plan = small(shards=len(order))
    assert same(shards.merge(plan, (shards.shard(plan, k) for k in order), limits), atlas)


@pytest.mark.parametrize("chosen", [(0, 1), (0, 1, 2, 1)])
def test_a_shard_too_few_or_too_many_is_refused(small, parts, limits, refusal, chosen):
    with refusal(ModelError, "of the atlas is in", "shards, not in one"):
        shards.merge(small(), (parts[k] for k in chosen), limits)


def test_the_answers_are_those_of_all_errors_at_once(small, every_node, monkeypatch):
    # Without any piece: the errors of all nodes of a row kept, and asked directly. As if the
    # models had no orbit at some Λ, and with so small an M that the law is exceeded.
    def with_gaps(orbit):
        return np.where(orbit.amplitude < np.median(orbit.amplitude), errors_of(orbit), np.nan)

    errors_of = answers.orbit_errors
    bound = 0.05
    counted = []
    monkeypatch.setattr(answers, "orbit_errors", with_gaps)
    monkeypatch.setattr(error_law, "REMAINDER", dict.fromkeys(OF_ORBITS, bound))
    plan = small()
    row = plan.rows[4]
    nodes = every_node(plan, row)
    steps = list(walk(nodes, plan.ratios))
    ratios = np.concatenate([step.frequency_ratio for step in steps])
    found = np.concatenate([with_gaps(step.orbit) for step in steps], axis=2)
    stable = np.concatenate([step.stable for step in steps])
    # One tolerance is an error itself, which is then within it.
    at_ten = found[0, 0, ratios == 10.0][0]
    plan = small(tolerances=[0.1, float(np.nanmax(np.abs(at_ten))), 0.001])
    there = answers.row_answers(plan, row)
    law = error_law.coefficients(nodes.n, nodes.damping_ratio, nodes.amplitude, nodes.release)
    for place, ratio in enumerate(plan.examined):
        k = int(np.flatnonzero(ratios == ratio)[0])
        at = there.isel(frequency_ratio=place)
        tiles = found[:, :, k].reshape(2, 4, 3, -1)
        finite = np.isfinite(tiles)
        assert not finite.all() and finite.any()
        for m, limit in enumerate(plan.tolerances):
            beyond = ~finite | (np.abs(tiles) > limit)
            assert np.array_equal(at.exceeding[..., m], np.moveaxis(beyond.sum(-1), -1, 0))
            if m == 1:  # The threshold is an examined ϖ itself, but for rounding.
                continue
            # It holds from there on if the error is within the tolerance at every larger ϖ.
            right = np.all(np.abs(found[:, :, : k + 1]) <= limit, axis=2).reshape(tiles.shape)
            assert np.array_equal(at.holding[..., m], np.moveaxis(right.sum(-1), -1, 0))
        assert np.array_equal(at.unstable, (~stable[k]).reshape(3, -1).sum(-1))
        # |error - K/ϖ| > M S δ where δ < 0.3.
        own = nodes.n, Signature(nodes.contact(ratio))(), nodes.amplitude
        small_number = error_law.small_parameter(*own)
        whole = error_law.scale(*own)
        stated = np.isfinite(found[0, :, k]) & (small_number < 0.3)
        off = [np.abs(found[0, j, k] - law[q] / ratio) / whole[q] for j, q in enumerate(OF_ORBITS)]
        beyond = stated & (np.array(off) > bound * small_number)
        counted += [(stated & ~beyond).sum(), beyond.sum(), (~stated).sum()]
        for name, which in (("law_stated", stated), ("law_exceeding", beyond)):
            assert np.array_equal(at[name].T, which.reshape(4, 3, -1).sum(-1)), name
    assert np.all(np.sum(np.reshape(counted, (-1, 3)), axis=0) > 0)


def test_the_orbits_that_were_looked_for_are_counted(small, monkeypatch):
    monkeypatch.setattr("bouncing_ball.beyond.atlas.walk.REACHED", -1.0)
    plan = small()
    found = answers.row_answers(plan, plan.rows[0]).sought
    assert found.values.tolist() == 3 * [plan.nodes_per_tile * len(plan.ratios)]


def test_the_counts_add_up_to_the_number_of_nodes(small, atlas):
    plan = small()
    nodes = atlas.threshold_counts.sum("threshold_bin").values
    reached = np.isin(np.arange(np.prod(plan.shape)), plan.rows).reshape(plan.shape)
    # The force release does not reach the first range of r: nothing is known of it.
    assert np.array_equal(nodes > 0, np.broadcast_to(reached.T, nodes.T.shape).T)
    assert np.all(nodes[reached] == plan.nodes_per_tile) and (~reached).sum() == 2
    for name in ("largest_threshold", "limit_needed"):
        assert np.all(np.isnan(atlas[name].values[~reached])), name
    # The histogram has the largest threshold in its last bin that is not empty.
    bins = atlas.threshold_bin.values
    largest = atlas.largest_threshold.values[reached]
    last = len(bins) - 1 - (atlas.threshold_counts.values[reached] > 0)[..., ::-1].argmax(-1)
    assert np.all(bins[last] <= largest)
    above = largest >= np.append(bins[1:], np.inf)[last]
    assert np.all(~above | (last == len(bins) - 1) | (last == 0))
    # Three ranges from 0.05 to 0.95, and from 0 to 1: their middles.
    assert atlas.restitution.values == pytest.approx([0.2, 0.5, 0.8])
    assert atlas.position.values == pytest.approx([1 / 6, 0.5, 5 / 6])
    # The first bin has what is within the tolerance at every ϖ scanned.
    always = atlas.threshold_counts.isel(threshold_bin=0).values[reached] == plan.nodes_per_tile
    assert np.array_equal(always, np.isclose(largest, 3.0, rtol=1e-9)) and always.any()
    # What is tolerated from a ϖ on is tolerated there, and from any larger one on.
    assert int((atlas.holding + atlas.exceeding).max()) == plan.nodes_per_tile
    assert np.all(atlas.holding.diff("frequency_ratio") >= 0)


def test_the_law_is_kept_where_it_is_stated(atlas):
    assert int(atlas.law_stated.sum()) > 500 and int(atlas.law_exceeding.sum()) == 0


def test_the_limits_of_a_row_are_the_largest_of_its_r(small, limits):
    plan = small()
    found = []
    row = plan.rows[-1]
    down = plan.ratios[::-1]
    for r in plan.restitutions(row):
        one = plan.placed(row, np.array([r]), np.zeros(1))
        error = errors(one.contact(down[:, np.newaxis]), one.n, one.amplitude, OF_LIMITS)
        threshold = last_crossings(down, np.moveaxis(error, 2, 0), np.array(plan.tolerances))
        found.append(np.moveaxis(threshold[..., 0], 0, -1))
    np.testing.assert_allclose(limits.limit_needed[-1], np.max(found, axis=0), rtol=1e-9)

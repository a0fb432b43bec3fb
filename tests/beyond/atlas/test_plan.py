import numpy as np
import pytest

from bouncing_ball.models.damping import Release
from bouncing_ball.models.rigid import RestitutionModel
from bouncing_ball.periodic.one_impact import n_t


def test_every_node_is_in_its_tile_and_within_the_stable_range(small, every_node):
    plan = small()
    for row in plan.rows:
        rule, family, tile = np.unravel_index(row, plan.shape)
        nodes = every_node(plan, row)
        assert (nodes.release, nodes.n) == (plan.release[rule], plan.n[family])
        low, high = plan.edges[tile : tile + 2]
        assert np.all((low < nodes.restitution) & (nodes.restitution < high))
        model = RestitutionModel(nodes.restitution)
        bottom, top = (
            find(model, nodes.n).amplitude for find in (n_t.saddle_node, n_t.period_doubling)
        )
        place = (nodes.amplitude - bottom) / (top - bottom)
        assert np.array_equal(np.floor(place * 3), np.arange(len(place)) // plan.nodes_per_tile)
        # Even in both directions: all midpoints of a grid, each once.
        assert len(set(zip(nodes.restitution, place.round(9), strict=True))) == len(place) == 24
        assert place.min() == pytest.approx(1 / 24) and place.mean() == pytest.approx(0.5)
        assert nodes.restitution.mean() == pytest.approx((low + high) / 2)
        assert np.allclose(nodes.contact(5.0).restitution, nodes.restitution, rtol=1e-14)


def test_ranges_that_the_force_release_does_not_reach_are_left_out(small):
    plan = small(restitution={"min": 0.05, "max": 0.95, "tiles": 18, "samples": 1})
    assert plan.release == (Release.DISPLACEMENT, Release.FORCE)
    rule, _, tile = np.unravel_index(plan.rows, plan.shape)
    # e⁻² = 0.135 lies in the range from 0.1 to 0.15.
    lowest = [plan.edges[tile[rule == k].min()] for k in (0, 1)]
    assert lowest == [0.05, 0.15] and len(plan.rows) == 2 * (18 + 16)


@pytest.mark.parametrize("count", [1, 2, 5, 10, 1000])
def test_the_shards_share_the_rows(small, count):
    plan = small(shards=count)
    found = plan.shard_rows()
    assert np.array_equal(np.concatenate(found), plan.rows) and len(found) == min(count, 10)
    sizes = [len(rows) for rows in found]
    assert min(sizes) >= 1 and max(sizes) - min(sizes) <= 1


def test_what_is_examined_is_among_the_ratios_once(small):
    # 100 is on the grid from 10 to 1000 but for rounding.
    span = {"min": 10.0, "max": 1000.0, "samples": 21}
    plan = small(frequency_ratio=span, examined=[100.0, 77.0])
    assert {77.0, 100.0} <= set(plan.ratios) and len(plan.ratios) == 22
    assert np.all(np.diff(np.log(plan.ratios)) > 1e-3)
    assert plan.resolution == pytest.approx(100 ** (1 / 20) - 1)

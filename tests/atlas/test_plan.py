import numpy as np
import pytest

from bouncing_ball.atlas.plan import Plan
from bouncing_ball.configuration.yaml_file import read_yaml
from bouncing_ball.contacts.release import Release
from bouncing_ball.errors import ModelError
from bouncing_ball.orbits.restitution_model import RestitutionModel


def test_every_node_is_in_its_tile_and_within_the_stable_range(small):
    plan = small()
    for row in plan.rows:
        nodes, n = plan.nodes(row), plan.families[row.n]
        low, high = plan.edges[row.restitution : row.restitution + 2]
        assert np.all((low < nodes.restitution) & (nodes.restitution < high))
        model = RestitutionModel(nodes.restitution)
        bottom, top = model.saddle_node(n).amplitude, model.period_doubling(n).amplitude
        place = (nodes.amplitude - bottom) / (top - bottom)
        tile = np.arange(len(place)) // plan.nodes_per_tile
        assert np.array_equal(np.floor(place * 3), tile)
        assert np.allclose(nodes.contact(5.0).restitution, nodes.restitution, rtol=1e-14)


def test_ranges_that_the_force_release_does_not_reach_are_left_out(small):
    plan = small(restitution={"min": 0.05, "max": 0.95, "tiles": 18, "samples": 1})
    lowest = {row.release: plan.edges[row.restitution] for row in reversed(plan.rows)}
    assert plan.releases == [Release.DISPLACEMENT, Release.FORCE]
    # e⁻² = 0.135 lies in the range from 0.1 to 0.15.
    assert lowest == {0: 0.05, 1: 0.15}


def test_the_shards_share_the_rows(small):
    for count in (1, 2, 5, 10, 1000):
        plan = small(shards=count)
        shards = [plan.shard(k) for k in range(plan.shards)]
        assert [row for shard in shards for row in shard] == plan.rows
        sizes = {len(shard) for shard in shards}
        assert min(sizes) >= 1 and max(sizes) - min(sizes) <= 1


def test_a_shard_that_is_not_there(small, one_line):
    with pytest.raises(ModelError) as error:
        small().shard(3)
    one_line(error, "no shard 3", "0 to 2")


def test_what_is_examined_is_among_the_ratios_once(small):
    # 100 is on the grid from 10 to 1000 but for rounding.
    plan = small(
        frequency_ratio={"min": 10.0, "max": 1000.0, "samples": 21}, examined=[100.0, 77.0]
    )
    assert {77.0, 100.0} <= set(plan.ratios)
    assert np.all(np.diff(np.log(plan.ratios)) > 1e-3)
    assert len(plan.ratios) == 22


def test_the_sizes_that_are_promised(pytestconfig):
    folder = pytestconfig.rootpath / "config"
    section = read_yaml(folder / "config.yaml")["atlas"]
    assert Plan(section).orbits >= 10**8
    for key, value in read_yaml(folder / "atlas-large.yaml")["atlas"].items():
        section[key] = section[key] | value if isinstance(value, dict) else value
    large = Plan(section)
    assert large.orbits >= 10**10
    # Ten minutes a shard, at the rate of docs/atlas.md.
    assert large.orbits / large.shards / 1.4e6 > 600

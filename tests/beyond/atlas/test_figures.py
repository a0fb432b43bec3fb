"""The accepted summary, the charts that are drawn from it, and the orbits that it names."""

from pathlib import Path

import numpy as np
import pytest

from bouncing_ball.beyond.atlas.figures import charts
from bouncing_ball.datasets.files import parameter_attributes, read_dataset
from bouncing_ball.drawing.style import style
from bouncing_ball.periodic.one_impact import restitution_branch as restitution_orbit
from bouncing_ball.pipeline.yaml_files import read_yaml

ROOT = Path(__file__).resolve().parents[3]
SUMMARY = ROOT / "config" / "atlas.nc"
CHARTS = ROOT / "docs" / "atlas"


@pytest.fixture(scope="module")
def data():
    return read_dataset(SUMMARY)


def test_the_summary_is_that_of_the_configuration(data):
    section = parameter_attributes(read_yaml(ROOT / "config" / "config.yaml")["atlas"])
    for name, value in section.items():
        assert np.array_equal(data.attrs[name], value), name
    assert int(data.orbits) >= 10**8


def test_a_supremum_is_reproduced_by_the_command_line_and_exceeded_by_no_node(data, ask):
    simple = data.sel(release="displacement", model="restitution", n=1)
    low = float(data.restitution_edge[0])
    rule = float(data.rule_of_thumb)
    # The corner in which the height's error is largest.
    fold = float(restitution_orbit.saddle_node(1, low)) * (1 + 1e-12)
    orbit = f"orbit --amplitude {fold!r}"
    contact = f"--measured-restitution {low} --frequency-ratio {rule:g}"
    exact, rigid = (ask(*f"{orbit} {x}".split()) for x in (contact, f"--restitution {low}"))
    error = abs(exact["max_height"] / rigid["max_height"] - 1)
    assert float(simple.supremum.sel(supremum_quantity="max_height")) == pytest.approx(error, 1e-5)
    for one in ("restitution", "corrected"):
        needed = data.needed.sel(model=one).max(("restitution", "position"))
        names = {"model": one, "supremum_quantity": needed["quantity"].values}
        # A node is known within one step of the grid.
        step = 1 + float(data.resolution)
        found = data.supremum_needed.sel(names)
        # Without a threshold the error is unbounded, or tolerated at every ϖ.
        found = found.where(found.notnull() | (data.supremum.sel(names) <= 0.01), np.inf)
        assert np.all(needed.values <= step * found.fillna(float(needed.min())).values)


def test_the_charts_are_drawn(data):
    # What is drawn is looked at by people; that the numbers are there is seen here.
    with style():
        drawn = dict(charts(data))
    assert set(drawn) == {path.stem for path in CHARTS.glob("*.png")}
    mesh = drawn["phase"].axes[3].collections[0]
    needed = data.needed.sel(release="force", model="corrected", n=1, quantity="phase")
    shown = np.ma.filled(mesh.get_array(), np.nan).reshape(needed.T.shape)
    assert np.array_equal(shown, needed.T.clip(3, 1e6), equal_nan=True)
    titles = [axes.get_title() for axes in drawn["page"].axes]
    assert len([title for title in titles if title]) == 7

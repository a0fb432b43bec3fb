"""The pictures of the docs are drawn from their datasets, and from all that they should show."""

from functools import partial
from importlib.metadata import version

import make_data
import pytest
from figure_checks import follows_its_data
from the_docs import DATA

from bouncing_ball_beyond.inherited.datasets.files import read_dataset
from bouncing_ball_beyond.inherited.drawing.files import save
from bouncing_ball_beyond.inherited.pipeline.diff.pictures import compare_pixels
from bouncing_ball_beyond.inherited.pipeline.provenance import read_attributes

pytestmark = pytest.mark.slow

DRAWN = [name for name, shown in make_data.SHOWN.items() if shown.draw is not None]


@pytest.mark.parametrize("name", DRAWN)
def test_a_figure_follows_its_data_and_names_its_axes(name):
    follows_its_data(partial(make_data.drawn, name), read_dataset(DATA / f"{name}.nc"))


# One of each, and the others weekly.
@pytest.mark.parametrize(
    "name",
    [pytest.param(x, marks=pytest.mark.long) if x != "bounces" else x for x in DRAWN],
)
def test_the_picture_of_a_dataset_is_that_of_the_page(name, tmp_path):
    shown = DATA / f"{name}.png"
    if read_attributes(shown)["matplotlib"] != version("matplotlib"):
        pytest.skip("the page is drawn by another matplotlib")
    path = tmp_path / shown.name
    save(make_data.drawn(name, read_dataset(DATA / f"{name}.nc")), path, {})
    rows = compare_pixels(shown, path, moved=False, redrawn=False)
    assert all(row.outcome.agrees for row in rows)

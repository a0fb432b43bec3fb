"""The pictures of the docs are drawn from their datasets, and from all that they should show."""

from importlib.metadata import version

import make_data
import numpy as np
import pytest
from the_docs import DATA

from bouncing_ball.datasets.files import read_dataset
from bouncing_ball.drawing.files import save
from bouncing_ball.pipeline.diff.pictures import compare_pixels
from bouncing_ball.pipeline.provenance import read_attributes

pytestmark = pytest.mark.slow

DRAWN = [name for name, shown in make_data.SHOWN.items() if shown.draw is not None]


def lines(figure):
    return [line for axes in figure.axes for line in axes.lines]


@pytest.mark.parametrize("name", DRAWN)
def test_a_figure_follows_its_data_and_names_its_axes(name):
    data = read_dataset(DATA / f"{name}.nc")
    moved = data.map(lambda values: values * 1.1 + 0.01 if values.dtype.kind == "f" else values)
    before = make_data.drawn(name, data)
    after = make_data.drawn(name, moved.assign_attrs(data.attrs))
    assert any(axes.get_xlabel() for axes in before.axes)
    assert any(axes.get_ylabel() or axes.get_yticklabels() for axes in before.axes)
    same = [
        np.array_equal(line.get_xydata(), other.get_xydata(), equal_nan=True)
        for line, other in zip(lines(before), lines(after), strict=True)
        if len(line.get_xydata()) > 2
    ]
    assert same and sum(same) <= len(before.axes) and not all(same)


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

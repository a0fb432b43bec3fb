"""The figures and tables of the studies are made from their datasets, and from all of them."""

import csv
import json
from functools import partial
from importlib.metadata import version
from pathlib import Path

import numpy as np
import pytest
from figure_checks import follows_its_data

from bouncing_ball_beyond.exhibits import (
    cascade_of_flights_figures,
    contact_laws_figures,
    corrected_model_figures,
    release_rules_figures,
    stiffness_map_figures,
)
from bouncing_ball_beyond.inherited.drawing.files import save
from bouncing_ball_beyond.inherited.drawing.style import style
from bouncing_ball_beyond.inherited.pipeline.diff.pictures import compare_pixels
from bouncing_ball_beyond.inherited.pipeline.provenance import read_attributes

pytestmark = pytest.mark.slow

FIGURES = Path(__file__).resolve().parents[2] / "figures"
DRAWN = {
    "ext_flights": cascade_of_flights_figures.cascade_of_flights,
    "ext_impact": release_rules_figures.free_impacts,
    "ext_instant": corrected_model_figures.meeting_flights,
    "ext_laws": contact_laws_figures.contact_laws,
    "ext_map": stiffness_map_figures.stiffness_map,
    "ext_orders": corrected_model_figures.orders,
}
TABLES = {
    "ext_laws": contact_laws_figures.ext_laws,
    "ext_orders": corrected_model_figures.ext_orders,
}


def drawn(name, data):
    with style():
        return DRAWN[name](data)


def test_every_picture_and_table_of_the_record_is_made_here():
    assert {path.stem for path in FIGURES.glob("*.png")} == DRAWN.keys()
    assert {path.stem for path in FIGURES.glob("*.csv")} == TABLES.keys()


@pytest.mark.parametrize("name", DRAWN)
def test_a_figure_follows_its_data_and_names_its_axes(recorded, name):
    follows_its_data(partial(drawn, name), recorded[name])


@pytest.mark.parametrize("name", DRAWN)
def test_the_picture_of_a_dataset_is_that_of_the_record(recorded, name, tmp_path):
    accepted = FIGURES / f"{name}.png"
    made = read_attributes(accepted)["provenance_versions"]
    if json.loads(made)["matplotlib"] != version("matplotlib"):
        pytest.skip("the record is drawn by another matplotlib")
    path = tmp_path / accepted.name
    save(drawn(name, recorded[name]), path, {})
    rows = compare_pixels(accepted, path, moved=False, redrawn=False)
    assert all(row.outcome.agrees for row in rows)


@pytest.mark.parametrize("name", TABLES)
def test_the_table_of_a_dataset_is_that_of_the_record(recorded, name):
    with (FIGURES / f"{name}.csv").open(encoding="utf-8", newline="") as file:
        header, *body = csv.reader(file)
    assert (header, body) == TABLES[name](recorded[name])


def test_errors_show_their_zeros(recorded):
    data = recorded["ext_orders"]
    shown = drawn("ext_orders", data)
    for axes, quantity in zip(shown.axes, data["quantity"].values, strict=True):
        for model, name in (("restitution", "error_zero"), ("corrected", "corrected_error_zero")):
            zero = float(data[name].sel(quantity=quantity))
            (line,) = [x for x in axes.lines if x.get_label() == model]
            ratio, error = line.get_data()
            assert (error.min() == 0) == np.isfinite(zero)
            assert not error.min() == 0 or ratio[error.argmin()] == pytest.approx(zero, rel=1e-12)
    data = recorded["ext_laws"]
    zeros = data.law_error_zero.values
    drawn_zeros = [
        1 / (2 * data.attrs["n"] * line.get_xdata()[line.get_ydata().argmin()])
        for axes in drawn("ext_laws", data).axes
        for line in axes.lines
        if len(line.get_ydata()) and min(line.get_ydata()) == 0
    ]
    assert sorted(drawn_zeros) == pytest.approx(sorted(zeros[np.isfinite(zeros)]), rel=1e-12)


def test_the_errors_of_the_laws_are_over_the_share_of_the_cycle(recorded):
    """(D + κ)/(2πn), where the dataset has π/(D + κ)."""
    data = recorded["ext_laws"]
    length = np.pi / data.centroid_ratio.values
    figure = drawn("ext_laws", data)
    line = figure.axes[0].lines[0]
    share = length / (2 * np.pi * data.attrs["n"])
    assert line.get_xdata() == pytest.approx(share, rel=1e-14)
    # The guides of the first and the second order span the same shares.
    for slope, guide in zip((1, 2), figure.axes[0].lines[-2:], strict=True):
        assert guide.get_xdata() == pytest.approx(share[[0, -1]], rel=1e-14)
        assert guide.get_ydata() == pytest.approx(share[[0, -1]] ** slope, rel=1e-14)

"""The figures are drawn from their datasets, and from all that they should show."""

import functools
from collections import Counter
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from bouncing_ball_beyond.inherited.paper.exhibits.printed_table1 import PERMANENT_CONTACT
from declared_artifacts import DRAWINGS
from figure_checks import follows_its_data, lines

import bouncing_ball_beyond.inherited
from bouncing_ball_beyond.inherited.drawing.canvas import lay_out
from bouncing_ball_beyond.inherited.drawing.files import save
from bouncing_ball_beyond.inherited.drawing.style import COLOURS, DASHES, LINES, style
from bouncing_ball_beyond.inherited.pipeline.provenance import read_attributes

pytestmark = pytest.mark.slow

ROOT = Path(__file__).resolve().parents[2]
SCHEMATICS = ("fig01", "fig04")
# A new one is drawn here as soon as its dataset is accepted.
WITH_DATA = [name for name in DRAWINGS if (ROOT / f"figures/{name}.nc").exists()]


def drawn(name, *data):
    with style():
        return DRAWINGS[name](*data)


@pytest.fixture(scope="module")
def accepted_figure():
    """The figure of an accepted dataset, as a user draws it from its file, and drawn once: tests
    look at it and change nothing.
    """

    @functools.cache
    def figure(name):
        return bouncing_ball_beyond.inherited.open(ROOT / f"figures/{name}.nc").plot()

    return figure


@pytest.mark.parametrize("name", WITH_DATA)
def test_a_figure_follows_its_data_and_names_its_axes(record, name):
    follows_its_data(functools.partial(drawn, name), record[name])


@pytest.mark.parametrize("name", SCHEMATICS)
def test_schematics_are_drawn(name):
    (axes,) = drawn(name).axes
    words = {text.get_text() for text in axes.texts}
    assert {"$m$", "$g$", r"$M=\infty$"} <= words
    assert ({"$k$", "$c$"} <= words) == (name == "fig04")


def test_figure_7_marks_the_instants_and_velocities(record, accepted_figure):
    data = record["fig07"]
    (axes,) = accepted_figure("fig07").axes
    words = " ".join(text.get_text() for text in axes.texts)
    for symbol in (r"\tau_i", r"\tau_b", r"\tau_2", "z′_i", "z′_b", "z′_2"):
        assert symbol in words
    # The arrows are tangents: into the impacts, and out of the release.
    arrows = [text for text in axes.texts if not text.get_text()]
    assert len(arrows) == 3
    for arrow, velocity in zip(
        arrows, (data.impact_velocity, data.bounce_velocity, data.impact_velocity), strict=True
    ):
        x0, y0 = arrow.xyann
        x1, y1 = arrow.xy
        slope = (y1 - y0) / (2 * np.pi * (x1 - x0))
        assert x1 > x0 and slope == pytest.approx(float(velocity))


def test_stability_is_drawn_solid_dashed_and_dotted(record, accepted_figure):
    data = record["fig03"]
    runs = [line for line in lines(accepted_figure("fig03")) if len(line.get_xdata()) > 1]
    widths = {kind: look["linewidth"] for kind, look in LINES.items()}
    solid = [line for line in runs if line.get_linewidth() == widths["stable"]]
    # Each solid run begins at its saddle-node and ends at its period doubling.
    assert sum(len(line.get_xdata()) for line in solid) == int(data.stable.sum()) + 2 * len(solid)
    assert {line.get_linewidth() for line in runs} == {widths["stable"], widths["unstable"]}
    hidden = drawn("fig03", data.assign(admissible=data.admissible & False))
    dotted = {line.get_linewidth() for line in lines(hidden) if len(line.get_xdata()) > 1}
    assert dotted == {widths["inadmissible"]} and len(set(widths.values())) == 3


@pytest.mark.parametrize("name", ["fig03", "fig08", "fig09", "fig15"])
def test_a_line_changes_its_look_at_a_special_point_and_nowhere_else(record, name, accepted_figure):
    data = record[name]
    found = lines(accepted_figure(name))
    marks = [line.get_xydata() for line in found if line.get_marker() in ("o", "s", "^", "v", ".")]
    marks = {tuple(point) for line in marks for point in line if np.all(np.isfinite(point))}
    runs = [line for line in found if line.get_marker() == "None" and len(line.get_xdata()) > 1]
    assert len(runs) > 4
    ends = [tuple(line.get_xydata()[k]) for line in runs for k in (0, -1)]
    top = data.attrs["amplitude_max"]
    # The others are the ends of the branches, at the largest Λ; of a branch that ends inside, at
    # permanent contact, there is one in each of the two panels.
    others = {end for end in ends if end not in marks and end[0] != pytest.approx(top, abs=1e-12)}
    reasons = data.get("end_reason", xr.DataArray(["none"], dims="end"))
    assert len(others) == 2 * reasons.str.contains("permanent contact").sum().item()
    assert {end[0] for end in others} <= {*data.amplitude.values.ravel()}
    # At each mark a solid line meets a dashed one.
    met = Counter(end for end in ends if end in marks)
    assert set(met) == marks and 1 not in met.values()


def test_markers_stand_at_the_bifurcations(record, accepted_figure):
    data = record["fig08"].sel(frequency_ratio=10.0)
    found = lines(accepted_figure("fig08"))
    for kind, marker in (("saddle-node", "o"), ("period doubling", "s")):
        shown = np.concatenate([x.get_xdata() for x in found if x.get_marker() == marker])
        at = data.special_amplitude.values[data.special_kind.values == kind]
        assert at.size and np.all(np.isin(at, shown))


KINDS = ["stable", "unstable", "saddle-node", "period doubling"]
NAMED = {
    "fig03": [f"$n={n}$" for n in range(1, 6)],
    "fig08": [rf"$\varpi={ratio}$" for ratio in ("10^{4}", "10", "2")],
    "fig15": ["restitution", "spring-damper"],
}


@pytest.mark.parametrize(("name", "marks"), [("fig03", 1), ("fig08", 0), ("fig15", 0)])
def test_every_curve_is_named_at_its_end_and_every_kind_once(name, marks, accepted_figure):
    """The dashes are those of the stability, so that in grey only names tell curves apart."""
    figure = accepted_figure(name)
    (legend,) = figure.legends
    names = [text.get_text() for text in legend.get_texts() if text.get_text()]
    assert sorted(names) == sorted(KINDS + ["period doubling, Eq. 8"] * marks)
    for axes in figure.axes:
        assert {text.get_text() for text in axes.texts} == {*NAMED[name]}
        for text in axes.texts:
            (_, height) = text.xy
            curve = [x for x in axes.lines if x.get_color() == text.get_color()]
            ends = [x.get_xydata()[[0, -1]] for x in curve if len(x.get_xdata()) > 1]
            last = max(map(tuple, np.concatenate(ends)))
            assert height == pytest.approx(last[1], abs=1e-9)


@pytest.mark.parametrize("name", ["fig08", "fig09"])
def test_figures_8_and_9_have_every_orbit_of_their_dataset_in_both_panels(
    record, name, accepted_figure
):
    data = record[name]
    start, end = accepted_figure(name).axes
    assert start.get_title() == r"start of contact, $\varphi$"
    assert end.get_title() == r"end of contact, $\varphi+\tau_b$"
    for axes, phase in ((start, data.phase), (end, data.release_phase)):
        for kind, orbits in (("stable", data.stable), ("unstable", ~data.stable)):
            shown = [line for line in axes.lines if line.get_label() == kind]
            points = {tuple(point) for line in shown for point in line.get_xydata()}
            there = (orbits & data.admissible).values
            of_data = zip(data.amplitude.values[there], phase.values[there] / np.pi, strict=True)
            assert set(of_data) <= points
    # The branch of the most compliant contact has stable orbits beyond its second saddle-node.
    soft = data.isel(frequency_ratio=-1)
    longest = soft.contact_duration.where(soft.stable).max()
    if name == "fig08":
        assert (
            longest > soft.special_contact_duration.where(soft.special_kind == "saddle-node").max()
        )


def test_figure_3_marks_equation_8_beside_the_exact_map(record, accepted_figure):
    data = record["fig03"]
    found = lines(accepted_figure("fig03"))
    for marker, kind in (("s", "exact"), ("x", "holmes")):
        shown = sorted(
            float(line.get_xdata().item()) for line in found if line.get_marker() == marker
        )
        assert shown == data.period_doubling_amplitude.sel(impact_map=kind).values.tolist()


def test_figure_16_marks_the_printed_ratio_of_its_own_parameters_only(record, accepted_figure):
    data = record["fig16"]
    (mark,) = [line for line in lines(accepted_figure("fig16")) if line.get_marker() == "D"]
    assert mark.get_xydata().tolist() == [[PERMANENT_CONTACT, data.attrs["tolerance"]]]
    for change in ({"restitution": 0.2}, {"tolerance": 0.02}, {"release": "force"}):
        others = lines(drawn("fig16", data.assign_attrs(change)))
        assert not [line for line in others if line.get_marker() == "D"]


def test_figure_16_shows_where_its_error_is_zero(record, accepted_figure):
    data = record["fig16"]
    below = accepted_figure("fig16").axes[1]
    ratio, error = max(below.lines, key=lambda line: len(line.get_xdata())).get_data()
    # Eq. 33 equals one at 1/√(2 - 4ζ²); the zero lies between two samples of the grid.
    exact = 1 / np.sqrt(2 - 4 * float(data.damping_ratio) ** 2)
    step = np.log(data.frequency_ratio.values[1] / data.frequency_ratio.values[0])
    assert abs(np.log(ratio[np.argmin(error)] / exact)) < step**2
    assert error.min() < 1e-9 < below.get_ylim()[0]


@pytest.mark.parametrize("name", ["fig02", "fig07", "fig12"])
def test_time_is_in_periods_of_the_table(name, accepted_figure):
    drawn_axes = accepted_figure(name).axes
    assert {axes.get_xlabel() for axes in drawn_axes} == {r"time $\tau/2\pi$"}
    first = drawn_axes[0].get_lines()
    longest = max(float(np.max(line.get_xdata())) for line in first)
    assert 1 <= longest <= 3, longest


def test_figure_13_marks_round_frequency_ratios(accepted_figure):
    (axes,) = accepted_figure("fig13").axes
    words = {text.get_text() for text in axes.texts}
    small = {rf"$\varpi={ratio}$" for ratio in (1, 2, 5, 10)}
    assert words == small | {r"$\varpi\geq100$"} and len(axes.texts) == 2 * len(words)


def test_figure_12_names_the_curves_of_its_enlargement(accepted_figure):
    (_, summit) = accepted_figure("fig12").axes
    bottom, _ = summit.get_ylim()
    inside = [x.get_label() for x in summit.lines if x.get_ydata().max() > bottom]
    assert summit.get_title() == f"the summit: {', '.join(inside)}"


@pytest.mark.parametrize("name", ["fig05", "fig06", "fig10", "fig12"])
def test_of_the_curves_that_are_compared_one_is_not_dashed(name, accepted_figure):
    axes = accepted_figure(name).axes[0]
    compared = [x for x in axes.lines if "=" in str(x.get_label())]
    assert 2 < len(compared) <= len({*map(str, DASHES)})
    assert [x.is_dashed() for x in compared] == [False] + [True] * (len(compared) - 1)


def test_the_cross_of_equation_8_is_inside_its_square(record):
    figure = drawn("fig03", record["fig03"])
    with style():
        figure.draw_without_rendering()
        lay_out(figure, figure.get_layout_engine())
    (axes,) = figure.axes
    pixels = figure.dpi / 72
    found = {mark: [x for x in axes.lines if x.get_marker() == mark] for mark in "sx"}
    for square, cross in zip(found["s"], found["x"], strict=True):
        (middle,), (other,) = (axes.transData.transform(x.get_xydata()) for x in (square, cross))
        room = square.get_markersize() - square.get_markeredgewidth()
        needed = cross.get_markersize() + cross.get_markeredgewidth()
        assert np.abs(other - middle).max() <= (room - needed) / 2 * pixels


@pytest.mark.parametrize("name", ["fig14", "fig16"])
def test_the_crossing_of_the_tolerance_lies_on_the_error(record, name, accepted_figure):
    data = record[name]
    below = accepted_figure(name).axes[1]
    assert below.get_yscale() == "log"
    curve = max(below.lines, key=lambda line: len(line.get_xdata()))
    # Without the zeros, which a logarithmic axis does not have.
    ratio, error = curve.get_xydata()[curve.get_ydata() > 0].T
    at = np.interp(np.log(data.error_threshold.item()), np.log(ratio), np.log(error))
    assert np.exp(at) == pytest.approx(data.attrs["tolerance"], rel=1e-3)


def test_colours_are_legible_on_white_and_apart_in_grey():
    channels = np.array([[int(c[k : k + 2], 16) for k in (1, 3, 5)] for c in COLOURS]) / 255
    linear = np.where(channels <= 0.04045, channels / 12.92, ((channels + 0.055) / 1.055) ** 2.4)
    # WCAG 2.1: relative luminance, and a contrast of 3:1 for graphical objects.
    assert np.all(1.05 / (linear @ [0.2126, 0.7152, 0.0722] + 0.05) >= 3)
    grey = 255 * channels @ [0.299, 0.587, 0.114]
    assert np.abs(np.diff(grey)).min() > 40


def test_files_are_the_same_every_time(record, tmp_path):
    contents = []
    for run in ("first", "second"):
        figure = drawn("fig11", record["fig11"])
        for path in (tmp_path / run / f"fig11.{kind}" for kind in ("png", "svg")):
            with style():
                save(figure, path, {"provenance_commit": 'of <"ϖ">'})
            contents.append(path.read_bytes())
            assert read_attributes(path)["provenance_commit"] == 'of <"ϖ">'
    assert contents[:2] == contents[2:] and min(map(len, contents)) > 5000

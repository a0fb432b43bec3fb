"""The figures are drawn from their datasets, and from all that they should show."""

import operator
from collections import Counter
from pathlib import Path

import numpy as np
import pytest
from adapter import function
from declared_artifacts import ARTIFACTS

from bouncing_ball.drawing.files import save
from bouncing_ball.drawing.style import COLOURS, LINES, style
from bouncing_ball.paper.exhibits.continuation_of_orbits_figures import up_to_second_saddle_node
from bouncing_ball.pipeline.provenance import read_attributes

pytestmark = pytest.mark.slow

ROOT = Path(__file__).resolve().parents[2]
SCHEMATICS = ("fig01", "fig04")
# A new one is drawn here as soon as its dataset is accepted.
WITH_DATA = [
    name
    for name, each in ARTIFACTS.items()
    if each.drawing and (ROOT / f"{each.place}.nc").exists()
]


def drawn(name, *data):
    draw = function(ARTIFACTS[name].figures, ARTIFACTS[name].drawing)
    with style():
        return draw(*data)


def lines(figure):
    return [line for axes in figure.axes for line in axes.lines]


@pytest.mark.parametrize("name", WITH_DATA)
def test_a_figure_follows_its_data_and_names_its_axes(record, name):
    data = record[name]
    moved = data.map(lambda values: values * 1.5 + 0.1 if values.dtype.kind == "f" else values)
    before = drawn(name, data)
    after = drawn(name, moved)
    assert any(axes.get_xlabel() for axes in before.axes)
    assert any(axes.get_ylabel() or axes.get_yticklabels() for axes in before.axes)
    pairs = zip(lines(before), lines(after), strict=True)
    same = {
        line: np.array_equal(line.get_xydata(), other.get_xydata(), equal_nan=True)
        for line, other in pairs
        if len(line.get_xydata()) > 2
    }
    # One in a panel may follow from the parameters alone: the table of Figure 12, or the
    # arrows at the end of a range. Basins are areas, with numbers in their titles.
    titles = ([axes.get_title() for axes in figure.axes] for figure in (before, after))
    # Strokes fill the area of a kind of motion.
    assert sum(x for line, x in same.items() if line.get_linestyle() != "None") <= len(before.axes)
    assert not all(same.values()) if same else operator.ne(*titles)


@pytest.mark.parametrize("name", SCHEMATICS)
def test_schematics_are_drawn(name):
    (axes,) = drawn(name).axes
    words = {text.get_text() for text in axes.texts}
    assert {"$m$", "$g$", r"$M=\infty$"} <= words
    assert ({"$k$", "$c$"} <= words) == (name == "fig04")


def test_figure_7_marks_the_instants_and_velocities(record):
    data = record["fig07"]
    (axes,) = drawn("fig07", data).axes
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
        assert x1 > x0 and (y1 - y0) / (x1 - x0) == pytest.approx(float(velocity))


def test_stability_is_drawn_solid_dashed_and_dotted(record):
    data = record["fig03"]
    runs = [line for line in lines(drawn("fig03", data)) if len(line.get_xdata()) > 1]
    widths = {kind: look["linewidth"] for kind, look in LINES.items()}
    solid = [line for line in runs if line.get_linewidth() == widths["stable"]]
    # Each solid run begins at its saddle-node and ends at its period doubling.
    assert sum(len(line.get_xdata()) for line in solid) == int(data.stable.sum()) + 2 * len(solid)
    assert {line.get_linewidth() for line in runs} == {widths["stable"], widths["unstable"]}
    hidden = drawn("fig03", data.assign(admissible=data.admissible & False))
    dotted = {line.get_linewidth() for line in lines(hidden) if len(line.get_xdata()) > 1}
    assert dotted == {widths["inadmissible"]} and len(set(widths.values())) == 3


@pytest.mark.parametrize("name", ["fig03", "fig08", "fig09", "fig15"])
def test_a_line_changes_its_look_at_a_special_point_and_nowhere_else(record, name):
    data = record[name]
    found = lines(drawn(name, data))
    marks = [line.get_xydata() for line in found if line.get_marker() in ("o", "s", "^")]
    marks = {tuple(point) for line in marks for point in line if np.all(np.isfinite(point))}
    runs = [line for line in found if line.get_marker() == "None" and len(line.get_xdata()) > 1]
    assert len(runs) > 4
    ends = [tuple(line.get_xydata()[k]) for line in runs for k in (0, -1)]
    top = data.attrs["amplitude_max"]
    # The others are the ends of the branches, at the largest Λ.
    assert all(end in marks or end[0] == pytest.approx(top, abs=1e-12) for end in ends)
    # At each mark a solid line meets a dashed one, but for a branch drawn up to a saddle-node.
    met = Counter(end for end in ends if end in marks)
    turned = 2 if name == "fig08" else 0
    assert set(met) == marks and sorted(met.values()).count(1) == turned


def test_markers_stand_at_the_bifurcations(record):
    data = record["fig08"].sel(frequency_ratio=10.0)
    found = lines(drawn("fig08", record["fig08"]))
    for kind, marker in (("saddle-node", "o"), ("period doubling", "s")):
        shown = np.concatenate([x.get_xdata() for x in found if x.get_marker() == marker])
        at = data.special_amplitude.values[data.special_kind.values == kind]
        assert at.size and np.all(np.isin(at, shown))


@pytest.mark.parametrize(("name", "curves"), [("fig03", 0), ("fig08", 3), ("fig15", 3)])
def test_every_curve_and_mark_is_named_once(record, name, curves):
    figure = drawn(name, record[name])
    (legend,) = figure.legends
    names = [text.get_text() for text in legend.get_texts()]
    if name == "fig03":
        assert [text.get_text() for text in figure.axes[0].texts] == [
            f"$n={n}$" for n in range(1, 6)
        ]
    kinds = {"stable", "unstable", "saddle-node", "period doubling"}
    assert kinds <= set(names) and len(names) == len(set(names)) == curves + len(kinds)


def test_figure_8_is_drawn_up_to_where_its_softest_branch_turns_back(record):
    data = record["fig08"]
    soft = data.sel(frequency_ratio=2.0)
    turns = soft.special_amplitude.values[soft.special_kind.values == "saddle-node"]
    assert len(turns) == 2
    part = up_to_second_saddle_node(soft)
    assert part.sizes["point"] < soft.sizes["point"]
    assert float(part.contact_duration.max()) < float(soft.contact_duration.max())
    # Its points end a step before the turn, and the line at the turn.
    assert float(part.amplitude[0]) == pytest.approx(turns.max(), abs=1e-3)
    drawn_lines = [line for line in lines(drawn("fig08", data)) if line.get_marker() == "None"]
    assert any(line.get_xdata()[0] == turns.max() for line in drawn_lines if len(line.get_xdata()))
    shown = np.concatenate([line.get_ydata() for line in drawn_lines])
    assert np.nanmin(shown) >= float(part.phase.min()) / np.pi - 1e-3
    stiff = data.sel(frequency_ratio=10.0)
    assert up_to_second_saddle_node(stiff) is stiff


def test_figure_13_marks_round_frequency_ratios(record):
    (axes,) = drawn("fig13", record["fig13"]).axes
    words = {text.get_text() for text in axes.texts}
    assert words == {rf"$\varpi={ratio}$" for ratio in (1, 2, 5, 10)}


@pytest.mark.parametrize("name", ["fig14", "fig16"])
def test_the_crossing_of_the_tolerance_lies_on_the_error(record, name):
    data = record[name]
    below = drawn(name, data).axes[1]
    assert below.get_yscale() == "log"
    curve = max(below.lines, key=lambda line: len(line.get_xdata()))
    at = np.interp(np.log(data.error_threshold.item()), *np.log(curve.get_data()))
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


def test_basins_are_drawn_where_they_are(record):
    data = record["ext_basins"]
    panels = np.reshape(drawn("ext_basins", data).axes, (data.sizes["case"], data.sizes["model"]))
    for k, axes in np.ndenumerate(panels):
        (image,) = axes.images
        assert np.array_equal(image.get_array(), data.destination.values[k])
        assert (image.origin, image.get_extent()) == ("lower", [-1.0, 1.0, 0.0, 8.0])
        colours = image.cmap(image.norm(np.arange(data.sizes["motion"])))
        assert len(np.unique(colours, axis=0)) == data.sizes["motion"]

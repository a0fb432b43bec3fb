"""The figures are drawn from their datasets, and from all that they should show."""

from importlib import import_module

import numpy as np
import pytest

from bouncing_ball.configuration.stages import STAGES, Kind, names
from bouncing_ball.figures.domains import up_to_second_saddle_node
from bouncing_ball.figures.style import (
    COLOURS,
    INADMISSIBLE,
    STABLE,
    UNSTABLE,
    number,
    save,
    style,
)
from bouncing_ball.provenance.origin import read_attributes

pytestmark = pytest.mark.slow

FIGURES = [STAGES[name] for name in names(Kind.FIGURE, Kind.EXTENSION)]
WITH_DATA = [stage.name for stage in FIGURES if stage.study]


def drawn(name, *data):
    with style():
        return import_module(f"bouncing_ball.figures.{name}").draw(*data)


def lines(figure):
    return [line for axes in figure.axes for line in axes.lines]


# The map of the basins has a test of its own, below.
@pytest.mark.parametrize("name", [name for name in WITH_DATA if name != "ext_basins"])
def test_a_figure_follows_its_data(record, name):
    data = record[name]
    moved = data.map(lambda values: values * 1.5 + 0.1 if values.dtype.kind == "f" else values)
    before, after = drawn(name, data), drawn(name, moved)
    curves = 0
    for axes, others in zip(before.axes, after.axes, strict=True):
        pairs = [
            (line.get_xydata(), other.get_xydata())
            for line, other in zip(axes.lines, others.lines, strict=True)
            if len(line.get_xydata()) > 2  # no limit, no mark
        ]
        same = [a.shape == b.shape and np.array_equal(a, b, equal_nan=True) for a, b in pairs]
        # One may follow from the parameters alone: the table of Figure 12, or the
        # arrows at the end of a range.
        assert sum(same) <= 1
        curves += len(pairs) - sum(same)
    assert curves


@pytest.mark.parametrize("name", WITH_DATA)
def test_axes_have_labels(record, name):
    figure = drawn(name, record[name])
    assert any(axes.get_xlabel() for axes in figure.axes)
    assert any(axes.get_ylabel() or axes.get_yticklabels() for axes in figure.axes)


@pytest.mark.parametrize("name", ["fig01", "fig04"])
def test_schematics_are_drawn(name):
    (axes,) = drawn(name).axes
    words = {text.get_text() for text in axes.texts}
    assert {"$m$", "$g$", r"$M=\infty$"} <= words
    if name == "fig04":
        assert {"$k$", "$c$"} <= words


def test_figure_7_marks_the_instants_and_velocities(record):
    (axes,) = drawn("fig07", record["fig07"]).axes
    words = " ".join(text.get_text() for text in axes.texts)
    for symbol in (r"\tau_i", r"\tau_b", r"\tau_2", "z′_i", "z′_b", "z′_2"):
        assert symbol in words


def test_stability_is_drawn_solid_dashed_and_dotted(record):
    data = record["fig03"]
    looks = {line.get_linestyle() for line in lines(drawn("fig03", data))}
    assert {"-", "--"} <= looks or len(looks) > 1
    # Length in each look, in points of the dataset: stable orbits are solid.
    stable = int(data.stable.sum())
    solid = [
        line
        for line in lines(drawn("fig03", data))
        if line.get_linestyle() == STABLE["linestyle"] and len(line.get_xdata()) > 1
    ]
    # Each solid run shares one more point with its dashed neighbour.
    assert sum(len(line.get_xdata()) for line in solid) == stable + len(solid)
    hidden = data.assign(admissible=data.admissible & False)
    dotted = [line for line in lines(drawn("fig03", hidden)) if len(line.get_xdata()) > 1]
    widths = {line.get_linewidth() for line in dotted}
    assert widths == {INADMISSIBLE["linewidth"]} != {UNSTABLE["linewidth"]}


def test_markers_stand_at_the_bifurcations(record):
    data = record["fig08"].sel(frequency_ratio=10.0)
    marks = [line for line in lines(drawn("fig08", record["fig08"])) if line.get_marker() == "s"]
    shown = np.concatenate([line.get_xdata() for line in marks])
    at = data.special_amplitude.values[data.special_kind.values == "period doubling"]
    assert np.all(np.isin(at, shown))


@pytest.mark.parametrize("name", ["fig08", "fig09", "fig15"])
def test_every_curve_is_named_at_its_end(record, name):
    data = record[name]
    (axes,) = drawn(name, data).axes
    ends = {tuple(text.xy) for text in axes.texts}
    drawn_ends = {
        (float(curve.amplitude[-1]), float(curve[phase][-1]) / np.pi)
        for _, curve in data.groupby("frequency_ratio")
        for curve in [curve.squeeze("frequency_ratio")]
        for phase in ("phase", "release_phase")
    }
    assert drawn_ends <= ends
    places = np.sort([text.get_position()[1] for text in axes.texts])
    # Eight points of a text; the panel is at least 2.5 inches high.
    assert np.diff(places).min() >= 8 / (72 * 2.5) * 0.4 * np.ptp(axes.get_ylim())


def test_figure_8_is_drawn_up_to_where_its_softest_branch_turns_back(record):
    data = record["fig08"]
    soft = data.sel(frequency_ratio=2.0)
    turns = soft.special_amplitude.values[soft.special_kind.values == "saddle-node"]
    assert len(turns) == 2
    part = up_to_second_saddle_node(soft)
    assert part.sizes["point"] < soft.sizes["point"]
    assert float(part.contact_duration.max()) < float(soft.contact_duration.max())
    # Up to the turn, but for one step along the branch.
    assert float(part.amplitude[0]) == pytest.approx(turns.max(), abs=1e-3)
    shown = np.concatenate([line.get_ydata() for line in lines(drawn("fig08", data))])
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


@pytest.mark.parametrize("kind", ["png", "svg"])
def test_files_are_the_same_every_time(record, tmp_path, kind):
    contents = []
    for run in ("first", "second"):
        path = tmp_path / run / f"fig11.{kind}"
        with style():
            figure = import_module("bouncing_ball.figures.fig11").draw(record["fig11"])
            save(figure, path, {"provenance_commit": 'of <"ϖ">'})
        contents.append(path.read_bytes())
        assert read_attributes(path)["provenance_commit"] == 'of <"ϖ">'
        assert [p.name for p in path.parent.iterdir()] == [path.name]
    assert contents[0] == contents[1] and len(contents[0]) > 5000


def test_numbers_in_labels():
    assert [number(x) for x in (1.0, 0.1, 1e4, 2.5e5)] == [
        "1",
        "0.1",
        "10^{4}",
        r"2.5\times 10^{5}",
    ]


def test_basins_are_drawn_where_they_are(record):
    data = record["ext_basins"]
    for case, axes in enumerate(drawn("ext_basins", data).axes):
        (image,) = axes.images
        assert np.array_equal(image.get_array(), data.destination.values[case])
        assert (image.origin, image.get_extent()) == ("lower", [-1.0, 1.0, 0.0, 8.0])
        colours = image.cmap(image.norm(np.arange(data.sizes["motion"])))
        assert len(np.unique(colours, axis=0)) == data.sizes["motion"]


def test_windows_are_drawn_from_the_threshold_to_their_ends(record):
    data = record["ext_rattling"]
    left, right = drawn("ext_rattling", data).axes
    first = data.isel(restitution=0)
    marked = {
        line.get_label(): line.get_xydata()
        for line in left.lines
        if not line.get_label().startswith("_")
    }
    for kind in ("saddle-node", "period doubling", "grazing in contact"):
        for ratio, amplitude in marked[kind]:
            place = first.sel(frequency_ratio=ratio)
            assert (place.window_end, place.window_amplitude) == (kind, amplitude)
    assert marked[r"$\Lambda_{SD}$"][:, 1].tolist() == first.threshold_amplitude.values.tolist()
    limits = {float(line.get_ydata()[0]) for line in right.lines if line.get_marker() == 5}
    assert limits == set(data.stiff_window.values.tolist())

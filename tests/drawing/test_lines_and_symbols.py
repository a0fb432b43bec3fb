"""What a line of a figure stands for, and the symbols of its parameters."""

import numpy as np
import pytest
import xarray as xr
from bouncing_ball.beyond.exhibits.contact_laws_figures import contact_laws
from bouncing_ball.beyond.exhibits.motion_maps import (
    DOTS,
    OTHER_COLOURS,
    UNKNOWN_PERIOD,
    mark_nodes,
    node_map,
)
from matplotlib.figure import Figure

import bouncing_ball as bb
from bouncing_ball.datasets.variables import SHARED
from bouncing_ball.drawing.canvas import draw_curve
from bouncing_ball.drawing.labels import _SYMBOLS, in_a_row
from bouncing_ball.drawing.style import LINES, style

IN_LATEX = {"Λ": r"\Lambda", "ϖ": r"\varpi", "ζ": r"\zeta", "φ": r"\varphi", "z′ᵢ": "z′_i"}


@pytest.mark.parametrize("name", sorted(_SYMBOLS.keys() & SHARED.keys()))
def test_a_parameter_has_the_symbol_of_its_variable(name):
    symbol = SHARED[name].symbol
    assert _SYMBOLS[name] == IN_LATEX.get(symbol, symbol)


def test_the_damping_ratio_of_a_ball_is_in_the_title_of_its_figure():
    ball = bb.spring_damper(damping_ratio=0.1, frequency_ratio=10.0)
    figure = bb.history(ball, amplitude=1.0, periods=1).plot()
    texts = [axes.get_title() for axes in figure.axes] + [text.get_text() for text in figure.texts]
    assert any(r"\zeta" in text for text in texts), texts


@pytest.mark.parametrize("special", [0, 2])
def test_cases_are_in_a_row_also_if_there_are_no_special_points(special):
    size = {"n": 2, "amplitude": 3, "special": special}
    values = np.arange(6.0 * special).reshape(tuple(size.values()))
    data = xr.Dataset({"phase": (tuple(size), values)}, {"n": [1, 2], "amplitude": [0.5, 0.6, 0.7]})
    rows, names = in_a_row(data, "special")
    assert np.array_equal(rows.phase.values, values.reshape(6, special))
    assert rows.phase.dims == ("case", "special") and len(names) == 6


def test_the_inadmissible_part_of_a_curve_is_dotted_and_the_other_part_is_not():
    x = np.arange(5.0)
    y = x**2
    admissible = np.array([True, True, False, False, True])
    axes = Figure().add_subplot()
    draw_curve(axes, x, y, admissible, color="#123456", **LINES["stable"])
    whole, dotted = axes.lines
    assert np.array_equal(np.isfinite(whole.get_ydata()), admissible)
    assert np.array_equal(np.isfinite(dotted.get_ydata()), ~admissible)
    assert np.nanmax(np.abs(dotted.get_ydata() - y)) == 0
    axes.plot(x, y, **LINES["inadmissible"])
    expected = axes.lines[-1]
    assert dotted.get_linestyle() == expected.get_linestyle() != whole.get_linestyle()
    assert dotted._unscaled_dash_pattern == expected._unscaled_dash_pattern


def test_the_errors_of_the_laws_are_over_the_share_of_the_cycle(recorded):
    """(D + κ)/(2πn), where the dataset has π/(D + κ)."""
    data = recorded["ext_laws"]
    length = np.pi / data.centroid_ratio.values
    with style():
        figure = contact_laws(data)
    line = figure.axes[0].lines[0]
    share = length / (2 * np.pi * data.attrs["n"])
    assert line.get_xdata() == pytest.approx(share, rel=1e-14)
    # The guides of the first and the second order span the same shares.
    for slope, guide in zip((1, 2), figure.axes[0].lines[-2:], strict=True):
        assert guide.get_xdata() == pytest.approx(share[[0, -1]], rel=1e-14)
        assert guide.get_ydata() == pytest.approx(share[[0, -1]] ** slope, rel=1e-14)


def test_the_nodes_of_a_kind_are_marked_and_no_others():
    kinds = np.array([["orbit", "chaotic"], ["locked", "chaotic"], ["orbit", "orbit"]])
    axis = {"restitution": [0.2, 0.5, 0.8], "amplitude": [1.0, 2.0]}
    one = xr.Dataset({"kind": (("restitution", "amplitude"), kinds)}, axis)
    axes = Figure().add_subplot()
    mark_nodes(axes, one, one.kind == "chaotic", {"marker": "."})
    (marks,) = axes.lines
    found = {tuple(map(float, point)) for point in marks.get_xydata()}
    expected = {(0.2, 2.0), (0.5, 2.0)}
    assert found in (expected, {(lam, r) for r, lam in expected})


def test_a_map_of_motions_marks_each_kind_at_its_own_nodes():
    kinds = np.array(
        [["orbit", "undecided"], ["permanent contact", "undecided"], ["orbit", "orbit"]]
    )
    axis = {"restitution": [0.2, 0.5, 0.8], "amplitude": [1.0, 2.0]}
    one = xr.Dataset(
        {
            "kind": (("restitution", "amplitude"), kinds),
            "saddle_node_amplitude": ("restitution", [1.1, 1.2, 1.3]),
            "period_doubling_amplitude": ("restitution", [1.7, 1.8, 1.9]),
        },
        axis,
    )
    axes = Figure().add_subplot()
    values = np.arange(6.0).reshape(3, 2)
    shown = node_map(axes, one, values, ["undecided", "permanent contact"], vmin=0, vmax=5)
    assert np.array_equal(shown.get_array(), values)
    *marks, fold, doubling = axes.lines
    places = [{tuple(map(float, point)) for point in line.get_xydata()} for line in marks]
    assert places == [{(2.0, 0.2), (2.0, 0.5)}, {(1.0, 0.5)}]
    for line, amplitudes in ((fold, [1.1, 1.2, 1.3]), (doubling, [1.7, 1.8, 1.9])):
        assert line.get_xydata().tolist() == list(
            map(list, zip(amplitudes, axis["restitution"], strict=True))
        )
    assert fold.get_linestyle() != doubling.get_linestyle()


def test_the_kinds_with_marks_are_kinds_of_the_maps():
    assert set(DOTS) <= OTHER_COLOURS.keys() | {UNKNOWN_PERIOD}

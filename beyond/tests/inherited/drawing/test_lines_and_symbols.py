"""What a line of a figure stands for, and the symbols of its parameters."""

import numpy as np
import pytest
import scipy
import xarray as xr
from matplotlib.figure import Figure

import bouncing_ball_beyond.inherited as bb
from bouncing_ball_beyond.inherited.datasets.variables import SHARED
from bouncing_ball_beyond.inherited.drawing.canvas import draw_curve
from bouncing_ball_beyond.inherited.drawing.labels import _SYMBOLS, _ascending, in_a_row
from bouncing_ball_beyond.inherited.drawing.style import LINES

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


def test_names_are_moved_to_the_nearest_places_that_ascend():
    random = np.random.default_rng(66)
    for count in (1, 2, 5, 9):
        values = random.normal(size=count)
        exact = scipy.optimize.isotonic_regression(values).x
        assert _ascending(values) == pytest.approx(exact, abs=1e-14)

"""Calls that return labelled datasets: balls over time, drops, branches."""

import numpy as np
import pytest
import xarray as xr
from scipy.optimize import brentq

import bouncing_ball as bb
from bouncing_ball.datasets.labelled import Labelled

CONTACT = {"restitution": 0.85, "frequency_ratio": 10.0}


def test_a_ball_started_on_its_orbit_follows_the_path_of_the_orbit():
    orbit = bb.model(**CONTACT).orbit(1, 0.9)
    start = {"phase": float(orbit.phase), "velocity": float(orbit.impact_velocity)}
    found = bb.history(0.9, **start, **CONTACT, periods=3.0)
    # Stable: rounding of the start does not grow.
    np.testing.assert_allclose(found.ball, orbit.path(found.time.values)[0], atol=1e-12)
    share = float(found.contact.mean())
    # A sample at either end of a contact is in it or not by rounding.
    assert share == pytest.approx(float(orbit.contact_duration) / (2 * np.pi), abs=2 / 200)


def test_an_elastic_drop_on_a_spring_keeps_its_energy():
    height, ratio = 5.0, 3.0
    found = bb.drop(height, restitution=1.0, frequency_ratio=ratio, periods=4.0)
    spring = np.where(found.contact, ratio**2 * found.ball**2 / 2, 0.0)
    energy = found.ball_velocity**2 / 2 + found.ball + spring
    np.testing.assert_allclose(energy, height, rtol=1e-12)
    assert found.contact.any()


def test_a_drop_on_a_moving_table_meets_it_where_a_root_finder_says():
    height, lam, phase, r = 4.0, 0.8, 2.0, 0.6
    fall = brentq(lambda t: height - t * t / 2 - lam * np.sin(phase + t), 0.0, 5.0, xtol=1e-15)
    found = bb.drop(height, lam, phase=phase, restitution=r, periods=1.0, samples=4000)
    before, after = found.sel(time=slice(0, fall)), found.sel(time=slice(fall, fall + 1.0))
    np.testing.assert_allclose(before.ball, height - before.time**2 / 2, rtol=1e-15)
    table = lam * np.cos(phase + fall)
    up = table - r * (-fall - table)
    since = after.time - fall
    level = height - fall**2 / 2
    np.testing.assert_allclose(after.ball, level + up * since - since**2 / 2, atol=1e-12)
    np.testing.assert_allclose(found.table, lam * np.sin(phase + found.time), atol=1e-14)


def test_a_ball_let_go_on_the_table_stays_behind_where_it_recedes_faster_than_the_ball_falls():
    # From its highest point at Λ = 2 the table goes down with twice the acceleration of a fall.
    found = bb.drop(2.0, 2.0, phase=np.pi / 2, restitution=0.5, periods=0.25)
    np.testing.assert_allclose(found.ball, 2 - found.time**2 / 2, rtol=1e-14)


@pytest.mark.parametrize(
    "given", [CONTACT, {"restitution": 0.85}, CONTACT | {"model": "corrected"}]
)
def test_a_branch_holds_the_orbits_and_limits_of_the_model(given):
    model = bb.model(**given)
    found = model.branch(2, points=60)
    known = [float(limit.amplitude) for limit in bb.limits(2, **given)]
    np.testing.assert_allclose(found.special_amplitude, known, rtol=1e-9)
    assert float(found.residual.max()) < 1e-12
    upper = found.isel(point=slice(int(found.amplitude.values.argmin()) + 2, None))
    exact = model.orbit(2, upper.amplitude.values)
    # At equal Λ the phase is so much less certain as the branch is steep there.
    np.testing.assert_allclose(upper.phase, exact.phase, atol=1e-9)
    assert upper.stable.values.tolist() == exact.is_stable().tolist()
    assert float(found.amplitude.max()) == pytest.approx(1.4 * known[1], rel=1e-12)


def test_two_arrays_make_a_grid_and_arrays_along_one_axis_are_pairs():
    given = {"restitution": 0.85, "periods": 2.0, "samples": 20}
    grid = bb.history([0.5, 1.0], frequency_ratio=[5.0, 10.0, 20.0], **given)
    assert dict(grid.ball.sizes) == {"amplitude": 2, "frequency_ratio": 3, "time": 41}
    one = bb.history(1.0, frequency_ratio=5.0, **given)
    np.testing.assert_array_equal(grid.ball.sel(amplitude=1.0, frequency_ratio=5.0), one.ball)
    lam, ratio = (xr.DataArray(x, dims="ball") for x in ([0.5, 1.0], [20.0, 5.0]))
    pairs = bb.history(lam, frequency_ratio=ratio, **given)
    assert pairs.ball.dims == ("ball", "time")
    np.testing.assert_array_equal(pairs.ball[1], one.ball)
    assert grid.frequency_ratio.attrs["symbol"] == "ϖ"


def test_a_family_that_does_not_exist_says_why_beside_the_others():
    found = bb.branch([1, 3], restitution=0.5, amplitude_max=1.3, points=20)
    assert found.amplitude.sel(n=1).notnull().all()
    assert found.amplitude.sel(n=3).isnull().all()
    assert "no 3-T orbit up to Λ = 1.3" in found.end_reason.sel(n=3).values[0]


@pytest.mark.parametrize(
    "data",
    [
        pytest.param(lambda: bb.history([0.5, 1.0], **CONTACT, periods=2.0), id="history"),
        pytest.param(lambda: bb.branch([1, 2], **CONTACT, points=40), id="branch"),
        pytest.param(lambda: bb.orbit([1, 2], [0.6, 1.0, 1.3], **CONTACT), id="orbit"),
        pytest.param(lambda: bb.limits([1, 2], restitution=[0.5, 0.85]), id="limits"),
    ],
)
def test_a_plot_shows_the_data_and_is_a_picture(data, tmp_path):
    found = data()
    figure = found.plot(tmp_path / "shown.png")
    assert (tmp_path / "shown.png").read_bytes()[1:4] == b"PNG"
    drawn = {line.get_label(): line for line in figure.axes[0].get_lines()}
    if found.kind == "history":
        np.testing.assert_array_equal(drawn[r"$\Lambda=0.5$"].get_ydata(), found.ball[0])
    elif found.kind == "orbit":
        np.testing.assert_array_equal(
            drawn["$n=1$"].get_ydata(), (found.phase[0] / np.pi).where(found.stable[0])
        )
        # Beyond the period doubling.
        assert np.isnan(drawn["$n=1$"].get_ydata()).tolist() == [False, False, True]
    elif found.kind == "limits":
        ends = drawn["period doubling, $n=2$"].get_ydata()
        np.testing.assert_array_equal(ends, found.period_doubling_amplitude[1])
    else:
        y = np.concatenate([line.get_ydata() for line in figure.axes[0].get_lines()])
        assert float(found.phase.max() / np.pi) in y
        assert {"$n=1$", "$n=2$", "stable", "saddle-node"} <= set(drawn)
    assert callable(found.plot.scatter)
    assert isinstance(found.isel({found.ball.dims[0]: 0}) if "ball" in found else found, Labelled)


MANY = {"restitution": 0.5, "periods": 10_000, "samples": 10_000}


@pytest.mark.parametrize(
    ("amplitude", "given", "text"),
    [
        (-1.0, {}, "amplitude = -1.0 is not a number in [0, 1e+08]"),
        ([1.0, "a"], {}, "amplitude = 'a' is not a number in [0"),
        (np.ones((1, 1)), {}, "amplitude has 2 axes without names"),
        (None, {}, "amplitude is missing"),
        ([], {}, "amplitude has no entries"),
        (1.0, {"periods": 0}, "periods = 0 is not a number in (0, 10"),
        (1.0, MANY, "100000001 states exceed the limit of 10000000"),
        (1.0, {"foo": 3}, "unknown parameter 'foo': choose from"),
        (1.0, {"restitution": None}, "one of the arguments restitution damping_ratio"),
        (1.0, {"release": ["force", "displacement"]}, "release must be one value or an array of n"),
    ],
)
def test_a_mistake_about_a_ball_is_one_line(amplitude, given, text, refusal):
    with refusal(ValueError, text):
        bb.history(amplitude, **CONTACT | given)


LAW = {"law": "tsuji", "duration": 0.1}
ARRAYS = {"law": "tsuji", "parameters": {"stiffness": [9.0, 8.0], "damping": 1.0}}


@pytest.mark.parametrize(
    ("call", "text"),
    [
        (lambda: bb.drop(0.5, 1.0, phase=1.0, restitution=0.5), "height = 0.5 is not at or above"),
        (lambda: bb.drop(9.0, **LAW, restitution=[0.5, 0.6]), "restitution must be a single numb"),
        (lambda: bb.drop(9.0, **ARRAYS), "parameters must be single numbers"),
        (lambda: bb.branch(0, restitution=0.5), "n = 0 is not a whole number from 1 to 1000"),
        (lambda: bb.branch(1, restitution=0.5, amplitude_max=0.1), "no 1-T orbit up to Λ = 0.1"),
        (lambda: bb.model([0.5, 0.6]).branch(1), "several models have no labels"),
        (lambda: bb.drop(9.0, restitution=0.5).plot("x.txt"), "'x.txt' does not end in .pdf or"),
        (lambda: Labelled().plot(), "a dataset of the kind None has no figure: history, branch"),
    ],
)
def test_a_mistake_is_one_line(call, text, refusal):
    with refusal(ValueError, text):
        call()

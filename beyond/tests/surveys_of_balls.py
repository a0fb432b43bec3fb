"""Tests of the calls that both houses have, over time and along branches, of labelled datasets.

A house's test class has its package as ``bb``, and says how an orbit is computed another way.
"""

import pickle
from itertools import product
from types import ModuleType

import numpy as np
import pytest
import xarray as xr
from scipy.optimize import brentq

from bouncing_ball_beyond.inherited.drawing.result import Result


def drawn(found, path):
    """The lines of the figure of a result by their labels, and the figure."""
    figure = found.plot(path)
    assert path.read_bytes()[1:4] == b"PNG"
    return {line.get_label(): line for line in figure.axes[0].get_lines()}, figure


def parts_draw_the_figure_of_the_whole(found):
    """A part of a result, and one that was pickled, are results, and draw as many axes."""
    first = next(iter(found.dims))
    whole = found.plot()
    parts = [found.isel({first: [k]}) for k in range(found.sizes[first])]
    for part in (found.isel({first: 0}), pickle.loads(pickle.dumps(found)), *parts):
        assert type(part) is type(found) and isinstance(part, Result)
        assert len(part.plot().axes) == len(whole.axes)
    joined = xr.concat(parts, first).transpose(*found.dims)
    assert joined.identical(found) and joined.plot().axes[0].get_title() == (
        whole.axes[0].get_title()
    )


def has_the_orbits_and_limits(bb, ball, exact):
    """The branch of 2-T orbits agrees with ``exact``: their phase and stability at given Λ."""
    found = bb.branch(ball, 2, points=60)
    known = [limit.amplitude for limit in bb.limits(ball, 2)]
    np.testing.assert_allclose(found.special_amplitude, known, rtol=1e-9)
    assert float(found.residual.max()) < 1e-12
    upper = found.isel(point=slice(int(found.amplitude.values.argmin()) + 2, None))
    phase, stable = exact(upper.amplitude.values)
    # At equal Λ the phase is so much less certain as the branch is steep there.
    np.testing.assert_allclose(upper.phase, phase, atol=1e-9)
    assert upper.stable.values.tolist() == stable.tolist()
    assert float(found.amplitude.max()) == pytest.approx(1.4 * known[1], rel=1e-12)


def contact(bb):
    return bb.spring_damper(restitution=0.85, frequency_ratio=10.0)


def rigid(bb):
    return bb.rigid(restitution=0.85)


MANY = {"periods": 10_000, "samples": 10_000}


class Surveys:
    """The tests of a house, which has ``bb`` and :meth:`path`."""

    bb: ModuleType

    def path(self, orbit, time):
        """The height of the ball on an orbit."""
        raise NotImplementedError

    def test_a_ball_started_on_its_orbit_follows_the_path_of_the_orbit(self):
        orbit = self.bb.orbit(contact(self.bb), amplitude=0.9)
        found = self.bb.history(
            contact(self.bb),
            amplitude=0.9,
            phase=orbit.phase,
            velocity=orbit.impact_velocity,
            periods=3.0,
        )
        # Stable: rounding of the start does not grow.
        np.testing.assert_allclose(found.ball, self.path(orbit, found.time.values), atol=1e-12)
        share = float(found.contact.mean())
        # A sample at either end of a contact is in it or not by rounding.
        assert share == pytest.approx(orbit.contact_duration / (2 * np.pi), abs=2 / 200)

    def test_an_elastic_drop_on_a_spring_keeps_its_energy(self):
        height = 5.0
        ratio = 3.0
        ball = self.bb.spring_damper(restitution=1.0, frequency_ratio=ratio)
        found = self.bb.drop(ball, height=height, periods=4.0)
        spring = np.where(found.contact, ratio**2 * found.ball**2 / 2, 0.0)
        energy = found.ball_velocity**2 / 2 + found.ball + spring
        np.testing.assert_allclose(energy, height, rtol=1e-12)
        assert found.contact.any()

    def test_a_drop_on_a_moving_table_meets_it_where_a_root_finder_says(self):
        height, lam, phase, r = 4.0, 0.8, 2.0, 0.6
        fall = brentq(lambda t: height - t * t / 2 - lam * np.sin(phase + t), 0.0, 5.0, xtol=1e-15)
        found = self.bb.drop(
            self.bb.rigid(restitution=r),
            height=height,
            amplitude=lam,
            phase=phase,
            periods=1.0,
            samples=4000,
        )
        before = found.sel(time=slice(0, fall))
        after = found.sel(time=slice(fall, fall + 1.0))
        np.testing.assert_allclose(before.ball, height - before.time**2 / 2, rtol=1e-15)
        table = lam * np.cos(phase + fall)
        up = table - r * (-fall - table)
        since = after.time - fall
        level = height - fall**2 / 2
        np.testing.assert_allclose(after.ball, level + up * since - since**2 / 2, atol=1e-12)
        np.testing.assert_allclose(found.table, lam * np.sin(phase + found.time), atol=1e-14)

    def test_a_ball_let_go_on_the_table_stays_behind_where_it_recedes_faster_than_the_ball_falls(
        self,
    ):
        # From its highest point at Λ = 2 the table goes down with twice the acceleration of a fall.
        ball = self.bb.rigid(restitution=0.5)
        found = self.bb.drop(ball, height=2.0, amplitude=2.0, phase=np.pi / 2, periods=0.25)
        np.testing.assert_allclose(found.ball, 2 - found.time**2 / 2, rtol=1e-14)

    def test_two_arrays_make_a_grid_and_arrays_along_one_axis_are_pairs(self):
        length = {"periods": 2.0, "samples": 20}
        balls = self.bb.spring_damper(restitution=0.85, frequency_ratio=[5.0, 10.0, 20.0])
        grid = self.bb.history(balls, amplitude=[0.5, 1.0], **length)
        assert dict(grid.ball.sizes) == {"amplitude": 2, "frequency_ratio": 3, "time": 41}
        compliant = self.bb.spring_damper(restitution=0.85, frequency_ratio=5.0)
        one = self.bb.history(compliant, amplitude=1.0, **length)
        np.testing.assert_array_equal(grid.ball.sel(amplitude=1.0, frequency_ratio=5.0), one.ball)
        lam, ratio = (xr.DataArray(x, dims="pair") for x in ([0.5, 1.0], [20.0, 5.0]))
        several = self.bb.spring_damper(restitution=0.85, frequency_ratio=ratio)
        pairs = self.bb.history(several, amplitude=lam, **length)
        assert pairs.ball.dims == ("pair", "time")
        np.testing.assert_array_equal(pairs.ball[1], one.ball)
        assert grid.frequency_ratio.attrs["symbol"] == "ϖ"

    def test_a_family_that_does_not_exist_says_why_beside_the_others(self):
        found = self.bb.branch(self.bb.rigid(restitution=0.5), [1, 3], amplitude_max=1.3, points=20)
        assert found.amplitude.sel(n=1).notnull().all()
        assert found.amplitude.sel(n=3).isnull().all()
        assert "no 3-T orbit up to Λ = 1.3" in found.end_reason.sel(n=3).values[0]

    def test_the_plot_of_histories_has_a_line_for_each_ball(self, tmp_path):
        found = self.bb.history(contact(self.bb), amplitude=[0.5, 1.0], periods=2.0)
        lines, _ = drawn(found, tmp_path / "shown.png")
        np.testing.assert_array_equal(lines[r"$\Lambda=0.5$"].get_ydata(), found.ball[0])

    def test_the_plot_of_orbits_is_solid_where_they_are_stable(self, tmp_path):
        found = self.bb.orbit(contact(self.bb), [1, 2], amplitude=[0.6, 1.0, 1.3])
        lines, _ = drawn(found, tmp_path / "shown.png")
        shown = lines["$n=1$"].get_ydata()
        np.testing.assert_array_equal(shown, (found.phase[0] / np.pi).where(found.stable[0]))
        # Beyond the period doubling.
        assert np.isnan(shown).tolist() == [False, False, True]

    def test_the_plot_of_limits_has_both_bifurcations_of_each_family(self, tmp_path):
        found = self.bb.limits(self.bb.rigid(restitution=[0.5, 0.85]), [1, 2])
        lines, _ = drawn(found, tmp_path / "shown.png")
        ends = lines["period doubling, $n=2$"].get_ydata()
        np.testing.assert_array_equal(ends, found.period_doubling_amplitude[1])

    def test_the_plot_of_branches_has_their_points_and_bifurcations(self, tmp_path):
        found = self.bb.branch(contact(self.bb), [1, 2], points=40)
        lines, figure = drawn(found, tmp_path / "shown.png")
        y = np.concatenate([line.get_ydata() for line in figure.axes[0].get_lines()])
        assert float(found.phase.max() / np.pi) in y
        assert {"stable", "saddle-node"} <= set(lines)
        assert {"$n=1$", "$n=2$"} <= {text.get_text() for text in figure.axes[0].texts}

    def test_the_plot_of_a_simulation_has_a_mark_for_each_impact(self, tmp_path):
        found = self.bb.simulate(contact(self.bb), amplitude=[0.9, 1.0], impacts=5)
        lines, figure = drawn(found, tmp_path / "shown.png")
        shown = lines[r"$\Lambda=0.9$"].get_ydata()
        np.testing.assert_array_equal(shown, found.impact_phase[0] / np.pi)
        speeds = figure.axes[1].get_lines()[1].get_ydata()
        np.testing.assert_array_equal(speeds, found.impact_velocity[1])

    def test_the_plot_of_thresholds_of_permanent_contact_has_a_line_for_each_damping(
        self, tmp_path
    ):
        balls = self.bb.spring_damper(damping_ratio=[0.0, 0.1], frequency_ratio=[2.0, 4.0, 8.0])
        found = self.bb.permanent_contact(balls)
        lines, _ = drawn(found, tmp_path / "shown.png")
        shown = lines[r"$\zeta=0.1$"].get_ydata()
        np.testing.assert_array_equal(shown, found.threshold_amplitude[1])

    @pytest.mark.parametrize(
        "call",
        [
            lambda bb: bb.history(contact(bb), amplitude=[0.5, 1.0], periods=1.0),
            lambda bb: bb.drop(contact(bb), height=[5.0, 8.0], periods=1.0),
            lambda bb: bb.simulate(contact(bb), amplitude=[0.5, 1.0], impacts=3),
            lambda bb: bb.orbit(contact(bb), [1, 2], amplitude=[0.9, 1.0]),
            lambda bb: bb.limits(bb.rigid(restitution=[0.5, 0.6]), [1, 2]),
            lambda bb: bb.branch(contact(bb), [1, 2], points=20),
            lambda bb: bb.permanent_contact(
                bb.spring_damper(restitution=[0.5, 0.6], frequency_ratio=[5.0, 10.0])
            ),
            lambda bb: bb.error_thresholds(rigid(bb), [1, 2], amplitude=1.0),
        ],
    )
    def test_a_part_of_a_result_draws_the_figure_of_the_whole(self, call):
        parts_draw_the_figure_of_the_whole(call(self.bb))

    def test_a_dataset_without_its_attributes_says_so(self, refusal):
        with refusal(ValueError, "has lost the attributes of the result of a call"):
            self.bb.limits(rigid(self.bb), [1, 2]).drop_attrs().plot()

    @pytest.mark.parametrize(
        ("amplitude", "given", "text"),
        [
            (-1.0, {}, "amplitude = -1.0 is not 0 or a number in [1e-12, 1e+08]"),
            ([1.0, "a"], {}, "amplitude = 'a' is not 0 or a number in [1e-12"),
            (np.array([1.0, -2.0]), {}, "amplitude = -2.0 is not 0 or a number in [1e-12"),
            (np.ones((1, 1)), {}, "amplitude has 2 axes without names"),
            (None, {}, "amplitude is missing"),
            ([], {}, "amplitude has no entries"),
            (1.0, {"periods": 0}, "periods = 0 is not a number in (0, 10"),
            (1.0, {"periods": [1.0, 2.0]}, "periods must be a single number"),
            (1.0, MANY, "100000001 states exceed the limit of 10000000"),
        ],
    )
    def test_a_mistake_about_a_ball_is_one_line(self, amplitude, given, text, refusal):
        with refusal(ValueError, text):
            self.bb.history(contact(self.bb), amplitude=amplitude, **given)

    @pytest.mark.parametrize(
        ("call", "text"),
        [
            (
                lambda bb: bb.drop(bb.rigid(restitution=0.5), height=0.5, amplitude=1.0, phase=1.0),
                "height = 0.5 is not at or above",
            ),
            (
                lambda bb: bb.branch(bb.rigid(restitution=0.5), 0),
                "n = 0 is not a whole number from 1 to 1000",
            ),
            (
                lambda bb: bb.branch(bb.rigid(restitution=0.5), amplitude_max=0.1),
                "no 1-T orbit up to Λ = 0.1",
            ),
            (
                lambda bb: bb.drop(bb.rigid(restitution=0.5), height=9.0).plot("x.txt"),
                "'x.txt' does not end in .pdf or",
            ),
            (
                lambda bb: bb.simulate(bb.rigid(restitution=0.5), amplitude=1.0, velocity=9.0),
                "rises from the table",
            ),
        ],
    )
    def test_a_mistake_is_one_line(self, call, text, refusal):
        with refusal(ValueError, text):
            call(self.bb)

    def test_the_plot_of_a_branch_shows_all_that_its_dataset_has(self):
        """At ϖ = 2 the branch turns twice, and two period doublings lie on the longer contacts."""
        found = self.bb.branch(
            self.bb.spring_damper(restitution=0.85, frequency_ratio=2.0), points=100
        )
        panels = found.plot().axes
        assert len(panels) == 2
        for axes, kind in product(panels, ("saddle-node", "period doubling")):
            here = (found.special_kind == kind).values
            (line,) = [line for line in axes.lines if line.get_label() == kind]
            x = line.get_xdata()[np.isfinite(line.get_ydata().astype(float))]
            np.testing.assert_array_equal(np.sort(x), np.sort(found.special_amplitude.values[here]))
        axes = panels[0]
        stable = np.unique(
            np.concatenate([x.get_xdata() for x in axes.lines if x.get_label() == "stable"])
        )
        assert np.isin(found.amplitude.values[found.stable.values], stable).all()

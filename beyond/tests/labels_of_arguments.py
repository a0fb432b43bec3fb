"""Tests of arrays with labels as arguments of the calls that both houses have.

They say what labels may say, and what is refused. A house's test class has its package as ``bb``.
"""

from types import ModuleType

import numpy as np
import pytest
import xarray as xr

from bouncing_ball_beyond.inherited.errors import ModelError, NoOrbitError, ParameterError

ALONG_K = xr.DataArray([1.0, 1.2], dims="k", coords={"k": [0, 1]})
LONG = np.linspace(0.5, 1.5, 100_001)


def rigid(bb):
    return bb.rigid(restitution=0.85)


def refuses_an_array_along_one_value(bb, refusal, call):
    """An array along the axis of an amplitude that has a single value, or lies elsewhere."""
    first = bb.orbit(rigid(bb), amplitude=[1.0, 1.2])
    with refusal(ParameterError, "phase lies along amplitude", "a single value"):
        call(rigid(bb), amplitude=1.5, phase=first.phase)
    with refusal(ParameterError, "phase lies along amplitude, but amplitude does not"):
        call(rigid(bb), amplitude=ALONG_K, phase=first.phase)


class Talkative:
    """What prints many lines."""

    def __repr__(self):
        return "a line\n" * 1000


def a_dataset(bb):
    """A result of a call of the house."""
    return bb.orbit(rigid(bb), amplitude=[1.0, 1.2])


WRONG = {
    "a dataset": a_dataset,
    "unequal rows": [[1], [1, 2]],
    "a number and a row": [0.5, [0.6]],
    "many lines": Talkative(),
    "a long list": ["x"] * 5000,
    "a long text": "x\ny" * 500,
    "many digits": 10**5000,
    "a module": np,
    "a time": np.timedelta64(1, "ns"),
    "a date": np.datetime64(1, "ns"),
    "times": np.array([1, 1], dtype="timedelta64[ns]"),
    "dates": [np.datetime64(1, "ns")],
    "a plane": np.full((2, 2), -1.0),
}
CALLS = {
    "restitution": lambda bb, wrong: bb.rigid(restitution=wrong),
    "amplitude": lambda bb, wrong: bb.orbit(rigid(bb), amplitude=wrong),
    "impacts": lambda bb, wrong: bb.simulate(rigid(bb), amplitude=1.0, impacts=wrong),
    "ball": lambda bb, wrong: bb.orbit(wrong, amplitude=1.0),
    "side": lambda bb, wrong: bb.orbit(rigid(bb), amplitude=1.0, side=wrong),
    "quantities": lambda bb, wrong: bb.error_thresholds(rigid(bb), amplitude=1.0, quantities=wrong),
    "damping ratio": lambda bb, wrong: bb.SpringDamper(10.0, wrong),
    "release": lambda bb, wrong: bb.SpringDamper(10.0, 0.1, wrong),
}

every_wrong_object = pytest.mark.parametrize("wrong", WRONG.values(), ids=WRONG)


def refuses_in_one_short_line(bb, call, wrong):
    if wrong is a_dataset:
        wrong = a_dataset(bb)
    with pytest.raises(ModelError) as error:
        call(bb, wrong)
    line = str(error.value)
    assert "\n" not in line and len(line) < 300


class LabelsOfArguments:
    """The tests of a house, which has ``bb``."""

    bb: ModuleType

    def test_what_an_array_was_a_result_of_does_not_label_another_result(self):
        """The impacts of one call start another one, whose results replace them."""
        first = self.bb.orbit(rigid(self.bb), amplitude=[1.0, 1.2])
        at = {"amplitude": first.amplitude, "phase": first.phase, "velocity": first.impact_velocity}
        moved = self.bb.history(rigid(self.bb), **at, periods=1)
        found = self.bb.orbit(rigid(self.bb), amplitude=moved.amplitude * 1.1)
        right = self.bb.orbit(rigid(self.bb), amplitude=np.array([1.0, 1.2]) * 1.1)
        assert found.phase.values == pytest.approx(right.phase.values, rel=1e-14)
        assert found.amplitude.values.tolist() == right.amplitude.values.tolist()

    def test_an_array_along_an_argument_with_one_value_is_refused(self, refusal):
        refuses_an_array_along_one_value(self.bb, refusal, self.bb.simulate)

    @pytest.mark.parametrize(
        ("other", "said"),
        [
            (
                xr.DataArray([1, 2], dims="k", coords={"k": [0, 2]}),
                "other labels on the same axis k",
            ),
            (xr.DataArray([1, 2, 3], dims="k"), "3 and 2 entries on the same axis k"),
        ],
    )
    def test_two_arrays_on_one_axis_have_the_same_labels(self, refusal, other, said):
        with refusal(ParameterError, "n and amplitude have", said):
            self.bb.orbit(rigid(self.bb), amplitude=ALONG_K, n=other)

    def test_labels_may_be_given_once(self):
        found = self.bb.orbit(rigid(self.bb), amplitude=ALONG_K, n=xr.DataArray([1, 2], dims="k"))
        assert found.phase.dims == ("k",) and found.k.values.tolist() == [0, 1]
        assert found.n.values.tolist() == [1, 2]

    @pytest.mark.parametrize(
        ("call", "axis"),
        [
            (lambda bb, lam: bb.history(rigid(bb), amplitude=lam, periods=1), "time"),
            (lambda bb, lam: bb.simulate(rigid(bb), amplitude=lam, impacts=3), "impact"),
            (lambda bb, lam: bb.orbit(rigid(bb), amplitude=lam), "phase"),
            (lambda bb, n: bb.branch(rigid(bb), n=n.astype(int), points=10), "point"),
        ],
    )
    def test_an_axis_has_no_name_of_a_result(self, refusal, call, axis):
        with refusal(ParameterError, f"an axis {axis}, which is the name of a result"):
            call(self.bb, ALONG_K.rename(k=axis))

    def test_the_axis_of_cases_of_a_dataset_is_an_axis_as_any_other(self):
        found = self.bb.orbit(rigid(self.bb), amplitude=ALONG_K.rename(k="case"))
        assert found.phase.dims == ("case",)

    def test_a_half_precision_number_is_computed_in_double_precision(self):
        half = np.array([1.0, 1.25], dtype=np.float16)
        for given in (half, xr.DataArray(half, dims="k"), half.astype(np.float32)):
            found = self.bb.orbit(rigid(self.bb), amplitude=given)
            right = self.bb.orbit(rigid(self.bb), amplitude=[1.0, 1.25])
            assert found.phase.values.tolist() == right.phase.values.tolist()
        n = np.array([100, 101], dtype=np.int8)
        found, right = (self.bb.limits(rigid(self.bb), n=each) for each in (n, n.tolist()))
        assert found.equals(right)

    def test_a_masked_array_is_refused(self, refusal):
        masked = np.ma.array([1.0, 1.2], mask=[False, True])
        with refusal(ParameterError, "amplitude is a masked array"):
            self.bb.orbit(rigid(self.bb), amplitude=masked)
        with refusal(ModelError, "damping ratio", "masked_array"):
            self.bb.SpringDamper(10.0, masked / 10)

    @every_wrong_object
    @pytest.mark.parametrize("call", CALLS.values(), ids=CALLS)
    def test_any_object_is_refused_in_one_short_line(self, call, wrong):
        refuses_in_one_short_line(self.bb, call, wrong)

    def test_what_a_caller_lets_numpy_do_does_not_reach_into_the_library(self):
        """The contacts are so long and lossy that their ends are below the smallest number."""
        lossy = self.bb.spring_damper(restitution=1e-6, frequency_ratio=1e-3)
        before = self.bb.limits(lossy)
        fallen = self.bb.drop(lossy, height=1.0, periods=1)
        ball = self.bb.spring_damper(restitution=0.85, frequency_ratio=10.0)
        long_fallen = self.bb.drop(ball, height=1.0, periods=750)
        with np.errstate(all="raise"):
            assert self.bb.drop(ball, height=1.0, periods=750).equals(long_fallen)
            self.bb.history(rigid(self.bb), amplitude=1.0, periods=5e-324)
            assert repr(self.bb.limits(lossy)) == repr(before)
            assert self.bb.drop(lossy, height=1.0, periods=1).equals(fallen)
            with pytest.raises(NoOrbitError):
                self.bb.orbits(lossy, amplitude=1.0)

    def test_more_impacts_than_fit_into_memory_are_refused_before_they_are_computed(self, refusal):
        with refusal(
            ModelError, "100000000 states exceed the limit of 10000000", "impacts or balls"
        ):
            self.bb.simulate(rigid(self.bb), amplitude=np.linspace(1.0, 2.0, 1000), impacts=100_000)

    @pytest.mark.parametrize(
        ("call", "text"),
        [
            (
                lambda bb: bb.orbit(rigid(bb), [1, 2] * 50, amplitude=LONG),
                "10000100 places of a grid exceed",
            ),
            (
                lambda bb: bb.permanent_contact(bb.rigid(restitution=np.ones(10**7 + 1))),
                "10000001 places",
            ),
            (
                lambda bb: bb.branch(bb.rigid(restitution=LONG / 2)),
                "30000300 points exceed the limit",
            ),
            (
                lambda bb: bb.history(rigid(bb), amplitude=LONG),
                "states exceed the limit of 10000000",
            ),
        ],
    )
    def test_results_that_would_fill_the_memory_are_refused_before_they_are_computed(
        self, call, text, refusal
    ):
        with refusal(ModelError, text, "use fewer"):
            call(self.bb)

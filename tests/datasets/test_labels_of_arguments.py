"""Arrays with labels as arguments of calls: what their labels may say, and what is refused."""

import numpy as np
import pytest
import xarray as xr

import bouncing_ball as bb
from bouncing_ball.errors import ParameterError

BALL = bb.rigid(restitution=0.85)
ALONG_K = xr.DataArray([1.0, 1.2], dims="k", coords={"k": [0, 1]})


def test_what_an_array_was_a_result_of_does_not_label_another_result():
    """The impacts of one call start another one, whose results replace them."""
    first = bb.orbit(BALL, amplitude=[1.0, 1.2])
    at = {"amplitude": first.amplitude, "phase": first.phase, "velocity": first.impact_velocity}
    moved = bb.history(BALL, **at, periods=1)
    found = bb.orbit(BALL, amplitude=moved.amplitude * 1.1)
    right = bb.orbit(BALL, amplitude=np.array([1.0, 1.2]) * 1.1)
    assert found.phase.values == pytest.approx(right.phase.values, rel=1e-14)
    assert found.amplitude.values.tolist() == right.amplitude.values.tolist()


def test_an_array_along_an_argument_with_one_value_is_refused(refusal):
    first = bb.orbit(BALL, amplitude=[1.0, 1.2])
    with refusal(ParameterError, "phase lies along amplitude", "a single value"):
        bb.simulate(BALL, amplitude=1.5, phase=first.phase)
    with refusal(ParameterError, "phase lies along amplitude, but amplitude does not"):
        bb.simulate(BALL, amplitude=ALONG_K, phase=first.phase)


@pytest.mark.parametrize(
    ("other", "said"),
    [
        (xr.DataArray([1, 2], dims="k", coords={"k": [0, 2]}), "other labels on the same axis k"),
        (xr.DataArray([1, 2, 3], dims="k"), "3 and 2 entries on the same axis k"),
    ],
)
def test_two_arrays_on_one_axis_have_the_same_labels(refusal, other, said):
    with refusal(ParameterError, "n and amplitude have", said):
        bb.orbit(BALL, amplitude=ALONG_K, n=other)


def test_labels_may_be_given_once():
    found = bb.orbit(BALL, amplitude=ALONG_K, n=xr.DataArray([1, 2], dims="k"))
    assert found.phase.dims == ("k",) and found.k.values.tolist() == [0, 1]
    assert found.n.values.tolist() == [1, 2]


@pytest.mark.parametrize(
    ("call", "axis"),
    [
        (lambda lam: bb.history(BALL, amplitude=lam, periods=1), "time"),
        (lambda lam: bb.simulate(BALL, amplitude=lam, impacts=3), "impact"),
        (lambda lam: bb.orbit(BALL, amplitude=lam), "phase"),
        (lambda n: bb.branch(BALL, n=n.astype(int), points=10), "point"),
    ],
)
def test_an_axis_has_no_name_of_a_result(refusal, call, axis):
    with refusal(ParameterError, f"an axis {axis}, which is the name of a result"):
        call(ALONG_K.rename(k=axis))


def test_the_axis_of_cases_of_a_dataset_is_an_axis_as_any_other():
    found = bb.orbit(BALL, amplitude=ALONG_K.rename(k="case"))
    assert found.phase.dims == ("case",)


def test_a_half_precision_number_is_computed_in_double_precision():
    half = np.array([1.0, 1.25], dtype=np.float16)
    for given in (half, xr.DataArray(half, dims="k"), half.astype(np.float32)):
        found = bb.orbit(BALL, amplitude=given)
        right = bb.orbit(BALL, amplitude=[1.0, 1.25])
        assert found.phase.values.tolist() == right.phase.values.tolist()
    n = np.array([100, 101], dtype=np.int8)
    found, right = (bb.limits(BALL, n=each) for each in (n, n.tolist()))
    assert found.equals(right)


def test_a_masked_array_is_refused(refusal):
    masked = np.ma.array([1.0, 1.2], mask=[False, True])
    with refusal(ParameterError, "amplitude is a masked array"):
        bb.orbit(BALL, amplitude=masked)
    with refusal(bb.ModelError, "damping ratio", "masked_array"):
        bb.SpringDamper(10.0, masked / 10)


class Talkative:
    """What prints many lines."""

    def __repr__(self):
        return "a line\n" * 1000


WRONG = {
    "a dataset": bb.orbit(BALL, amplitude=[1.0, 1.2]),
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
    "restitution": lambda wrong: bb.rigid(restitution=wrong),
    "amplitude": lambda wrong: bb.orbit(BALL, amplitude=wrong),
    "impacts": lambda wrong: bb.simulate(BALL, amplitude=1.0, impacts=wrong),
    "ball": lambda wrong: bb.orbit(wrong, amplitude=1.0),
    "side": lambda wrong: bb.orbit(BALL, amplitude=1.0, side=wrong),
    "quantities": lambda wrong: bb.error_thresholds(BALL, amplitude=1.0, quantities=wrong),
    "damping ratio": lambda wrong: bb.SpringDamper(10.0, wrong),
    "release": lambda wrong: bb.SpringDamper(10.0, 0.1, wrong),
}


@pytest.mark.parametrize("wrong", WRONG.values(), ids=WRONG)
@pytest.mark.parametrize("call", CALLS.values(), ids=CALLS)
def test_any_object_is_refused_in_one_short_line(call, wrong):
    with pytest.raises(bb.ModelError) as error:
        call(wrong)
    line = str(error.value)
    assert "\n" not in line and len(line) < 300


def test_what_a_caller_lets_numpy_do_does_not_reach_into_the_library():
    """The contacts are so long, and lose so much, that their ends are below the smallest number."""
    lossy = bb.spring_damper(restitution=1e-6, frequency_ratio=1e-3)
    before = bb.limits(lossy)
    fallen = bb.drop(lossy, height=1.0, periods=1)
    ball = bb.spring_damper(restitution=0.85, frequency_ratio=10.0)
    long_fallen = bb.drop(ball, height=1.0, periods=750)
    with np.errstate(all="raise"):
        assert bb.drop(ball, height=1.0, periods=750).equals(long_fallen)
        bb.history(BALL, amplitude=1.0, periods=5e-324)
        assert repr(bb.limits(lossy)) == repr(before)
        assert bb.drop(lossy, height=1.0, periods=1).equals(fallen)
        with pytest.raises(bb.NoOrbitError):
            bb.orbits(lossy, amplitude=1.0)


def test_more_impacts_than_fit_into_memory_are_refused_before_they_are_computed(refusal):
    with refusal(
        bb.ModelError, "100000000 states exceed the limit of 10000000", "impacts or balls"
    ):
        bb.simulate(BALL, amplitude=np.linspace(1.0, 2.0, 1000), impacts=100_000)


LONG = np.linspace(0.5, 1.5, 100_001)


@pytest.mark.parametrize(
    ("call", "text"),
    [
        (lambda: bb.orbit(BALL, [1, 2] * 50, amplitude=LONG), "10000100 places of a grid exceed"),
        (lambda: bb.permanent_contact(bb.rigid(restitution=np.ones(10**7 + 1))), "10000001 places"),
        (lambda: bb.branch(bb.rigid(restitution=LONG / 2)), "30000300 points exceed the limit"),
        (lambda: bb.history(BALL, amplitude=LONG), "states exceed the limit of 10000000"),
    ],
)
def test_results_that_would_fill_the_memory_are_refused_before_they_are_computed(
    call, text, refusal
):
    with refusal(bb.ModelError, text, "use fewer"):
        call()

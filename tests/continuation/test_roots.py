"""Roots in brackets, of functions whose roots are known."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from bouncing_ball.continuation.roots import bracketed_roots

ROOTS = st.lists(st.floats(-3, 3), min_size=1, max_size=20).map(np.array)


@given(root=ROOTS, slope=st.floats(1e-3, 1e3), flat=st.sampled_from([1, 3]))
def test_a_rising_function_has_its_root_found_to_the_last_digits(root, slope, flat):
    # x - root is exact near the root, so that only the root's own rounding remains.
    calls = []

    def function(x, k):
        calls.append(x.size)
        return slope * (x - root[k]) ** flat * (1 + x * x)

    found = bracketed_roots(function, np.full(root.size, -5.0), np.full(root.size, 7.0), 1e-15)
    assert np.all(np.abs(found - root) <= 4 * np.spacing(np.abs(root)) + 1e-15)
    # Functions whose root is known are not evaluated again.
    assert sorted(calls, reverse=True) == calls


def test_without_a_change_of_sign_the_end_with_the_smaller_value_is_the_result():
    found = bracketed_roots(lambda x, _: 1 + x * x, np.array([-1.0, -3.0]), np.array([2.0, 2.0]))
    assert found.tolist() == [-1.0, 2.0]

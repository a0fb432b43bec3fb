"""Random calls end with an answer or with one line: no traceback, no warning, nothing printed."""

import pytest
import random_calls

# Calls of the functions that answer at once; all functions are in the long test.
SOME = 60
MANY = 2000


def test_every_public_function_is_called():
    assert random_calls.uncovered() == set()


@pytest.mark.parametrize("part", range(4))
def test_random_calls_of_quick_functions_are_answered_or_refused(part):
    for number in range(part * SOME // 4, (part + 1) * SOME // 4):
        found = random_calls.result(5, number, random_calls.QUICK)
        assert found.outcome not in random_calls.BAD, found


@pytest.mark.long
@pytest.mark.parametrize("part", range(100))
def test_random_calls_are_answered_or_refused(part):
    for number in range(part * MANY // 100, (part + 1) * MANY // 100):
        found = random_calls.result(7, number)
        assert found.outcome not in random_calls.BAD, found

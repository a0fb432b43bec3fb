"""Random branches of all models: each end is right by a second code, or named."""

import numpy as np
import pytest
from random_branches import sample


@pytest.mark.parametrize(
    "count, seed", [(5, 7), pytest.param(300, 480411, marks=[pytest.mark.long, pytest.mark.slow])]
)
def test_the_ends_of_random_branches_are_right_or_named(count, seed):
    verdicts = sample(count, seed)
    wrong = [each for each in verdicts if each.verdict == "wrong"]
    assert not wrong
    # Of the 300 branches 296 were right, and 4 were named.
    assert np.mean([each.verdict == "right" for each in verdicts]) > 0.95

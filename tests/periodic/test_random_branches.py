"""Random branches of all models: each end is right by a second code, or named."""

import numpy as np
import pytest
from random_branches import sample


@pytest.mark.parametrize(
    "count", [5, pytest.param(300, marks=[pytest.mark.long, pytest.mark.slow])]
)
def test_the_ends_of_random_branches_are_right_or_named(count):
    verdicts = sample(count, seed=7)
    wrong = [each for each in verdicts if each.verdict == "wrong"]
    assert not wrong
    # Of 131 branches of this sample 111 were right and 20 were named.
    assert np.mean([each.verdict == "right" for each in verdicts]) > 0.7

"""Small helpers of the studies."""

import numpy as np
import pytest

from bouncing_ball.errors import ModelError
from bouncing_ball.impacts.spring_damper import Release
from bouncing_ball.studies.parameters import contact, grid


def test_grid_is_logarithmic_and_meets_its_ends():
    points = grid({"min": 0.5, "max": 50.0, "samples": 21})
    assert points[[0, -1]].tolist() == [0.5, 50.0]
    # Equal ratios, to the roundings of a power.
    assert points[1:] / points[:-1] == pytest.approx(np.full(20, 100 ** (1 / 20)), rel=1e-14)


def test_contact_has_the_damping_of_equation_16():
    touch = contact(3.0, 0.85, "force")
    assert touch.release is Release.FORCE
    assert touch.frequency_ratio == 3.0
    assert touch.damping_ratio == pytest.approx(0.05166, abs=5e-6)


def test_contact_with_a_bad_parameter(one_line):
    with pytest.raises(ModelError) as error:
        contact(3.0, 1.2, "displacement")
    one_line(error, "r = 1.2")
    with pytest.raises(ModelError) as error:
        contact(-3.0, 0.85, "displacement")
    one_line(error, "ϖ = -3.0")

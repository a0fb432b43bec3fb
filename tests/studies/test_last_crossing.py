"""Last changes of sign on a grid, closed to the last digit."""

import numpy as np

from bouncing_ball.studies.last_crossing import last_crossing

RATIOS = np.geomspace(1.0, 1e4, 9)


def test_the_last_of_several():
    def wave(ratio, _):
        return np.sin(np.log(ratio) / 2 + 1.0)

    found = last_crossing(wave, RATIOS, wave(RATIOS, 0)[np.newaxis])
    np.testing.assert_allclose(np.log(found), 2 * (np.pi - 1), rtol=1e-14)


def test_each_function_has_its_own():
    levels = np.array([0.3, 0.001, 2.0, 1e-9])

    def function(ratio, which):
        return 1 / ratio - levels[which]

    values = function(RATIOS, np.arange(4)[:, np.newaxis])
    found = last_crossing(function, RATIOS, values)
    np.testing.assert_allclose(found, [1 / 0.3, 1000.0, np.nan, np.nan], rtol=1e-14)


def test_a_gap_is_no_crossing():
    values = np.where(RATIOS < 50, 1.0, -1.0)
    values[np.abs(RATIOS - 31.6) < 1] = np.nan
    assert np.isnan(last_crossing(lambda ratio, _: 50 - ratio, RATIOS, values[np.newaxis])).all()

"""Our statements about the whole motion, beyond the paper: each with the interval of its number.

Most are about a variable of a dataset at one place, and rows of ``whole_motion.csv``. No statement
is about more than its sample: balls, places and contacts are those of its dataset.
"""

import json

import numpy as np

from bouncing_ball.attractors.period_doublings import FEIGENBAUM
from bouncing_ball.claims.claim import Claim, claim
from bouncing_ball.claims.verdict import decided
from bouncing_ball.datasets.files import rows_beside


def limits(data, name, place):
    """An estimate and its lower and upper limit at a place of a dataset, shape (3,)."""
    return np.array([data[f"{name}{end}"].sel(place).item() for end in ("", "_low", "_high")])


def _of_table(dataset, variable, place, side, bound, **given):
    """The statement that the interval of a variable is above, or below, a bound."""

    def decide(data):
        found = limits(data[dataset], variable, json.loads(place))
        return decided(found, **{side: float(bound)})

    return Claim(kind="statement", decide=decide, **given)


TABLE = [_of_table(**row) for row in rows_beside(__file__)]


def _missed(data, model, order, coefficient):
    """Largest relative difference of a model's errors from a law of this order, from ϖ = 100 on."""
    stiff = data["ext_cascades"].sel(model=model, frequency_ratio=slice(100, None))
    return abs(stiff.cascade_error * stiff.frequency_ratio**order / stiff[coefficient] - 1).max()


@claim("cascades")
def end_of_the_first_order(data):
    """the first order K_k/ϖ gives the shift of every doubling from ϖ = 100 on

    Condition: no shift differs from it by more than a tenth
    """
    return decided(_missed(data, "restitution", 1, "cascade_coefficient"), below=0.1)


@claim("cascades")
def corrected_cascades(data):
    """the error of the corrected model is of second order in 1/ϖ at every doubling

    Condition: from ϖ = 100 on it is C/ϖ² to within a hundredth, with C from two stiffer contacts
    """
    return decided(_missed(data, "corrected", 2, "cascade_second_order"), below=0.01)


@claim("cascades")
def cascade_moves_as_a_whole(data):
    """the coefficients K_k of the shift of a cascade have a limit

    Condition: for every r the last one differs from the one before by less than a hundredth
    """
    before, last = data["ext_cascades"].cascade_coefficient.values[:, -2:].T
    return decided(np.max(np.abs(last / before - 1)), below=0.01)


@claim("cascades")
def feigenbaum(data):
    """in every contact the distances of doublings tend to Feigenbaum's ratio

    Condition: the last ratio is within a hundredth of it
    """
    last = data["ext_cascades"].contact_cascade_ratio.isel(step=-1)
    return decided(abs(last / FEIGENBAUM - 1).max(), below=0.01)


@claim("cascades")
def measured_doublings(data):
    """the exact map with r = 0.5 has its period doublings where a textbook's table had them

    Condition: both amplitudes are within a hundredth

    Remark: r and the frequency of 60 Hz are assumed, because they could not be read
    """
    found = data["ext_cascades"].sel(restitution=0.5)
    return decided(abs(found.restitution_cascade / found.measured_cascade - 1).max(), below=0.01)


@claim("transients")
def longer_transients(data):
    """a ball on a contact of ϖ = 10⁴ may take ten times as long to lock as in the restitution model

    Condition: the mean lives at r = 0.6 and Λ = 3 differ by this factor, even between the limits of
    their intervals that are closest to each other
    """
    lives = (
        limits(data["ext_lives"], "mean_life", {"case": 2, "life_ratio": x}) for x in (1e4, np.inf)
    )
    contact, simple = lives
    return decided(contact / simple[[0, 2, 1]], above=10)

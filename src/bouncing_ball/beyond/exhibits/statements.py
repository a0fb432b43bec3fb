"""Our statements about the whole motion, beyond the paper: each with the interval of its number.

No statement is about more than its sample: balls, places and contacts are those of its dataset. The
statements and their bounds are ours and were chosen when the datasets were known, so that a
confirmed statement is a summary with an interval, and no prediction that was tested.
"""

import sys
from collections.abc import Mapping

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from bouncing_ball.beyond.exhibits.motion_samples import share_with_limits
from bouncing_ball.long_run.period_doublings import FEIGENBAUM
from bouncing_ball.paper.claims.claim import claim, defined_in
from bouncing_ball.paper.claims.claims import assess
from bouncing_ball.paper.claims.parameters import Digests
from bouncing_ball.paper.claims.verdict import Finding, Verdict

PARAMETERS: Digests = {
    "ext_locking": ("5663cdb1", "frequency_ratio"),
    "ext_chaos": ("aad7e794", "followed", "bands"),
    "ext_lives": ("5663cdb1", "frequency_ratio"),
    "ext_cascades": (
        "2a3e477b",
        "n",
        "restitution",
        "frequency_ratio__min",
        "frequency_ratio__max",
    ),
    "ext_means": ("47b23b1c", "frequency_ratio"),
}
"""The digests of the parameters that the statements name; other datasets may have any."""


def decided(estimate: ArrayLike, *, above: float = -np.inf, below: float = np.inf) -> Finding:
    """The finding that the interval of an estimate lies above a bound, or below one.

    ``estimate`` is a number, or a number with its lower and its upper limit. The statement is
    contradicted if the whole interval lies beyond the bound, and not decided if a part of it does,
    or if a limit is NaN.

    Examples
    --------
    >>> [str(decided([x, x - 1, x + 1], above=3).verdict) for x in (5, 3, 1)]
    ['confirmed', 'not decided', 'contradicted']
    """
    value, low, high = map(float, np.broadcast_to(estimate, 3))
    # A mean life may be infinite.
    holds = low > above and (high < below or np.isinf(below))
    fails = high <= above or low >= below
    verdict = Verdict.CONTRADICTED if fails else Verdict.NOT_DECIDED
    required = f"> {above:g}" if np.isinf(below) else f"< {below:g}"
    return Finding(value, Verdict.CONFIRMED if holds else verdict, required, low=low, high=high)


def limits(data, name, **place):
    """An estimate and its lower and upper limit at a place of a dataset, shape (3,)."""
    return np.array([data[f"{name}{end}"].sel(place).item() for end in ("", "_low", "_high")])


def same_period(data, group, ratio):
    """Share of the nodes locked in the restitution model that have this period at this ϖ, (3,)."""
    agreement = data["ext_locking"].sel(simple="restitution", motion_group=group)
    return limits(agreement, "agreement", frequency_ratio=ratio)


@claim("locking")
def short_periods_agree(data):
    """where the restitution model locks with 1 to 4 T, a contact of ϖ = 100 has the same period

    Condition: at more than nine of ten nodes in Λ and r
    """
    return decided(same_period(data, "locked, 1 to 4 T", 100), above=0.9)


@claim("locking")
def long_periods_differ(data):
    """where it locks with more than 10 T, not even a contact of ϖ = 10⁴ has the same period

    Condition: the period is the same at less than a quarter of the nodes
    """
    return decided(same_period(data, "locked, above 10 T", 1e4), below=0.25)


@claim("locking")
def prediction_ranks(data):
    """max(S/W, P) ranks the places where a contact reaches the locked orbit by the ϖ needed, and
    better than the period of the orbit alone does

    Condition: its rank correlation at these places is larger than that of the period

    Remark: places where no ϖ that was tried is enough would be one tie, and are left out
    """
    return decided(limits(data["ext_locked"], "correlation_gain", scale="max(S/w, P)"), above=0)


@claim("locking")
def dense_discontinuities(data):
    """the share of places whose locked period changes with Λ hardly falls with the change

    Condition: its exponent is below 0.1; next to a smooth boundary it is 1
    """
    return decided(limits(data["ext_locked"], "uncertainty_exponent"), below=0.1)


@claim("means")
def power_needs_more(data):
    """no stiffness up to ϖ = 10⁴ is known to make the power of the restitution model right to 1 %
    at most places

    Condition: the share of the nodes in Λ and r known to be right at ϖ = 10⁴ is below a half
    """
    right = data["ext_means"].sel(simple="restitution", mean="power")
    return decided(limits(right, "right", frequency_ratio=1e4), below=0.5)


@claim("basins")
def compliant_contacts_throw(data):
    """at ϖ = 2, r = 0.85 and Λ = 0.9 no ball comes to rest on the contact, as many do in the
    restitution model

    Condition: the basin of permanent contact has less than a fiftieth of the starts on the contact
    """
    on_contact = data["ext_basins"].sel(case=0, model="spring-damper")
    return decided(limits(on_contact, "basin_share", motion="permanent contact"), below=0.02)


@claim("basins")
def fractal_boundaries(data):
    """at the same place the boundaries of the basins on the contact are fractal

    Condition: their exponent of uncertainty is below 1
    """
    on_contact = data["ext_basins"].sel(case=0, model="spring-damper")
    return decided(limits(on_contact, "uncertainty_exponent"), below=1)


@claim("basins")
def smooth_when_stiffer(data):
    """at ϖ = 30, r = 0.5 and Λ = 1.45 the boundary of the basins is smooth on the scales of its
    dataset

    Condition: its exponent of uncertainty is above 0.8; that of a smooth curve is 1
    """
    on_contact = data["ext_basins"].sel(case=1, model="spring-damper")
    return decided(limits(on_contact, "uncertainty_exponent"), above=0.8)


@claim("transients")
def stiff_contacts_lock(data):
    """at r = 0.6 and Λ = 3 the balls on a contact of ϖ = 10⁴ lock, though doubles do not tell after
    which period

    Condition: less than a hundredth of the random starts is chaotic to the last of the impacts of
    its dataset
    """
    shares = data["ext_lives"].sel(case=2, life_ratio=1e4)
    return decided(limits(shares, "chaotic_share"), below=0.01)


def locked_later(chaos):
    """Shares of the balls that had not stuck twice after the fewest impacts and have after the
    most, in each range of r, with their limits, shape (band, 3).
    """
    first, last = (chaos.locked_share.isel(followed=k) for k in (0, -1))
    before = np.rint(chaos.band_nodes * first).astype(int)
    after = np.rint(chaos.band_nodes * last).astype(int)
    balls = zip((chaos.band_nodes - before).values, (after - before).values, strict=True)
    level = float(chaos.attrs["confidence"])
    return np.array([share_with_limits(np.arange(left) < locked, level) for left, locked in balls])


@claim("transients")
def seeming_chaos_locks(data):
    """with r from 0.5 to 0.9 most balls of the restitution model that have neither repeated nor
    stuck twice after 500 impacts, and whose neighbours separate, stick twice after long transients

    Condition: in each range of r of its dataset more than half of them have stuck twice within 10⁴
    impacts

    Remark: the number found and both limits are the smallest of those of the ranges; for smaller r
    the statement does not hold
    """
    chaos = data["ext_chaos"]
    inside = (chaos.band > 0) & (chaos.band_low >= 0.5)
    return decided(locked_later(chaos)[inside.values].min(axis=0), above=0.5)


@claim("transients")
def chaos_beside_locking(data):
    """at r = 0.5 and Λ = 2.5 a ball of the restitution model may stay chaotic instead of locking

    Condition: more than one of a hundred random starts is chaotic to the last of the impacts of its
    dataset
    """
    shares = data["ext_lives"].sel(case=1, life_ratio=np.inf)
    return decided(limits(shares, "chaotic_share"), above=0.01)


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
    """for n = 1 and the displacement release, the coefficients K_k of the shift of a cascade seem
    to tend to a limit

    Condition: for every r the last one differs from the one before by less than a hundredth

    Remark: a few values cannot prove a limit
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


@claim("transients")
def transients_alike(data):
    """balls on a contact of ϖ = 10⁴ do not take longer to lock than in the restitution model

    Condition: the ratio of the mean lives at r = 0.6 and Λ = 3 is below 1, even between the limits
    of their intervals that are closest to each other
    """
    lives = data["ext_lives"].sel(case=2)
    contact = limits(lives, "mean_life", life_ratio=1e4)
    simple, simple_low, simple_high = limits(lives, "mean_life", life_ratio=np.inf)
    return decided(contact / np.array([simple, simple_high, simple_low]), below=1)


def statements(data: Mapping[str, xr.Dataset]) -> xr.Dataset:
    """The verdict on each of our statements about the whole motion.

    The arguments, the dataset and the errors are those of :func:`assess`. Each number has the unit
    of the variable from which its statement takes it.
    """
    return assess([*defined_in(sys.modules[__name__])], data, PARAMETERS)

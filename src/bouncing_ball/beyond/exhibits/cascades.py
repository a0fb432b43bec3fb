"""Two cascades on contacts of finite stiffness (beyond the paper).

The T-periodic orbits into which permanent contact continues get one flight after another as Λ
grows. Along the n-T orbits the period doubles again and again, at values of Λ that the contact
shifts. The errors of these values are relative to the simple model as in Eqs. 37-38, with their
sign: (Λ_SD - Λ)/Λ, with Λ of the restitution model, or of the corrected one, at the same doubling.
"""

from typing import Annotated, Self

import numpy as np
import xarray as xr
from pydantic import Field, model_validator

from bouncing_ball.accuracy.simple_models import exact_and_simple_models
from bouncing_ball.accuracy.thresholds import last_zero
from bouncing_ball.beyond.motions.cascade_of_flights import (
    balls_behind_the_top,
    openings,
    stiff_openings,
)
from bouncing_ball.beyond.motions.period_doublings import MOST, cascade
from bouncing_ball.datasets.parameters import (
    Family,
    LossyRestitution,
    Many,
    Parameters,
    Span,
    number,
)
from bouncing_ball.datasets.variables import Variable, described
from bouncing_ball.long_run.destination import final_motions
from bouncing_ball.models.contact_model import ContactModel
from bouncing_ball.models.damping import Release, damping_ratio
from bouncing_ball.models.spring_damper import SpringDamper
from bouncing_ball.periodic.one_impact import n_t

VARIABLES = {
    "flights": Variable("flights of the orbit in a period", symbol="k"),
    "opening_amplitude": Variable(
        "amplitude at which the orbit gets one flight more", symbol="Λ_k"
    ),
    "opening_multiplier": Variable(
        "larger modulus of the multipliers at an opening", budget=1e-10, scale="1"
    ),
    "opening_excess": Variable(
        "ϖ² times the distance of an opening from Λ_SD", symbol="E_k", budget=1e-10
    ),
    "stiff_opening": Variable(
        "ϖ² times the distance of an opening from Λ_SD, limit for ϖ → ∞", symbol="E_k"
    ),
    "opening": Variable("opening that is compared with the next one", symbol="k"),
    "stiff_opening_ratio": Variable("r² E_{k+1}/E_k of the limits for ϖ → ∞"),
    "leaving_ratio": Variable("frequency ratio of contacts on which a ball leaves", symbol="ϖ"),
    "leaving": Variable(
        "smallest ϖ²(Λ - Λ_SD) up to the second opening at which a ball is not known to end on an "
        "orbit of one period",
        symbol="E",
    ),
    "leaving_periods": Variable(
        "periods of the table in which the motion repeats there; 0 if that is not known"
    ),
    "doubling": Variable("period doubling of the orbit of so many doubled periods", symbol="k"),
    "step": Variable("step between two period doublings", symbol="k"),
    "restitution_cascade": Variable(
        "amplitude of the period doublings, restitution model", symbol="Λ_k", budget=1e-13
    ),
    "cascade_ratio": Variable(
        "ratio of successive distances of period doublings, restitution model", budget=1e-09
    ),
    "contact_cascade_ratio": Variable(
        "ratio of successive distances of period doublings, spring-damper", budget=1e-08
    ),
    "cascade_error": Variable(
        "relative error of a simple model in the amplitude of the period doublings, with its sign",
        budget=1e-10,
    ),
    "cascade_zero": Variable(
        "frequency ratio at which the restitution model's error at a period doubling is zero",
        symbol="ϖ",
        budget=1e-07,
    ),
    "cascade_coefficient": Variable(
        "coefficient of the restitution model's error at the period doublings",
        symbol="K_m",
        budget=1e-06,
    ),
    "cascade_second_order": Variable(
        "coefficient of the corrected model's error at the period doublings",
        symbol="C_k",
        budget=0.001,
    ),
    "textbook_cascade": Variable(
        "amplitude of the period doublings in the computed diagram of a textbook, at an assumed "
        "frequency",
        symbol="Λ",
    ),
}


class Flights(Parameters):
    """A grid of ϖ for contacts of the first r, further r whose limits for stiff contacts are
    computed, and the number of openings that are followed.
    """

    restitution: Many[LossyRestitution]
    frequency_ratio: Span
    flights: Annotated[int, number("openings that are followed", ge=2, le=6)]


def cascade_of_flights(parameters: Flights, release: Release) -> xr.Dataset:
    """The amplitudes above which the T-periodic orbit above Λ_SD has one more flight per period.

    The dataset has, for the first r, ``threshold_amplitude`` Λ_SD (ϖ,). ``opening_amplitude``
    (flights, ϖ) is the lowest Λ up to which the orbit has this number of flights, and
    ``opening_multiplier`` the larger modulus of its multipliers there; both are NaN where no stable
    orbit was found: see :func:`bouncing_ball.beyond.motions.cascade_of_flights.openings`.
    ``opening_excess`` is E = ϖ²(Λ - Λ_SD) there, ``stiff_opening`` (restitution, flights) its limit
    for stiff contacts, and ``stiff_opening_ratio`` (restitution, opening) r² times the ratio of the
    limits of one opening and the one before.
    ``leaving`` (restitution, leaving_ratio) is the smallest E, of 40 equal steps up to the limit of
    the second opening, at which a ball that is set down behind the top of the table is not known to
    end on an orbit of one period, NaN if there is none. ``leaving_periods`` is the period of its
    motion, 0 if it is not known within the impacts followed, as where the motion is chaotic.
    ``leaving_ratio`` are some of the ϖ. All except the first are NaN, or 0, unless the release is
    the displacement release.
    """
    restitution = np.array(parameters.restitution)
    ratio = parameters.frequency_ratio.grid()
    zeta = damping_ratio(restitution)
    most = parameters.flights
    every = SpringDamper(ratio, zeta[:, np.newaxis], release)
    law = every[0]
    some = slice(None, None, max(1, (ratio.size - 1) // _LEAVING_RATIOS))
    amplitude = np.full((most, ratio.size), np.nan)
    multiplier = np.full((most, ratio.size), np.nan)
    stiff = np.full((zeta.size, most), np.nan)
    excess = np.full((zeta.size, ratio[some].size), np.nan)
    periods = np.zeros(excess.shape, dtype=int)
    if release is Release.DISPLACEMENT:
        amplitude, multiplier = (x[0] for x in openings(zeta[:1], ratio, most))
        stiff = np.stack([stiff_openings(z, most) for z in zeta])
        excess, periods = _leaving(every[:, some], stiff[:, 1])
    dims = ("flights", "frequency_ratio")
    threshold = ContactModel(law).permanent_contact_threshold()
    growth = np.square(restitution)[:, np.newaxis] * stiff[:, 1:] / stiff[:, :-1]
    return described(
        {
            "threshold_amplitude": ("frequency_ratio", threshold),
            "opening_amplitude": (dims, amplitude),
            "opening_multiplier": (dims, multiplier),
            "opening_excess": (dims, ratio**2 * (amplitude - threshold)),
            "stiff_opening": (("restitution", "flights"), stiff),
            "stiff_opening_ratio": (("restitution", "opening"), growth),
            "leaving": (("restitution", "leaving_ratio"), excess),
            "leaving_periods": (("restitution", "leaving_ratio"), periods),
        },
        coords={
            "restitution": restitution,
            "flights": np.arange(1, most + 1),
            "opening": np.arange(1, most),
            "frequency_ratio": ratio,
            "leaving_ratio": ratio[some],
        },
        variables=VARIABLES,
    )


def _leaving(law: SpringDamper, second: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The smallest E up to ``second`` (r,) at which balls on contacts, shape (r, ϖ), are not known
    to end on an orbit of one period, and the period of their motion, 0 if it is not known; NaN and
    0 if there is none.
    """
    excess = second[:, np.newaxis] * np.linspace(0, 1, _PLACES + 1)[1:, np.newaxis, np.newaxis]
    threshold = ContactModel(law).permanent_contact_threshold()
    amplitude = threshold + excess / np.square(law.frequency_ratio)
    found = balls_behind_the_top(law, amplitude)
    every_period = found.periods.copy()
    # Orbits that attract slowly need more impacts; these balls are followed from where they are, if
    # the ball does not leave at a smaller E.
    left = np.logical_or.accumulate(every_period > 1)
    unknown = np.nonzero((every_period == 0) & ~left)
    slow = ContactModel(law[unknown[1:]])
    ends = found.end_phase[unknown], found.end_velocity[unknown]
    further = final_motions(slow, amplitude[unknown], *ends, impacts=_FURTHER)
    every_period[unknown] = further.periods
    leaves = every_period != 1
    first = np.argmax(leaves, axis=0)[np.newaxis]
    never = ~leaves.any(axis=0)
    at = np.take_along_axis(np.broadcast_to(excess, leaves.shape), first, axis=0)[0]
    periods = np.take_along_axis(every_period, first, axis=0)[0]
    return np.where(never, np.nan, at), np.where(never, 0, periods)


_PLACES = 40
# Further impacts of balls whose period is not known.
_FURTHER = 1000
# The intervals between the ϖ at which it is sought where balls leave.
_LEAVING_RATIOS = 24
_GRAVITY = 9.80665
"""Standard gravity in m/s²."""


class Textbook(Parameters):
    """Period doublings over the amplitude of a table in a diagram, at an assumed frequency."""

    frequency: Annotated[float, number("frequency of the table", "Hz", gt=0, le=1e6)]
    amplitudes: Many[Annotated[float, number("amplitude of a doubling", "m", gt=0, le=1)]]


class Cascades(Parameters):
    """Cascades of period doublings of the n-T orbits, for several r and a grid of ϖ."""

    n: Family
    restitution: Many[LossyRestitution]
    frequency_ratio: Span
    doublings: Annotated[
        int,
        Field(
            description="period doublings of each cascade; the ratio needs three, and beyond "
            f"{MOST} rounding decides",
            ge=3,
            le=MOST,
        ),
    ]
    textbook: Textbook

    @model_validator(mode="after")
    def _computed(self) -> Self:
        count = len(self.textbook.amplitudes)
        if count > self.doublings:
            raise ValueError(
                f"textbook.amplitudes has {count} values, more than doublings = {self.doublings}"
            )
        return self


_STIFF = np.array([1000.0, 2000.0])
"""Two ϖ from which K is computed: higher orders contribute at smaller ϖ, and rounding errors at
much larger ϖ."""


def cascades(parameters: Cascades, release: Release) -> xr.Dataset:
    """Λ at the period doublings of the orbits of 2ᵏ n table periods, k = 0, 1, …

    ``restitution_cascade`` (restitution, doubling) is Λ of the restitution model.
    ``cascade_ratio`` (restitution, step) are the ratios of successive distances in Λ, which tend to
    Feigenbaum's number, and ``contact_cascade_ratio`` (restitution, step, ϖ) those of the contact.
    ``cascade_error`` (model, restitution, doubling, ϖ) is the signed relative error of each simple
    model, and ``cascade_zero`` (restitution, doubling) the largest ϖ at which that of the
    restitution model is zero. To leading order, the error of the restitution model is K/ϖ, where K
    is ``cascade_coefficient`` (restitution, doubling), and that of the corrected model is C/ϖ²,
    where C is ``cascade_second_order``. Both are measured at two stiff contacts, and the next order
    is eliminated (Richardson). Values are NaN where a doubling was not found. ``textbook_cascade``
    (doubling,) is Λ in the textbook's diagram.
    """
    r = np.array(parameters.restitution)
    ratios = parameters.frequency_ratio.grid()
    with_stiff = np.concatenate([ratios, _STIFF])
    contact = SpringDamper.from_restitution(r[:, np.newaxis], with_stiff, release)
    exact_model, _, corrected_model = exact_and_simple_models(contact)
    # The restitution model has the r of a free impact on the contact and does not depend on ϖ.
    _, restitution_model, _ = exact_and_simple_models(contact[:, :1])
    # Arrays over (doubling, restitution, ϖ).
    simple, corrected, exact = (
        cascade(n_t.period_doubling(model, parameters.n), parameters.doublings)
        for model in (restitution_model, corrected_model, exact_model)
    )
    simple_error = exact.amplitude / simple.amplitude - 1
    corrected_error = exact.amplitude / corrected.amplitude - 1
    errors = np.stack([simple_error, corrected_error])[..., : ratios.size]
    of_contact = exact.ratios()[..., : ratios.size]

    def single(ratio: np.ndarray, row: np.ndarray) -> np.ndarray:
        k, of_r = np.divmod(row, r.size)
        model = exact_and_simple_models(SpringDamper.from_restitution(r[of_r], ratio, release))[0]
        there = cascade(n_t.period_doubling(model, parameters.n), int(k.max()) + 1)
        rows = np.arange(ratio.size)
        return there.amplitude[k, rows] / simple.amplitude[k, of_r, 0] - 1

    zeros = last_zero(single, ratios, errors[0].reshape(-1, ratios.size))
    return described(
        {
            "restitution_cascade": (("restitution", "doubling"), simple.amplitude[..., 0].T),
            "textbook_cascade": ("doubling", _of_textbook(parameters)),
            "cascade_ratio": (("restitution", "step"), simple.ratios()[..., 0].T),
            "contact_cascade_ratio": (
                ("restitution", "step", "frequency_ratio"),
                of_contact.swapaxes(0, 1),
            ),
            "cascade_error": (
                ("model", "restitution", "doubling", "frequency_ratio"),
                errors.swapaxes(1, 2),
            ),
            "cascade_zero": (("restitution", "doubling"), zeros.reshape(-1, r.size).T),
            "cascade_coefficient": (
                ("restitution", "doubling"),
                _stiff_coefficient(simple_error, order=1).T,
            ),
            "cascade_second_order": (
                ("restitution", "doubling"),
                _stiff_coefficient(corrected_error, order=2).T,
            ),
        },
        coords={
            "model": ["restitution", "corrected"],
            "restitution": r,
            "doubling": np.arange(parameters.doublings),
            "step": np.arange(1, parameters.doublings - 1),
            "frequency_ratio": ratios,
        },
        variables=VARIABLES,
    )


def _of_textbook(parameters: Cascades) -> np.ndarray:
    """Λ = aΩ²/g of the doublings of the textbook, NaN for further doublings, shape (doublings,)."""
    known = np.array(parameters.textbook.amplitudes) / _GRAVITY
    known *= (2 * np.pi * parameters.textbook.frequency) ** 2
    return np.pad(known, (0, parameters.doublings - known.size), constant_values=np.nan)


def _stiff_coefficient(error: np.ndarray, order: int) -> np.ndarray:
    """The limit of the error times ϖ to the order, from the last two ϖ, :data:`_STIFF`."""
    once, twice = np.moveaxis(error[..., -2:] * _STIFF**order, -1, 0)
    return 2 * twice - once

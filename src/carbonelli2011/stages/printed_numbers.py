"""Stage: all printed numbers under hypotheses on what the authors computed.

A hypothesis is another damping ratio, another release, no gravity in contact, another
stability, digits that were cut off, or the formulas of the restitution model. Each is judged by all
23 printed numbers, in units of their last digits.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from scipy.optimize.elementwise import find_root

from bouncing_ball import restitution
from bouncing_ball.continuation import at_amplitude, at_bifurcation, bifurcations, correct, walk
from bouncing_ball.errors import (
    enough_from,
    orbits_along,
    permanent_contact_error,
    relative_error,
    threshold,
)
from bouncing_ball.orbits import Family
from bouncing_ball.spring_damper import RELEASES, Contact, damping_ratio
from carbonelli2011.paper import (
    BOUNDS,
    LIMIT,
    PARAMETERS,
    PRINTED,
    end_of_range,
    printed_table,
)
from paper_replication.verdicts import ROUNDING

DIGIT = 0.001
"""The last digit of Table 1."""
R_OF_TABLE_1 = PARAMETERS["table1"]["restitution"]
R_OF_THRESHOLDS = PARAMETERS["fig14"]["restitution"]
PRINTED_DAMPING = {R_OF_TABLE_1: 0.052, R_OF_THRESHOLDS: 0.136}
"""ζ as the captions of Figs. 8 to 15 round it."""
SCAN = np.geomspace(2.0, 500.0, 25)
EXPONENTS = (1, 2, 3, 4, 5, 6)
"""Exponents that the largest frequency ratio may have."""
AS_THEY_STAND = "equations as they stand"


def reproduced(units: NDArray) -> NDArray[np.bool_]:
    """Whether numbers round to the printed ones, from their distances in units of the digit."""
    return abs(units) <= 0.5 + ROUNDING


@dataclass(frozen=True)
class Impact:
    """A contact by its damping ratio as a function of r, its release, and the weight in contact."""

    damping: Callable[[float], float | NDArray] = damping_ratio
    release: str = "displacement"
    weight: float = 1.0

    def contact(self, r: float, ratios: NDArray) -> Contact:
        """The contact at frequency ratios, for impacts with the restitution r."""
        return Contact(ratios, np.array([[float(self.damping(r))]]), self.release, self.weight)


IMPACTS = {
    AS_THEY_STAND: Impact(),
    "damping as printed": Impact(PRINTED_DAMPING.__getitem__),
    "damping to first order": Impact(lambda r: -np.log(r) / np.pi),
    "force release": Impact(release="force"),
    "force release, equal r": Impact(lambda r: damping_ratio(r, "force"), "force"),
    "no gravity in contact": Impact(weight=0.0),
}
"""The hypotheses that differ in the contact. With "equal r" it has the damping with which a free
impact has the restitution r.
"""


# Table 1


def ends_of_ranges(n: NDArray, ratios: NDArray) -> dict[str, NDArray]:
    """Both ends of the ranges of Table 1 for each of `IMPACTS`, shape (ϖ, n, 2)."""
    ends_by_name: dict[str, NDArray] = {}
    for release in RELEASES:
        impacts = {name: impact for name, impact in IMPACTS.items() if impact.release == release}
        # One walk along the contacts has the families of all of them.
        damping = np.array([float(impact.damping(R_OF_TABLE_1)) for impact in impacts.values()])
        weight = np.array([impact.weight for impact in impacts.values()])
        contact = Contact(
            ratios,
            np.repeat(damping, n.size)[:, np.newaxis],
            release,
            np.repeat(weight, n.size)[:, np.newaxis],
        )
        families = np.tile(n, len(impacts))
        kinds = [bifurcations(families, kind, contact)[0] for kind in BOUNDS]
        ends = np.stack(kinds, axis=-1).reshape(len(impacts), n.size, ratios.size, 2)
        ends_by_name |= dict(zip(impacts, ends.swapaxes(1, 2), strict=True))
    return ends_by_name


def high_bounce_doublings(n: NDArray, ratios: NDArray) -> NDArray:
    """The period doublings by the stability of the high-bounce approximation, shape (ϖ, n)."""
    family = Family(n[:, np.newaxis], IMPACTS[AS_THEY_STAND].contact(R_OF_TABLE_1, ratios))
    x = restitution.saddle_node(family.n, R_OF_TABLE_1)
    return walk(family, at_bifurcation(high_bounce_test), x, np.ones_like(x))[0].T


def high_bounce_test(family: Family, y: NDArray) -> NDArray:
    """1 + trace + determinant of a return map whose flight ends at the height at which it began.

    This is the neglect of Holmes' map: a flight of duration L obeys z′_b L - L²/2 = 0 in place of
    Eq. 25, so that L changes by -L/z′_i times the change of z′_b.
    """
    later, _, velocity = family.release_map(y)
    longer = -(family.period - family.contact_duration(y)) / y[2] * velocity
    phase = later + longer
    velocity = velocity - longer
    determinant = phase[0] * velocity[1] - phase[1] * velocity[0]
    return 1 + phase[0] + velocity[1] + determinant


def stiff_reproduced(n: NDArray, printed: NDArray) -> NDArray:
    """How many ends of the stiffest row each of `EXPONENTS` reproduces, with the stability of the
    high-bounce approximation.
    """
    ratios = 10.0 ** np.array(EXPONENTS)
    contact = IMPACTS[AS_THEY_STAND].contact(R_OF_TABLE_1, ratios)
    nodes = bifurcations(n, "saddle-node", contact)[0].T
    row = np.stack([nodes, high_bounce_doublings(n, ratios)], axis=-1)
    return reproduced((row - printed) / DIGIT).sum(axis=(1, 2))


# The other printed numbers


def other_numbers(impact: Impact) -> dict[str, float]:
    """The numbers of `PRINTED` that a contact decides, by their names."""
    r = np.array([[R_OF_THRESHOLDS]])
    amplitude = np.ones((1, 1))
    family = Family(np.ones((1, 1)), impact.contact(R_OF_THRESHOLDS, SCAN))
    orbits = orbits_along(family, amplitude)
    enough = enough_from(family, orbits, r, amplitude, LIMIT)
    zeta = float(impact.damping(R_OF_THRESHOLDS))
    resting = threshold(SCAN, permanent_contact_error(SCAN, zeta, impact.release), LIMIT)
    # Without weight there is no permanent contact.
    from_rest = resting.ratio if impact.weight else np.nan
    compliant = Family(1, impact.contact(R_OF_THRESHOLDS, np.ones(1)))
    bounce = compliant.apparent_restitution(orbits_along(compliant, 1.2 * amplitude))
    return {
        "height threshold": enough[0, 0],
        "permanent contact threshold": from_rest,
        "compliant end of 1.2": bounce[0, 0],
        "damping of 0.85": float(impact.damping(R_OF_TABLE_1)),
        "damping of 0.65": zeta,
    }


def damping_of_82() -> NDArray:
    """The ζ with which the height threshold is 81.5 and 82.5, between which it is printed as 82."""
    ratios = np.array([81.5, 82.5])
    contact = Contact.of_restitution(ratios, R_OF_THRESHOLDS)
    highest = restitution.max_height(1, R_OF_THRESHOLDS, 1.0)
    orbits = orbits_along(Family(1, contact), np.ones((1, 1)))[:, 0]

    def excess(zeta, which):
        family = Family(1, Contact(ratios[which], zeta))
        y = correct(family, orbits[:, which], at_amplitude(1.0))
        return relative_error(family.summit(y), highest) - LIMIT

    return find_root(excess, (0.13, 0.14), args=(np.arange(2),)).x


# All of them


@dataclass(frozen=True)
class Hypothesis:
    """The printed numbers that the authors would have found, and whose contact they had.

    Attributes
    ----------
    ends : the ends of Table 1, shape (ϖ, n, 2).
    others : the numbers of `other_numbers`.
    contact : the name of the contact in `IMPACTS`, "" without one.
    """

    ends: NDArray
    others: dict[str, float]
    contact: str = AS_THEY_STAND

    def numbers(self) -> NDArray:
        """All of them, first those of Table 1."""
        return np.append(self.ends, [*self.others.values()])

    def cut_off(self, digits: NDArray) -> "Hypothesis":
        """The same after the last printed digit was not rounded."""
        cut = np.floor(self.numbers() / digits) * digits
        ends, others = np.split(cut, [self.ends.size])
        return Hypothesis(
            ends.reshape(self.ends.shape), dict(zip(self.others, others.tolist(), strict=True))
        )


def all_hypotheses(n: NDArray, ratios: NDArray) -> dict[str, Hypothesis]:
    """Each hypothesis but that of digits that were cut off, by its name."""
    ends = ends_of_ranges(n, ratios)
    hypotheses = {
        name: Hypothesis(ends[name], other_numbers(impact), name)
        for name, impact in IMPACTS.items()
    }

    plain = hypotheses[AS_THEY_STAND]
    approximate = np.stack([plain.ends[..., 0], high_bounce_doublings(n, ratios)], axis=-1)
    in_one_row = np.concatenate([approximate[:1], plain.ends[1:]])
    hypotheses["high-bounce stability"] = Hypothesis(approximate, plain.others)
    hypotheses["high-bounce stability of the stiff row"] = Hypothesis(in_one_row, plain.others)

    first = restitution.saddle_node(n, R_OF_TABLE_1)
    last = restitution.holmes_period_doubling(n, R_OF_TABLE_1)
    formulas = np.broadcast_to(np.stack([first, last], axis=-1), plain.ends.shape)
    unknown = dict.fromkeys(plain.others, np.nan)
    hypotheses["Eqs. 7 and 8 in all rows"] = Hypothesis(formulas, unknown, "")
    return hypotheses


def hypotheses(parameters: dict) -> xr.Dataset:
    """All printed numbers under each hypothesis, in order of decreasing agreement."""
    printed = printed_table()
    n = printed.n.values
    ratios = printed.frequency_ratio.values
    ends = printed.stack(number=printed.dims).number.values
    table = all_hypotheses(n, ratios)
    plain = table[AS_THEY_STAND]
    decided = [*plain.others]
    texts = [*printed.values.ravel().tolist(), *(PRINTED[name] for name in decided)]
    digits = np.array([10.0 ** -len(text.partition(".")[2]) for text in texts])

    table["digits cut off"] = plain.cut_off(digits)

    computed = np.stack([hypothesis.numbers() for hypothesis in table.values()])
    units = (computed - np.array(texts, dtype=float)) / digits
    # The rows of the compliant contacts, in which most hypotheses differ.
    compliant = units[:, plain.ends[0].size : plain.ends.size]
    distances = (plain.ends - printed.values.astype(float)) / DIGIT
    over = ("hypothesis", "number")
    data = xr.Dataset(
        {
            "found": (over, computed),
            "deviation_units": (over, units),
            "agrees": (over, reproduced(units)),
            "reproduced": ("hypothesis", reproduced(units).sum(axis=1)),
            "compliant_reproduced": ("hypothesis", reproduced(compliant).sum(axis=1)),
            "rms_difference": ("hypothesis", np.sqrt((compliant**2).mean(axis=1))),
            "largest_difference": ("hypothesis", abs(compliant).max(axis=1)),
            "printed_text": ("number", texts),
            "row": ("number", [*(ratio for ratio, _, _ in ends), *[np.nan] * len(decided)]),
            "contact_of": ("hypothesis", [hypothesis.contact for hypothesis in table.values()]),
            "damping_of_82": ("end", damping_of_82()),
            "stiff_reproduced": ("exponent", stiff_reproduced(n, printed.values[0].astype(float))),
            "below_orbits": int((distances[..., 0] > 0.5 + ROUNDING).sum()),
            "mean_difference": ("n", distances[1:].mean(axis=(0, 2))),
        },
        {
            "hypothesis": list(table),
            "number": [*(end_of_range(*end) for end in ends), *decided],
            "exponent": list(EXPONENTS),
            "n": n,
        },
    )
    return data.sortby([-data.reproduced, data.rms_difference])


STAGE = {"hypotheses": hypotheses}

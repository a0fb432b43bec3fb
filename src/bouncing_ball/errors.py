"""How wrong the restitution model is, and from which stiffness on it is right (Eqs. 37 and 38).

The relative error of a quantity is |spring-damper - restitution| / |restitution|, as the paper has
it. The threshold of a tolerance is the frequency ratio ϖ from which on the error stays within it.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq, minimize_scalar
from scipy.optimize.elementwise import find_root

from bouncing_ball import restitution
from bouncing_ball.continuation import (
    WALK_START,
    Condition,
    at_amplitude,
    at_bifurcation,
    bifurcations,
    correct,
    stable_orbits,
    walk,
)
from bouncing_ball.orbits import Family
from bouncing_ball.restitution import Numbers
from bouncing_ball.spring_damper import Contact, damping_ratio, permanent_contact


class Error(NamedTuple):
    """The relative error of one quantity along ϖ.

    ``values`` are those at the ratios of a scan, and ``between(ratio, i)`` computes one between
    the ratios i and i + 1.
    """

    values: NDArray
    between: Callable[[float, int], float]


class Threshold(NamedTuple):
    """A frequency ratio, and how it was found.

    The status is ``found``; ``within`` if the error is within the tolerance at every ratio of the
    scan; and ``outside`` if it is not so at the largest, or if the error jumps into the tolerance
    because there is no orbit at the ratio before. The ratio is NaN if it is not found.
    """

    ratio: float
    status: str


def relative_error(value: Numbers, reference: Numbers) -> NDArray:
    """Relative error of the restitution model, whose value is the reference (Eqs. 37 and 38).

    >>> float(relative_error(0.99, 1.0).round(12))
    0.01
    """
    return np.abs(np.asarray(value) - reference) / np.abs(reference)


def threshold(ratios: NDArray, error: Error, tolerance: float) -> Threshold:
    """The frequency ratio from which on an error stays within a tolerance.

    The last ratio of the scan whose error exceeds the tolerance begins the interval in which the
    threshold is located. Two crossings between two neighbours are not noticed.

    >>> grid = np.geomspace(1, 1000, 7)
    >>> found = threshold(grid, Error(1 / grid, lambda ratio, i: 1 / ratio), 0.02)
    >>> round(found.ratio, 9), found.status
    (50.0, 'found')
    """
    outside = np.flatnonzero(~(error.values <= tolerance))
    if outside.size == 0:
        return Threshold(np.nan, "within")
    last = int(outside[-1])
    if last + 1 == ratios.size or np.isinf(error.values[last]):
        return Threshold(np.nan, "outside")
    place = brentq(
        lambda logarithm: error.between(np.exp(logarithm), last) - tolerance,
        np.log(ratios[last]),
        np.log(ratios[last + 1]),
        xtol=1e-14,
    )
    return Threshold(float(np.exp(place)), "found")


def permanent_contact_error(ratios: NDArray, zeta: Numbers, release: str) -> Error:
    """The error of the threshold of permanent contact (Eq. 38)."""

    def error(ratio):
        found = permanent_contact(ratio, zeta, release)
        return relative_error(found, restitution.PERMANENT_CONTACT)

    return Error(error(ratios), lambda ratio, i: float(error(ratio)))


def orbit_errors(family: Family, orbits: NDArray, r: float, amplitude: float) -> dict[str, Error]:
    """The errors of quantities of n-T orbits at an amplitude along ϖ (Eq. 37), by their names."""
    n = family.n
    phase = restitution.impact_phase(n, r, amplitude)
    quantities: dict[str, tuple[Callable[[Family, NDArray], NDArray], Numbers]] = {
        "max_height": (Family.max_height, restitution.max_height(n, r, amplitude)),
        "bounce_velocity": (Family.bounce_velocity, restitution.bounce_velocity(n)),
        "phase": (lambda family, y: y[1], phase),
        "apparent_restitution": (Family.apparent_restitution, r),
    }
    condition = at_amplitude(amplitude)
    return {
        name: _along(family, orbits, condition, value, reference)
        for name, (value, reference) in quantities.items()
    }


def bifurcation_errors(n: int, r: float, ratios: NDArray, release: str) -> dict[str, Error]:
    """The errors of the amplitudes of both bifurcations, by their names."""
    kinds = {
        "saddle_node": ("saddle-node", Family.saddle_node_test, restitution.saddle_node(n, r)),
        "period_doubling": (
            "period doubling",
            Family.period_doubling_test,
            restitution.period_doubling(n, r),
        ),
    }
    contact = Contact(ratios, damping_ratio(r), release)
    found = {}
    for name, (kind, test, reference) in kinds.items():
        orbits = bifurcations(n, kind, contact)[:, 0]
        condition = at_bifurcation(test)
        family = Family(n, contact)
        found[name] = _along(family, orbits, condition, lambda family, y: y[0], reference)
    return found


def _along(
    family: Family,
    orbits: NDArray,
    condition: Condition,
    value: Callable[[Family, NDArray], NDArray],
    reference: Numbers,
) -> Error:
    """The error of a quantity of the orbits of a scan, shape (4, ratios).

    The ratios of the scan are those of the family's contact.
    """
    ratios = np.asarray(family.contact.frequency_ratio)

    def error(family, y):
        return relative_error(value(family, y), reference)

    def between(ratio, i):
        one = replace(family, contact=replace(family.contact, frequency_ratio=ratio))
        part = np.log(ratio / ratios[i]) / np.log(ratios[i + 1] / ratios[i])
        guess = orbits[:, i] + part * (orbits[:, i + 1] - orbits[:, i])
        return float(error(one, correct(one, guess, condition)))

    # Where there is no orbit, the restitution model is as wrong as can be.
    values = error(family, orbits)
    return Error(np.where(np.isnan(values), np.inf, values), between)


def errors(
    quantities: Sequence[str], n: int, r: float, amplitude: float, ratios: NDArray, release: str
) -> dict[str, Error]:
    """The errors of the quantities with these names, of all that can be compared."""
    known: dict[str, Error] = {}
    if set(quantities) - {"saddle_node", "period_doubling", "permanent_contact"}:
        family = Family(n, Contact(ratios, damping_ratio(r), release))
        orbits = stable_orbits(n, r, amplitude, ratios, release)[:, 0]
        known |= orbit_errors(family, orbits, r, amplitude)
    if {"saddle_node", "period_doubling"} & set(quantities):
        known |= bifurcation_errors(n, r, ratios, release)
    known["permanent_contact"] = permanent_contact_error(ratios, damping_ratio(r), release)
    return {name: known[name] for name in quantities}


COMPARED = ("max_height", "bounce_velocity", "apparent_restitution", "phase_in_periods")
"""The quantities of an orbit in the first axis of `errors_of_orbits`."""


def errors_of_orbits(family: Family, y: NDArray, r: Numbers, amplitude: Numbers) -> NDArray:
    """The errors of the quantities `COMPARED` on orbits y at amplitudes Λ, shape (4, ...).

    They are relative to the restitution model with r, but for the phase, whose error is a share of
    a period of the table. The greatest height is that of the flight.
    """
    n = family.n
    phase = restitution.impact_phase(n, r, amplitude)
    errors = (
        relative_error(family.summit(y), restitution.max_height(n, r, amplitude)),
        relative_error(family.bounce_velocity(y), restitution.bounce_velocity(n)),
        relative_error(family.apparent_restitution(y), r),
        np.abs(y[1] - phase) / (2 * np.pi),
    )
    return np.stack(np.broadcast_arrays(*errors))


def orbits_along(family: Family, amplitude: NDArray) -> NDArray:
    """Stable orbits at amplitudes, shape (orbits, 1), along the ϖ of the family's contact.

    Here Λ may be that of the saddle-node of the restitution model (Eq. 7). A stiff contact has its
    saddle-node at a lower Λ, by a share of 1/ϖ, so that the height Λ sin φ of its impact
    is there of the order of √(X/ϖ). See `continuation.walk` for what is returned.
    """
    ratios = np.asarray(family.contact.frequency_ratio)
    x = restitution.saddle_node(family.n, family.contact.restitution)
    # A guess, somewhat too large, with the ϖ at which the walk starts.
    impact_height = np.sqrt(amplitude**2 - x**2 + 8 * x / max(WALK_START, 2 * ratios.max()))
    return walk(family, at_amplitude(amplitude), x, impact_height)


def enough_from(
    family: Family, orbits: NDArray, r: NDArray, amplitude: NDArray, tolerance: float
) -> NDArray:
    """The frequency ratios from which on the errors of orbits stay within a tolerance.

    Parameters
    ----------
    family : Family
        With n and ζ of the shape (orbits, 1), and the ascending frequency ratios of a scan. Two
        crossings of the tolerance between two neighbours are not noticed.
    orbits : ndarray, shape (4, orbits, ratios)
        Those of `orbits_along`.
    r, amplitude : ndarray, shape (orbits, 1)
    tolerance : float

    Returns
    -------
    ndarray, shape (quantities, orbits)
        The quantities are `COMPARED`. Where the error is within the tolerance at all ratios, it is
        the lowest of them. Where it is not so at the largest one, or where there is no orbit at the
        ratio below the first that is enough, it is NaN.
    """
    ratios = np.asarray(family.contact.frequency_ratio)
    logarithms = np.log(ratios)
    n = np.asarray(family.n)
    zeta = np.asarray(family.contact.damping_ratio)
    outside = ~(errors_of_orbits(family, orbits, r, amplitude) <= tolerance)
    last = ratios.size - 1 - np.argmax(outside[..., ::-1], axis=-1)
    crossed = outside.any(axis=-1) & (last < ratios.size - 1)
    quantity, orbit = np.nonzero(crossed)

    def excess(logarithm, quantity, orbit, below):
        low = logarithms[below]
        high = logarithms[below + 1]
        part = (logarithm - low) / (high - low)
        guess = (1 - part) * orbits[:, orbit, below] + part * orbits[:, orbit, below + 1]
        contact = replace(
            family.contact,
            frequency_ratio=np.exp(logarithm),
            damping_ratio=zeta[orbit, 0],
        )
        one = Family(n[orbit, 0], contact)
        at = amplitude[orbit, 0]
        found = errors_of_orbits(one, correct(one, guess, at_amplitude(at)), r[orbit, 0], at)
        return found[quantity, np.arange(quantity.size)] - tolerance

    below = last[quantity, orbit]
    bracket = logarithms[below], logarithms[below + 1]
    # The ratios are known to 1e-11, which is what the orbits are known to.
    precision = {"xatol": 1e-11, "xrtol": 0.0}
    found = find_root(excess, bracket, args=(quantity, orbit, below), tolerances=precision)
    enough = np.where(outside.any(axis=-1), np.nan, ratios[0])
    enough[quantity, orbit] = np.where(found.success, np.exp(found.x), np.nan)
    return enough


def lowest_period_doublings(
    n: Numbers, r: float, ratios: NDArray, release: str
) -> tuple[NDArray, NDArray]:
    """The frequency ratio at which the period doubling of each family is lowest, and its amplitude.

    Both are NaN if it is lowest at an end of the ratios. The place of a minimum has half of the
    digits of its value.
    """
    contact = Contact(ratios, damping_ratio(r), release)
    orbits = bifurcations(n, "period doubling", contact)
    families = np.atleast_1d(n)
    turns = np.full(families.size, np.nan)
    amplitudes = np.full_like(turns, np.nan)
    for k, lowest in enumerate(np.nanargmin(orbits[0], axis=1)):
        if lowest in (0, ratios.size - 1):
            continue

        def amplitude(logarithm, n=families[k], guess=orbits[:, k, lowest]):
            family = Family(n, replace(contact, frequency_ratio=np.exp(logarithm)))
            return float(correct(family, guess, at_bifurcation(Family.period_doubling_test))[0])

        around = np.log(ratios[[lowest - 1, lowest + 1]])
        found = minimize_scalar(
            amplitude, bounds=tuple(around), method="bounded", options={"xatol": 1e-9}
        )
        turns[k] = np.exp(found.x)
        amplitudes[k] = found.fun
    return turns, amplitudes

"""Errors of the restitution model, and the stiffness that keeps them small (Eqs. 37 and 38).

The relative error of a quantity is |spring-damper - restitution| / |restitution|, as the paper
defines it. The threshold for a tolerance is the frequency ratio ϖ above which the error stays
within the tolerance.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar
from scipy.optimize.elementwise import find_root

from bouncing_ball import restitution
from bouncing_ball.continuation import (
    SPECIAL,
    WALK_START,
    Condition,
    at_amplitude,
    at_bifurcation,
    bifurcations,
    correct,
    stable_orbits,
    walk,
)
from bouncing_ball.orbits import Family, NoOrbit, contact_of_ball
from bouncing_ball.restitution import Numbers, ascending, finite, required
from bouncing_ball.spring_damper import Contact, permanent_contact

OF_ORBITS = ("max_height", "bounce_velocity", "phase_in_periods", "apparent_restitution")
"""Quantities of orbits."""
OF_BIFURCATIONS = ("saddle_node", "period_doubling")
"""Amplitudes of bifurcations."""
QUANTITIES = (*OF_ORBITS, *OF_BIFURCATIONS, "permanent_contact")
"""Quantities that both models have, by the names that `errors` takes."""


class Error(NamedTuple):
    """Relative errors of quantities along ϖ.

    Attributes
    ----------
    values
        Errors at the frequency ratios of a scan, shape (..., ratios). A row is a curve.
    between
        ``between(ratio, below, curve)`` returns the errors at frequency ratios between those of the
        scan with the indices ``below`` and ``below + 1``, on the curves with these flat indices.
    admissible
        Whether a ball follows the orbits at the frequency ratios of the scan.
    """

    values: NDArray
    between: Callable[[NDArray, NDArray, NDArray], NDArray]
    admissible: NDArray | bool = True


class Threshold(NamedTuple):
    """Frequency ratios above which errors stay within a tolerance.

    Attributes
    ----------
    ratio
        Shape (...); NaN if it is not found.
    status
        One of

        - ``found``;
        - ``within``: the error is within the tolerance at every ratio of the scan;
        - ``exceeded``: it exceeds the tolerance at the largest ratio;
        - ``first orbit``: it is within the tolerance from the first ratio with an orbit on;
        - ``no orbit``: there is no orbit at the largest ratio.
    """

    ratio: NDArray
    status: NDArray


def relative_error(value: Numbers, reference: Numbers) -> NDArray:
    """Relative error |value - reference| / |reference| (Eqs. 37 and 38).

    The reference is the value of the restitution model.

    >>> relative_error([0.99, 2.2], [1.0, -2.0]).round(12).tolist()
    [0.01, 2.1]
    """
    return np.abs(np.asarray(value) - reference) / np.abs(reference)


def threshold(ratios: NDArray, error: Error, tolerance: Numbers) -> Threshold:
    """Find the frequency ratios above which errors stay within a tolerance.

    The search starts from the last ratio of the scan whose error exceeds the tolerance. The
    threshold is between this ratio and the next. If the error crosses the tolerance twice between
    two neighbours, the search misses both crossings.

    Parameters
    ----------
    ratios : ndarray, shape (ratios,)
        Frequency ratios of the scan, in ascending order.
    error : Error
        Errors at these ratios, of one or several curves.
    tolerance : float or ndarray, shape (tolerances,)
        Maximum relative error. Of several, each curve has a threshold for each tolerance, along
        the last axis of the results.

    >>> grid = np.geomspace(1, 1000, 7)
    >>> error = Error(1 / grid, lambda ratio, below, curve: 1 / ratio)
    >>> last = threshold(grid, error, [0.02, 2.0])
    >>> last.ratio.round(9).tolist(), last.status.tolist()
    ([50.0, nan], ['found', 'within'])
    """
    ratios = ascending(ratios)
    values = error.values.reshape(-1, 1, ratios.size)
    allowed = np.atleast_1d(tolerance)
    required("tolerance", allowed, ~np.greater(allowed, 0), "a tolerance > 0")
    outside = ~(values <= allowed[:, np.newaxis])
    last = ratios.size - 1 - np.argmax(outside[..., ::-1], axis=-1)
    is_within = ~outside.any(axis=-1)
    is_last = last == ratios.size - 1
    is_orbit = np.isfinite(np.take_along_axis(values, last[..., np.newaxis], axis=-1)[..., 0])
    is_crossed = ~is_within & ~is_last & is_orbit
    curve, column = np.nonzero(is_crossed)
    below = last[is_crossed]
    logarithms = np.log(ratios)
    ratio = np.full(last.shape, np.nan)
    if curve.size:
        crossing = find_root(
            lambda log, below, curve, most: error.between(np.exp(log), below, curve) - most,
            (logarithms[below], logarithms[below + 1]),
            args=(below, curve, allowed[column]),
            tolerances={"xatol": 1e-14, "xrtol": 0.0},
        )
        ratio[is_crossed] = np.where(crossing.success, np.exp(crossing.x), np.nan)
    cases = [is_within, ~is_orbit & is_last, ~is_orbit, np.isfinite(ratio)]
    status = np.select(cases, ["within", "no orbit", "first orbit", "found"], "exceeded")
    shape = error.values.shape[:-1] + np.shape(tolerance)
    # For a single curve and tolerance, the results are numbers.
    return Threshold(ratio.reshape(shape)[()], status.reshape(shape)[()])


def permanent_contact_error(ratios: NDArray, zeta: Numbers, release: str) -> Error:
    """Relative error of the threshold of permanent contact along ϖ (Eq. 38)."""

    def error(ratio):
        limit = permanent_contact(ratio, zeta, release)
        return relative_error(limit, restitution.PERMANENT_CONTACT)

    return Error(error(ratios), lambda ratio, below, curve: error(ratio))


def orbit_errors(
    family: Family,
    orbits: NDArray,
    r: float,
    amplitude: float,
    names: Sequence[str] = OF_ORBITS,
) -> dict[str, Error]:
    """Errors of the quantities of n-T orbits, along ϖ at one amplitude, as in `errors` (Eq. 37).

    Parameters
    ----------
    family : Family
        Family with the frequency ratios of a scan, shape (ratios,).
    orbits : ndarray, shape (4, ratios)
        Orbits at these ratios, NaN if an orbit does not exist.
    r, amplitude : float
        Restitution coefficient and amplitude Λ of the orbits.
    names : sequence of str
        Quantities, any of OF_ORBITS.

    Returns
    -------
    dict
        Errors by the name of the quantity. An error is infinite if the orbit does not exist.
    """
    n = family.n
    highest = restitution.max_height(n, r, amplitude)
    velocity = restitution.bounce_velocity(n)
    phase = restitution.impact_phase(n, r, amplitude)
    # Value on an orbit, its limit, and the unit of the error.
    quantities: dict[str, tuple[Callable[[Family, NDArray], NDArray], Numbers, Numbers]] = {
        "max_height": (Family.max_height, highest, highest),
        "bounce_velocity": (Family.bounce_velocity, velocity, velocity),
        "phase_in_periods": (lambda family, y: y[1], phase, 2 * np.pi),
        "apparent_restitution": (Family.apparent_restitution, r, r),
    }
    condition = at_amplitude(finite("Λ", amplitude))
    admissible = family.admissible(orbits)
    return {
        name: _along(family, orbits, condition, admissible, *quantities[name]) for name in names
    }


def bifurcation_errors(
    n: int, r: float, ratios: NDArray, release: str, names: Sequence[str] = OF_BIFURCATIONS
) -> dict[str, Error]:
    """Relative errors of the amplitudes of bifurcations, by name, any of OF_BIFURCATIONS."""
    kinds = {
        "saddle_node": ("saddle-node", Family.saddle_node_test, restitution.saddle_node(n, r)),
        "period_doubling": (
            "period doubling",
            Family.period_doubling_test,
            restitution.period_doubling(n, r),
        ),
    }
    family = Family(n, contact_of_ball(ratios, r, release))
    error_of = {}
    for name in names:
        kind, test, limit = kinds[name]
        orbits = bifurcations(n, kind, family.contact)[:, 0]
        error_of[name] = _along(
            family,
            orbits,
            condition=at_bifurcation(test),
            admissible=family.admissible(orbits),
            value=lambda family, y: y[0],
            limit=limit,
            unit=limit,
        )
    return error_of


def _along(
    family: Family,
    orbits: NDArray,
    condition: Condition,
    admissible: NDArray,
    value: Callable[[Family, NDArray], NDArray],
    limit: Numbers,
    unit: Numbers,
) -> Error:
    """Error of a quantity along a scan: its distance from a limit, in a unit.

    The contact of the family contains the ratios of the scan. The orbits have the shape
    (4, ratios).
    """
    ratios = np.asarray(family.contact.frequency_ratio)

    def error(family, y):
        return np.abs(value(family, y) - limit) / unit

    def between(ratio, below, curve):
        part = np.log(ratio / ratios[below]) / np.log(ratios[below + 1] / ratios[below])
        guess = orbits[:, below] + part * (orbits[:, below + 1] - orbits[:, below])
        one = replace(family, contact=replace(family.contact, frequency_ratio=ratio))
        return error(one, correct(one, guess, condition))

    # The restitution model predicts an orbit that does not exist: count its error as infinite.
    values = error(family, orbits)
    return Error(np.where(np.isnan(orbits).any(axis=0), np.inf, values), between, admissible)


def errors(
    quantities: Sequence[str],
    n: int,
    r: float,
    amplitude: float,
    ratios: Numbers,
    release: str = "displacement",
) -> dict[str, Error]:
    """Errors of the named quantities, along ϖ, on contacts whose free impact has the restitution r.

    Parameters
    ----------
    quantities : sequence of str
        Any of QUANTITIES. Errors are relative, except for the phase: its error is a fraction of the
        period of the table.
    n : int
        Number of table periods in one cycle.
    r, amplitude : float
        Restitution coefficient and amplitude Λ.
    ratios : array_like, shape (ratios,) or ()
        Frequency ratios ϖ, in ascending order.
    release : str
        Release condition, ``displacement`` or ``force``.

    Returns
    -------
    dict
        Errors by the name of the quantity, over the ratios. The error of a quantity of orbits is
        infinite where the contact has no stable orbit.

    Raises
    ------
    NoOrbit
        If no contact with ζ < 1 has this r (`damping_ratio`). Also if a quantity of orbits is
        named, and the restitution model or the contacts of all ϖ have no stable orbit at the
        amplitude: there is nothing to compare. The message says where the contact of the largest ϖ
        has stable orbits.
    ValueError
        If quantities is no list of names, or if a name, the release, n, r, Λ or ϖ is not allowed.

    >>> scan = np.array([10.0, 100.0])
    >>> velocity = errors(["bounce_velocity"], 1, 0.65, 1.0, scan, "displacement")
    >>> velocity["bounce_velocity"].values.round(3).tolist()
    [0.061, 0.006]
    """
    ratios = ascending(ratios)
    contact = contact_of_ball(ratios, r, release)
    names = [quantities] if isinstance(quantities, str) else list(quantities)
    unknown = [name for name in names if name not in QUANTITIES or isinstance(quantities, str)]
    if unknown:
        raise ValueError(f"quantities is {unknown[0]!r}: give a list of {', '.join(QUANTITIES)}")
    known: dict[str, Error] = {}
    if of_orbits := [name for name in names if name in OF_ORBITS]:
        finite("Λ", amplitude)
        family = Family(n, contact)
        ends = restitution.saddle_node(n, r), restitution.period_doubling(n, r)
        orbits = np.full((4, ratios.size), np.nan)
        if ends[0] < amplitude < ends[1]:
            orbits = stable_orbits(n, r, amplitude, ratios, release)[:, 0]
        if np.isnan(orbits).all():
            stiffest = replace(contact, frequency_ratio=np.max(ratios))
            low, high = (bifurcations(n, kind, stiffest)[0].item() for kind in SPECIAL[:2])
            of_contact = f"; those with ϖ = {np.max(ratios):g} need {low:.6g} to {high:.6g}"
            raise NoOrbit(
                f"Λ = {amplitude:.6g}: stable {n}-T orbits of the restitution model need Λ from "
                f"{ends[0]:.6g} to {ends[1]:.6g} (Eqs. 7 and R1){of_contact * (low < high)}"
            )
        known = orbit_errors(family, orbits, r, amplitude, of_orbits)
    of_bifurcations = [name for name in names if name in OF_BIFURCATIONS]
    known |= bifurcation_errors(n, r, ratios, release, of_bifurcations)
    if "permanent_contact" in names:
        known["permanent_contact"] = permanent_contact_error(ratios, contact.damping_ratio, release)
    return {name: known[name] for name in names}


COMPARED = ("summit", "bounce_velocity", "apparent_restitution", "phase_in_periods")
"""Quantities of an orbit, along the first axis of `errors_of_orbits`."""


def errors_of_orbits(family: Family, y: NDArray, r: Numbers, amplitude: Numbers) -> NDArray:
    """Errors of the quantities `COMPARED` on orbits y at amplitudes Λ, shape (4, ...).

    An error is negative if the value of the restitution model is larger. The errors are relative to
    the restitution model with r, except the error of the phase. The error of the phase is a
    fraction of the period of the table. The maximum height is taken in the flight only.
    """
    n = family.n
    pairs = (
        (family.summit(y), restitution.max_height(n, r, amplitude)),
        (family.bounce_velocity(y), restitution.bounce_velocity(n)),
        (family.apparent_restitution(y), r),
    )
    errors = [(value - limit) / limit for value, limit in pairs]
    turn = y[1] - restitution.impact_phase(n, r, amplitude)
    return np.stack(np.broadcast_arrays(*errors, turn / (2 * np.pi)))


def orbits_along(family: Family, amplitude: NDArray) -> NDArray:
    """Orbits at amplitudes of the shape (orbits, 1), along the ϖ of the family's contact.

    They are stable next to the saddle-node, as `continuation.upper_orbits`.

    The amplitude may equal the saddle-node of the restitution model (Eq. 7). The saddle-node of a
    stiff contact is at a lower amplitude; the relative difference is of the order of 1/ϖ. At the
    amplitude of Eq. 7, the impact height Λ sin φ on a stiff contact is therefore of the order of
    √(X/ϖ).

    Returns
    -------
    ndarray, shape (4, orbits, ratios)
        NaN if the walk does not reach the orbit (`continuation.walk`).
    """
    ratios = np.asarray(family.contact.frequency_ratio)
    finite("Λ", amplitude)
    x = restitution.saddle_node(family.n, family.contact.restitution)
    # Guess of Y for the ϖ at which the walk starts. It is larger than the Y of the orbit.
    impact_height = np.sqrt(amplitude**2 - x**2 + 8 * x / max(WALK_START, 2 * ratios.max()))
    return walk(family, at_amplitude(amplitude), x, impact_height)


def enough_from(
    family: Family, orbits: NDArray, r: NDArray, amplitude: NDArray, tolerance: float
) -> NDArray:
    """Frequency ratios above which the errors of orbits stay within a tolerance.

    If an error crosses the tolerance twice between two neighbours of the scan, the search misses
    both crossings.

    Parameters
    ----------
    family : Family
        Family with n and ζ of the shape (orbits, 1), and with the frequency ratios of a scan in
        ascending order.
    orbits : ndarray, shape (4, orbits, ratios)
        Result of `orbits_along`.
    r, amplitude : ndarray, shape (orbits, 1)
        Restitution coefficient and amplitude Λ of each orbit.
    tolerance : float
        Maximum error.

    Returns
    -------
    ndarray, shape (quantities, orbits)
        Frequency ratios for the quantities `COMPARED`:

        - the smallest ratio of the scan, if the error is within the tolerance at all ratios;
        - NaN, if the error exceeds the tolerance at the largest ratio;
        - NaN, if no orbit exists at the last ratio before the crossing;
        - otherwise the ratio at which the error crosses the tolerance for the last time.
    """
    ratios = np.asarray(family.contact.frequency_ratio)
    n = np.asarray(family.n)
    zeta = np.asarray(family.contact.damping_ratio)
    values = np.abs(errors_of_orbits(family, orbits, r, amplitude))

    def between(ratio, below, curve):
        quantity, orbit = np.unravel_index(curve, values.shape[:2])
        part = np.log(ratio / ratios[below]) / np.log(ratios[below + 1] / ratios[below])
        guess = (1 - part) * orbits[:, orbit, below] + part * orbits[:, orbit, below + 1]
        contact = replace(family.contact, frequency_ratio=ratio, damping_ratio=zeta[orbit, 0])
        one = Family(n[orbit, 0], contact)
        at = amplitude[orbit, 0]
        error = errors_of_orbits(one, correct(one, guess, at_amplitude(at)), r[orbit, 0], at)
        return np.abs(error[quantity, np.arange(quantity.size)])

    crossing = threshold(ratios, Error(values, between), tolerance)
    return np.where(crossing.status == "within", ratios[0], crossing.ratio)


def lowest_period_doublings(
    n: Numbers, r: float, ratios: NDArray, release: str
) -> tuple[NDArray, NDArray]:
    """Minimum over ϖ of the amplitude of the period doubling, for each family.

    Returns the frequency ratios of the minima and the amplitudes there, both of the shape
    (families,). Both are NaN if the smallest amplitude is at the first or last ratio with a period
    doubling. A frequency ratio has half as many exact digits as the amplitude, because the minimum
    is flat.
    """
    ratios = ascending(ratios)
    contact = Contact.of_restitution(ratios, finite("r", r), release)
    orbits = bifurcations(n, "period doubling", contact)
    families = np.atleast_1d(n)
    turns = np.full(families.size, np.nan)
    amplitudes = np.full_like(turns, np.nan)
    known = np.where(np.isnan(orbits[0]), np.inf, orbits[0])
    for k, lowest in enumerate(np.argmin(known, axis=1)):
        # Without an orbit on one side, this is an end of the doublings, and no minimum.
        if lowest in (0, ratios.size - 1) or np.isinf(known[k, [lowest - 1, lowest + 1]]).any():
            continue

        def amplitude(logarithm, n=families[k], guess=orbits[:, k, lowest]):
            family = Family(n, replace(contact, frequency_ratio=np.exp(logarithm)))
            return float(correct(family, guess, at_bifurcation(Family.period_doubling_test))[0])

        around = np.log(ratios[[lowest - 1, lowest + 1]])
        turn = minimize_scalar(
            amplitude, bounds=tuple(around), method="bounded", options={"xatol": 1e-9}
        )
        turns[k] = np.exp(turn.x)
        amplitudes[k] = turn.fun
    return turns, amplitudes

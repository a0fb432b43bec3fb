"""Table 1 under nine hypotheses about the authors' computation, called readings.

Seven readings are the models of this package with another damping, release or rounding, and Eqs. 7
and 8. Two readings alter an equation: a contact without gravity, and a period doubling whose
linearised flight neglects the displacement of the table against its height, as Holmes' map does.

A continuation that is converged loosely is no reading, because it has more free numbers than the
table can decide: a tolerance, a step, and the Λ at which the steps of each branch begin. What can
be computed is the tolerance that a printed saddle-node needs (:func:`needed_tolerance`).
"""

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from bouncing_ball.datasets.variables import Variable, describe
from bouncing_ball.models.damping import Release, damping_ratio
from bouncing_ball.models.flight import flight_derivative, matrix_of
from bouncing_ball.models.spring_damper import ContactState, SpringDamper, responses
from bouncing_ball.numerics.corrector import solve_linear
from bouncing_ball.paper.claims import as_printed
from bouncing_ball.paper.exhibits.printed_table1 import AXES, LAST_DIGIT, RESTITUTION, printed_table
from bouncing_ball.periodic.continuation import PaperEquations
from bouncing_ball.periodic.explicit import explicit_branch
from bouncing_ball.periodic.orbit import Bifurcation, Orbit
from bouncing_ball.periodic.spring_damper_branch import branch_point

VARIABLES = {
    "rows": Variable("rows of the table that are compared", equation="Table 1"),
    "rank": Variable("place of the reading, the closest to the printed table first"),
    "difference": Variable("computed less printed value, in units of the last digit", budget=1e-08),
    "largest_difference": Variable("largest difference, in units of the last digit", budget=1e-08),
    "rms_difference": Variable(
        "root mean square difference, in units of the last digit", budget=1e-08
    ),
    "reproduced": Variable("number of entries within half a unit of the last digit"),
    "entries": Variable("number of entries compared"),
    "unreachable": Variable("number of saddle-nodes printed below every computed orbit"),
    "stable_width": Variable(
        "√(Λ_PD² - Λ_SN²) of a range of stable orbits, which is 1 by Eqs. 7 and 8 for every n",
        budget=1e-11,
    ),
    "needed_tolerance": Variable(
        "norm of the residual of Eqs. 21-26 that a continuation must accept to reach the printed "
        "saddle-node; 0 where orbits exist",
        equation="Eqs. 21-26",
        budget=1e-11,
    ),
    "printed_stable_width": Variable("√(Λ_PD² - Λ_SN²) of the printed ends"),
    "printed_stable_width_rounding": Variable(
        "largest change of √(Λ_PD² - Λ_SN²) by rounding of the printed ends"
    ),
}
PRINTED_DAMPING = 0.052
"""ζ in the paper's rounding, an alternative to ζ by Eq. 16."""
# Values that differ by less count as equal. They are in units of a last printed digit, computed to
# 1e-8 and printed to 1e-2.
_SAME = 1e-6
# The ends of a range of stable orbits, from below.
_KINDS = (Bifurcation.SADDLE_NODE, Bifurcation.PERIOD_DOUBLING)
# Number of samples of a branch along ε.
_SAMPLES = 401
# The largest |ε| in units of 1/ϖ, the scale of the fold.
_REACH = 12.0


def contact_end(orbit: Orbit, weight: float) -> ContactState:
    """The ends of the contacts of orbits, in which the ball has this part of its weight.

    The part of the weight that is missing is that of a ball on a table at rest.
    """
    contact: Any = orbit.model
    time = orbit.contact_duration
    whole = contact.flow(time, orbit.phase, orbit.relative_impact_velocity, orbit.amplitude)
    sag = contact.flow(time, 0.0, 0.0, 0.0)
    pairs = zip(whole, sag, strict=True)
    return ContactState(*(state - (1 - weight) * missing for state, missing in pairs))


def weightless_orbits(excess: ArrayLike, contact: SpringDamper, n: ArrayLike) -> Orbit:
    """n-T orbits with gravity in flight, but not in contact, with excess angles ε of the contact.

    At a fixed duration Eqs. 23-25 are linear in u = δ′ at the start, Λ cos φ and Λ sin φ.
    """
    duration = (contact.free_angle + excess) / contact.damped_frequency
    flight = 2 * np.pi * np.asarray(n) - duration

    def orbit(u, x, y) -> Orbit:
        return Orbit(contact, n, np.hypot(x, y), np.arctan2(y, x), duration, u + x)

    def defects(u, x, y) -> np.ndarray:
        tried = orbit(u, x, y)
        end = contact_end(tried, weight=0.0)
        bounce = tried.bounce_velocity
        speed = end.velocity + tried.amplitude * np.cos(tried.release_phase) - bounce
        height = end.displacement + tried.amplitude * np.sin(tried.release_phase) - y
        landing = height + (bounce - flight / 2) * flight
        return np.stack([contact.frequency_ratio * end.displacement, speed, landing], axis=-1)

    constant = defects(0.0, 0.0, 0.0)
    columns = [defects(*unit) - constant for unit in np.eye(3)]
    solved = solve_linear(np.stack(columns, axis=-1), -constant)
    return orbit(*np.moveaxis(solved, -1, 0))


def altered_monodromy(orbit: Orbit, weight: float = 1.0, high_bounce: bool = False) -> np.ndarray:
    """Monodromy of orbits with an altered contact or flight, shape (..., 2, 2).

    ``weight`` is the part of the weight in contact. The flight ends at the table, or, with
    ``high_bounce``, as that of Holmes' map at the height at which it began, ``z′_b T - T²/2 = 0``
    in place of Eq. 25, so that ``dT = -T dz′_b/z′_i``.
    """
    end = contact_end(orbit, weight)
    contact: Any = orbit.model
    time = orbit.contact_duration
    found = responses(time, contact.frequency_ratio, contact.damping_ratio)
    x = orbit.amplitude * np.cos(orbit.phase)
    y = orbit.amplitude * np.sin(orbit.phase)
    later_by_phase = -(x * found.in_phase - y * found.quadrature) / end.velocity
    later_by_velocity = -found.impulse / end.velocity
    rate_by_phase = x * (found.impulse - found.quadrature) - y * found.in_phase
    of_contact = matrix_of(
        1 + later_by_phase,
        later_by_velocity,
        rate_by_phase + end.acceleration * later_by_phase,
        found.impulse_rate + end.acceleration * later_by_velocity,
    )
    flight = orbit.flight_time
    release = orbit.release_phase
    if not high_bounce:
        landing = orbit.relative_impact_velocity
        return flight_derivative(release, flight, landing, orbit.amplitude) @ of_contact
    height = orbit.amplitude * np.sin(release)
    longer_by_phase = flight * height / orbit.impact_velocity
    longer_by_velocity = -flight / orbit.impact_velocity
    of_flight = matrix_of(
        1 + longer_by_phase,
        longer_by_velocity,
        -height - longer_by_phase + y * (1 + longer_by_phase),
        1 - longer_by_velocity + y * longer_by_velocity,
    )
    return of_flight @ of_contact


@np.errstate(divide="ignore", invalid="ignore")  # where the ball grazes
def altered_ends(
    contact: SpringDamper, n: np.ndarray, orbit_at: Callable, linearised: Callable
) -> np.ndarray:
    """Λ at the saddle-node and the period doubling of altered branches, shape (m, 2).

    The saddle-node is the minimum of Λ along the branch for any linearisation, because no orbit has
    a smaller Λ. The period doubling is the root of 1 + tr + det nearest to the saddle-node on the
    side of the short contacts.

    Parameters
    ----------
    contact : SpringDamper
        With ϖ of shape (m,).
    n : ndarray, shape (m,)
    orbit_at : callable
        The orbits as a function of ε, the contact and n; their contacts last (θ₀ + ε)/ϖ_d.
    linearised : callable
        The monodromy of these orbits, shape (..., 2, 2).
    """
    # This module of scipy is not loaded on first use, and its import takes a third of a second.
    from scipy.optimize.elementwise import find_minimum, find_root

    def amplitude(excess, which):
        return orbit_at(excess, contact[which], n[which]).amplitude

    def doubling(excess, which):
        matrix = linearised(orbit_at(excess, contact[which], n[which]))
        trace = np.trace(matrix, axis1=-2, axis2=-1)
        return Bifurcation.PERIOD_DOUBLING.test(trace, np.linalg.det(matrix))

    every = np.arange(n.size)
    sample = np.arange(_SAMPLES)[:, np.newaxis]
    reach = np.minimum(_REACH / contact.frequency_ratio, 0.9 * contact.free_angle)
    grid = np.linspace(-reach, reach, _SAMPLES)
    lowest = np.nanargmin(amplitude(grid, every), axis=0)
    node = find_minimum(amplitude, [grid[lowest + k, every] for k in (-1, 0, 1)], args=(every,))
    unstable = (doubling(grid, every) < 0) & (sample < lowest)
    left = grid[np.max(sample * unstable, axis=0), every]
    root = find_root(doubling, (left, node.x), args=(every,))
    return np.stack([node.f_x, amplitude(root.x, every)], axis=-1)


def stable_width(ends: xr.DataArray) -> xr.DataArray:
    """√(Λ_PD² - Λ_SN²) of ranges of stable orbits, over all dimensions but ``bound``.

    Eqs. 7 and 8 give 1 for every n and r, and the map of Eq. 5 gives a number that depends on r
    alone, so that it tells which stability was used.

    Examples
    --------
    >>> ends = xr.DataArray([0.6, 1.0], {"bound": ["saddle-node", "period doubling"]}, "bound")
    >>> float(stable_width(ends).round(9))
    0.8
    """
    by_kind = [ends.sel(bound=str(kind), drop=True) for kind in _KINDS]
    return (by_kind[1] ** 2 - by_kind[0] ** 2) ** 0.5


def needed_tolerance(contact: SpringDamper, n: np.ndarray, amplitude: np.ndarray) -> np.ndarray:
    """The smallest norm of the residual of Eqs. 21-26 at a given Λ, to first order in the distance
    from the saddle-node; 0 for Λ above it, where orbits exist.

    At the saddle-node the derivative of the residual R by the unknowns has a unit vector ψ with
    ψ·∂R/∂y = 0. Below it no change of the unknowns removes the part of the residual along ψ, which
    is ``ψ·∂R/∂Λ (Λ - Λ_SN)``. The residual is that of
    :class:`~bouncing_ball.periodic.continuation.PaperEquations`, in which heights in contact are
    multiplied by ϖ.

    Examples
    --------
    The 1-T orbits at r = 0.85 and ϖ = 10 begin at Λ = 0.23999:

    >>> contact = SpringDamper(np.array([10.0, 10.0]), float(damping_ratio(0.85)))
    >>> needed_tolerance(contact, np.array([1, 1]), np.array([0.238, 0.241])).round(4).tolist()
    [0.0024, 0.0]
    """
    node = explicit_branch(contact).bifurcation(Bifurcation.SADDLE_NODE, n)
    equations = PaperEquations(contact, n)
    jacobian = equations.jacobian(equations.point(node))
    left = np.linalg.svd(jacobian[..., :-1])[0][..., -1]
    by_amplitude = np.abs(np.sum(left * jacobian[..., -1], axis=-1))
    return by_amplitude * np.maximum(np.asarray(node.amplitude) - amplitude, 0)


def readings() -> dict[str, np.ndarray]:
    """Both ends of each range under the nine readings, shape (ϖ, n, 2).

    "Equations as they stand" means Eqs. 11-26 and the linearised return map; in one reading the
    digits beyond the last printed digit are cut off. ζ to first order is -ln r/π. With "equal r"
    the contact with the force release has the ζ that gives it the r of the table. Under
    "high-bounce stability" the orbit is exact. "All rows from Eqs. 7-8" shows the influence of the
    stiffness.
    """
    omega, n = np.meshgrid(AXES["frequency_ratio"], AXES["n"], indexing="ij")
    zeta = float(damping_ratio(RESTITUTION))
    # By Eq. 16 a contact with the force release has a larger r than that of the table.
    equal = damping_ratio(RESTITUTION, Release.FORCE)

    def of_model(damping: float = zeta, release: Release = Release.DISPLACEMENT) -> np.ndarray:
        branch = explicit_branch(SpringDamper(omega, damping, release))
        return np.stack([branch.bifurcation(kind, n).amplitude for kind in Bifurcation], axis=-1)

    def altered(orbit_at: Callable, linearised: Callable) -> np.ndarray:
        contact = SpringDamper(omega.ravel(), zeta)
        return altered_ends(contact, n.ravel(), orbit_at, linearised).reshape(*n.shape, 2)

    def exact(*given: Any) -> Orbit:
        return branch_point(*given).orbit

    plain = of_model()
    printed_ends = [
        as_printed.saddle_node(n, RESTITUTION),
        as_printed.period_doubling(n, RESTITUTION),
    ]
    return {
        "equations as they stand": plain,
        "digits cut off": np.floor(plain / LAST_DIGIT) * LAST_DIGIT,
        "damping as printed": of_model(PRINTED_DAMPING),
        "damping to first order": of_model(-np.log(RESTITUTION) / np.pi),
        "force release": of_model(release=Release.FORCE),
        "force release, equal r": of_model(float(equal), Release.FORCE),
        "no gravity in contact": altered(weightless_orbits, partial(altered_monodromy, weight=0.0)),
        "high-bounce stability": altered(exact, partial(altered_monodromy, high_bounce=True)),
        "all rows from Eqs. 7-8": np.stack(printed_ends, axis=-1),
    }


def levels(values: ArrayLike) -> np.ndarray:
    """For each value, the number of distinct smaller values; equal up to rounding is not distinct.

    Values are not rounded to decimals, because rounding errors would decide about a value halfway
    between two decimals.

    Examples
    --------
    >>> levels([2.0, 1.0, 1.0 + 1e-12, np.inf]).tolist()
    [1, 0, 0, 2]
    """
    values = np.asarray(values, dtype=float)
    order = np.argsort(values)
    ranked = values[order]
    # A comparison, because the difference of two infinite values, which are equal, is NaN.
    apart = ranked[1:] > ranked[:-1] + _SAME
    found = np.empty(values.shape, dtype=int)
    found[order] = np.concatenate([[0], np.cumsum(apart)])
    return found


def forensics() -> xr.Dataset:
    """Table 1 under every reading, ranked by the rms difference in the two rows of smaller ϖ.

    Returns
    -------
    xarray.Dataset
        ``computed`` and ``difference`` (in units of the last digit) over (reading,
        frequency_ratio, n, bound); the largest and the rms difference and the number of reproduced
        entries over (reading, rows); and ``unreachable`` over reading, the number of printed
        saddle-nodes that lie below the fold by more than rounding, where no orbit exists.
        ``stable_width`` over (reading, frequency_ratio, n), and that of the printed ends with the
        change that rounding can make, and ``needed_tolerance``, over (frequency_ratio, n).
    """
    found = readings()
    printed = printed_table()
    axes = {"reading": list(found), **printed.coords}
    computed = xr.DataArray(np.array(list(found.values())), axes, ("reading", *printed.dims))
    difference = (computed - printed) / LAST_DIGIT
    below = difference.sel(bound=Bifurcation.SADDLE_NODE, drop=True) > 0.5
    # The largest first-order change by rounding of both ends.
    width = stable_width(printed)
    rounding = LAST_DIGIT / 2 * printed.sum("bound") / width
    nodes = printed.sel(bound=Bifurcation.SADDLE_NODE, drop=True)
    ratio, n = xr.broadcast(nodes.frequency_ratio, nodes.n)
    contact = SpringDamper(ratio.values, float(damping_ratio(RESTITUTION)))
    ratio = printed.frequency_ratio
    groups = {"all rows": ratio > 0, "compliant rows": ratio < ratio.max()}
    groups |= {f"ϖ = {float(value):g}": ratio == value for value in ratio}
    rows = xr.Variable("rows", list(groups))
    over = list(printed.dims)
    parts = xr.concat([difference.where(group) for group in groups.values()], rows)
    data = xr.Dataset(
        {
            "computed": computed,
            "printed": printed,
            "difference": difference,
            "largest_difference": abs(parts).max(over).transpose("reading", "rows"),
            "rms_difference": ((parts**2).mean(over) ** 0.5).transpose("reading", "rows"),
            "reproduced": (abs(parts) <= 0.5).sum(over).transpose("reading", "rows"),
            "entries": parts.isel(reading=0, drop=True).count(over),
            "unreachable": below.sum(["frequency_ratio", "n"]),
            "stable_width": stable_width(computed),
            "needed_tolerance": nodes.copy(data=needed_tolerance(contact, n.values, nodes.values)),
            "printed_stable_width": width,
            "printed_stable_width_rounding": rounding,
        }
    )
    # The compliant rows decide, and all rows where these are equal.
    all_rows = levels(data.rms_difference.sel(rows="all rows").values)
    compliant_rows = levels(data.rms_difference.sel(rows="compliant rows").values)
    order = np.lexsort([all_rows, compliant_rows])
    ranked = data.isel(reading=order).assign(rank=("reading", 1 + np.arange(len(found))))
    return describe(ranked, variables=VARIABLES).assign_attrs(
        last_digit=LAST_DIGIT,
        restitution=RESTITUTION,
        printed_damping_ratio=PRINTED_DAMPING,
        force_damping_ratio=float(damping_ratio(RESTITUTION, Release.FORCE)),
    )

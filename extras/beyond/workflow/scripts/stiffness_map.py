"""Stage: how stiff a contact must be to bounce, to be stable and to bounce as high.

The question has three answers at an amplitude Λ, each a frequency ratio ϖ from which on the contact
agrees with the restitution model. Let Λ_SN and Λ_PD be the saddle-node and the period doubling.

- It bounces: both models have the orbit, or none has it. The contact's Λ_SN is lower by s₁/ϖ.
- It is stable: Λ is below both Λ_PD. That of the contact is lower by a share |K|/ϖ.
- It bounces as high: the error of the greatest height is within the tolerance ε (Eq. R9).
"""

import sys
from dataclasses import dataclass

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from scipy.optimize.elementwise import find_minimum, find_root

from bouncing_ball.datasets import grid, save_stage
from bouncing_ball.restitution import period_doubling, saddle_node
from bouncing_ball_beyond.balls import Corrected, SpringDamper
from bouncing_ball_beyond.equations import OrbitEquations
from bouncing_ball_beyond.error_law import (
    contact_values,
    exact_errors,
    free_impact,
    law_coefficients,
    law_errors,
    rows_of_orbits,
)
from bouncing_ball_beyond.paths import Parameter
from bouncing_ball_beyond.periodic import guess_of_instants
from bouncing_ball_beyond.special_orbits import special_near
from studies.orbits import flight_height, solved
from studies.variables import VARIABLES

# Share by which the frequency ratio of the error law differs from the exact one where it is marked.
MARKED = 0.1

# The ϖ of the lines of the figure; those of the rule of thumb and of the paper are added.
LEVELS = (10.0, 20.0, 50.0, 100.0, 200.0, 1000.0)

# Samples of ϖ among which the law's largest Y₀ is sought, at ratios that no line shows.
STIFFER = 301

# Newton's method leaves rounding errors, some 1e-15, or fails.
CONVERGED = 1e-12

BIFURCATIONS = ("saddle_node", "period_doubling")
JUDGES = ("rule of thumb", "paper")


@dataclass(frozen=True)
class Lift:
    """Y₀ = √(Λ² - C²) as what changes, from the Λ = C of the saddle-node on.

    The height is an analytic function of it, also at Y₀ = 0.
    """

    name: str = "lift"

    def apply(self, ball: SpringDamper, amplitude, value):
        """The ball and Λ at a value of Y₀."""
        return ball, np.sqrt(amplitude**2 + value**2)


def restitution_height(n: NDArray, lift: NDArray) -> NDArray:
    """The greatest height H = Y₀ + (nπ)²/2 of the restitution model."""
    return lift + (n * np.pi) ** 2 / 2


# The height


def law_roots(n: NDArray, r: NDArray, lift: NDArray, error: float) -> NDArray:
    """The ϖ at which the height has an error by the law: one over the smallest positive root of

    (k² + s₁²) u² + 2 [k (Y₀ + EH) - C s₁] u + 2 Y₀EH + (EH)² = 0, Y₀ + EH + ku ≥ 0 (Eq. R9).

    It is 0 where there is none.
    """
    unit = free_impact(SpringDamper(1.0, restitution=r), n)
    k = unit.shift * unit.line + unit.speed * unit.centroid
    step = error * restitution_height(n, lift)
    a = k**2 + unit.shift**2
    b = k * (lift + step) - unit.line * unit.shift
    c = step * (2 * lift + step)
    discriminant = b**2 - a * c
    root = np.sqrt(np.maximum(discriminant, 0))
    both = np.array([-b - root, -b + root]) / a
    allowed = (both > 0) & (lift + step + k * both >= 0) & (discriminant >= 0)
    return 1 / np.where(allowed, both, np.inf).min(axis=0)


def law_lift(n: NDArray, r: NDArray, ratio: NDArray, error: float) -> NDArray:
    """The Y₀ at which the height has a positive error at ϖ by the law: the larger root of

    [(1 + E)² - 1] Y₀² + 2 (1 + E) g Y₀ + g² - q = 0 (Eq. R9, solved for Y₀),

    with g = E (nπ)²/2 + k/ϖ and q = 2Cs - s². It is negative where no Λ ≥ C has such an error.
    """
    impact = free_impact(SpringDamper(ratio, restitution=r), n)
    shift = impact.shift
    g = error * impact.half**2 / 2 + shift * impact.line + impact.speed * impact.centroid
    q = 2 * impact.line * shift - shift**2
    a = (1 + error) ** 2 - 1
    return (np.sqrt(np.maximum(g**2 + a * q, 0)) - (1 + error) * g) / a


def exact_lift(n: NDArray, r: NDArray, ratio: NDArray, error: float) -> NDArray:
    """The same exactly, by Newton's method from the law; all arrays have the shape (rows,)."""
    ball = SpringDamper(1.0, restitution=r).at(frequency_ratio=ratio)
    low = saddle_node(n, r)
    lift = law_lift(n, r, ratio, error)
    guess = guess_of_instants(ball, n, np.hypot(low, lift))
    guess[:, -1] = lift
    equations = OrbitEquations(ball, 1, n, low, (Lift(),))

    def excess(z: NDArray) -> NDArray:
        return flight_height(equations, z) - (1 + error) * restitution_height(n, z[:, -1])

    return solved(equations, guess, lambda z: excess(z)[:, np.newaxis])[:, -1]


def largest_lift(n: NDArray, r: NDArray, ratios: NDArray, error: float) -> tuple[NDArray, NDArray]:
    """The largest Y₀ at which some ϖ has this positive error, and ln ϖ there.

    At a larger Y₀ the height leaves the tolerance downwards only, so that the ϖ that is needed
    jumps there.
    """
    by_law = law_lift(n, r, ratios[:, np.newaxis], error)
    middle = np.log(ratios[by_law.argmax(axis=0)])
    found = find_minimum(
        lambda x, n, r: -exact_lift(n, r, np.exp(x), error),
        (middle - 1, middle, middle + 1),
        args=(n, r),
        # The minimum of a parabola is known to half of the digits of its values.
        tolerances={"xatol": 1e-6},
        maxiter=40,
    )
    return np.where(found.success, -found.f_x, np.nan), found.x


def upper_thresholds(n, r, lift, jump, ratios, error: float) -> NDArray:
    """The largest ϖ at which the height has a positive error.

    It exceeds the ϖ at which Y₀ with this error is largest, whose logarithm is `jump`.
    """
    found = find_root(
        lambda x, n, r, lift: exact_lift(n, r, np.exp(x), error) - lift,
        (jump, np.full_like(jump, np.log(ratios[-1]))),
        args=(n, r, lift),
    )
    return np.where(found.success, np.exp(found.x), np.nan)


def lower_thresholds(n, r, amplitude, lift, error: float) -> NDArray:
    """The ϖ at which the height has a negative error, by Newton's method from the law."""
    ratio = law_roots(n, r, lift, error)
    ball = SpringDamper(1.0, restitution=r).at(frequency_ratio=ratio)
    guess = guess_of_instants(ball, n, amplitude)
    guess[:, -1] = ratio
    equations = OrbitEquations(ball, 1, n, amplitude, (Parameter("frequency_ratio"),))
    sought = (1 + error) * restitution_height(n, lift)
    z = solved(equations, guess, lambda z: (flight_height(equations, z) - sought)[:, np.newaxis])
    converged = np.abs(flight_height(equations, z) / sought - 1) < CONVERGED
    return np.where(converged, z[:, -1], np.nan)


# Stability


def doubling_thresholds(n: NDArray, r: NDArray, amplitude: NDArray, ratios: NDArray) -> NDArray:
    """The largest ϖ at which the contact doubles its period, and the least of `ratios` if all are
    larger; NaN if all are smaller. Λ has the shape (families, positions).

    A scan along ϖ brackets it, and Newton's method starts between.
    """
    balls = SpringDamper(1.0, restitution=r).at(frequency_ratio=ratios[:, np.newaxis])
    scan = contact_values(balls, amplitude=1.0, n=n, quantities=["period_doubling"])
    ends = scan["period_doubling"][..., np.newaxis]
    doubled = ends <= amplitude
    last = ratios.size - 1 - doubled[::-1].argmax(axis=0)
    found = np.where(doubled[-1], np.nan, ratios[0])
    family, position = np.nonzero(doubled.any(axis=0) & ~doubled[-1])
    last = last[family, position]
    amplitude = amplitude[family, position]
    logarithm = np.log(ratios)
    low = ends[last, family, 0]
    share = (amplitude - low) / (ends[last + 1, family, 0] - low)
    ratio = np.exp(logarithm[last] + share * (logarithm[last + 1] - logarithm[last]))
    ball = SpringDamper(1.0, restitution=r[family]).at(frequency_ratio=ratio)
    guess = guess_of_instants(ball, n[family], amplitude)
    guess[:, -1] = ratio
    equations = OrbitEquations(ball, 1, n[family], amplitude, (Parameter("frequency_ratio"),))
    z, good = special_near(equations, "period doubling", guess)
    found[family, position] = np.where(good, z[:, -1], np.nan)
    return found


def law_doubling_thresholds(n: NDArray, r: NDArray, amplitude: NDArray) -> NDArray:
    """|K|/(1 - Λ/Λ_PD), at which the law has the period doubling at Λ; NaN at Λ_PD itself.

    K is negative for linear contacts: they double at a smaller Λ.
    """
    unit = free_impact(SpringDamper(1.0, restitution=r), n)
    first = law_coefficients(unit, amplitude=period_doubling(n, r))["period_doubling"]
    below = 1 - amplitude / period_doubling(n, r)[:, np.newaxis]
    with np.errstate(divide="ignore"):
        found = np.maximum(-first, 0)[:, np.newaxis] / below
    return np.where(below > CONVERGED, found, np.nan)


def orbits_at(n: NDArray, r: NDArray, amplitude: NDArray, ratio: NDArray) -> dict[str, NDArray]:
    """Orbits on contacts: height, the least real multiplier, and whether a ball stays near them.

    All arrays have one shape; NaN where there is no orbit, and where multipliers are not real.
    """
    shape = amplitude.shape
    n, r, amplitude, ratio = (each.ravel() for each in (n, r, amplitude, ratio))
    ball = SpringDamper(1.0, restitution=r).at(frequency_ratio=ratio)
    equations = OrbitEquations(ball, 1, n)
    z = rows_of_orbits(equations, amplitude)
    known = np.isfinite(z[:, 0])
    equations = equations.rows(known)
    z = z[known]
    linear = equations.linear(z)
    trace, determinant = equations.trace_and_determinant(linear)
    stable = equations.stable(linear)
    stable[stable] = equations.rows(stable).admissible(z[stable])
    with np.errstate(invalid="ignore"):
        least = (trace - np.sqrt(trace**2 - 4 * determinant)) / 2
    found = {"height": flight_height(equations, z), "multiplier": least, "stable": stable}
    whole = {name: np.full(amplitude.size, np.nan) for name in found}
    for name, values in found.items():
        whole[name][known] = values
    return {name: values.reshape(shape) for name, values in whole.items()}


# The map


@dataclass(frozen=True)
class Families:
    """All (n, r) in a row, shape (families,), with Λ and Y₀ of their nodes, (families, positions).

    `low` and `high` are the restitution model's Λ of the saddle-node and of the period doubling.
    """

    n: NDArray
    r: NDArray
    low: NDArray
    high: NDArray
    amplitude: NDArray
    lift: NDArray


def families_of(n: NDArray, r: NDArray, position: NDArray) -> Families:
    """The families of each n and each r, with nodes at positions in the stable range."""
    n, r = (each.ravel() for each in np.meshgrid(n, r, indexing="ij"))
    low = saddle_node(n, r)
    high = period_doubling(n, r)
    amplitude = low[:, np.newaxis] + position * (high - low)[:, np.newaxis]
    lift = np.sqrt(np.maximum(amplitude**2 - low[:, np.newaxis] ** 2, 0))
    return Families(n, r, low, high, amplitude, lift)


def least_gaps(known: Families) -> NDArray:
    """The least gap of the restitution model's flights in each family, over the product of the
    times since the impact and until the next one.

    It tells how far all nodes are from grazing. The quotient is smooth up to both impacts, so that
    samples between them show its least value.
    """
    low, n = (each[:, np.newaxis, np.newaxis] for each in (known.low, known.n))
    amplitude, lift = (each[..., np.newaxis] for each in (known.amplitude, known.lift))
    time = 2 * np.pi * n * np.linspace(0, 1, 501)[1:-1]
    ball = lift + n * np.pi * time - time**2 / 2
    gap = ball - amplitude * np.sin(np.arctan2(lift, low) + time)
    return (gap / (time * (2 * np.pi * n - time))).min(axis=(1, 2))


def heights_of(known: Families, ratios: NDArray, tolerance: float) -> dict[str, tuple]:
    """The ϖ from which on the height is within the tolerance at all nodes, and lines of one ϖ."""
    n = known.n
    r = known.r
    shape = known.amplitude.shape
    each_n, each_r = (np.repeat(each, shape[1]) for each in (n, r))
    amplitude = known.amplitude.ravel()
    lift = known.lift.ravel()
    lower = lower_thresholds(each_n, each_r, amplitude, lift, -tolerance)
    upwards = law_roots(each_n, each_r, lift, tolerance)
    downwards = law_roots(each_n, each_r, lift, -tolerance)
    jump, at_jump = largest_lift(n, r, ratios, tolerance)
    rises = known.lift <= jump[:, np.newaxis]
    family, _ = np.nonzero(rises)
    threshold = lower.reshape(shape).copy()
    threshold[rises] = upper_thresholds(
        n[family], r[family], known.lift[rises], at_jump[family], ratios, tolerance
    )
    product = n[:, np.newaxis] * tolerance * np.where(rises, threshold, -threshold)
    return {
        "error_threshold": (("position",), threshold),
        "lower_threshold": (("position",), lower.reshape(shape)),
        "lower_threshold_by_law": (("position",), downwards.reshape(shape)),
        "threshold_by_law": (
            ("position",),
            np.where(upwards > 0, upwards, downwards).reshape(shape),
        ),
        "rule_product": (("position",), product),
        "jump_lift": ((), jump),
        "jump_ratio": ((), np.where(np.isnan(jump), np.nan, np.exp(at_jump))),
    }


def lines_of(known: Families, levels: NDArray, of_heights: dict, parameters: dict) -> dict:
    """Where contacts of one ϖ have their bifurcations, and up to which Y₀ they bounce too high."""
    n = known.n
    r = known.r
    tolerance = parameters["tolerance"]
    contacts = SpringDamper(1.0, restitution=r).at(frequency_ratio=levels[:, np.newaxis])
    exact = contact_values(contacts, amplitude=1.0, n=n, quantities=BIFURCATIONS)
    law = law_errors(free_impact(contacts, n), amplitude=known.high)
    found = {f"{name}_law": (("level",), law[name].T) for name in BIFURCATIONS}
    for name, rigid in zip(BIFURCATIONS, (known.low, known.high), strict=True):
        found[f"{name}_error"] = ("level",), (exact[name] / rigid - 1).T
    _, jump = of_heights["jump_lift"]
    _, jump_ratio = of_heights["jump_ratio"]
    too_high = []
    by_law = []
    for level in levels:
        at_level = exact_lift(n, r, np.full(r.size, level), tolerance)
        too_high.append(np.where(level < jump_ratio, jump, at_level))
        stiffer = np.geomspace(level, parameters["frequency_ratio"]["max"], STIFFER)
        by_law.append(law_lift(n, r, stiffer[:, np.newaxis], tolerance).max(axis=0))
    return found | {
        "too_high_lift": (("level",), np.transpose(too_high)),
        "too_high_lift_by_law": (("level",), np.transpose(by_law)),
    }


def corrected_at(known: Families, levels: NDArray) -> dict[str, tuple]:
    """The errors of the corrected model's height at all nodes, for contacts of some ϖ."""
    ball = SpringDamper(levels[:, np.newaxis, np.newaxis], restitution=known.r[:, np.newaxis])
    given = {"amplitude": known.amplitude, "n": known.n[:, np.newaxis]}
    error = exact_errors(ball, simple=Corrected, quantities=["max_height"], **given)["max_height"]
    return {"corrected_error": (("level", "position"), np.moveaxis(error, 0, 1))}


def judged_at(known: Families, ratio: NDArray) -> dict[str, tuple]:
    """The orbits of all nodes on contacts of ϖ, shape (judges, families), and those in the middle
    of the window, which are the Λ at which the contact has an orbit and the restitution model none.
    """
    shape = ratio.shape[0], *known.amplitude.shape
    at_nodes = (known.n[:, np.newaxis], known.r[:, np.newaxis], known.amplitude)
    nodes = orbits_at(
        *(np.broadcast_to(each, shape) for each in (*at_nodes, ratio[..., np.newaxis]))
    )
    contacts = SpringDamper(1.0, restitution=known.r).at(frequency_ratio=ratio)
    ends = contact_values(contacts, amplitude=1.0, n=known.n, quantities=["saddle_node"])
    middle = (ends["saddle_node"] + known.low) / 2
    beside = (known.n, known.r, middle, ratio)
    window = orbits_at(*(np.broadcast_to(each, ratio.shape) for each in beside))
    error = nodes["height"] / restitution_height(known.n[:, np.newaxis], known.lift) - 1
    both = ("judge", "position")
    return {
        "judged_error": (both, np.moveaxis(error, 0, 1)),
        "judged_multiplier": (both, np.moveaxis(nodes["multiplier"], 0, 1)),
        "judged_stable": (both, np.moveaxis(nodes["stable"] == 1, 0, 1)),
        "window_amplitude": (("judge",), middle.T),
        "window_stable": (("judge",), window["stable"].T == 1),
    }


def ext_map(parameters: dict) -> xr.Dataset:
    """The ϖ from which on a contact is stable and bounces as high as the restitution model, and the
    amplitudes next to its saddle-node and its period doubling at which it is not.

    Λ = Λ_SN + p (Λ_PD - Λ_SN) has the position p in the stable range of the restitution model.
    Next to the saddle-node the error changes with √p, so that the positions, p = sin² of evenly
    spaced angles, are dense there, and at the period doubling as well. `rule_product` is nϖe with
    the signed error e at the threshold of the height. A `level` is a ϖ of lines in the map. A
    `judge` is one of two ϖ that are tried at all nodes, that of the rule of thumb 1/(nε) and that
    of the paper.
    """
    limits = parameters["restitution"]
    tolerance = parameters["tolerance"]
    ratios = grid(parameters["frequency_ratio"])
    n = np.array(parameters["n"])
    r = np.linspace(limits["min"], limits["max"], limits["samples"]).round(12)
    position = np.sin(np.linspace(0.0, np.pi / 2, parameters["positions"])) ** 2
    known = families_of(n, r, position)
    rule = 1 / (n * tolerance)
    levels = np.unique([*LEVELS, *rule, parameters["paper"]])
    judged = np.array([rule, np.full(n.size, float(parameters["paper"]))])
    heights = heights_of(known, ratios, tolerance)
    stable = doubling_thresholds(known.n, known.r, known.amplitude, ratios)
    stable_by_law = law_doubling_thresholds(known.n, known.r, known.amplitude)
    variables = {
        "saddle_node_amplitude": ((), known.low),
        "period_doubling_amplitude": ((), known.high),
        "amplitude": (("position",), known.amplitude),
        "least_gap": ((), least_gaps(known)),
        **heights,
        "stability_threshold": (("position",), stable),
        "stability_by_law": (("position",), stable_by_law),
        **lines_of(known, levels, heights, parameters),
        **corrected_at(known, levels),
        **judged_at(known, np.repeat(judged, r.size, axis=1)),
    }
    by_family = {}
    for name, (others, values) in variables.items():
        dimensions = ("n", "restitution", *others)
        by_family[name] = dimensions, values.reshape(n.size, r.size, *values.shape[1:])
    return xr.Dataset(
        by_family | {"judged_ratio": (("judge", "n"), judged), "law_differs_above": MARKED},
        {
            "n": n,
            "restitution": r,
            "position": position,
            "level": levels,
            "judge": list(JUDGES),
        },
    )


STAGE = {"ext_map": ext_map}

if __name__ == "__main__":
    sys.stderr = open(snakemake.log[0], "w", encoding="utf-8")  # what goes wrong is in the log
    save_stage(
        STAGE,
        snakemake.params.entries,
        snakemake.params.settings,
        snakemake.output,
        snakemake.input.code,
        VARIABLES,
    )

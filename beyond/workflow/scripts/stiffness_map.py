"""Stage: how stiff a contact must be for the greatest height, over all stable orbits."""

import sys

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from bouncing_ball.datasets import grid, save_stage
from bouncing_ball.restitution import period_doubling, saddle_node
from bouncing_ball_beyond.balls import SpringDamper
from bouncing_ball_beyond.equations import OrbitEquations
from bouncing_ball_beyond.error_law import contact_values, free_impact
from bouncing_ball_beyond.periodic import guess_of_instants
from bouncing_ball_beyond.paths import Parameter
from studies.orbits import flight_height, solved
from studies.variables import VARIABLES

# Share by which the frequency ratio of the error law differs from the exact one where it is marked.
MARKED = 0.1

# The law is within some per cent of the exact error. Where its largest error is nearer to the
# tolerance, it does not tell whether the exact one reaches it.
DOUBTFUL = 0.2

# Newton's method leaves rounding errors, some 1e-15, or fails.
CONVERGED = 1e-12


def law_roots(n: int, r: NDArray, amplitude: NDArray, height: NDArray, error: float):
    """The ϖ at which the height has an error by the law: one over the smallest positive root of

    (k² + s₁²) u² + 2 [k (Y₀ + EH) - C s₁] u + 2 Y₀EH + (EH)² = 0, Y₀ + EH + ku ≥ 0 (Eq. R9).

    It is 0 where there is none. The second array is the discriminant as a share of the square of
    the middle term: 0 where the largest error by the law is E, and -1 where errors do not rise.
    """
    unit = free_impact(SpringDamper(1.0, restitution=r), n)
    line = unit.speed - n * np.pi
    shift = unit.load / (1 + unit.slope)
    k = shift * line + unit.speed * unit.centroid
    lift = height - (n * np.pi) ** 2 / 2
    step = error * height
    a = k**2 + shift**2
    b = k * (lift + step) - line * shift
    c = step * (2 * lift + step)
    discriminant = b**2 - a * c
    root = np.sqrt(np.maximum(discriminant, 0))
    both = np.array([-b - root, -b + root]) / a
    allowed = (both > 0) & (lift + step + k * both >= 0) & (discriminant >= 0)
    smallest = np.where(allowed, both, np.inf).min(axis=0)
    return 1 / smallest, np.where(b < 0, discriminant / b**2, -1.0)


def of_family(n: int, r: NDArray, position: NDArray, parameters: dict) -> dict[str, NDArray]:
    """The variables of the map at the nodes of one family, shape (restitution, position)."""
    tolerance = parameters["tolerance"]
    low = saddle_node(n, r)[:, np.newaxis]
    nodes = low + position * (period_doubling(n, r)[:, np.newaxis] - low)
    amplitude = nodes.ravel()
    r = np.repeat(r, position.size)
    height = np.sqrt(amplitude**2 - saddle_node(n, r) ** 2) + (n * np.pi) ** 2 / 2
    # An error that rises reaches the positive tolerance at a larger ϖ than the negative one.
    upper, reached = law_roots(n, r, amplitude, height, tolerance)
    lower, _ = law_roots(n, r, amplitude, height, -tolerance)
    by_law = np.where(upper > 0, upper, lower)
    sign = np.where(upper > 0, 1.0, -1.0)
    ratio = by_law.copy()
    doubtful = np.abs(reached) < DOUBTFUL
    ball = SpringDamper(1.0, restitution=r[doubtful])
    ratio[doubtful], sign[doubtful] = scanned(
        ball, n, amplitude[doubtful], height[doubtful], parameters
    )
    ball = SpringDamper(1.0, restitution=r).at(frequency_ratio=ratio)
    guess = guess_of_instants(ball, np.full(r.size, n), amplitude)
    guess[:, -1] = ratio
    along = (Parameter("frequency_ratio"),)
    sought = (1 + sign * tolerance) * height
    searched = OrbitEquations(ball, 1, n, amplitude, along)
    z = solved(searched, guess, lambda z: (flight_height(searched, z) - sought)[:, np.newaxis])
    equations = OrbitEquations(ball.at(frequency_ratio=z[:, -1]), 1, n, amplitude, along)
    trace, determinant = equations.trace_and_determinant(equations.linear(z))
    stable = (np.abs(trace / (1 + determinant)) < 1) & (np.abs(determinant) < 1)
    stable &= np.abs(flight_height(equations, z) / sought - 1) < CONVERGED
    stable[stable] = equations.rows(stable).admissible(z[stable])
    threshold = np.where(stable, z[:, -1], np.nan)
    found = {
        "amplitude": amplitude,
        "error_threshold": threshold,
        "threshold_by_law": by_law,
        "rule_product": n * threshold * sign * tolerance,
    }
    return {name: values.reshape(nodes.shape) for name, values in found.items()}


def scanned(
    ball: SpringDamper, n: int, amplitude: NDArray, height: NDArray, parameters: dict
) -> tuple[NDArray, NDArray]:
    """Next to which ϖ the error of the height comes into the tolerance, and with which sign, by a
    scan along ϖ.
    """
    tolerance = parameters["tolerance"]
    ratios = grid(parameters["frequency_ratio"])
    along = ball.at(frequency_ratio=ratios[:, np.newaxis])
    found = contact_values(along, amplitude=amplitude, n=n, quantities=["max_height"])
    error = found["max_height"] / height - 1
    # The last sample before the first one from the stiff end that is beyond the tolerance.
    inside = np.minimum.accumulate(np.abs(error[::-1]) <= tolerance)
    last = ratios.size - 1 - inside.sum(axis=0)
    pair = np.clip([last, last + 1], 0, ratios.size - 1)
    before, after = np.take_along_axis(error, pair, axis=0)
    sign = np.sign(before)
    share = (sign * tolerance - after) / (before - after)
    return 1 / (share / ratios[pair[0]] + (1 - share) / ratios[pair[1]]), sign


def ext_map(parameters: dict) -> xr.Dataset:
    """The ϖ from which on the greatest height of the restitution model is within the tolerance.

    Λ = Λ_SN + p (Λ_PD - Λ_SN) has the position p in the stable range of the restitution model.
    Next to the saddle-node the error changes with √p, so that the positions, p = sin² of evenly
    spaced angles, are dense there, and at the period doubling as well. `rule_product` is nϖe with
    the signed error e at the threshold. It and the threshold are NaN where the contact has no
    stable and admissible orbit there.
    """
    limits = parameters["restitution"]
    r = np.linspace(limits["min"], limits["max"], limits["samples"]).round(12)
    position = np.sin(np.linspace(0.0, np.pi / 2, parameters["positions"])) ** 2
    families = [of_family(n, r, position, parameters) for n in parameters["n"]]
    shape = ("n", "restitution", "position")
    return xr.Dataset(
        {name: (shape, [family[name] for family in families]) for name in families[0]}
        | {"law_differs_above": MARKED},
        {"n": parameters["n"], "restitution": r, "position": position},
    )


STAGE = {
    "ext_map": (ext_map, "How stiff a contact must be for the greatest height, over r and Λ"),
}

if __name__ == "__main__":
    sys.stderr = open(snakemake.log[0], "w", encoding="utf-8")  # what goes wrong is in the log
    save_stage(
        STAGE, snakemake.params.config, {}, snakemake.output, snakemake.input.code, VARIABLES
    )

"""How often the 95 % interval of r holds the truth, in simulated recordings.

``python tests/interval_coverage.py [RECORDINGS]`` prints a table, the last eight lines of which are
kinds that were made after the priors had been chosen: the share of recordings whose
interval holds the true r; the median of its half width, beside the bound of 95 % of the errors of
r, which is the half width that an ideal interval about the same r would have, and beside that of a
straight line in ln v with known errors; and the share in which the true law is rejected, if it is
one of the fitted laws.
"""

import math
import sys
from functools import partial

import numpy as np

from bouncing_ball_contacts.fits import (
    LAWS,
    G,
    impacts_of,
    judge,
    posterior,
    predicted,
    quantile,
)
from bouncing_ball_contacts.recordings import Recording


def power(e, slope, v):
    return e * (v / 2.0) ** slope


def of_law(name, e, v):
    """Return r of a fitted law that has r = e at 2 m/s."""
    law = LAWS[name][0]
    low, high = 1e-6, 2.0
    for _ in range(60):
        a = (low + high) / 2
        low, high = (a, high) if law(a, np.array([2.0]))[0] > math.log(e) else (low, a)
    return np.exp(law(a, np.atleast_1d(np.asarray(v, float))))


CONSTANT, VISCOELASTIC, CROSSLEY = LAWS


def flights(rng, r, impacts, error, scatter, recordings=1, start=3.6):
    chains = []
    for _ in range(recordings):
        v = start * rng.uniform(0.95, 1.05)
        times = [0.0]
        for _ in range(impacts + 1):
            times.append(times[-1] + 2 * v / G)
            v *= float(np.squeeze(r(v))) * math.exp(scatter * rng.normal())
        noisy = np.array(times) + error * rng.normal(size=len(times))
        chains.append(np.diff(noisy))
    return Recording("flights", "flights", tuple(chains))


def rounded(rng, r, impacts, digits, scatter):
    """Times that are rounded to frames of a camera."""
    found = flights(rng, r, impacts, 0.0, scatter)
    times = np.concatenate([[0.0], np.cumsum(found.chains[0])]) + rng.uniform(0, digits)
    return Recording("flights", "flights", (np.diff(np.round(times / digits) * digits),))


def tops(rng, r, impacts, error, scatter):
    v = 5.0
    heights = []
    for _ in range(impacts + 1):
        heights.append(v**2 / (2 * G) + error * rng.normal())
        v *= float(np.squeeze(r(v))) * math.exp(scatter * rng.normal())
    return Recording("heights", "heights", (np.array(heights),))


def drops(rng, r, heights, each, error, scatter):
    h = np.repeat(heights, each)
    v = np.sqrt(2 * G * h)
    up = h * (r(v) * np.exp(scatter * rng.normal(size=len(h)))) ** 2
    # The drop height is set, the rebound is read.
    return Recording(
        "drops", "drops", (np.column_stack([h, up + error * rng.normal(size=len(h))]),)
    )


def speeds(rng, r, v, error, scatter):
    out = v * r(v) * np.exp(scatter * rng.normal(size=len(v)))
    noisy = [v + error * rng.normal(size=len(v)), out + error * rng.normal(size=len(v))]
    return Recording("speeds", "speeds", (np.column_stack(noisy),))


def coefficients(rng, r, v, error, scatter, stated):
    e = r(v) * np.exp(scatter * rng.normal(size=len(v))) + error * rng.normal(size=len(v))
    given = np.full(len(v), error) if stated else None
    return Recording("coefficients", "coefficients", (np.column_stack([v, e]),), given)


HIGH = np.array([0.2, 0.5, 1.0, 1.5, 2.0])
FEW = np.array([0.3, 0.6, 1.2])
SPREAD = np.linspace(1, 4, 10)
WIDE = np.geomspace(0.3, 6, 15)
NEAR = np.linspace(1.8, 2.2, 6)
FLAT = partial(of_law, CONSTANT, 0.82)
SOFT = partial(of_law, VISCOELASTIC, 0.82)
STEEP = partial(of_law, CROSSLEY, 0.75)
# Name, true r, the law of it if it is one that is fitted, recording, stated resolution.
KINDS = [
    ("7 impacts heard, 0.7 ms", FLAT, CONSTANT, partial(flights, impacts=7, error=7e-4, scatter=0)),
    (
        "7 impacts heard, 0.7 ms, scatter 0.01",
        FLAT,
        CONSTANT,
        partial(flights, impacts=7, error=7e-4, scatter=0.01),
    ),
    (
        "7 impacts heard, scatter 0.01 alone",
        SOFT,
        VISCOELASTIC,
        partial(flights, impacts=7, error=0, scatter=0.01),
    ),
    (
        "7 impacts heard, 0.7 ms, v^-0.05",
        partial(power, 0.82, -0.05),
        None,
        partial(flights, impacts=7, error=7e-4, scatter=0),
    ),
    ("3 impacts heard, 2 ms", FLAT, CONSTANT, partial(flights, impacts=3, error=2e-3, scatter=0)),
    (
        "5 recordings of 6 impacts, 1 ms, scatter 0.007",
        SOFT,
        VISCOELASTIC,
        partial(flights, impacts=6, error=1e-3, scatter=0.007, recordings=5),
    ),
    (
        "8 impacts filmed, times rounded to 1/30 s",
        FLAT,
        CONSTANT,
        partial(rounded, impacts=8, digits=1 / 30, scatter=0),
    ),
    (
        "8 impacts filmed, times rounded to 1/240 s, scatter 0.01",
        FLAT,
        CONSTANT,
        partial(rounded, impacts=8, digits=1 / 240, scatter=0.01),
    ),
    (
        "6 tops read to 3 mm, v^-0.05",
        partial(power, 0.82, -0.05),
        None,
        partial(tops, impacts=6, error=3e-3, scatter=0),
    ),
    (
        "15 drops read to 5 mm, v^-0.05",
        partial(power, 0.82, -0.05),
        None,
        partial(drops, heights=HIGH, each=3, error=5e-3, scatter=0),
    ),
    (
        "15 drops read to 5 mm, scatter 0.01",
        SOFT,
        VISCOELASTIC,
        partial(drops, heights=HIGH, each=3, error=5e-3, scatter=0.01),
    ),
    (
        "15 drops, scatter 0.02 alone, v^-0.2",
        partial(power, 0.6, -0.2),
        None,
        partial(drops, heights=HIGH, each=3, error=0, scatter=0.02),
    ),
    (
        "3 drops read to 5 mm",
        FLAT,
        CONSTANT,
        partial(drops, heights=FEW, each=1, error=5e-3, scatter=0),
    ),
    (
        "10 pairs of speeds to 0.02 m/s, Hunt and Crossley",
        STEEP,
        CROSSLEY,
        partial(speeds, v=SPREAD, error=0.02, scatter=0),
    ),
    (
        "10 pairs of speeds to 0.05 m/s, 1 - 0.05 v",
        lambda v: 1 - 0.05 * np.asarray(v),
        None,
        partial(speeds, v=SPREAD, error=0.05, scatter=0.005),
    ),
    (
        "15 coefficients over a factor of 20, scatter 0.004",
        SOFT,
        VISCOELASTIC,
        partial(coefficients, v=WIDE, error=0, scatter=0.004, stated=False),
    ),
    (
        "10 coefficients with stated errors of 0.01",
        SOFT,
        VISCOELASTIC,
        partial(coefficients, v=SPREAD, error=0.01, scatter=0, stated=True),
    ),
    (
        "10 coefficients with stated errors of 0.005, scatter 0.015",
        FLAT,
        CONSTANT,
        partial(coefficients, v=SPREAD, error=0.005, scatter=0.015, stated=True),
    ),
    (
        "6 coefficients at nearly one speed, 0.01",
        FLAT,
        CONSTANT,
        partial(coefficients, v=NEAR, error=0.01, scatter=0, stated=False),
    ),
    (
        "7 impacts heard, 0.7 ms, resolution stated",
        FLAT,
        CONSTANT,
        partial(flights, impacts=7, error=7e-4, scatter=0),
        7e-4,
    ),
    (
        "7 impacts heard, 0.7 ms, scatter 0.01, resolution stated",
        FLAT,
        CONSTANT,
        partial(flights, impacts=7, error=7e-4, scatter=0.01),
        7e-4,
    ),
]
# Kinds that were made after the priors of the fit had been chosen.
FRESH = [
    (
        "12 impacts heard, 0.3 ms, scatter 0.005, v^-0.02",
        partial(power, 0.9, -0.02),
        None,
        partial(flights, impacts=12, error=3e-4, scatter=0.005),
    ),
    (
        "5 impacts heard, 1 ms, scatter 0.02",
        partial(of_law, CONSTANT, 0.7),
        CONSTANT,
        partial(flights, impacts=5, error=1e-3, scatter=0.02, start=4.5),
    ),
    (
        "3 recordings of 4 impacts, 0.5 ms, scatter 0.01",
        partial(of_law, VISCOELASTIC, 0.6),
        VISCOELASTIC,
        partial(flights, impacts=4, error=5e-4, scatter=0.01, recordings=3, start=4.0),
    ),
    (
        "6 impacts filmed, times rounded to 1/120 s, v^-0.05",
        partial(power, 0.85, -0.05),
        None,
        partial(rounded, impacts=6, digits=1 / 120, scatter=0),
    ),
    (
        "9 tops read to 1 mm, scatter 0.01",
        SOFT,
        VISCOELASTIC,
        partial(tops, impacts=9, error=1e-3, scatter=0.01),
    ),
    (
        "8 drops read to 2 mm, scatter 0.005, v^-0.1",
        partial(power, 0.7, -0.1),
        None,
        partial(drops, heights=np.array([0.1, 0.3, 0.8, 1.8]), each=2, error=2e-3, scatter=0.005),
    ),
    (
        "20 pairs of speeds to 0.01 m/s, scatter 0.01, Hunt and Crossley",
        partial(of_law, CROSSLEY, 0.85),
        CROSSLEY,
        partial(speeds, v=np.linspace(0.5, 3, 20), error=0.01, scatter=0.01),
    ),
    (
        "25 coefficients over a factor of 10, scatter 0.02, 1 - 0.05 v",
        lambda v: 1 - 0.05 * np.asarray(v),
        None,
        partial(coefficients, v=np.geomspace(0.5, 5, 25), error=0, scatter=0.02, stated=False),
    ),
]


def ideal(impacts, error, scatter, at):
    """Return the half width of a straight line in ln v if the errors are known."""
    n = len(impacts.log_r)
    errors = error**2 * impacts.readings @ impacts.readings.T
    covariance = errors + (scatter**2 + 1e-10) * np.eye(n)
    x = np.column_stack([np.ones(n), np.log(impacts.speed / at)])
    inverse = np.linalg.inv(x.T @ np.linalg.solve(covariance, x))
    return 1.96 * math.sqrt(inverse[0, 0])


def study(kind, recordings, seed):
    name, r, law, make, *stated = kind
    rng = np.random.default_rng(seed)
    held = 0
    rejected = 0
    widths = []
    best = []
    missed = []
    for _ in range(recordings):
        recording = make(rng, r)
        impacts = impacts_of(recording)
        known = stated[0] if stated else recording.uncertainty
        found = posterior(impacts, known)
        at = math.exp(float(np.mean(np.log(impacts.speed))))
        means, deviations = predicted(impacts, found, at)
        ends = [quantile(q, means, deviations, found.weights) for q in (0.025, 0.975)]
        truth = math.log(float(np.squeeze(r(at))))
        held += ends[0] <= truth <= ends[1]
        widths.append((ends[1] - ends[0]) / 2)
        missed.append(abs(quantile(0.5, means, deviations, found.weights) - truth))
        error = make.keywords.get("error", make.keywords.get("digits", 0.0) / math.sqrt(12))
        best.append(ideal(impacts, error, make.keywords["scatter"], at))
        if law is not None:
            judged = judge(impacts, found, at, known is not None)
            rejected += any(each.law == law and each.probability < 0.005 for each in judged)
    e = math.exp(truth)
    spread = np.quantile(missed, 0.95)
    return held, np.median(widths) * e, spread * e, np.median(best) * e, rejected


def main():
    recordings = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    print(
        "| recording | held, % | half width | 95 % of the errors are below | ratio | half width of "
        "a line with known errors | true law rejected, % |"
    )
    print("| --- | --- | --- | --- | --- | --- | --- |")
    for i, kind in enumerate(KINDS + FRESH):
        held, width, spread, best, rejected = study(kind, recordings, i)
        share = f"{100 * rejected / recordings:.1f}" if kind[2] else "–"
        print(
            f"| {kind[0]} | {100 * held / recordings:.1f} | {width:.4f} | {spread:.4f} | "
            f"{width / spread:.1f} | {best:.4f} | {share} |",
            flush=True,
        )


if __name__ == "__main__":
    main()

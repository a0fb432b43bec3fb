"""How often the 95 % interval of r holds the truth, in simulated recordings.

That of recordings without scatter is the interval for no scatter, if the answer has one.

``python tests/interval_coverage.py [RECORDINGS [KIND]...]`` prints a table: the share of recordings
whose interval holds the true r; the median of its half width; how many times wider the intervals
are than ones about the same r that hold it in 95 %; and the share in which the true law is
rejected, if it is one of the fitted laws.
"""

import math
import sys
from dataclasses import astuple
from functools import partial

import numpy as np

from bouncing_ball_contacts.intervals import curves_of, estimates, impacts_of
from bouncing_ball_contacts.laws import LAWS, judge
from bouncing_ball_contacts.recordings import Recording, rounding_of
from bouncing_ball_contacts.units import STANDARD_GRAVITY as G


def power(e, slope, v):
    return e * (v / 2.0) ** slope


def of_law(name, e, v):
    """Return r of a fitted law that has r = e at 2 m/s."""
    law = LAWS[name]
    return np.exp(law.log_r(law.damping(e) / 2.0**law.speed, np.asarray(v, float)))


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
    rounded_times = np.round(times / digits) * digits
    return Recording("flights", "flights", (np.diff(rounded_times),), are_times=True, digit=digits)


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


FLAT = partial(of_law, CONSTANT)
SOFT = partial(of_law, VISCOELASTIC)
STEEP = partial(of_law, CROSSLEY)
# Each recording has a scatter of its own if it is None, from a log-normal distribution like that of
# the published experiments: its middle, and the width of its logarithm.
PUBLISHED = 0.011
WIDTH = 1.5
# Name, true r, the law of it if it is one that is fitted, recording, stated resolution.
KINDS = [
    (
        "6 impacts heard, 0.4 ms",
        partial(FLAT, 0.75),
        CONSTANT,
        partial(flights, impacts=6, error=4e-4, scatter=0, start=4.2),
    ),
    (
        "9 impacts heard, 1 ms, v^-0.05",
        partial(power, 0.85, -0.05),
        None,
        partial(flights, impacts=9, error=1e-3, scatter=0, start=4.0),
    ),
    (
        "4 impacts heard, 1 ms",
        partial(SOFT, 0.8),
        VISCOELASTIC,
        partial(flights, impacts=4, error=1e-3, scatter=0),
    ),
    (
        "10 impacts heard, 0.5 ms, scatter 0.007",
        partial(SOFT, 0.8),
        VISCOELASTIC,
        partial(flights, impacts=10, error=5e-4, scatter=0.007, start=4.4),
    ),
    (
        "6 impacts heard, scatter 0.015 alone",
        partial(FLAT, 0.65),
        CONSTANT,
        partial(flights, impacts=6, error=0, scatter=0.015, start=4.4),
    ),
    (
        "4 recordings of 5 impacts, 0.8 ms, scatter 0.005, v^-0.05",
        partial(power, 0.8, -0.05),
        None,
        partial(flights, impacts=5, error=8e-4, scatter=0.005, recordings=4),
    ),
    (
        "8 impacts heard, 0.5 ms, resolution stated",
        partial(FLAT, 0.8),
        CONSTANT,
        partial(flights, impacts=8, error=5e-4, scatter=0, start=4.0),
        5e-4,
    ),
    (
        "8 impacts heard, 0.5 ms, scatter 0.01, resolution stated",
        partial(SOFT, 0.8),
        VISCOELASTIC,
        partial(flights, impacts=8, error=5e-4, scatter=0.01, start=4.0),
        5e-4,
    ),
    (
        "7 impacts filmed, times rounded to 1/60 s",
        partial(FLAT, 0.78),
        CONSTANT,
        partial(rounded, impacts=7, digits=1 / 60, scatter=0),
    ),
    (
        "10 impacts filmed, times rounded to 1/240 s, scatter 0.008, v^-0.03",
        partial(power, 0.84, -0.03),
        None,
        partial(rounded, impacts=10, digits=1 / 240, scatter=0.008),
    ),
    (
        "5 tops read to 2 mm, v^-0.05",
        partial(power, 0.8, -0.05),
        None,
        partial(tops, impacts=5, error=2e-3, scatter=0),
    ),
    (
        "8 tops read to 2 mm, scatter 0.012",
        partial(FLAT, 0.84),
        CONSTANT,
        partial(tops, impacts=8, error=2e-3, scatter=0.012),
    ),
    (
        "12 drops read to 4 mm, v^-0.05",
        partial(power, 0.75, -0.05),
        None,
        partial(drops, heights=np.array([0.2, 0.5, 1.0, 1.8]), each=3, error=4e-3, scatter=0),
    ),
    (
        "20 drops read to 3 mm, scatter 0.015, Hunt and Crossley",
        partial(STEEP, 0.7),
        CROSSLEY,
        partial(drops, heights=np.geomspace(0.1, 2, 5), each=4, error=3e-3, scatter=0.015),
    ),
    (
        "5 drops read to 4 mm",
        partial(SOFT, 0.7),
        VISCOELASTIC,
        partial(drops, heights=np.geomspace(0.2, 1.5, 5), each=1, error=4e-3, scatter=0),
    ),
    (
        "12 pairs of speeds to 0.03 m/s",
        partial(SOFT, 0.75),
        VISCOELASTIC,
        partial(speeds, v=np.linspace(1, 5, 12), error=0.03, scatter=0),
    ),
    (
        "18 coefficients over a factor of 15, scatter 0.006, v^-0.05",
        partial(power, 0.8, -0.05),
        None,
        partial(coefficients, v=np.geomspace(0.3, 4.5, 18), error=0, scatter=0.006, stated=False),
    ),
    (
        "12 coefficients with stated errors of 0.008",
        partial(FLAT, 0.6),
        CONSTANT,
        partial(coefficients, v=np.linspace(0.5, 3, 12), error=8e-3, scatter=0, stated=True),
    ),
    (
        "12 coefficients with stated errors of 0.004, scatter 0.012, 1 - 0.04 v",
        lambda v: 1 - 0.04 * np.asarray(v),
        None,
        partial(coefficients, v=np.linspace(1, 5, 12), error=4e-3, scatter=0.012, stated=True),
    ),
    (
        "15 pairs of speeds to 0.01 m/s, scatter 0.01, Hunt and Crossley",
        partial(STEEP, 0.6),
        CROSSLEY,
        partial(speeds, v=np.linspace(0.8, 4, 15), error=0.01, scatter=0.01),
    ),
    (
        "24 drops read to 2 mm, scatter 0.01",
        partial(SOFT, 0.6),
        VISCOELASTIC,
        partial(drops, heights=np.geomspace(0.15, 2.5, 6), each=4, error=2e-3, scatter=0.01),
    ),
    (
        "7 coefficients at nearly one speed, scatter 0.02",
        partial(FLAT, 0.55),
        CONSTANT,
        partial(coefficients, v=np.linspace(2.9, 3.2, 7), error=0, scatter=0.02, stated=False),
    ),
    (
        "3 impacts heard, 2 ms",
        partial(FLAT, 0.7),
        CONSTANT,
        partial(flights, impacts=3, error=2e-3, scatter=0, start=4.0),
    ),
    (
        "5 impacts heard, 0.5 ms, scatter 0.01",
        partial(SOFT, 0.75),
        VISCOELASTIC,
        partial(flights, impacts=5, error=5e-4, scatter=0.01, start=4.2),
    ),
    (
        "5 tops read to 3 mm, scatter 0.02",
        partial(FLAT, 0.8),
        CONSTANT,
        partial(tops, impacts=5, error=3e-3, scatter=0.02),
    ),
    (
        "4 pairs of speeds to 0.02 m/s",
        partial(SOFT, 0.85),
        VISCOELASTIC,
        partial(speeds, v=np.linspace(1, 4, 4), error=0.02, scatter=0),
    ),
    (
        "4 impacts heard, 0.1 ms, scatter 0.02",
        partial(FLAT, 0.7),
        CONSTANT,
        partial(flights, impacts=4, error=1e-4, scatter=0.02, start=4.2),
    ),
    (
        "9 impacts filmed, times rounded to 1/120 s, scatter 0.007",
        partial(SOFT, 0.82),
        VISCOELASTIC,
        partial(rounded, impacts=9, digits=1 / 120, scatter=0.007),
    ),
    (
        "9 impacts filmed, times rounded to 1/120 s, scatter 0.007, resolution stated",
        partial(SOFT, 0.82),
        VISCOELASTIC,
        partial(rounded, impacts=9, digits=1 / 120, scatter=0.007),
        1 / 120 / math.sqrt(12),
    ),
    (
        "6 impacts filmed, times rounded to 1/60 s, scatter 0.02",
        partial(FLAT, 0.7),
        CONSTANT,
        partial(rounded, impacts=6, digits=1 / 60, scatter=0.02),
    ),
    (
        "12 impacts filmed, times rounded to 1/240 s, scatter 0.015",
        partial(SOFT, 0.85),
        VISCOELASTIC,
        partial(rounded, impacts=12, digits=1 / 240, scatter=0.015),
    ),
    (
        "8 impacts filmed, times rounded to 1/30 s",
        partial(FLAT, 0.8),
        CONSTANT,
        partial(rounded, impacts=8, digits=1 / 30, scatter=0),
    ),
    (
        "8 impacts filmed, times rounded to 1/120 s, scatter 0.02, resolution stated",
        partial(FLAT, 0.75),
        CONSTANT,
        partial(rounded, impacts=8, digits=1 / 120, scatter=0.02),
        1 / 120 / math.sqrt(12),
    ),
    (
        "6 impacts, times typed to 0.01 s, scatter 0.01",
        partial(FLAT, 0.78),
        CONSTANT,
        partial(rounded, impacts=6, digits=0.01, scatter=0.01),
    ),
    (
        "7 impacts heard, 0.3 ms, scatter 0.03",
        partial(FLAT, 0.75),
        CONSTANT,
        partial(flights, impacts=7, error=3e-4, scatter=0.03, start=4.0),
    ),
    (
        "14 impacts heard, 1 ms, scatter 0.004",
        partial(SOFT, 0.88),
        VISCOELASTIC,
        partial(flights, impacts=14, error=1e-3, scatter=0.004, start=4.0),
    ),
    (
        "3 recordings of 4 impacts, 0.5 ms, scatter 0.02",
        partial(SOFT, 0.7),
        VISCOELASTIC,
        partial(flights, impacts=4, error=5e-4, scatter=0.02, recordings=3),
    ),
    (
        "6 tops read to 5 mm, scatter 0.006",
        partial(SOFT, 0.82),
        VISCOELASTIC,
        partial(tops, impacts=6, error=5e-3, scatter=0.006),
    ),
    (
        "10 drops read to 2 mm, scatter 0.03",
        partial(FLAT, 0.65),
        CONSTANT,
        partial(drops, heights=np.geomspace(0.2, 2, 5), each=2, error=2e-3, scatter=0.03),
    ),
    (
        "30 drops read to 1 mm, scatter 0.004, v^-0.1",
        partial(power, 0.6, -0.1),
        None,
        partial(drops, heights=np.geomspace(0.1, 2, 10), each=3, error=1e-3, scatter=0.004),
    ),
    (
        "8 pairs of speeds to 0.05 m/s, scatter 0.005",
        partial(FLAT, 0.9),
        CONSTANT,
        partial(speeds, v=np.linspace(1, 5, 8), error=0.05, scatter=0.005),
    ),
    (
        "9 coefficients over a factor of 5, scatter 0.035",
        partial(SOFT, 0.5),
        VISCOELASTIC,
        partial(coefficients, v=np.geomspace(1, 5, 9), error=0, scatter=0.035, stated=False),
    ),
    (
        "6 coefficients with stated errors of 0.01, scatter 0.003",
        partial(FLAT, 0.7),
        CONSTANT,
        partial(coefficients, v=np.linspace(1, 3, 6), error=0.01, scatter=0.003, stated=True),
    ),
    (
        "5 impacts heard, 0.2 ms, any scatter",
        partial(FLAT, 0.7),
        CONSTANT,
        partial(flights, impacts=5, error=2e-4, scatter=None, start=4.2),
    ),
    (
        "8 impacts heard, 0.7 ms, any scatter",
        partial(SOFT, 0.85),
        VISCOELASTIC,
        partial(flights, impacts=8, error=7e-4, scatter=None, start=4.2),
    ),
    (
        "12 impacts heard, 1.5 ms, any scatter",
        partial(FLAT, 0.9),
        CONSTANT,
        partial(flights, impacts=12, error=1.5e-3, scatter=None),
    ),
    (
        "20 impacts heard, 0.5 ms, any scatter, v^-0.02",
        partial(power, 0.9, -0.02),
        None,
        partial(flights, impacts=20, error=5e-4, scatter=None),
    ),
    (
        "3 recordings of 5 impacts, 1 ms, any scatter",
        partial(SOFT, 0.75),
        VISCOELASTIC,
        partial(flights, impacts=5, error=1e-3, scatter=None, recordings=3),
    ),
    (
        "9 impacts heard, 0.3 ms, any scatter, resolution stated",
        partial(SOFT, 0.8),
        VISCOELASTIC,
        partial(flights, impacts=9, error=3e-4, scatter=None),
        3e-4,
    ),
    (
        "7 impacts filmed, times rounded to 1/60 s, any scatter",
        partial(FLAT, 0.75),
        CONSTANT,
        partial(rounded, impacts=7, digits=1 / 60, scatter=None),
    ),
    (
        "10 impacts filmed, times rounded to 1/240 s, any scatter",
        partial(SOFT, 0.85),
        VISCOELASTIC,
        partial(rounded, impacts=10, digits=1 / 240, scatter=None),
    ),
    (
        "4 tops read to 5 mm, any scatter",
        partial(FLAT, 0.8),
        CONSTANT,
        partial(tops, impacts=4, error=5e-3, scatter=None),
    ),
    (
        "7 tops read to 3 mm, any scatter",
        partial(SOFT, 0.85),
        VISCOELASTIC,
        partial(tops, impacts=7, error=3e-3, scatter=None),
    ),
    (
        "15 drops read to 5 mm, any scatter",
        partial(SOFT, 0.7),
        VISCOELASTIC,
        partial(drops, heights=np.geomspace(0.2, 2, 5), each=3, error=5e-3, scatter=None),
    ),
    (
        "8 drops from one height read to 2 mm, any scatter",
        partial(FLAT, 0.65),
        CONSTANT,
        partial(drops, heights=np.array([1.0]), each=8, error=2e-3, scatter=None),
    ),
    (
        "6 pairs of speeds to 0.02 m/s, any scatter",
        partial(FLAT, 0.8),
        CONSTANT,
        partial(speeds, v=np.linspace(1, 4, 6), error=0.02, scatter=None),
    ),
    (
        "15 pairs of speeds to 0.05 m/s, any scatter, Hunt and Crossley",
        partial(STEEP, 0.65),
        CROSSLEY,
        partial(speeds, v=np.linspace(1, 5, 15), error=0.05, scatter=None),
    ),
    (
        "10 coefficients over a factor of 8, any scatter, v^-0.08",
        partial(power, 0.7, -0.08),
        None,
        partial(coefficients, v=np.geomspace(0.5, 4, 10), error=2e-3, scatter=None, stated=False),
    ),
    (
        "8 coefficients with stated errors of 0.005, any scatter",
        partial(SOFT, 0.6),
        VISCOELASTIC,
        partial(coefficients, v=np.linspace(1, 4, 8), error=5e-3, scatter=None, stated=True),
    ),
]


def answer(kind, rng):
    """Return the answers, with scatter and without, to one recording of a kind; and what is true.

    The last ones are whether it scatters, ln r, and whether the true law is rejected.
    """
    _, r, law, make, *stated = kind
    scatter = make.keywords["scatter"]
    if scatter is None:
        scatter = PUBLISHED * math.exp(WIDTH * rng.normal())
    recording = make(rng, r, scatter=scatter)
    # Flights of no duration are refused.
    while np.min(np.concatenate(recording.chains)) <= 0:
        recording = make(rng, r, scatter=scatter)
    impacts = impacts_of(recording)
    known = stated[0] if stated else recording.uncertainty
    at = math.exp(float(np.mean(np.log(impacts.speed))))
    curves = curves_of(impacts, known, at, rounding_of(recording))
    judged = judge(impacts, curves, at) if law else []
    is_rejected = any(each.law == law and each.probability < 0.005 for each in judged)
    truth = math.log(float(np.squeeze(r(at))))
    return *estimates(impacts, curves), scatter > 0, truth, is_rejected


def study(kind, recordings, seed):
    """Return the numbers of a kind: held, half width, times wider than needed, law rejected."""
    rng = np.random.default_rng(seed)
    answers = [answer(kind, rng) for _ in range(recordings)]
    found = [first if scatters else still or first for first, still, scatters, *_ in answers]
    value, low, high, _ = np.array([astuple(each) for each in found]).T
    truth, rejected = np.array([each[3:] for each in answers]).T
    held = int(np.sum((low <= truth) & (truth <= high)))
    widths = (high - low) / 2
    wider = 1 / np.quantile(np.abs(value - truth) / widths, 0.95)
    return held, np.median(widths) * math.exp(truth[-1]), wider, int(np.sum(rejected))


def main():
    recordings = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    chosen = [int(each) for each in sys.argv[2:]] or range(len(KINDS))
    print("| recording | held, % | half width | wider than needed | true law rejected, % |")
    print("| --- | --- | --- | --- | --- |")
    for i in chosen:
        kind = KINDS[i]
        held, width, wider, rejected = study(kind, recordings, 700 + i)
        share = f"{100 * rejected / recordings:.1f}" if kind[2] else "–"
        print(
            f"| {kind[0]} | {100 * held / recordings:.1f} | {width:.4f} | {wider:.1f} | {share} |",
            flush=True,
        )


if __name__ == "__main__":
    main()

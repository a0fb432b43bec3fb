"""How often the 95 % interval of r holds the truth, in simulated recordings.

``python tests/interval_coverage.py [RECORDINGS [KIND]...]`` prints a table: the share of recordings
whose interval holds the true r; the median of its half width; and how many times wider the
intervals are than ones about the same r that hold it in 95 %.
"""

import math
import sys
from dataclasses import astuple
from functools import partial

import numpy as np

from bouncing_ball_contacts.intervals import curves_of, estimate, impacts_of
from bouncing_ball_contacts.recordings import Recording, read, rounding_of
from bouncing_ball_contacts.units import STANDARD_GRAVITY as G


def power(e, slope, v):
    return e * (v / 2.0) ** slope


def lossy(e, exponent, v):
    """Return r = e at 2 m/s whose loss 1/r - 1 goes as a power of the speed.

    The power is 1/5 as of a damping of Kuwabara and Kono, and 1 as of one of Hunt and Crossley.
    """
    return 1 / (1 + (1 / e - 1) * (np.asarray(v, float) / 2.0) ** exponent)


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


def falls(rng, r, heights, error, scatter):
    """Two intervals after each fall from a height."""
    v = np.sqrt(2 * G * heights)
    recordings = [flights(rng, r, 1, error, scatter, start=speed) for speed in v * r(v)]
    return Recording("falls", "flights", tuple(recording.chains[0] for recording in recordings))


def rounded(rng, r, impacts, digits, scatter):
    """Times that are rounded to frames of a camera."""
    recording = flights(rng, r, impacts, 0.0, scatter)
    times = np.concatenate([[0.0], np.cumsum(recording.chains[0])]) + rng.uniform(0, digits)
    rounded_times = np.round(times / digits) * digits
    return Recording("flights", "flights", (np.diff(rounded_times),), are_times=True, digit=digits)


def tops(rng, r, impacts, error, scatter):
    v = 5.0
    heights = []
    for _ in range(impacts + 1):
        heights.append(v**2 / (2 * G) + error * rng.normal())
        v *= float(np.squeeze(r(v))) * math.exp(scatter * rng.normal())
    return Recording("heights", "heights", (np.array(heights),))


def drops(rng, r, heights, trials, error, scatter, shared=0.0, height_error=0.0):
    """Trials of each height, which share an error of ln r, and one of the height in m."""
    h = np.repeat(heights, trials)
    true = np.repeat(heights + shared_errors(rng, height_error, len(heights)), trials)
    v = np.sqrt(2 * G * true)
    of_height = np.repeat(shared_errors(rng, shared, len(heights)), trials)
    up = true * (r(v) * np.exp(of_height + scatter * rng.normal(size=len(h)))) ** 2
    # The drop height is set, the rebound is read.
    pairs = np.column_stack([h, up + error * rng.normal(size=len(h))])
    return Recording("drops", "drops", (pairs,), groups=h)


def shared_errors(rng, size, groups):
    if size == 0:
        return np.zeros(groups)
    size = PUBLISHED * math.exp(WIDTH * rng.normal()) if size is None else size
    return size * rng.normal(size=groups)


def speeds(rng, r, v, error, scatter):
    out = v * r(v) * np.exp(scatter * rng.normal(size=len(v)))
    noisy = [v + error * rng.normal(size=len(v)), out + error * rng.normal(size=len(v))]
    return Recording("speeds", "speeds", (np.column_stack(noisy),))


def films(rng, r, heights, impacts, error, scatter, shared):
    """Films of one fall each, with 60 frames a second; the flights of a film share an error."""
    tracks = []
    for height, own in zip(heights, shared_errors(rng, shared, len(heights)), strict=True):
        v = math.sqrt(2 * G * height)
        begin = 0.0
        for _ in range(impacts):
            up = v * float(np.squeeze(r(v))) * math.exp(own + scatter * rng.normal())
            fall = np.arange(-1.9 * v / G, -0.02, 1 / 60)
            rise = np.arange(0.02, 1.9 * up / G, 1 / 60)
            t = np.concatenate([fall, rise])
            y = np.concatenate([-v * fall, up * rise]) - G / 2 * t**2
            noisy = y + error * rng.normal(size=len(t))
            tracks.append(np.column_stack([begin + t, noisy, t > 0]))
            begin += 2 * up / G
            v = up
    groups = np.repeat(np.arange(len(heights)), impacts)
    return Recording("films", "track", tuple(tracks), groups=groups)


def film(rng, r, height, impacts, error, scatter):
    """One film of a fall with 60 frames a second, as it is tracked and read."""
    up = math.sqrt(2 * G * height)
    begins, ups = [-2 * up / G], [up]
    for _ in range(impacts):
        begins.append(begins[-1] + 2 * ups[-1] / G)
        ups.append(ups[-1] * float(np.squeeze(r(ups[-1]))) * math.exp(scatter * rng.normal()))
    t = np.arange(-up / G + rng.uniform(0, 1 / 60), begins[-1] + 1.9 * ups[-1] / G, 1 / 60)
    flight = np.searchsorted(begins, t, side="right") - 1
    since = t - np.array(begins)[flight]
    y = np.array(ups)[flight] * since - G / 2 * since**2
    (recording,) = read({"t (s)": t, "y (m)": y + error * rng.normal(size=len(t))}).values()
    return recording


def coefficients(rng, r, v, error, scatter, stated, shared=0.0):
    _, of = np.unique(v, return_inverse=True)
    of_speed = shared_errors(rng, shared, len(v))[of]
    e = r(v) * np.exp(of_speed + scatter * rng.normal(size=len(v)))
    e += error * rng.normal(size=len(v))
    given = np.full(len(v), error) if stated else None
    pairs = np.column_stack([v, e])
    return Recording("coefficients", "coefficients", (pairs,), given, groups=v)


def several_balls(rng, r, balls, impacts, error, scatter, shared):
    """Flights of several balls of one kind, in a column `group`."""
    chains = []
    for own in shared_errors(rng, shared, balls):
        recording = flights(rng, lambda v, own=own: r(v) * math.exp(own), impacts, error, scatter)
        chains += recording.chains
    groups = np.repeat(np.arange(balls), impacts)
    return Recording("balls", "flights", tuple(chains), groups=groups)


def flat(e):
    return partial(lossy, e, 0.0)


def soft(e):
    return partial(lossy, e, 0.2)


def steep(e):
    return partial(lossy, e, 1.0)


# Each recording has a scatter of its own if it is None, from a log-normal distribution like that of
# the published experiments: its middle, and the width of its logarithm.
PUBLISHED = 0.011
WIDTH = 1.5
# Name, true r, recording, stated resolution.
KINDS = [
    (
        "6 impacts heard, 0.4 ms",
        flat(0.75),
        partial(flights, impacts=6, error=4e-4, scatter=0, start=4.2),
    ),
    (
        "9 impacts heard, 1 ms, v^-0.05",
        partial(power, 0.85, -0.05),
        partial(flights, impacts=9, error=1e-3, scatter=0, start=4.0),
    ),
    (
        "4 impacts heard, 1 ms",
        soft(0.8),
        partial(flights, impacts=4, error=1e-3, scatter=0),
    ),
    (
        "10 impacts heard, 0.5 ms, scatter 0.007",
        soft(0.8),
        partial(flights, impacts=10, error=5e-4, scatter=0.007, start=4.4),
    ),
    (
        "6 impacts heard, scatter 0.015 alone",
        flat(0.65),
        partial(flights, impacts=6, error=0, scatter=0.015, start=4.4),
    ),
    (
        "4 recordings of 5 impacts, 0.8 ms, scatter 0.005, v^-0.05",
        partial(power, 0.8, -0.05),
        partial(flights, impacts=5, error=8e-4, scatter=0.005, recordings=4),
    ),
    (
        "8 impacts heard, 0.5 ms, resolution stated",
        flat(0.8),
        partial(flights, impacts=8, error=5e-4, scatter=0, start=4.0),
        5e-4,
    ),
    (
        "8 impacts heard, 0.5 ms, scatter 0.01, resolution stated",
        soft(0.8),
        partial(flights, impacts=8, error=5e-4, scatter=0.01, start=4.0),
        5e-4,
    ),
    (
        "7 impacts filmed, times rounded to 1/60 s",
        flat(0.78),
        partial(rounded, impacts=7, digits=1 / 60, scatter=0),
    ),
    (
        "10 impacts filmed, times rounded to 1/240 s, scatter 0.008, v^-0.03",
        partial(power, 0.84, -0.03),
        partial(rounded, impacts=10, digits=1 / 240, scatter=0.008),
    ),
    (
        "5 tops read to 2 mm, v^-0.05",
        partial(power, 0.8, -0.05),
        partial(tops, impacts=5, error=2e-3, scatter=0),
    ),
    (
        "8 tops read to 2 mm, scatter 0.012",
        flat(0.84),
        partial(tops, impacts=8, error=2e-3, scatter=0.012),
    ),
    (
        "12 drops read to 4 mm, v^-0.05",
        partial(power, 0.75, -0.05),
        partial(drops, heights=np.array([0.2, 0.5, 1.0, 1.8]), trials=3, error=4e-3, scatter=0),
    ),
    (
        "20 drops read to 3 mm, scatter 0.015, 1/(1 + b v)",
        steep(0.7),
        partial(drops, heights=np.geomspace(0.1, 2, 5), trials=4, error=3e-3, scatter=0.015),
    ),
    (
        "5 drops read to 4 mm",
        soft(0.7),
        partial(drops, heights=np.geomspace(0.2, 1.5, 5), trials=1, error=4e-3, scatter=0),
    ),
    (
        "12 pairs of speeds to 0.03 m/s",
        soft(0.75),
        partial(speeds, v=np.linspace(1, 5, 12), error=0.03, scatter=0),
    ),
    (
        "18 coefficients over a factor of 15, scatter 0.006, v^-0.05",
        partial(power, 0.8, -0.05),
        partial(coefficients, v=np.geomspace(0.3, 4.5, 18), error=0, scatter=0.006, stated=False),
    ),
    (
        "12 coefficients with stated errors of 0.008",
        flat(0.6),
        partial(coefficients, v=np.linspace(0.5, 3, 12), error=8e-3, scatter=0, stated=True),
    ),
    (
        "12 coefficients with stated errors of 0.004, scatter 0.012, 1 - 0.04 v",
        lambda v: 1 - 0.04 * np.asarray(v),
        partial(coefficients, v=np.linspace(1, 5, 12), error=4e-3, scatter=0.012, stated=True),
    ),
    (
        "15 pairs of speeds to 0.01 m/s, scatter 0.01, 1/(1 + b v)",
        steep(0.6),
        partial(speeds, v=np.linspace(0.8, 4, 15), error=0.01, scatter=0.01),
    ),
    (
        "24 drops read to 2 mm, scatter 0.01",
        soft(0.6),
        partial(drops, heights=np.geomspace(0.15, 2.5, 6), trials=4, error=2e-3, scatter=0.01),
    ),
    (
        "7 coefficients at nearly one speed, scatter 0.02",
        flat(0.55),
        partial(coefficients, v=np.linspace(2.9, 3.2, 7), error=0, scatter=0.02, stated=False),
    ),
    (
        "3 impacts heard, 2 ms",
        flat(0.7),
        partial(flights, impacts=3, error=2e-3, scatter=0, start=4.0),
    ),
    (
        "5 impacts heard, 0.5 ms, scatter 0.01",
        soft(0.75),
        partial(flights, impacts=5, error=5e-4, scatter=0.01, start=4.2),
    ),
    (
        "5 tops read to 3 mm, scatter 0.02",
        flat(0.8),
        partial(tops, impacts=5, error=3e-3, scatter=0.02),
    ),
    (
        "4 pairs of speeds to 0.02 m/s",
        soft(0.85),
        partial(speeds, v=np.linspace(1, 4, 4), error=0.02, scatter=0),
    ),
    (
        "4 impacts heard, 0.1 ms, scatter 0.02",
        flat(0.7),
        partial(flights, impacts=4, error=1e-4, scatter=0.02, start=4.2),
    ),
    (
        "9 impacts filmed, times rounded to 1/120 s, scatter 0.007",
        soft(0.82),
        partial(rounded, impacts=9, digits=1 / 120, scatter=0.007),
    ),
    (
        "9 impacts filmed, times rounded to 1/120 s, scatter 0.007, resolution stated",
        soft(0.82),
        partial(rounded, impacts=9, digits=1 / 120, scatter=0.007),
        1 / 120 / math.sqrt(12),
    ),
    (
        "6 impacts filmed, times rounded to 1/60 s, scatter 0.02",
        flat(0.7),
        partial(rounded, impacts=6, digits=1 / 60, scatter=0.02),
    ),
    (
        "12 impacts filmed, times rounded to 1/240 s, scatter 0.015",
        soft(0.85),
        partial(rounded, impacts=12, digits=1 / 240, scatter=0.015),
    ),
    (
        "8 impacts filmed, times rounded to 1/30 s",
        flat(0.8),
        partial(rounded, impacts=8, digits=1 / 30, scatter=0),
    ),
    (
        "8 impacts filmed, times rounded to 1/120 s, scatter 0.02, resolution stated",
        flat(0.75),
        partial(rounded, impacts=8, digits=1 / 120, scatter=0.02),
        1 / 120 / math.sqrt(12),
    ),
    (
        "6 impacts, times typed to 0.01 s, scatter 0.01",
        flat(0.78),
        partial(rounded, impacts=6, digits=0.01, scatter=0.01),
    ),
    (
        "7 impacts heard, 0.3 ms, scatter 0.03",
        flat(0.75),
        partial(flights, impacts=7, error=3e-4, scatter=0.03, start=4.0),
    ),
    (
        "14 impacts heard, 1 ms, scatter 0.004",
        soft(0.88),
        partial(flights, impacts=14, error=1e-3, scatter=0.004, start=4.0),
    ),
    (
        "3 recordings of 4 impacts, 0.5 ms, scatter 0.02",
        soft(0.7),
        partial(flights, impacts=4, error=5e-4, scatter=0.02, recordings=3),
    ),
    (
        "6 tops read to 5 mm, scatter 0.006",
        soft(0.82),
        partial(tops, impacts=6, error=5e-3, scatter=0.006),
    ),
    (
        "10 drops read to 2 mm, scatter 0.03",
        flat(0.65),
        partial(drops, heights=np.geomspace(0.2, 2, 5), trials=2, error=2e-3, scatter=0.03),
    ),
    (
        "30 drops read to 1 mm, scatter 0.004, v^-0.1",
        partial(power, 0.6, -0.1),
        partial(drops, heights=np.geomspace(0.1, 2, 10), trials=3, error=1e-3, scatter=0.004),
    ),
    (
        "8 pairs of speeds to 0.05 m/s, scatter 0.005",
        flat(0.9),
        partial(speeds, v=np.linspace(1, 5, 8), error=0.05, scatter=0.005),
    ),
    (
        "9 coefficients over a factor of 5, scatter 0.035",
        soft(0.5),
        partial(coefficients, v=np.geomspace(1, 5, 9), error=0, scatter=0.035, stated=False),
    ),
    (
        "6 coefficients with stated errors of 0.01, scatter 0.003",
        flat(0.7),
        partial(coefficients, v=np.linspace(1, 3, 6), error=0.01, scatter=0.003, stated=True),
    ),
    (
        "5 impacts heard, 0.2 ms, any scatter",
        flat(0.7),
        partial(flights, impacts=5, error=2e-4, scatter=None, start=4.2),
    ),
    (
        "8 impacts heard, 0.7 ms, any scatter",
        soft(0.85),
        partial(flights, impacts=8, error=7e-4, scatter=None, start=4.2),
    ),
    (
        "12 impacts heard, 1.5 ms, any scatter",
        flat(0.9),
        partial(flights, impacts=12, error=1.5e-3, scatter=None),
    ),
    (
        "20 impacts heard, 0.5 ms, any scatter, v^-0.02",
        partial(power, 0.9, -0.02),
        partial(flights, impacts=20, error=5e-4, scatter=None),
    ),
    (
        "3 recordings of 5 impacts, 1 ms, any scatter",
        soft(0.75),
        partial(flights, impacts=5, error=1e-3, scatter=None, recordings=3),
    ),
    (
        "9 impacts heard, 0.3 ms, any scatter, resolution stated",
        soft(0.8),
        partial(flights, impacts=9, error=3e-4, scatter=None),
        3e-4,
    ),
    (
        "7 impacts filmed, times rounded to 1/60 s, any scatter",
        flat(0.75),
        partial(rounded, impacts=7, digits=1 / 60, scatter=None),
    ),
    (
        "10 impacts filmed, times rounded to 1/240 s, any scatter",
        soft(0.85),
        partial(rounded, impacts=10, digits=1 / 240, scatter=None),
    ),
    (
        "4 tops read to 5 mm, any scatter",
        flat(0.8),
        partial(tops, impacts=4, error=5e-3, scatter=None),
    ),
    (
        "7 tops read to 3 mm, any scatter",
        soft(0.85),
        partial(tops, impacts=7, error=3e-3, scatter=None),
    ),
    (
        "15 drops read to 5 mm, any scatter",
        soft(0.7),
        partial(drops, heights=np.geomspace(0.2, 2, 5), trials=3, error=5e-3, scatter=None),
    ),
    (
        "8 drops from one height read to 2 mm, any scatter",
        flat(0.65),
        partial(drops, heights=np.array([1.0]), trials=8, error=2e-3, scatter=None),
    ),
    (
        "6 pairs of speeds to 0.02 m/s, any scatter",
        flat(0.8),
        partial(speeds, v=np.linspace(1, 4, 6), error=0.02, scatter=None),
    ),
    (
        "15 pairs of speeds to 0.05 m/s, any scatter, 1/(1 + b v)",
        steep(0.65),
        partial(speeds, v=np.linspace(1, 5, 15), error=0.05, scatter=None),
    ),
    (
        "10 coefficients over a factor of 8, any scatter, v^-0.08",
        partial(power, 0.7, -0.08),
        partial(coefficients, v=np.geomspace(0.5, 4, 10), error=2e-3, scatter=None, stated=False),
    ),
    (
        "8 coefficients with stated errors of 0.005, any scatter",
        soft(0.6),
        partial(coefficients, v=np.linspace(1, 4, 8), error=5e-3, scatter=None, stated=True),
    ),
    (
        "20 pairs of intervals, 20 ms",
        flat(0.8),
        partial(flights, impacts=1, error=0.02, scatter=0, recordings=20),
    ),
    (
        "30 pairs of intervals, 20 ms",
        flat(0.8),
        partial(flights, impacts=1, error=0.02, scatter=0, recordings=30),
    ),
    (
        "30 pairs of intervals, 20 ms, resolution stated",
        flat(0.8),
        partial(flights, impacts=1, error=0.02, scatter=0, recordings=30),
        0.02,
    ),
    (
        "10 falls with two impacts each, 20 ms",
        flat(0.8),
        partial(flights, impacts=2, error=0.02, scatter=0, recordings=10),
    ),
    (
        "20 pairs of intervals, 20 ms, scatter 0.02",
        flat(0.8),
        partial(flights, impacts=1, error=0.02, scatter=0.02, recordings=20),
    ),
    (
        "20 pairs of speeds about 3 m/s to 0.1 m/s",
        flat(0.8),
        partial(speeds, v=np.linspace(2.9, 3.1, 20), error=0.1, scatter=0),
    ),
    (
        "40 falls from 0.2 to 2 m, two intervals each, 20 ms, v^-0.1",
        partial(power, 0.8, -0.1),
        partial(falls, heights=np.geomspace(0.2, 2, 40), error=0.02, scatter=0),
    ),
    (
        "60 pairs of speeds from 1 to 5 m/s to 0.2 m/s",
        flat(0.8),
        partial(speeds, v=np.geomspace(1, 5, 60), error=0.2, scatter=0),
    ),
    # Impacts of one height, film or ball share an error.
    (
        "10 trials at each of 5 heights set to 5 mm, read to 3 mm, scatter 0.005",
        flat(0.85),
        partial(
            drops,
            heights=np.linspace(0.2, 1, 5),
            trials=10,
            error=3e-3,
            scatter=5e-3,
            height_error=5e-3,
        ),
    ),
    (
        "5 trials at each of 3 heights, shared 0.025, scatter 0.01",
        soft(0.8),
        partial(
            drops,
            heights=np.geomspace(0.3, 1.5, 3),
            trials=5,
            error=2e-3,
            scatter=0.01,
            shared=0.025,
        ),
    ),
    (
        "10 trials at each of 3 heights, shared 0.05, scatter 0.02",
        soft(0.75),
        partial(
            drops,
            heights=np.geomspace(0.4, 1.6, 3),
            trials=10,
            error=2e-3,
            scatter=0.02,
            shared=0.05,
        ),
    ),
    (
        "4 trials at each of 3 heights, any shared, any scatter",
        soft(0.7),
        partial(
            drops,
            heights=np.geomspace(0.2, 2, 3),
            trials=4,
            error=2e-3,
            scatter=None,
            shared=None,
        ),
    ),
    (
        "3 trials at each of 4 heights, any shared, any scatter, v^-0.05",
        partial(power, 0.8, -0.05),
        partial(
            drops,
            heights=np.geomspace(0.2, 2, 4),
            trials=3,
            error=2e-3,
            scatter=None,
            shared=None,
        ),
    ),
    (
        "10 trials at each of 4 heights, shared 0.025, scatter 0.01, 1/(1 + b v)",
        steep(0.7),
        partial(
            drops,
            heights=np.geomspace(0.3, 1.5, 4),
            trials=10,
            error=2e-3,
            scatter=0.01,
            shared=0.025,
        ),
    ),
    (
        "3 trials at each of 10 heights, shared 0.015, scatter 0.01",
        flat(0.6),
        partial(
            drops,
            heights=np.geomspace(0.1, 2, 10),
            trials=3,
            error=2e-3,
            scatter=0.01,
            shared=0.015,
        ),
    ),
    (
        "1, 2, 3, 10 and 20 trials at 5 heights, shared 0.02, scatter 0.01",
        soft(0.8),
        partial(
            drops,
            heights=np.geomspace(0.3, 1.5, 5),
            trials=[1, 2, 3, 10, 20],
            error=2e-3,
            scatter=0.01,
            shared=0.02,
        ),
    ),
    (
        "1, 3, 10 and 20 trials at 4 heights, scatter 0.03",
        soft(0.8),
        partial(
            drops,
            heights=np.geomspace(0.3, 1.5, 4),
            trials=[1, 3, 10, 20],
            error=2e-3,
            scatter=0.03,
        ),
    ),
    (
        "5 coefficients at each of 4 speeds with stated errors of 0.005, shared 0.02",
        soft(0.6),
        partial(
            coefficients,
            v=np.repeat(np.linspace(1, 4, 4), 5),
            error=5e-3,
            scatter=0,
            stated=True,
            shared=0.02,
        ),
    ),
    (
        "3 films of 4 impacts, positions to 2 mm, shared 0.02, scatter 0.005",
        flat(0.8),
        partial(
            films,
            heights=np.array([1.0, 1.0, 1.0]),
            impacts=4,
            error=2e-3,
            scatter=0.005,
            shared=0.02,
        ),
    ),
    (
        "6 films of 3 impacts from 0.5 to 2 m, positions to 3 mm, shared 0.015, scatter 0.01",
        soft(0.85),
        partial(
            films,
            heights=np.geomspace(0.5, 2, 6),
            impacts=3,
            error=3e-3,
            scatter=0.01,
            shared=0.015,
        ),
    ),
    (
        "5 balls heard, 6 impacts each, 0.5 ms, shared 0.02, scatter 0.01",
        flat(0.75),
        partial(several_balls, balls=5, impacts=6, error=5e-4, scatter=0.01, shared=0.02),
    ),
    (
        "3 drops from each of 3 heights read to 1 mm, scatter 0.005",
        soft(0.8),
        partial(drops, heights=np.array([0.35, 0.8, 1.4]), trials=3, error=1e-3, scatter=0.005),
    ),
    (
        "9 drops from 9 heights read to 1 mm, scatter 0.005",
        soft(0.8),
        partial(drops, heights=np.geomspace(0.35, 1.4, 9), trials=1, error=1e-3, scatter=0.005),
    ),
    # The commonest film.
    (
        "1 film of 5 impacts, positions to 2 mm",
        flat(0.8),
        partial(film, height=1.2, impacts=5, error=2e-3, scatter=0),
    ),
    (
        "1 film of 5 impacts, positions to 2 mm, scatter 0.01",
        soft(0.8),
        partial(film, height=1.2, impacts=5, error=2e-3, scatter=0.01),
    ),
]


def answer(kind, rng):
    """Return the answer to one recording of a kind, and the true ln r."""
    _, r, make, *stated = kind
    scatter = make.keywords["scatter"]
    if scatter is None:
        scatter = PUBLISHED * math.exp(WIDTH * rng.normal())
    recording = make(rng, r, scatter=scatter)
    # Flights of no duration are refused.
    while recording.kind != "track" and np.min(np.concatenate(recording.chains)) <= 0:
        recording = make(rng, r, scatter=scatter)
    impacts = impacts_of(recording)
    known = stated[0] if stated else impacts.known
    at = math.exp(float(np.mean(np.log(impacts.speed))))
    curves = curves_of(impacts, known, at, rounding_of(recording))
    return estimate(curves), math.log(float(np.squeeze(r(at))))


def study(kind, recordings, seed):
    """Return the numbers of a kind: held, half width, times wider than needed."""
    rng = np.random.default_rng(seed)
    estimates, truths = zip(*(answer(kind, rng) for _ in range(recordings)), strict=True)
    value, low, high, _ = np.array([*map(astuple, estimates)]).T
    truth = np.array(truths)
    held = int(np.sum((low <= truth) & (truth <= high)))
    widths = (high - low) / 2
    wider = 1 / np.quantile(np.abs(value - truth) / widths, 0.95)
    return held, np.median(widths) * math.exp(truth[-1]), wider


def main():
    recordings = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    chosen = [int(number) for number in sys.argv[2:]] or range(len(KINDS))
    print("| recording | held, % | half width | wider than needed |")
    print("| --- | --- | --- | --- |")
    for i in chosen:
        kind = KINDS[i]
        held, width, wider = study(kind, recordings, 700 + i)
        share = 100 * held / recordings
        print(f"| {kind[0]} | {share:.1f} | {width:.4f} | {wider:.1f} |", flush=True)


if __name__ == "__main__":
    main()

"""The reference numbers of docs/bounces against closed forms."""

import csv
import math
from pathlib import Path

import pytest
from scipy.optimize import brentq

FILE = Path(__file__).parents[1] / "docs" / "bounces" / "reference" / "bounces.csv"
G = 9.81


def first_bounces():
    with FILE.open(newline="") as file:
        return [row for row in csv.DictReader(file) if row["bounce"] == "1"]


def ident(row):
    return f"{row['rule']} {row['r'] or row['stiffness'] + ' ' + row['damping']}"


def position(t, start, k, c):
    """Return penetration and rate of an oscillator p″ = -k p - c p′ + g from p, p′ at t = 0."""
    decay = c / 2
    omega = math.sqrt(k - decay**2)
    a = start[0] - G / k
    b = (start[1] + decay * a) / omega
    wave = a * math.cos(omega * t) + b * math.sin(omega * t)
    slope = omega * (b * math.cos(omega * t) - a * math.sin(omega * t))
    shrink = math.exp(-decay * t)
    return G / k + shrink * wave, shrink * (slope - decay * wave)


def release(rule, k, c, v):
    """Return time, penetration and rate at the end of a contact of 1 kg."""
    half = math.pi / math.sqrt(k - (c / 2) ** 2)
    if rule == "approach":
        turn = brentq(lambda t: position(t, (0, v), k, c)[1], 0.1 * half, 0.9 * half, xtol=1e-15)
        deep = position(turn, (0, v), k, c)[0]
        back = brentq(lambda t: position(t, (deep, 0), k, 0)[0], 0.1 * half, 0.9 * half, xtol=1e-15)
        return turn + back, *position(back, (deep, 0), k, 0)

    def ends(t):
        p, rate = position(t, (0, v), k, c)
        return k * p + c * rate if rule == "force" else p

    end = brentq(ends, 0.5 * half, 1.2 * half, xtol=1e-15)
    return end, *position(end, (0, v), k, c)


@pytest.mark.parametrize("row", first_bounces(), ids=ident)
def test_the_reference_numbers_are_those_of_closed_forms(row):
    v = math.sqrt(2 * G)
    if row["rule"] == "restitution":
        lasts, p, rate = 0.0, 0.0, -float(row["r"]) * v
    else:
        lasts, p, rate = release(row["rule"], float(row["stiffness"]), float(row["damping"]), v)
    fall = math.sqrt(2 / G)
    assert float(row["impact_speed"]) == pytest.approx(v, rel=1e-12)
    assert float(row["release_time"]) == pytest.approx(fall + lasts, rel=1e-11)
    assert float(row["top_height"]) == pytest.approx(rate**2 / (2 * G) - p, rel=1e-10)

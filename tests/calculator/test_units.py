"""Quantities at the edge: what is read, and what is refused in one line."""

import math

import pytest

from bouncing_ball.calculator.units import KINDS, number
from bouncing_ball.errors import ModelError


@pytest.mark.parametrize(
    ("name", "value", "expected"),
    [
        ("mass", "20 g", 0.02),
        ("mass", 0.02, 0.02),
        ("mass", "0.02", 0.02),
        ("frequency", "50 Hz", 50.0),
        ("frequency", "3000 rpm", 50.0),
        ("frequency", "0.05 kHz", 50.0),
        ("frequency", "100 rad/s", 100 / (2 * math.pi)),
        ("angular_frequency", "100 rad/s", 100.0),
        ("angular_frequency", "50 Hz", 100 * math.pi),
        ("angular_frequency", "180 deg/s", math.pi),
        ("amplitude", "0.1 mm", 1e-4),
        ("amplitude", "100 µm", 1e-4),
        # The Greek letter, which looks the same.
        ("amplitude", "100 \N{GREEK SMALL LETTER MU}m", 1e-4),
        ("acceleration", "2 g", 19.6133),
        ("acceleration", "2 m/s²", 2.0),
        ("acceleration", "2 m/s**2", 2.0),
        ("stiffness", "2 kN/mm", 2e6),
        ("stiffness", "2 N/µm", 2e6),
        ("damping", "5 N·s/m", 5.0),
        ("damping", "5 kg/s", 5.0),
        ("reduced_modulus", "115 GPa", 1.15e11),
        ("tolerance", "1 %", 0.01),
        ("stiffness", "-5 N/m", -5.0),
    ],
)
def test_what_is_read(name, value, expected):
    assert number(name, value) == pytest.approx(expected, rel=1e-14)


@pytest.mark.parametrize(
    ("name", "value", "says"),
    [
        ("frequency", "20 ms", "is a time: it needs a frequency, such as 50 Hz"),
        ("period", "50 Hz", "is a frequency: it needs a time, such as 20 ms"),
        ("frequency", "314 1/s", "cycles or radians: write Hz or rad/s"),
        ("frequency", "314 s^-1", "cycles or radians"),
        ("frequency", "5 Bq", "cycles or radians"),
        ("amplitude", "2 m/s^2", "acceleration has its own parameter, acceleration"),
        ("amplitude", "2 g", "is a mass: it needs a length"),
        ("stiffness", "3 Pa", "is a pressure: it needs a stiffness"),
        ("damping_ratio", "3 N s/m", "has its own parameter, damping"),
        ("restitution", "3 m", "is a length: it needs a number"),
        ("mass", "50 furlong^2 candela", "is of dimension"),
        ("mass", "20 grams of steel", "an unknown unit"),
        ("mass", "", "does not begin with a number"),
        ("mass", "twenty", "does not begin with a number"),
        ("mass", "nan", "does not begin with a number"),
        ("mass", "1e999", "not a finite number"),
        ("mass", math.inf, "not a finite number"),
        ("mass", [1.0, 2.0], "neither a number nor a text"),
        ("contact_time", "20 degC", "an unknown unit"),
        # Nothing is evaluated, however short its text.
        ("frequency", "9**9**9**9", "an unknown unit"),
        ("frequency", "9 m**9**9", "an unknown unit"),
        ("frequency", "9 m^9^9", "an unknown unit"),
        ("frequency", "9 __import__('os')", "an unknown unit"),
        ("frequency", "1 " + "m" * 10_000, "an unknown unit"),
        # Half a minute, where blanks at the end are looked for from each of them.
        ("frequency", "1 m" + " " * 100_000 + "m", "an unknown unit"),
    ],
)
def test_what_is_refused_in_one_line(name, value, says):
    with pytest.raises(ModelError) as error:
        number(name, value)
    text = str(error.value)
    # A text of megabytes is not given back.
    assert len(text) < 200
    assert says in text and text.startswith(f"{name} = ") and "\n" not in text


def test_every_example_is_read():
    for name, kind in KINDS.items():
        assert number(name, kind.example) > 0


def test_quantities_of_any_registry():
    pint = pytest.importorskip("pint")
    registry = pint.UnitRegistry()
    assert number("stiffness", 2 * registry.kilonewton / registry.millimeter) == 2e6
    assert number("restitution", registry.Quantity(0.5)) == 0.5
    with pytest.raises(ModelError, match="is a time"):
        number("frequency", 3 * registry.second)

"""Quantities at the edge: what is read, and what is refused in one line."""

import math

import pint
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bouncing_ball_beyond.inherited.contacts.contact import units
from bouncing_ball_beyond.inherited.contacts.contact.contact import Contact
from bouncing_ball_beyond.inherited.contacts.contact.drops import drop_at_rest
from bouncing_ball_beyond.inherited.contacts.contact.quantities import quantities
from bouncing_ball_beyond.inherited.contacts.contact.question import Question
from bouncing_ball_beyond.inherited.contacts.contact.table import Table
from bouncing_ball_beyond.inherited.contacts.contact.texts import shown
from bouncing_ball_beyond.inherited.contacts.contact.units import number_in_si
from bouncing_ball_beyond.inherited.errors import ModelError

KINDS = {}
for each in (Contact, Table, Question, drop_at_rest):
    KINDS |= quantities(each)


def read(name, value):
    return number_in_si(name, value, KINDS[name])


# A unit of each way to write one, and what it is in SI units (cycles, for a frequency).
UNITS = [
    ("mass", "g", 1e-3),
    ("mass", "", 1),
    ("frequency", "rpm", 1 / 60),
    ("frequency", "kHz", 1e3),
    ("frequency", "rad/s", 1 / (2 * math.pi)),
    ("frequency", "deg/s", 1 / 360),
    ("contact_time", "ms", 1e-3),
    ("table_amplitude", "µm", 1e-6),
    # The Greek letter, which looks the same.
    ("table_amplitude", "\N{GREEK SMALL LETTER MU}m", 1e-6),
    ("acceleration", "g", 9.80665),
    ("acceleration", "m/s²", 1),
    ("acceleration", "m/s**2", 1),
    ("gravity", "m/s2", 1),
    ("gravity", "m/s^2", 1),
    ("stiffness", "kg/s2", 1),
    ("stiffness", "kN/mm", 1e6),
    ("damping", "N·s/m", 1),
    ("damping", "kg/s", 1),
    ("reduced_modulus", "GPa", 1e9),
    ("tolerance", "%", 0.01),
]


@given(st.sampled_from(UNITS), st.floats(-1e30, 1e30).filter(lambda x: x == 0 or abs(x) > 1e-30))
def test_a_number_and_its_unit(case, value):
    name, unit, factor = case
    assert read(name, f"{value!r} {unit}") == pytest.approx(value * factor, rel=1e-14)


@given(st.sampled_from(sorted(KINDS)), st.floats(allow_nan=False, allow_infinity=False))
def test_a_plain_number_is_in_si_units(name, value):
    assert read(name, value) == read(name, repr(value)) == value


@pytest.mark.parametrize(
    ("name", "text", "value"),
    [
        ("contact_time", "1/240", 1 / 240),
        ("contact_time", "1 / 240 s", 1 / 240),
        ("contact_time", "2/3 ms", 2e-3 / 3),
        ("mass", "1/2 kg", 0.5),
        ("restitution", "3/4", 0.75),
        ("stiffness", "1e6/4 N/m", 2.5e5),
    ],
)
def test_a_fraction_of_two_numbers_is_a_number(name, text, value):
    assert read(name, text) == pytest.approx(value, rel=1e-14)


@pytest.mark.parametrize(
    ("name", "value", "says"),
    [
        ("contact_time", "1/0 s", "is divided by 0"),
        ("contact_time", "1/240/2", "is not one number and a unit"),
        ("frequency", "20 ms", "is in millisecond, not in Hz: write it as '50 Hz'"),
        ("frequency", "314 s^-1", "turns or radians: write '314 Hz' or '314 rad/s'"),
        ("frequency", "5 Bq", "is in becquerel, not in Hz"),
        ("table_amplitude", "2 g", "is in gram, not in m"),
        ("restitution", "3 m", "is in meter, and not a plain number: write it as '0.85'"),
        ("damping", "8 Ns/m", "has an unknown unit: did you mean '8 N s/m'?"),
        ("mass", "1e999", "not a finite number"),
        ("mass", [1.0, 2.0], "neither a number nor a text"),
        ("contact_time", "20 degC", "is in degree Celsius, not in s"),
        # Nothing is evaluated, however short its text.
        ("frequency", "9**9**9**9", "not one number"),
        ("frequency", "9 m^9^9", "an unknown unit"),
        ("frequency", "9 __import__('os')", "an unknown unit"),
        # Half a minute, where blanks at the end are looked for from each of them.
        ("frequency", "1 m" + " " * 100_000 + "m", "an unknown unit"),
    ],
)
def test_what_is_refused_in_one_line(name, value, says):
    with pytest.raises(ModelError) as error:
        read(name, value)
    text = str(error.value)
    # A text of megabytes is not given back.
    assert says in text and text.startswith(f"{name} = ") and "\n" not in text and len(text) < 200


def test_every_example_is_read():
    assert all(read(name, kind.example) > 0 for name, kind in KINDS.items())


def test_quantities_of_any_registry():
    registry = pint.UnitRegistry()
    assert read("stiffness", 2 * registry.kilonewton / registry.millimeter) == 2e6
    assert read("restitution", registry.Quantity(0.5)) == 0.5
    with pytest.raises(ModelError, match="is in second, not in Hz"):
        read("frequency", 3 * registry.second)


@given(st.floats(1e-12, 1e12))
def test_a_prefix_keeps_four_digits(value):
    digits, unit = shown(value, "m").split(" ")
    factor = {"G": 1e9, "M": 1e6, "k": 1e3, "m": 1e-3, "µ": 1e-6, "n": 1e-9}.get(unit[:-1], 1.0)
    assert float(digits) * factor == pytest.approx(value, rel=5.001e-4)
    assert 1 <= float(digits) < 1000 or not 1e-9 <= value < 1e12


def test_a_whole_number_beyond_all_floats_is_refused_in_one_line():
    with pytest.raises(ModelError, match=r"measured_restitution.* is not a finite number"):
        read("measured_restitution", 10**400)


def test_common_units_have_the_sizes_that_pint_gives_them():
    registry = units._registry()
    for name, common in units.COMMON.items():
        for unit, size in common.items():
            written = "standard_gravity" if (name, unit) == ("m/s^2", "g") else unit
            exact = registry.Quantity(1.0, registry.parse_units(written)).m_as(name)
            assert size == pytest.approx(float(exact), rel=1e-15)


@pytest.mark.parametrize("name", ["mass", "stiffness"])
def test_a_common_unit_needs_no_pint(name, monkeypatch):
    monkeypatch.setattr(units, "_registry", None)
    assert read(name, KINDS[name].example) > 0

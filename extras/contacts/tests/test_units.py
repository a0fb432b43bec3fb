"""Numbers with units, in and out."""

import pytest

from bouncing_ball_contacts import Bounce, Refused
from bouncing_ball_contacts.units import density_of, in_si, show, span


@pytest.mark.parametrize(
    ("given", "unit", "expected"),
    [
        ("50 g", "kg", 0.05),
        ("50g", "kg", 0.05),
        (0.05, "kg", 0.05),
        ("0.05", "kg", 0.05),
        ("1/240", "s", 1 / 240),
        ("1/3 ms", "s", 1e-3 / 3),
        ("1,5 mm", "m", 1.5e-3),
        ("20 µs", "s", 2e-5),
        ("2 lb", "kg", 0.90718474),
        ("1 inch", "m", 0.0254),
        ("64 %", "", 0.64),
        ("1e5 N/m", "N/m", 1e5),
        ("2.5 kN/mm", "N/m", 2.5e6),
        ("−3", "s", -3.0),
        ("3 mN/m", "N/m", 3e-3),
        ("7.8 g/cm3", "kg/m^3", 7800.0),
        ("1100 kg/m3", "kg/m^3", 1100.0),
        ("1.62 m/s2", "m/s^2", 1.62),
        ("10 N s/m", "N s/m", 10.0),
        ("2 1/s", "1/s", 2.0),
    ],
)
def test_a_quantity_is_read(given, unit, expected):
    assert in_si("value", given, unit) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize(
    ("given", "unit", "said"),
    [
        ("1,500 N/m", "N/m", "'1500 N/m' or as '1.500 N/m'"),
        ("five g", "kg", "does not begin with a number"),
        ("50 Kg", "kg", "'Kg' in '50 Kg' does not fit; write it as in '50 g', in kg, g, mg"),
        ("2 Ms", "s", "does not fit"),
        ("5 s", "kg", "does not fit; write it as in '50 g'"),
        ("5 s", "", "write a number without a unit as in '0.8', in %"),
        ("1/0", "s", "divides by zero"),
        ("nan", "s", "does not begin"),
        (float("inf"), "s", "inf s is not computed"),
        (float("nan"), "", "nan is not computed"),
        ("1e-300", "kg", "1e-300 kg is not computed, but 0 and quantities from 1e-18 to 1e.18"),
        (None, "s", "does not fit"),
    ],
)
def test_a_text_that_is_no_quantity_is_refused_in_one_line(given, unit, said):
    with pytest.raises(Refused, match=said) as refused:
        in_si("value", given, unit)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(
    ("value", "unit", "expected"),
    [
        (0.99999, "m", "1 m"),
        (0.9996, "m", "1 m"),
        (0.0999996, "m", "100 mm"),
        (1234.0, "m", "1230 m"),
        (1e-7, "m", "100 nm"),
        (2200.0, "N/m", "2.2 kN/m"),
        (0.05, "kg", "50 g"),
        (2000.0, "kg", "2000 kg"),
        (0.0, "m", "0 m"),
        (float("nan"), "N/m", "–"),
        (4.429, "m/s", "4.43 m/s"),
        (999.6, "N", "1 kN"),
        # Rounding was shown as 3.47e-09 nm, and 498000000000000012582912 GN/m.
        (3.47e-18, "m", "0 m"),
        (4.98e32, "N/m", "4.98e+23 GN/m"),
        (1e14, "N/m", "100000 GN/m"),
        (2e-11, "m", "0.02 nm"),
    ],
)
def test_a_number_is_shown_with_a_prefix(value, unit, expected):
    assert show(value, unit) == expected


def test_the_ends_of_a_range_are_told_apart():
    assert span(0.1, 0.6) == "0.100 to 0.600"
    assert span(0.60012, 0.60041) == "0.6001 to 0.6004"
    assert span(0.6, 0.6) == "0.600 to 0.600"
    assert span(1.23412, 1.23441, form="g") == "1.2341 to 1.2344"


def test_a_material_is_a_density():
    assert density_of("Rubber") == density_of("1100 kg/m^3") == 1100
    with pytest.raises(
        Refused, match="does not begin with a number; write it as in '1100 kg/m.3' or 'rubber'"
    ):
        density_of("unobtainium")


def test_a_bounce_takes_texts_and_numbers_alike():
    one = Bounce(mass="50 g", restitution="80 %", drop_height="1 m")
    other = Bounce(mass=0.05, restitution=0.8, drop_height=1.0)
    assert one == other and hash(one) == hash(other)
    assert one.impact_speed == pytest.approx(4.4287, abs=1e-4)

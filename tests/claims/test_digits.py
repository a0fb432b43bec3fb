"""Units of printed digits."""

import pytest

from bouncing_ball.claims.digits import distance_in_units, is_number_text, last_unit


@pytest.mark.parametrize(
    ("text", "unit"),
    [
        ("82", 1.0),
        ("6", 1.0),
        ("0.052", 0.001),
        ("0.1359", 1e-4),
        # A trailing zero is a digit.
        ("0.750", 0.001),
        ("0.75", 0.01),
        ("1e-12", 1e-12),
        ("2.5e-3", 1e-4),
        ("-1.5", 0.1),
    ],
)
def test_the_unit_of_the_last_digit(text, unit):
    # Exactly the number nearest to the power of ten.
    assert last_unit(text) == unit


def test_the_distance_has_the_sign_of_computed_less_printed():
    assert distance_in_units(83.5, "82") == 1.5
    assert distance_in_units(80.5, "82") == -1.5
    assert distance_in_units(0.2557, "0.255") == pytest.approx(0.7, abs=1e-12)


def test_a_unit_may_be_given_where_the_digits_do_not_tell():
    assert distance_in_units(150.0, "100") == 50.0
    assert distance_in_units(150.0, "100", 100) == 0.5


@pytest.mark.parametrize("text", ["0.255", "82", "-3", "1e-12", "1.5e3"])
def test_numbers_as_texts(text):
    assert is_number_text(text)
    float(text)


@pytest.mark.parametrize("value", [82, 0.255, None, "", "about 82", "1.", ".5", "1e", "nan", "1 "])
def test_what_is_not_a_number_as_text(value):
    assert not is_number_text(value)

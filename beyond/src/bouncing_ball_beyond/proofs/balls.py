"""Balls of Arb: their precision, exact fractions as balls, and decimal texts that bound them."""

from fractions import Fraction

from flint import arb, ctx, fmpq

from bouncing_ball.errors import ModelError, NoOrbitError


class ProofError(ModelError):
    """A number or an orbit cannot be certified; the message gives the reason."""


class NoStartError(ProofError, NoOrbitError):
    """There is no orbit in double precision from which a proof could start."""


class precision:
    """The number of bits of all balls within a ``with`` block."""

    def __init__(self, bits: int) -> None:
        self.bits = bits

    def __enter__(self) -> None:
        self.before = ctx.prec
        ctx.prec = self.bits

    def __exit__(self, *_: object) -> None:
        ctx.prec = self.before


def exactly(number: float) -> Fraction:
    """The fraction that the shortest decimal text of a number means.

    Examples
    --------
    >>> exactly(0.85)
    Fraction(17, 20)
    """
    return Fraction(repr(float(number)))


def rational(value: Fraction) -> arb:
    """A fraction as a ball that contains it; its numerator and denominator are not rounded."""
    return arb(fmpq(value.numerator, value.denominator))


def decimal_with_bound(ball: arb, digits: int) -> tuple[str, str]:
    """A decimal number near the middle of a ball, and a bound of its distance to the ball's points.

    The bound includes the rounding of the decimal number and of the bound's own text.

    Examples
    --------
    >>> with precision(100):
    ...     text, radius = decimal_with_bound(arb(2).sqrt(), 20)
    >>> text, float(radius) < 1e-19
    ('1.4142135623730950488', True)
    """
    text = arb(ball.mid()).str(digits, radius=False)
    # One part in 32 covers the rounding of the bound's text to three digits.
    error = (arb(text) - ball).abs_upper() * arb(33) / 32
    return text, arb(error).str(3, radius=False)

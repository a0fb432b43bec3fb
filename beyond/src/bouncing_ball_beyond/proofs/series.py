"""Truncated Taylor series in two variables, with balls as coefficients.

A series ``f = Σ c_ij x^i y^j`` over i + j ≤ N is exact for polynomials, and its coefficients are
enclosures for every function that is composed of the functions of this module: the first
derivatives of f at the point are c_10 and c_01, the second 2 c_20, c_11 and 2 c_02, and so on.
If the point is itself a ball, the coefficients enclose the derivatives at all of its points,
which is what an interval Newton step needs.
"""

from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import Any, Self

from flint import arb


@lru_cache
def _powers(order: int) -> list[tuple[int, int]]:
    """The exponents (i, j) of the terms, by degree."""
    return [(degree - j, j) for degree in range(order + 1) for j in range(degree + 1)]


@lru_cache
def _products(order: int) -> list[tuple[int, int, int]]:
    """The indices of two terms and of their product, for all products within the order."""
    place = {power: k for k, power in enumerate(_powers(order))}
    return [
        (a, b, place[i + k, j + m])
        for (i, j), a in place.items()
        for (k, m), b in place.items()
        if i + j + k + m <= order
    ]


class Series:
    """A truncated Taylor series in two variables; ``terms`` are its coefficients by degree.

    Examples
    --------
    The derivatives of x² y at (3, 2):

    >>> x, y = Series.variable(arb(3), 0, 2), Series.variable(arb(2), 1, 2)
    >>> f = x * x * y
    >>> [int(float(f.coefficient(*power))) for power in ((0, 0), (1, 0), (0, 1), (1, 1))]
    [18, 12, 9, 6]
    """

    __slots__ = ("order", "terms")

    def __init__(self, terms: Sequence[arb], order: int) -> None:
        self.terms = list(terms)
        self.order = order

    @classmethod
    def constant(cls, value: Any, order: int) -> Self:
        """The series of a number."""
        none = arb(0)
        return cls([arb(value), *[none] * (len(_powers(order)) - 1)], order)

    @classmethod
    def variable(cls, value: arb, number: int, order: int) -> Self:
        """The series of the variable x (number 0) or y (number 1) about a value."""
        found = cls.constant(value, order)
        found.terms[1 + number] = arb(1)
        return found

    @property
    def value(self) -> arb:
        """The coefficient of degree 0."""
        return self.terms[0]

    def coefficient(self, i: int, j: int) -> arb:
        """The coefficient of x^i y^j."""
        return self.terms[_powers(self.order).index((i, j))]

    def derivative(self) -> "Series":
        """The derivative with respect to x, of one order less."""
        lower = self.order - 1
        terms = [(i + 1) * self.coefficient(i + 1, j) for i, j in _powers(lower)]
        return Series(terms, lower)

    def truncated(self, order: int) -> "Series":
        """The terms up to a lower order."""
        return Series(self.terms[: len(_powers(order))], order)

    def without_value(self) -> Self:
        """The series with the coefficient of degree 0 replaced by an exact 0."""
        return type(self)([arb(0), *self.terms[1:]], self.order)

    def __add__(self, other: Any) -> "Series":
        if isinstance(other, Series):
            return Series([a + b for a, b in zip(self.terms, other.terms, strict=True)], self.order)
        return Series([self.terms[0] + other, *self.terms[1:]], self.order)

    __radd__ = __add__

    def __neg__(self) -> "Series":
        return Series([-a for a in self.terms], self.order)

    def __sub__(self, other: Any) -> "Series":
        return self + (-other)

    def __rsub__(self, other: Any) -> "Series":
        return (-self) + other

    def __mul__(self, other: Any) -> "Series":
        if not isinstance(other, Series):
            return Series([a * other for a in self.terms], self.order)
        found = [arb(0)] * len(self.terms)
        left = self.terms
        right = other.terms
        for a, b, c in _products(self.order):
            found[c] += left[a] * right[b]
        return Series(found, self.order)

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> "Series":
        if not isinstance(other, Series):
            return Series([a / other for a in self.terms], self.order)
        return self * other.composed(_reciprocal)

    def composed(self, derivatives: Callable[[arb, int], list[arb]]) -> "Series":
        """f of the series, where ``derivatives(c, N)`` are the Taylor coefficients of f at c."""
        outer = derivatives(self.value, self.order)
        inner = self.without_value()
        found = Series.constant(outer[-1], self.order)
        for coefficient in reversed(outer[:-1]):
            found = found * inner + coefficient
        return found

    def exp(self) -> "Series":
        """The exponential function of the series."""
        return self.composed(_exponential)

    def sin_cos(self) -> "tuple[Series, Series]":
        """Sine and cosine of the series."""
        return self.composed(_sine), self.composed(_cosine)


def _exponential(c: arb, order: int) -> list[arb]:
    found = [c.exp()]
    for k in range(1, order + 1):
        found.append(found[-1] / k)
    return found


def _trigonometric(cycle: Sequence[arb], order: int) -> list[arb]:
    """Taylor coefficients of a function whose derivatives repeat after four."""
    found = []
    factorial = arb(1)
    for k in range(order + 1):
        factorial = factorial * max(k, 1)
        found.append(cycle[k % 4] / factorial)
    return found


def _sine(c: arb, order: int) -> list[arb]:
    sine, cosine = c.sin_cos()
    return _trigonometric((sine, cosine, -sine, -cosine), order)


def _cosine(c: arb, order: int) -> list[arb]:
    sine, cosine = c.sin_cos()
    return _trigonometric((cosine, -sine, -cosine, sine), order)


def _reciprocal(c: arb, order: int) -> list[arb]:
    found = [1 / c]
    for _ in range(order):
        found.append(-found[-1] * found[0])
    return found

"""Proofs that a ball or a box contains exactly one solution: interval Newton and Krawczyk steps.

Newton's method with long numbers gives the middle, which proves nothing. The proof is one step with
balls: if the image of a ball I with the point m in it, ``m - F(m)/F′(I)``, lies in the interior of
I, then I contains exactly one zero of F, and the image contains it. F(m) is evaluated at a point,
and F′(I) encloses the derivatives at all points of I. Krawczyk's method does the same for two
equations.
"""

from collections.abc import Callable

from flint import arb, ctx

from bouncing_ball_beyond.proofs.balls import ProofError
from bouncing_ball_beyond.proofs.series import Series

# Largest number of Newton steps with long numbers: each doubles the digits of the start.
_STEPS = 12
# The ball of the proof is the last Newton step times these factors, tried in turn.
_WIDER = (2**8, 2**16, 2**24)
# Distance from the start of double precision, relative to 1 + |start|, from which on a solution is
# another one: the searches in double precision end at 1e-9 or closer.
_NEAR = 1e-6


def certified_zero(test: Callable[[Series], Series], start: float) -> arb:
    """A ball that is proved to contain exactly one zero of a function, near a start.

    Raises
    ------
    ProofError
        If Newton's method does not converge to a zero near the start, or if no ball is mapped into
        its own interior.
    """
    middle = arb(start)
    step = arb(1)
    for _ in range(_STEPS):
        found = test(Series.variable(middle, 0, 2))
        step = found.value / found.coefficient(1, 0)
        if not step.is_finite():
            raise ProofError("Newton's method met a singular point of the branch")
        middle = arb((middle - step).mid())
        if step.abs_upper() < _resolution(middle):
            break
    else:
        raise ProofError("Newton's method did not converge from the start of double precision")
    _require_near(middle, start)
    value = test(Series.variable(middle, 0, 2)).value
    least = arb(step.abs_upper()) + arb(value.abs_upper()) + _resolution(middle)
    for factor in _WIDER:
        radius = least * factor
        ball = (middle - radius).union(middle + radius)
        slope = test(Series.variable(ball, 0, 2)).coefficient(1, 0)
        # If the slope may be 0, the image is not finite and lies in no ball.
        image = middle - value / slope
        if ball.contains_interior(image):
            return image
    raise ProofError(
        "no ball around the solution is mapped into its interior: it may be a tangency"
    )


Equations = Callable[[list[arb]], tuple[Series, Series]]
"""Two functions of two unknowns, as series about a box or a point."""


def certified_box(equations: Equations, start: list[float]) -> list[arb]:
    """A box that is proved to contain exactly one solution of two equations, near a start.

    Krawczyk's method: the image ``m - Y F(m) + (I - Y J(B)) (B - m)`` of a box B with midpoint m
    lies in its interior, where Y is an approximate inverse of the Jacobian and J(B) encloses the
    Jacobians at all points of B.

    Raises
    ------
    ProofError
        If Newton's method does not converge to a solution near the start, or if no box is mapped
        into its interior.
    """
    middle = _solved(equations, [arb(x) for x in start])
    for center, begin in zip(middle, start, strict=True):
        _require_near(center, begin)
    step, inverse = _newton_step(equations, middle)
    for factor in _WIDER:
        box = []
        for center, change in zip(middle, step, strict=True):
            radius = factor * (arb(change.abs_upper()) + _resolution(center))
            box.append((center - radius).union(center + radius))
        image = _krawczyk(equations, box, middle, step, inverse)
        if all(b.contains_interior(x) for b, x in zip(box, image, strict=True)):
            return image
    raise ProofError("no box around the solution is mapped into its interior")


def _require_near(middle: arb, start: float) -> None:
    """Check that Newton's method has found the solution from which it started."""
    away = abs(middle - start)
    if not away < _NEAR * (1 + abs(start)):
        raise ProofError("Newton's method went to another solution than that of double precision")


def _solved(equations: Equations, middle: list[arb]) -> list[arb]:
    """The solution near a start by Newton's method, without a proof."""
    for _ in range(_STEPS):
        step, _ = _newton_step(equations, middle)
        if not all(change.is_finite() for change in step):
            raise ProofError("Newton's method met a singular point")
        middle = [arb((m - change).mid()) for m, change in zip(middle, step, strict=True)]
        pairs = zip(step, middle, strict=True)
        if all(change.abs_upper() < _resolution(center) for change, center in pairs):
            return middle
    raise ProofError("Newton's method did not converge from the start of double precision")


def _newton_step(equations: Equations, middle: list[arb]) -> tuple[list[arb], list[list[arb]]]:
    """The step Y F(m), and the approximate inverse Y of the Jacobian."""
    values, slopes = _linearised(equations(middle))
    inverse = _inverse([[arb(x.mid()) for x in row] for row in slopes])
    return [_scalar_product(row, values) for row in inverse], inverse


def _krawczyk(
    equations: Equations,
    box: list[arb],
    middle: list[arb],
    step: list[arb],
    inverse: list[list[arb]],
) -> list[arb]:
    """The image of a box under Krawczyk's operator."""
    _, slopes = _linearised(equations(box))
    away = [b - m for b, m in zip(box, middle, strict=True)]
    image = []
    for k in (0, 1):
        contraction = []
        for j in (0, 1):
            column = [slopes[0][j], slopes[1][j]]
            contraction.append((1 if k == j else 0) - _scalar_product(inverse[k], column))
        image.append(middle[k] - step[k] + _scalar_product(contraction, away))
    return image


def _resolution(center: arb) -> arb:
    """The size of a Newton step after which rounding dominates."""
    return (abs(center) + 1) * arb(2) ** (-ctx.prec * 3 // 4)


def _scalar_product(left: list[arb], right: list[arb]) -> arb:
    """The scalar product of two pairs."""
    return left[0] * right[0] + left[1] * right[1]


def _linearised(found: tuple[Series, Series]) -> tuple[list[arb], list[list[arb]]]:
    values = [f.value for f in found]
    return values, [[f.coefficient(1, 0), f.coefficient(0, 1)] for f in found]


def _inverse(rows: list[list[arb]]) -> list[list[arb]]:
    (a, b), (c, d) = rows
    volume = a * d - b * c
    inverse = [[d / volume, -b / volume], [-c / volume, a / volume]]
    return [[arb(x.mid()) for x in row] for row in inverse]

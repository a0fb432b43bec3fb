r"""The criticality of a bifurcation: the first coefficient of its normal form.

The return map F has the fixed point 0 and the derivative A = DF, with A q = μ q, pᵀA = μ pᵀ,
p·q = 1 and ``|q| = 1`` in (φ, δ′). Its second and third derivatives are B and C. On the centre
manifold, along q, the map is ::

    saddle-node, μ = 1:        ξ → ξ + rate dλ + a ξ²,        a = p·B(q, q)/2
    period doubling, μ = -1:   ξ → -(1 + rate dλ) ξ + b ξ³

    b = p·C(q, q, q)/6 + p·B(q, w)/2,    w = (I - A)⁻¹ B(q, q)

A doubling with b > 0 is supercritical: the orbits of twice the period are stable, if the other
multiplier is inside the unit circle, and exist where the orbit is unstable, at ξ² = rate dλ/b. With
b < 0 they are unstable, and exist beside the stable orbit. A saddle-node with a ≠ 0 is a simple
fold: its two orbits are at ξ² = -rate dλ/a.

Source: Y. A. Kuznetsov, *Elements of Applied Bifurcation Theory*, section 5.4 (the projection), and
sections 4.3 and 4.5 (the normal forms).

The derivative DF is known to rounding at every state (:mod:`.return_map`), so that B and C need
differences along q only: ``B(q, u)`` is the first derivative of DF u in the direction q, and
``C(q, q, q)`` the second one of DF q. They come from nine states on a line, with an error of the
eighth order, at steps that are halved. The two neighbouring steps that agree best are chosen, and
their difference is the error of the coefficient.
"""

import math
from dataclasses import dataclass

import numpy as np

from bouncing_ball_beyond.inherited.errors import NoOrbitError, suggesting
from bouncing_ball_beyond.inherited.numerics.corrector import solve_linear
from bouncing_ball_beyond.inherited.periodic.orbit import Bifurcation
from bouncing_ball_beyond.periodic.orbits.impacts import equations_of
from bouncing_ball_beyond.periodic.orbits.orbit import Orbit
from bouncing_ball_beyond.periodic.orbits.problem import OrbitEquations
from bouncing_ball_beyond.periodic.orbits.return_map import returned
from bouncing_ball_beyond.periodic.orbits.special import Special
from bouncing_ball_beyond.periodic.orbits.stability import multiplier_at

# Weights of the central differences of the first and of the second derivative over the nine points
# -4…4, which are exact for polynomials of degree eight (nine for the second one).
_FIRST = np.array([1 / 280, -4 / 105, 1 / 5, -4 / 5, 0, 4 / 5, -1 / 5, 4 / 105, -1 / 280])
_SECOND = np.array([-1 / 560, 8 / 315, -1 / 5, 8 / 5, -205 / 72, 8 / 5, -1 / 5, 8 / 315, -1 / 560])
_NODES = np.arange(-4.0, 5.0)
# The largest step of the differences relative to the slowest impact, and the number of halvings.
_STEP = 0.1
_HALVINGS = 14
# Step of the differences by the parameter.
_DIFFERENCE = 6e-6
# det(M ∓ 1) of a bifurcation over the size of the entries of M.
_AT = 1e-6


@dataclass(frozen=True)
class NormalForm:
    """The normal form of a saddle-node or a period doubling, see :func:`normal_form`.

    ``kind`` is that of the orbit; ``coefficient`` is a or b and ``error`` its error; ``rate`` is
    that of the parameter ``along``; ``direction`` is q, and ``other`` the other multiplier.
    """

    kind: str
    coefficient: float
    error: float
    rate: float
    along: str
    direction: tuple[float, float]
    other: float

    @property
    def is_supercritical(self) -> bool:
        """Whether a period doubling has b > 0.

        Raises
        ------
        NoOrbitError
            If the orbit is a saddle-node.
        """
        if self.kind != Special.PERIOD_DOUBLING:
            raise NoOrbitError("a saddle-node is neither supercritical nor subcritical")
        return self.coefficient > 0

    @property
    def opens_upwards(self) -> bool:
        """Whether the orbits that branch off exist at larger values of the parameter: the two
        orbits of a saddle-node, or those of twice the period.
        """
        sign = -1 if self.kind == Special.SADDLE_NODE else 1
        return sign * self.rate * self.coefficient > 0


@suggesting
def normal_form(orbit: Orbit) -> NormalForm:
    """The first coefficient of the normal form of a saddle-node or a period doubling.

    Parameters
    ----------
    orbit : Orbit
        A special orbit of a branch, such as ``found.first("period doubling")``.

    Raises
    ------
    NoOrbitError
        If the orbit is neither of the two.

    Examples
    --------
    >>> import bouncing_ball_beyond
    >>> one = bouncing_ball_beyond.orbit(bouncing_ball_beyond.rigid(restitution=0.5), amplitude=1.4)
    >>> doubling = bouncing_ball_beyond.follow(one, to=1.8).first("period doubling")
    >>> found = bouncing_ball_beyond.normal_form(doubling)
    >>> found.is_supercritical, found.opens_upwards, round(found.coefficient, 6)
    (True, True, 1.54243)
    """
    if not isinstance(orbit, Orbit) or orbit.shape or orbit.kind not in list(Bifurcation):
        raise NoOrbitError(
            "normal_form needs a saddle-node or a period doubling of a branch, such as "
            'found.first("period doubling")'
        )
    problem, y = equations_of(orbit, orbit.along[0])
    kind = Bifurcation(orbit.kind)
    off = float(kind.test(*problem.trace_and_determinant(y)))
    size = 1 + float(np.max(np.abs(problem.monodromy(y))))
    if not abs(off) <= _AT * size:
        raise NoOrbitError(f"the orbit is no {kind}: its test function is {off:.1e}")
    value, error, right, other = coefficient(problem, y, kind)
    return NormalForm(
        kind=str(kind),
        coefficient=value,
        error=error,
        rate=_rate(problem, y, kind),
        along=orbit.along[0],
        direction=(float(right[0]), float(right[1])),
        other=other,
    )


def coefficient(
    problem: OrbitEquations, y: np.ndarray, kind: Bifurcation
) -> tuple[float, float, np.ndarray, float]:
    """a or b of an orbit at a bifurcation, its error, q, and the other multiplier."""
    right, left = eigenvectors(problem, y, multiplier_at(kind))
    other = float(problem.trace_and_determinant(y)[1]) / multiplier_at(kind)
    _, speed = problem.states(y)
    longest = _STEP * min(1.0, float(np.min(np.abs(speed))))
    steps = longest * 0.5 ** np.arange(_HALVINGS)
    nodes = np.multiply.outer(steps, _NODES).ravel()
    image = returned(problem, y, nodes[:, np.newaxis] * right)
    along = image.derivative.reshape(_HALVINGS, len(_NODES), 2, 2)
    first = np.einsum("n,hnij->hij", _FIRST, along) / steps[:, np.newaxis, np.newaxis]
    bend = first @ right
    if kind is Bifurcation.SADDLE_NODE:
        values = bend @ left / 2
    else:
        second = np.einsum("n,hnij->hij", _SECOND, along) / steps[:, np.newaxis, np.newaxis] ** 2
        whole = along[0, len(_NODES) // 2]
        moved = np.linalg.solve(np.eye(2) - whole, bend[..., np.newaxis])
        values = (second @ right) @ left / 6 + (first @ moved)[..., 0] @ left / 2
    change = np.abs(np.diff(values))
    # At an end of a curve the map may have no derivative.
    best = int(np.argmin(np.where(np.isnan(change), np.inf, change)))
    return float(values[best + 1]), float(change[best]), right, other


def eigenvectors(
    problem: OrbitEquations, y: np.ndarray, multiplier: float
) -> tuple[np.ndarray, np.ndarray]:
    """q with ``|q| = 1`` and its largest entry positive, and p with p·q = 1, of the monodromy."""
    m = problem.monodromy(y)
    off = np.array([[m.a, m.b], [m.c, m.d]]) - multiplier * np.eye(2)
    # The rows of adj(M - μ) are multiples of p, and its columns are multiples of q.
    adjugate = np.array([[off[1, 1], -off[0, 1]], [-off[1, 0], off[0, 0]]])
    column = int(np.argmax(np.sum(adjugate**2, axis=0)))
    row = int(np.argmax(np.sum(adjugate**2, axis=1)))
    right = adjugate[:, column] / np.linalg.norm(adjugate[:, column])
    right = right * np.sign(right[np.argmax(np.abs(right))])
    left = adjugate[row] / (adjugate[row] @ right)
    return right, left


def _rate(problem: OrbitEquations, y: np.ndarray, kind: Bifurcation) -> float:
    """The rate of the normal form, by the first parameter that varies."""
    name = problem.along[0]
    if kind is Bifurcation.PERIOD_DOUBLING:
        # det(M + 1) = (1 + μ₁)(1 + μ₂) along the branch.
        _, gradient = problem.bifurcation(kind, y)
        matrix = problem.jacobian(y)
        n = problem.size
        states = solve_linear(matrix[:, :n], -matrix[:, n])
        slope = gradient[:n] @ states + gradient[n]
        other = -float(problem.trace_and_determinant(y)[1])
        value = float(problem.values(y)[name])
        return -float(slope) / (1 + other) / math.sqrt(1 + value * value)
    _, left = eigenvectors(problem, y, 1.0)
    value = float(problem.values(y)[name])
    step = _DIFFERENCE * max(1.0, abs(value))
    sides = np.array([value + step, value - step])
    image = returned(problem, y, np.zeros((2, 2)), problem.balls.at({name: sides}))
    slope = (image.distance[0] - image.distance[1]) / (2 * step)
    return float(left @ slope)

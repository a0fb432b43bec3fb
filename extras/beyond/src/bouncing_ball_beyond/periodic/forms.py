"""Normal forms of saddle-nodes and period doublings, and orbits next to a grazing flight.

The derivation is in docs/equations.md. Sources: Y. A. Kuznetsov, *Elements of Applied Bifurcation
Theory*, sections 4.3, 4.5 and 5.4; Y. A. Kuznetsov, W. Govaerts, E. J. Doedel and A. Dhooge, SIAM
J. Numer. Anal. 43, 1407 (2005).
"""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from bouncing_ball_beyond.contacts.balls import brief
from bouncing_ball_beyond.periodic.chains import dense
from bouncing_ball_beyond.periodic.equations import (
    MULTIPLIERS,
    OrbitEquations,
    OrbitNotFound,
    PeriodicOrbit,
    flight,
)
from bouncing_ball_beyond.periodic.march import newton

NODES = np.arange(-4.0, 5.0)
FIRST = np.array([3, -32, 168, -672, 0, 672, -168, 32, -3]) / 840
SECOND = np.array([-9, 128, -1008, 8064, -14350, 8064, -1008, 128, -9]) / 5040
"""Weights of central differences at `NODES` for first and second derivatives.

They are exact for polynomials of degree 8.
"""

SHARE = 0.1
"""Largest change of an unknown in a step of the differences, divided by min(1, min |u|).

At half and at twice: coefficients change by 1e-9.
"""


SUCH = "such as branch.first('period doubling')"
"""What messages propose instead of a wrong orbit."""


def check_orbit(orbit: object) -> None:
    """Raise ValueError unless ``orbit`` is a `PeriodicOrbit`."""
    if not isinstance(orbit, PeriodicOrbit):
        raise ValueError(f"orbit = {brief(orbit)}: must be an orbit, {SUCH}")


# Normal forms


class Curvature(NamedTuple):
    """Derivatives of the residuals of the legs of one orbit, shape (k, q, q + 2 + p) each.

    Attributes
    ----------
    derivatives : array
        As in `LinearizedLegs`, without rows.
    first, second : array
        B(v, ·) and C(v, v, ·) of docs/equations.md.
    """

    derivatives: NDArray
    first: NDArray
    second: NDArray


def closed(derivatives: NDArray, multiplier: complex) -> NDArray:
    """Matrix, shape (kq, kq), of a chain of legs whose end is ``multiplier`` times its start."""
    q = derivatives.shape[-2]
    turned = derivatives[..., : q + 2] * np.ones_like(multiplier)
    turned[-1, :, q:] *= multiplier
    return dense(turned[np.newaxis])[0].reshape(-1, derivatives.shape[0] * q)


def curvature(
    equations: OrbitEquations, z: NDArray, v: NDArray, after: NDArray, step: float
) -> Curvature:
    """Differentiate the legs of one period along v, which is ``after`` one period later."""
    twice, row = equations.doubled(z[np.newaxis])
    direction = np.concatenate([v, after, np.zeros(len(z) - len(v))])
    rows = row + np.multiply.outer(step * NODES, direction)
    derivatives = twice.linearized(rows).derivatives[:, : equations.impacts]
    first = np.tensordot(FIRST, derivatives, axes=1) / step
    second = np.tensordot(SECOND, derivatives, axes=1) / step**2
    return Curvature(derivatives[len(NODES) // 2], first, second)


def _bent(
    equations: OrbitEquations, z: NDArray, v: NDArray, multiplier: complex, step: float
) -> Curvature:
    """Differentiate the legs along a vector that one period of the orbit multiplies.

    Complex steps already give the derivatives of the legs, so for a complex v the derivatives along
    real vectors are combined: B(v, ·) is linear in v, and C(v, v, ·) is quadratic.
    """
    after = multiplier * v
    if np.isrealobj(after):
        return curvature(equations, z, v, after, step)
    start, end = (np.array([x.real, x.imag, x.real + x.imag, x.real - x.imag]) for x in (v, after))
    real, imaginary, plus, minus = (
        curvature(equations, z, *way, step) for way in zip(start, end, strict=True)
    )
    second = real.second - imaginary.second + 0.5j * (plus.second - minus.second)
    return Curvature(real.derivatives, real.first + 1j * imaginary.first, second)


def coefficient(bent: Curvature, v: NDArray, w: NDArray, multiplier: complex) -> float:
    """Coefficient a or b of docs/equations.md. It depends on the scales of v and w."""
    bend = closed(bent.first, multiplier) @ v
    if multiplier == 1:
        return float(w @ bend / 2)
    if multiplier == -1:
        h = np.linalg.solve(closed(bent.derivatives, 1), -bend / 2)
        return float(w @ (closed(bent.first, 1) @ h + closed(bent.second, multiplier) @ v / 6))
    back, square = np.conj(multiplier), multiplier**2
    h = np.linalg.solve(closed(bent.derivatives, 1), -closed(bent.first, back) @ v.conj())
    g = np.linalg.solve(closed(bent.derivatives, square), -bend)
    cubic = closed(bent.first, 1) @ h + closed(bent.first.conj(), square) @ g / 2
    cubic += closed(bent.second, back) @ v.conj() / 2
    return float((back * (w @ cubic)).real)


def _vectors(derivatives: NDArray, multiplier: complex) -> tuple[NDArray, NDArray]:
    """Vectors v and w of docs/equations.md. Their scales follow from |v_0| = 1 and p v_0 = 1."""
    q = derivatives.shape[-2]
    left, _, right = np.linalg.svd(closed(derivatives, multiplier))
    v = right[-1].conj()
    w = left[:, -1].conj()
    # The sign of v is chosen so that τ or δ′ = -u grows, whichever changes more.
    start = v[:2] * [1.0, -1.0]
    largest = start[np.abs(start).argmax()]
    v = v * (abs(largest) / largest) / np.linalg.norm(start)
    return v, w / -(w[-q:] @ derivatives[-1, :, q : q + 2] @ v[:2])


@dataclass(frozen=True)
class NormalForm:
    """Normal form of a special orbit, the result of `normal_form`.

    Attributes
    ----------
    kind : str
        "saddle-node", "period doubling" or "Neimark-Sacker".
    coefficient : float
        a at a saddle-node or a Neimark-Sacker bifurcation, b at a period doubling.
    error : float
        Estimated error of the coefficient.
    rate : float
        Rate of the parameter in the map.
    along : str
        Name of the parameter.
    direction : tuple of two numbers
        Unit vector of ξ in (τ, δ′) of the first impact. It is complex for a pair.
    other : float or complex
        The other multiplier.
    obstacle : str
        Why no ball follows the special orbit, and then none the orbits beside it; "" if a ball
        does.
    """

    kind: str
    coefficient: float
    error: float
    rate: float
    along: str
    direction: tuple[complex, complex]
    other: complex
    obstacle: str = ""

    @property
    def supercritical(self) -> bool:
        """Whether a period doubling has b > 0, or a Neimark-Sacker bifurcation a < 0.

        The doubled orbits, or the closed curve, then exist where the orbit is unstable. The closed
        curve is then stable, and doubled orbits are stable if the other multiplier is inside the
        unit circle. Raises ValueError for a saddle-node.
        """
        if self.kind == "saddle-node":
            raise ValueError("a saddle-node is neither supercritical nor subcritical")
        return (self.coefficient > 0) == (self.kind == "period doubling")

    @property
    def opens_upwards(self) -> bool:
        """Whether the new orbits exist at larger values of the parameter.

        These are the doubled orbits of a period doubling, the closed curve of a Neimark-Sacker
        bifurcation, or both orbits of a saddle-node.
        """
        return -MULTIPLIERS.get(self.kind, 1) * self.rate * self.coefficient > 0


RESONANT = 1e-3
"""Smallest |μ^k - 1|, for k from 1 to 4, of a Neimark-Sacker bifurcation with a normal form.

At a strong resonance, the cubic terms that turn with the motion count, too; at the first three,
`coefficient` is infinite.
"""


def _off_resonance(orbit: PeriodicOrbit) -> complex:
    """Multiplier of a Neimark-Sacker bifurcation. Raises ValueError at a strong resonance."""
    multiplier = np.exp(1j * np.arccos(np.clip(orbit.trace_and_determinant[0] / 2, -1, 1)))
    distances = np.abs(multiplier ** np.arange(1, 5) - 1)
    if distances.min() < RESONANT:
        raise ValueError(
            f"the bifurcation is at the strong resonance 1:{distances.argmin() + 1}, which has"
            " another normal form"
        )
    return multiplier


def normal_form(orbit: PeriodicOrbit) -> NormalForm:
    """Compute the normal form of a saddle-node, a period doubling or a Neimark-Sacker bifurcation.

    On the centre manifold the return map is ξ → ξ + rate dλ + aξ² at a saddle-node, and
    ξ → -(1 + rate dλ) ξ + bξ³ at a period doubling. At a Neimark-Sacker bifurcation ξ is complex,
    and |ξ| → (1 + rate dλ) |ξ| + a|ξ|³: motions near the orbit have the deviation 2 Re(ξv) from it.

    Parameters
    ----------
    orbit : PeriodicOrbit
        Saddle-node or period doubling of a branch.

    Returns
    -------
    NormalForm

    Raises
    ------
    ValueError
        If the orbit is of another kind, or if a pair of multipliers is a strong resonance: its
        first, second, third or fourth power is 1.

    Examples
    --------
    >>> from bouncing_ball_beyond import Rigid, follow, orbit
    >>> branch = follow(orbit(Rigid(0.5), amplitude=1.4), to=1.8)
    >>> form = normal_form(branch.first("period doubling"))
    >>> form.supercritical, form.opens_upwards, round(form.coefficient, 6)
    (True, True, 1.54243)
    """
    check_orbit(orbit)
    if orbit.kind not in (*MULTIPLIERS, "Neimark-Sacker"):
        raise ValueError(
            f"kind = {orbit.kind!r}: a normal form needs a saddle-node, a period doubling or a"
            ' Neimark-Sacker bifurcation, such as branch.first("period doubling")'
        )
    multiplier = MULTIPLIERS.get(orbit.kind) or _off_resonance(orbit)
    equations = orbit.equations
    z = orbit.z
    q = equations.unknowns
    derivatives = equations.linearized(z[np.newaxis]).derivatives[0]
    v, w = _vectors(derivatives, multiplier)
    # The longest step of the central differences along v.
    slowest = np.abs(z[1 : equations.size : q]).min()
    step = SHARE * min(1.0, slowest) / np.abs(v).max()
    by_parameter = derivatives[..., q + 2].ravel()
    coarse, fine = (_bent(equations, z, v, multiplier, h) for h in (step, step / 2))
    value = coefficient(fine, v, w, multiplier)
    if multiplier == 1:
        rate = w @ by_parameter
    else:
        moved = np.linalg.solve(closed(derivatives, 1), -by_parameter)
        turned = w @ (closed(fine.first, 1) @ moved + fine.first[..., q + 2].ravel())
        rate = (np.conj(multiplier) * turned).real
    return NormalForm(
        kind=orbit.kind,
        coefficient=value,
        error=abs(value - coefficient(coarse, v, w, multiplier)),
        rate=float(rate),
        along=equations.along[0].name,
        direction=tuple((v[:2] * [1, -1]).tolist()),
        other=orbit.trace_and_determinant[1] / multiplier,
        obstacle=orbit.obstacle,
    )


# Grazing flights

FLIGHT_SAMPLES = 201
"""Number of samples of a flight in the search for its lowest point."""

TOUCHES = 1e-9
"""Maximum gap at the lowest point of a flight that touches the table.

Grazings are located to 1e-12.

At half and at twice: no effect.
"""

SLOW = 1e-3
"""Speed of an added impact, divided by aD².

a is δ″ at the touch. On a stiff contact, the branch of orbits with this impact turns back at a few
hundredths.

At half and at twice: no effect.
"""


class Touch(NamedTuple):
    """Point at which a flight touches the table.

    Attributes
    ----------
    leg : int
        Number of the impact before the flight, from 0.
    time : float
        Time of the touch.
    acceleration : float
        δ″ at the touch.
    """

    leg: int
    time: float
    acceleration: float


def _touch(equations: OrbitEquations, z: NDArray) -> Touch:
    """Find where a flight of an orbit touches the table. Raises OrbitNotFound if none does."""
    if equations.ball.below_table:
        raise OrbitNotFound(
            "an impact of the corrected model takes effect below the table: at a grazing flight"
            " there are no orbits with one impact more"
        )
    ends = equations.ends(z[np.newaxis])
    leaves, gap, speed, last, amplitudes = (quantity[0] for quantity in ends[:5])
    amplitude = float(amplitudes[0])
    table = ends.table.rows(0).rows(0)
    times = np.linspace(0, last, FLIGHT_SAMPLES)
    heights = flight(times, leaves, gap, speed, amplitude, table)[0]
    least = (heights[1:-1] < heights[:-2]) & (heights[1:-1] <= heights[2:])
    if not least.any():
        raise OrbitNotFound("no flight of the orbit turns back from the table")
    lowest = np.where(least, heights[1:-1], np.inf)
    sample, leg = np.unravel_index(lowest.argmin(), lowest.shape)
    time = times[sample + 1, leg]
    for _ in range(8):
        height, rate = flight(time, leaves[leg], gap[leg], speed[leg], amplitude, table)
        acceleration = -amplitude * table(leaves[leg] + time, 2) - 1
        time = time - rate / acceleration
    if not abs(height) < TOUCHES:
        raise OrbitNotFound(
            f"no flight of the orbit touches the table: the smallest gap is {height:.2g}"
        )
    return Touch(int(leg), float(leaves[leg] + time), float(acceleration))


def one_impact_more(
    equations: OrbitEquations, z: NDArray
) -> tuple[OrbitEquations, NDArray, NDArray]:
    """Find the first orbit with one more impact than an orbit z with a grazing flight.

    Returns

    1. the equations of k + 1 impacts;
    2. their first orbit, next to z, shape (N + q,);
    3. the direction in which the speed of the added impact grows by 1, shape (N + q,).

    Raises OrbitNotFound if no flight touches the table, or if the first orbit is not found.
    """
    at = _touch(equations, z)
    _, ball, amplitude, table = equations.split(z[np.newaxis])
    # If the added impact is instantaneous, it has the speed 0, because its free impact takes no
    # time.
    free = float(np.ravel(ball.signature(SLOW).duration)[0])
    u = SLOW * at.acceleration * np.fmin(1.0, free) ** 2
    start = at.time - u / at.acceleration
    T = float(np.ravel(ball.first_release(start, u, amplitude, table=table))[0])
    added = [start, u, T][: equations.unknowns]
    place = (at.leg + 1) * equations.unknowns
    more = replace(equations, impacts=equations.impacts + 1)
    guess = np.insert(z, place, added)
    normal = np.zeros((1, guess.size))
    normal[0, place + 1] = 1.0
    solution = newton(more, guess[np.newaxis], normal)
    if not solution.converged[0]:
        raise OrbitNotFound(
            f"no orbit with {more.impacts} impacts is found next to the grazing flight:"
            " Newton's method does not converge"
        )
    return more, solution.z[0], solution.tangent[0]


@dataclass(frozen=True)
class GrazingForm:
    """Result of `grazing_form`.

    Attributes
    ----------
    leg : int
        Number of the impact before the flight, from 0.
    phase : float
        Phase of the table at the touch.
    acceleration : float
        a = δ″ at the touch.
    coefficient : float
        Coefficient S of the square root.
    slope : float
        Derivative of the parameter with respect to the speed of the added impact; 0 for contacts of
        finite duration.
    along : str
        Name of the parameter.
    opens_upwards : bool
        Whether the orbits with one more impact exist at larger values of the parameter.
    persists : bool
        Whether the orbits with one more impact exist where the flight would be below the table. If
        not, they meet the orbit with the grazing flight, and all these orbits disappear.
    """

    leg: int
    phase: float
    acceleration: float
    coefficient: float
    slope: float
    along: str
    opens_upwards: bool
    persists: bool


def grazing_form(orbit: PeriodicOrbit) -> GrazingForm:
    """Compute the square-root term of the return map at a grazing flight.

    If the flight would be at the depth d below the table, an additional impact changes the velocity
    by S √d. S is (1 + r) √(2a), where r belongs to the speed 0. For contacts of finite duration S
    is 0 (docs/equations.md).

    Parameters
    ----------
    orbit : PeriodicOrbit
        Grazing of a flight of a branch.

    Returns
    -------
    GrazingForm

    Raises
    ------
    OrbitNotFound
        If no flight touches the table, if the impacts of the ball take effect below the table, or
        if no orbit with one more impact is found.

    Examples
    --------
    >>> from bouncing_ball_beyond import Rigid, follow, orbit
    >>> branch = follow(orbit(Rigid(0.5), amplitude=2.0, side="unstable"), to=3.0)
    >>> form = grazing_form(branch.first("grazing of a flight"))
    >>> round(form.coefficient, 6), form.persists
    (2.507284, False)

    Source: A. B. Nordmark, J. Sound Vib. 145, 279 (1991).
    """
    check_orbit(orbit)
    # On a curve two parameters change. The form belongs to the first parameter.
    path = orbit.equations.along[0]
    equations, z = orbit.on(path)
    at = _touch(equations, z)
    _, _, direction = one_impact_more(equations, z)
    opens_upwards = bool(direction[-1] > 0)
    tangent = newton(equations, z[np.newaxis]).tangent[0]
    # The smallest gap is a smooth function. Its difference over a step of 1e-6 has enough digits
    # for the sign.
    step = 1e-6 * max(1.0, abs(z[-1]))
    below, above = equations.clearance(z + np.multiply.outer([-step, step], tangent))
    # r = -1 gives S = 0 for contacts of finite duration.
    r, slope = -1.0, 0.0
    if not orbit.ball.has_duration:
        r, slope = float(orbit.ball.signature(0.0).restitution), float(direction[-1])
    return GrazingForm(
        leg=at.leg,
        phase=float(np.pi - (np.pi - at.time) % (2 * np.pi)),
        acceleration=at.acceleration,
        coefficient=(1 + r) * float(np.sqrt(2 * at.acceleration)),
        slope=slope,
        along=path.name,
        opens_upwards=opens_upwards,
        persists=opens_upwards == bool(above < below),
    )

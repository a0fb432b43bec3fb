"""Independent implementation of both models, as a reference for the tests.

It shares no code with the package. The motion in contact is computed in two ways: by
`scipy.integrate.solve_ivp`, and by the exponential of the matrix of its linear equation. The
exponential needs no special case at resonance.

The equation of motion is scaled with the time θ = ϖ s and the displacement q = ϖδ. All terms are
then of order one for any stiffness of the contact:

    dq/dθ = δ′,  dδ′/dθ = -q - 2ζδ′ + (Λ sin(s + φ) - 1)/ϖ.
"""

from dataclasses import dataclass

import numpy as np
from scipy.integrate import simpson, solve_ivp
from scipy.optimize import brentq

ACCURACY = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-14}


def restitution_to_damping(r, release="displacement"):
    """Damping ratio ζ with which a free impact has the restitution r.

    It is ζ = sin β with ln r = -θ tan β, where θ is the angle of the damped oscillation in contact:
    π for the displacement release (Eq. 16), and π - 2β for the force release.
    """
    if release == "displacement":
        return np.sin(np.arctan(-np.log(r) / np.pi))

    def excess(beta):
        return (np.pi - 2 * beta) * np.tan(beta) + np.log(r)

    return np.sin(brentq(excess, 0, np.pi / 2 - 1e-9, xtol=1e-15))


def lag(ratio, zeta, release):
    """Coefficient κ of the release condition δ + κδ′ = 0."""
    return 2 * zeta / ratio if release == "force" else 0.0


def transfer(ratio, zeta, duration):
    """Matrices that map (ϖδ, δ′, w, w′, 1) at the start of a contact to given times after it."""
    duration = np.asarray(duration, dtype=float)
    rates = np.zeros((5, 5))
    rates[0, 1] = 1
    rates[1] = -1, -2 * zeta, 1 / ratio, 0, -1 / ratio
    rates[2, 3] = 1 / ratio
    rates[3, 2] = -1 / ratio
    # Scaling and squaring: for a matrix of norm below 1/4, the series of the exponential has a
    # remainder 0.25¹³/13! < 1e-17. `scipy.linalg.expm` computes its matrices one by one.
    norm = np.abs(rates).sum(axis=1).max() * ratio * np.max(duration)
    halvings = max(0, int(np.ceil(np.log2(4 * norm + 1))))
    step = rates * (ratio * duration / 2**halvings)[..., np.newaxis, np.newaxis]
    total = np.broadcast_to(np.eye(5), step.shape)
    for order in range(12, 0, -1):
        total = np.eye(5) + step @ total / order
    for _ in range(halvings):
        total = total @ total
    return total


def orbit(n, ratio, zeta, release, duration):
    """n-T orbits (Λ, φ, z′_i, ϖτ_b) with given durations of the contact, shape (4, ...).

    For a given duration, the conditions of release, landing and velocity are three linear equations
    for X = Λ cos φ, Y = Λ sin φ and u = δ′_i.
    """
    duration = np.asarray(duration, dtype=float)
    flight = 2 * np.pi * n - duration
    # Columns: coefficients of X, Y, u and 1 in the start (ϖδ, δ′, w, w′, 1) = (0, u, Y, X, 1).
    start = np.zeros((5, 4))
    start[3, 0] = start[2, 1] = start[1, 2] = start[4, 3] = 1
    end = transfer(ratio, zeta, duration) @ start
    gap = end[..., 0, :] / ratio
    rate = end[..., 1, :]
    velocity = rate + end[..., 3, :]
    release = ratio * (gap + lag(ratio, zeta, release) * rate)
    landing = gap + end[..., 2, :] - start[2] + flight[..., np.newaxis] * velocity
    landing[..., 3] -= flight**2 / 2
    repeating = velocity - start[3] - start[1]
    repeating[..., 3] -= flight
    rows = np.stack([release, landing, repeating], axis=-2)
    x, impact_height, u = np.moveaxis(np.linalg.solve(rows[..., :3], -rows[..., 3:])[..., 0], -1, 0)
    return np.stack(
        [np.hypot(x, impact_height), np.arctan2(impact_height, x), u + x, ratio * duration]
    )


def monodromy(n, ratio, zeta, release, duration):
    """Monodromy matrix of the state (z, z′) over one cycle, shape (..., 2, 2).

    Its eigenvalues are the Floquet multipliers of the orbit. It is the product of the transition
    matrices of contact and flight, and of the saltation matrices of landing and release. A
    saltation matrix is 1 + (jump of the rates)(gradient of the event)ᵀ/(rate of the event).

    - Landing: z″ jumps by -2ζϖδ′, and the rate of the event δ = 0 is δ′.
    - Displacement release: z″ jumps back.
    - Force release: z″ does not jump, because the force vanishes.
    """
    duration = np.asarray(duration, dtype=float)
    scale = np.array([[1, ratio], [1 / ratio, 1]])
    contact = transfer(ratio, zeta, duration)[..., :2, :2] / scale
    kick = 2 * zeta * ratio
    landing = np.array([[1, 0], [-kick, 1]])
    leaving = np.array([[1, 0], [kick if release == "displacement" else 0, 1]])
    flight = np.zeros((*duration.shape, 2, 2))
    flight[..., 0, 0] = flight[..., 1, 1] = 1
    flight[..., 0, 1] = 2 * np.pi * n - duration
    return landing @ flight @ leaving @ contact


def test_functions(n, ratio, zeta, release, duration):
    """Test functions of the bifurcations, for the monodromy matrix.

    1 - trace + determinant vanishes at a saddle-node, and 1 + trace + determinant vanishes at a
    period doubling.
    """
    trace = np.trace(monodromy(n, ratio, zeta, release, duration), axis1=-2, axis2=-1)
    determinant = np.exp(-2 * zeta * ratio * np.asarray(duration))
    return 1 - trace + determinant, 1 + trace + determinant


test_functions.__test__ = False


def roots(function, grid):
    """Zeros of a vectorised function, bracketed by the points of a grid."""
    values = function(grid)
    brackets = np.flatnonzero(values[:-1] * values[1:] < 0)
    return [brentq(function, grid[i], grid[i + 1], xtol=1e-16) for i in brackets]


def lowest(function):
    """Minimum of a function on the interval [0.01, 0.99].

    The interval is sampled at 201 points. It is then reduced twice to the interval between the
    neighbours of the smallest sample, and sampled again.
    """
    part = np.linspace(0.01, 0.99, 201)
    for _ in range(2):
        middle = np.clip(np.argmin(function(part)), 1, 199)
        part = np.linspace(part[middle - 1], part[middle + 1], 201)
    return function(part).min()


@dataclass
class Contact:
    """Contact computed by integration.

    Attributes
    ----------
    duration
        Duration of the contact.
    gap, rate
        δ and δ′ at its end.
    times, gaps, rates
        400 samples: time since the start, ϖδ and δ′.
    """

    duration: float
    gap: float
    rate: float
    times: np.ndarray
    gaps: np.ndarray
    rates: np.ndarray

    def centroid(self, zeta):
        """Centroid of the force -ϖ²δ - 2ζϖδ′, of which a factor ϖ does not matter."""
        force = -self.gaps - 2 * zeta * self.rates
        return simpson(force * self.times, self.times) / simpson(force, self.times)


def integrate_contact(ratio, zeta, release, amplitude, phase, u, weight=1.0, duration=None):
    """Integrate Eq. 11 from δ = 0, δ′ = u until the release, or for a given duration."""
    kappa = lag(ratio, zeta, release) * ratio

    def rates(theta, state):
        force = (amplitude * np.sin(theta / ratio + phase) - weight) / ratio
        return [state[1], force - state[0] - 2 * zeta * state[1]]

    def released(theta, state):
        return state[0] + kappa * state[1]

    released.terminal = True
    released.direction = 1
    last = 200 * ratio if duration is None else ratio * duration
    event = released if duration is None else None
    path = solve_ivp(
        rates, (0, last), [0.0, u], events=event, dense_output=True, max_step=0.5, **ACCURACY
    )
    theta = path.t[-1]
    state = path.y[:, -1]
    if duration is None:
        # The event is located on the interpolant, which is less accurate than the steps. Integrate
        # again to its time, and correct the remaining error by one Newton step.
        state = solve_ivp(rates, (0, theta), [0.0, u], **ACCURACY).y[:, -1]
        speed = np.array(rates(theta, state))
        late = released(theta, state) / (speed[0] + kappa * speed[1])
        theta = theta - late
        state = state - late * speed
    samples = np.linspace(0, theta, 400)
    dense = path.sol(np.minimum(samples, path.t[-1]))
    return Contact(theta / ratio, state[0] / ratio, state[1], samples / ratio, *dense)


@dataclass
class Cycle:
    """A contact and the flight after it.

    Attributes
    ----------
    contact
        The contact.
    bounce
        Velocity of the ball at the end of the contact.
    time
        Duration of contact and flight together.
    velocity
        Velocity of the ball at the next landing.
    times, heights, velocities
        400 samples in contact, followed by 400 samples in flight.
    """

    contact: Contact
    bounce: float
    time: float
    velocity: float
    times: np.ndarray
    heights: np.ndarray
    velocities: np.ndarray

    def greatest_height(self):
        """Maximum height, from a parabola through the largest sample and its two neighbours."""
        greatest = self.heights.max()
        for part in np.split(self.heights, 2):
            middle = np.clip(np.argmax(part), 1, 398)
            before, top, after = part[middle - 1 : middle + 2]
            if top >= max(before, after):
                summit = top - (after - before) ** 2 / (8 * (before - 2 * top + after))
                greatest = max(greatest, summit)
        return greatest


def cycle(ratio, zeta, release, amplitude, phase, velocity):
    """Integrate a contact from its start to its release, and follow the flight to its landing."""
    u = velocity - amplitude * np.cos(phase)
    contact = integrate_contact(ratio, zeta, release, amplitude, phase, u)
    height = contact.gap + amplitude * np.sin(phase + contact.duration)
    bounce = contact.rate + amplitude * np.cos(phase + contact.duration)
    kappa = lag(ratio, zeta, release)
    flight = first_landing(amplitude, phase + contact.duration, height, bounce, kappa)
    pressed = phase + contact.times
    flying = np.linspace(0, flight, 400)
    return Cycle(
        contact=contact,
        bounce=bounce,
        time=contact.duration + flight,
        velocity=bounce - flight,
        times=np.concatenate([contact.times, contact.duration + flying]),
        heights=np.concatenate(
            [
                contact.gaps / ratio + amplitude * np.sin(pressed),
                height + bounce * flying - flying**2 / 2,
            ]
        ),
        velocities=np.concatenate([contact.rates + amplitude * np.cos(pressed), bounce - flying]),
    )


def first_landing(amplitude, phase, height, velocity, kappa=0.0):
    """Duration of a flight that starts at a height, found in steps of about 2e-3.

    The flight ends when δ decreases through zero. After a force release δ is negative at first. The
    flight then also ends if δ + κδ′ decreases through zero while δ is negative, because the contact
    presses the ball again.
    """

    def gap(s):
        return height + velocity * s - s**2 / 2 - amplitude * np.sin(phase + s)

    def outside(s):
        rate = velocity - s - amplitude * np.cos(phase + s)
        return np.maximum(gap(s), gap(s) + kappa * rate) if kappa else gap(s)

    last = velocity + np.sqrt(velocity**2 + 2 * (height + amplitude)) + 1
    grid = np.linspace(0, last, 2 + int(last / 2e-3))
    values = outside(grid)
    # Skip the first point. It is the release, where rounding errors decide the sign.
    first = 1 + np.flatnonzero((values[1:-1] > 0) & (values[2:] <= 0))[0]
    return brentq(outside, grid[first], grid[first + 1], xtol=1e-15)

"""n-T orbits of the spring-damper model and their stability (Eqs. 17-27).

An orbit is represented by a vector y = (Λ, φ, z′_i, θ):

    Λ     amplitude of the table,
    φ     phase of the table when the contact starts,
    z′_i  velocity of the ball when the contact starts,
    θ     scaled duration of the contact, θ = ϖ τ_b.

The paper describes an orbit by six equations, Eqs. 21-26. Here z′_b and the constants A and B of
Eqs. 12 and 13 are eliminated. Three equations remain for the four unknowns of y, so the orbits of a
family form curves. Arrays of orbits have the shape (4, ...).
"""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bouncing_ball.restitution import MARGIN, Numbers, is_stable, periods, required
from bouncing_ball.spring_damper import NO_CONTACT, Contact

RINGING = 15
"""Decay rates ζθ after which a contact no longer rings, and its samples may be far apart."""

MOST_SAMPLES = 2000
"""Maximum number of samples, two in a radian of θ, while a contact rings."""


class NoOrbit(ValueError):
    """The orbit does not exist, or Newton's method does not find it."""


def contact_of_ball(frequency_ratio: Numbers, r: float, release: str) -> Contact:
    """Contact with whose damping a free impact has the restitution r.

    Raises NoOrbit if there is none (`spring_damper.damping_ratio`).
    """
    r = float(required("r", r, False, "0 < r <= 1"))
    required("r", r, np.isnan(r), "0 < r <= 1")
    contact = Contact.of_restitution(frequency_ratio, r, release)
    if np.isnan(contact.damping_ratio):
        raise NoOrbit(f"r = {r:g}: {NO_CONTACT}")
    return contact


@dataclass(frozen=True)
class ContactEnd:
    """State of ball and table when a contact ends.

    Attributes
    ----------
    duration, flight
        Durations of the contact and of the flight after it.
    table_height, table_velocity
        Height and velocity of the table.
    gap, gap_velocity, gap_acceleration
        Relative motion δ, δ′ and δ″ at the end of the contact, while the contact still acts.
    gap_by, gap_velocity_by
        Derivatives of δ and δ′ with respect to X, Y and u, for a fixed duration.
    """

    duration: NDArray
    flight: NDArray
    table_height: NDArray
    table_velocity: NDArray
    gap: NDArray
    gap_velocity: NDArray
    gap_acceleration: NDArray
    gap_by: tuple[NDArray, NDArray, NDArray]
    gap_velocity_by: tuple[NDArray, NDArray, NDArray]

    @property
    def velocity(self) -> NDArray:
        """Velocity z′_b of the ball (Eq. 24)."""
        return self.gap_velocity + self.table_velocity


@dataclass(frozen=True)
class Family:
    """n-T orbits for one contact and one n, or for arrays of contacts and n.

    Methods take orbits y, shape (4, ...). The axes after the first must broadcast against n and
    against the parameters of the contact.

    Attributes
    ----------
    n
        Number of table periods in one cycle.
    contact
        Contact of ball and table.

    Raises
    ------
    ValueError
        If n is not a whole number of periods.
    """

    n: int | NDArray
    contact: Contact

    def __post_init__(self):
        periods(self.n)

    @property
    def period(self) -> float | NDArray:
        """Period 2πn of the orbits."""
        return 2 * np.pi * self.n

    def start(self, y: NDArray) -> tuple[NDArray, NDArray, NDArray]:
        """X = Λ cos φ, Y = Λ sin φ and the relative impact velocity u = δ′_i = z′_i - X."""
        amplitude, phase, velocity, _ = y
        x = amplitude * np.cos(phase)
        return x, amplitude * np.sin(phase), velocity - x

    def contact_end(self, y: NDArray) -> ContactEnd:
        """State of ball and table when the contact ends."""
        x, impact_height, u = self.start(y)
        duration = y[3] / self.contact.frequency_ratio
        cosine = np.cos(duration)
        sine = np.sin(duration)
        response = self.contact.responses(duration)
        motion = self.contact.motion(duration, u, x, impact_height, response)
        return ContactEnd(
            duration=duration,
            flight=self.period - duration,
            table_height=x * sine + impact_height * cosine,
            table_velocity=x * cosine - impact_height * sine,
            gap=motion.displacement,
            gap_velocity=motion.velocity,
            gap_acceleration=motion.acceleration,
            gap_by=(response.sine, response.cosine, response.impulse),
            gap_velocity_by=(
                response.cosine,
                response.impulse - response.sine,
                response.impulse_rate,
            ),
        )

    def equations(self, y: NDArray, end: ContactEnd | None = None) -> NDArray:
        """Residuals of the three equations of an orbit, shape (3, ...).

        1. Release: ϖ(δ + κδ′) = 0 when the contact ends (Eq. 23).
        2. Landing: δ = 0 after a flight of duration L (Eqs. 19 and 25).
        3. Velocity: z′_b - L = z′_i at the landing (Eqs. 20, 26 and 27).

        The landing equation is divided by L, and -κδ′ replaces δ at the release. The equations are
        then regular as L tends to 0, where the orbit becomes permanent contact.

        Pass `end` to avoid computing the end of the contact again.
        """
        x, impact_height, _ = self.start(y)
        end = end or self.contact_end(y)
        lag = self.contact.lag
        flight = end.flight
        # (w_b - w_i)/L. The phase of the table grows by L from the release to the landing, and at
        # the landing it equals φ up to a multiple of 2π.
        table_rise = -x * np.sinc(flight / np.pi) - impact_height * np.sin(flight / 2) * np.sinc(
            flight / (2 * np.pi)
        )
        landing = table_rise + end.velocity - flight / 2
        if self.contact.release == "force":
            landing = landing - lag * end.gap_velocity / flight
        return np.stack(
            np.broadcast_arrays(
                self.contact.frequency_ratio * (end.gap + lag * end.gap_velocity),
                landing,
                end.velocity - flight - y[2],
            )
        )

    def jacobian(self, y: NDArray, end: ContactEnd | None = None) -> NDArray:
        """Derivatives of the residuals with respect to y, shape (3, 4, ...).

        Pass `end` to avoid computing the end of the contact again.
        """
        x, impact_height, _ = self.start(y)
        end = end or self.contact_end(y)
        lag = self.contact.lag
        ratio = self.contact.frequency_ratio
        flight = end.flight
        by_rate = np.stack(end.gap_velocity_by)
        zero = np.zeros_like(x)
        # Columns: derivatives with respect to X, Y, u and the duration of the contact. A longer
        # contact shortens the flight by the same time.
        to_release = ratio * np.stack(
            [*(np.stack(end.gap_by) + lag * by_rate), end.gap_velocity + lag * end.gap_acceleration]
        )
        to_velocity = np.stack(
            [
                by_rate[0] + np.cos(end.duration),
                by_rate[1] - np.sin(end.duration),
                by_rate[2],
                end.gap_acceleration - end.table_height,
            ]
        )
        # Derivatives of sin(L)/L and (1 - cos L)/L with respect to L. For small L use their series,
        # because the terms of the closed forms cancel.
        small = np.abs(flight) < 1e-3
        safe = np.where(small, 1, flight)
        by_sine = np.where(
            small, -flight / 3 + flight**3 / 30, (safe * np.cos(safe) - np.sin(safe)) / safe**2
        )
        by_cosine = np.where(
            small, 1 / 2 - flight**2 / 8, (safe * np.sin(safe) - 1 + np.cos(safe)) / safe**2
        )
        to_landing = to_velocity + np.stack(
            [
                -np.sinc(flight / np.pi) + zero,
                -np.sin(flight / 2) * np.sinc(flight / (2 * np.pi)) + zero,
                zero,
                x * by_sine + impact_height * by_cosine + 1 / 2,
            ]
        )
        if self.contact.release == "force":
            by_duration = end.gap_acceleration + end.gap_velocity / flight
            to_landing = to_landing - lag / flight * np.stack([*by_rate, by_duration])
        whole = np.stack([to_release, to_landing, to_velocity])
        whole[2, 3] += 1
        # Chain rule from (X, Y, u, τ_b) to (Λ, φ, z′_i, θ): X = Λ cos φ, Y = Λ sin φ,
        # u = z′_i - X, τ_b = θ/ϖ.
        by_x = whole[:, 0] - whole[:, 2]
        cosine = np.cos(y[1])
        sine = np.sin(y[1])
        columns = [
            cosine * by_x + sine * whole[:, 1],
            -impact_height * by_x + x * whole[:, 1],
            whole[:, 2],
            whole[:, 3] / ratio,
        ]
        matrix = np.stack(columns, axis=1)
        matrix[2, 2] -= 1
        return matrix

    def release_map(self, y: NDArray) -> NDArray:
        """Linearised map from the start of contact to the release, shape (3, 2, ...).

        Rows: time of the release, height and velocity of the ball. Columns: phase and velocity at
        the start. The release condition gives the change of the duration of the contact.
        """
        x, impact_height, u = self.start(y)
        end = self.contact_end(y)
        lag = self.contact.lag
        columns = []
        # Derivatives of (X, Y, u) with respect to the phase and to the velocity at the start.
        for phase, change in (
            (1, (-impact_height, x, impact_height)),
            (0, (0 * u, 0 * u, 1 + 0 * u)),
        ):
            gap = sum(one * other for one, other in zip(end.gap_by, change, strict=True))
            rate = sum(one * other for one, other in zip(end.gap_velocity_by, change, strict=True))
            longer = -(gap + lag * rate) / (end.gap_velocity + lag * end.gap_acceleration)
            later = phase + longer
            height = end.table_velocity * later + gap + end.gap_velocity * longer
            velocity = rate + end.gap_acceleration * longer - end.table_height * later
            columns.append([later, height, velocity])
        return np.moveaxis(np.array(columns), 0, 1)

    def return_map(self, y: NDArray) -> NDArray:
        """Linearised map from one start of contact to the next, shape (2, 2, ...).

        Rows: phase and velocity at the next start. Columns: phase and velocity at this start. The
        landing condition gives the change of the duration of the flight.
        """
        x, _, u = self.start(y)
        later, height, velocity = self.release_map(y)
        flight = self.period - self.contact_duration(y)
        longer = -(height + flight * velocity - x * later) / u
        return np.stack([later + longer, velocity - longer])

    def trace_and_determinant(self, y: NDArray) -> tuple[NDArray, NDArray]:
        """Trace and determinant of the linearised return map.

        The determinant is exp(-2ζϖτ_b) for both release conditions.
        """
        matrix = self.return_map(y)
        return matrix[0, 0] + matrix[1, 1], np.exp(-2 * self.contact.damping_ratio * y[3])

    def saddle_node_test(self, y: NDArray) -> NDArray:
        """1 - trace + determinant, which vanishes if a Floquet multiplier is 1."""
        trace, determinant = self.trace_and_determinant(y)
        return 1 - trace + determinant

    def period_doubling_test(self, y: NDArray) -> NDArray:
        """1 + trace + determinant, which vanishes if a Floquet multiplier is -1."""
        trace, determinant = self.trace_and_determinant(y)
        return 1 + trace + determinant

    def multipliers(self, y: NDArray) -> NDArray:
        """Complex Floquet multipliers, shape (2, ...), in order of decreasing modulus."""
        trace, determinant = self.trace_and_determinant(y)
        root = np.sqrt(trace**2 / 4 - determinant + 0j)
        larger = np.where(trace < 0, trace / 2 - root, trace / 2 + root)
        with np.errstate(invalid="ignore"):  # orbits that are NaN
            return np.stack([larger, determinant / larger])

    def motion(self, y: NDArray, s: NDArray) -> tuple[NDArray, NDArray, NDArray]:
        """Motion of the ball during one cycle (Eqs. 12-15).

        Returns height, velocity, and whether the ball is in contact, at the times s since the start
        of the contact. The times must be between 0 and the period.
        """
        x, impact_height, u = self.start(y)
        end = self.contact_end(y)
        touching = s <= end.duration
        gap, gap_velocity, _ = self.contact.motion(np.minimum(s, end.duration), u, x, impact_height)
        since = s - end.duration
        height = np.where(
            touching,
            x * np.sin(s) + impact_height * np.cos(s) + gap,
            end.table_height + end.gap + end.velocity * since - since**2 / 2,
        )
        velocity = np.where(
            touching, x * np.cos(s) - impact_height * np.sin(s) + gap_velocity, end.velocity - since
        )
        return height, velocity, touching

    def bounce_velocity(self, y: NDArray) -> NDArray:
        """Velocity z′_b of the ball when the contact ends (Eq. 24)."""
        return self.contact_end(y).velocity

    def apparent_restitution(self, y: NDArray) -> NDArray:
        """Apparent restitution coefficient r_a = -δ′_b/δ′_i (Eq. 17)."""
        _, _, u = self.start(y)
        return -self.contact_end(y).gap_velocity / u

    def summit(self, y: NDArray) -> NDArray:
        """Maximum height of the ball during the flight.

        If the ball only falls or only rises, the maximum is at one end of the flight.
        """
        end = self.contact_end(y)
        rise = np.clip(end.velocity, 0, end.flight)
        return end.table_height + end.gap + end.velocity * rise - rise**2 / 2

    def max_height(self, y: NDArray) -> NDArray:
        """Maximum height of the ball over one cycle.

        On a compliant contact the table can lift the ball higher than it flies. The maximum height
        is then reached in contact, and otherwise in flight (`summit`).
        """
        x, impact_height, u = self.start(y)
        duration = y[3] / self.contact.frequency_ratio

        def in_contact(part):
            s = part * duration
            return (
                x * np.sin(s)
                + impact_height * np.cos(s)
                + self.contact.motion(s, u, x, impact_height)[0]
            )

        summit = self.summit(y)
        return np.maximum(summit, -_least(lambda part: -in_contact(part), summit.shape))

    def possible(self, y: NDArray) -> NDArray:
        """Whether the numbers of a solution of the equations have the signs of an orbit.

        The conditions are Λ >= 0, positive durations of contact and flight, and an impact from
        above, u < 0.
        """
        _, _, u = self.start(y)
        flight = self.period - y[3] / self.contact.frequency_ratio
        return (y[0] >= 0) & (y[3] > 0) & (flight > 0) & (u < 0)

    def clearance(self, y: NDArray) -> NDArray:
        """Margin by which an orbit is admissible: positive if it is, zero if it grazes.

        An orbit is admissible if the ball is not released before the end of the contact, and does
        not touch the table before the end of the flight:

        - In contact, δ + κδ′ < 0 until the release.
        - In flight, δ > 0 or δ + κδ′ > 0 until the landing. The second condition is needed after a
          force release. The ball is then below the table at first, but the contact does not press
          it if δ + κδ′ > 0.
        - At the ends, u < 0 at the impact, and δ + κδ′ increases at the release.

        The functions of the first two conditions vanish at the ends of contact and flight. They are
        therefore divided by t(1 - t), where t is the elapsed fraction of the contact or flight. The
        method returns the minimum over all three conditions.
        """
        x, impact_height, u = self.start(y)
        end = self.contact_end(y)
        lag = self.contact.lag

        def in_contact(part):
            gap, gap_velocity, _ = self.contact.motion(part * end.duration, u, x, impact_height)
            pressed = -(gap + lag * gap_velocity) * self.contact.frequency_ratio
            return pressed / (part * (1 - part))

        def in_flight(part):
            since = part * end.flight
            s = end.duration + since
            table_height = x * np.sin(s) + impact_height * np.cos(s)
            table_velocity = x * np.cos(s) - impact_height * np.sin(s)
            height = end.table_height + end.gap + end.velocity * since - since**2 / 2
            gap = height - table_height
            free = gap + lag * (end.velocity - since - table_velocity)
            return np.maximum(gap, free) / (part * (1 - part))

        shape = np.shape(end.velocity)
        flight_samples = _places(32 * int(np.max(self.n)) + 1)
        inside = np.minimum(
            _least(in_contact, shape, self._contact_samples(y[3], shape)),
            _least(in_flight, shape, flight_samples),
        )
        return np.minimum(inside, np.minimum(-u, end.gap_velocity + lag * end.gap_acceleration))

    def _contact_samples(self, angle: NDArray, shape: tuple[int, ...]) -> NDArray:
        """Parts of contacts at which they are sampled, shape (samples, ...).

        A long contact rings at first: there its samples are half a radian of θ apart.
        """
        places = _places()
        longest = np.max(angle, initial=0, where=np.isfinite(angle))
        if longest <= 3 * np.pi:
            return places
        zeta = max(float(np.nanmin(self.contact.damping_ratio)), RINGING / MOST_SAMPLES)
        count = int(min(2 * longest, 2 * RINGING / zeta, MOST_SAMPLES))
        steps = np.arange(1, count + 1).reshape(-1, *np.ones(len(shape), dtype=int))
        with np.errstate(divide="ignore", invalid="ignore"):
            ringing = steps / (2 * np.broadcast_to(angle, shape))
        ringing = np.where((ringing > 0) & (ringing < 1), ringing, steps / (count + 1))
        others = np.broadcast_to(places.reshape(-1, *steps.shape[1:]), (places.size, *shape))
        return np.sort(np.concatenate([ringing, others]), axis=0)

    def admissible(self, y: NDArray) -> NDArray:
        """Whether a ball can follow an orbit: its `clearance` is positive, by a margin."""
        return self.clearance(y) > MARGIN

    def of_duration(self, duration: NDArray) -> NDArray:
        """n-T orbits with given durations of the contact in closed form, shape (4, ...).

        At a fixed duration the equations of an orbit are affine in X, Y and u. A solution may have
        the wrong signs (`possible`), or be inadmissible.
        """
        angle = self.contact.frequency_ratio * np.asarray(duration, dtype=float)

        def orbit(x, impact_height, u):
            amplitude = np.hypot(x, impact_height)
            phase = np.arctan2(impact_height, x)
            return np.stack(np.broadcast_arrays(amplitude, phase, u + x, angle))

        constant = self.equations(orbit(0.0, 0.0, 0.0))
        units = [self.equations(orbit(*unit)) - constant for unit in np.eye(3)]
        rows = np.moveaxis(np.stack(units, axis=1), (0, 1), (-2, -1))
        solved = np.linalg.solve(rows, -np.moveaxis(constant, 0, -1)[..., np.newaxis])
        return orbit(*np.moveaxis(solved[..., 0], -1, 0))

    def contact_duration(self, y: NDArray) -> NDArray:
        """Duration τ_b of the contact (Eq. 23)."""
        return y[3] / self.contact.frequency_ratio

    def centroid(self, y: NDArray) -> NDArray:
        """Centroid ∫F s ds/∫F ds of the contact force F, as a time after the start of the contact.

        The flights before and after the contact, continued into it, meet at the centroid, and on an
        n-T orbit they have the velocities -nπ and nπ there. Outside of the contact the motion is
        therefore that of a ball with an instantaneous impact at the centroid, for any F.
        """
        return y[2] + np.pi * self.n

    def centroid_gap(self, y: NDArray) -> NDArray:
        """Height above the table at which the continued flights meet (`centroid`); negative if they
        meet below the table.
        """
        x, impact_height, _ = self.start(y)
        since = self.centroid(y)
        ball = impact_height + y[2] * since - since**2 / 2
        return ball - x * np.sin(since) - impact_height * np.cos(since)

    def observables(self, y: NDArray, names: Iterable[str]) -> dict[str, NDArray]:
        """Quantities of orbits by name, any of `OBSERVABLES`."""
        return {name: OBSERVABLES[name](self, y) for name in names}


OBSERVABLES: Mapping[str, Callable[[Family, NDArray], NDArray]] = {
    "amplitude": lambda family, y: y[0],
    "phase": lambda family, y: y[1],
    "contact_duration": Family.contact_duration,
    "release_phase": lambda family, y: y[1] + family.contact_duration(y),
    "impact_velocity": lambda family, y: y[2],
    "bounce_velocity": Family.bounce_velocity,
    "apparent_restitution": Family.apparent_restitution,
    "max_height": Family.max_height,
    "summit": Family.summit,
    "centroid": Family.centroid,
    "centroid_gap": Family.centroid_gap,
    "stable": lambda family, y: is_stable(*family.trace_and_determinant(y)),
    "admissible": Family.admissible,
}
"""Quantities of an orbit, by the names of their variables in datasets."""


def _places(samples: int = 33) -> NDArray:
    """Places on the open interval (0, 1), denser towards its ends."""
    return (1 - np.cos(np.pi * np.arange(1, samples + 1) / (samples + 1))) / 2


def _least(function, shape: tuple[int, ...], places: NDArray | None = None) -> NDArray:
    """Minimum of each function of an array on the open interval (0, 1).

    The functions may be undefined at the ends of the interval. The interval between the neighbours
    of the smallest sample is refined four times. The final samples are at most 1e-6 apart. The
    minimum of a smooth function has an error of the order of the square of this distance.

    Parameters
    ----------
    function
        Function of points in (0, 1), shape (samples, *shape). Its values have the same shape.
    shape
        Shape of the array of functions.
    places
        Samples before the first refinement in ascending order, shape (samples,) or
        (samples, *shape); by default 33.
    """
    axes = (-1, *np.ones(len(shape), dtype=int))
    places = _places() if places is None else places
    if places.ndim == 1:
        places = places.reshape(axes)
    grid = np.broadcast_to(places, (len(places), *shape))
    steps = np.linspace(0, 1, 33).reshape(axes)
    for _ in range(4):
        best = np.clip(np.argmin(function(grid), axis=0), 1, len(grid) - 2)[np.newaxis]
        low = np.take_along_axis(grid, best - 1, axis=0)
        high = np.take_along_axis(grid, best + 1, axis=0)
        grid = low + steps * (high - low)
    return function(grid).min(axis=0)

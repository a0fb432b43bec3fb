"""The n-T orbits of the spring-damper model and their stability (Eqs. 17-27).

An orbit is a vector y = (Λ, φ, z′_i, θ): the amplitude of the table, its phase at the start of the
contact, the velocity of the ball there, and the duration of the contact in units of that of the
contact itself, θ = ϖ τ_b. With the constants A and B of Eqs. 12 and 13 and z′_b eliminated,
Eqs. 21-26 are three equations for these four numbers, so that the orbits of a family form curves.
The first axis of y has the four numbers; further axes are further orbits.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bouncing_ball.restitution import is_stable
from bouncing_ball.spring_damper import Contact


@dataclass(frozen=True)
class ContactEnd:
    """The end of a contact: its duration and that of the flight, height and velocity of the table,
    the relative motion δ, δ′ and δ″ before it, and the velocity z′_b of the ball (Eq. 24).

    `gap_by` and `gap_velocity_by` are the derivatives of δ and δ′ by (X, Y, u) at this time after
    the start.
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
        return self.gap_velocity + self.table_velocity


@dataclass(frozen=True)
class Family:
    """The n-T orbits on a contact, or on an array of contacts, for one n or an array of them.

    Methods take orbits y, shape (4, ...), where the further axes are those of the contact's
    frequency ratio or broadcast against them.
    """

    n: int | NDArray
    contact: Contact

    @property
    def period(self) -> float | NDArray:
        return 2 * np.pi * self.n

    def start(self, y: NDArray) -> tuple[NDArray, NDArray, NDArray]:
        """X = Λ cos φ, Y = Λ sin φ and the relative velocity u = δ′_i = z′_i - X of the impact."""
        amplitude, phase, velocity, _ = y
        x = amplitude * np.cos(phase)
        return x, amplitude * np.sin(phase), velocity - x

    def contact_end(self, y: NDArray) -> ContactEnd:
        """The end of the contact."""
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
        """The defects of the three equations of an orbit, shape (3, ...).

        They are the release, ϖ(δ + κδ′) = 0 (Eq. 23), the landing at δ = 0 after the flight L
        (Eqs. 19 and 25), and the velocity there, z′_b - L = z′_i (Eqs. 20, 26 and 27). The landing
        is divided by L, and δ at the release is replaced by -κδ′, so that the equations are regular
        also where the flight vanishes and the orbit becomes permanent contact. The end of the
        contact is computed unless it is given.
        """
        x, impact_height, _ = self.start(y)
        end = end or self.contact_end(y)
        lag = self.contact.lag
        flight = end.flight
        # (w_b - w_i)/L, where the phases of the table differ by -L up to whole turns.
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
        """Derivatives of the defects by the four numbers of an orbit, shape (3, 4, ...).

        The end of the contact is computed unless it is given.
        """
        x, impact_height, _ = self.start(y)
        end = end or self.contact_end(y)
        lag = self.contact.lag
        ratio = self.contact.frequency_ratio
        flight = end.flight
        by_rate = np.stack(end.gap_velocity_by)
        zero = np.zeros_like(x)
        # Columns by X, Y, u and the duration, of which the flight takes the rest.
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
        # Derivatives by L of sin(L)/L and (1 - cos L)/L, whose series serve where they cancel.
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
        # The chain rule to Λ, φ, z′_i and θ = ϖ τ_b, with X = Λ cos φ, Y = Λ sin φ, u = z′_i - X.
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

    def return_map(self, y: NDArray) -> NDArray:
        """The linearised map from a start of contact to the next, shape (2, 2, ...).

        Rows are phase and velocity at the next start, columns at this one. A change of the start
        changes the duration of the contact by the condition of release, and that of the flight by
        the condition of landing.
        """
        x, impact_height, u = self.start(y)
        end = self.contact_end(y)
        lag = self.contact.lag
        columns = []
        # The change of (X, Y, u) with the phase and with the velocity at the start.
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
            flight = -(height + end.flight * velocity - x * later) / u
            columns.append([later + flight, velocity - flight])
        return np.moveaxis(np.array(columns), 0, 1)

    def trace_and_determinant(self, y: NDArray) -> tuple[NDArray, NDArray]:
        """Trace and determinant of the return map; the latter is exp(-2ζϖτ_b) for both releases."""
        matrix = self.return_map(y)
        return matrix[0, 0] + matrix[1, 1], np.exp(-2 * self.contact.damping_ratio * y[3])

    def saddle_node_test(self, y: NDArray) -> NDArray:
        """1 - trace + determinant, zero where a Floquet multiplier is 1."""
        trace, determinant = self.trace_and_determinant(y)
        return 1 - trace + determinant

    def period_doubling_test(self, y: NDArray) -> NDArray:
        """1 + trace + determinant, zero where a Floquet multiplier is -1."""
        trace, determinant = self.trace_and_determinant(y)
        return 1 + trace + determinant

    def multipliers(self, y: NDArray) -> NDArray:
        """Floquet multipliers, complex, shape (2, ...), that of the larger modulus first."""
        trace, determinant = self.trace_and_determinant(y)
        root = np.sqrt(trace**2 / 4 - determinant + 0j)
        larger = np.where(trace < 0, trace / 2 - root, trace / 2 + root)
        return np.stack([larger, determinant / larger])

    def motion(self, y: NDArray, s: NDArray) -> tuple[NDArray, NDArray, NDArray]:
        """Height and velocity of the ball at times s since the start of contact, from 0 to the
        period, and whether it is in contact (Eqs. 12-15).
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
        """Velocity z′_b of the ball at the end of the contact (Eq. 24)."""
        return self.contact_end(y).velocity

    def apparent_restitution(self, y: NDArray) -> NDArray:
        """The apparent restitution coefficient r_a = -δ′_b/δ′_i (Eq. 17)."""
        _, _, u = self.start(y)
        return -self.contact_end(y).gap_velocity / u

    def summit(self, y: NDArray) -> NDArray:
        """Greatest height of the flight, which is at one of its ends if the ball falls, or rises,
        throughout.
        """
        end = self.contact_end(y)
        rise = np.clip(end.velocity, 0, end.flight)
        return end.table_height + end.gap + end.velocity * rise - rise**2 / 2

    def max_height(self, y: NDArray) -> NDArray:
        """Greatest height of the ball over a cycle.

        It is the summit of the flight or, if the table lifts the ball higher in contact than it
        flies, as compliant contacts can, a height in contact.
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
        """Whether a solution of the equations has the signs of an orbit: Λ >= 0, a contact and a
        flight that take time, and an impact from above.
        """
        _, _, u = self.start(y)
        flight = self.period - y[3] / self.contact.frequency_ratio
        return (y[0] >= 0) & (y[3] > 0) & (flight > 0) & (u < 0)

    def clearance(self, y: NDArray) -> NDArray:
        """Positive if nothing else happens during an orbit, and zero where it grazes.

        In contact δ + κδ′ must be negative until the release. In flight the ball must be above the
        table or, after a force release, must not be pressed by the contact before it is. Both
        functions are divided by t(1 - t), with t the part of the contact or flight that has passed,
        because they vanish at its ends; there, the relative velocity of the impact must be
        negative and δ + κδ′ must rise. The smallest of these numbers is returned.
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
        samples = 32 * int(np.max(self.n)) + 1
        inside = np.minimum(_least(in_contact, shape), _least(in_flight, shape, samples))
        return np.minimum(inside, np.minimum(-u, end.gap_velocity + lag * end.gap_acceleration))

    def observables(self, y: NDArray) -> dict[str, NDArray]:
        """The quantities of orbits by the names that they have in datasets."""
        duration = y[3] / self.contact.frequency_ratio
        return {
            "amplitude": y[0],
            "phase": y[1],
            "contact_duration": duration,
            "release_phase": y[1] + duration,
            "impact_velocity": y[2],
            "bounce_velocity": self.bounce_velocity(y),
            "apparent_restitution": self.apparent_restitution(y),
            "max_height": self.max_height(y),
            "stable": is_stable(*self.trace_and_determinant(y)),
            "admissible": self.clearance(y) > 0,
        }


def _least(function, shape: tuple[int, ...], samples: int = 33) -> NDArray:
    """The smallest value of functions between 0 and 1, for an array of functions.

    The functions are sampled at places that are denser towards the ends, where they need not be
    defined, and sampled again four times between the neighbours of their smallest samples. The last
    samples are 1e-6 of the interval apart at most, so that the smallest of them is the minimum of a
    smooth function up to the square of this.
    """
    axes = (-1, *np.ones(len(shape), dtype=int))
    places = (1 - np.cos(np.pi * np.arange(1, samples + 1) / (samples + 1))) / 2
    grid = np.broadcast_to(places.reshape(axes), (samples, *shape))
    steps = np.linspace(0, 1, 33).reshape(axes)
    for _ in range(4):
        best = np.clip(np.argmin(function(grid), axis=0), 1, len(grid) - 2)[np.newaxis]
        low = np.take_along_axis(grid, best - 1, axis=0)
        high = np.take_along_axis(grid, best + 1, axis=0)
        grid = low + steps * (high - low)
    return function(grid).min(axis=0)

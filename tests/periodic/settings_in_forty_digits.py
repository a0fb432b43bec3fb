"""The return map of a rigid ball on any table, with drag or on a spring, in 40 digits.

A flight is written in the coordinates in which its equation is usually solved: with drag in those
of the room, and on a spring as the sum of free and forced oscillations of δ. Nothing is shared with
the package; a landing is only sought near a given time.
"""

from mpmath import mp, mpf

from bouncing_ball.models.suspension import Drag

mp.dps = 40
_STEP = mpf(10) ** -14


def derivative(turned, state):
    """The derivative of a map of the phase and the velocity, by central differences."""
    columns = []
    for j in range(2):
        ends = []
        for sign in (1, -1):
            moved = list(state)
            moved[j] += sign * _STEP
            ends.append(turned(moved))
        columns.append([(ends[0][i] - ends[1][i]) / (2 * _STEP) for i in range(2)])
    return mp.matrix(columns).T


class Exact:
    """The map of a ball with the restitution r; ``sine`` are the harmonics of the table."""

    def __init__(self, restitution, sine, flight):
        self.r = mpf(restitution)
        self.sine = [mpf(a) for a in sine]
        self.flight = flight

    def table(self, lam, time, order=0):
        """The table's height or a derivative of it."""
        angle = order * mp.pi / 2
        return lam * sum(
            k**order * a * mp.sin(k * time + angle) for k, a in enumerate(self.sine, 1)
        )

    def gap(self, lam, phase, speed, time):
        """δ a time after the release at this phase with δ′ = ``speed``."""
        if isinstance(self.flight, Drag):
            c = mpf(self.flight.drag)
            rising = speed + self.table(lam, phase, 1) + 1 / c
            height = self.table(lam, phase) + rising * (1 - mp.exp(-c * time)) / c - time / c
            return height - self.table(lam, phase + time)
        nu = mpf(self.flight.spring_frequency)
        a = mpf(self.flight.spring_damping) * nu
        sigma = mpf(self.flight.gap)
        root = mp.mpc(-a, mp.sqrt(nu**2 - a**2))

        def forced(t, order):
            found = mpf(0)
            for k, amplitude in enumerate(self.sine, 1):
                turn = mp.exp(mp.mpc(0, k * t)) * mp.mpc(0, k) ** order
                found += mp.im(lam * amplitude * k**2 * turn / mp.mpc(nu**2 - k**2, 2 * a * k))
            return found

        start = -sigma - forced(phase, 0)
        rate = speed - forced(phase, 1)
        swing = mp.mpc(start, -(rate + a * start) / root.imag)
        return sigma + mp.re(swing * mp.exp(root * time)) + forced(phase + time, 0)

    def after(self, lam, phase, velocity, time):
        """The time to the landing near a given time, and δ′ there, after an impact (φ, δ′)."""
        speed = -self.r * velocity
        landing = mp.findroot(lambda t: self.gap(lam, phase, speed, t), time)
        rate = mp.diff(lambda t: self.gap(lam, phase, speed, t), landing)
        return landing, rate

    def turned(self, lam, state, times):
        """The state after all legs, near these times, less the whole time."""
        phase, velocity = state
        passed = mpf(0)
        for time in times:
            flown, velocity = self.after(lam, phase, velocity, time)
            phase += flown
            passed += flown
        return phase, velocity, passed

    def matrix(self, lam, state, times):
        """The derivative of the map."""
        return derivative(lambda moved: self.turned(lam, moved, times), state)

    def orbit(self, lam, state, times, periods):
        """The state of the orbit with this period, near a state."""

        def defect(phase, velocity):
            end, rate, _ = self.turned(lam, (phase, velocity), times)
            return end - phase - 2 * mp.pi * periods, rate - velocity

        return list(mp.findroot(defect, state))

    def bifurcation(self, lam, state, times, periods, multiplier):
        """Λ at which an orbit near a state has this multiplier, 1 or -1."""

        def defect(phase, velocity, amplitude):
            end, rate, _ = self.turned(amplitude, (phase, velocity), times)
            m = self.matrix(amplitude, (phase, velocity), times)
            off = mp.det(m - multiplier * mp.eye(2))
            return end - phase - 2 * mp.pi * periods, rate - velocity, off

        # The differences in the matrix leave some 25 digits, and a start has twelve: two steps.
        return mp.findroot(defect, [*state, lam], tol=1e-20, maxsteps=20, verify=False)[2]

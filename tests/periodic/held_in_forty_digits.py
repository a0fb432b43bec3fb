"""The return map of a ball on a spring and a damper over any table, in 40 digits.

The motion in contact and that in flight are each the sum of a free and a forced oscillation, whose
constants follow from two linear equations. Nothing is shared with the package; a release and a
landing are only sought near given times.
"""

from mpmath import mp, mpf
from settings_in_forty_digits import derivative

mp.dps = 40


class Exact:
    """The map for ϖ, ζ and κ; ``sine`` are the harmonics of the table.

    ``flight`` are l, q and b of the flight δ″ + l (δ′ + e w′) + q δ = b - w″, with e = 1 if the air
    rests, and 0 if the damper stands on the table.
    """

    def __init__(self, frequency, damping, lag, sine, flight=(0, 0, -1, 0)):
        self.omega = mpf(frequency)
        self.zeta = mpf(damping)
        self.lag = mpf(lag)
        self.sine = [mpf(a) for a in sine]
        self.loss, self.stiffness, self.load, self.air = (mpf(x) for x in flight)

    def _steady(self, lam, time, order, loss, stiffness):
        """A derivative of the forced part of δ."""
        found = mpf(0)
        if order == 0 and stiffness:
            found += self.load / stiffness
        for k, a in enumerate(self.sine, 1):
            force = lam * a * mp.mpc(k**2, -self.air * self.loss * k)
            answer = force / mp.mpc(stiffness - k**2, loss * k)
            found += mp.im(answer * mp.mpc(0, k) ** order * mp.exp(mp.mpc(0, k * time)))
        return found

    def moved(self, lam, start, gap, rate, time, held):
        """δ and δ′ a time after a state at this phase, in contact or in flight."""
        loss = self.loss + (2 * self.zeta * self.omega if held else 0)
        stiffness = self.stiffness + (self.omega**2 if held else 0)
        if loss == 0 and stiffness == 0:

            def table(t, order):
                return sum(
                    lam * a * k**order * mp.sin(k * t + order * mp.pi / 2)
                    for k, a in enumerate(self.sine, 1)
                )

            speed = rate + table(start, 1)
            height = gap + table(start, 0) + speed * time - time**2 / 2
            return height - table(start + time, 0), speed - time - table(start + time, 1)
        free = gap - self._steady(lam, start, 0, loss, stiffness)
        free_rate = rate - self._steady(lam, start, 1, loss, stiffness)
        if stiffness == 0:
            # A drag: the free part is c₀ + c₁ e^{-ls} and gravity.
            fall = self.load / loss
            c1 = -(free_rate - fall) / loss
            gone = mp.exp(-loss * time)
            height = free - c1 + c1 * gone + fall * time
            speed = -loss * c1 * gone + fall
        else:
            root = mp.mpc(-loss / 2, mp.sqrt(stiffness - loss**2 / 4))
            swing = mp.mpc(free, -(free_rate + loss / 2 * free) / root.imag)
            whole = swing * mp.exp(root * time)
            height = mp.re(whole)
            speed = mp.re(root * whole)
        end = start + time
        return (
            height + self._steady(lam, end, 0, loss, stiffness),
            speed + self._steady(lam, end, 1, loss, stiffness),
        )

    def after(self, lam, phase, velocity, duration, time):
        """The time to the landing near a given time, and δ′ there, after an impact (φ, δ′)."""

        def grip(t):
            gap, rate = self.moved(lam, phase, mpf(0), velocity, t, held=True)
            return gap + self.lag * rate

        release = mp.findroot(grip, duration)
        gap, rate = self.moved(lam, phase, mpf(0), velocity, release, held=True)
        left = phase + release
        flown = mp.findroot(
            lambda t: self.moved(lam, left, gap, rate, t, held=False)[0], time - release
        )
        return release + flown, self.moved(lam, left, gap, rate, flown, held=False)[1]

    def turned(self, lam, state, legs):
        """The state after all legs, near these durations and times, and the whole time."""
        phase, velocity = state
        passed = mpf(0)
        for duration, time in legs:
            flown, velocity = self.after(lam, phase, velocity, duration, time)
            phase += flown
            passed += flown
        return phase, velocity

    def matrix(self, lam, state, legs):
        """The derivative of the map."""
        return derivative(lambda moved: self.turned(lam, moved, legs), state)

    def orbit(self, lam, state, legs, periods):
        """The state of the orbit with this period, near a state."""

        def defect(phase, velocity):
            end, rate = self.turned(lam, (phase, velocity), legs)
            return end - phase - 2 * mp.pi * periods, rate - velocity

        return list(mp.findroot(defect, state))

    def bifurcation(self, lam, state, legs, periods, multiplier):
        """Λ at which an orbit near a state has this multiplier, 1 or -1."""

        def defect(phase, velocity, amplitude):
            end, rate = self.turned(amplitude, (phase, velocity), legs)
            m = self.matrix(amplitude, (phase, velocity), legs)
            off = mp.det(m - multiplier * mp.eye(2))
            return end - phase - 2 * mp.pi * periods, rate - velocity, off

        # The differences in the matrix leave some 25 digits, and a start has twelve: two steps.
        return mp.findroot(defect, [*state, lam], tol=1e-20, maxsteps=20, verify=False)[2]

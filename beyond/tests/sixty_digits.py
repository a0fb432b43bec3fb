"""The orbits and the return map in 60 digits, which share nothing with the packages but the model.

The contact's response is written with complex exponentials, the orbit solves the three
conditions of ``docs/closed-form.md`` by elimination, and the monodromy is a difference quotient
of the return map, whose events are found by the secant method. With a step of 1e-20 in 60
digits, 35 digits are left.
"""

from typing import Protocol

from mpmath import mp, mpf

STEP = mpf(10) ** -20


class Contact(Protocol):
    """What a contact of either house has."""

    frequency_ratio: float
    damping_ratio: float
    release: str


class Exact:
    """One contact and family in 60 digits.

    The contact's ϖ and ζ are doubles unless numbers of more digits are given for them.
    """

    def __init__(self, contact: Contact, n: int, omega=None, zeta=None):
        self.omega = mpf(float(contact.frequency_ratio)) if omega is None else omega
        self.zeta = mpf(float(contact.damping_ratio)) if zeta is None else zeta
        self.a = self.zeta * self.omega
        self.q = self.omega**2
        self.n = int(n)
        self.damped = self.omega * mp.sqrt(1 - self.zeta**2)
        force = contact.release == "force"
        self.lag = 2 * self.zeta / self.omega if force else mpf(0)
        self.free_angle = mp.pi - 2 * mp.asin(self.zeta if force else 0)

    def responses(self, s):
        """(g, g′), (G, G′), and the responses to sin and cos with their rates."""
        decay = mp.exp(-self.a * s)
        sine = mp.sin(self.damped * s) / self.damped
        g = decay * sine
        g_rate = decay * (mp.cos(self.damped * s) - self.a * sine)
        weight = (1 - g_rate - 2 * self.a * g) / self.q
        h = (mp.expj(s) - g_rate - (1j + 2 * self.a) * g) / (self.q - 1 + 2j * self.a)
        h_rate = 1j * h + g
        return (g, g_rate), (weight, g), (h.imag, h_rate.imag), (h.real, h_rate.real)

    def state(self, s, u, x, y):
        """δ and δ′ a time s after an impact with δ′ = u."""
        push, weight, sine, cosine = self.responses(s)
        return tuple(u * push[k] - weight[k] + x * sine[k] + y * cosine[k] for k in (0, 1))

    def orbit(self, excess):
        """D and (u, X, Y) from the release, the velocity and the landing."""
        duration = (self.free_angle + mpf(excess)) / self.damped
        flight = 2 * mp.pi * self.n - duration
        push, weight, sine, cosine = self.responses(duration)
        c = mp.cos(duration)
        s = mp.sin(duration)
        columns = (push, sine, cosine)
        matrix = mp.matrix(
            [
                [k[0] + self.lag * k[1] for k in columns],
                [push[1] - 1, sine[1] + c - 1, cosine[1] - s],
                [push[0] + flight, sine[0] + s + flight, cosine[0] + c - 1],
            ]
        )
        right = [weight[0] + self.lag * weight[1], weight[1] + flight, weight[0] - flight**2 / 2]
        return duration, *mp.lu_solve(matrix, mp.matrix(right))

    def cycle(self, duration, phase, u, amplitude):
        """The return map, for events near those of the orbit."""
        x = amplitude * mp.cos(phase)
        y = amplitude * mp.sin(phase)

        def released(s):
            gap, rate = self.state(s, u, x, y)
            return gap + self.lag * rate

        width = STEP / self.omega
        stay = mp.findroot(released, (duration - width, duration + width), tol=1e-100, verify=False)
        gap, rate = self.state(stay, u, x, y)
        off = phase + stay

        def above(s):
            moved = amplitude * (mp.sin(off + s) - mp.sin(off) - s * mp.cos(off))
            return gap + rate * s - s * s / 2 - moved

        hang = 2 * mp.pi * self.n - duration
        hang = mp.findroot(above, (hang - STEP, hang + STEP), tol=1e-100, verify=False)
        landing = off + hang
        speed = rate - hang - amplitude * (mp.cos(landing) - mp.cos(off))
        return landing, speed

    def trace(self, excess):
        """Trace of the monodromy, by central differences."""
        duration, u, x, y = self.orbit(excess)
        amplitude = mp.hypot(x, y)
        phase = mp.atan2(y, x)
        total = mpf(0)
        for k, (by_phase, by_speed) in enumerate(((STEP, 0), (0, STEP))):
            ends = [
                self.cycle(duration, phase + s * by_phase, u + s * by_speed, amplitude)[k]
                for s in (1, -1)
            ]
            total += (ends[0] - ends[1]) / (2 * STEP)
        return total

    def determinant(self, excess):
        return mp.exp(-2 * self.a * (self.free_angle + mpf(excess)) / self.damped)

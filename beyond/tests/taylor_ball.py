"""A reference simulation: Taylor integration with detection of events (heyoka)."""

import numpy as np
import pytest


class TaylorBall:
    """One ball on the spring-damper, integrated to the rounding error.

    Nothing of the package is used. The contact is integrated in z, and its law
    is F = max(0, -(2ζϖ δ′ + ϖ² δ)) for the force release.
    """

    def __init__(self, force_release):
        heyoka = pytest.importorskip("heyoka")
        z, v = heyoka.make_vars("z", "v")
        lam, omega, zeta, phase = (heyoka.par[k] for k in range(4))
        angle = heyoka.time + phase
        gap = z - lam * heyoka.sin(angle)
        closing = v - lam * heyoka.cos(angle)
        pull = 2 * zeta * omega * closing + omega * omega * gap
        up = heyoka.event_direction.positive
        down = heyoka.event_direction.negative

        def integrator(acceleration, *events):
            return heyoka.taylor_adaptive(
                [(z, v), (v, acceleration)],
                [0.0, 0.0],
                pars=[0.0] * 4,
                t_events=[heyoka.t_event(e, direction=d) for e, d in events],
            )

        self.force_release = force_release
        self.contact = integrator(-1.0 - pull, (pull if force_release else gap, up))
        # heyoka needs an expression for the constant acceleration.
        self.flight = integrator(0.0 * z - 1.0, (gap, down), (pull, down))

    def _until(self, integrator, time, state, wanted):
        integrator.time = time
        integrator.state[:] = state
        integrator.reset_cooldowns()
        while True:
            outcome = integrator.propagate_until(time + 1e3)[0]
            # Terminal events report -index - 1.
            index = -int(outcome.value if hasattr(outcome, "value") else outcome) - 1
            if wanted(index, integrator.time, integrator.state):
                return integrator.time, integrator.state.copy()

    def impacts(self, lam, omega, zeta, phase, velocity, count):
        """Rows (time, z′_i, duration of contact, z′_b)."""
        for integrator in (self.contact, self.flight):
            integrator.pars[:] = [lam, omega, zeta, phase]
        time = 0.0
        state = np.array([lam * np.sin(phase), velocity])
        rows = []

        def landed(index, t, y):
            below = y[0] < lam * np.sin(t + phase)
            return index == 0 or (index == 1 and below and self.force_release)

        for _ in range(count):
            end, left = self._until(self.contact, time, state, lambda *_: True)
            rows.append((time, state[1], end - time, left[1]))
            time, state = self._until(self.flight, end, left, landed)
        return np.array(rows).T


@pytest.fixture(scope="session")
def taylor_ball():
    """:class:`TaylorBall`, compiled once for each release rule."""
    built = {}

    def build(force_release):
        if force_release not in built:
            built[force_release] = TaylorBall(force_release)
        return built[force_release]

    return build

"""The worst orbits of tiles, computed again by simulation and in 50 digits.

Both know only what the atlas says of them: r, Λ, ϖ, n and the rule. In 50 digits the
branch is that of ``tests/orbits/test_sixty_digits.py``, which shares nothing with the
package; the simple models are written here again.
"""

import runpy
from pathlib import Path

import numpy as np
import pytest
from mpmath import mp, mpf

from bouncing_ball.accuracy.errors import SIMPLE
from bouncing_ball.accuracy.quantities import OF_ORBITS
from bouncing_ball.atlas.answers import row_answers
from bouncing_ball.atlas.plan import AtlasParameters
from bouncing_ball.configuration.yaml_file import read_yaml
from bouncing_ball.contacts.spring_damper import SpringDamper
from bouncing_ball.orbits.spring_damper_model import SpringDamperModel

ORBITS = Path(__file__).resolve().parents[1] / "orbits"
Exact = runpy.run_path(str(ORBITS / "test_sixty_digits.py"))["Exact"]
NAMES = [str(quantity) for quantity in OF_ORBITS]


def exact_in_digits(contact, n, lam, start):
    """The quantities of the orbit at Λ, by the secant method along the branch."""
    exact = Exact(contact, n)

    def surplus(excess):
        _, _, x, y = exact.orbit(excess)
        return x * x + y * y - lam * lam

    width = mpf(10) ** -12 / exact.omega
    excess = mp.findroot(surplus, (start, start + width), solver="secant", tol=mpf(10) ** -70)
    duration, u, x, y = exact.orbit(excess)
    gap, rate = exact.state(duration, u, x, y)
    phase, flight = mp.atan2(y, x), 2 * mp.pi * n - duration
    bounce = u + x + flight
    top = gap + lam * mp.sin(phase + duration) + bounce**2 / 2
    return [top, bounce, phase, -rate / u]


def simple_in_digits(exact, n, lam, corrected):
    """The same of the restitution model, or of the corrected one."""
    zeta, lag = exact.zeta, exact.lag
    duration = exact.free_angle / exact.damped
    r = mp.exp(-zeta * exact.omega * duration)
    delay = r * (duration + lag) / (1 + r)
    load = (1 - r) * (duration + lag) - 2 * zeta * (1 + r) / exact.omega
    if not corrected:
        delay = load = duration = mpf(0)
    half = n * mp.pi
    side = half * (1 - r) - load
    radius = mp.sqrt((1 + r) ** 2 + load**2)
    psi = mp.acos(side / (radius * lam)) - mp.atan2(load, 1 + r)
    x, y = lam * mp.cos(psi), lam * mp.sin(psi)
    arrival, leaving = -(half - delay), half - (duration - delay)
    phase = psi - delay
    ratio = (leaving - lam * mp.cos(phase + duration)) / (lam * mp.cos(phase) - arrival)
    return [y - (half + x) * delay + half**2 / 2, leaving, phase, ratio]


def simulated(contact, n, lam):
    """The quantities of the orbit at Λ read from one simulated cycle, and ε."""
    orbit = SpringDamperModel(contact).require_orbit(n, lam)
    ball = SpringDamperModel(contact).simulate(lam, orbit.phase, orbit.impact_velocity, 2)
    assert abs(ball.time[1] - 2 * np.pi * n) < 1e-9
    duration, leaving = ball.contact_duration[0], ball.relative_release_velocity[0]
    end = ball.phase[0] + duration
    bounce = leaving + lam * np.cos(end)
    top = ball.release_displacement[0] + lam * np.sin(end) + bounce**2 / 2
    values = [top, bounce, ball.phase[1], -leaving / ball.relative_velocity[0]]
    return values, float(contact.damped_frequency * duration - contact.free_angle)


def check(plan, row, part, tile, ratio):
    """The errors of the worst orbits of one tile at one ϖ."""
    rule, family, _ = np.unravel_index(row, plan.shape)
    k, n = plan.examined.index(ratio), plan.n[family]
    for i, j in np.ndindex(len(SIMPLE), len(NAMES)):
        stored = float(part["largest_error"][tile, i, j, k])
        r, lam = (float(part[f"worst_{x}"][tile, i, j, k]) for x in ("restitution", "amplitude"))
        contact = SpringDamper.from_restitution(r, ratio, plan.release[rule], measured=True)
        values, start = simulated(contact, n, lam)
        exact = Exact(contact, n)
        near = float(part["farthest"][tile])
        found = []
        for place in (mpf(lam), lam * (1 + mpf(near)), lam * (1 - mpf(near))):
            digits = exact_in_digits(contact, n, place, mpf(start))
            found.append(abs(digits[j] / simple_in_digits(exact, n, place, i == 1)[j] - 1))
        by_motion = abs(values[j] / float(simple_in_digits(exact, n, mpf(lam), i == 1)[j]) - 1)
        # The walk is at Λ but for the distance that it says; next to the saddle-node
        # rounding (1e-13, see test_sixty_digits) turns the phase by a thousand times that.
        allowed = 2 * float(max(found) - min(found)) + 1e-10
        assert abs(stored - float(found[0])) < allowed, (row, tile, SIMPLE[i], NAMES[j])
        assert abs(by_motion - float(found[0])) < 1e-9


def test_the_worst_orbits_of_some_tiles(small):
    plan, random = small(), np.random.default_rng(8)
    with mp.workdps(50):
        for row in random.choice(plan.rows, 3, replace=False):
            part = row_answers(plan, row)
            check(plan, row, part, int(random.integers(3)), float(random.choice(plan.examined)))


@pytest.mark.long
def test_the_worst_orbits_of_a_thousand_tiles(pytestconfig):
    config = read_yaml(pytestconfig.rootpath / "config" / "config.yaml")
    plan, random = AtlasParameters(**config["atlas"]), np.random.default_rng(9)
    with mp.workdps(50):
        for row in random.choice(plan.rows, 50, replace=False):
            part = row_answers(plan, row)
            for tile in range(20):
                check(plan, row, part, tile, float(random.choice(plan.examined)))

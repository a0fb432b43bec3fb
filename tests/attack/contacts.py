"""Random contacts: limits that are no bifurcations, orbits to which the simulation does not return.

Contacts of the whole range, from softer than the table's own period to nearly
rigid, in families up to 200. At each bifurcation that is reported the
linearised cycle, which is another derivation than the test functions along the
branch, must have a multiplier of 1 or -1: at a pole or a grazing point it has
none near. Each orbit that is called admissible must return to itself.
"""

from collections.abc import Iterator

import numpy as np

from bouncing_ball.contacts.damping import damping_ratio
from bouncing_ball.contacts.spring_damper import Release, SpringDamper
from bouncing_ball.orbits.model import Side
from bouncing_ball.orbits.spring_damper_model import SpringDamperModel

BLOCK = 100
# A multiplier at a pole is far from ±1, one at a root off by the rounding of
# the root, amplified by the branch's curvature: 1e-9 in 10⁶ contacts.
AT_ROOT = 1e-4
# Rounding of one cycle over the amplification of the orbit; the simulation's
# own tests have 1e-13 for ϖ ≥ 1 and n ≤ 5.
RETURNS = 1e-11


def draw(rng: np.random.Generator) -> tuple[SpringDamper, np.ndarray, str]:
    """Contacts, families, and how each of them is named on the command line."""
    r = rng.uniform(0.05, 0.999, BLOCK)
    omega = 10 ** rng.uniform(-1.0, 4.0, BLOCK)
    n = np.floor(10 ** rng.uniform(0.0, np.log10(200.0), BLOCK))
    release = Release(str(rng.choice([str(one) for one in Release])))
    contact = SpringDamper(omega, damping_ratio(r), release)
    names = [
        f"--restitution {a!r} --frequency-ratio {b!r} --n {int(c)} --release {release}"
        for a, b, c in zip(r.tolist(), omega.tolist(), n, strict=True)
    ]
    return contact, n, np.array(names)


def wrong_limits(contact: SpringDamper, n: np.ndarray) -> tuple[int, np.ndarray, np.ndarray]:
    """How many bifurcations are reported, and which contacts have one that is none."""
    model = SpringDamperModel(contact)
    reported, wrong = 0, np.zeros(n.shape, dtype=bool)
    for orbit, at in ((model.saddle_node(n), 1.0), (model.period_doubling(n), -1.0)):
        there = orbit.exists
        with np.errstate(all="ignore"):
            trace, _ = orbit.trace_and_determinant()
            determinant = orbit.determinant()
            off = np.abs(1 - at * trace + determinant) / (1 + np.abs(determinant))
        reported += int(np.sum(there))
        # Not-a-number is no root either.
        wrong |= there & ~(off < AT_ROOT)
    return reported, wrong


def astray(
    contact: SpringDamper, n: np.ndarray, lam: np.ndarray, side: Side
) -> tuple[int, np.ndarray]:
    """How many orbits are admissible, and which of them the simulation does not return to."""
    orbit = SpringDamperModel(contact).orbit(n, lam, side)
    admissible = orbit.is_admissible()
    wrong = np.zeros(n.shape, dtype=bool)
    if np.any(admissible):
        orbit = orbit[admissible]
        u = orbit.relative_impact_velocity
        cycle = orbit.cycle(orbit.phase, u)
        turn = np.angle(np.exp(1j * (cycle.phase - orbit.phase)))
        off = np.max(np.abs([turn, cycle.relative_velocity - u]), axis=0)
        amplification = 1 + np.linalg.norm(orbit.monodromy(), axis=(-2, -1))
        size = 1 + np.abs(u) + 2 * np.pi * np.asarray(orbit.n)
        wrong[admissible] = ~(off < RETURNS * amplification * size)
    return int(np.sum(admissible)), wrong


def attack(seed: int) -> Iterator[list[str]]:
    """Reported bifurcations and admissible orbits of random contacts."""
    rng = np.random.default_rng(seed)
    while True:
        contact, n, names = draw(rng)
        count, wrong = wrong_limits(contact, n)
        fallen = [f"limits {name}" for name in names[wrong]]
        yield [*fallen, *[""] * (count - len(fallen))]
        lam = 10 ** rng.uniform(-1.0, 2.0, BLOCK)
        for side in Side:
            count, wrong = astray(contact, n, lam, side)
            fallen = [
                f"orbit {name} --amplitude {x!r} --side {side}"
                for name, x in zip(names[wrong], lam[wrong].tolist(), strict=True)
            ]
            yield [*fallen, *[""] * (count - len(fallen))]

"""What contacts of any law cost: simulation against the linear contact, orbits, branches.

In one process, medians of repeated pairs, in processor time. Not part of the test suite,
as a noisy machine would fail it:

    OMP_NUM_THREADS=1 python tests/speed/contact_laws.py [repetitions]
"""

import sys
import time
from functools import partial
from statistics import median

import numpy as np

from bouncing_ball.beyond.laws.impedance import Impedance
from bouncing_ball.beyond.laws.law_of_impact import law_of_impact
from bouncing_ball.beyond.laws.linear import LinearLaw
from bouncing_ball.beyond.laws.orbits import LawModel
from bouncing_ball.beyond.laws.registry import LAWS
from bouncing_ball.paper.contact.damping import Release, damping_ratio
from bouncing_ball.paper.orbits.restitution_branch import rigid_speed

HERTZ = ("hunt-crossley", "tsuji", "kuwabara-kono")
# r, Λ and D; at Λ = 1 many balls are next to permanent contact.
CASES = [(0.65, 1.0, 0.1), (0.85, 1.0, 0.1), (0.85, 1.5, 0.1), (0.85, 1.0, 0.03), (0.85, 2.0, 0.03)]
BALLS, IMPACTS = 10_000, 60
ORBITS = 2000


def spent(run) -> tuple[float, object]:
    """Processor time of a call, and its result."""
    start = time.process_time()
    result = run()
    return time.process_time() - start, result


def simulated(law, amplitude, phase, velocity):
    return law.dynamics(amplitude).simulate(phase, velocity, IMPACTS)


def per_impact(run) -> float:
    """Processor time per impact of a simulation, in microseconds."""
    seconds, sequence = spent(run)
    return seconds / int(np.isfinite(sequence.time).sum()) * 1e6


def simulations(repetitions: int) -> None:
    print(
        f"simulation, {BALLS} balls, {IMPACTS} impacts: over the linear contact's time per impact"
    )
    rng = np.random.default_rng(0)
    phase = rng.uniform(-3, 3, BALLS)
    fall = rng.uniform(1.5, 5, BALLS)
    for r, lam, duration in CASES:
        zeta = damping_ratio(r)
        linear = LinearLaw(np.pi / duration / np.sqrt(1 - zeta**2), zeta)
        start = lam, phase, -fall - lam
        said = []
        speed = float(rigid_speed(1, r))
        for name in (*HERTZ, "by depth"):
            if name in LAWS:
                law = law_of_impact(LAWS[name], r, duration, speed)
            else:
                # MuJoCo's default impedance, which varies over half the depth of an impact.
                ratio = np.pi / duration
                damping = float(damping_ratio(r, Release.FORCE))
                law = Impedance(ratio, damping, 0.95, 0.9, speed * duration / 2 / np.pi)
            runs = partial(simulated, linear, *start), partial(simulated, law, *start)
            pairs = [tuple(map(per_impact, runs)) for _ in range(repetitions)]
            said.append(f"{name} {median(b / a for a, b in pairs):.1f}")
        cost = median(a for a, _ in pairs)
        print(f"r={r} Λ={lam} D={duration}: linear {cost:.2f} µs, {', '.join(said)}", flush=True)


def orbits(repetitions: int) -> None:
    print(f"{ORBITS} stable 1-T orbits, and a branch's two bifurcations, r=0.85 D=0.1")
    lam = np.linspace(0.4, 1.0, ORBITS)
    for name in HERTZ:
        law = law_of_impact(LAWS[name], 0.85, 0.1, rigid_speed(1, 0.85))
        rate = ORBITS / median(spent(lambda law=law: LawModel(law).orbit(1, lam))[0]
                               for _ in range(repetitions))  # fmt: skip
        other = [law_of_impact(LAWS[name], 0.85, 0.1 + 1e-3 * k, 3.4) for k in range(repetitions)]
        both = median(spent(lambda law=law: branch(law))[0] for law in other)
        print(f"{name}: {rate:.0f} orbits per second, branch {both:.2f} s", flush=True)


def branch(law) -> None:
    """Both bifurcations of a law that has no cached results."""
    model = LawModel(law)
    assert model.saddle_node(1).amplitude < model.period_doubling(1).amplitude


if __name__ == "__main__":
    repeated = int(sys.argv[1]) if len(sys.argv) > 1 else 3
    orbits(repeated)
    simulations(repeated)

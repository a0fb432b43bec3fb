"""How many impacts per second the simulation computes, on one core.

Random starts above the stiff and soft contacts of the paper and in chaotic
motion; the best of some repetitions in processor time. Not part of the test
suite, as a noisy machine would fail it:

    OMP_NUM_THREADS=1 python tests/speed/impacts.py [repetitions]
"""

import sys
import time

import numpy as np

from bouncing_ball.contacts.damping import damping_ratio
from bouncing_ball.contacts.spring_damper import Release, SpringDamper
from bouncing_ball.motion import contact as spring_damper
from bouncing_ball.motion import restitution

CASES = [
    # r, ϖ, Λ, release
    (0.85, 10.0, 0.8, Release.DISPLACEMENT),
    (0.85, 10.0, 1.0, Release.DISPLACEMENT),  # many balls next to permanent contact
    (0.85, 10.0, 1.0, Release.FORCE),
    (0.85, 100.0, 1.5, Release.DISPLACEMENT),
    (0.85, 1e4, 1.2, Release.DISPLACEMENT),
    (0.65, 2.0, 1.5, Release.DISPLACEMENT),
    (0.85, 2.0, 2.0, Release.FORCE),
    (0.90, 10.0, 5.0, Release.DISPLACEMENT),
    (0.50, 5.0, 3.0, Release.DISPLACEMENT),
]


def rate(run, repetitions: int) -> float:
    """Impacts per second of processor time."""
    best = 0.0
    for _ in range(repetitions):
        start = time.process_time()
        sequence = run()
        best = max(best, int(sequence.impacts.sum()) / (time.process_time() - start))
    return best


def main() -> None:
    repetitions = int(sys.argv[1]) if len(sys.argv) > 1 else 5
    print("model                                     balls   million impacts/s")
    for balls, impacts in ((10_000, 60), (100_000, 20)):
        rng = np.random.default_rng(1)
        phase, speed = rng.uniform(-np.pi, np.pi, balls), rng.uniform(1.5, 5.0, balls)
        for r, omega, lam, release in CASES:
            contact = SpringDamper(omega, float(damping_ratio(r)), release)
            start = contact, lam, phase, -speed - lam, impacts
            found = rate(lambda start=start: spring_damper.simulate(*start), repetitions)
            name = f"r={r} ϖ={omega:g} Λ={lam} {release}"
            print(f"{name:40} {balls:7} {found / 1e6:8.2f}")
        start = 0.85, 1.5, phase, speed + 1.5, impacts
        found = rate(lambda start=start: restitution.simulate(*start), repetitions)
        print(f"{'restitution r=0.85 Λ=1.5':40} {balls:7} {found / 1e6:8.2f}")


if __name__ == "__main__":
    main()

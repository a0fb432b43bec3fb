"""How the atlas scales: rate and memory against size.

Not part of the test suite, as a noisy machine would fail it. A quiet machine takes a minute
for sizes up to 10⁷, half an hour for 10⁸ and 10⁹:

    OMP_NUM_THREADS=1 python tests/speed/atlas.py [largest size, default 1e7]

Rates are orbits per second of processor time in a process of its own, start and imports
left out.
"""

import resource
import subprocess
import sys
import time
from statistics import median

from bouncing_ball.beyond.atlas.plan import Plan
from bouncing_ball.beyond.atlas.shards import shard

SMALLEST = 1e5
SECONDS = 3.0


def sized(orbits: float) -> Plan:
    """A plan of about so many orbits in one tile: so also small sizes have long arrays."""
    ratios, values = 164, 8
    return Plan(
        n=[1],
        release=["displacement"],
        restitution={"min": 0.05, "max": 1.0, "tiles": 1, "samples": values},
        position={"tiles": 1, "samples": max(1, round(orbits / ratios / values))},
        frequency_ratio={"min": 3.0, "max": 1.0e5, "samples": 161},
        tolerances=[0.1, 0.05, 0.02, 0.01, 0.005, 0.001],
        examined=[10.0, 30.0, 100.0, 300.0, 1000.0],
        shards=1,
    )


def measured(orbits: float) -> str:
    """Orbits, millions of them in a second, and the peak of the memory in megabytes."""
    plan = sized(orbits)
    # What is imported or made as it is first needed.
    shard(sized(SMALLEST), 0)
    times = []
    # Until it is some seconds; a single run where that takes longer.
    while sum(times) < SECONDS:
        start = time.process_time()
        shard(plan, 0)
        times.append(time.process_time() - start)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    return f"{plan.orbit_count:<13.3g} {plan.orbit_count / median(times) / 1e6:<18.2f} {peak:.0f}"


def main() -> None:
    if "--one" in sys.argv:
        print(measured(float(sys.argv[2])))
        return
    largest = float(sys.argv[1]) if len(sys.argv) > 1 else 1e7
    print("orbits        million orbits/s   peak memory, MB", flush=True)
    orbits = SMALLEST
    while orbits <= largest * 1.001:
        subprocess.run([sys.executable, __file__, "--one", f"{orbits:g}"], check=True)
        orbits *= 10


if __name__ == "__main__":
    main()

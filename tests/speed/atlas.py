"""How the atlas scales: rate and memory against size, one core and two, shards to merge.

Not part of the test suite, as a noisy machine would fail it. A quiet machine with two
cores takes some minutes for sizes up to 10⁷, half an hour for 10⁸ and 10⁹:

    OMP_NUM_THREADS=1 python tests/speed/atlas.py [largest size, default 1e7] [most shards, 1000]

Rates are orbits per second of processor time in a process of its own, start and imports
left out; two cores are two such processes at once, by the clock.
"""

import resource
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from statistics import median

import netCDF4

from bouncing_ball.atlas.merge import merge
from bouncing_ball.atlas.plan import Plan
from bouncing_ball.atlas.shards import limit_shard, shard
from bouncing_ball.datasets.netcdf import read_dataset, write_dataset

SMALLEST = 1e5
SECONDS = 3.0
PAIRS = 3
BASE = {
    "n": [1],
    "release": ["displacement"],
    # One tile, so that also small sizes have many nodes in a block.
    "restitution": {"min": 0.05, "max": 1.0, "tiles": 1, "samples": 8},
    "position": {"tiles": 1, "samples": 50},
    "frequency_ratio": {"min": 3.0, "max": 1.0e5, "samples": 161},
    "tolerances": [0.1, 0.05, 0.02, 0.01, 0.005, 0.001],
    "examined": [10.0, 30.0, 100.0, 300.0, 1000.0],
    "shards": 1,
}


def sized(orbits: float) -> Plan:
    """A plan of about so many orbits: more positions in its tile, as a larger atlas has."""
    each = Plan(BASE).orbits / BASE["position"]["samples"]
    samples = max(1, round(orbits / each))
    return Plan(BASE | {"position": {"tiles": 1, "samples": samples}})


def measured(plan: Plan) -> str:
    """Orbits, seconds of processor time, and the peak of the memory in megabytes."""
    # What is imported or made as it is first needed.
    shard(sized(SMALLEST), 0)
    times = []
    # Until it is some seconds; a single run where that takes longer.
    while sum(times) < SECONDS:
        start = time.process_time()
        shard(plan, 0)
        times.append(time.process_time() - start)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    return f"{plan.orbits} {median(times)} {peak}"


def process(orbits: float) -> subprocess.Popen:
    command = [sys.executable, __file__, "--one", f"{orbits:g}"]
    return subprocess.Popen(command, stdout=subprocess.PIPE, text=True)


def ended(running: subprocess.Popen) -> tuple[float, float, float]:
    said, _ = running.communicate()
    count, seconds, peak = map(float, said.split())
    return count, seconds, peak


def sizes(largest: float) -> None:
    print("orbits        million orbits/s   peak memory, MB")
    orbits = SMALLEST
    while orbits <= largest * 1.001:
        count, seconds, peak = ended(process(orbits))
        print(f"{count:<13.3g} {count / seconds / 1e6:<18.2f} {peak:.0f}", flush=True)
        orbits *= 10


def cores(orbits: float) -> None:
    """One process and two at once by the clock, each with the same work."""
    gains = []
    for _ in range(PAIRS):
        start = time.perf_counter()
        ended(process(orbits))
        alone = time.perf_counter() - start
        start = time.perf_counter()
        for running in [process(orbits), process(orbits)]:
            ended(running)
        gains.append(2 * alone / (time.perf_counter() - start))
    said = " ".join(f"{gain:.2f}" for gain in gains)
    print(f"two cores: {median(gains):.2f} times one ({said})", flush=True)


def merging(most: int) -> None:
    """The time of the merge against the number of shards, of one row with one tile each."""
    print("shards   merge, s   files, MB   peak memory, MB")
    count = 10
    while count <= most:
        small = {
            "restitution": {"min": 0.05, "max": 1.0, "tiles": min(count, 2000), "samples": 1},
            "position": {"tiles": 1, "samples": 1},
            "n": list(range(1, max(1, count // 2000) + 1)),
            "frequency_ratio": BASE["frequency_ratio"] | {"samples": 21},
            "shards": count,
        }
        plan = Plan(BASE | small)
        with tempfile.TemporaryDirectory() as folder:
            paths = [Path(folder, f"{k}.nc") for k in range(plan.shards)]
            simulate(plan, paths)
            limits = limit_shard(plan)
            start = time.process_time()
            merge(plan, (read_dataset(path) for path in paths), limits)
            spent = time.process_time() - start
            size = sum(path.stat().st_size for path in paths) / 1e6
        peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
        print(f"{plan.shards:<8} {spent:<10.2f} {size:<11.1f} {peak:.0f}", flush=True)
        count *= 10


def simulate(plan: Plan, paths: list[Path]) -> None:
    """Files of shards, all with the answers of the first: what is in them costs no time."""
    write_dataset(shard(plan, 0), paths[0], compressed=True)
    for row, path in enumerate(paths[1:], 1):
        shutil.copyfile(paths[0], path)
        with netCDF4.Dataset(path, "a") as file:
            file["row"][:] = row


def main() -> None:
    if "--one" in sys.argv:
        print(measured(sized(float(sys.argv[2]))))
        return
    largest = float(sys.argv[1]) if len(sys.argv) > 1 else 1e7
    most = int(sys.argv[2]) if len(sys.argv) > 2 else 1000
    sizes(largest)
    cores(min(largest, 1e7))
    merging(most)


if __name__ == "__main__":
    main()

"""What a user waits for: measures the calls of docs/speed.md and writes its table.

`make -C extras/beyond speed` renews the page, in a few minutes.
"""

import os
import platform
import time
from pathlib import Path
from statistics import median

import numpy as np

import bouncing_ball_beyond as bb

PAGE = Path(__file__).resolve().parent / "speed.md"
ROUNDS = 3

RIGID = bb.Rigid(0.85)
SPRING = bb.SpringDamper(20.0, restitution=0.65)
TSUJI = bb.tsuji(restitution=0.65, duration=0.16, speed=3.8)
START = bb.orbit(SPRING, amplitude=0.8)
DOUBLING = bb.follow(START, to=1.3).first("period doubling")
MANY = bb.orbit(SPRING.at(restitution=np.linspace(0.6, 0.7, 200)), amplitude=0.8)
HERTZ = bb.hunt_crossley(1000.0, 0.3)

CALLS = {
    "an n-T orbit": lambda: bb.orbit(SPRING, amplitude=0.8),
    "an n-T orbit, Tsuji's law": lambda: bb.orbit(TSUJI, amplitude=0.8),
    "`limits` of n-T orbits, Tsuji's law": lambda: bb.limits(TSUJI),
    "all `orbits` with 3 impacts in 3 periods, r = 0.5": lambda: bb.orbits(
        bb.Rigid(0.5), impacts=3, periods=3, amplitude=1.6
    ),
    "no n-T orbit, Hunt and Crossley's law": lambda: missing(HERTZ, amplitude=0.2),
    "200 branches side by side": lambda: bb.follow(MANY, to=1.3),
    "a `cascade` to 64 impacts": lambda: bb.cascade(DOUBLING, to=1.41, impacts=64),
    "2,000 impacts of one ball, ϖ = 20": lambda: bb.simulate(SPRING, amplitude=2.0, impacts=2000),
    "200 impacts of one ball, Tsuji's law": lambda: bb.simulate(TSUJI, amplitude=2.0, impacts=200),
    "`lyapunov` of a chaotic ball": lambda: bb.lyapunov(RIGID, amplitude=2.3),
    "`basins` of 100 × 100 starts, r = 0.5": lambda: bb.basins(
        bb.Rigid(0.5), amplitude=1.2, starts=100
    ),
    "`basins` of 8 × 8 starts, Hunt and Crossley's law": lambda: bb.basins(
        HERTZ, amplitude=1.2, starts=8
    ),
    "`error_thresholds` of six quantities": lambda: bb.error_thresholds(SPRING, amplitude=1.0),
    "`error_thresholds` of six quantities, Tsuji's law": lambda: bb.error_thresholds(
        TSUJI, amplitude=1.0
    ),
}


def missing(*ball, **given) -> None:
    """Search for an orbit that does not exist."""
    try:
        bb.orbit(*ball, **given)
    except bb.OrbitNotFound:
        return
    raise AssertionError("there is an orbit")


def seconds(call) -> float:
    """The time of the processor that a call takes."""
    start = time.process_time()
    call()
    return time.process_time() - start


def processor() -> str:
    """The name of the processor, where the system has it."""
    file = Path("/proc/cpuinfo")
    lines = file.read_text("utf-8").splitlines() if file.exists() else []
    names = [line.partition(": ")[2] for line in lines if line.startswith("model name")]
    return names[0] if names else platform.processor()


def text(value: float) -> str:
    """A time with two digits, such as 130 ms."""
    number, unit = (value, "s") if value >= 1 else (1e3 * value, "ms")
    return f"{float(f'{number:.2g}'):g} {unit}"


def main() -> None:
    rounds = [{name: seconds(call) for name, call in CALLS.items()} for _ in range(ROUNDS)]
    rows = [f"| {name} | {text(median(times[name] for times in rounds))} |" for name in CALLS]
    PAGE.write_text(
        f"""# How long a call takes

`make -C extras/beyond speed` measures the times and writes this page. The table lists processor
times with one thread and with numba; each is the median of {ROUNDS} rounds of all calls. If the
table names no ball, the ball is `SpringDamper(20.0, restitution=0.65)`. The ball with Tsuji's law
has the same restitution coefficient and nearly the same duration of contact. Its contacts have no
closed form, so they are integrated numerically.

Machine: {os.cpu_count()} processors, {processor()}, {platform.machine()}, at a load of
{os.getloadavg()[0]:.0f}; Python {platform.python_version()}, numpy {np.__version__}.

| call | time |
| --- | --- |
{chr(10).join(rows)}

The integration of contact laws uses arrays. This is efficient for many balls, but slow for a single
ball. Nearly all of the time of one contact is that of calls of numpy on arrays of 20 numbers.

An orbit that is not near the orbit of instantaneous impacts is searched from thousands of impacts.
Laws with a kink take ten times as long.

The first motion after the installation takes up to 20 s longer, because numba compiles the
functions and stores them. Searches and motions report their `progress` every two seconds, or when a
longer step ends.
""",
        encoding="utf-8",
    )


if __name__ == "__main__":
    main()

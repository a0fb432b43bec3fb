"""What a user waits for: measures the calls of docs/speed.md and writes its table.

`make speed` renews the page, in a few minutes.
"""

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
OF_TSUJI = bb.orbit(TSUJI, amplitude=0.8)
SKEWED = bb.Table([(1, 1, 0), (2, 0.3, 1)])
RESTING = bb.orbit_with_rest(bb.Rigid(0.3), amplitude=1.1, table=SKEWED)
DAMPED = bb.kuwabara_kono(restitution=0.2, duration=0.16, speed=3.8)
FOUR = bb.Table([(1, 1, 0), (2, 0.3, 0.7), (3, 0.15, -1.1), (4, 0.08, 2)])
TONES = bb.Table([(12, 1 / 144, 0), (17, 0.5 / 289, 0.4)])
HERTZ = bb.hunt_crossley(1000.0, 0.3)
KINKED = bb.simscape_contact(400.0, 4.0, 0.02)


def smooth_sphere(p, v, k, c):
    """Contact of OpenSim, with steep steps by tanh."""
    hertz = k * (p * p + 1e-5) ** 0.75 * (1 + np.tanh(300 * p)) / 2
    return hertz * (1 + 1.5 * c * v) * (1 + np.tanh(50 * (v + 2 / (3 * c)))) / 2


STEEP = bb.ForceLaw(smooth_sphere, {"k": 1e4, "c": 0.1})
OF_STEEP = bb.orbit(STEEP, amplitude=0.9)
TWO_OWN = bb.ForceLaw(lambda p, v, k, c: k * p * (1 + c * v), {"k": [400.0, 500.0], "c": 0.1})
OWN = bb.ForceLaw(lambda p, v, k, c: k * p + c * p * v, {"k": 400.0, "c": 8.0})

CALLS = {
    "an n-T orbit": lambda: bb.orbit(SPRING, amplitude=0.8),
    "an n-T orbit, Tsuji's law": lambda: bb.orbit(TSUJI, amplitude=0.8),
    "an n-T orbit below the saddle-node of impacts, Kuwabara and Kono's law, r = 0.2": lambda: (
        bb.orbit(DAMPED, amplitude=1.5)
    ),
    "`limits` of n-T orbits": lambda: bb.limits(SPRING),
    "`limits` of n-T orbits, Tsuji's law": lambda: bb.limits(TSUJI),
    "all `orbits` with 3 impacts in 3 periods, r = 0.5": lambda: bb.orbits(
        bb.Rigid(0.5), impacts=3, periods=3, amplitude=1.6
    ),
    "an n-T orbit of a steep law, four harmonics": lambda: bb.orbit(
        STEEP, amplitude=2.5, table=FOUR
    ),
    "no n-T orbit of a steep law, four harmonics": lambda: missing(
        STEEP.at(c=0.3), amplitude=0.7, table=FOUR
    ),
    "no n-T orbit, Hunt and Crossley's law": lambda: missing(HERTZ, amplitude=0.2),
    "all `orbits` with one impact, two tones, Hunt and Crossley's law": lambda: bb.orbits(
        bb.hunt_crossley(1e6, 0.8), amplitude=1.2, table=TONES
    ),
    "a branch with its special orbits": lambda: bb.follow(START, to=1.3),
    "a branch, Tsuji's law": lambda: bb.follow(OF_TSUJI, to=1.3),
    "a branch to both sides, a steep law": lambda: bb.follow(OF_STEEP, to=(0.05, 1.5)),
    "a branch up to the end of a rest, r = 0.3, two harmonics": lambda: bb.follow(RESTING, to=1.6),
    "200 branches side by side": lambda: bb.follow(MANY, to=1.3),
    "a `cascade` to 64 impacts": lambda: bb.cascade(DOUBLING, to=1.41, impacts=64),
    "a `special_curve`": lambda: bb.special_curve(DOUBLING),
    "a `normal_form`": lambda: bb.normal_form(DOUBLING),
    "2,000 impacts of one ball, r = 0.85": lambda: bb.simulate(RIGID, amplitude=2.0, impacts=2000),
    "2,000 impacts of one ball, ϖ = 20": lambda: bb.simulate(SPRING, amplitude=2.0, impacts=2000),
    "200 impacts of one ball, Tsuji's law": lambda: bb.simulate(TSUJI, amplitude=2.0, impacts=200),
    "50 impacts of one ball, a law of one's own": lambda: bb.simulate(
        OWN, amplitude=2.0, impacts=50
    ),
    "`history` of 10 periods": lambda: bb.history(SPRING, amplitude=1.2),
    "`motion_of` a ball": lambda: bb.motion_of(SPRING, amplitude=1.1),
    "`lyapunov` of a chaotic ball": lambda: bb.lyapunov(RIGID, amplitude=2.3),
    "`basins` of 100 × 100 starts, r = 0.5": lambda: bb.basins(
        bb.Rigid(0.5), amplitude=1.2, starts=100
    ),
    "`basins` of 30 × 30 starts, Tsuji's law": lambda: bb.basins(TSUJI, amplitude=1.1, starts=30),
    "an `orbit_diagram` at 50 Λ": lambda: bb.orbit_diagram(
        bb.Rigid(0.5), amplitude=np.linspace(1.0, 1.7, 50)
    ),
    "`law_errors`": lambda: bb.law_errors(SPRING, amplitude=1.0),
    "`error_thresholds` of six quantities": lambda: bb.error_thresholds(SPRING, amplitude=1.0),
    "`error_thresholds` of six quantities, Tsuji's law": lambda: bb.error_thresholds(
        TSUJI, amplitude=1.0
    ),
    "`error_thresholds` of six quantities, a law with a kink": lambda: bb.error_thresholds(
        KINKED, amplitude=1.0
    ),
    "`motion_of` two chaotic balls, a law of one's own, 2,000 impacts": lambda: bb.motion_of(
        TWO_OWN, amplitude=1.5
    ),
    "`tsuji` with a given r and duration": lambda: bb.tsuji(
        restitution=0.7, duration=0.1, speed=3.0
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


def text(value: float) -> str:
    """A time with two digits, such as 130 ms."""
    number, unit = (value, "s") if value >= 1 else (1e3 * value, "ms")
    return f"{float(f'{number:.2g}'):g} {unit}"


def main() -> None:
    rounds = [{name: seconds(call) for name, call in CALLS.items()} for _ in range(ROUNDS)]
    rows = [f"| {name} | {text(median(each[name] for each in rounds))} |" for name in CALLS]
    PAGE.write_text(
        f"""# How long a call takes

`make speed` measures the times and writes this page. The table lists processor times with one
thread and with numba ({platform.machine()}, Python {platform.python_version()}, numpy
{np.__version__}). All calls are measured in each of {ROUNDS} rounds, and each time is the median of
the rounds. If the table names no ball, the ball is `SpringDamper(20.0, restitution=0.65)`. The ball
with Tsuji's law has the same restitution coefficient and nearly the same duration of contact. Its
contacts have no closed form, so they are integrated numerically.

| call | time |
| --- | --- |
{chr(10).join(rows)}

The integration of contact laws uses arrays. This is efficient for many balls, but slow for a single
ball. Nearly all of the 3 ms of one contact are calls of numpy on arrays of 20 numbers.

An orbit that is not near the orbit of instantaneous impacts is searched from thousands of impacts:
32 speeds at 96 phases, or at 32 phases for each wave of the highest harmonic. These contacts take
nine tenths of the time, and a quarter of it is the waveform of the table. A terminal or a notebook
shows how many of them are done. The search for an orbit that does not exist also finds the
saddle-node, for its message.

The signature of a law with a kink is integrated for each speed, and kept. The thresholds of such a
law ask for the same speed at all ϖ.

The first motion after the installation takes a few seconds longer, because numba compiles the
functions and stores them.
""",
        encoding="utf-8",
    )


if __name__ == "__main__":
    main()

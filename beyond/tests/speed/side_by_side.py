"""How fast, side by side: renews docs/speed.md, with one table from one run (`make speed`).

Each row compares times of this machine in this run, with the error that each program reached. A
program that is not installed is named absent: AUTO-07p interpreted (`pip install bifpy`, which
needs gfortran) and compiled (AUTO_DIR, see compiled_auto.py), heyoka. With --cold, a cold
run of the pipeline is compared with its imports, in some minutes (tests/speed/imports_only.py).
"""

import math
import platform
import resource
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from statistics import median
from typing import NamedTuple

import compiled_auto
import numpy as np

import bouncing_ball_beyond
from bouncing_ball_beyond.inherited.numerics.corrector import newton, plane
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.linear_contact import LinearContactDynamics
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.periodic.branches.curves import CurveProblem, condition_of, curve_through
from bouncing_ball_beyond.periodic.branches.following import branch_from
from bouncing_ball_beyond.periodic.one_impact import n_t
from bouncing_ball_beyond.periodic.orbits.balls import LAMBDA, Balls
from bouncing_ball_beyond.periodic.orbits.ends import Window
from bouncing_ball_beyond.periodic.orbits.impacts import equations_of
from bouncing_ball_beyond.periodic.orbits.orbit import Orbit
from bouncing_ball_beyond.periodic.orbits.special import Special

PAGE = Path(__file__).resolve().parents[2] / "docs" / "speed.md"
R = 0.5
REPETITIONS = 3
# Branches that are corrected together, and their points.
BRANCHES, POINTS = 200, 20
# Numbers of branches together at which the time for each is compared with compiled AUTO.
TOGETHER = (1, 2, 5, 10, 20, 50, 100, 200)


class Row(NamedTuple):
    """A line of the table: seconds and errors of this package and of a peer."""

    task: str
    ours: float
    error: float
    peer: str
    theirs: float | None = None
    their_error: float | None = None

    def line(self) -> str:
        if self.theirs is None:
            ours = f"{seconds(self.ours)} | {self.error:.0e}"
            return f"| {self.task} | {ours} | {self.peer} | – | – | – |"
        ratio = self.theirs / self.ours
        return (
            f"| {self.task} | {seconds(self.ours)} | {self.error:.0e} | {self.peer} | "
            f"{seconds(self.theirs)} | {self.their_error:.0e} | {ratio:.2g} |"
        )


def seconds(value: float) -> str:
    """A time with its unit."""
    return f"{value:.2g} s" if value >= 0.1 else f"{1e3 * value:.2g} ms"


def processor_time() -> float:
    """Seconds that the processor has spent on this process and on those that it has started."""
    others = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.process_time() + others.ru_utime + others.ru_stime


def timed(run: Callable) -> tuple[float, object]:
    """Median seconds of the processor in some calls, and the last result."""
    times, result = _times(run, REPETITIONS)
    return median(times), result


def least(run: Callable) -> tuple[float, object]:
    """The least seconds of the processor in many calls, and the last result."""
    times, result = _times(run, compiled_auto.RUNS)
    return min(times), result


def _times(run: Callable, count: int) -> tuple[list[float], object]:
    times = []
    for _ in range(count):
        start = processor_time()
        result = run()
        times.append(processor_time() - start)
    return times, result


def flights(state, amplitude: float, restitution: float, periods: int) -> list[float]:
    """The defects of an orbit of the restitution model: height and velocity of each leg."""
    found = []
    legs = len(state) // 2
    for leg in range(legs):
        phase = state[2 * leg]
        velocity = state[2 * leg + 1]
        last = leg == legs - 1
        then = state[0] + 2 * math.pi * periods if last else state[2 * leg + 2]
        after = state[1] if last else state[2 * leg + 3]
        time_aloft = then - phase
        launch = amplitude * math.cos(phase) - restitution * velocity
        rise = launch * time_aloft - time_aloft**2 / 2
        level = amplitude * (math.sin(phase) - math.sin(then))
        found.append(rise + level)
        found.append(launch - time_aloft - amplitude * math.cos(then) - after)
    return found


def doubling(state, amplitude: float, restitution: float) -> float:
    """1 + tr M + det M of an orbit of the restitution model, for AUTO."""
    legs = len(state) // 2
    whole = ((1.0, 0.0), (0.0, 1.0))
    for leg in range(legs):
        phase = state[2 * leg]
        after = state[1] if leg == legs - 1 else state[2 * leg + 3]
        then = state[0] if leg == legs - 1 else state[2 * leg + 2]
        periods = 2 * math.pi * legs if leg == legs - 1 else 0.0
        aloft = then + periods - phase
        x = amplitude * math.cos(phase)
        y = amplitude * math.sin(phase)
        x1 = amplitude * math.cos(then)
        y1 = amplitude * math.sin(then)
        columns = []
        for d_phase, d_velocity in ((1.0, 0.0), (0.0, -restitution)):
            gap = d_velocity * aloft + d_phase * (x - x1 - y * aloft)
            rate = d_velocity + d_phase * (y1 - y)
            later = -gap / after
            columns.append((d_phase + later, rate + (y1 - 1) * later))
        (a, c), (b, d) = columns
        (p, q), (s, t) = whole
        whole = ((a * p + b * s, a * q + b * t), (c * p + d * s, c * q + d * t))
    (a, b), (c, d) = whole
    return 1 + a + d + a * d - b * c


def in_auto(state, parameters, equations, low: float, high: float, step: float) -> tuple:
    """Seconds, and (state, parameter) of the points of a branch that AUTO-07p follows."""
    from bifpy import auto

    def begin(u, p, _):
        for k, value in enumerate(state):
            u[k] = value
        p[0] = parameters

    settings = {
        "ips": auto.IPS_ALGEBRAIC_SYSTEM, "ndim": len(state), "npar": 1, "nmx": 500, "ilp": 1,
        "isp": 0, "iads": 1, "itmx": 9, "itnw": 9, "nwtn": 3, "jac": 0, "ds": step,
        "dsmin": 1e-6, "dsmax": 0.1, "rl0": low, "rl1": high, "a0": -1e300, "a1": 1e300,
        "epsl": 1e-12, "epsu": 1e-12, "epss": 1e-10,
    }  # fmt: skip
    spent, found = timed(lambda: auto.run(equations, begin, settings, icu=[1]))
    points = [(list(point.state), point.parameters[0]) for point in found.branches[0].points]
    return spent, points


def peer(module: str) -> bool:
    """Whether a program is installed."""
    try:
        __import__(module)
    except ImportError:
        return False
    return True


def orbit_state(orbit: Orbit) -> list[float]:
    """The phases, which increase from impact to impact, and the velocities δ′ of an orbit."""
    before = np.concatenate([[0], np.cumsum(orbit.turns)[:-1]])
    rising = orbit.phases + 2 * np.pi * before
    velocity = np.atleast_1d(orbit.relative_impact_velocity)
    return [float(x) for pair in zip(rising, velocity, strict=True) for x in pair]


def branch_row(impacts: int, amplitude: float, to: float) -> Row:
    """A branch of the restitution model along Λ, with its bifurcations."""
    ball = bouncing_ball_beyond.rigid(restitution=R)
    start = bouncing_ball_beyond.orbit_of_motion(
        ball, amplitude=amplitude, phase=1.0, velocity=-3.0
    )
    ours, found = timed(lambda: branch_from(start, to=to))
    error = np.abs(found.problem.residual(found.branch.points)).max()
    task = (
        f"branch of orbits with {impacts} impact{'s' if impacts > 1 else ''}, {len(found)} points"
    )
    if not peer("bifpy.auto"):
        return Row(task, ours, error, "AUTO-07p: absent")

    def equations(u, p):
        return flights(u, p[0], R, impacts)

    theirs, points = in_auto(orbit_state(start), amplitude, equations, 0.0, to, 0.01)
    worst = max(max(map(abs, flights(u, p, R, impacts))) for u, p in points)
    return Row(task, ours, error, f"AUTO-07p, {len(points)} points", theirs, worst)


def curve_row() -> Row:
    """The period doublings of the orbits with two impacts in (r, Λ)."""
    ball = bouncing_ball_beyond.rigid(restitution=R)
    start = bouncing_ball_beyond.orbit_of_motion(ball, amplitude=1.6, phase=1.0, velocity=-3.0)
    window = Window(R, 0.8)
    kind = Special.PERIOD_DOUBLING
    special = next(each for each in branch_from(start, to=1.8).special if each.kind == kind)
    ours, found = timed(
        lambda: curve_through(special, kind, LAMBDA, "restitution", across_window=window)
    )
    values = found.problem.values(found.branch.points)
    last = found.branch.points[values["restitution"].argmax()]
    error = np.abs(found.problem.residual(last)).max()
    task = f"curve of period doublings with two impacts in (r, Λ), {len(found)} points"
    if not peer("bifpy.auto"):
        return Row(task, ours, error, "AUTO-07p: absent")

    def equations(u, p):
        return [*flights(u[:4], u[4], p[0], 2), doubling(u[:4], u[4], p[0])]

    state = [*orbit_state(special), special.amplitude]
    theirs, points = in_auto(state, R, equations, 0.0, 0.8, 0.01)
    worst = 0.0
    for u, r in points:
        # Both find the same Λ at the same r.
        y = found.branch.points[np.abs(values["restitution"] - r).argmin()].copy()
        y[-1] = np.arcsinh(r)
        axis = np.eye(y.size)[-1]
        problem = CurveProblem(found.problem, condition_of(found.problem, kind))
        ours_there = newton(problem, y, plane(axis, y)).point
        worst = max(worst, abs(float(np.sinh(ours_there[-2])) - u[4]))
    return Row(task, ours, error, f"AUTO-07p, {len(points)} points", theirs, worst)


def compiled_rows() -> tuple[Row, str]:
    """The public call `follow` against AUTO with compiled equations, and at how many branches
    together both take the same time for each branch.
    """
    ball = bouncing_ball_beyond.rigid(restitution=R)
    start = bouncing_ball_beyond.orbit_of_motion(ball, amplitude=1.6, phase=1.0, velocity=-3.0)
    to = 1.8
    ours, found = least(lambda: bouncing_ball_beyond.follow(start, to=to))
    error = float(found.orbits.defect().max())
    task = f"the same branch by the public call `follow`, {len(found)} points"
    auto = compiled_auto.folder()
    if auto is None:
        return Row(task, ours, error, "AUTO-07p compiled: absent"), ""
    run = compiled_auto.followed(auto, orbit_state(start), 1.6, R, to)
    worst = max(max(map(abs, flights(u, p, R, 2))) for u, p in run.points)
    name = f"AUTO-07p compiled, {len(run.points)} points"
    row = Row(task, ours, error, name, run.seconds, worst)
    share = POINTS / len(run.points)
    times = {count: _together(count, least)[0] / count for count in TOGETHER}
    even = [count for count, each in times.items() if each <= share * run.seconds]
    each = ", ".join(f"{seconds(spent)} for {count}" for count, spent in times.items())
    said = (
        f"Compiled AUTO takes {seconds(run.seconds)} by its own clock, and {seconds(run.process)} "
        f"with the start of its process. {POINTS} points of branches with two impacts that are "
        f"corrected together, without events and stability, take for each branch {each} branches; "
    )
    if not even:
        return row, said + "AUTO takes less time for each branch at all of these numbers."
    return row, said + f"from {even[0]} together on, each takes no longer than with AUTO."


def batch_row() -> Row:
    """Points of branches with two impacts, corrected together."""
    spent, error = _together(BRANCHES)
    count = BRANCHES * POINTS
    task = f"{count} points of {BRANCHES} branches with two impacts together"
    return Row(f"{task}: {count / spent:.0f} points per second", spent, error, "none")


def _together(branches: int, timer: Callable = timed) -> tuple[float, float]:
    """Seconds and the largest defect of branches with two impacts that are corrected together: a
    row of r at each of many Λ.
    """
    ball = bouncing_ball_beyond.rigid(restitution=R)
    start = bouncing_ball_beyond.orbit_of_motion(ball, amplitude=1.6, phase=1.0, velocity=-3.0)
    r = np.linspace(R - 0.01, R + 0.01, branches) if branches > 1 else np.array([R])
    problem, here = equations_of(start, LAMBDA)
    balls = Balls(ball, np.full(branches, 1.6)).at({"restitution": r})
    orbits = replace(problem, balls=balls)
    first = np.tile(here, (branches, 1))

    def points() -> np.ndarray:
        y = first.copy()
        axis = np.eye(y.shape[-1])[-1]
        for lam in np.linspace(1.6, 1.64, POINTS):
            y[:, -1] = np.arcsinh(lam)
            found = newton(orbits, y, plane(axis, y))
            assert found.converged.all()
            y = found.point
        return y

    spent, y = timer(points)
    return spent, float(np.abs(orbits.residual(y)).max())


def simulation_row() -> Row:
    """Impacts on a spring and a damper, against a Taylor integrator with events."""
    sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
    contact = SpringDamper.from_restitution(0.85, 20.0)
    impacts = 300
    # Beside the stable 1-T orbit, so that rounding errors do not grow.
    orbit = n_t.orbit(ContactModel(contact), 1, 0.9)
    phase = float(orbit.phase) + 0.01
    velocity = float(orbit.impact_velocity)
    dynamics = LinearContactDynamics.of(contact, 0.9)

    def simulated():
        return dynamics.simulate(np.array([phase]), np.array([velocity]), impacts)

    ours, sequence = timed(simulated)
    error = abs(float(sequence.impact_velocity[-1, 0]) - velocity)
    task = f"{impacts} impacts of one ball on a contact with ϖ = 20"
    if not peer("heyoka"):
        return Row(task, ours, error, "heyoka: absent")
    from taylor_ball import TaylorBall

    ball = TaylorBall(False)
    theirs, rows = timed(
        lambda: ball.impacts(0.9, 20.0, contact.damping_ratio, phase, velocity, impacts)
    )
    their_error = abs(np.asarray(rows)[1, -1] - velocity)
    return Row(task, ours, error, "heyoka", theirs, float(their_error))


def page(rows: list[Row], even: str, cold: str) -> str:
    """The page as Markdown."""
    table = "\n".join(row.line() for row in rows)
    return f"""# How fast, side by side

`make speed` renews this page. All times are times of the processor, medians of
{REPETITIONS} runs on one machine ({platform.machine()}, Python {platform.python_version()},
numpy {np.__version__}).
A ratio above 1 says that this package is faster. The error of a branch is the largest defect of the
equations; that of AUTO-07p includes the eleven digits of its output files, and on the curve its
error is the difference of Λ from this package. The error of a simulation is the distance from the
1-T orbit in closed form, to which the ball has settled. "AUTO-07p"
evaluates the equations of the restitution model in Python, through its interface `bifpy`, and each
of its runs is a process. "AUTO-07p compiled" has them in Fortran (`tests/speed/two_impacts.f90`),
with the same settings; its time is that of its own clock, and both this and that of `follow` beside
it are the least of {compiled_auto.OF_AUTO} and of {compiled_auto.RUNS} runs. Neither computes
events except folds. This package also evaluates stability and grazing, also in the public call
`follow`; the two rows above it are the driver alone.

| task | this package | error | peer | peer's time | peer's error | ratio |
| --- | --- | --- | --- | --- | --- | --- |
{table}

{even}
{cold}
"""


def main() -> None:
    rows = [branch_row(1, 1.3, 1.8), branch_row(2, 1.6, 1.8)]
    compiled, even = compiled_rows()
    rows += [compiled, curve_row(), batch_row()]
    rows.append(simulation_row())
    cold = "A cold run of the pipeline against its imports was left out: `make speed COLD=--cold`."
    if "--cold" in sys.argv:
        import imports_only

        cold = imports_only.compared(1)
    text = page(rows, even, cold)
    PAGE.write_text(text, encoding="utf-8")
    print(text)


if __name__ == "__main__":
    main()

"""How fast, side by side: measures everything that docs/speed.md says, and writes this page.

`make speed` renews the page, in some minutes. AUTO-07p is compared if AUTO_DIR names a folder in
which it was built without OpenMP (its clock is that of the processor then) and FC a Fortran
compiler, gfortran by default; its equations are speed.f90. heyoka is compared if it is installed.
"""

import cProfile
import math
import os
import platform
import pstats
import re
import resource
import subprocess
import sys
import tempfile
import time
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from statistics import median

import numpy as np

import bouncing_ball_beyond as bb

HERE = Path(__file__).resolve().parent
ROUNDS = 3
"""Each median is that of as many rounds, in each of which everything is measured in turn."""
ROWS = 200
H = 1e-30
"""Complex step."""


# Tasks: each function prepares one, and returns the call that is measured.


def followed(start, to):
    """A call that follows a branch and says where it is stable and admissible."""

    def call():
        branch = bb.follow(start, to=to)
        assert branch.stable.any() and branch.admissible.any()
        return branch

    return call


def one_impact():
    return followed(bb.orbit(bb.Rigid(0.5), amplitude=1.3), to=1.8)


def two_impacts():
    return followed(two_impact_orbit(), to=1.8)


def one_contact():
    return followed(bb.orbit(bb.SpringDamper(20.0, restitution=0.65), amplitude=0.8), to=1.3)


def two_contacts():
    branch = one_contact()()
    doubled = bb.follow(branch.first("period doubling"), to=1.3)
    return followed(doubled.orbits[-1], to=1.4)


def two_impact_orbit():
    """The 2-impact orbit of a ball with r = 0.5 at Λ = 1.6."""
    return bb.orbit_of_motion(bb.Rigid(0.5), amplitude=1.6)


def rigid_rows():
    starts = bb.orbit(bb.Rigid(np.linspace(0.45, 0.55, ROWS)), amplitude=1.3)
    return lambda: bb.follow(starts, to=1.8)


def doubled_rows():
    doublings = [each.first("period doubling") for each in rigid_rows()()]
    return lambda: bb.follow(doublings, to=1.8)


def contact_rows():
    balls = bb.SpringDamper(20.0, restitution=np.linspace(0.6, 0.7, ROWS))
    starts = bb.orbit(balls, amplitude=0.8)
    return lambda: bb.follow(starts, to=1.3)


def whole_cascade():
    doubling = one_impact()().first("period doubling")
    return lambda: bb.cascade(doubling, to=1.8, impacts=64)


def many_impacts():
    doubling = one_impact()().first("period doubling")
    last = bb.cascade(doubling, to=1.8, impacts=32)[-1]
    call = followed(last.special[-1], to=1.8)
    assert call().impacts == 64
    return call


def doublings():
    special = two_impacts()().first("period doubling")
    ranges = {"restitution": (0.5, 0.8)}
    return lambda: bb.special_curve(special, along=("amplitude", "restitution"), ranges=ranges)


def motion(ball, impacts, balls=None):
    """A call that follows chaotic balls for some impacts."""
    phase = 0.5 if balls is None else np.linspace(0.0, 6.0, balls)
    return lambda: bb.simulate(ball, amplitude=2.0, phase=phase, impacts=impacts)


def rigid_motion():
    return motion(bb.Rigid(0.85), 2000)


def contact_motion():
    return motion(bb.SpringDamper(20.0, restitution=0.85), 2000)


def long_rigid_motion():
    return motion(bb.Rigid(0.85), 100_000)


def long_contact_motion():
    return motion(bb.SpringDamper(20.0, restitution=0.85), 100_000)


def many_rigid_balls():
    return motion(bb.Rigid(0.85), 20, balls=10_000)


def many_contact_balls():
    return motion(bb.SpringDamper(20.0, restitution=0.85), 20, balls=10_000)


def new_hertzian():
    return bb.tsuji(restitution=0.85, duration=0.1, speed=3.0)


@cache
def hertzian():
    return new_hertzian()


def hertzian_of_impact():
    return new_hertzian


def tsuji_basins():
    return lambda: bb.basins(hertzian(), amplitude=1.2, starts=30)


def tsuji_motion():
    return motion(hertzian(), 50)


def tsuji_balls():
    return motion(hertzian(), 20, balls=1000)


def tsuji_orbit():
    return lambda: bb.orbit(hertzian(), amplitude=0.9)


def linear_orbit():
    return lambda: bb.orbit(bb.SpringDamper(20.0, restitution=0.65), amplitude=0.8)


def tsuji_limits():
    return lambda: bb.limits(hertzian())


def linear_limits():
    return lambda: bb.limits(bb.SpringDamper(20.0, restitution=0.65))


def tsuji_branch():
    return followed(bb.orbit(hertzian(), amplitude=0.9), to=1.3)


def integrated_branch():
    """The branch of `one_contact`, by the integration of the contact."""
    zeta = float(bb.SpringDamper(20.0, restitution=0.65).zeta)
    return followed(bb.orbit(bb.linear(20.0, zeta), amplitude=0.8), to=1.3)


def tsuji_thresholds():
    return lambda: bb.error_thresholds(hertzian(), amplitude=1.0)


def linear_thresholds():
    ball = bb.SpringDamper(1.0, restitution=0.65)
    return lambda: bb.error_thresholds(ball, amplitude=1.0)


def rigid_basins():
    return lambda: bb.basins(bb.Rigid(0.5), amplitude=1.2, starts=100)


def chaotic_basins():
    return lambda: bb.basins(bb.Rigid(0.5), amplitude=1.6, starts=100)


def contact_basins():
    ball = bb.SpringDamper(20.0, restitution=0.5)
    return lambda: bb.basins(ball, amplitude=1.2, starts=100)


def settled():
    """A phase beside that of the 1-T orbit at Λ = 0.9, and the relative speed of this orbit."""
    orbit = bb.orbit(bb.SpringDamper(20.0, restitution=0.85), amplitude=0.9)
    phase = float(orbit.phase)
    return phase + 0.01, float(orbit.impact_velocity) - 0.9 * math.cos(phase)


def settling_motion():
    phase, speed = settled()
    ball = bb.SpringDamper(20.0, restitution=0.85)

    def call():
        found = bb.simulate(ball, amplitude=0.9, phase=phase, relative_velocity=speed, impacts=300)
        velocity, phase_of_table = found.impact_velocity.values[-1], found.impact_phase.values[-1]
        return abs(velocity - 0.9 * math.cos(phase_of_table) - speed)

    return call


# The same by other means.


def defects(z, restitution=0.5):
    """Height and speed at the ends of flights; z has phases and speeds in turn, and then Λ."""
    phase, speed, amplitude = z[..., :-1:2], z[..., 1:-1:2], z[..., -1:]
    then = np.roll(phase, -1, axis=-1)
    then[..., -1] += 2 * np.pi * phase.shape[-1]
    aloft = then - phase
    launch = amplitude * np.cos(phase) + restitution * speed
    height = launch * aloft - aloft**2 / 2 + amplitude * (np.sin(phase) - np.sin(then))
    landing = aloft + amplitude * np.cos(then) - launch - np.roll(speed, -1, axis=-1)
    return np.concatenate([height, landing], axis=-1)


def slopes(z):
    """The derivatives of the defects, by complex steps."""
    return defects(z + 1j * H * np.eye(z.size)).imag.T / H


def bare_branch(z, to):
    """Pseudo-arclength continuation in numpy, without a second thought about what may fail."""
    last = np.eye(z.size)[-1]
    tangent = last
    found = [z]
    step = 0.1
    while z[-1] < to:
        tangent = np.linalg.solve(np.vstack([slopes(z), tangent]), last)
        tangent /= np.linalg.norm(tangent)
        normal = tangent
        if z[-1] + step * tangent[-1] >= to:
            step = (to - z[-1]) / tangent[-1]
            normal = last
        ahead = z + step * tangent
        new = ahead
        iterations = 0
        converged = False
        while not converged and iterations < 7:
            iterations += 1
            matrix = np.vstack([slopes(new), normal])
            change = np.linalg.solve(matrix, -np.append(defects(new), normal @ (new - ahead)))
            new = new + change
            converged = np.abs(change).max() < 1e-10
        if not converged:
            step /= 2
            continue
        z = new
        if normal is last:
            z[-1] = to
        found.append(z)
        if iterations < 5:
            step = min(2 * step, 0.4)
    return np.array(found)


def unknowns(orbit):
    """An orbit as the unknowns of `defects`."""
    phases = np.atleast_1d(orbit.phase)
    speeds = orbit.amplitude * np.cos(phases) - np.atleast_1d(orbit.impact_velocity)
    # The orbits here have one impact in each turn of the table.
    phases = phases + 2 * np.pi * np.arange(speeds.size)
    return np.append(np.stack([phases, speeds], axis=1).ravel(), orbit.amplitude)


def bare_one_impact():
    z = unknowns(bb.orbit(bb.Rigid(0.5), amplitude=1.3))
    return lambda: bare_branch(z, 1.8)


def bare_two_impacts():
    z = unknowns(two_impact_orbit())
    return lambda: bare_branch(z, 1.8)


def taylor_motion():
    """The ball of `settling_motion` by heyoka, with one terminal event in each phase."""
    import heyoka

    ball = bb.SpringDamper(20.0, restitution=0.85)
    z, v = heyoka.make_vars("z", "v")
    phase_of_table = heyoka.time + heyoka.par[0]
    gap = z - 0.9 * heyoka.sin(phase_of_table)
    rate = v - 0.9 * heyoka.cos(phase_of_table)
    ratio, zeta = ball.frequency_ratio, float(ball.zeta)
    force = -2 * zeta * ratio * rate - ratio * ratio * gap

    def integrator(acceleration, direction):
        event = heyoka.t_event(gap, direction=direction)
        return heyoka.taylor_adaptive([(z, v), (v, acceleration)], [0.0, 0.0], t_events=[event])

    contact = integrator(force - 1.0, heyoka.event_direction.positive)
    flight = integrator(0.0 * z - 1.0, heyoka.event_direction.negative)
    start, speed = settled()

    def call():
        contact.pars[0] = flight.pars[0] = start
        now = 0.0
        state = [0.9 * math.sin(start), speed + 0.9 * math.cos(start)]
        for _ in range(299):
            for each in (contact, flight):
                each.time = now
                each.state[:] = state
                each.reset_cooldowns()
                each.propagate_until(now + 1e3)
                now = each.time
                state = each.state.copy()
        return abs(state[1] - 0.9 * math.cos(now + start) - speed)

    return call


def auto_folder():
    """The folder of a built AUTO-07p, or None."""
    named = os.environ.get("AUTO_DIR")
    if named and list(Path(named, "lib").glob("*.o")):
        return Path(named)
    return None


AUTO = """NDIM=2, IPS=-1, IRS={label}, ILP=1, ICP={parameters}
NTST=10, NCOL=4, IAD=3, ISP=2, ISW={switch}, IPLT=0, NBC=0, NINT=0
NMX=500, NPR=1000, MXBF=10, IID=0, ITMX=9, ITNW=9, NWTN=3, JAC=1
EPSL=1e-12, EPSU=1e-12, EPSS=1e-10, DS=0.01, DSMIN=1e-6, DSMAX=0.1, IADS=1
NPAR=11, THL={{}}, THU={{}}, RL0=0.0, RL1={to}, A0=-1e300, A1=1e300
"""


class AutoRun:
    """Runs of AUTO-07p, compiled, with the return map of speed.f90 in its map mode."""

    def __init__(self, here, orbit):
        self.here = Path(here)
        self.program = self.here / "branch"
        objects = sorted(map(str, (auto_folder() / "lib").glob("*.o")))
        compiler = os.environ.get("FC", "gfortran")
        build = [compiler, "-O2", str(HERE / "speed.f90"), *objects, "-o", str(self.program)]
        subprocess.run(build, check=True, cwd=here, capture_output=True)
        state = unknowns(orbit)
        start = [orbit.amplitude, 0.5, orbit.impacts, state[0], state[1]]
        (self.here / "start").write_text(" ".join(repr(float(each)) for each in start))

    def seconds(self, **settings):
        """Seconds of AUTO's own clock, and those of the whole process."""
        (self.here / "fort.2").write_text(AUTO.format(**settings))
        before = processor_time()
        run = subprocess.run([self.program], check=True, cwd=self.here, capture_output=True)
        whole = processor_time() - before
        own = re.search(r"Total Time\s+(\S+)", run.stdout.decode())[1]
        return float(own), whole

    def branch(self):
        """Along Λ, with stability and doublings."""
        return self.seconds(label=0, switch=1, parameters=[1], to=1.8)

    def curve(self):
        """Along r and Λ, from the doubling that `branch` has found."""
        (self.here / "fort.8").replace(self.here / "fort.3")
        seconds = self.seconds(label=2, switch=2, parameters=[2, 1], to=0.8)
        (self.here / "fort.3").unlink()
        return seconds

    def points(self):
        """Rows of AUTO's table: branch, point, type, label, and numbers."""
        lines = (line.split() for line in (self.here / "fort.7").read_text().splitlines())
        return [[float(each) for each in line] for line in lines if line and line[0] != "0"]


# Measuring.


def processor_time():
    """Seconds that the processor has spent on this process and on those that it has started."""
    others = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.process_time() + others.ru_utime + others.ru_stime


def spent(call, repetitions=1):
    """Seconds of the processor for a call."""
    start = time.process_time()
    for _ in range(repetitions):
        call()
    return (time.process_time() - start) / repetitions


def in_process(task, **environment):
    """Seconds of the processor for a task in a process of its own, after a first call."""
    name = task.__name__
    program = f"import speed; call = speed.{name}(); call(); print(speed.spent(call))"
    return float(python(program, **environment)[1])


def python(program, **environment):
    """Seconds of the processor for a Python process, and what it prints."""
    whole = os.environ | {"PYTHONPATH": os.pathsep.join([str(HERE), *sys.path])} | environment
    before = processor_time()
    run = subprocess.run(
        [sys.executable, "-c", program], check=True, capture_output=True, text=True, env=whole
    )
    return processor_time() - before, run.stdout


PLAIN = {"NUMBA_DISABLE_JIT": "1"}
WITHOUT_NUMBA = "import sys; sys.modules['numba'] = None; "
FIRST_ORBIT = "import bouncing_ball_beyond as bb; bb.orbit(bb.Rigid(0.5), amplitude=1.2)"
FIRST_MOTION = (
    "import bouncing_ball_beyond as bb; bb.simulate(bb.Rigid(0.5), amplitude=1.2, impacts=10)"
)


def measured() -> dict[str, float]:
    """Medians of seconds by the names of tasks."""
    quick = [one_impact, two_impacts, one_contact, two_contacts, doublings]
    quick += [bare_one_impact, bare_two_impacts]
    slow = [rigid_rows, doubled_rows, contact_rows, whole_cascade, settling_motion]
    slow += [long_rigid_motion, long_contact_motion, tsuji_motion, tsuji_balls]
    slow += [rigid_basins, contact_basins, linear_thresholds, linear_limits, linear_orbit]
    slow += [hertzian_of_impact, tsuji_orbit, tsuji_limits, tsuji_branch, integrated_branch]
    plain = [rigid_motion, contact_motion, many_rigid_balls, many_contact_balls, settling_motion]
    plain += [rigid_basins]
    if find_spec("heyoka"):
        slow.append(taylor_motion)
    calls = {task: task() for task in (*quick, *slow)}
    for call in calls.values():
        call()
    times: dict[str, list[float]] = {}

    def note(name, seconds):
        times.setdefault(name, []).append(seconds)

    with tempfile.TemporaryDirectory() as here:
        runs = {}
        if auto_folder():
            for start in (one_impact, two_impacts):
                folder = Path(here, start.__name__)
                folder.mkdir()
                runs[start] = AutoRun(folder, start()().orbits[0])
        for i in range(ROUNDS):
            for task in quick:
                note(task.__name__, spent(calls[task], 10))
            for start, run in runs.items():
                own, whole = zip(*(run.branch() for _ in range(20)), strict=True)
                note(f"auto {start.__name__}", median(own))
                note(f"auto process {start.__name__}", median(whole))
                found = run.points()
                times[f"auto points {start.__name__}"] = [len(found)]
                times[f"auto doubling {start.__name__}"] = [r[4] for r in found if r[2] == 7]
            for run in list(runs.values())[1:]:
                note("auto curve", run.curve()[0])
                times["auto points curve"] = [len(run.points())]
            for task in slow:
                note(task.__name__, spent(calls[task]))
            for task in plain:
                note(f"plain {task.__name__}", in_process(task, **PLAIN))
            for threads in ("1", "2"):
                limits = {"OMP_NUM_THREADS": threads, "OPENBLAS_NUM_THREADS": threads}
                note(f"threads {threads}", in_process(many_impacts, **limits))
            note("nothing", python("")[0])
            note("numpy", python("import numpy")[0])
            note("import", python("import bouncing_ball_beyond")[0])
            note("first orbit", python(FIRST_ORBIT)[0])
            note("first motion", python(FIRST_MOTION)[0])
            note("plain first motion", python(WITHOUT_NUMBA + FIRST_MOTION)[0])
            if i == 0:
                note("chaotic_basins", spent(chaotic_basins()))
                note("tsuji_thresholds", spent(tsuji_thresholds()))
                note("tsuji_basins", spent(tsuji_basins()))
                cache = str(Path(here, "cache"))
                note("compiling", python(FIRST_MOTION, NUMBA_CACHE_DIR=cache)[0])
    return {name: median(each) for name, each in times.items()}


def shares(call) -> tuple[float, float]:
    """Which parts of a call go into Newton's method, and into locating special orbits."""
    profile = cProfile.Profile()
    for _ in range(20):
        profile.runcall(call)
    stats = pstats.Stats(profile)
    cumulative = {}
    for (_, _, name), row in stats.stats.items():
        cumulative[name] = cumulative.get(name, 0.0) + row[3]
    return cumulative["newton"] / stats.total_tt, cumulative["located"] / stats.total_tt


# The page.


def said(seconds):
    """A time with its unit."""
    units = [(1.0, "s"), (1e-3, "ms"), (1e-6, "µs")]
    scale, unit = next((each for each in units if seconds >= 0.95 * each[0]), units[-1])
    value = seconds / scale
    return f"{value:.0f} {unit}" if value >= 100 else f"{value:.2g} {unit}"


def table(head: list[str], rows: list[list[str]]) -> str:
    """A table in Markdown."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def branches_table(t) -> str:
    rows = []
    cases = [
        (one_impact, bare_one_impact, "1 impact, r = 0.5, Λ from 1.3 to 1.8"),
        (two_impacts, bare_two_impacts, "2 impacts, r = 0.5, Λ from 1.6 to 1.8"),
        (one_contact, None, "1 impact, ϖ = 20, r = 0.65, Λ from 0.8 to 1.3"),
        (two_contacts, None, "2 impacts, ϖ = 20, r = 0.65, Λ from 1.3 to 1.4"),
    ]
    for task, bare, text in cases:
        name = task.__name__
        ours = f"{said(t[name])} ({len(task()())} orbits)"
        numpy = f"{said(t[bare.__name__])} ({len(bare()())} orbits)" if bare else "–"
        auto = "–"
        if f"auto {name}" in t:
            auto = f"{said(t[f'auto {name}'])} ({t[f'auto points {name}']:.0f} orbits)"
        rows.append([text, ours, numpy, auto])
    ours = f"{said(t['doublings'])} ({len(doublings()())} orbits)"
    auto = f"{said(t['auto curve'])} ({t['auto points curve']:.0f})" if "auto curve" in t else "–"
    rows.append(["doublings of the 2 impacts, r from 0.5 to 0.8", ours, "–", auto])
    return table(["branch", "`follow`", "bare numpy", "AUTO-07p, compiled"], rows)


def auto_text(t) -> str:
    if "auto one_impact" not in t:
        return "AUTO-07p was not measured: no built copy was found."
    worst = max(
        abs(t[f"auto doubling {task.__name__}"] - task()().first("period doubling").amplitude)
        for task in (one_impact, two_impacts)
    )
    faster = t["one_impact"] / t["auto one_impact"], t["two_impacts"] / t["auto two_impacts"]
    curve = t["doublings"] / t["auto curve"]
    processes = said(t["auto process one_impact"]), said(t["auto process two_impacts"])
    return f"""AUTO-07p is used in its map mode (IPS = -1): it iterates the return map, compiled
from [a page of Fortran](speed.f90) with its derivatives, says of each orbit whether it is stable,
and finds where it doubles. The time is that of its own clock, of the processor; with the start of
its process a branch takes {processes[0]} and {processes[1]}. By its own clock AUTO is
{faster[0]:.1f} and {faster[1]:.1f} times faster than `follow` on the branches, and {curve:.1f}
times faster than `special_curve` on the curve of doublings. The doublings of both differ by less
than {math.ceil(worst * 1e11):.0f}·10⁻¹¹, and AUTO writes eleven digits. What one pays is a map and
its derivatives in Fortran for each kind of ball, without the grazings of flights."""


def page(t) -> str:
    newton, located = shares(two_impacts())
    ratio = t["two_impacts"] / t["bare_two_impacts"]
    threads = t["threads 2"] / t["threads 1"]
    many = [
        ["1 impact, r from 0.45 to 0.55", "rigid_rows", "one_impact"],
        ["2 impacts, from the doublings of these", "doubled_rows", "two_impacts"],
        ["1 impact, ϖ = 20, r from 0.6 to 0.7", "contact_rows", "one_contact"],
    ]
    side = [[text, said(t[rows] / ROWS), said(t[one])] for text, rows, one in many]
    motions = [
        [
            "one ball, r = 0.85",
            said(t["plain rigid_motion"] / 2000),
            said(t["long_rigid_motion"] / 1e5),
        ],
        [
            "one ball, ϖ = 20, r = 0.85",
            said(t["plain contact_motion"] / 2000),
            said(t["long_contact_motion"] / 1e5),
        ],
        ["10⁴ balls, r = 0.85", said(t["plain many_rigid_balls"] / 2e5), "–"],
        ["10⁴ balls, ϖ = 20, r = 0.85", said(t["plain many_contact_balls"] / 2e5), "–"],
        ["one ball, Tsuji's law", said(t["tsuji_motion"] / 50), "–"],
        ["1000 balls, Tsuji's law", said(t["tsuji_balls"] / 2e4), "–"],
    ]
    laws = [
        ["a 1-T orbit", said(t["linear_orbit"]), said(t["tsuji_orbit"])],
        ["its `limits`", said(t["linear_limits"]), said(t["tsuji_limits"])],
        ["a branch", said(t["one_contact"]), said(t["tsuji_branch"])],
        ["six `error_thresholds`", said(t["linear_thresholds"]), said(t["tsuji_thresholds"])],
    ]
    first = [
        ["Python alone", said(t["nothing"])],
        ["`import numpy`", said(t["numpy"])],
        ["`import bouncing_ball_beyond`", said(t["import"])],
        ["the import and a first orbit", said(t["first orbit"])],
        ["the import and a first motion, if numba is not installed", said(t["plain first motion"])],
        ["the import and a first motion, compiled before", said(t["first motion"])],
        ["the first motion ever, which numba compiles", said(t["compiling"])],
    ]
    if "taylor_motion" in t:
        taylor, plain = t["taylor_motion"], t["plain settling_motion"]
        errors = taylor_motion()(), settling_motion()()
        heyoka = f"""heyoka, a Taylor integrator with detection of events that compiles itself,
follows a ball with ϖ = 20 and r = 0.85 for 300 impacts in {said(taylor)}, with one terminal event
in each phase. `simulate` takes {said(plain)} without numba and {said(t["settling_motion"])} with
it. The ball settles on the 1-T orbit, whose speed heyoka has in the end to {errors[0]:.0e} and
`simulate` to {errors[1]:.0e}. The compilations of both are not counted. heyoka integrates any
force; `simulate` uses the closed form of this contact."""
    else:
        heyoka = "heyoka was not measured: it is not installed."
    call = spent(motion(bb.Rigid(0.85), 1), 20)
    system = f"{platform.machine()}, Python {platform.python_version()}, numpy {np.__version__}"
    return f"""# How fast, side by side

`make speed` renews this page. All times are times of the processor, medians of {ROUNDS} rounds in
which everything is measured in turn, with one thread ({system}). Other work ran on the machine;
processor times then vary by a factor of two from one day to another, and their ratios vary less.

## One branch

{branches_table(t)}

`follow` finds and corrects all special orbits, and says of each orbit whether it is stable and
whether a ball follows it. The bare numpy is a loop of forty lines in
[the script of this page](speed.py): the same equations, Newton's method along a tangent, and
nothing else, so that it can make longer steps. It is {ratio:.1f} times faster on the branch with
two impacts. There {100 * newton:.0f} % of the time of `follow` are Newton's method, and
{100 * located:.0f} % are the location of special orbits, which uses Newton's method as well. The
rest are the tests for special orbits at each step, and the work for a row of branches that has only
one here.

{auto_text(t)}

## Many branches side by side

{table([f"{ROWS} branches, with special orbits", "each", "alone"], side)}

"Alone" is the first table; for two impacts it starts from an orbit and not from the doubling, next
to which steps are short.

A cascade from 2 to 64 impacts takes {said(t["whole_cascade"])}. Its last branch, of 64 impacts,
takes {said(t["threads 1"])} with one thread of BLAS, and {said(t["threads 2"])} of the processor
with two, {threads:.2g} times as long.

## Contacts without a closed form

{table(["one ball", "ϖ = 20, r = 0.65", "Tsuji's law"], laws)}

Each residual of Tsuji's contact is an integration, with its derivatives. The branch of the linear
contact takes {said(t["integrated_branch"])} if its motion is integrated in place of the closed
form. `limits` follow an orbit both ways. To find the law of a given r and duration takes
{said(t["hertzian_of_impact"])} more, once. The thresholds of Tsuji's contact were measured once.

## Motions

{table(["an impact of", "without numba", "with numba"], motions)}

These balls are at Λ = 2. One ball is a loop over scalars, which numba compiles if it is installed;
many balls are arrays, for which numba is of little use. A call takes {said(call)} beside its
impacts, to check the arguments and to label the result. Tsuji's contact has no closed form and is
integrated by steps on arrays, which are made for many balls: one alone is slow.

{heyoka}

A basin of 100 × 100 starts takes {said(t["rigid_basins"])} for r = 0.5 at Λ = 1.2
({said(t["plain rigid_basins"])} without numba), and {said(t["contact_basins"])} for ϖ = 20. At
Λ = 1.6, where two thirds of the balls of r = 0.5 are chaotic and are followed for 2000 impacts,
it takes {said(t["chaotic_basins"])}, measured once. Tsuji's ball takes {said(t["tsuji_basins"])}
for 30 × 30 starts at Λ = 1.2: contacts that swing once are a map of polynomials there, and the
others are integrated together.

## The first second

{table(["a new process", "time"], first)}

`import bouncing_ball_beyond` imports nothing else; the first call imports what it needs. Numba
keeps what it has compiled for later processes.
"""


def main() -> None:
    times = measured()
    for name, seconds in times.items():
        print(name, seconds)
    (HERE / "speed.md").write_text(page(times), encoding="utf-8")


if __name__ == "__main__":
    main()

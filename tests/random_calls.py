"""Random calls of all public functions, over the whole ranges of their arguments and beyond.

Run as ``python tests/random_calls.py SEED FIRST LAST`` it prints one line for each call that is not
answered or refused as it should be, and the counts of all outcomes.
"""

import contextlib
import inspect
import io
import itertools
import signal
import sys
import time
import traceback
import warnings
from collections import Counter
from enum import StrEnum
from typing import Any, NamedTuple

import numpy as np
from random_arguments import Draw

import bouncing_ball as bb

# Seconds of processor time after which a call is ended.
MOST = 6.0


class Outcome(StrEnum):
    """How a call ends."""

    ANSWER = "answer"
    REFUSAL = "refusal"
    NO_ANSWER_SOON = "ended without an answer"
    SPOKEN = "writes to standard error"
    WARNING = "warning"
    TRACEBACK = "traceback"


BAD = {Outcome.SPOKEN, Outcome.WARNING, Outcome.TRACEBACK}


class Result(NamedTuple):
    """The outcome of a call, its processor time in seconds, and the call as text."""

    outcome: Outcome
    seconds: float
    call: str
    message: str


class TimeOver(BaseException):
    """No error, so that no call takes it for one."""


def simulate(draw: Draw) -> Any:
    arguments = draw.start() | draw.some(impacts=lambda: draw.count(1, 100_000))
    return draw.call("simulate", draw.ball(), amplitude=draw.amplitude(), **arguments)


def sampled(draw: Draw) -> dict[str, Any]:
    return draw.some(
        periods=lambda: draw.number(0.01, 10_000), samples=lambda: draw.count(1, 100_000)
    )


def history(draw: Draw) -> Any:
    arguments = draw.start() | sampled(draw)
    return draw.call("history", draw.ball(), amplitude=draw.amplitude(), **arguments)


def drop(draw: Draw) -> Any:
    arguments = sampled(draw) | draw.some(amplitude=draw.amplitude, phase=draw.state)
    return draw.call("drop", draw.ball(), height=draw.number(1e-3, 1e4), **arguments)


def orbit(draw: Draw) -> Any:
    arguments = draw.family() | draw.some(side=lambda: draw.pick("stable", "unstable"))
    found = draw.call("orbit", draw.ball(), amplitude=draw.amplitude(), **arguments)
    if hasattr(found, "multipliers"):
        for use in (found.multipliers, found.is_admissible, found.defect, found.__repr__):
            use()
        found.path(np.linspace(0.0, 7.0, 5))
    return found


def orbits(draw: Draw) -> Any:
    return draw.call("orbits", draw.ball(), amplitude=draw.amplitude(), **draw.family())


def limits(draw: Draw) -> Any:
    return draw.call("limits", draw.ball(), **draw.family())


def branch(draw: Draw) -> Any:
    arguments = draw.family() | draw.some(
        amplitude_max=lambda: draw.number(0.1, 1e4), points=lambda: draw.count(10, 10_000)
    )
    return draw.call("branch", draw.ball(), **arguments)


def permanent_contact(draw: Draw) -> Any:
    return draw.call("permanent_contact", draw.ball())


def error_thresholds(draw: Draw) -> Any:
    ball = draw.call("rigid", restitution=draw.share())
    arguments = draw.family() | draw.some(
        tolerance=lambda: draw.number(1e-9, 1.0),
        quantities=lambda: [draw.pick("max_height", "phase", "saddle_node")],
        release=lambda: draw.pick("displacement", "force"),
    )
    return draw.call("error_thresholds", ball, amplitude=draw.amplitude(), **arguments)


def followed(draw: Draw) -> dict[str, Any]:
    return draw.some(impacts=lambda: draw.count(10, 100_000))


def motion_of(draw: Draw) -> Any:
    arguments = draw.start() | followed(draw)
    return draw.call("motion_of", draw.ball(), amplitude=draw.amplitude(), **arguments)


def lyapunov_exponent(draw: Draw) -> Any:
    arguments = draw.start() | followed(draw)
    return draw.call("lyapunov_exponent", draw.ball(), amplitude=draw.amplitude(), **arguments)


def orbit_diagram(draw: Draw) -> Any:
    low = draw.number(0.1, 5.0)
    if isinstance(low, float):
        low = [low, low + draw.random.random()]
    arguments = followed(draw) | draw.some(
        starts=lambda: draw.count(1, 1000), samples=lambda: draw.count(1, 1000)
    )
    return draw.call("orbit_diagram", draw.ball(), amplitudes=low, **arguments)


def basins(draw: Draw) -> Any:
    arguments = followed(draw) | draw.some(
        starts=lambda: draw.count(1, 1000), velocity_max=lambda: draw.number(1e-3, 1e3)
    )
    return draw.call("basins", draw.ball(), amplitude=draw.amplitude(), **arguments)


def orbit_of_motion(draw: Draw) -> Any:
    arguments = draw.start() | followed(draw)
    return draw.call("orbit_of_motion", draw.ball(), amplitude=draw.amplitude(), **arguments)


KINDS = "saddle-node", "period doubling", "grazing of a flight", "grazing of a release"
ACROSS = "frequency_ratio", "restitution", "damping_ratio", "stiffness", "damping"


def branch_of_an_orbit(draw: Draw) -> Any:
    start = orbit_of_motion(draw) if draw.is_odd(0.3) else orbit(draw)
    names = ("amplitude", "amplitude", "frequency_ratio", "restitution", "damping_ratio")
    arguments = draw.some(
        along=lambda: draw.pick(*names, "stiffness", "damping"),
        points=lambda: draw.count(10, 10_000),
    )
    return draw.call("follow", start, **arguments, **end(draw))


def end(draw: Draw) -> dict[str, Any]:
    return {"to": draw.number(0.1, 10.0)} if draw.random.random() < 0.8 else {}


def follow(draw: Draw) -> Any:
    """The branch of an orbit, or a branch or a curve from a special orbit."""
    way = draw.random.random()
    if way < 0.6:
        return branch_of_an_orbit(draw)
    start = special(draw, draw.pick(*KINDS))
    if way < 0.8:
        return draw.call("follow", start, **end(draw))
    ranges = {"amplitude": limits_of(draw)} if draw.random.random() < 0.5 else {}
    across = draw.pick(*ACROSS)
    return draw.call("follow", start, along=("amplitude", across), ranges=ranges)


def limits_of(draw: Draw) -> tuple[Any, Any]:
    """The range of a parameter on a curve."""
    return draw.number(0.01, 1.0), draw.number(1.0, 100.0)


def switch(draw: Draw) -> Any:
    return draw.call("switch", special(draw, "period doubling"))


def special(draw: Draw, kind: Any) -> Any:
    """A special orbit of a branch, or a wrong start."""
    found = branch_of_an_orbit(draw)
    if draw.is_odd(0.05):
        return next(iter(found.states()))
    try:
        return found.first(kind)
    except (ValueError, TypeError, LookupError) as error:
        raise ValueError(str(error)) from None


def curve(draw: Draw) -> Any:
    kind = draw.pick(*KINDS)
    arguments = draw.some(
        along_range=lambda: limits_of(draw),
        across_range=lambda: limits_of(draw),
        points=lambda: draw.count(10, 10_000),
    )
    across = draw.pick(*ACROSS)
    start = special(draw, kind)
    return draw.call("curve", start, kind=kind, across=across, **arguments)


def _of_table(draw: Draw) -> dict[str, Any]:
    return {
        "frequency": draw.text("Hz", 0.1, 1e5),
        "acceleration": draw.text("g", 0.05, 50.0),
    } | draw.some(gravity=lambda: draw.text("m/s^2", 1e-3, 1e3))


def _of_contact(draw: Draw, *, stiff: bool) -> dict[str, Any]:
    found = {"mass": draw.text("kg", 1e-6, 1e3), draw.loss(): draw.share()}
    match draw.random.integers(4) if stiff else 9:
        case 0 | 1:
            found["stiffness"] = draw.text("N/m", 1.0, 1e12)
        case 2:
            found["contact_time"] = draw.text("s", 1e-7, 1.0)
        case 3:
            found["reduced_modulus"] = draw.text("Pa", 1e4, 1e12)
            found["radius"] = draw.text("m", 1e-5, 1.0)
    return found | draw.some(release=lambda: draw.pick("displacement", "force"))


def _of_question(draw: Draw) -> dict[str, Any]:
    return draw.family() | draw.some(
        tolerance=lambda: draw.number(1e-6, 1.0),
        quantity=lambda: draw.pick("max_height", "phase", "saddle_node", "bounce_velocity"),
        balls=lambda: draw.count(1, 100_000),
    )


ENGINES = "generic", "mujoco", "lammps", "liggghts", "pybullet", "drake", "mercurydpm"


def _of_engine(draw: Draw) -> dict[str, Any]:
    return {"engine": draw.pick(*ENGINES)} | draw.some(
        time_step=lambda: draw.text("s", 1e-8, 0.1), restitution_error=lambda: draw.number(1e-6, 1)
    )


def describe_contact(draw: Draw) -> Any:
    if draw.random.random() < 0.5:
        width = ["0.9", "0.95", "0.001", "0.5", "2"][: 1 + draw.random.integers(5)]
        given = {"mass": draw.text("kg", 1e-3, 1e3), "from_engine": "mujoco"}
        given["solref"] = f"-{draw.number(1, 1e8)} -{draw.number(1e-3, 1e5)}"
        given |= draw.some(solimp=lambda: " ".join(width))
    else:
        given = _of_contact(draw, stiff=True)
    gravity = draw.some(gravity=lambda: draw.text("m/s^2", 1e-3, 1e3))
    return draw.call("describe_contact", made(draw, "Contact", given), **gravity)


def made(draw: Draw, name: str, given: dict[str, Any]) -> Any:
    """A table, a contact, a question or the setup of an engine."""
    return draw.call(name, **given)


def assess_contact(draw: Draw) -> Any:
    table = made(draw, "Table", _of_table(draw))
    contact = made(draw, "Contact", _of_contact(draw, stiff=True))
    return draw.call("assess_contact", table, contact, made(draw, "Question", _of_question(draw)))


def choose_contact(draw: Draw) -> Any:
    table = made(draw, "Table", _of_table(draw))
    contact = made(draw, "Contact", _of_contact(draw, stiff=False))
    return draw.call("choose_contact", table, contact, made(draw, "Question", _of_question(draw)))


def write_contact(draw: Draw) -> Any:
    contact = made(draw, "Contact", _of_contact(draw, stiff=True))
    setup = made(draw, "EngineSetup", _of_engine(draw))
    table = made(draw, "Table", _of_table(draw)) if draw.random.random() < 0.5 else None
    return draw.call("write_contact", contact, setup, table)


def fit_contact(draw: Draw) -> Any:
    count = draw.random.choice((1, 2, 3, 8))
    arguments = draw.some(
        durations=lambda: draw.number(1e-6, 1.0),
        uncertainties=lambda: draw.number(1e-6, 0.5),
        mass=lambda: draw.number(1e-6, 1e3),
        laws=lambda: [draw.pick("tsuji", "kuwabara-kono", "hunt-crossley", "linear")],
    )
    points = [draw.number(1e-3, 1e3) for _ in range(count)], [draw.share() for _ in range(count)]
    return draw.call("fit_contact", *points, **arguments)


CALLS = (
    simulate, history, drop, orbit, orbits, limits, branch, permanent_contact, error_thresholds,
    motion_of, lyapunov_exponent, orbit_diagram, basins, orbit_of_motion, follow, switch, curve,
    describe_contact, assess_contact, choose_contact, write_contact,
    fit_contact,
)  # fmt: skip
"""A function for each public function, which draws its arguments and calls it."""
QUICK = (orbit, limits, permanent_contact, error_thresholds, write_contact)


def result(seed: int, number: int, calls: Any = CALLS, most: float = MOST) -> Result:
    """The outcome of one random call."""
    draw = Draw(seed, number)
    spoken = io.StringIO()
    call = calls[number % len(calls)]
    start = time.process_time()
    outcome = Outcome.ANSWER
    message = ""

    def over(*_: Any) -> None:
        if time.process_time() - start > most:
            raise TimeOver

    signal.signal(signal.SIGPROF, over)
    signal.setitimer(signal.ITIMER_PROF, 0.5, 0.5)
    try:
        with contextlib.redirect_stderr(spoken), warnings.catch_warnings():
            warnings.simplefilter("error")
            call(draw)
    except Warning as error:
        outcome = Outcome.WARNING
        message = f"{error!r} {_place(error)}"
    except ValueError as error:
        message = str(error)
        of_package = type(error).__name__ in {"ParameterError", "ModelError", "NoOrbitError"}
        proper = of_package or error.__suppress_context__
        outcome = Outcome.REFUSAL if proper and "\n" not in message else Outcome.TRACEBACK
        message += "" if outcome is Outcome.REFUSAL else f" {_place(error)}"
    except TimeOver as error:
        outcome = Outcome.NO_ANSWER_SOON
        message = _place(error)
    except Exception as error:
        outcome = Outcome.TRACEBACK
        message = f"{error!r} {_place(error)}"
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
    if spoken.getvalue():
        outcome = Outcome.SPOKEN
        message = spoken.getvalue()
    return Result(outcome, time.process_time() - start, "; ".join(draw.said), message)


def _place(error: BaseException) -> str:
    frames = traceback.extract_tb(error.__traceback__)
    ours = [f for f in frames if "bouncing_ball" in f.filename]
    last = ours[-4:] or frames[-2:]
    return " < ".join(f"{f.filename.rpartition('/')[2]}:{f.lineno}" for f in reversed(last))


def uncovered() -> set[str]:
    """The public functions that no random call calls."""
    functions = {name for name in bb.__all__ if inspect.isfunction(getattr(bb, name))}
    makers = {"rigid", "spring_damper", "contact_law", "corrected"}
    # It takes the path of a file and no numbers: tests/drawing/test_figures_of_files.py.
    readers = {"open"}
    return functions - makers - readers - {call.__name__ for call in CALLS}


def main(seed: int, first: int, last: int) -> None:
    """Print the outcomes of the calls of a seed from the first to before the last."""
    counts: Counter = Counter()
    for number in itertools.count(first):
        if number >= last:
            break
        found = result(seed, number)
        counts[found.outcome] += 1
        if found.outcome in BAD | {Outcome.NO_ANSWER_SOON} or found.seconds > MOST / 3:
            print(seed, number, *found, sep=" | ", flush=True)
    print(dict(counts), flush=True)


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))

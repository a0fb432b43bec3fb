"""Random attacks on the project, each for its share of the time: make attack.

    python tests/attack [--seconds 600] [--seed N] [--table FILE] [name ...]

An attack is a module of this folder whose docstring's first line says what it
does to what, with one function

    attack(seed: int) -> Iterator[list[str]]

that tries one or more cases at a time, and yields an empty text for each that held
and for one that fell a line from which it can be repeated. It runs in a process of
its own until its time is over; one that does not end, or tries nothing, fell.
"""

import argparse
import ast
import contextlib
import json
import os
import signal
import subprocess
import sys
import time
from dataclasses import dataclass
from datetime import date
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
# An attack looks at the clock between two cases; a case of a pipeline takes its time.
GRACE = 120.0
SHOWN = 10


@dataclass(frozen=True)
class Outcome:
    """What became of one attack."""

    name: str
    tried: int
    fallen: tuple[str, ...]

    @property
    def held(self) -> int:
        return max(0, self.tried - len(self.fallen))

    def row(self) -> str:
        numbers = f"{self.tried} | {self.held} | {len(self.fallen)}"
        return f"| {self.name} | {title(self.name)} | {numbers} |"


def attacks() -> list[str]:
    """Names of all attacks: the modules of this folder."""
    paths = sorted(HERE.glob("[a-z]*.py"))
    return [path.stem for path in paths if not path.stem.startswith(("test_", "conftest"))]


def title(name: str) -> str:
    """The first line of an attack's docstring, without its stop."""
    tree = ast.parse((HERE / f"{name}.py").read_text(encoding="utf-8"))
    return (ast.get_docstring(tree) or name).splitlines()[0].rstrip(".")


def shown(fallen: tuple[str, ...]) -> list[str]:
    """The first of many."""
    more = [f"and {len(fallen) - SHOWN} more"] if len(fallen) > SHOWN else []
    return [*fallen[:SHOWN], *more]


def run_here(name: str, seed: int, seconds: float) -> tuple[int, list[str]]:
    """One attack in this process: how many cases it tried, and those that fell."""
    spec = spec_from_file_location(f"attack_{name}", HERE / f"{name}.py")
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    # What the attacked code prints is not a result.
    with contextlib.redirect_stdout(sys.stderr):
        tried, fallen, end = 0, [], time.monotonic() + seconds
        with contextlib.closing(module.attack(seed)) as cases:
            for verdicts in cases:
                tried += len(verdicts)
                fallen += filter(None, verdicts)
                if time.monotonic() > end:
                    break
    return tried, fallen


def run(name: str, seed: int, seconds: float) -> Outcome:
    """One attack in a process of its own, which is ended when it does not end."""
    command = [sys.executable, str(HERE), "--here", "--seed", str(seed), "--seconds", f"{seconds}"]
    with subprocess.Popen(
        [*command, name],
        cwd=ROOT,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    ) as process:
        try:
            out, err = process.communicate(timeout=seconds + GRACE)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            return Outcome(name, 1, (f"seed {seed}: no end {GRACE:g} s after its time",))
    if process.returncode != 0:
        last = err.strip().splitlines()[-1:] or ["no message"]
        return Outcome(name, 1, (f"seed {seed}: ended with {process.returncode}: {last[0]}",))
    tried, fallen = json.loads(out)
    if not tried:
        return Outcome(name, 0, (f"seed {seed}: nothing was tried in {seconds:.3g} s",))
    return Outcome(name, tried, tuple(fallen))


def git(*arguments: str) -> str:
    done = subprocess.run(
        ["git", *arguments], cwd=ROOT, capture_output=True, text=True, check=False
    )
    return done.stdout.strip() if done.returncode == 0 else "unknown"


def page(outcomes: list[Outcome], seed: int, seconds: float) -> str:
    """The result for the documentation."""
    commit = git("rev-parse", "HEAD")
    if git("status", "--porcelain", "--untracked-files=no"):
        commit += " with changes"
    lines = [
        "# Attacks",
        "",
        "Written by `make attack`, which tries random cases for ten minutes and fails if one of",
        "them falls; the modules are in [tests/attack](../tests/attack).",
        "",
        f"{date.today().isoformat()}, commit {commit}, seed {seed}, {seconds:.0f} s.",
        "",
        "| attack | what | tried | held | fallen |",
        "| --- | --- | ---: | ---: | ---: |",
        *(outcome.row() for outcome in outcomes),
    ]
    fallen = [f"- {one.name}: `{line}`" for one in outcomes for line in shown(one.fallen)]
    if fallen:
        lines += ["", "Fallen:", "", *fallen]
    return "\n".join(lines) + "\n"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", metavar="name", help=", ".join(attacks()))
    parser.add_argument("--seconds", type=float, default=600.0, help="for all together")
    parser.add_argument("--seed", type=int, default=int(time.time()), help="of all of them")
    parser.add_argument("--table", type=Path, help="write the result to this Markdown file")
    parser.add_argument("--here", action="store_true", help=argparse.SUPPRESS)
    options = parser.parse_args()
    names = options.names or attacks()
    unknown = sorted(set(names) - set(attacks()))
    if unknown:
        parser.error(f"unknown attack {', '.join(unknown)}; allowed: {', '.join(attacks())}")
    if options.here:
        print(json.dumps(run_here(names[0], options.seed, options.seconds)))
        return 0
    print(f"seed {options.seed}, {options.seconds:g} s for {len(names)} attacks", flush=True)
    end = time.monotonic() + options.seconds
    outcomes = []
    for left, name in zip(range(len(names), 0, -1), names, strict=True):
        share = max(0.0, end - time.monotonic()) / left
        outcome = run(name, options.seed, share)
        outcomes.append(outcome)
        counts = f"{outcome.tried:8} tried {outcome.held:8} held {len(outcome.fallen):6} fallen"
        print(f"{name:16}{counts}", *shown(outcome.fallen), sep="\n    ", flush=True)
    if options.table:
        options.table.write_text(page(outcomes, options.seed, options.seconds), encoding="utf-8")
    return int(any(outcome.fallen for outcome in outcomes))


if __name__ == "__main__":
    sys.exit(main())

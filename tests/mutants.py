"""Do the tests notice a wrong line?  ``make mutants``

Single faults are put into modules as these are imported, one at a time. First ``make quick``
runs without a fault, and each test is noted with the functions that it calls. A fault meets the
tests in three rounds: those beside it that reach its function, those elsewhere that reach it, and
those beside it that do not, because a cache may hide that they do. All faults are tried in a round
before the next one, which takes longer. A fault is noticed if one of the tests fails, or if one
hangs: this is said apart, and it is judged by processor time, so that other programs on the machine
do not matter. What survives is listed: it changes nothing, for a reason that stands in
``equivalent_faults.yaml``, or a test is missing.

A whole run takes hours. What is decided is kept in ``results/mutants``, and the same command goes
on from there, as long as neither the package nor the tests change.

usage: python tests/mutants.py [--count 200] [--seed 2011] [--workers 2] [--only PART ...]
"""

import argparse
import ast
import hashlib
import importlib
import os
import pickle
import signal
import sys
import time
from collections import ChainMap, Counter, defaultdict
from collections.abc import Iterable, Iterator, Sequence
from enum import Enum, auto
from importlib.machinery import SourceFileLoader
from itertools import islice
from multiprocessing.context import ForkContext, ForkProcess
from pathlib import Path
from types import CodeType, FrameType
from typing import Any, NamedTuple

import pytest
import yaml
from hypothesis import Phase, settings

ROOT = Path(__file__).parents[1]
PACKAGE = Path("src/bouncing_ball")
# The modules that compute: both sets of studies with what they stand on, and the comparison with
# the record, but no pictures.
COMPUTING = (
    "numerics", "models", "periodic", "long_run", "accuracy", "contacts", "paper", "beyond",
    "pipeline/diff",
)  # fmt: skip
PICTURES = "*figures.py"
# Folders whose folders are tried one by one, because they have many tests.
SETS = ("paper", "beyond")
QUICK = "not long and not slow and not cluster and not engines and not docs"
# What this does not run: pictures, and runs of the pipeline.
ELSEWHERE = {"tests/drawing", "tests/speed", "tests/workflow"}
# Imported once for all processes.
LIBRARIES = ["matplotlib", "mpmath", "netCDF4", "pint", "pydantic", "scipy.optimize", "xarray"]
# A test hangs that takes this many times the processor time that it takes without a fault, and
# one second more.
LONGER = 20
# A test that waits takes no processor time: it may last this many times as long, and a second more.
WAITING = 600
Functions = set[tuple[str, int]]
# Another operator of the same kind: a sign, an exponent, a border, a condition.
_EXCHANGED = [
    (ast.Add, ast.Sub), (ast.Mult, ast.Div), (ast.BitAnd, ast.BitOr), (ast.And, ast.Or),
    (ast.Eq, ast.NotEq), (ast.Is, ast.IsNot), (ast.In, ast.NotIn),
]  # fmt: skip
_OPERATORS: dict[type, tuple[type, ...]] = {
    **{one: (other,) for pair in _EXCHANGED for one, other in (pair, pair[::-1])},
    ast.Pow: (ast.Mult,),
    ast.Lt: (ast.LtE, ast.Gt),
    ast.LtE: (ast.Lt, ast.Gt),
    ast.Gt: (ast.GtE, ast.Lt),
    ast.GtE: (ast.Gt, ast.Lt),
}
# A function for its neighbour.
_NEIGHBOURS = {
    "sin": "cos", "cos": "sin", "min": "max", "max": "min", "minimum": "maximum",
    "maximum": "minimum", "any": "all", "all": "any", "nanmax": "nanmin", "nanmin": "nanmax",
    "fmax": "fmin", "fmin": "fmax", "argmin": "argmax", "argmax": "argmin",
}  # fmt: skip
_SMALL = 1e-3
NOTICED, HANGS, EQUAL, SURVIVED = "noticed", "hangs", "equal", "SURVIVED"


class Round(Enum):
    """The tests that a fault meets, in order: their name is the end of a fault that survives them,
    until the next round.
    """

    NEAR = auto()
    ELSEWHERE = auto()
    BESIDE = auto()

    def follows(self, end: str) -> bool:
        """Whether a fault with this end, "" for none, meets the tests of this round."""
        earlier = ["", *(one.name for one in Round if one.value < self.value)]
        return end in earlier


WIDTH = max(map(len, Round.__members__))


class Fault(NamedTuple):
    """One fault: its function and its place, what it changes, and the source that has it."""

    function: int
    line: int
    column: int
    before: str
    after: str
    source: str


def faults(source: str) -> list[Fault]:
    """All faults of a module.

    Examples
    --------
    >>> for fault in faults("x = -a if b < 1e-9 else 0"):
    ...     print(fault.before, "→", fault.after)
    b < 1e-09 → b <= 1e-09
    b < 1e-09 → b > 1e-09
    1e-09 → 1e-05
    -a → a
    0 → 1
    """
    tree = ast.parse(source)
    first: dict[int, int] = {}
    # Outer functions come before inner ones; a function begins at its decorators.
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef):
            start = min([node.lineno, *(each.lineno for each in node.decorator_list)])
            first |= dict.fromkeys(range(start, node.end_lineno + 1), start)
    return [
        Fault(
            function=first.get(node.lineno, 0),
            line=node.lineno,
            column=node.col_offset,
            before=ast.unparse(node),
            after=ast.unparse(wrong),
            source=_with(source, node, wrong),
        )
        for node in _computing(tree)
        for wrong in _wrong(node)
    ]


def _computing(node: ast.AST) -> Iterator[ast.AST]:
    """The nodes below one, without annotations, decorators and formatted texts."""
    for name, value in ast.iter_fields(node):
        if name in ("annotation", "returns", "decorator_list", "type_params"):
            continue
        for child in value if isinstance(value, list) else [value]:
            if isinstance(child, ast.AST) and not isinstance(child, ast.JoinedStr):
                # What is zipped has one length: strict=False changes nothing.
                if not (isinstance(child, ast.keyword) and child.arg == "strict"):
                    yield child
                    yield from _computing(child)


def _wrong(node: ast.AST) -> Iterator[ast.expr]:
    """What may stand in a node's place by mistake."""
    match node:
        case ast.BinOp(left, operator, right):
            yield from (ast.BinOp(left, other(), right) for other in _others(operator))
        case ast.BoolOp(operator, values):
            yield from (ast.BoolOp(other(), values) for other in _others(operator))
        case ast.Compare(left, [operator], right):
            yield from (ast.Compare(left, [other()], right) for other in _others(operator))
        case ast.UnaryOp(ast.USub() | ast.Not() | ast.Invert(), operand):
            yield operand
        case ast.Constant(bool(value)):
            yield ast.Constant(not value)
        case ast.Constant(int(value)):
            yield ast.Constant(value + 1)
        case ast.Constant(float(value)):
            yield ast.Constant(value * (1e4 if abs(value) < _SMALL else 1.1) or 1.0)
        case ast.Call(ast.Attribute(_, "isfinite" | "isnan")):
            # A missing value counts as right, or all values are missing.
            yield ast.BinOp(node, ast.BitOr(), ast.Constant(True))
        case ast.Call(ast.Attribute(owner, name), arguments, keywords) if name in _NEIGHBOURS:
            yield ast.Call(ast.Attribute(owner, _NEIGHBOURS[name]), arguments, keywords)
        case ast.Call(ast.Name(name), arguments, keywords) if name in _NEIGHBOURS:
            yield ast.Call(ast.Name(_NEIGHBOURS[name]), arguments, keywords)
        case ast.Call(ast.Attribute(_, "where") as function, [condition, yes, no], []):
            yield ast.Call(function, [condition, no, yes], [])


def _others(operator: ast.AST) -> tuple[type, ...]:
    return _OPERATORS.get(type(operator), ())


def _with(source: str, node: ast.AST, wrong: ast.expr) -> str:
    """The source with one expression in the place of another; its lines stay where they are."""
    lines = source.encode().splitlines(keepends=True)
    start = sum(map(len, lines[: node.lineno - 1])) + node.col_offset
    end = sum(map(len, lines[: node.end_lineno - 1])) + node.end_col_offset
    text = f"({ast.unparse(wrong)}{chr(10) * (node.end_lineno - node.lineno)})"
    return (source.encode()[:start] + text.encode() + source.encode()[end:]).decode()


def sample(count: int, seed: int, only: Sequence[str] = ("",)) -> list[tuple[Path, Fault]]:
    """Faults drawn from all modules that compute, each as likely as another.

    The order is that of a checksum of the fault itself, so that an edit elsewhere leaves
    the sample as it is.
    """
    every = []
    for folder in COMPUTING:
        for path in sorted((ROOT / PACKAGE / folder).rglob("*.py")):
            if path.match(PICTURES):
                continue
            # Equal faults of a module are told apart by their number, or they come together.
            seen: Counter[str] = Counter()
            for fault in faults(path.read_text()):
                name = path.relative_to(ROOT)
                text = f"{seed} {name} {fault.before} {fault.after}"
                seen[text] += 1
                order = hashlib.sha256(f"{text} {seen[text]}".encode()).digest()
                every.append((order, name, fault))
    asked = (each for each in sorted(every) if any(part in str(each[1]) for part in only))
    return [(name, fault) for _, name, fault in islice(asked, count)]


def told(path: Path, fault: Fault) -> str:
    """The place of a fault and what it changes."""
    return f"{path}:{fault.line}:{fault.column}: {fault.before}  →  {fault.after}"


class Reach:
    """A plugin of pytest: the seconds that each test takes, and the functions that it calls.

    A function is the path of its module with its first line; the line 0 stands for the module.
    """

    def __init__(self) -> None:
        self.tests: dict[str, tuple[float, Functions]] = {}
        self._fixtures: dict[str, Functions] = defaultdict(set)

    def _note(self, functions: Functions) -> None:
        def call(frame: FrameType, event: str, argument: object) -> None:
            functions.add((frame.f_code.co_filename, frame.f_code.co_firstlineno))

        sys.settrace(call)

    @pytest.hookimpl(wrapper=True)
    def pytest_fixture_setup(self, fixturedef: Any) -> Iterator[None]:
        # A fixture of a session is set up in one test and used in others.
        outer = sys.gettrace()
        self._note(self._fixtures[fixturedef.argname])
        result = yield
        sys.settrace(outer)
        return result

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item: Any) -> Iterator[None]:
        calls: Functions = set()
        start = time.process_time()
        self._note(calls)
        result = yield
        sys.settrace(None)
        calls.update(*(self._fixtures[name] for name in getattr(item, "fixturenames", ())))
        functions = {(os.path.relpath(name), line) for name, line in calls}
        functions |= {(name, 0) for name, _ in functions}
        self.tests[item.nodeid] = time.process_time() - start, functions
        return result


class Chosen:
    """A plugin of pytest: some tests only, each as long as it may take."""

    def __init__(self, seconds: dict[str, float]) -> None:
        self._seconds = seconds
        self.hung = False

    def pytest_collection(self) -> None:
        # It is enough that a random example fails; it need not be the simplest one.
        settings.register_profile("first", settings(), phases=[Phase.explicit, Phase.generate])
        settings.load_profile("first")
        # A test that hangs is interrupted.
        signal.signal(signal.SIGPROF, self._interrupt)
        signal.signal(signal.SIGALRM, self._interrupt)

    def _interrupt(self, number: int, frame: FrameType | None) -> None:
        self.hung = True
        raise KeyboardInterrupt

    def pytest_collection_modifyitems(self, items: list[Any]) -> None:
        items[:] = [item for item in items if item.nodeid in self._seconds]

    def pytest_runtest_setup(self, item: Any) -> None:
        usual = 1 + self._seconds[item.nodeid]
        signal.setitimer(signal.ITIMER_PROF, LONGER * usual)
        signal.setitimer(signal.ITIMER_REAL, WAITING * usual)


def passes(files: Iterable[str], plugin: Reach | Chosen) -> bool:
    """Whether tests pass, or there are none; in a process of their own."""
    sys.stdout = open(os.devnull, "w")
    # Modules that pytest rewrites would not have the fault.
    options = ["-x", "--assert=plain", "--tb=no", "-p", "no:cacheprovider", "-m", QUICK]
    return pytest.main([*options, *files], [plugin]) in (0, 5)


def parts_of(tree: Path) -> list[str]:
    """Folders and modules whose tests run in one process; each in a set of studies is one."""
    found = []
    for path in tree.iterdir():
        if path.name in SETS:
            found += parts_of(path)
        elif (path.is_dir() or path.suffix == ".py") and str(path) not in ELSEWHERE:
            found.append(str(path))
    return found


def reached(part: str) -> dict[str, tuple[float, Functions]] | None:
    """What the tests of a folder reach; None if they fail."""
    reach = Reach()
    return reach.tests if passes([part], reach) else None


def digest(tree: Path) -> str:
    """A checksum of the package and the tests, which decide about faults; this module does not."""
    found = hashlib.sha256()
    modules = [*(tree / PACKAGE).rglob("*.py"), *(tree / "tests").rglob("*.py")]
    for path in sorted(modules):
        if path != Path(__file__).resolve():
            found.update(f"{path.relative_to(tree)}\n{path.read_text()}".encode())
    return found.hexdigest()[:12]


def traced(pool: Any, kept: Path) -> dict[str, tuple[float, Functions]]:
    """The seconds of each test and the functions that it calls, from a file if it is there."""
    if kept.is_file():
        return pickle.loads(kept.read_bytes())
    parts = sorted(parts_of(PACKAGE) + parts_of(Path("tests")))
    found = dict(zip(parts, pool.map(reached, parts, chunksize=1), strict=True))
    if failed := [part for part, tests in found.items() if tests is None]:
        sys.exit(f"{failed} fail without any fault: see make quick")
    tests = dict(ChainMap(*found.values()))
    temporary = kept.with_suffix(".part")
    temporary.write_bytes(pickle.dumps(tests))
    temporary.replace(kept)
    return tests


def chosen(
    path: Path, fault: Fault, tests: dict[str, tuple[float, Functions]], one: Round
) -> dict[str, float]:
    """The seconds of the tests that a fault meets in a round, in the order of their files.

    Beside it are those of its module and of its folders.
    """
    folder = path.relative_to(PACKAGE).parent
    # The tests of a room's rooms stand in one folder.
    while not Path("tests", folder).is_dir():
        folder = folder.parent
    own = str(path), f"tests/{folder}/test_{path.stem}.py"
    # The tests of all models and laws are in a folder of their own.
    folders = f"tests/{folder}/", "tests/contracts/"
    reaching = {name for name, (_, calls) in tests.items() if (str(path), fault.function) in calls}
    beside = {name for name in tests if name.startswith((*own, *folders))}
    parts = {
        Round.NEAR: reaching & beside,
        Round.ELSEWHERE: reaching - beside,
        Round.BESIDE: beside - reaching,
    }
    found = parts[one]
    spent: Counter[str] = Counter()
    for name in found:
        spent[name.split("::")[0]] += tests[name][0]

    def order(name: str) -> tuple[bool, bool, float]:
        file = name.split("::")[0]
        return name not in reaching, file not in own, spent[file]

    return {name: tests[name][0] for name in sorted(found, key=order)}


def state(work: tuple[Path, Fault, dict[str, float]]) -> tuple[Path, Fault, str]:
    """A fault, and whether tests notice it, one of them hangs, or it survives them."""
    path, fault, seconds = work
    return path, fault, end_of(path, fault, seconds)


def end_of(path: Path, fault: Fault, seconds: dict[str, float]) -> str:
    """Whether tests notice a fault, one of them hangs, or the fault survives them."""
    wrong = str(path.absolute())
    right = SourceFileLoader.get_code

    def get_code(self: SourceFileLoader, name: str) -> CodeType | None:
        if self.path == wrong:
            return compile(fault.source, wrong, "exec", dont_inherit=True)
        return right(self, name)

    SourceFileLoader.get_code = get_code
    files = dict.fromkeys(name.split("::")[0] for name in seconds)
    plugin = Chosen(seconds)
    if not files or passes(files, plugin):
        return SURVIVED
    return HANGS if plugin.hung else NOTICED


def reasons(tree: Path) -> dict[tuple[Path, int, str, str], str]:
    """Why faults change nothing, by module, line and change."""
    found = {}
    for each in yaml.safe_load((tree / "tests" / "equivalent_faults.yaml").read_text()):
        path = PACKAGE / each["module"]
        lines = (tree / path).read_text().splitlines() if (tree / path).is_file() else []
        numbers = [k for k, line in enumerate(lines, start=1) if line.strip() == each["line"]]
        if not numbers:
            sys.exit(f"tests/equivalent_faults.yaml: {path} has no line {each['line']!r}")
        for k in numbers:
            found[path, k, *each["fault"].split(" → ")] = each["because"]
    return found


class Fork(ForkProcess):
    """A process that may start others, as some tests do; a daemon, as those of a pool are, may
    not."""

    @property
    def daemon(self) -> bool:
        return False

    @daemon.setter
    def daemon(self, value: bool) -> None:
        pass


class Forks(ForkContext):
    """Pools of such processes."""

    Process = Fork


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--seed", type=int, default=2011)
    parser.add_argument("--only", nargs="*", default=[""], help="parts of the paths of modules")
    parser.add_argument("--workers", type=int, default=os.cpu_count() or 1)
    options = parser.parse_args()
    drawn = sample(options.count, options.seed, options.only)
    known = reasons(ROOT)
    # Each part and each fault has a process, a fork of this one, which has the libraries.
    os.chdir(ROOT)
    os.environ["OMP_NUM_THREADS"] = "1"
    for name in LIBRARIES:
        importlib.import_module(name)
    kept = ROOT / "results" / "mutants" / digest(ROOT)
    kept.mkdir(parents=True, exist_ok=True)
    with Forks().Pool(options.workers, maxtasksperchild=1) as pool:
        tests = traced(pool, kept / "reached.pickle")
        log = kept / f"{options.seed}.txt"
        decided = log.read_text().splitlines() if log.is_file() else []
        ends = {line[WIDTH:].strip(): line[:WIDTH].strip() for line in decided}
        for one in Round:
            due = [each for each in drawn if one.follows(ends.get(told(*each), ""))]
            work = [(*each, chosen(*each, tests, one)) for each in due]
            for path, fault, end in pool.imap_unordered(state, work):
                if end == SURVIVED and (path, fault.line, fault.before, fault.after) in known:
                    end = EQUAL
                elif end == SURVIVED and one is not Round.BESIDE:
                    end = one.name
                ends[told(path, fault)] = end
                line = f"{end:{WIDTH}} {told(path, fault)}"
                print(line, flush=True)
                with log.open("a") as lines:
                    lines.write(f"{line}\n")
    count = Counter(ends[told(*each)] for each in drawn)
    print(
        f"{len(drawn)} faults: {count[EQUAL]} change nothing, {count[SURVIVED]} survived, "
        f"{count[HANGS]} hang"
    )


if __name__ == "__main__":
    main()

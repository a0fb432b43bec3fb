"""Do the tests notice a wrong line?  ``make mutants``

A sample of single faults is put into copies of the tree, one at a time. The
doctests of the module and the tests of its folder run first, then those of ``make quick``. A fault
is noticed if one of them fails, or hangs. What survives is listed: it changes nothing, or a
test is missing. With ``--near`` only the tests next to the fault run, in a fraction of the time;
what survives it may still be noticed elsewhere.

usage: python tests/mutants.py [--count 200] [--seed 2011] [--near] [--workers 2] [--only PART ...]
"""

import argparse
import ast
import hashlib
import os
import queue
import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from itertools import islice
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[1]
PACKAGE = Path("src/bouncing_ball")
LAYERS = ["contacts", "continuation", "motion", "orbits", "attractors", "accuracy", "studies",
          "claims", "engines", "calculator", "atlas", "compare"]  # fmt: skip
QUICK = "not long and not slow and not cluster and not engines"
# The tests of all models and laws are in a folder of their own.
CONTRACTS = {"contacts", "continuation", "motion", "orbits"}
EVERYTHING = ["src", "tests", "--ignore=tests/workflow", "--ignore=tests/figures"]
# In seconds; some tests take minutes on a busy machine, and only a hang takes this long.
HANGS = 1800
# Another operator of the same kind: a sign, an exponent, a border, a condition.
_OPERATORS: dict[type, tuple[type, ...]] = {
    ast.Add: (ast.Sub,),
    ast.Sub: (ast.Add,),
    ast.Mult: (ast.Div,),
    ast.Div: (ast.Mult,),
    ast.Pow: (ast.Mult,),
    ast.BitAnd: (ast.BitOr,),
    ast.BitOr: (ast.BitAnd,),
    ast.And: (ast.Or,),
    ast.Or: (ast.And,),
    ast.Lt: (ast.LtE, ast.Gt),
    ast.LtE: (ast.Lt, ast.Gt),
    ast.Gt: (ast.GtE, ast.Lt),
    ast.GtE: (ast.Gt, ast.Lt),
    ast.Eq: (ast.NotEq,),
    ast.NotEq: (ast.Eq,),
    ast.Is: (ast.IsNot,),
    ast.IsNot: (ast.Is,),
    ast.In: (ast.NotIn,),
    ast.NotIn: (ast.In,),
}
# A function for its neighbour.
_NEIGHBOURS = {
    "sin": "cos", "cos": "sin", "min": "max", "max": "min", "minimum": "maximum",
    "maximum": "minimum", "any": "all", "all": "any", "nanmax": "nanmin", "nanmin": "nanmax",
    "fmax": "fmin", "fmin": "fmax", "argmin": "argmax", "argmax": "argmin",
}  # fmt: skip
_SMALL = 1e-3


class Fault(NamedTuple):
    """One fault: where it is, what it changes, and the source that has it."""

    line: int
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
    return [
        Fault(node.lineno, ast.unparse(node), ast.unparse(wrong), _with(source, node, wrong))
        for node in _computing(ast.parse(source))
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
    """Faults drawn from all modules of the layers, each as likely as another.

    The order is that of a checksum of the fault itself, so that an edit elsewhere leaves
    the sample as it is.
    """
    every = []
    for layer in LAYERS:
        for path in sorted((ROOT / PACKAGE / layer).rglob("*.py")):
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


def passes(tree: Path, *tests: str) -> bool:
    """Whether tests pass in a copy of the tree; one that collects nothing passes."""
    command = [sys.executable, "-m", "pytest", "-q", "-x", "-p", "no:cacheprovider", "-m", QUICK]
    environment = {**os.environ, "PYTHONPATH": str(tree / "src"), "OMP_NUM_THREADS": "1",
                   "PYTHONDONTWRITEBYTECODE": "1"}  # fmt: skip
    try:
        ended = subprocess.run(
            [*command, *tests], cwd=tree, env=environment, capture_output=True, timeout=HANGS
        )
    except subprocess.TimeoutExpired:
        return False
    return ended.returncode in (0, 5)


def mirror(path: Path) -> list[str]:
    """The folders of the tests next to a module."""
    layer = path.relative_to(PACKAGE).parts[0]
    return [f"tests/{layer}", *(["tests/contracts"] if layer in CONTRACTS else [])]


def survives(tree: Path, path: Path, fault: Fault, near: bool) -> bool:
    """Whether no test notices a fault, or none next to it."""
    folders = mirror(path)
    own = [name for name in [f"{folders[0]}/test_{path.stem}.py"] if (tree / name).exists()]
    before = [*folders, "tests/workflow", "tests/figures"]
    right = (tree / path).read_text()
    (tree / path).write_text(fault.source)
    try:
        if not passes(tree, str(path), *own, *folders):
            return False
        return near or passes(tree, "src", "tests", *(f"--ignore={folder}" for folder in before))
    finally:
        (tree / path).write_text(right)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--seed", type=int, default=2011)
    parser.add_argument("--only", nargs="*", default=[""], help="parts of the paths of modules")
    parser.add_argument("--near", action="store_true", help="the tests next to a fault only")
    parser.add_argument("--workers", type=int, default=os.cpu_count() or 1)
    options = parser.parse_args()
    drawn = sample(options.count, options.seed, options.only)
    trees: queue.SimpleQueue[Path] = queue.SimpleQueue()
    with tempfile.TemporaryDirectory() as folder:
        for worker in range(options.workers):
            tree = Path(folder) / str(worker)
            tracked = subprocess.run(
                ["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, check=True, text=True
            ).stdout.split("\0")
            for name in filter(None, tracked):
                (tree / name).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(ROOT / name, tree / name)
            trees.put(tree)
        beside = sorted({folder for path, _ in drawn for folder in mirror(path)})
        if not passes(tree, *(["src", *beside] if options.near else EVERYTHING)):
            sys.exit("the tests fail without any fault: see make quick")

        def tried(drawn_fault: tuple[Path, Fault]) -> bool:
            tree = trees.get()
            try:
                return survives(tree, *drawn_fault, options.near)
            finally:
                trees.put(tree)

        survived = 0
        with ThreadPoolExecutor(options.workers) as pool:
            for (path, fault), alive in zip(drawn, pool.map(tried, drawn), strict=True):
                survived += alive
                state = "SURVIVED" if alive else "noticed "
                print(f"{state} {path}:{fault.line}: {fault.before}  →  {fault.after}", flush=True)
    print(f"{len(drawn) - survived} of {len(drawn)} faults noticed, {survived} survived")


if __name__ == "__main__":
    main()

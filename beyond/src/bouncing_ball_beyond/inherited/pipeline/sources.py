"""The code that a job uses, by digests.

Snakemake does not see the modules that a script imports, and it compares times, which an old file
or ``--touch`` makes misleading. Each job therefore has a *note* as one of its inputs: a small file
with a digest of each file of code that the job uses, and with the versions of the libraries that
compute and draw. A note is written only if one of them changes, and is then newer than what the job
has made. Datasets and pictures record the same digests, so that a comparison names the files that
have changed.

Docstrings, lines that are comments and the ends of lines are no code. Only of a module that imports
a reader of docstrings, such as the claims, whose statements are docstrings, the docstrings count.
"""

import ast
import platform
import re
from collections.abc import Iterable, Iterator
from contextlib import suppress
from functools import cache
from hashlib import sha256
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path

from bouncing_ball_beyond.inherited.datasets.files import write_text

REPOSITORY = Path(__file__).resolve().parents[5]
"""The checkout, with all houses; names of files of code are relative to it."""

LIBRARIES = ("numpy", "scipy", "xarray", "netCDF4", "matplotlib")
"""The libraries that affect the artifacts."""

# The names of our packages begin with it.
_OURS = "bouncing_ball_"
# The package imports its public functions only when a user asks for them, and a result imports what
# draws it only when it is drawn, which no study does: what their functions import does not count.
_ON_DEMAND = ("inherited/__init__.py", "inherited/drawing/result.py")
# How a module reads docstrings.
_READER = r"\bgetdoc\("


@cache
def versions() -> dict[str, str]:
    """Versions of Python and of the libraries that affect the artifacts."""
    return {"python": platform.python_version(), **{name: version(name) for name in LIBRARIES}}


@cache
def parsed(code: bytes) -> ast.Module:
    """The syntax tree of a module."""
    return ast.parse(code)


def statements(body: Iterable[ast.AST]) -> Iterator[ast.AST]:
    """The statements of a block, and those in the blocks of each."""
    for each in body:
        yield each
        for part in ("body", "handlers", "orelse", "finalbody", "cases"):
            yield from statements(getattr(each, part, ()))


def without_remarks(code: str) -> str:
    """The lines of Python code without docstrings, empty lines and the lines that are comments.

    Comments stay in a module in which a value is a text of several lines.

    Examples
    --------
    >>> print(without_remarks("def f():\\n    'What.'\\n\\n    # Why.\\n    return '#'\\n"))
    def f():
        return '#'
    """
    lines = code.encode().splitlines()
    for node in statements(parsed(code.encode()).body):
        if not (isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)):
            continue
        first = node.lineno - 1
        last = node.end_lineno or node.lineno
        around = lines[first][: node.col_offset] + lines[last - 1][node.end_col_offset :]
        if isinstance(node.value.value, str) and not around.strip():
            lines[first:last] = [b""] * (last - first)
    # A line of a text may begin as a comment does.
    has_texts = any(mark in line for line in lines for mark in (b'"""', b"'''"))
    kept = [line.rstrip() for line in lines if has_texts or not line.lstrip().startswith(b"#")]
    return b"\n".join(line for line in kept if line).decode()


@cache
def files_of_module(name: str) -> list[Path]:
    """The files that Python reads for a name in an import: a module and the packages above it.

    If a package and a module have the same name, Python imports the package.
    """
    first, *rest = name.split(".")
    spec = find_spec(first)
    if spec is None or spec.origin is None:
        return []
    base = Path(spec.origin).parent
    files = [base / "__init__.py"]
    for part in rest:
        base /= part
        candidates = (base / "__init__.py", base.with_suffix(".py"))
        files += [path for path in candidates if path.is_file()][:1]
    return files


@cache
def imported(path: Path) -> frozenset[Path]:
    """The files that are read when a file is imported, without what these import."""
    if path.suffix != ".py":
        return frozenset()
    try:
        tree = parsed(path.read_bytes())
    # The job fails with this error, in one line.
    except (SyntaxError, ValueError):
        return frozenset()
    names = set()
    on_demand = path.as_posix().endswith(_ON_DEMAND)
    for node in tree.body if on_demand else statements(tree.body):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            # `from package import name` may name a module or an object.
            names |= {node.module, *(f"{node.module}.{alias.name}" for alias in node.names)}
    ours = (name for name in names if name.startswith(_OURS))
    return frozenset(file for name in ours for file in files_of_module(name))


def sources(files: Iterable[Path]) -> list[Path]:
    """The files that are read when scripts run, sorted: the given ones, all modules that they
    import, and the data beside these modules, such as a template or a style.

    Data with the name of a module belong to this module, and others to all modules of the folder.

    Examples
    --------
    >>> errors = REPOSITORY / "beyond/src/bouncing_ball_beyond/inherited/errors.py"
    >>> [name_of(path) for path in sources([errors])]
    ['beyond/src/bouncing_ball_beyond/inherited/errors.py']
    """
    found: set[Path] = set()
    new = given = set(files)
    while new:
        found |= new
        new = set().union(*map(imported, new)) - found
    folders = {path.parent for path in found - given}
    beside = {path for folder in folders for path in folder.iterdir() if path.is_file()}
    # An empty file, such as the mark of a typed package, holds no data.
    data = {x for x in beside if x.suffix != ".py" and x.name[0] != "." and x.stat().st_size}
    named = {path: path.with_suffix(".py") for path in data}
    used = {path for path, module in named.items() if module in found or not module.exists()}
    return sorted(found | used, key=str)


@cache
def reads_docstrings(path: Path) -> bool:
    """Whether a file of code has a call that reads docstrings."""
    return re.search(_READER, path.read_text(encoding="utf-8")) is not None


def digest_of(path: Path) -> str:
    """The first digits of SHA-256 of what counts in a file."""
    content = path.read_bytes().replace(b"\r\n", b"\n")
    if path.suffix == ".py":
        if not any(map(reads_docstrings, (path, *imported(path)))):
            with suppress(SyntaxError, ValueError):
                content = without_remarks(content.decode()).encode()
    return sha256(content).hexdigest()[:12]


@cache
def line_of(path: Path) -> str:
    """The digest and the name of a file of code."""
    return f"{digest_of(path)} {name_of(path)}"


def lines_of(paths: Iterable[Path]) -> str:
    """A line for each file with its digest and its name, which tell code apart."""
    return "\n".join(map(line_of, paths))


def write_note(path: Path, paths: Iterable[Path], house: str = ".") -> None:
    """Write the note of a job that uses these files, if it has another content.

    It ends with the folder of the house whose workflow runs, relative to the current one.
    """
    libraries = "\n".join(f"{number} {name}" for name, number in versions().items())
    text = "\n\n".join([lines_of(paths), libraries, house])
    if path.is_file() and path.read_bytes() == text.encode():
        return
    write_text(path, text)


def parts_of_note(note: str) -> tuple[str, str]:
    """The lines of code in the text of a note, and the folder of the house.

    Examples
    --------
    >>> parts_of_note("1f0e a.py\\n\\n2.3.5 numpy\\n\\n.")
    ('1f0e a.py', '.')
    """
    return note.partition("\n\n")[0], note.rpartition("\n\n")[2]


def name_of(path: Path) -> str:
    """The name of a file of code: its path in the repository."""
    # A house may stand outside of the repository.
    folder = REPOSITORY if path.is_relative_to(REPOSITORY) else path.parent.parent
    return path.relative_to(folder).as_posix()


def changed_files(record: str, new: str) -> list[str]:
    """The names of the files that differ between two texts of :func:`lines_of`.

    Examples
    --------
    >>> changed_files("1f0e a.py\\n2a2a b.py", "1f0e a.py\\n3b3b b.py\\n4c4c c.py")
    ['b.py', 'c.py']
    >>> changed_files("", "1f0e a.py")
    []
    """
    if not record or not new:
        return []
    return sorted({line.partition(" ")[2] for line in {*record.splitlines()} ^ {*new.splitlines()}})

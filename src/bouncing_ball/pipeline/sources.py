"""The code that a job uses, by digests.

Snakemake does not see the modules that a script imports, and it compares times, which an old file
or ``--touch`` makes misleading. Each job therefore has a *note* as one of its inputs: a small file
with a digest of each file of code that the job uses, and with the versions of the libraries that
compute and draw. A note is written only if one of them changes, and is then newer than what the job
has made. Datasets and pictures record the same digests, so that a comparison names the files that
have changed.

Comments, docstrings and the ends of lines are no code. Only of a module that imports a reader of
docstrings, such as the claims, whose statements are docstrings, the docstrings count.
"""

import ast
import io
import json
import platform
import re
import tokenize
from collections.abc import Iterable, Sequence
from contextlib import suppress
from functools import cache
from hashlib import sha256
from importlib.metadata import version
from importlib.util import cache_from_source, find_spec
from pathlib import Path
from typing import NamedTuple

from bouncing_ball.datasets.files import write_text

REPOSITORY = Path(__file__).resolve().parents[3]
"""The checkout, with all houses; names of files of code are relative to it."""

LIBRARIES = ("numpy", "scipy", "xarray", "netCDF4", "matplotlib")
"""The libraries that affect the artifacts."""

# The packages of all houses begin with it.
_OURS = "bouncing_ball"
# The package imports its public functions only when a user asks for them, and a result imports what
# draws it only when it is drawn, which no study does. What they import at once is named here.
_ON_DEMAND = {
    "bouncing_ball/__init__.py": ["bouncing_ball.first_use"],
    "bouncing_ball/drawing/result.py": [],
}
_STARTS = (tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT, tokenize.NL, tokenize.ENCODING)


@cache
def versions() -> dict[str, str]:
    """Versions of Python and of the libraries that affect the artifacts."""
    return {"python": platform.python_version(), **{name: version(name) for name in LIBRARIES}}


def digest(content: bytes) -> str:
    """The first digits of SHA-256 of a content, whatever the ends of its lines are."""
    return sha256(content.replace(b"\r\n", b"\n")).hexdigest()[:12]


def without_remarks(code: str) -> str:
    """The lines of Python code without comments, docstrings and empty lines.

    Examples
    --------
    >>> print(without_remarks("def f():  # why\\n    'What.'\\n\\n    return '#'\\n"))
    def f():
        return '#'
    """
    lines = code.splitlines(keepends=True)
    tokens = list(tokenize.generate_tokens(io.StringIO(code).readline))
    before = tokenize.ENCODING
    remarks = []
    for token, after in zip(tokens, [*tokens[1:], tokens[-1]], strict=True):
        is_statement = before in _STARTS and after.type == tokenize.NEWLINE
        if token.type == tokenize.COMMENT or (token.type == tokenize.STRING and is_statement):
            remarks.append((token.start, token.end))
        else:
            before = token.type
    for (first, start), (last, end) in reversed(remarks):
        rest = lines[first - 1][:start] + lines[last - 1][end:]
        lines[first - 1 : last] = [rest]
    return "\n".join(line.rstrip() for line in "".join(lines).splitlines() if line.strip())


class Module(NamedTuple):
    """A file of Python: digests of all of it and of its code alone, the names that it imports, and
    whether it reads docstrings.
    """

    content: str
    code: str
    imports: list[str]
    reads_docstrings: bool


def examined(content: bytes) -> Module:
    """The :class:`Module` with a content; what is no Python imports nothing.

    Examples
    --------
    >>> examined(b"from bouncing_ball.errors import ModelError").imports
    ['bouncing_ball.errors', 'bouncing_ball.errors.ModelError']
    """
    whole = digest(content)
    try:
        text = content.decode().replace("\r\n", "\n")
        tree = ast.parse(text)
    except (SyntaxError, ValueError):
        return Module(whole, whole, [], False)
    names = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            # `from package import name` may name a module or an object.
            names |= {node.module, *(f"{node.module}.{alias.name}" for alias in node.names)}
    code = without_remarks(text)
    ours = sorted(name for name in names if name.startswith(_OURS))
    return Module(whole, digest(code.encode()), ours, bool(re.search("getdoc|__doc__", code)))


@cache
def file_of_module(name: str) -> Path | None:
    """The file of a module or a package of a house; None if there is none.

    If a package and a module have the same name, Python imports the package.
    """
    first, *rest = name.split(".")
    spec = find_spec(first)
    if spec is None or spec.origin is None:
        return None
    base = Path(spec.origin).parent.joinpath(*rest)
    candidates = (base / "__init__.py", base.with_suffix(".py"))
    return next((path for path in candidates if path.is_file()), None)


@cache
def files_of_module(name: str) -> list[Path]:
    """The files that Python reads for a name in an import: a module and the packages above it."""
    parts = name.split(".")
    files = (file_of_module(".".join(parts[: count + 1])) for count in range(len(parts)))
    return [file for file in files if file]


@cache
def _data_of_folder(folder: Path) -> list[Path]:
    """The files of a package that are not Python, also in its folders that are no packages."""
    inner = [each for each in folder.iterdir() if each.is_dir() and each.name != "__pycache__"]
    folders = [folder, *(each for each in inner if not (each / "__init__.py").exists())]
    files = [path for each in folders for path in each.iterdir() if path.is_file()]
    # An empty file, such as the mark of a typed package, holds no data.
    return [x for x in files if x.suffix != ".py" and x.name[0] != "." and x.stat().st_size]


def data_beside(module: Path) -> list[Path]:
    """The data files that a module may read.

    Data with the name of a module belong to this module; other data belong to all modules of their
    package.
    """
    return [
        path
        for path in _data_of_folder(module.parent)
        if path.stem == module.stem or not path.with_suffix(".py").exists()
    ]


# What contents hold, by their digests; to examine all modules takes a second.
_KNOWN: dict[str, list] = {}
_KEPT = ".modules"


@cache
def recall(folder: Path) -> None:
    """Read what an earlier start has found out about modules, from the folder of its notes."""
    with suppress(OSError, TypeError, ValueError):
        _KNOWN.update(json.loads((folder / _KEPT).read_bytes()))


@cache
def module(path: Path) -> Module:
    """What a file of Python holds."""
    content = path.read_bytes()
    known = _KNOWN.setdefault(digest(content), [])
    if not known:
        known.extend(examined(content))
    return Module(*known)


@cache
def imported(path: Path) -> frozenset[Path]:
    """The files that are read when a file is imported, without what these import."""
    at_once = (names for file, names in _ON_DEMAND.items() if path.as_posix().endswith(file))
    names = next(at_once, module(path).imports)
    return frozenset(file for name in names for file in files_of_module(name))


def sources(modules: Iterable[str], others: Iterable[Path] = ()) -> list[Path]:
    """The files that are read when modules are imported and scripts run, sorted.

    Parameters
    ----------
    modules : iterable of str
        Modules with their full names.
    others : iterable of Path
        Scripts, whose imports are followed, and other files that the job reads.

    Raises
    ------
    ModuleNotFoundError
        If a named module does not exist.

    Examples
    --------
    >>> [path.name for path in sources(["bouncing_ball.errors"])]
    ['__init__.py', 'errors.py', 'first_use.py']
    """
    given = set(others)
    found: set[Path] = set()
    new = {file for path in given if path.suffix == ".py" for file in imported(path)}
    for name in modules:
        if file_of_module(name) is None:
            raise ModuleNotFoundError(f"no module {name}")
        new.update(files_of_module(name))
    while new:
        found |= new
        new = set().union(*map(imported, new)) - found
    return sorted(given.union(found, *map(data_beside, found)), key=str)


def digest_of(path: Path) -> str:
    """A digest of what counts in a file."""
    if path.suffix != ".py":
        return digest(path.read_bytes())
    about = [module(each) for each in (path, *imported(path))]
    return about[0].content if any(x.reads_docstrings for x in about) else about[0].code


def lines_of(paths: Iterable[Path]) -> str:
    """A line for each file with its digest and its name, which tell code apart."""
    return "\n".join(f"{digest_of(path)} {name_of(path)}" for path in paths)


def write_note(path: Path, paths: Sequence[Path], house: str = ".") -> None:
    """Write the note of a job that uses these files, if it has another content.

    It ends with the folder of the house whose workflow runs, relative to the current one.
    """
    libraries = "\n".join(f"{number} {name}" for name, number in versions().items())
    text = "\n\n".join([lines_of(paths), libraries, house])
    if path.is_file() and path.read_bytes() == text.encode():
        return
    for source in paths:
        # Python runs bytecode if the size and the time of the source are as they were when it was
        # compiled, which an edit may restore; but not the time of the last change of the file.
        bytecode = Path(cache_from_source(str(source)))
        with suppress(OSError):
            if source.stat().st_ctime_ns > bytecode.stat().st_mtime_ns:
                bytecode.unlink()
    write_text(path, text)
    write_text(path.with_name(_KEPT), json.dumps(_KNOWN))


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
    # A run in another folder has a file of its own in `config`.
    folder = REPOSITORY if path.is_relative_to(REPOSITORY) else path.parent.parent
    return path.relative_to(folder).as_posix()


def changed_files(record: str, new: str) -> list[str]:
    """The names of the files that differ between two texts of :func:`lines_of`.

    Earlier records have a single digest, which names no file.

    Examples
    --------
    >>> changed_files("1f0e a.py\\n2a2a b.py", "1f0e a.py\\n3b3b b.py\\n4c4c c.py")
    ['b.py', 'c.py']
    >>> changed_files("5d5d", "1f0e a.py")
    []
    """
    old, now = ([line.partition(" ") for line in text.splitlines()] for text in (record, new))
    if not old or not now or not all(name for _, _, name in (*old, *now)):
        return []
    return sorted({name for _, _, name in {*old} ^ {*now}})

"""The code that a job uses, and digests of its contents.

Snakemake runs a job again when its script changes, but does not see the modules that the script
imports, and it compares times, which an old file or ``--touch`` makes misleading. Each job
therefore has one small file as its input, which holds the digests of all modules and data that the
job uses, and the versions of the libraries that compute and draw. The file is written only when one
of them changes, and is then newer than what the job has made. A dataset and a picture record the
same digests, so that a comparison names the files that have changed.

An accepted sample also records digests of the code that computed it, without comments and
docstrings. If one of these files computes something else today, the sample is older than its code.
"""

import io
import platform
import re
import tokenize
from collections.abc import Iterable
from functools import cache
from hashlib import sha256
from importlib.metadata import version
from pathlib import Path

from bouncing_ball.datasets.files import write_text

_PACKAGE = "bouncing_ball"
_ROOT = Path(__file__).resolve().parent.parent
_REPOSITORY = _ROOT.parent.parent

LIBRARIES = ("numpy", "scipy", "xarray", "netCDF4", "matplotlib", "python-flint")
"""The libraries that affect the artifacts."""


@cache
def versions() -> dict[str, str]:
    """Versions of Python and of the libraries that affect the artifacts."""
    return {"python": platform.python_version(), **{name: version(name) for name in LIBRARIES}}


@cache
def module_file(module: str) -> Path | None:
    """The file of a module or subpackage of this package; None if it does not exist.

    If a package and a module have the same name, Python imports the package.
    """
    base = _ROOT.joinpath(*module.split(".")[1:])
    for candidate in (base / "__init__.py", base.with_suffix(".py")):
        if candidate.is_file():
            return candidate
    return None


# Regular expressions, because parsing the files would take half a second at each start of
# Snakemake.
_FROM = re.compile(rf"^[ \t]*from ({_PACKAGE}[\w.]*) import (\([^)]*\)|[^\n]*)", re.MULTILINE)
_IMPORT = re.compile(rf"^[ \t]*import ({_PACKAGE}[\w.]*)", re.MULTILINE)


# The package itself imports its public functions only when a user asks for them, and a result
# imports what draws it only when it is drawn, which no study does.
_ON_DEMAND = {_ROOT / "__init__.py", _ROOT / "drawing" / "result.py"}


@cache
def imports(path: Path) -> frozenset[str]:
    """Names of modules of this package, and of objects in them, that a file imports."""
    text = path.read_text(encoding="utf-8")
    found = set(_IMPORT.findall(text))
    for module, names in _FROM.findall(text):
        # `from package import name` may name a module or an object.
        found.add(module)
        found |= {f"{module}.{name}" for name in re.findall(r"\w+", names)}
    return frozenset(found)


@cache
def _files_of_module(name: str) -> tuple[Path, ...]:
    """The files that Python reads for a name of :func:`imports`: a module and its packages."""
    parts = name.split(".")
    files = (module_file(".".join(parts[: k + 1])) for k in range(len(parts)))
    return tuple(file for file in files if file)


@cache
def _imported(path: Path) -> frozenset[Path]:
    """The files that are read when a file is imported, without what these import."""
    names = () if path in _ON_DEMAND else imports(path)
    return frozenset(file for name in names for file in _files_of_module(name))


@cache
def _data_of_folder(folder: Path) -> tuple[Path, ...]:
    """The files of a package that are not Python, also in its folders that are no packages.

    An empty file, such as the mark of a typed package, holds no data.
    """
    found: list[Path] = []
    for path in folder.iterdir():
        if path.is_dir():
            if path.name != "__pycache__" and not (path / "__init__.py").exists():
                found += _data_of_folder(path)
        elif (
            path.suffix not in (".py", ".pyc")
            and not path.name.startswith(".")
            and path.stat().st_size
        ):
            found.append(path)
    return tuple(found)


@cache
def data_beside(module: Path) -> tuple[Path, ...]:
    """The data files that a module may read.

    Data with the name of a module belong to this module; other data belong to all modules of their
    package.

    Examples
    --------
    >>> "style.mplstyle" in [path.name for path in data_beside(_ROOT / "drawing" / "style.py")]
    True
    """
    return tuple(
        path
        for path in _data_of_folder(module.parent)
        if path.stem == module.stem or not path.with_suffix(".py").exists()
    )


def sources(modules: Iterable[str], files: Iterable[Path] = ()) -> list[Path]:
    """The files that are read when modules are imported and scripts run, sorted.

    Parameters
    ----------
    modules : iterable of str
        Modules of this package with their full names.
    files : iterable of Path
        Scripts, whose imports are followed, and other files that the job reads.

    Raises
    ------
    ModuleNotFoundError
        If a named module does not exist.

    Examples
    --------
    >>> found = sources(["bouncing_ball.models.damping"])
    >>> [path.name for path in found if path.name != "__init__.py"]
    ['errors.py', 'damping.py', 'arrays.py']
    """
    for module in modules:
        if module_file(module) is None:
            raise ModuleNotFoundError(f"no module {module}")
    given = set(files)
    scripts = [path for path in given if path.suffix == ".py"]
    found: set[Path] = set()
    new: set[Path] = set()
    for module in modules:
        new.update(_files_of_module(module))
    for script in scripts:
        new |= _imported(script)
    new -= given
    while new:
        found |= new
        new = set().union(*map(_imported, new)) - found - given
    return sorted(given.union(found, *map(data_beside, found)), key=str)


# The first digits of SHA-256; two versions of a file share them with a chance of 2⁻⁴⁸.
_DIGITS = 12


@cache
def _line_of_file(path: Path) -> str:
    """A digest of the contents of a file, and its name in the package or in the repository."""
    if path.is_relative_to(_REPOSITORY):
        folder = _ROOT if path.is_relative_to(_ROOT) else _REPOSITORY
    else:
        # A run in another folder has a sample of its own in `config`.
        folder = path.parent.parent
    name = path.relative_to(folder).as_posix()
    return f"{sha256(path.read_bytes()).hexdigest()[:_DIGITS]} {name}"


def digests(paths: Iterable[Path]) -> str:
    """A line for each file with the digest of its contents and its name, which tell code apart.

    They do not depend on the folder of the repository.
    """
    return "\n".join(map(_line_of_file, paths))


def lines_of_versions() -> str:
    """A line for each of :func:`versions`, in the form of the lines of :func:`digests`.

    The results of a job are made again when a library is replaced.
    """
    return "\n".join(f"{number} {name}" for name, number in versions().items())


def without_versions(code: str) -> str:
    """The text of :func:`digests` alone, from one that may have :func:`lines_of_versions` too.

    Examples
    --------
    >>> without_versions("1f0e a.py\\n2.3.5 numpy")
    '1f0e a.py'
    """
    names = ("python", *LIBRARIES)
    lines = code.splitlines()
    return "\n".join(line for line in lines if line.rpartition(" ")[2] not in names)


def changed_files(record: str, new: str) -> list[str]:
    """The names of the files that differ between two texts of :func:`digests`.

    Earlier records have a single digest, which names no file.

    Examples
    --------
    >>> changed_files("1f0e a.py\\n2a2a b.py", "1f0e a.py\\n3b3b b.py\\n4c4c c.py")
    ['b.py', 'c.py']
    >>> changed_files("5d5d", "1f0e a.py")
    []
    """
    old, now = ([line.split(" ", 1) for line in text.splitlines()] for text in (record, new))
    if any(len(line) < 2 for line in (*old, *now)):
        return []
    changed = {tuple(line) for line in old} ^ {tuple(line) for line in now}
    return sorted({name for _, name in changed})


# What changes no number: the list of public names, texts of errors, names and units of variables,
# files, pictures, and the workflow, which only calls the package.
_COMPUTES_NOTHING = re.compile(
    r"__init__\.py|errors\.py|(datasets|drawing|pipeline|workflow)/|.*figures\.py|.*/as_text\.py"
)
_STARTS = (tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT, tokenize.NL, tokenize.ENCODING)


# The samples are made by the same modules.
@cache
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


def _line_of_computation(path: Path) -> str:
    """A digest of what a file computes, and the name of the file, as in :func:`digests`."""
    name = _line_of_file(path).partition(" ")[2]
    content = path.read_bytes()
    if path.suffix == ".py":
        content = without_remarks(content.decode()).encode()
    return f"{sha256(content).hexdigest()[:_DIGITS]} {name}"


def computation(paths: Iterable[Path]) -> str:
    """A line for each file that computes, with the digest of its code without remarks.

    Files that change no number are left out: texts, names, pictures and the workflow.
    """
    lines = [_line_of_computation(path) for path in paths]
    return "\n".join(x for x in lines if not _COMPUTES_NOTHING.match(x.partition(" ")[2]))


def names_of(recorded: str) -> list[str]:
    """The names of the files in the lines of :func:`digests`."""
    return [line.partition(" ")[2] for line in recorded.splitlines()]


def file_of(name: str) -> Path:
    """The file with a name of :func:`digests`, in the package or in the repository."""
    inside = _ROOT / name
    return inside if inside.exists() else _REPOSITORY / name


def changed_since(recorded: str) -> list[str]:
    """The names of the files of :func:`computation` that compute something else now, or are gone.

    Examples
    --------
    >>> changed_since(computation([_ROOT / "models" / "restitution.py"]))
    []
    >>> changed_since("1f0e models/restitution.py\\n2a2a models/gone.py")
    ['models/restitution.py', 'models/gone.py']
    """
    changed = []
    for line in recorded.splitlines():
        name = line.partition(" ")[2]
        path = file_of(name)
        if not path.is_file() or _line_of_computation(path) != line:
            changed.append(name)
    return changed


def keep_digests(path: Path, found: str) -> None:
    """Write digests to a file if the file has others."""
    if not path.is_file() or path.read_bytes() != found.encode():
        write_text(path, found)

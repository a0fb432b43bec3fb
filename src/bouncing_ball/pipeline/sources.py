"""The source files that a stage uses.

Snakemake reruns a job when its script changes, but does not see the modules that the script
imports. These modules are therefore inputs of the job. They are found by following the import
statements, so that an edit reruns only the stages that use the module.
"""

import re
from functools import cache
from pathlib import Path

_PACKAGE = "bouncing_ball"
_ROOT = Path(__file__).resolve().parent.parent


@cache
def module_file(module: str) -> Path | None:
    """The file of a module or subpackage of this package; None if it does not exist."""
    base = _ROOT.joinpath(*module.split(".")[1:])
    for candidate in (base.with_suffix(".py"), base / "__init__.py"):
        if candidate.is_file():
            return candidate
    return None


# Regular expressions, because parsing the files would take half a second at each start of
# Snakemake.
_FROM = re.compile(rf"^[ \t]*from ({_PACKAGE}[\w.]*) import (\([^)]*\)|[^\n]*)", re.MULTILINE)
_IMPORT = re.compile(rf"^[ \t]*import ({_PACKAGE}[\w.]*)", re.MULTILINE)


@cache
def imports(path: Path) -> frozenset[str]:
    """Names of modules of this package, and of objects in them, that a file imports."""
    text = path.read_text(encoding="utf-8")
    found = set(_IMPORT.findall(text))
    for module, names in _FROM.findall(text):
        # `from package import name` may name a module or an object.
        found |= {module, *(f"{module}.{name}" for name in re.findall(r"\w+", names))}
    return frozenset(found)


def sources(*modules: str) -> list[str]:
    """The files that run when the modules are imported, with their tables and texts, sorted.

    Raises
    ------
    ModuleNotFoundError
        If a named module does not exist.

    Examples
    --------
    >>> [Path(file).name for file in sources("bouncing_ball.paper.contact.damping")]
    ['__init__.py', 'errors.py', '__init__.py', 'elementary.py', '__init__.py', '__init__.py', 'damping.py']
    """
    for module in modules:
        if module_file(module) is None:
            raise ModuleNotFoundError(f"no module {module}")
    pending, seen = list(modules), set()
    while pending:
        # A module's packages are imported with it.
        parts = pending.pop().split(".")
        for k in range(len(parts)):
            path = module_file(".".join(parts[: k + 1]))
            if path is not None and path not in seen:
                seen.add(path)
                pending.extend(imports(path))
    beside = (path.with_suffix(x) for path in seen for x in (".csv", ".md", ".toml", ".yaml"))
    return sorted(str(path) for path in [*seen, *filter(Path.is_file, beside)])

"""The source files that a stage really uses.

Snakemake reruns a job when its script changes, but does not see the modules
that the script imports. They are listed among its inputs instead, found by
following the import statements, so that an edit reruns the stages that use
the module and no others.
"""

import ast
from functools import cache
from pathlib import Path

_PACKAGE = "bouncing_ball"
_ROOT = Path(__file__).resolve().parent.parent


@cache
def module_file(module: str) -> Path | None:
    """The file of a module or package of this package, if there is one."""
    base = _ROOT.joinpath(*module.split(".")[1:])
    for candidate in (base.with_suffix(".py"), base / "__init__.py"):
        if candidate.is_file():
            return candidate
    return None


@cache
def _imports(path: Path) -> frozenset[str]:
    """Modules of this package named in the import statements of a file."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.level == 0 and node.module:
            # `from package import name` may name a module or an object.
            names = [node.module, *(f"{node.module}.{alias.name}" for alias in node.names)]
        else:
            continue
        found |= {name for name in names if name.split(".")[0] == _PACKAGE}
    return frozenset(found)


def _with_parents(module: str) -> list[str]:
    parts = module.split(".")
    return [".".join(parts[: k + 1]) for k in range(len(parts))]


def sources(*modules: str) -> list[str]:
    """Files of this package that importing the modules executes, sorted.

    Raises
    ------
    ModuleNotFoundError
        If a named module does not exist.

    Examples
    --------
    >>> [Path(file).name for file in sources("bouncing_ball.impacts.damping")]
    ['__init__.py', 'errors.py', '__init__.py', 'damping.py', 'release.py']
    """
    for module in modules:
        if module_file(module) is None:
            raise ModuleNotFoundError(f"no module {module}")
    pending, seen = list(modules), set()
    while pending:
        for name in _with_parents(pending.pop()):
            path = module_file(name)
            if path is not None and path not in seen:
                seen.add(path)
                pending.extend(_imports(path))
    return sorted(str(path) for path in seen)

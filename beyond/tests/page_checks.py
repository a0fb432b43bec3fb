"""What pages and docstrings of a house refer to, and whether it exists."""

import builtins
import doctest
import re
from functools import cache
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from types import ModuleType

import matplotlib.pyplot as plt

ROLE = re.compile(r":(?:mod|func|class|meth|data|attr|exc):`(?:[^`<]*<)?[~.]*([\w.\s]+)>?`")
# It matches nothing.
NONE = re.compile("(?!)")
OTHERS = ("numpy.", "scipy.", "xarray.", "matplotlib.", "pydantic.")


def every_module_exists(page: Path, pattern: re.Pattern[str], but: re.Pattern[str] = NONE) -> None:
    """Every dotted name on a page that the pattern finds is a module, or a name in one.

    Names that ``but`` matches are those of modules that a reader makes.
    """
    for name in pattern.findall(page.read_text(encoding="utf-8")):
        if but.search(name):
            continue
        # The longest part that is a module has the rest as an attribute.
        module, _, last = name.rpartition(".")
        assert find_spec(module) is not None, name
        assert hasattr(import_module(module), last) or find_spec(name) is not None, name


def exists(name: str) -> bool:
    """Whether a dotted name is a module, or an attribute or a field of one or of its class."""
    parts = name.split(".")
    for count in range(len(parts), 0, -1):
        try:
            value = import_module(".".join(parts[:count]))
        except ModuleNotFoundError:
            continue
        for part in parts[count:]:
            if part in getattr(value, "__annotations__", {}):
                return True
            if not hasattr(value, part):
                return False
            value = getattr(value, part)
        return True
    return False


def modules_of(package: ModuleType) -> list[Path]:
    return sorted(Path(package.__file__).parent.rglob("*.py"))


def dotted(path: Path, package: ModuleType) -> str:
    """The name of the module of a package at this path."""
    name = ".".join(path.relative_to(Path(package.__file__).parents[1]).with_suffix("").parts)
    return name.removesuffix(".__init__")


@cache
def known_names(package: ModuleType) -> set[str]:
    """Names of all modules, of what they define, and of the attributes of their classes."""
    names = set()
    for path in modules_of(package):
        module = import_module(dotted(path, package))
        names.add(module.__name__)
        # Public functions are loaded when they are first used: dir names more than vars.
        for name in {*dir(module), *vars(module)}:
            value = vars(module).get(name)
            if isinstance(value, ModuleType):
                continue
            names.add(f"{module.__name__}.{name}")
            if isinstance(value, type):
                attributes = {*dir(value), *getattr(value, "__annotations__", {})}
                names |= {f"{module.__name__}.{name}.{each}" for each in attributes}
    return names


def lost_references(package: ModuleType, *below: ModuleType) -> list[tuple[str, str]]:
    """What docstrings of a package refer to and does not exist, with the file.

    A whole name is one of the package, or of the packages ``below`` it. The end of a name is one of
    the package.
    """
    known = known_names(package)
    ends = {name.split(".", k)[-1] for name in known for k in range(name.count(".") + 1)}
    others = [each.__name__ for each in below]

    def is_found(name: str) -> bool:
        first = name.partition(".")[0]
        if name.startswith(OTHERS) or hasattr(builtins, name):
            return True
        if first in others:
            return exists(name)
        return name in (known if first == package.__name__ else ends)

    return [
        (dotted(path, package), name)
        for path in modules_of(package)
        for name in ROLE.findall(path.read_text(encoding="utf-8"))
        if not is_found(name)
    ]


def its_examples_run(page: Path) -> int:
    """How many examples a page has; they are right."""
    plt.switch_backend("agg")
    try:
        found = doctest.testfile(str(page), module_relative=False)
    finally:
        plt.close("all")
    assert found.failed == 0
    return found.attempted

"""Public names of a package that are imported on first use.

``--help`` of the command line needs no numpy, a single orbit no xarray, and no call the packages of
another.
"""

from collections.abc import Callable, Mapping
from importlib import import_module
from typing import Any

from bouncing_ball_beyond.inherited.errors import did_you_mean


def first_use(
    package: str, modules: Mapping[str, str], known: Mapping[str, Any]
) -> tuple[Callable[[str], Any], Callable[[], list[str]]]:
    """The functions ``__getattr__`` and ``__dir__`` of a package.

    Parameters
    ----------
    package : str
        Name of the package.
    modules : mapping
        The modules in which the public names are defined, by these names.
    known : mapping
        The names that the package has already.
    """

    def get(name: str) -> Any:
        if name not in modules:
            meant = did_you_mean(name, modules)
            raise AttributeError(f"module {package!r} has no attribute {name!r}{meant}")
        return getattr(import_module(f"{package}.{modules[name]}"), name)

    def names() -> list[str]:
        return sorted({*known, *modules})

    return get, names

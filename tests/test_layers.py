"""What each layer may import, read from the source's import statements and import_module calls."""

import ast
import sys
from pathlib import Path

import pytest

import bouncing_ball

ROOT = Path(bouncing_ball.__file__).parent
PACKAGE = "bouncing_ball"
# Modules that any layer may import.
COMMON = ("errors", "parameters", "call_signatures")

# For each layer, from the bottom: other layers of the package, and packages from outside.
ALLOWED = {
    "datasets": (set(), {"numpy", "xarray"}),
    "contacts": (set(), {"numpy", "scipy"}),
    "continuation": (set(), {"numpy", "scipy"}),
    "motion": ({"contacts"}, {"numpy"}),
    "orbits": ({"datasets", "contacts", "continuation", "motion"}, {"numpy", "scipy", "xarray"}),
    "attractors": (
        {"datasets", "contacts", "continuation", "motion", "orbits"},
        {"numpy", "scipy", "xarray"},
    ),
    "calls": ({"datasets", "contacts", "motion", "orbits", "attractors"}, {"numpy"}),
    "accuracy": ({"contacts", "continuation", "motion", "orbits"}, {"numpy", "scipy"}),
    # No engine is imported.
    "engines": ({"contacts"}, {"numpy"}),
    "studies": (
        {
            *("datasets", "contacts", "continuation", "motion", "orbits", "attractors"),
            *("accuracy", "engines"),
        },
        {"numpy", "scipy", "xarray", "pydantic"},
    ),
    # Units are parsed at the edge, and pint is imported there when it is asked for.
    "calculator": (
        {"contacts", "motion", "orbits", "attractors", "calls", "accuracy", "engines"},
        {"numpy", "xarray", "pint"},
    ),
    "atlas": ({"datasets", "contacts", "orbits", "accuracy"}, {"numpy", "xarray", "pydantic"}),
    # Studies are imported by name when they are run.
    "configuration": ({"atlas"}, {"yaml", "pydantic"}),
    "claims": (
        {
            *("datasets", "contacts", "continuation", "motion", "orbits", "attractors"),
            *("accuracy", "studies", "configuration"),
        },
        {"numpy", "scipy", "xarray"},
    ),
    # Pandoc and Typst only where the PDF is made.
    "figures": ({"datasets"}, {"numpy", "xarray", "matplotlib", "jinja2", "pypandoc", "typst"}),
    # netCDF4 and Pillow read attributes without the data.
    "provenance": ({"configuration"}, {"numpy", "netCDF4", "PIL"}),
    "compare": (
        {"datasets", "configuration", "provenance"},
        {"numpy", "xarray", "netCDF4", "PIL", "jinja2"},
    ),
    "pipeline": (
        {"datasets", "atlas", "configuration", "figures", "provenance"},
        {"numpy", "xarray", "yaml"},
    ),
    "cli": (
        {
            "datasets",
            "contacts",
            "motion",
            "orbits",
            "calls",
            "accuracy",
            "engines",
            "calculator",
            "configuration",
            "figures",
            "provenance",
            "compare",
        },
        {"numpy"},
    ),
}


# Imported when a method is first called, see the package's docstring.
LATER = {"orbits": {"calls"}, "datasets": {"figures"}}


def imports(tree: ast.AST):
    """Absolute names of the modules that a module imports; relative imports are not used."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert not node.level, ast.unparse(node)
            # "from package import x" may import a module x.
            yield from (f"{node.module}.{alias.name}" for alias in node.names)
        elif isinstance(node, ast.Call) and ast.unparse(node.func) == "import_module":
            # A name that is put together is known up to its first part that is not.
            yield "later:" + ast.unparse(node.args[0]).lstrip("f").strip("'\"").partition("{")[0]


def violations(layer: str, source: str) -> set[str]:
    layers, outside = ALLOWED[layer]
    bad = set()
    for name in imports(ast.parse(source)):
        inside = {layer, *COMMON, *layers, *(LATER.get(layer, ()) if "later:" in name else ())}
        top, _, rest = name.removeprefix("later:").partition(".")
        if top == PACKAGE:
            good = rest in ("", "__version__") or rest.split(".")[0] in inside
        else:
            good = top in outside or top in sys.stdlib_module_names
        bad |= set() if good else {name}
    return bad


@pytest.mark.parametrize("layer", ALLOWED)
def test_layer_imports_only_what_it_may(layer):
    # A layer is a folder, or a single module.
    files = sorted((ROOT / layer).rglob("*.py")) or [ROOT / f"{layer}.py"]
    found = {str(path): violations(layer, path.read_text(encoding="utf-8")) for path in files}
    assert {path: bad for path, bad in found.items() if bad} == {}
    # The package's docstring has the layers in their order: each imports only what lies above.
    order = [line.split("``")[1] for line in bouncing_ball.__doc__.splitlines() if "``" in line[:2]]
    assert ALLOWED[layer][0] <= set(order[: order.index(layer)])

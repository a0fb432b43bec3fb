"""What each layer may import, read from the source's import statements."""

import ast
import sys
from pathlib import Path

import pytest

import bouncing_ball

ROOT = Path(bouncing_ball.__file__).parent
PACKAGE = "bouncing_ball"
STANDARD = set(sys.stdlib_module_names)
# What import_module is given, if that is no literal.
BY_NAME = "(by name)"
# Modules that any layer may import.
COMMON = ("errors", "parameters", "signatures")

# For each layer, from the bottom: other layers of the package, and packages from outside.
ALLOWED = {
    "datasets": (set(), {"numpy", "xarray"}),
    "contacts": (set(), {"numpy"}),
    "continuation": (set(), {"numpy", "scipy"}),
    "motion": ({"contacts"}, {"numpy"}),
    "orbits": ({"contacts", "continuation", "motion"}, {"numpy", "scipy"}),
    "accuracy": ({"contacts", "continuation", "motion", "orbits"}, {"numpy", "scipy"}),
    "studies": (
        {"datasets", "contacts", "continuation", "motion", "orbits", "accuracy"},
        {"numpy", "scipy", "xarray", "pydantic"},
    ),
    # Units are parsed at the edge, and pint is imported there when it is asked for.
    "calculator": ({"contacts", "orbits", "accuracy"}, {"numpy", "xarray", "pint"}),
    "atlas": ({"datasets", "contacts", "orbits", "accuracy"}, {"numpy", "xarray", "pydantic"}),
    # Studies are imported by name when they are run.
    "configuration": ({"atlas"}, {"yaml", "pydantic", BY_NAME}),
    "claims": (
        {"datasets", "contacts", "continuation", "motion", "orbits", "accuracy", "studies"},
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
        {"xarray", "yaml"},
    ),
    "cli": (
        {
            "datasets",
            "contacts",
            "motion",
            "orbits",
            "accuracy",
            "calculator",
            "configuration",
            "figures",
            "provenance",
            "compare",
        },
        # The calls of a subcommand are imported when it is used.
        {"numpy", BY_NAME},
    ),
}


def imports(source: str, module: str) -> set[str]:
    """Absolute names of all modules that a module imports, however it does."""
    found = set()
    package = module.split(".")[:-1]
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            base = package[: len(package) - node.level + 1] if node.level else []
            parts = [*base, *([node.module] if node.module else [])]
            name = ".".join(parts)
            # "from package import x" may import a module x.
            found |= {f"{name}.{alias.name}" for alias in node.names}
        elif isinstance(node, ast.Attribute) and ast.unparse(node.value) == PACKAGE:
            # After "import package", what is taken from it.
            found |= {f"{PACKAGE}.{node.attr}"}
        elif isinstance(node, ast.Call):
            called = ast.unparse(node.func)
            if called in ("__import__", "import_module", "importlib.import_module"):
                name = node.args[0]
                found.add(name.value if isinstance(name, ast.Constant) else BY_NAME)
    # Its file and its version are no modules.
    return {name for name in found if not name.endswith("__")}


def violations(layer: str, source: str, module: str) -> set[str]:
    layers, outside = ALLOWED[layer]
    inside = {f"{PACKAGE}.{name}" for name in (layer, *COMMON, *layers)}
    bad = set()
    for name in imports(source, module):
        top = name.split(".")[0]
        if name == PACKAGE:
            continue
        if top == PACKAGE:
            if ".".join(name.split(".")[:2]) not in inside:
                bad.add(name)
        elif top not in STANDARD and top not in outside:
            bad.add(name)
    return bad


def modules(layer: str):
    for path in sorted((ROOT / layer).rglob("*.py")):
        parts = path.relative_to(ROOT.parent).with_suffix("").parts
        yield path, ".".join(parts)


@pytest.mark.parametrize("layer", ALLOWED)
def test_layer_imports_only_what_it_may(layer):
    found = {
        module: bad
        for path, module in modules(layer)
        if (bad := violations(layer, path.read_text(encoding="utf-8"), module))
    }
    assert found == {}
    assert len(list(modules(layer))) > 1


@pytest.mark.parametrize(
    ("layer", "source"),
    [
        ("contacts", "import scipy"),
        ("contacts", "from bouncing_ball.orbits import spring_damper_limits as limits"),
        ("contacts", "from bouncing_ball import orbits"),
        ("contacts", "from ..orbits.spring_damper_limits import orbit_at"),
        ("continuation", "import bouncing_ball.contacts.spring_damper"),
        ("continuation", "def f():\n    from bouncing_ball.contacts import damping"),
        ("orbits", "from bouncing_ball.studies.parameters import Points"),
        ("datasets", "from bouncing_ball.contacts import spring_damper"),
        ("studies", "from bouncing_ball.figures import style"),
        ("studies", "import matplotlib.pyplot as plt"),
        ("figures", "from bouncing_ball.orbits import spring_damper_limits as limits"),
        ("figures", "from scipy.optimize import brentq"),
        ("figures", "import importlib\nimportlib.import_module('bouncing_ball.contacts')"),
        ("figures", "from .. import studies"),
        ("figures", "from importlib import import_module\nimport_module(f'bouncing_ball.{name}')"),
        ("compare", "from bouncing_ball.claims import convergence"),
        ("compare", "import bouncing_ball\nbouncing_ball.claims.convergence.stages"),
        ("pipeline", "from bouncing_ball.cli.output import fail"),
        ("cli", "from bouncing_ball.claims.evidence import dip"),
        ("cli", "import matplotlib"),
    ],
)
def test_the_check_sees_violations(layer, source):
    assert violations(layer, source, f"{PACKAGE}.{layer}.some_module")


@pytest.mark.parametrize(
    ("layer", "source"),
    [
        ("contacts", "import numpy as np\nfrom bouncing_ball.errors import ModelError"),
        ("contacts", "from .damping import damping_ratio\nimport dataclasses"),
        ("orbits", "from bouncing_ball.contacts.spring_damper import SpringDamper"),
        ("figures", "import matplotlib.pyplot as plt\nfrom bouncing_ball.datasets import netcdf"),
        ("pipeline", "import bouncing_ball\nbouncing_ball.__file__"),
    ],
)
def test_the_check_lets_the_rest_pass(layer, source):
    assert violations(layer, source, f"{PACKAGE}.{layer}.some_module") == set()


def test_the_documented_order_of_the_layers():
    # The package's docstring: each layer imports only what lies above it.
    lines = bouncing_ball.__doc__.splitlines()
    order = [line.split("``")[1] for line in lines if line.startswith("``")]
    assert set(ALLOWED) <= set(order)
    for layer in order:
        above = {layer, *COMMON, *order[: order.index(layer)]}
        if layer == "compare":
            above.add("record")
        for path, module in modules(layer):
            for name in imports(path.read_text(encoding="utf-8"), module):
                parts = name.split(".")
                if parts[0] == PACKAGE and len(parts) > 1:
                    assert parts[1] in above, f"{module} imports {name}"

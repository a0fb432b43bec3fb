"""The jobs that a change makes run again, as far as parameters and imports determine them.

That Snakemake follows them is tested in tests/workflow/test_reruns.py.
"""

import ast
import copy
import subprocess
import sys
from pathlib import Path

import pytest

from bouncing_ball.pipeline.configuration import arguments, read_yaml
from bouncing_ball.pipeline.sources import imports, sources

ROOT = Path(__file__).resolve().parents[2]
CONFIG = read_yaml(ROOT / "config" / "config.yaml")


@pytest.mark.parametrize(
    ("keys", "value", "expected"),
    [
        (("figures", "fig08", "points"), 101, {"fig08"}),
        (("studies", "formulas", "seed"), 1, {"formulas"}),
        (
            ("continuation", "largest_step"),
            0.1,
            {"fig08", "fig09", "fig15", "table1"},
        ),
    ],
)
def test_a_changed_parameter(stages, keys, value, expected):
    config = copy.deepcopy(CONFIG)
    section = config
    for key in keys[:-1]:
        section = section[key]
    section[keys[-1]] = value
    given = [{x: arguments(stages[x], x, run) for x in stages} for run in (CONFIG, config)]
    assert {name for name in stages if given[0][name] != given[1][name]} == expected


@pytest.mark.parametrize(
    ("file", "expected"),
    [
        ("paper/exhibits/restitution_model.py", {"fig02", "fig03"}),
        ("paper/claims/verdict.py", {"claims", "statements"}),
        ("paper/claims/witness.py", {"witness"}),
        ("drawing/style.py", set()),
        ("pipeline/configuration_docs.py", set()),
    ],
)
def test_a_changed_module(stages, file, expected):
    users = {
        name
        for name, study in stages.items()
        for path in sources(f"bouncing_ball.{study.rpartition('.')[0]}")
        if path.endswith(f"/{file}")
    }
    assert users == expected


def test_the_modules_of_a_stage_are_those_it_imports():
    """The modules found in the sources are those that Python really imports."""
    code = (
        "import sys, bouncing_ball.paper.exhibits.continuation_of_orbits\n"
        "print(*sorted(m.__file__ for n, m in sys.modules.items()"
        " if n.split('.')[0] == 'bouncing_ball'), sep='\\n')"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    found = sources("bouncing_ball.paper.exhibits.continuation_of_orbits")
    assert [path for path in found if path.endswith(".py")] == done.stdout.splitlines()


def test_no_import_statement_is_missed():
    """The statements found by regular expressions are those that Python's parser finds."""
    for path in sorted((ROOT / "src" / "bouncing_ball").rglob("*.py")):
        named = set()
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Import):
                named |= {alias.name for alias in node.names}
            elif isinstance(node, ast.ImportFrom) and node.module:
                named |= {node.module, *(f"{node.module}.{alias.name}" for alias in node.names)}
        own = {name for name in named if name.split(".")[0] == "bouncing_ball"}
        assert own <= imports(path), path

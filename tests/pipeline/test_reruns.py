"""What a change makes again, as far as entries of stages and imports decide it.

That Snakemake follows them is tested in tests/workflow/test_reruns.py.
"""

import ast
import copy
import subprocess
import sys
from pathlib import Path

import pytest

from bouncing_ball.configuration.stages import studied
from bouncing_ball.configuration.yaml_file import read_yaml
from bouncing_ball.pipeline.sources import imports, sources

ROOT = Path(__file__).resolve().parents[2]
CONFIG = ROOT / "config"
RUN = read_yaml(CONFIG / "config.yaml")
# What rests on the orbits shown.
CLAIMS, WITNESS = {"claims"}, {"witness", "claims"}


def given(run):
    """What each stage is given."""
    return {stage.name: (stage.parameters(run), stage.settings(run)) for stage in studied()}


def with_followers(names):
    """The stages and all that read their datasets, or those made from these."""
    found = set(names)
    for stage in studied():  # each after those that it reads
        if found & set(stage.reads):
            found.add(stage.name)
    return found


@pytest.mark.parametrize(
    ("keys", "value", "expected"),
    [
        (("figures", "fig08", "points"), 101, {"fig08", *WITNESS}),
        (("extensions", "ext_release", "restitution"), 0.9, {"ext_release", *WITNESS}),
        (("figures", "fig16", "tolerance"), 0.02, {"fig16", *CLAIMS}),
        # Decides two claims by its damping alone.
        (("figures", "fig11", "restitution"), 0.7, {"fig11", *CLAIMS}),
        # Decides none.
        (("figures", "fig12", "amplitude"), 1.1, {"fig12", *WITNESS}),
        (("studies", "formulas", "seed"), 1, {"formulas", *CLAIMS}),
        (("tables", "table1", "amplitude_max"), 1.6, {"table1", *WITNESS}),
        (
            ("continuation", "max_angle"),
            0.1,
            {"fig08", "fig09", "fig15", "table1", *WITNESS},
        ),
    ],
)
def test_a_changed_parameter(keys, value, expected):
    run = copy.deepcopy(RUN)
    section = run
    for key in keys[:-1]:
        section = section[key]
    section[keys[-1]] = value
    before, after = given(RUN), given(run)
    assert with_followers(name for name in after if after[name] != before[name]) == expected


def users(file):
    """The stages whose study imports a module, itself or by way of others."""
    return {
        stage.name
        for stage in studied()
        if any(path.endswith(f"/{file}") for path in sources(f"bouncing_ball.{stage.module}"))
    }


@pytest.mark.parametrize(
    ("file", "expected"),
    [
        ("studies/restitution_families.py", {"fig02", "fig03"}),
        ("claims/verdict.py", {"claims"}),
        ("claims/tally.py", set()),
        ("figures/style.py", set()),
        ("configuration/stages.py", set()),
        ("claims/as_printed.py", {"formulas", "forensics", "claims"}),
    ],
)
def test_a_changed_module(file, expected):
    assert users(file) == expected


def test_the_modules_of_a_stage_are_those_it_imports():
    """Followed in the sources, and as Python really imports them."""
    code = (
        "import sys, bouncing_ball.studies.orbit_branches\n"
        "print(*sorted(m.__file__ for n, m in sys.modules.items()"
        " if n.split('.')[0] == 'bouncing_ball'), sep='\\n')"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert sources("bouncing_ball.studies.orbit_branches") == done.stdout.splitlines()


def test_no_import_statement_is_missed():
    """Those that are found by their form are those that Python's parser finds."""
    for path in sorted((ROOT / "src" / "bouncing_ball").rglob("*.py")):
        named = set()
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Import):
                named |= {alias.name for alias in node.names}
            elif isinstance(node, ast.ImportFrom) and node.module:
                named |= {node.module, *(f"{node.module}.{alias.name}" for alias in node.names)}
        own = {name for name in named if name.split(".")[0] == "bouncing_ball"}
        assert imports(path) == own, path


def test_a_line_of_a_text_is_no_import_statement(tmp_path):
    path = tmp_path / "module.py"
    path.write_text('"""Values\nfrom bouncing_ball as it is.\n"""\n', encoding="utf-8")
    assert imports(path) == set()

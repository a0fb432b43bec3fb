"""The jobs that a change makes run again, as far as parameters and contents determine them.

That Snakemake follows them is tested in tests/workflow/test_reruns.py.
"""

import ast
import copy
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from declared_artifacts import ARTIFACTS, STUDIES

from bouncing_ball.pipeline import sources as module
from bouncing_ball.pipeline.configuration import arguments
from bouncing_ball.pipeline.sources import digests, imports, keep_digests, sources
from bouncing_ball.pipeline.yaml_files import read_yaml

ROOT = Path(__file__).resolve().parents[2]
CONFIG = read_yaml(ROOT / "config" / "config.yaml")


def arguments_in(run):
    return {x: arguments(study, ARTIFACTS[x].part, x, run) for x, study in STUDIES.items()}


@pytest.mark.parametrize(
    ("keys", "value", "expected"),
    [
        (("paper", "fig08", "points"), 101, {"fig08"}),
        (("paper", "formulas", "seed"), 1, {"formulas"}),
        (
            ("continuation", "largest_step"),
            0.1,
            {"fig08", "fig09", "fig15", "table1"},
        ),
    ],
)
def test_a_parameter_changes_the_arguments_of_its_studies_only(keys, value, expected):
    config = copy.deepcopy(CONFIG)
    section = config
    for key in keys[:-1]:
        section = section[key]
    section[keys[-1]] = value
    before = arguments_in(CONFIG)
    after = arguments_in(config)
    assert {name for name in STUDIES if before[name] != after[name]} == expected


@pytest.mark.parametrize(
    ("file", "expected"),
    [
        ("paper/exhibits/restitution_model.py", {"fig02", "fig03"}),
        ("paper/claims/verdict.py", {"claims", "ext_verdicts"}),
        ("paper/claims/witness.py", {"witness"}),
        ("drawing/style.py", set()),
        ("drawing/style.mplstyle", set()),
        ("pipeline/configuration_docs.py", set()),
    ],
)
def test_a_module_belongs_to_the_studies_that_import_it(file, expected):
    changed = ROOT / "src" / "bouncing_ball" / file
    assert changed.is_file()
    users = {
        name for name in STUDIES if changed in sources([f"bouncing_ball.{ARTIFACTS[name].module}"])
    }
    assert users == expected


def test_the_modules_of_a_stage_are_those_that_python_imports():
    code = (
        "import sys, bouncing_ball.paper.exhibits.continuation_of_orbits\n"
        "print(*sorted(m.__file__ for n, m in sys.modules.items()"
        " if n.split('.')[0] == 'bouncing_ball'), sep='\\n')"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    found = sources(["bouncing_ball.paper.exhibits.continuation_of_orbits"])
    assert [str(path) for path in found if path.suffix == ".py"] == done.stdout.splitlines()


@pytest.mark.parametrize(
    ("module", "data"),
    [
        ("bouncing_ball.drawing.style", "drawing/style.mplstyle"),
        ("bouncing_ball_beyond.explorer.document", "explorer/model.js"),
        ("bouncing_ball_contacts.engines.engine", "contacts/engines/snippets/generic.txt"),
    ],
)
def test_the_data_that_a_module_reads_belong_to_its_code(module, data):
    assert ROOT / "src" / "bouncing_ball" / data in sources([module])


def test_the_modules_that_a_script_imports_belong_to_its_code():
    script = ROOT / "workflow" / "scripts" / "table.py"
    found = sources([], [script])
    assert {script, ROOT / "src" / "bouncing_ball" / "drawing" / "tables.py"} <= {*found}


def test_a_digest_follows_contents_and_names_and_not_times(tmp_path, monkeypatch):
    monkeypatch.setattr(module, "_REPOSITORY", tmp_path)

    def digest_of(name, text):
        path = tmp_path / name
        path.write_text(text, encoding="utf-8")
        os.utime(path, (0, 0))
        # As in another process, which has read nothing yet.
        module._line_of_file.cache_clear()
        return digests([path])

    first = digest_of("a.py", "r = 0.85")
    assert first == digest_of("a.py", "r = 0.85")
    assert first != digest_of("a.py", "r = 0.70")
    assert first != digest_of("b.py", "r = 0.85")


def test_a_package_that_shadows_a_module_is_the_one_that_is_read(tmp_path, monkeypatch):
    monkeypatch.setattr(module, "_ROOT", tmp_path)
    shadowed = tmp_path / "damping.py"
    shadowing = tmp_path / "damping" / "__init__.py"
    shadowing.parent.mkdir()
    for path in (shadowed, shadowing):
        path.touch()
        module.module_file.cache_clear()
        assert module.module_file("bouncing_ball.damping") == path
    module.module_file.cache_clear()


def test_the_versions_of_the_libraries_stand_below_the_digests_and_are_no_files():
    files = "1f0e a.py\n2a2a b.py"
    text = f"{files}\n{module.lines_of_versions()}"
    assert f"{np.__version__} numpy" in text.splitlines()
    assert module.without_versions(text) == files
    assert module.without_versions(files) == files


def test_the_file_of_a_digest_is_written_only_when_the_digest_changes(tmp_path):
    path = tmp_path / "fig02"
    keep_digests(path, "one")
    os.utime(path, (0, 0))
    keep_digests(path, "one")
    assert path.stat().st_mtime == 0
    keep_digests(path, "two")
    assert path.read_text() == "two" and path.stat().st_mtime > 0
    # Whatever another program has written there.
    path.write_bytes(b"\xff\xfe")
    keep_digests(path, "three")
    assert path.read_text() == "three"


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

"""The workflow: its targets, and what runs again after a change.

The scripts only write their outputs here: the rules are tested, and no numbers.
"""

import ast
import re
import shutil
from modulefinder import ModuleFinder
from pathlib import Path

import pytest
import yaml
from checkout import Checkout, stubbed

BEYOND = Path(__file__).resolve().parents[1]
ROOT = BEYOND.parents[1]
CONFIG = yaml.safe_load((BEYOND / "config/config.yaml").read_text("utf-8"))
STAGES = {
    name: [entry for entry in section if entry != "title"]
    for name, section in CONFIG.items()
    if isinstance(section, dict)
}
FIGURES = {
    name for stage, names in STAGES.items() for name in names if "caption" in CONFIG[stage][name]
}
TABLES = {"table_ext_orders", "table_ext_laws"}
TEXTS = {"article", "explorer_page"}
NO_NUMBER = {"variables.py", "provenance.py", "__init__.py"}
"""Modules that decide no number: they are in no list of code."""


@pytest.fixture(scope="module")
def stubs(tmp_path_factory) -> Checkout:
    """The workflow with scripts that only write their outputs, not run yet."""
    folder = tmp_path_factory.mktemp("stubs")
    for name in ("src", "workflow"):
        shutil.copytree(ROOT / name, folder / name)
    return stubbed(BEYOND, folder / "extras/beyond")


@pytest.fixture(scope="module")
def complete(stubs, tmp_path_factory) -> Checkout:
    """The same after a whole run. Tests plan further runs here, and change nothing."""
    folder = shutil.copytree(stubs.path.parents[1], tmp_path_factory.mktemp("complete") / "copy")
    copy = Checkout(folder / "extras/beyond")
    status, printed = copy.run("--cores", "2")
    assert status == 0, printed
    return copy


@pytest.fixture
def used(complete, tmp_path) -> Checkout:
    """A copy for one test, after a whole run."""
    folder = shutil.copytree(complete.path.parents[1], tmp_path / "checkout")
    return Checkout(folder / "extras/beyond")


def test_a_whole_run_makes_every_file_of_the_reference(complete):
    reference = {f"figures/{path.name}" for path in (BEYOND / "figures").iterdir()}
    texts = {"article.md", "appendix.md", "phase.md", "laid.md"}
    assert complete.made() | {"figures/accepted.json"} == reference | texts


def test_a_name_needs_its_stage_only(stubs):
    assert stubs.planned("ext_map") == {"stiffness_map", "ext_map"}
    assert stubs.planned("impacts") == {"impacts"}
    assert stubs.planned("ext_map", "diff") == {"stiffness_map", "ext_map", "diff"}
    stage = {"impacts", "ext_impact", "ext_instant", "ext_contact_time", "diff"}
    assert stubs.planned("impacts", "diff") == stage


@pytest.mark.parametrize(
    "file, old, new, again",
    [
        (
            "config/config.yaml",
            "positions: 41",
            "positions: 31",
            {"stiffness_map", "ext_map", "article"},
        ),
        (
            "config/config.yaml",
            "release: displacement",
            "release: force",
            {"impacts", "ext_impact", "ext_instant", "ext_contact_time"}
            | {"error_law", "ext_orders", "table_ext_orders", "article"},
        ),
        ("workflow/studies/figures.py", "import", "import  ", FIGURES),
        ("workflow/explorer/model.js", "", "// changed\n", {"explorer_page"}),
        ("workflow/templates/article.md.j2", "the", "a", {"article"}),
        ("workflow/studies/variables.py", "import", "import  ", set()),
        ("../../src/paper_replication/compare.py", "import", "import  ", set()),
    ],
)
def test_a_change_runs_again_what_follows_from_it(used, file, old, new, again):
    for path in used.path.parents[1].rglob("*.*"):
        path.touch()
    assert used.planned() == set()
    used.edit(file, old, new)
    assert used.planned() == again


def test_rules_list_the_modules_that_their_scripts_import(stubs):
    _, printed = stubs.run("--dry-run", "--cores", "1")
    scripts = dict.fromkeys(FIGURES, "draw") | dict.fromkeys(TABLES, "tables")
    inputs = {}
    for block in printed.split("\nrule ")[1:]:
        rule = block.partition(":")[0]
        files = block.partition("output:")[0].split(", ")
        inputs[scripts.get(rule, rule)] = {Path(file.strip()).name for file in files}
    del inputs["all"]
    assert inputs.keys() == {*STAGES, "draw", "tables", *TEXTS}
    # A project says where files are, and makes pictures for comparisons.
    folders = [str(BEYOND / "src"), str(BEYOND / "workflow"), str(ROOT / "src")]
    for name, files in inputs.items():
        folder = BEYOND / "workflow" / ("studies/stages" if name in STAGES else "scripts")
        finder = ModuleFinder(path=folders, excludes=["project"])
        finder.run_script(f"{folder}/{name}.py")
        modules = {
            Path(module.__file__).name for module in finder.modules.values() if module.__file__
        }
        assert modules - NO_NUMBER <= files, name
    # The lists have the __init__.py of the library. Those of the studies have a docstring only.
    for file in (BEYOND / "workflow").rglob("__init__.py"):
        assert len(ast.parse(file.read_text("utf-8")).body) == 1, file


@pytest.mark.parametrize(
    "changes, line",
    [
        ("release: sticky", "release: 'sticky' is not one of ['displacement', 'force']"),
        ("impacts: {ext_instant: {n: 0}}", "impacts.ext_instant.n: 0 is less than"),
        (
            "stiffness_map: {ext_map: {position: 3}}",
            "stiffness_map.ext_map.position: unknown key, did you mean positions?",
        ),
        (
            "impacts: {ext_instant: {release: force}}",
            "impacts.ext_instant.release: a setting of the whole run, not of an entry",
        ),
        ("answers: {}\nanswers: {}", "mine.yaml, line 2: answers stands twice: write its keys"),
    ],
)
def test_a_mistake_is_one_line(stubs, tmp_path, changes, line):
    file = tmp_path / "mine.yaml"
    file.write_text(changes, "utf-8")
    status, _ = stubs.run("--dry-run", "ext_map", "--configfile", str(file))
    assert str(status).startswith(f"configuration: {line}") and "\n" not in str(status)


def test_the_abstract_has_at_most_250_words():
    article = (BEYOND / "article.md").read_text("utf-8")
    (abstract,) = re.findall(r"## Abstract\n\n(.*?)\n\n## ", article, re.DOTALL)
    assert len(abstract.split()) <= 250

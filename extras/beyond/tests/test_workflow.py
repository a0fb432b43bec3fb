"""The workflow: targets, reruns, inputs, refused configurations, and the comparison.

In most tests the scripts only write their outputs: the rules are tested, and no numbers.
"""

import ast
import contextlib
import io
import json
import os
import re
import shutil
import sys
import warnings
from modulefinder import ModuleFinder
from pathlib import Path
from unittest import mock

import netCDF4
import pytest
import yaml
from snakemake import cli

from bouncing_ball.compare import Comparison
from bouncing_ball.datasets import read
from bouncing_ball.history import contents
from studies.products import PRODUCTS

BEYOND = Path(__file__).resolve().parents[1]
ROOT = BEYOND.parents[1]
# It only writes the outputs, and names the modules that the true script imports.
STUB = """from pathlib import Path
for file in snakemake.output:
    Path(file).write_text("made by a stub")
if False:
    {imports}
"""
FILES = {
    **{
        name: {"nc", "png", "svg"}
        for name in ("ext_answers", "ext_impact", "ext_instant", "ext_map", "ext_phase")
    },
    **{name: {"nc", "png", "svg", "md", "csv"} for name in ("ext_orders", "ext_laws")},
    "ext_basin": {"nc"},
    "explorer": {"nc", "html"},
}
STAGES = {
    "answers": ["ext_answers"],
    "impacts": ["ext_impact", "ext_instant"],
    "error_law": ["ext_orders"],
    "stiffness_map": ["ext_map"],
    "contact_laws": ["ext_laws"],
    "phases": ["ext_phase"],
}


def files(*names):
    """The files of figures, as results."""
    return {f"figures/{name}.{kind}" for name in names for kind in FILES[name]}


class Checkout:
    """A copy of the workflow, with shortcuts to run and to change it."""

    def __init__(self, path: Path):
        self.path = path

    def run(self, *arguments: str) -> tuple[int | str, str]:
        """Snakemake's command in the copy: its exit status and what it prints."""
        printed = io.StringIO()
        variables = dict(os.environ)
        with (
            # Those of Snakemake's code: files left open, deprecated arguments.
            warnings.catch_warnings(action="ignore"),
            contextlib.chdir(self.path / "extras/beyond"),
            contextlib.redirect_stdout(printed),
            contextlib.redirect_stderr(printed),
            # The profile reads the command line.
            mock.patch.object(sys, "argv", ["snakemake", *arguments]),
            pytest.raises(SystemExit) as ended,
        ):
            cli.main([*arguments])
        os.environ.clear()
        os.environ.update(variables)
        return ended.value.code, printed.getvalue()

    def plan(self, *targets: str, options: tuple[str, ...] = ()) -> str:
        """What a dry run prints."""
        always = ["--dry-run", "--cores", "1", "--quiet", "host"]
        status, printed = self.run(*always, *options, "--", *targets)
        assert status == 0, printed
        return printed

    def planned(self, *arguments: str) -> set[str]:
        """The rules whose jobs a run would execute."""
        jobs = re.findall(r"^(\w+) +\d+$", self.plan(*arguments), re.MULTILINE)
        return {*jobs} - {"total"}

    def made(self) -> set[str]:
        """The results of a run."""
        base = self.path / "extras/beyond/results"
        found = {str(path.relative_to(base)) for path in base.rglob("*") if path.is_file()}
        return {name for name in found if not name.startswith(("logs/", "benchmarks/"))}


def copied(folder: Path) -> Checkout:
    """The workflow with scripts that only write their outputs."""
    without = shutil.ignore_patterns("__pycache__")
    for name in ("config", "profiles", "src", "workflow"):
        shutil.copytree(BEYOND / name, folder / "extras/beyond" / name, ignore=without)
    shutil.copyfile(BEYOND / "Snakefile", folder / "extras/beyond/Snakefile")
    for name in ("src", "workflow"):
        shutil.copytree(ROOT / name, folder / name, ignore=without)
    for script in (folder / "extras/beyond/workflow/scripts").glob("*.py"):
        nodes = ast.walk(ast.parse(script.read_text("utf-8")))
        imports = [
            ast.unparse(node) for node in nodes if isinstance(node, ast.Import | ast.ImportFrom)
        ]
        script.write_text(STUB.format(imports="\n    ".join(imports)), encoding="utf-8")
    return Checkout(folder)


@pytest.fixture(scope="module")
def complete(tmp_path_factory):
    """The workflow after a whole run. Tests plan further runs here, and change nothing."""
    checkout = copied(tmp_path_factory.mktemp("complete"))
    status, printed = checkout.run("--cores", "2")
    assert status == 0, printed
    return checkout


@pytest.fixture
def used(complete, tmp_path):
    """A copy after a whole run, for one test."""
    shutil.copytree(complete.path, tmp_path / "checkout")
    return Checkout(tmp_path / "checkout")


# Targets


def test_a_whole_run_makes_every_file(complete):
    texts = {"article.md", "appendix.md", "phase.md", "figures/README.md"}
    assert complete.made() == files(*FILES) | texts


def test_every_name_is_a_target(complete):
    lines = complete.run("--list")[1].splitlines()
    targets = {line.split()[0] for line in lines}
    assert {*FILES, *STAGES, "all", "article", "diff", "accept"} <= targets


def test_a_figure_needs_its_stage_only(complete):
    fresh = complete.path / "extras/beyond/results"
    fresh.rename(complete.path / "aside")
    try:
        for stage, names in STAGES.items():
            tables = {"table"} if "md" in FILES[names[0]] else set()
            assert complete.planned(names[0]) == {f"compute_{stage}", stage, names[0]} | tables
        assert complete.planned("explorer") == {"compute_explorer", "explorer"}
        assert complete.planned("ext_basin") == {"compute_basins", "ext_basin"}
    finally:
        (complete.path / "aside").rename(fresh)


def test_the_comparison_knows_what_else_is_requested(complete):
    def inputs(*targets):
        plan = complete.plan(*targets, "diff")
        (block,) = re.findall(r"^(?:local)?rule diff:\n +input: (.*)", plan, re.MULTILINE)
        return {file for file in block.split(", ") if file.startswith("results/")}

    assert inputs("ext_map") == {f"results/{file}" for file in files("ext_map")}
    assert inputs("impacts") == {f"results/{file}" for file in files(*STAGES["impacts"])}
    assert len(inputs()) == len(complete.made())


# Reruns


def test_nothing_runs_again_although_every_file_was_touched(used):
    for path in used.path.rglob("*.*"):
        if path.is_file() and "results" not in path.parts:
            path.touch()
    assert used.planned() == set()


@pytest.mark.parametrize(
    ("old", "new", "again"),
    [
        ("positions: 41", "positions: 31", {"compute_stiffness_map", "stiffness_map"}),
        (
            "release: displacement",
            "release: force",
            {"compute_impacts", "impacts", "compute_error_law", "error_law", "table"},
        ),
    ],
)
def test_a_parameter_runs_its_stages_again(used, old, new, again):
    path = used.path / "extras/beyond/config/config.yaml"
    text = path.read_text("utf-8")
    assert text.count(old) == 1
    path.write_text(text.replace(old, new), "utf-8")
    assert used.planned() == again | {"article", "all"}


@pytest.mark.parametrize(
    ("file", "again"),
    [
        ("extras/beyond/workflow/studies/figures.py", {*STAGES, "all"}),
        ("extras/beyond/workflow/explorer/model.js", {"explorer", "all"}),
        ("extras/beyond/workflow/templates/article.md.j2", {"article", "all"}),
        (
            "extras/beyond/workflow/scripts/impacts.py",
            {"compute_impacts", "impacts", "article", "all"},
        ),
        ("src/bouncing_ball/compare.py", set()),
        ("extras/beyond/config/schema.yaml", set()),
    ],
)
def test_a_changed_file_runs_what_reads_it_again(used, file, again):
    with (used.path / file).open("a", encoding="utf-8") as opened:
        opened.write("# changed\n")
    assert used.planned() == again


# Inputs


def test_rules_have_the_modules_that_their_scripts_import_as_inputs(complete):
    blocks = complete.plan("all", "diff", options=("--forceall",)).split("rule ")
    blocks += complete.plan("accept").split("rule accept")[1:]
    scripts = set()
    for block in blocks:
        code = re.findall(r"[\w./]+\.py(?=[,\n])", block)
        script = next((path for path in code if path.startswith("workflow/scripts/")), None)
        if script is None:
            continue
        scripts.add(Path(script).name)
        folders = [BEYOND / "src", BEYOND / "workflow", ROOT / "src"]
        found = ModuleFinder(path=[*map(str, folders)])
        found.run_script(str(BEYOND / script))
        modules = {Path(each.__file__) for each in found.modules.values() if each.__file__}
        assert {(BEYOND / path).resolve() for path in code} == modules, script
    assert scripts == {path.name for path in (BEYOND / "workflow/scripts").glob("*.py")}


# Configuration


@pytest.mark.parametrize(
    ("changes", "line"),
    [
        ({"release": "sticky"}, "release: 'sticky' is not one of ['displacement', 'force']"),
        ({"impacts": {"ext_instant": {"n": 0}}}, "impacts.ext_instant.n: 0 is less than"),
        ({"stiffness_map": {"ext_map": {"position": 3}}}, "unknown key stiffness_map.ext_map.pos"),
        (
            {"error_law": {"ext_orders": {"amplitude": 0.5}}},
            "error_law.ext_orders.amplitude = 0.5: must be at least 0.666398",
        ),
        (
            {
                "contact_laws": {
                    "ext_laws": {"further": [{"n": 2, "restitution": 0.5, "amplitude": 2}]}
                }
            },
            "contact_laws.ext_laws.further[0].amplitude = 2: must be at least 2.0944",
        ),
        (
            {"stiffness_map": {"ext_map": {"restitution": {"min": 0.99}}}},
            "stiffness_map.ext_map.restitution.min = 0.99: must be less than max = 0.99",
        ),
    ],
)
def test_a_mistake_is_one_line(complete, tmp_path, changes, line):
    file = tmp_path / "mine.yaml"
    file.write_text(yaml.safe_dump(changes), "utf-8")
    status, _ = complete.run("--dry-run", "ext_map", "--configfile", str(file))
    assert str(status).startswith(f"configuration: {line}") and "\n" not in str(status)


def test_a_broken_file_is_one_line_before_snakemake_reads_it(complete, tmp_path):
    """By the profile, and by the checks of the replication."""
    file = tmp_path / "mine.yaml"
    file.write_text("release: force\n\timpacts: {}\n", "utf-8")
    status, _ = complete.run("--list", "--configfile", str(file))
    assert str(status).startswith(f"configuration: {file}, line 2: ") and "\n" not in str(status)
    assert str(complete.run("--list", "--config", "x")[0]).startswith("configuration: --config x: ")


# Comparison


@pytest.fixture
def results(tmp_path):
    """The accepted files of one figure, as results that were made by the script of today."""
    (tmp_path / "figures").mkdir()
    for path in (BEYOND / "figures").glob("ext_impact.*"):
        shutil.copyfile(path, tmp_path / "figures" / path.name)
    code = json.dumps(contents([BEYOND / "workflow/scripts/impacts.py"]))
    with netCDF4.Dataset(tmp_path / "figures/ext_impact.nc", "a") as file:
        file.setncattr("code", code)
    return tmp_path


def compared(results, name):
    config = yaml.safe_load((BEYOND / "config/config.yaml").read_text("utf-8"))
    return Comparison(results, BEYOND, PRODUCTS, config, [name])


def test_the_reference_agrees_with_itself(results):
    report = compared(results, "ext_impact")
    assert [finding.line for finding in report.findings] == []
    assert len(report.files) == 3


def test_a_changed_number_is_found(results):
    path = results / "figures/ext_impact.nc"
    data = read(path)
    data["restitution"][0, 7] *= 1 + 1e-7
    data.to_netcdf(path)
    line = compared(results, "ext_impact").findings[0].line
    assert line.startswith("ext_impact: restitution is ")
    assert " changed" in line or "unknown" in line


def test_a_text_that_its_datasets_do_not_give_is_found(tmp_path):
    shutil.copytree(BEYOND / "figures", tmp_path / "figures")
    article = (BEYOND / "article.md").read_text("utf-8")
    (tmp_path / "article.md").write_text(article.replace("82.18", "82.17", 1), "utf-8")
    findings = compared(tmp_path, "article").findings
    assert [finding.artifact for finding in findings] == ["article"]


# Texts


@pytest.mark.parametrize("file", ["metadata.yaml", "CITATION.cff"])
def test_the_abstract_is_that_of_the_article(file):
    described = yaml.safe_load((BEYOND / file).read_text("utf-8"))["abstract"]
    article = (BEYOND / "article.md").read_text("utf-8")
    (abstract,) = re.findall(r"## Abstract\n\n(.*?)\n\n## ", article, re.DOTALL)
    assert described.split() == abstract.split()

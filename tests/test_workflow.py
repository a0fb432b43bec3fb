"""The graph of the workflow: its targets, and what runs again after a change.

The scripts only write their outputs here (see checkout.py): the rules are tested, and no numbers.
"""

import ast
import os
import subprocess
import sys
import tomllib
from modulefinder import ModuleFinder
from pathlib import Path

import pytest
from tests.checkout import ROOT, Checkout
from tests.reference import CONFIG, stage

from paper_replication.configuration import entries, stages
from paper_replication.datasets import settings_of

COMPUTED = stages(CONFIG).keys() - {"schematics"}
ENTRIES = entries(CONFIG)
FIGURES = {name for name, entry in ENTRIES.items() if "caption" in entry}
IMPACTS = CONFIG["restitution_model"]["three_balls"]["impacts"]
TABLES = {name for name, entry in ENTRIES.items() if entry.get("table")}
TEXTS = {"claims", "choices", "article"}
NO_NUMBER = {"paper_replication/provenance.py"}
NO_NUMBER |= {f"paper_replication/{name}.j2" for name in ("diff.html", "diff.txt", "verdict")}
"""Modules and templates that decide no number: they are in no list of code."""
MODELS = {f"bouncing_ball/{path.name}" for path in (ROOT / "src/bouncing_ball").iterdir()}
MODELS |= {"paper_replication/datasets.py", "scripts/stage.py"}


def test_a_whole_run_makes_every_file_of_the_reference(complete):
    files = {f"figures/{path.name}" for path in (ROOT / "figures").iterdir()}
    pages = {f"{name}.html" for name in ("index", "claims", "paper", "supplement", "numbers")}
    texts = {"paper.md", "supplement.md", *pages}
    results = complete.made()
    assert files - {"figures/accepted.json"} | texts <= results
    # A figure that is new is not accepted yet.
    assert {Path(file).stem for file in results - files - texts} <= ENTRIES.keys()


def test_each_stage_runs_its_script_with_the_settings_that_its_functions_take(complete):
    for name in COMPUTED:
        needed = set().union(*map(settings_of, stage(name).STAGE.values()))
        record = complete.path / f"results/records/{name}.json"
        assert record.read_text("utf-8") == f"{name} {sorted(needed)}"


def test_a_name_makes_its_files_and_needs_its_stage_only(fresh):
    assert fresh.planned("fig01") == {"fig01"}
    assert fresh.planned("table1") == {"continuation", "table1"}
    assert fresh.planned("continuation") == {"continuation"}
    assert fresh.planned("fig14", "diff") == {"error_thresholds", "fig14", "diff"}
    stage = {"error_thresholds", "fig14", "thresholds", "diff"}
    assert fresh.planned("error_thresholds", "diff") == stage
    assert fresh.run("--cores", "1", "fig14")[0] == 0
    files = {f"figures/fig14.{kind}" for kind in ("nc", "png", "svg")}
    assert fresh.made() == files | {"figures/thresholds.nc"}


def test_a_comparison_without_names_makes_everything(fresh):
    assert fresh.planned("diff") == fresh.planned() | {"diff"}


def test_make_computes_what_it_judges():
    """The results that are accepted are judged first; a replication begins with nothing."""

    def commands(target):
        command = ["make", "--dry-run", "-C", str(ROOT), target]
        return subprocess.check_output(command, text=True).splitlines()

    judged = [line for line in commands("accept") if "pytest" in line or "snakemake" in line]
    assert [line.endswith(" accept") for line in judged] == [False, False, True]
    assert "CANDIDATE=results" in judged[1]
    assert f"{judged[0].rstrip()} --forceall diff" in commands("replication")


def test_a_run_in_another_folder_has_its_own_results(fresh, tmp_path):
    mine = tmp_path / "mine"
    mine.mkdir()
    (mine / "mine.yaml").write_text("error_thresholds: {fig14: {restitution: 0.7}}", "utf-8")
    command = ["--directory", str(mine), "--configfile", str(mine / "mine.yaml"), "--", "fig14"]
    assert fresh.run("--cores", "1", *command)[0] == 0
    assert "figures/fig14.png" in Checkout(mine).made() and not (fresh.path / "results").exists()


def test_another_workflow_has_it_as_a_module_with_a_prefix(fresh, tmp_path, monkeypatch):
    """Its jobs import the modules of a folder that it names itself, too."""
    outer = Checkout(tmp_path / "outer")
    outer.path.mkdir()
    (outer.path / "of_the_host.py").touch()
    monkeypatch.setenv("PYTHONPATH", str(outer.path))
    (outer.path / "Snakefile").write_text(
        f"""
configfile: "{fresh.path / "config/config.yaml"}"
module ball:
    snakefile: "{fresh.path / "Snakefile"}"
    config: config
    prefix: "ball"
use rule * from ball as ball_*
rule mine:
    input: "ball/results/figures/fig14.png"
    shell: "{sys.executable} -c 'import of_the_host, bouncing_ball'"
""",
        "utf-8",
    )
    assert outer.planned("mine") == {"ball_error_thresholds", "ball_fig14", "mine"}
    assert outer.run("--cores", "1", "mine")[0] == 0
    assert "figures/fig14.png" in outer.made("ball/results")


def test_the_page_of_an_earlier_comparison_is_removed(fresh):
    page = fresh.path / "results/diff/index.html"
    page.parent.mkdir(parents=True)
    page.write_text("of an earlier run", "utf-8")
    assert fresh.run("--cores", "1", "fig01")[0] == 0
    assert not page.exists()


@pytest.mark.parametrize(
    "file, old, new, again",
    [
        (
            "config/config.yaml",
            f"impacts: {IMPACTS}",
            f"impacts: {IMPACTS + 1}",
            {"restitution_model", "fig02", "fig03", *TEXTS},
        ),
        # A whole number may be written as a float.
        ("config/config.yaml", f"impacts: {IMPACTS}", f"impacts: {IMPACTS / 1e3}e+3", set()),
        # Which limit a claim has decides which choices change its verdict.
        ("src/carbonelli2011/claims.py", "LINE = 0.01", "LINE = 0.02", {*TABLES, *TEXTS}),
        (
            "config/config.yaml",
            f"step: {CONFIG['largest_step']}",
            f"step: {CONFIG['largest_step'] / 2}",
            {"continuation", "fig08", "fig09", "fig15", "table1", *TEXTS},
        ),
        ("src/carbonelli2011/figures.py", "import", "import  ", FIGURES),
        ("src/carbonelli2011/variables.py", "import", "import  ", set()),
        ("src/paper_replication/compare.py", "import", "import  ", set()),
        ("src/carbonelli2011/templates/paper.md.j2", "the", "a", {"article"}),
    ],
)
def test_a_change_runs_again_what_follows_from_it(used, file, old, new, again):
    for path in used.path.rglob("*.*"):
        path.touch()
    assert used.planned() == set()
    used.edit(file, old, new)
    assert used.planned() == again


def test_a_new_module_runs_again_what_may_import_it(used):
    """However old the file is."""
    for path in used.path.rglob("*.*"):
        path.touch()
    new = used.path / "src/bouncing_ball/extra.py"
    new.touch()
    os.utime(new, (0, 0))
    assert used.planned() >= {*COMPUTED}


def imports(package: str) -> set[str]:
    """The packages that the modules of a package import."""
    trees = [ast.parse(path.read_text("utf-8")) for path in (ROOT / "src" / package).glob("*.py")]
    nodes = [node for tree in trees for node in ast.walk(tree)]
    names = [node.module for node in nodes if isinstance(node, ast.ImportFrom)]
    names += [alias.name for node in nodes if isinstance(node, ast.Import) for alias in node.names]
    return {name.partition(".")[0] for name in names}


def test_the_models_and_what_any_replication_needs_import_no_other_package():
    libraries = {"numpy", "scipy", "bouncing_ball"}
    assert imports("bouncing_ball") <= sys.stdlib_module_names | libraries
    assert not imports("paper_replication") & {"bouncing_ball", "carbonelli2011"}


def test_no_package_has_code_of_its_own():
    """The lists of the rules leave them out: they have a docstring, and perhaps a version."""
    for file in (ROOT / "src").rglob("__init__.py"):
        documentation, *others = ast.parse(file.read_text("utf-8")).body
        assert isinstance(documentation, ast.Expr), file
        assert [ast.unparse(statement).partition(" = ")[0] for statement in others] in (
            [],
            ["__version__"],
        )


def test_a_wheel_has_every_file_of_its_packages():
    setuptools = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["tool"]["setuptools"]
    patterns = ["*.py", *setuptools["package-data"]["*"]]
    packages = [path.parent for path in (ROOT / "src").rglob("__init__.py")]
    packed = {
        file for package in packages for pattern in patterns for file in package.glob(pattern)
    }
    files = {path for package in packages for path in package.rglob("*.*")}
    assert {path for path in files if path.suffix != ".pyc"} == packed


def modules_of(script: Path) -> set[str]:
    """The modules of the package and the scripts that a script imports, directly or by another
    module, each with its folder.
    """
    # A project says where files are, and makes pictures for comparisons.
    finder = ModuleFinder(path=[str(ROOT / "src")], excludes=["project"])
    finder.run_script(str(script))
    files = {Path(module.__file__) for module in finder.modules.values() if module.__file__}
    return {in_folder(path) for path in files if path.name != "__init__.py"}


def in_folder(path: Path) -> str:
    """The name of a file with that of its folder: scripts and modules share some names."""
    return f"{path.parent.name}/{path.name}"


def test_rules_list_the_modules_and_templates_that_their_scripts_read(stubs):
    _, printed = stubs.run("--dry-run", "--cores", "1")
    scripts = dict.fromkeys(FIGURES, "draw") | dict.fromkeys(TABLES, "tables")
    inputs = {}
    for block in printed.split("\nrule ")[1:]:
        rule = block.partition(":")[0]
        files = block.partition("output:")[0].split(", ")
        inputs[scripts.get(rule, rule)] = {in_folder(Path(file.strip())) for file in files}
    del inputs["all"]
    assert inputs.keys() == {*COMPUTED, "draw", "tables", *TEXTS}
    for name, files in inputs.items():
        folder = ROOT / ("src/carbonelli2011/stages" if name in COMPUTED else "workflow/scripts")
        assert f"{folder.name}/{name}.py" in files
        modules = modules_of(folder / f"{name}.py") - NO_NUMBER
        assert modules <= files, name
        # All models count for all that computes.
        assert {file for file in files - modules - MODELS if file.endswith(".py")} == set(), name
    templates = {in_folder(path) for path in (ROOT / "src").rglob("*.j2")} - NO_NUMBER
    assert {file for file in inputs["article"] if file.endswith(".j2")} == templates


def test_parameters_without_an_orbit_are_one_line_with_the_name_of_the_figure(tmp_path):
    """The closed forms do not know where a compliant contact has its first orbit."""
    (tmp_path / "mine.yaml").write_text("continuation: {fig08: {frequency_ratio: [0.5]}}", "utf-8")
    command = [sys.executable, "-m", "snakemake", "--snakefile", str(ROOT / "Snakefile")]
    command += ["--cores", "1", "--configfile", "mine.yaml", "--", "fig08"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    (log,) = (tmp_path / "results/logs").glob("*.log")
    (line,) = log.read_text("utf-8").splitlines()
    assert done.returncode == 1 and line in done.stderr
    assert line.startswith("configuration: fig08: no 1-T orbit is found at Λ = 1.5 and ϖ = 0.5: ")


def test_a_failed_figure_does_not_stop_others(fresh):
    draw = fresh.path / "workflow/scripts/draw.py"
    draw.write_text("if 'fig16' in snakemake.output[0]:\n    1 / 0\n" + draw.read_text(), "utf-8")
    assert fresh.run("--cores", "1", "fig16", "fig11")[0] == 1
    assert fresh.made() >= {"figures/fig11.png"}
    assert "figures/fig16.png" not in fresh.made()

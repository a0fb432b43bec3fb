"""The graph of the workflow: its targets, what runs again after a change, and where it can run.

The scripts only write their outputs here (see conftest): the rules are tested, and no numbers.
"""

import ast
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
import tomllib
from functools import cache
from importlib.util import find_spec
from modulefinder import ModuleFinder
from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).resolve().parents[1]
CONFIG = yaml.safe_load((ROOT / "config/config.yaml").read_text("utf-8"))
ENTRIES = {
    stage: {name: entry for name, entry in section.items() if name != "title"}
    for stage, section in CONFIG.items()
    if isinstance(section, dict)
}
FIGURES = {
    name for entries in ENTRIES.values() for name, entry in entries.items() if "caption" in entry
}
TABLES = {
    name for entries in ENTRIES.values() for name, entry in entries.items() if "table" in entry
}
TABLES |= {"claims"}
# The stages that compute something, and those that draw something from it.
STAGES = {stage: {*names} for stage, names in ENTRIES.items() if stage != "schematics"}
DRAWN = {stage: names for stage, names in STAGES.items() if names & FIGURES}
DATASETS = {*set().union(*STAGES.values()), "claims"}
# What is made from all datasets.
TEXTS = {"claims", "article", "all"}


def made(folder: Path) -> set[str]:
    """The results in a folder of a run."""
    base = folder / "results"
    files = {str(path.relative_to(base)) for path in base.rglob("*") if path.is_file()}
    return {name for name in files if not name.startswith(("logs/", "benchmarks/"))}


def files(name: str) -> set[str]:
    """The files of a figure, a table or a dataset."""
    kinds = {"nc": DATASETS, "png": FIGURES, "svg": FIGURES, "md": TABLES, "csv": TABLES}
    return {f"figures/{name}.{kind}" for kind, names in kinds.items() if name in names}


# Targets


def test_a_whole_run_makes_every_file(complete):
    expected = set().union(*map(files, [*FIGURES, *DATASETS]))
    assert made(complete.path) == expected | {
        "paper.md",
        "supplement.md",
        "figures/README.md",
        "index.html",
    }


def test_a_stage_makes_its_datasets_and_pictures(stubs):
    """All stages in one plan: the rules of a stage, what they make, and nothing else."""
    plan = stubs.plan(*DRAWN)
    jobs = re.findall(r"^rule (\w+):\n(?: +input: .*\n)? +output: (.*)", plan, re.MULTILINE)
    made = {rule: {*re.findall(r"results/([\w/]+\.\w+)", outputs)} for rule, outputs in jobs}
    for stage, names in DRAWN.items():
        assert made.pop(f"compute_{stage}") == {f"figures/{name}.nc" for name in names}
        pictures = {file for name in names & FIGURES for file in files(name)}
        assert made.pop(stage) == {file for file in pictures if not file.endswith(".nc")}
    assert made == {}


@pytest.mark.parametrize(
    "names, rules",
    [
        (["fig01"], {"schematics"}),
        (["fig11"], {"compute_permanent_contact", "permanent_contact"}),
        (
            ["table1", "three_balls", "readings"],
            {"compute_continuation", "compute_restitution_model", "compute_readings", "table"},
        ),
    ],
)
def test_a_figure_a_table_and_a_dataset_need_their_stage_only(stubs, names, rules):
    assert stubs.planned(*names) == rules | {*names}


def test_every_name_is_a_target_and_the_list_of_targets_fits_on_a_screen(stubs):
    lines = stubs.run("--list")[1].splitlines()
    lines = [line for line in lines if not line.startswith("Using ")]
    targets = {line.split()[0] for line in lines}
    assert all(line.endswith(")") for line in lines)  # each has a description
    assert {
        *FIGURES,
        *DATASETS,
        *DRAWN,
        "schematics",
        "all",
        "article",
        "diff",
        "accept",
    } <= targets
    assert len(lines) <= 50 and max(map(len, lines)) <= 100


def test_the_comparison_knows_what_else_is_requested(stubs):
    def inputs(rule, *targets):
        plan = stubs.plan(*targets, rule)
        (block,) = re.findall(rf"^(?:local)?rule {rule}:\n +input: (.*)", plan, re.MULTILINE)
        return {file for file in block.split(", ") if file.startswith("results/")}

    assert inputs("diff", "fig11") == {f"results/{file}" for file in files("fig11")}
    both = files("fig02") | files("fig03") | files("three_balls") | files("fig01")
    assert inputs("accept", "restitution_model", "fig01") == {f"results/{file}" for file in both}
    assert len(inputs("diff")) == len(set().union(*map(files, [*FIGURES, *DATASETS]))) + 4


def test_a_comparison_and_an_acceptance_are_two_commands(stubs):
    line = "diff and accept are two commands: compare, look at the page, then accept"
    assert stubs.run("--dry-run", "fig11", "accept", "diff")[0] == line


# Reruns


def test_nothing_runs_again_although_every_file_was_touched(used):
    for path in used.path.rglob("*.*"):
        if path.is_file() and "results" not in path.parts:
            path.touch()
    assert used.planned() == {"all"}


def test_a_parameter_runs_its_stage_again(used):
    path = used.path / "config/config.yaml"
    text = path.read_text("utf-8")
    for old, new, again in [
        ("impacts: 1024", "impacts: 1000", {"compute_restitution_model", "restitution_model"}),
        (
            "largest_step: 0.2",
            "largest_step: 0.1",
            {"compute_continuation", "continuation", "table"},
        ),
    ]:
        assert text.count(old) == 1
        path.write_text(text.replace(old, new), "utf-8")
        assert used.planned() == again | TEXTS


@pytest.mark.parametrize(
    "file, again",
    [
        ("src/bouncing_ball/figures.py", {"schematics", *DRAWN, "all"}),
        ("src/bouncing_ball/claims.py", {"table", *TEXTS}),
        ("src/bouncing_ball/compare.py", {"all"}),
        (
            "workflow/scripts/permanent_contact.py",
            {"compute_permanent_contact", "permanent_contact", *TEXTS},
        ),
        ("workflow/templates/paper.md.j2", {"article", "all"}),
        ("config/schema.yaml", {"all"}),
    ],
)
def test_a_changed_file_runs_what_reads_it_again(used, file, again):
    used.append(file, "# changed")
    assert used.planned() == again


@cache
def modules_of(script: str) -> set[str]:
    """The names of the files of a script and of what it imports of this repository."""
    found = ModuleFinder(path=[str(ROOT / "src")])
    found.run_script(str(ROOT / script))
    return {Path(each.__file__).name for each in found.modules.values() if each.__file__}


def test_rules_have_the_modules_that_their_scripts_import_as_inputs(stubs):
    blocks = stubs.plan("all", "diff").split("rule ")
    blocks += stubs.plan("accept").split("rule accept")[1:]
    scripts = set()
    for block in blocks:
        code = re.findall(r"[\w/]+\.py(?=[,\n])", block)
        script = next((path for path in code if path.startswith("workflow/scripts/")), None)
        if script is None:
            continue
        scripts.add(Path(script).name)
        assert {Path(path).name for path in code} == modules_of(script), script
    assert scripts == {path.name for path in (ROOT / "workflow/scripts").glob("*.py")}


# Failures


def test_a_failed_figure_does_not_stop_other_stages(fresh):
    draw = fresh.path / "workflow/scripts/draw.py"
    condition = "if 'fig16' in snakemake.output.png[-1]:\n    raise SystemExit('no figure')\n"
    draw.write_text(condition + draw.read_text("utf-8"), "utf-8")
    # What an earlier comparison said is not said of this run.
    said = [fresh.path / "results" / file for file in ("diff/index.html", "logs/diff.log")]
    for path in said:
        path.parent.mkdir(parents=True)
        path.write_text("All files agree.", "utf-8")
    assert fresh.run("--cores", "1", "permanent_contact", "fig01")[0] == 1
    assert not any(path.exists() for path in said)
    datasets = {"figures/fig11.nc", "figures/fig16.nc"}
    assert made(fresh.path) == datasets | files("fig01") | files("fig04")


def test_a_killed_run_is_unlocked_and_completed(fresh):
    script = fresh.path / "workflow/scripts/permanent_contact.py"
    at_once = script.read_text("utf-8")
    script.write_text(f"{at_once}import time\ntime.sleep(60)\n", "utf-8")
    # In a group of processes with its job.
    command = [sys.executable, "-m", "snakemake", "--cores", "1", "fig11"]
    running = subprocess.Popen(
        command,
        cwd=fresh.path,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        process_group=0,
    )
    dataset = fresh.path / "results/figures/fig11.nc"
    while not dataset.exists():
        assert running.poll() is None
        time.sleep(0.05)
    os.killpg(running.pid, signal.SIGKILL)
    running.wait()
    script.write_text(at_once, "utf-8")
    dataset.write_text("half of it", "utf-8")
    status, printed = fresh.run("--cores", "1", "fig11")
    assert status == 1 and "--unlock" in printed
    assert fresh.run("--unlock")[0] == 0
    assert fresh.run("--cores", "1", "fig11")[0] == 0
    assert dataset.read_text("utf-8") == "made by a stub"


# Places


def test_a_run_elsewhere_has_its_own_results_and_configuration(fresh, tmp_path):
    elsewhere = tmp_path / "elsewhere"
    (elsewhere / "config").mkdir(parents=True)
    (elsewhere / "config/config.yaml").write_text("release: sticky", "utf-8")
    run = ("--snakefile", str(fresh.path / "Snakefile"), "--cores", "1", "fig11")
    status, _ = fresh.run(*run, folder=elsewhere)
    assert str(status).startswith("configuration: release: 'sticky' is not one of")
    (elsewhere / "config/config.yaml").write_text("release: force", "utf-8")
    assert fresh.run(*run, folder=elsewhere)[0] == 0
    assert made(elsewhere) == files("fig11") | files("fig16")
    assert not (fresh.path / "results").exists()


def test_as_a_module_with_a_prefix_it_reads_this_checkout(fresh, tmp_path):
    outer = tmp_path / "outer"
    # The configuration of the other workflow is not ours.
    (outer / "config").mkdir(parents=True)
    (outer / "config/config.yaml").write_text("samples: [a, b]", "utf-8")
    (outer / "Snakefile").write_text(
        "module ball:\n    snakefile: '../checkout/Snakefile'\n    prefix: 'ball'\n"
        "use rule * from ball as ball_*\n",
        "utf-8",
    )
    status, printed = fresh.run("--cores", "1", "ball_fig11", "ball_table1", folder=outer)
    assert status == 0, printed
    assert made(outer / "ball") >= files("fig11") | files("table1")
    assert not (outer / "results").exists()


@pytest.mark.parametrize("target", [".", "figures", "extras"])
def test_results_inside_the_checkout_are_refused(fresh, target):
    (fresh.path / target).mkdir(exist_ok=True)
    (fresh.path / "results").symlink_to(target)
    place = (fresh.path / target).resolve()
    line = f"results is {place}: results must not be written over the checkout"
    assert fresh.run("--dry-run", "fig11")[0] == line


def test_results_may_be_a_link_to_another_disk_but_not_a_file(fresh, tmp_path):
    results = fresh.path / "results"
    results.symlink_to(tmp_path)
    assert "compute_permanent_contact" in fresh.planned("fig11")
    results.unlink()
    results.write_text("notes", "utf-8")
    line = "results is no folder, but results are written there"
    assert fresh.run("--dry-run", "fig11")[0] == line


def test_the_report_has_every_figure_and_table(used):
    status, printed = used.run("--report", "report.html")
    assert status == 0, printed
    page = (used.path / "report.html").read_text("utf-8")
    titles = [entry["title"] for entries in ENTRIES.values() for entry in entries.values()]
    assert all(json.dumps(title)[1:-1] in page for title in titles if title.startswith("Figure"))
    assert all(f"results/figures/{name}.csv" in page for name in TABLES)
    loaded = re.findall(r"<(?:script|link|img)[^>]+(?:src|href)=[\"'](\w+:[^\"']*)", page)
    assert [url for url in loaded if not url.startswith("data:")] == []


# A cluster

MISSING = [
    name
    for name in ("slurmctld", "slurmd", "sbatch")
    if not shutil.which(name, path=f"{os.environ['PATH']}:/usr/sbin:/sbin")
]
if not find_spec("snakemake_executor_plugin_slurm"):
    MISSING.append("snakemake-executor-plugin-slurm")


@pytest.mark.cluster
@pytest.mark.skipif(bool(MISSING), reason=f"not installed: {', '.join(MISSING)}")
def test_a_stage_runs_on_a_cluster(fresh, tmp_path, monkeypatch):
    loopback = Path(__file__).with_name("slurm_on_loopback.sh")
    subprocess.run([loopback, "start", tmp_path / "slurm"], check=True)
    try:
        monkeypatch.setenv("PATH", f"{tmp_path / 'slurm/bin'}{os.pathsep}{os.environ['PATH']}")
        # Without accounting, squeue knows the state of a job; the rest makes the test short.
        options = ["--profile", "profiles/slurm", "--slurm-no-account", "--latency-wait", "5"]
        options += ["--slurm-status-command", "squeue"]
        options += ["--slurm-init-seconds-before-status-checks", "6"]
        status, printed = fresh.run(*options, "--", "permanent_contact")
    finally:
        subprocess.run([loopback, "stop", tmp_path / "slurm"], check=True)
    assert status == 0, printed
    assert made(fresh.path) == files("fig11") | files("fig16")


# Environments


def test_conda_has_the_versions_of_the_lock_file():
    lock = (ROOT / "requirements.lock").read_text("utf-8")
    locked = dict(re.findall(r"^([\w-]+)==([\d.]+)", lock, re.MULTILINE))
    names = {"matplotlib-base": "matplotlib", "snakemake-minimal": "snakemake"}
    for file in ("environment.yml", "workflow/envs/environment.yaml"):
        for each in yaml.safe_load((ROOT / file).read_text("utf-8"))["dependencies"]:
            name, version = each.split(" =")
            known = locked.get(names.get(name, name), f"{version}.")
            assert f"{known}.".startswith(f"{version}."), f"{file}: {each}"


def test_the_packages_that_scripts_import_are_in_every_environment():
    """Third-party modules of the package and its scripts, in pyproject.toml and for conda."""
    used = set()
    for path in [*ROOT.glob("src/bouncing_ball/*.py"), *ROOT.glob("workflow/scripts/*.py")]:
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.ImportFrom):
                used.add((node.module or "").split(".")[0])
            elif isinstance(node, ast.Import):
                used |= {alias.name.split(".")[0] for alias in node.names}
    used -= {*sys.stdlib_module_names, "bouncing_ball"}
    used = {{"PIL": "pillow", "yaml": "pyyaml"}.get(name, name).lower() for name in used}
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    assert used <= {re.match(r"[\w-]+", each)[0].lower() for each in project["dependencies"]}
    conda = yaml.safe_load((ROOT / "workflow/envs/environment.yaml").read_text("utf-8"))
    names = {each.split(" ")[0].removesuffix("-base") for each in conda["dependencies"]}
    assert used <= names


# Continuous integration


@pytest.mark.parametrize("ci, root", [("", True), ("true", False), ("true", True)])
def test_a_failed_step_does_not_hide_the_others(tmp_path, ci, root):
    """`.ci/run` with a make that notes its targets and fails for the tests, and without a browser.

    It finds the programs of one folder only.
    """
    for name, then in {
        "make": f'echo "$@" >> "{tmp_path}/called"; [ "$1" != test ]',
        "apt-get": f'echo apt-get >> "{tmp_path}/called"; exit 100',
        "id": f"echo {0 if root else 1000}",
    }.items():
        (tmp_path / name).write_text(f"#!/bin/sh\n{then}\n", "utf-8")
        (tmp_path / name).chmod(0o755)
    for name in ("bash", "dirname"):
        (tmp_path / name).symlink_to(shutil.which(name))
    environment = {"PATH": str(tmp_path), "CI": ci}
    done = subprocess.run(
        [ROOT / ".ci/run"], env=environment, capture_output=True, text=True, check=False
    )
    called = (tmp_path / "called").read_text("utf-8").splitlines()
    first = ["setup", "lint", "clean", "all", "diff", "test", "test-cluster"]
    assert called[: len(first)] == first
    extras = [line for line in called[len(first) :] if line != "apt-get"]
    assert all(line.startswith(("-C extras/beyond ", "-C extras/contacts ")) for line in extras)
    assert len(extras) == 9
    assert ("apt-get" in called) == (ci == "true" and root)
    assert ("the tests in a browser are skipped" in done.stdout) == ("apt-get" in called)
    assert "The replication: red in test." in done.stdout
    assert done.returncode == 1 and done.stdout.splitlines()[-1] == "Failed: make test"

"""Another processor: fast paths switched off, the numbers stay within the budgets."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from numpy._core._multiarray_umath import __cpu_dispatch__, __cpu_features__

from bouncing_ball.compare.data import compare_datasets
from bouncing_ball.compare.folders import compare_folders
from bouncing_ball.compare.outcome import Outcome
from bouncing_ball.compare.report_terminal import to_terminal
from bouncing_ball.datasets.netcdf import read_dataset

ROOT = Path(__file__).resolve().parents[2]
STAGES = ("fig05", "fig08")
# Those that numpy has code for and this processor offers.
FEATURES = [name for name in __cpu_dispatch__ if __cpu_features__.get(name)]
# The same for linear algebra and for the C library, which have their own
# switches; where these mean nothing they change nothing.
OLDER = {
    "NPY_DISABLE_CPU_FEATURES": " ".join(FEATURES),
    "OPENBLAS_CORETYPE": "Prescott",
    "GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2,-FMA,-AVX512F",
}

PROGRAM = """
import json, sys
from pathlib import Path
from numpy._core._multiarray_umath import __cpu_features__
from bouncing_ball.configuration.stages import STAGES
from bouncing_ball.configuration.study import load
from bouncing_ball.configuration.yaml_file import read_yaml
from bouncing_ball.datasets.netcdf import write_dataset
config = read_yaml(sys.argv[1])
for name in sys.argv[3:]:
    stage = STAGES[name]
    data = load(stage.study)(stage.parameters(config), *stage.settings(config).values())
    write_dataset(data, Path(sys.argv[2], f"{name}.nc"))
print(json.dumps([name for name, there in __cpu_features__.items() if there]))
"""


needs_switches = pytest.mark.skipif(
    not FEATURES, reason="numpy has no fast path for this processor to switch off"
)


def environment(root: Path, switches: dict[str, str]) -> dict[str, str]:
    """Of a process with these switches only, and with the package from a folder."""
    path = os.pathsep.join([str(root / "src"), os.environ.get("PYTHONPATH", "")])
    kept = {name: value for name, value in os.environ.items() if name not in OLDER}
    return kept | switches | {"PYTHONPATH": path}


def made(folder: Path, switches: dict[str, str]) -> set[str]:
    """Run the stages in a process of its own; the features that it had."""
    config = ROOT / "config" / "config.yaml"
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM, config, folder, *STAGES],
        env=environment(ROOT, switches),
        capture_output=True,
        text=True,
        check=True,
    )
    return set(json.loads(done.stdout))


@pytest.mark.slow
@needs_switches
def test_two_sets_of_processor_features_agree(rules, tmp_path):
    folders = tmp_path / "all", tmp_path / "fewer"
    everything, fewer = made(folders[0], {}), made(folders[1], OLDER)
    assert everything.issuperset(FEATURES) and not fewer & set(FEATURES)
    for name in STAGES:
        record, new = (read_dataset(folder / f"{name}.nc") for folder in folders)
        for result in compare_datasets(name, record, new, rules):
            assert result.outcome.agrees, result


# Everything is made once, in about 40 s.
@pytest.mark.long
@needs_switches
def test_a_whole_run_with_fewer_features_says_what_the_record_says(rules, tmp_path):
    tree = tmp_path / "tree"
    tree.mkdir()
    for name in ("Snakefile", "requirements.lock"):
        shutil.copyfile(ROOT / name, tree / name)
    for name in ("config", "profiles", "src", "workflow"):
        ignored = shutil.ignore_patterns("__pycache__")
        shutil.copytree(ROOT / name, tree / name, ignore=ignored)
    done = subprocess.run(
        [Path(sys.executable).with_name("snakemake"), "--cores", "2", "--quiet"],
        cwd=tree,
        env=environment(tree, OLDER),
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    comparison = compare_folders(ROOT, tree / "results", rules)
    # Else the switches have switched nothing, and this says nothing.
    assert any(found.outcome is not Outcome.IDENTICAL for found in comparison.artifacts)
    assert comparison.outcome.agrees, to_terminal(comparison)


@pytest.mark.long
@needs_switches
def test_the_tests_are_green_with_fewer_features():
    # The last digits of all numbers are others than those of the record. The tests of the
    # workflow compare runs with each other: their part is the whole run above.
    ours = {name: text for name, text in environment(ROOT, OLDER).items() if "PYTEST" not in name}
    command = [sys.executable, "-m", "pytest", "--numprocesses", "2", "-p", "no:cacheprovider"]
    command.append("--ignore=tests/workflow")
    done = subprocess.run(command, cwd=ROOT, env=ours, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout

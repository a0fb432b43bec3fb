"""Another processor: fast paths switched off, the numbers stay within the budgets."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from numpy._core._multiarray_umath import __cpu_dispatch__, __cpu_features__

from bouncing_ball.comparison.datasets import compare_datasets
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
import yaml
from numpy._core._multiarray_umath import __cpu_features__
from bouncing_ball.datasets.netcdf import write_dataset
from bouncing_ball.pipeline.ledger import printed, read_ledger
from bouncing_ball.studies.convergence import stages
folder = Path(sys.argv[1])
config = yaml.safe_load((folder / "config.yaml").read_text(encoding="utf-8"))
made = stages(config, printed(read_ledger(folder), "Table 1"), ["table1"])
for name in sys.argv[3:]:
    write_dataset(made[name].run(), Path(sys.argv[2], f"{name}.nc"))
print(json.dumps([name for name, there in __cpu_features__.items() if there]))
"""


def made(folder: Path, switches: dict[str, str]) -> set[str]:
    """Run the stages in a process of its own; the features that it had."""
    path = os.pathsep.join([str(ROOT / "src"), os.environ.get("PYTHONPATH", "")])
    kept = {name: value for name, value in os.environ.items() if name not in OLDER}
    environment = kept | switches | {"PYTHONPATH": path}
    config = ROOT / "config"
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM, config, folder, *STAGES],
        env=environment,
        capture_output=True,
        text=True,
        check=True,
    )
    return set(json.loads(done.stdout))


@pytest.mark.skipif(not FEATURES, reason="numpy has no fast path for this processor to switch off")
def test_two_sets_of_processor_features_agree(rules, tmp_path):
    folders = tmp_path / "all", tmp_path / "fewer"
    everything, fewer = made(folders[0], {}), made(folders[1], OLDER)
    assert everything.issuperset(FEATURES) and not fewer & set(FEATURES)
    for name in STAGES:
        record, new = (read_dataset(folder / f"{name}.nc") for folder in folders)
        for result in compare_datasets(name, record, new, rules):
            assert result.verdict.agrees, result

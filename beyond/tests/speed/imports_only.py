"""How much a cold run costs over the imports of its processes.

Runs the pipeline twice from clean in copies of this tree, alternately: as it
is, and with every script replaced by its imports. Prints the ratio of the
medians. Not part of the test suite, as a noisy machine would fail it:

    python tests/speed/imports_only.py [repetitions]
"""

import ast
import os
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
IGNORED = shutil.ignore_patterns(".git", ".venv*", "results", ".snakemake", "*.egg-info")
# What xarray and matplotlib import only when they read, write or draw.
LATE_DATA = "import netCDF4, xarray.backends.netCDF4_\n"
LATE_FIGURE = (
    "import matplotlib.backends.backend_agg, matplotlib.backends.backend_svg\n"
    "import PIL.Image, PIL.PngImagePlugin\nPIL.Image.preinit()\n"
)
FINISH = """
for path in (*snakemake.output, *snakemake.log):
    open(path, "w").close()
"""


def reduce_to_imports(script: Path) -> None:
    """Replace a script of the workflow by its imports and empty outputs."""
    tree = ast.parse(script.read_text(encoding="utf-8"))
    imports = [node for node in tree.body if isinstance(node, ast.Import | ast.ImportFrom)]
    text = "".join(ast.unparse(node) + "\n" for node in imports) + LATE_DATA
    if script.stem.startswith("draw_"):
        text += LATE_FIGURE
    script.write_text(text + FINISH, encoding="utf-8")


def cold_run(tree: Path) -> float:
    """Seconds that one run takes from a clean tree."""
    for folder in ("results", ".snakemake"):
        shutil.rmtree(tree / folder, ignore_errors=True)
    command = [Path(sys.executable).with_name("snakemake"), "--cores", "2", "--quiet", "all"]
    environment = os.environ | {"PYTHONPATH": str(tree / "src")}
    start = time.perf_counter()
    subprocess.run(command, cwd=tree, check=True, capture_output=True, env=environment)
    return time.perf_counter() - start


def compared(repetitions: int) -> str:
    """A sentence on the time of a cold run and of its imports."""
    with tempfile.TemporaryDirectory() as folder:
        whole = Path(folder, "whole")
        bare = Path(folder, "bare")
        for tree in (whole, bare):
            shutil.copytree(ROOT, tree, ignore=IGNORED)
        for script in (bare / "workflow" / "scripts").glob("*.py"):
            reduce_to_imports(script)
        times = [(cold_run(whole), cold_run(bare)) for _ in range(repetitions)]
    pipeline, imports = (statistics.median(column) for column in zip(*times, strict=True))
    return (
        f"A cold run of the pipeline takes {pipeline:.1f} s and its imports alone {imports:.1f} s, "
        f"a ratio of {pipeline / imports:.2f} (medians of {repetitions})."
    )


if __name__ == "__main__":
    print(compared(int(sys.argv[1]) if len(sys.argv) > 1 else 3))

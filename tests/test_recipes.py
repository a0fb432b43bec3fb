"""The recipes of CONTRIBUTING.md, followed in a copy of the checkout: what is registered in three
files is made, listed, drawn and shown, and the tests stay green before and after it is accepted.
"""

import os
import re
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

from bouncing_ball.datasets import read

ROOT = Path(__file__).resolve().parents[1]
FOLDERS = ("config", "docs", "figures", "profiles", "src", "tests", "workflow")
FILES = ("Snakefile", "CONTRIBUTING.md", "pyproject.toml")


def code(start: str) -> str:
    """The example of CONTRIBUTING that begins with a line, without its indentation there."""
    text = (ROOT / "CONTRIBUTING.md").read_text("utf-8")
    blocks = re.findall(r"^( *)```(?:yaml|python)\n(.*?)^ *```", text, re.DOTALL | re.MULTILINE)
    (found,) = (
        re.sub(f"^{indent}", "", block, flags=re.MULTILINE)
        for indent, block in blocks
        if block.strip().startswith(start)
    )
    return found


def insert(file: Path, before: str, text: str) -> None:
    """Insert a text before the only occurrence of another in a file."""
    old = file.read_text("utf-8")
    assert old.count(before) == 1, (file, before)
    file.write_text(old.replace(before, text + before), "utf-8")


# In the copy, whose package and scripts it imports: new datasets and pictures, and the tests that
# the entries of the registry decide, before anything is accepted and as if it were.
GREEN = """
import importlib
import shutil
import sys
from pathlib import Path

import pytest
import yaml

from bouncing_ball import datasets, drawing, figures

sys.path.append("workflow/scripts")
config = yaml.safe_load(Path("config/config.yaml").read_text("utf-8"))
made = Path("results/figures")
for name, stage in {
    "fig06": "apparent_restitution",
    "fig17": "apparent_restitution",
    "elsewhere": "thresholds_elsewhere",
}.items():
    compute = {name: importlib.import_module(stage).STAGE[name]}
    entries = {name: {"title": config[stage][name]["title"], "parameters": config[stage][name]}}
    settings = {"release": config["release"]}
    files = {name: made / f"{name}.nc"}
    datasets.save_stage(compute, entries, settings, files, [])
    figure = figures.draw(name, datasets.read(files[name]))
    drawing.save_picture(figure, made / f"{name}.png", made / f"{name}.svg", "unknown")

tests = ["tests/test_pages.py", "tests/test_figures.py"]
chosen = ["-q", "--noconftest", "-p", "no:cacheprovider", "--assert=plain"]
chosen += ["-k", "fig17 or elsewhere or every_figure"]
assert pytest.main([*tests, *chosen]) == 0
for name in ("fig17", "elsewhere"):
    for path in made.glob(f"{name}.*"):
        shutil.copyfile(path, Path("figures") / path.name)
assert pytest.main([*tests, *chosen]) == 0
"""


def test_what_the_recipes_add_is_made_listed_and_shown(stubs, tmp_path):
    folder = tmp_path / "checkout"
    follow(folder)
    checkout = replace(stubs, path=folder)
    status, listed = checkout.run("--list")
    assert status == 0, listed
    assert "fig17 (Figure 17: greatest height along the frequency ratio)" in listed
    assert "compute_thresholds_elsewhere (Permanent contact elsewhere)" in listed
    stages = {"apparent_restitution", "thresholds_elsewhere"}
    expected = {"fig17", "elsewhere", *stages, *(f"compute_{stage}" for stage in stages)}
    assert checkout.planned("fig17", "elsewhere") == expected
    green = subprocess.run(
        [sys.executable, "-c", GREEN],
        cwd=folder,
        env=os.environ | {"OMP_NUM_THREADS": "1", "PYTHONPATH": str(folder / "src")},
        capture_output=True,
        text=True,
        check=False,
    )
    assert green.returncode == 0, green.stdout + green.stderr
    assert green.stdout.count("5 passed") == 1 and green.stdout.count("4 skipped") == 1
    made = folder / "results/figures"
    assert read(made / "fig17.nc").title == "Figure 17: greatest height along the frequency ratio"
    assert read(made / "fig06.nc").sizes["case"] == 4


def follow(folder: Path) -> None:
    """Make a copy in which the recipes of a figure, a curve, a claim and a stage are followed."""
    for name in FOLDERS:
        without = shutil.ignore_patterns("__pycache__")
        shutil.copytree(ROOT / name, folder / name, ignore=without)
    for name in FILES:
        shutil.copyfile(ROOT / name, folder / name)
    config = folder / "config/config.yaml"
    # Few points are enough here.
    fewer = config.read_text("utf-8").replace("samples: 301", "samples: 21")
    config.write_text(fewer, "utf-8")
    scripts = folder / "workflow/scripts"
    figures = folder / "src/bouncing_ball/figures.py"
    # A figure, in three files.
    insert(config, "  fig13:\n", code("fig17:") + "\n")
    insert(
        scripts / "apparent_restitution.py", '"fig13": fig13', code('"fig17": fig10').strip() + " "
    )
    insert(figures, "SCHEMATICS: ", code("def fig17") + "\n\n")
    insert(figures, '    "fig16": fig16,\n', '    "fig17": fig17,\n')
    # A curve.
    insert(
        config,
        "      - { restitution: 0.65, amplitude: 1.2 }\n",
        "      - { restitution: 0.65, amplitude: 0.9 }\n",
    )
    # A claim.
    insert(
        folder / "src/bouncing_ball/claims.py",
        '@claim(\n    "threshold ensures"',
        code("@claim") + "\n\n",
    )
    # A stage: a section and a script of its name.
    insert(
        config,
        "time_histories:\n",
        "thresholds_elsewhere:\n  title: Permanent contact elsewhere\n  elsewhere:\n"
        "    title: The threshold of another ball\n    caption: Threshold along ϖ.\n"
        "    restitution: 0.5\n    frequency_ratio: { min: 1.0, max: 10.0, samples: 11 }\n\n",
    )
    script = (scripts / "permanent_contact.py").read_text("utf-8")
    stage = re.sub(r"STAGE = \{.*?\}", 'STAGE = {"elsewhere": fig11}', script, flags=re.DOTALL)
    (scripts / "thresholds_elsewhere.py").write_text(stage, "utf-8")
    insert(
        folder / "workflow/rules/common.smk",
        '    "time_histories": ["release"],\n',
        '    "thresholds_elsewhere": ["release"],\n',
    )
    insert(figures, '    "fig17": fig17,\n', '    "elsewhere": fig11,\n')

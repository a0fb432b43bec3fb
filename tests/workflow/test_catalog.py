"""What the Snakemake workflow catalog looks for, and the small run that it can try."""

import re
from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).resolve().parents[2]


def test_the_catalog_finds_its_files():
    usage = yaml.safe_load((ROOT / ".snakemake-workflow-catalog.yml").read_text("utf-8"))["usage"]
    assert usage["software-stack-deployment"]["report"] is True
    assert all((ROOT / name).is_file() for name in ("workflow/Snakefile", "config/README.md"))


@pytest.mark.long
def test_the_small_run_makes_what_its_page_says(fresh):
    page = (fresh.path / ".test" / "README.md").read_text(encoding="utf-8")
    (line,) = re.findall(r"^snakemake (.*)$", page, re.MULTILINE)
    options, _, targets = line.partition(" -- ")
    planned = fresh.planned(*options.split()[2:], "--", *targets.split())
    assert {*targets.split()} <= planned
    fresh.run(*options.split(), "--", "fig11")
    made = (fresh.path / ".test" / "results" / "figures").iterdir()
    assert {path.name for path in made} == {"fig11.nc", "fig11.png", "fig11.svg"}

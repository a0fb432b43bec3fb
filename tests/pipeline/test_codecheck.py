"""What is published beside the code says what the stages make, and where a blank is."""

import re
from pathlib import Path

import pytest
import yaml

from bouncing_ball.configuration.yaml_file import read_yaml
from bouncing_ball.pipeline.codecheck import NAME, codecheck, manifest

ROOT = Path(__file__).resolve().parents[2]
TITLE = read_yaml(ROOT / "metadata.yaml")["title"]
BLANK = re.compile(r"BLANK-[a-z]+(?:-[a-z]+)*")


def test_codecheck_is_what_the_stages_make():
    assert (ROOT / NAME).read_text(encoding="utf-8") == codecheck(TITLE), "run make codecheck"


def test_the_manifest_names_each_file_once():
    files = [entry["file"] for entry in manifest()]
    assert len(set(files)) == len(files) and all(entry["comment"] for entry in manifest())


def test_the_title_is_that_of_the_article():
    template = ROOT / "workflow" / "report" / "paper" / "article.md.j2"
    assert f"\n# {TITLE}\n" in template.read_text(encoding="utf-8")


@pytest.mark.parametrize("file", ["metadata.yaml", NAME])
def test_every_blank_is_in_the_list(file):
    listed = (ROOT / "docs" / "publication.md").read_text(encoding="utf-8")
    rows = dict(re.findall(r"^\| `(BLANK-[a-z-]+)` \|.*\| (.*) \|$", listed, re.MULTILINE))
    used = set(BLANK.findall((ROOT / file).read_text(encoding="utf-8")))
    assert used == {blank for blank, where in rows.items() if file in where}


def test_the_catalog_finds_the_workflow():
    usage = yaml.safe_load((ROOT / ".snakemake-workflow-catalog.yml").read_text(encoding="utf-8"))
    assert usage["usage"]["software-stack-deployment"] == {"conda": False, "singularity": False}
    assert (ROOT / "workflow" / "Snakefile").is_file()
    assert (ROOT / "config" / "README.md").is_file()

"""What is published of a complete run, and the workflow where a catalog looks for it."""

import json

from bouncing_ball.configuration.stages import Kind, names, studied, tables
from bouncing_ball.record.crate import NAME


def test_the_crate_holds_all_results(complete):
    before = set(complete.contents("results"))
    complete.run("--cores", "1", "crate")
    found = json.loads((complete.path / "results" / NAME).read_text(encoding="utf-8"))
    files = {entity["@id"] for entity in found["@graph"] if entity["@type"] == "File"}
    assert files == before
    # Every action names its inputs: none of the figures comes from nothing.
    actions = {each["@id"]: each for each in found["@graph"] if each["@type"] == "CreateAction"}
    assert {"@id": "figures/fig08.nc"} in actions["#job/figures/fig08.png"]["object"]


def test_the_snakefile_of_the_catalog_is_the_other_one(fresh):
    planned = fresh.planned("--snakefile", "workflow/Snakefile")
    stages = {f"{stage.name}: {stage.title}" for stage in studied()}
    figures = {f"Drawing {name}" for name in names(Kind.FIGURE, Kind.EXTENSION)}
    settings = {f"Setting {name}" for name in tables()}
    pages = {f"Writing results/figures/{name}.html" for name in names(Kind.PAGE)}
    assert planned == stages | figures | settings | pages | {"Writing results/paper.md"}

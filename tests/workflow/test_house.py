"""A second house: a folder with a Snakefile, a configuration and a record of its own."""

from dataclasses import replace

import pytest
import yaml

SNAKEFILE = """\
from bouncing_ball.datasets.artifact import Artifact, by_name

DRAWING = "bouncing_ball.paper.exhibits.restitution_model_figures:restitution_history"
HOUSE = workflow.basedir
ARTIFACTS = by_name(Artifact("fig02", "Another history", DRAWING))
BUDGETS = {}


include: "../workflow/rules/common.smk"


configfile: here("config/config.yaml")


rule history:
    input:
        code=code("history.py"),
    output:
        "results/figures/fig02.nc",
    params:
        artifact=about("fig02"),
        parameters=config["paper"]["fig02"],
    log:
        "results/logs/history.log",
    run:
        work("history.py", rule, input, output, params, log)


rule draw_fig02:
    input:
        code=code(f"{ROOT}/workflow/scripts/draw_fig02.py"),
        data="results/figures/fig02.nc",
    output:
        "results/figures/fig02.png",
        "results/figures/fig02.svg",
    log:
        "results/logs/draw_fig02.log",
    run:
        work(f"{ROOT}/workflow/scripts/draw_fig02.py", rule, input, output, params, log)


rule all:
    default_target: True
    input:
        rules.history.output,
        rules.draw_fig02.output,


include: "../workflow/rules/record.smk"
"""
SCRIPT = """\
from bouncing_ball.paper.exhibits.restitution_model import restitution_history
from bouncing_ball.pipeline.job import logged, make_dataset

with logged(snakemake):
    make_dataset(snakemake, restitution_history)
"""


@pytest.mark.long
def test_a_house_has_its_own_configuration_results_and_record(fresh):
    house = replace(fresh, path=fresh.path / "other", package=str(fresh.path / "src"))
    whole = yaml.safe_load((fresh.path / "config/config.yaml").read_text(encoding="utf-8"))
    (house.path / "config").mkdir(parents=True)
    (house.path / "Snakefile").write_text(SNAKEFILE, encoding="utf-8")
    (house.path / "workflow" / "scripts").mkdir(parents=True)
    (house.path / "workflow/scripts/history.py").write_text(SCRIPT, encoding="utf-8")
    own = {"paper": {"fig02": whole["paper"]["fig02"] | {"periods": 3}}}
    (house.path / "config/config.yaml").write_text(yaml.safe_dump(own), encoding="utf-8")
    commit = fresh.commit("Another house")
    made = house.run("--cores", "1", "accept").stdout
    assert {line for line in made.splitlines() if line.startswith("copied ")} == {
        f"copied figures/fig02.{kind}" for kind in ("nc", "png", "svg")
    }
    # Its record makes the tree of neither house dirty.
    (house.path / "results/figures/fig02.nc").unlink()
    said = house.run("--cores", "1", "diff").stdout
    assert said.splitlines()[-1] == "1 identical. The results agree with the record."
    assert not (fresh.path / "results").exists()
    program = "from bouncing_ball.cli.main import main; main()"
    for where, arguments in ((house, ["diff"]), (fresh, ["diff", "other", "fig02"])):
        assert where.python_says(program, *arguments) == said.splitlines()[-1]
    explained = fresh.python_says(program, "explain", "other/results/figures/fig02.nc")
    lines = dict(line.split("  ", 1) for line in explained.splitlines())
    assert {name: lines[name].strip() for name in ("commit", "dirty", "parameters periods")} == {
        "commit": commit,
        "dirty": "no",
        "parameters periods": "3",
    }
    assert "configuration paper" not in lines

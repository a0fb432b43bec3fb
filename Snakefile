# Carbonelli, Perret-Liaudet, Rigaud and Feki (2011): a ball that bounces on a vibrating table.
#
#     snakemake --cores 2                  everything: results/index.html
#     snakemake --cores 2 fig14 table1     a figure and a table
#     snakemake --cores 2 continuation     the datasets of a stage
#     snakemake --cores 2 diff             compare the results with the reference
#     snakemake --cores 2 fig14 diff       make and compare Figure 14 only
#
# `make accept` makes the results the new reference.

import os
import sys
from pathlib import Path

import yaml
from snakemake.utils import min_version

min_version("9.5")

# The folder of this file. A run may have another folder (--directory), which gets its results.
TOP = Path(workflow.current_basedir)
sys.path.insert(0, str(TOP / "src"))
from paper_replication.configuration import (
    SHOWN_BY,
    entries,
    mistakes,
    repeated_keys,
    shown_as,
    with_whole_numbers,
)

# Scripts import the package of this checkout, whatever else is installed.
os.environ.update(PYTHONPATH=str(TOP / "src"))


configfile: TOP / "config/config.yaml"


# A mistake in the configuration ends the run before any job.
schema = yaml.safe_load((TOP / "config/schema.yaml").read_text("utf-8"))
found = [
    f"{Path(file).name}, {line}"
    for file in workflow.configfiles
    for line in repeated_keys(Path(file).read_text("utf-8"))
]
if found := found or [*mistakes(config, schema)]:
    sys.exit("\n".join(f"configuration: {line}" for line in found))
config.update(with_whole_numbers(config, schema, schema["$defs"]))


# Figures, tables and datasets are registered in config.yaml, each in the section of its stage.

STAGES = {name: section for name, section in config.items() if isinstance(section, dict)}
ENTRIES = entries(config)
FIGURES = [name for name, entry in ENTRIES.items() if "caption" in entry]
TABLES = [name for name, entry in ENTRIES.items() if entry.get("table")]
DATASETS = [name for name in ENTRIES if name not in STAGES["schematics"]]


def names(stage):
    """The figures, tables and datasets of a stage."""
    return [name for name in STAGES[stage] if name != "title"]


def datasets(stage):
    """The files of the datasets of a stage, by name."""
    return {name: f"results/figures/{name}.nc" for name in names(stage)}


def parameters(stage):
    """The title and the parameters of each dataset of a stage."""
    return {
        name: {key: value for key, value in ENTRIES[name].items() if key not in SHOWN_BY}
        for name in names(stage)
    }


def files(name):
    """The files of a figure, a table or a dataset."""
    kinds = ["nc"] * (name in DATASETS)
    kinds += shown_as(ENTRIES[name])
    return [f"results/figures/{name}.{kind}" for kind in kinds]


# An entry without a function is found here, because a job would remove its stage's results first.
for stage in STAGES:
    for name in names(stage):
        needed = {
            f"workflow/scripts/{stage}.py": name in DATASETS,
            "src/carbonelli2011/figures.py": name in FIGURES,
            "src/carbonelli2011/tables.py": name in TABLES,
        }
        for file in [file for file, is_needed in needed.items() if is_needed]:
            if f'"{name}":' not in (TOP / file).read_text("utf-8"):
                sys.exit(f"configuration: {stage}.{name}: {file} needs a function for it")


# The code of the rules. A change of one of these files runs a rule again; a test compares the lists
# with the imports. Descriptions (variables.py) and provenance.py decide no number.


def checkout(*paths):
    """Files of this checkout, as paths from the folder of the run; they are not in its storage."""
    return [local(os.path.relpath(TOP / path)) for path in paths]


def modules(*names):
    """Modules of the packages, as paths from the folder of the run."""
    return checkout(*(path for name in names for path in sorted(TOP.glob(f"src/*/{name}.py"))))


MODELS = checkout(*sorted(TOP.glob("src/bouncing_ball/[!_]*.py"))) + modules("datasets")
PAPER = modules("paper")
DRAWING = modules("figures", "curves", "paper", "drawing", "texts", "datasets")
JUDGING = (
    MODELS + PAPER + modules("claims", "measures", "tables", "verdicts", "judgements", "texts")
)
WRITING = JUDGING + modules("article", "index", "pages", "origins", "templates")
VARIED = [
    "restitution_model",
    "apparent_restitution",
    "continuation",
    "permanent_contact",
    "error_thresholds",
    "time_histories",
]
TEMPLATES = [
    "paper.md",
    "supplement.md",
    "others.md",
    "verdicts.md",
    "article.html",
    "figures.md",
    "figures.html",
    "claims.html",
    "numbers.html",
]

PICTURES = checkout("workflow/scripts/draw.py") + DRAWING
TABULATING = checkout("workflow/scripts/tables.py") + JUDGING
CLAIMS = checkout("workflow/scripts/claims.py") + JUDGING
TEXTS = checkout("workflow/scripts/article.py") + WRITING
TEXTS += checkout(*(f"workflow/templates/{name}.j2" for name in TEMPLATES))


# The stages compute datasets.


rule restitution_model:
    """Motions and orbits of the restitution model, Eqs. 1 to 9"""
    input:
        code=checkout("workflow/scripts/restitution_model.py") + MODELS,
    output:
        **datasets("restitution_model"),
        record="results/records/restitution_model.json",
    params:
        entries=parameters("restitution_model"),
        settings={},
    log:
        "results/logs/restitution_model.log",
    conda:
        "workflow/envs/environment.yaml"
    script:
        "workflow/scripts/restitution_model.py"


rule apparent_restitution:
    """Apparent restitution and other quantities of the orbits along the frequency ratio ϖ"""
    input:
        code=checkout("workflow/scripts/apparent_restitution.py") + MODELS,
    output:
        **datasets("apparent_restitution"),
        record="results/records/apparent_restitution.json",
    params:
        entries=parameters("apparent_restitution"),
        settings={"release": config["release"]},
    log:
        "results/logs/apparent_restitution.log",
    conda:
        "workflow/envs/environment.yaml"
    script:
        "workflow/scripts/apparent_restitution.py"


rule continuation:
    """Branches of n-T orbits along the amplitude Λ, with their bifurcations"""
    input:
        code=checkout("workflow/scripts/continuation.py") + MODELS + PAPER,
    output:
        **datasets("continuation"),
        record="results/records/continuation.json",
    params:
        entries=parameters("continuation"),
        settings={"release": config["release"], "largest_step": config["largest_step"]},
    log:
        "results/logs/continuation.log",
    conda:
        "workflow/envs/environment.yaml"
    script:
        "workflow/scripts/continuation.py"


rule permanent_contact:
    """Thresholds of permanent contact along the frequency ratio ϖ"""
    input:
        code=checkout("workflow/scripts/permanent_contact.py") + MODELS,
    output:
        **datasets("permanent_contact"),
        record="results/records/permanent_contact.json",
    params:
        entries=parameters("permanent_contact"),
        settings={"release": config["release"]},
    log:
        "results/logs/permanent_contact.log",
    conda:
        "workflow/envs/environment.yaml"
    script:
        "workflow/scripts/permanent_contact.py"


rule error_thresholds:
    """Frequency ratios ϖ above which the restitution model is accurate enough"""
    input:
        code=checkout("workflow/scripts/error_thresholds.py") + MODELS,
    output:
        **datasets("error_thresholds"),
        record="results/records/error_thresholds.json",
    params:
        entries=parameters("error_thresholds"),
        settings={"release": config["release"]},
    log:
        "results/logs/error_thresholds.log",
    conda:
        "workflow/envs/environment.yaml"
    script:
        "workflow/scripts/error_thresholds.py"


rule validity:
    """Map of the stable orbits for which the advised frequency ratio is enough"""
    input:
        code=checkout("workflow/scripts/validity.py") + MODELS + PAPER,
    output:
        **datasets("validity"),
        record="results/records/validity.json",
    params:
        entries=parameters("validity"),
        settings={"release": config["release"]},
    log:
        "results/logs/validity.log",
    conda:
        "workflow/envs/environment.yaml"
    script:
        "workflow/scripts/validity.py"


rule time_histories:
    """Heights of ball and table over a cycle"""
    input:
        code=checkout("workflow/scripts/time_histories.py") + MODELS,
    output:
        **datasets("time_histories"),
        record="results/records/time_histories.json",
    params:
        entries=parameters("time_histories"),
        settings={"release": config["release"]},
    log:
        "results/logs/time_histories.log",
    conda:
        "workflow/envs/environment.yaml"
    script:
        "workflow/scripts/time_histories.py"


rule printed_numbers:
    """Printed numbers under hypotheses on what the authors computed"""
    input:
        code=checkout("workflow/scripts/printed_numbers.py")
        + MODELS
        + PAPER
        + modules("measures", "verdicts"),
    output:
        **datasets("printed_numbers"),
        record="results/records/printed_numbers.json",
    params:
        entries=parameters("printed_numbers"),
        settings={},
    log:
        "results/logs/printed_numbers.log",
    conda:
        "workflow/envs/environment.yaml"
    script:
        "workflow/scripts/printed_numbers.py"


# Figures and tables are made from their datasets, and texts from all of them.


def captions(name):
    """What `snakemake --report` shows beside a figure or a table."""
    entry = ENTRIES[name]
    return {"name": name, "title": entry["title"], "caption": entry.get("caption", "")}


for name in FIGURES:

    rule:
        name:
            name
        input:
            data=[file for file in files(name) if file.endswith(".nc")],
            code=PICTURES,
        output:
            png=report(f"results/figures/{name}.png", category="Figures", labels=captions(name)),
            svg=f"results/figures/{name}.svg",
            record=f"results/records/{name}.json",
        log:
            f"results/logs/{name}.log",
        conda:
            "workflow/envs/environment.yaml"
        script:
            "workflow/scripts/draw.py"


for name in TABLES:

    rule:
        name:
            name
        input:
            data=f"results/figures/{name}.nc",
            code=TABULATING,
        output:
            md=f"results/figures/{name}.md",
            csv=report(f"results/figures/{name}.csv", category="Tables", labels=captions(name)),
            record=f"results/records/{name}.json",
        log:
            f"results/logs/{name}.log",
        conda:
            "workflow/envs/environment.yaml"
        script:
            "workflow/scripts/tables.py"


rule claims:
    """Judge the claims of the paper"""
    input:
        data=expand("results/figures/{name}.nc", name=DATASETS),
        code=CLAIMS,
    output:
        nc="results/figures/claims.nc",
        md="results/figures/claims.md",
        csv=report("results/figures/claims.csv", category="Tables", labels={"name": "claims"}),
        record="results/records/claims.json",
    log:
        "results/logs/claims.log",
    conda:
        "workflow/envs/environment.yaml"
    script:
        "workflow/scripts/claims.py"


rule choices:
    """Judge the claims again, with other choices of what cannot be read in the paper"""
    input:
        data=expand("results/figures/{name}.nc", name=DATASETS),
        code=checkout(*(f"workflow/scripts/{name}.py" for name in ["choices", *VARIED])) + JUDGING,
    output:
        nc="results/figures/choices.nc",
        record="results/records/choices.json",
    log:
        "results/logs/choices.log",
    conda:
        "workflow/envs/environment.yaml"
    script:
        "workflow/scripts/choices.py"


rule article:
    """Write the article, its supplement, the list of figures and results/index.html"""
    input:
        data=expand("results/figures/{name}.nc", name=[*DATASETS, "claims", "choices"]),
        code=TEXTS,
    output:
        paper="results/paper.md",
        supplement="results/supplement.md",
        paper_page="results/paper.html",
        supplement_page="results/supplement.html",
        numbers="results/numbers.html",
        figures="results/figures/README.md",
        index="results/index.html",
        claims="results/claims.html",
        record="results/records/article.json",
    params:
        entries=ENTRIES,
    log:
        "results/logs/article.log",
    conda:
        "workflow/envs/environment.yaml"
    script:
        "workflow/scripts/article.py"


rule all:
    """Make everything: the page results/index.html shows it"""
    default_target: True
    localrule: True
    input:
        [files(name) for name in ENTRIES],
        rules.claims.output,
        rules.choices.output,
        rules.article.output,


# The reference: figures/, paper.md and supplement.md. These rules have no outputs, and run whenever
# they are named.


def named(wildcards):
    """The figures, tables and datasets to compare, those on the command line; none for all.

    Claims and texts follow from all datasets: with them, everything is compared.
    """
    found = set()
    for target in {*workflow.dag_settings.targets} - {"diff"}:
        found.update(names(target) if target in STAGES else [Path(target).stem])
    return sorted(found) if found <= {*ENTRIES} else []


rule diff:
    """Compare the results with the reference"""
    localrule: True
    input:
        lambda wildcards: [file for name in named(wildcards) for file in files(name)]
        or rules.all.input,
    params:
        names=named,
        config=config,
    log:
        "results/logs/diff.log",
    conda:
        "workflow/envs/environment.yaml"
    script:
        "workflow/scripts/compare.py"


rule accept:
    """The last step of `make accept`, which tests the results first"""
    localrule: True
    input:
        rules.all.input,
    log:
        "results/logs/accept.log",
    conda:
        "workflow/envs/environment.yaml"
    script:
        "workflow/scripts/accept.py"


# A run that fails leaves no page of an earlier comparison.
onstart:
    for path in ("results/diff/index.html", "results/diff/report.txt"):
        Path(path).unlink(missing_ok=True)

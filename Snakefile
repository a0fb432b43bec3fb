# Carbonelli, Perret-Liaudet, Rigaud and Feki (2011): a ball that bounces on a vibrating table.
#
#     snakemake --cores 2                  everything: results/index.html
#     snakemake --cores 2 fig14 table1     a figure and a table
#     snakemake --cores 2 continuation     the datasets of a stage
#     snakemake --cores 2 results/pdf/fig14.pdf    a figure as PDF: docs/chapter.md
#     snakemake --cores 2 diff             compare the results with the reference
#     snakemake --cores 2 fig14 diff       make and compare Figure 14 only
#
# `make accept` makes the results the new reference.

import os
import sys
from pathlib import Path

from snakemake.utils import min_version

min_version("9.5")

# The folder of this file. A run may have another folder (--directory), which gets its results.
TOP = Path(workflow.current_basedir)
sys.path.insert(0, str(TOP / "src"))
from paper_replication.provenance import from_source

with from_source(TOP / "src"):
    from carbonelli2011.existence import without_orbit
    from paper_replication.configuration import (
        captions,
        checked,
        code_of_packages,
        computed_from,
        datasets,
        entries,
        named,
        names,
        shown_as,
        stages,
        stop,
        unreadable,
        without_function,
    )

# Scripts import the package of this checkout, whatever else is installed. A workflow that has this
# one as a module may have folders of its own.
FOLDERS = filter(None, [str(TOP / "src"), os.getenv("PYTHONPATH")])
os.environ.update(PYTHONPATH=os.pathsep.join(FOLDERS))

if not os.access(".", os.W_OK):
    sys.exit("This folder cannot be written: give a folder for the results, --directory FOLDER")

if code := [*code_of_packages(TOP / "src")]:
    sys.exit("\n".join(code))

# A mistake in the configuration ends the run before any job.
stop(unreadable(TOP / "config/config.yaml"))


configfile: TOP / "config/config.yaml"


config.update(checked(config, TOP / "config/schema.yaml", workflow.configfiles))
stop(without_orbit(config))


# Figures, tables and datasets are registered in config.yaml, each in the section of its stage.

ENTRIES = entries(config)
FIGURES = [name for name, entry in ENTRIES.items() if "caption" in entry]
TABLES = [name for name, entry in ENTRIES.items() if entry.get("table")]
COMPUTED = [stage for stage in stages(config) if stage != "schematics"]
DATASETS = [name for stage in COMPUTED for name in names(config[stage])]


def files(name):
    """The files of a figure, a table or a dataset."""
    kinds = ["nc"] * (name in DATASETS) + shown_as(ENTRIES[name])
    return [f"results/figures/{name}.{kind}" for kind in kinds]


def shown_by(name):
    """The dataset of a figure, if it has one: its own, or the `data` of another entry."""
    data = ENTRIES[name].get("data", name)
    return [] if data in config["schematics"] else [f"results/figures/{data}.nc"]


# An entry without a function is found here, because a job would remove its stage's results first.
FUNCTIONS = {f"src/carbonelli2011/stages/{stage}.py": names(config[stage]) for stage in COMPUTED}
FUNCTIONS |= {"src/carbonelli2011/figures.py": FIGURES, "src/carbonelli2011/tables.py": TABLES}
stop(without_function(TOP, FUNCTIONS))


# The code of the rules. A change of one of these files runs a rule again; a test compares the lists
# with the imports. Descriptions (variables.py) and provenance.py decide no number.


def checkout(*paths):
    """Files of this checkout, as paths from the folder of the run; they are not in its storage."""
    return [local(os.path.relpath(TOP / path)) for path in paths]


def modules(*names):
    """Modules of the packages with their templates, as paths from the folder of the run."""
    return checkout(*(path for name in names for path in sorted(TOP.glob(f"src/*/{name}.*"))))


def stage(name):
    """The module that computes the datasets of a stage, and the script of all stages."""
    return checkout(f"src/carbonelli2011/stages/{name}.py", "workflow/scripts/stage.py")


MODELS = checkout(*sorted(TOP.glob("src/bouncing_ball/[!_]*.py"))) + modules("datasets")
PAPER = modules("paper")
DRAWING = modules("figures", "motion", "curves", "paper", "drawing", "texts", "datasets")
JUDGING = MODELS + PAPER + modules("claims", "measures", "verdicts", "judgements", "texts")
WRITING = JUDGING + modules("tables", "article", "index", "origins", "templates")
WRITING += modules("pages", "numbers", "results")
# The stages that the study of choices computes again.
VARIED = [
    "restitution_model",
    "apparent_restitution",
    "continuation",
    "permanent_contact",
    "error_thresholds",
    "time_histories",
]
PICTURES = checkout("workflow/scripts/draw.py") + DRAWING
TABULATING = checkout("workflow/scripts/tables.py") + JUDGING + modules("tables")
CLAIMS = checkout("workflow/scripts/claims.py") + JUDGING
CHOICES = checkout("workflow/scripts/choices.py") + JUDGING
CHOICES += modules("choices", *(f"stages/{name}" for name in VARIED))
TEXTS = checkout("workflow/scripts/article.py") + WRITING
TEXTS += checkout(*sorted(TOP.glob("src/carbonelli2011/templates/*.j2")))


# The stages compute datasets.


rule restitution_model:
    """Motions and orbits of the restitution model, Eqs. 1 to 9"""
    input:
        code=stage("restitution_model") + MODELS,
    output:
        **datasets(config["restitution_model"]),
        record="results/records/restitution_model.json",
    params:
        stage="restitution_model",
        entries=computed_from(config["restitution_model"]),
        settings={},
    log:
        "results/logs/restitution_model.log",
    conda:
        "workflow/envs/environment.yaml"
    script:
        "workflow/scripts/stage.py"


rule apparent_restitution:
    """Apparent restitution and other quantities of the orbits along the frequency ratio ϖ"""
    input:
        code=stage("apparent_restitution") + MODELS,
    output:
        **datasets(config["apparent_restitution"]),
        record="results/records/apparent_restitution.json",
    params:
        stage="apparent_restitution",
        entries=computed_from(config["apparent_restitution"]),
        settings={"release": config["release"]},
    log:
        "results/logs/apparent_restitution.log",
    conda:
        "workflow/envs/environment.yaml"
    script:
        "workflow/scripts/stage.py"


rule continuation:
    """Branches of n-T orbits along the amplitude Λ, with their bifurcations"""
    input:
        code=stage("continuation") + MODELS + PAPER,
    output:
        **datasets(config["continuation"]),
        record="results/records/continuation.json",
    params:
        stage="continuation",
        entries=computed_from(config["continuation"]),
        settings={"release": config["release"], "largest_step": config["largest_step"]},
    log:
        "results/logs/continuation.log",
    conda:
        "workflow/envs/environment.yaml"
    script:
        "workflow/scripts/stage.py"


rule permanent_contact:
    """Thresholds of permanent contact along the frequency ratio ϖ"""
    input:
        code=stage("permanent_contact") + MODELS,
    output:
        **datasets(config["permanent_contact"]),
        record="results/records/permanent_contact.json",
    params:
        stage="permanent_contact",
        entries=computed_from(config["permanent_contact"]),
        settings={"release": config["release"]},
    log:
        "results/logs/permanent_contact.log",
    conda:
        "workflow/envs/environment.yaml"
    script:
        "workflow/scripts/stage.py"


rule error_thresholds:
    """Frequency ratios ϖ above which the restitution model is accurate enough"""
    input:
        code=stage("error_thresholds") + MODELS,
    output:
        **datasets(config["error_thresholds"]),
        record="results/records/error_thresholds.json",
    params:
        stage="error_thresholds",
        entries=computed_from(config["error_thresholds"]),
        settings={"release": config["release"]},
    log:
        "results/logs/error_thresholds.log",
    conda:
        "workflow/envs/environment.yaml"
    script:
        "workflow/scripts/stage.py"


rule validity:
    """Map of the stable orbits for which the advised frequency ratio is enough"""
    input:
        code=stage("validity") + MODELS,
    output:
        **datasets(config["validity"]),
        record="results/records/validity.json",
    params:
        stage="validity",
        entries=computed_from(config["validity"]),
        settings={"release": config["release"]},
    log:
        "results/logs/validity.log",
    conda:
        "workflow/envs/environment.yaml"
    script:
        "workflow/scripts/stage.py"


rule time_histories:
    """Heights of ball and table over a cycle"""
    input:
        code=stage("time_histories") + MODELS,
    output:
        **datasets(config["time_histories"]),
        record="results/records/time_histories.json",
    params:
        stage="time_histories",
        entries=computed_from(config["time_histories"]),
        settings={"release": config["release"]},
    log:
        "results/logs/time_histories.log",
    conda:
        "workflow/envs/environment.yaml"
    script:
        "workflow/scripts/stage.py"


rule printed_numbers:
    """Printed numbers under hypotheses on what the authors computed"""
    input:
        code=stage("printed_numbers") + MODELS + PAPER + modules("verdicts"),
    output:
        **datasets(config["printed_numbers"]),
        record="results/records/printed_numbers.json",
    params:
        stage="printed_numbers",
        entries=computed_from(config["printed_numbers"]),
        settings={},
    log:
        "results/logs/printed_numbers.log",
    conda:
        "workflow/envs/environment.yaml"
    script:
        "workflow/scripts/stage.py"


# Figures and tables are made from their datasets, and texts from all of them.


for name in FIGURES:

    rule:
        name:
            name
        input:
            data=shown_by(name),
            code=PICTURES,
        output:
            png=report(
                f"results/figures/{name}.png",
                category="Figures",
                labels=captions(name, ENTRIES[name]),
            ),
            svg=f"results/figures/{name}.svg",
            record=f"results/records/{name}.json",
        log:
            f"results/logs/{name}.log",
        conda:
            "workflow/envs/environment.yaml"
        script:
            "workflow/scripts/draw.py"


rule pdf:
    """A figure as PDF, results/pdf/fig14.pdf, with the settings of the file `style`, if it is given"""
    input:
        data=lambda wildcards: shown_by(wildcards.name),
        style=config.get("style", []),
        code=checkout("workflow/scripts/pdf.py") + DRAWING,
    output:
        pdf="results/pdf/{name}.pdf",
    wildcard_constraints:
        name="|".join(FIGURES),
    log:
        "results/logs/pdf/{name}.log",
    conda:
        "workflow/envs/environment.yaml"
    script:
        "workflow/scripts/pdf.py"


for name in TABLES:

    rule:
        name:
            name
        input:
            data=f"results/figures/{name}.nc",
            code=TABULATING,
        output:
            md=f"results/figures/{name}.md",
            csv=report(
                f"results/figures/{name}.csv",
                category="Tables",
                labels=captions(name, ENTRIES[name]),
            ),
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
        code=CHOICES,
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


def asked(wildcards):
    """The figures, tables and datasets to compare, those on the command line; none for all."""
    settings = workflow.dag_settings
    if settings.until or settings.omit_from:
        sys.exit("--until and --omit-from leave out the comparison: name the figures instead")
    if "accept" in settings.targets:
        sys.exit("diff and accept: one after the other, because accept changes what diff reads")
    return named(config, settings.targets)


rule diff:
    """Compare the results with the reference"""
    localrule: True
    input:
        lambda wildcards: [file for name in asked(wildcards) for file in files(name)]
        or rules.all.input,
    params:
        names=asked,
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

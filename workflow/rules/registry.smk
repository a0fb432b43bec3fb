# What config.yaml registers: the stages, and the figures, tables and datasets of each. Names, files
# and descriptions follow from it here, for the rules of both workflows of this repository.
#
# The workflow that includes this file has its folder HERE and the folders SOURCES of the packages that
# its scripts import; then SETTINGS, the settings of the whole run on which a script depends, and
# READS, its further inputs that decide what it makes as its code does.

import os
import re
from difflib import get_close_matches
from functools import cache
from pathlib import Path

# Scripts import these packages, whatever else is installed.
paths = [*map(str, SOURCES), os.environ.get("PYTHONPATH", "")]
os.environ.update(PYTHONPATH=os.pathsep.join(filter(None, paths)))

# What each stage is for, and its entries; then every entry by its name.
STAGES = {stage: list(entries(section)) for stage, section in entries(config).items()}
TITLES = {stage: section["title"] for stage, section in entries(config).items()}
ENTRIES = {
    name: entry for section in entries(config).values() for name, entry in entries(section).items()
}
FIGURES = [name for name, entry in ENTRIES.items() if "caption" in entry]
TABLES = [name for name, entry in ENTRIES.items() if entry.get("table")]
# A stage without a script computes nothing: its figures are schematics, which show no data.
COMPUTED = [stage for stage in STAGES if (HERE / f"workflow/scripts/{stage}.py").exists()]
for stage in STAGES.keys() - COMPUTED:
    if any(name not in FIGURES or parameters_of(ENTRIES[name]) for name in STAGES[stage]):
        end(f"configuration: {stage}: there is no workflow/scripts/{stage}.py to compute it")
DRAWN = [stage for stage, names in STAGES.items() if set(names) & set(FIGURES)]
DATASETS = [name for stage in COMPUTED for name in STAGES[stage]]
# The kinds of files of each entry.
KINDS = {
    name: ["nc"] * (name in DATASETS)
    + ["png", "svg"] * (name in FIGURES)
    + ["md", "csv"] * (name in TABLES)
    for name in ENTRIES
}


# Code


def relative(path):
    """A file of the repository, as a path from the working directory.

    The mark `local` keeps it as it is if this workflow is a module with a prefix.
    """
    return local(os.path.relpath(path))


# The modules of SOURCES, and an import at the start of a line, where `make lint` wants it, perhaps in
# parentheses or continued after a backslash. Syntax trees would take half the time of a start.
MODULES = {
    f"{path.parent.name}.{path.stem}": path for folder in SOURCES for path in folder.glob("*/*.py")
}
IMPORT = re.compile(r"^[ \t]*(?:from ([\w.]+) )?import (\([^)]*\)|(?:\\\n|.)*)", re.MULTILINE)


@cache
def imports(file):
    """The modules of SOURCES that a Python file imports itself, also within its functions."""
    without_comments = re.sub("#.*", "", file.read_text("utf-8"))
    found = set()
    for origin, listed in IMPORT.findall(without_comments):
        names = re.findall(r"([\w.]+)(?: as \w+)?", listed)
        if origin:
            names = [origin, *(f"{origin}.{name}" for name in names)]
        found.update(names)
        # A package is imported before its modules.
        found.update(f"{name.partition('.')[0]}.__init__" for name in names)
    return {MODULES[name] for name in found & MODULES.keys()}


def code(script):
    """The files that decide what a script makes: itself, the modules that it imports, directly or by
    another module, and what else it reads. A change of one of them runs the script again.
    """
    found = new = {HERE / f"workflow/scripts/{script}.py"}
    while new:
        new = set().union(*map(imports, new)) - found
        found = found | new
    return [*map(relative, sorted(found)), *READS.get(script, {}).values()]


# Stages


def titled_parameters(stage):
    """The title and the parameters of each entry of a stage."""
    return {
        name: {"title": ENTRIES[name]["title"], "parameters": parameters_of(ENTRIES[name])}
        for name in STAGES[stage]
    }


def settings(stage):
    """The settings of the whole run on which the datasets of a stage depend."""
    return {key: config[key] for key in SETTINGS.get(stage, [])}


def datasets(stage):
    """The files of the datasets of a stage, by name; none if it computes nothing."""
    names = STAGES[stage] if stage in COMPUTED else []
    return {name: f"results/figures/{name}.nc" for name in names}


def figure_datasets(stage):
    """The datasets that the figures of a stage show."""
    return [file for name, file in datasets(stage).items() if name in FIGURES]


def pictures(stage):
    """The pictures of a stage, with what the report says of them."""
    names = [name for name in STAGES[stage] if name in FIGURES]
    about = {"caption": "../report/figures.rst", "category": "Figures"}
    png = {name: f"results/figures/{name}.png" for name in names}
    return {
        "png": [report(file, labels={"figure": name}, **about) for name, file in png.items()],
        "svg": [f"results/figures/{name}.svg" for name in names],
    }


def listed(name):
    """What `snakemake --list` says of a stage, a figure, a table or a dataset."""
    if name in ENTRIES:
        return ENTRIES[name]["title"]
    if name in DRAWN:
        return f"{TITLES[name]}: {', '.join(each for each in STAGES[name] if each in FIGURES)}"
    return TITLES.get(name.removeprefix("compute_"))


# Files


def files(name):
    """All files of a figure, a table or a dataset."""
    return [f"results/figures/{name}.{kind}" for kind in KINDS[name]]


def unknown_target(wildcards):
    """End the run with a line on a name that is no target."""
    names = [*KINDS, *STAGES, "all", "article", "diff"]
    # A figure is often meant whose number has one digit: fig6 is fig06.
    padded = re.sub(r"\d+", lambda number: number[0].zfill(2), wildcards.name.lower())
    found = [*get_close_matches(padded, names, 1, 0.99), *get_close_matches(wildcards.name, names)]
    near = " or ".join(list(dict.fromkeys(found))[:3])
    meant = f"did you mean {near}? " if near else ""
    end(f"{wildcards.name} is no target: {meant}snakemake --list names all of them")


def requested(wildcards):
    """The figures, tables and datasets that the command line names with `diff` or `accept`.

    With any other target, such as `article` or a file, everything is compared.
    """
    known = STAGES | {name: [name] for name in KINDS}
    targets = set(workflow.dag_settings.targets)
    if {"diff", "accept"} <= targets:
        end("diff and accept are two commands: compare, look at the page, then accept")
    targets -= {"diff", "accept"}
    if not targets or targets - known.keys():
        return sorted(KINDS)
    return sorted({name for target in targets for name in known[target]})


def requested_files(wildcards):
    """The files to compare: those of the figures and tables named, or everything."""
    if requested(wildcards) == sorted(KINDS):
        return rules.all.input
    return [file for name in requested(wildcards) for file in files(name)]


wildcard_constraints:
    table="|".join(TABLES),

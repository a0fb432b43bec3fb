# Names and paths that the rules share.

import os
from pathlib import Path

# Scripts import the package of this checkout, whatever else is installed.
paths = [str(CHECKOUT / "src"), os.environ.get("PYTHONPATH", "")]
os.environ.update(PYTHONPATH=os.pathsep.join(filter(None, paths)))

# The datasets of each stage: those that have parameters, and one that has none.
STAGES = {stage: list(names) for stage, names in config.items() if isinstance(names, dict)}
STAGES["table1_readings"] = ["table1_readings"]
DATASETS = [name for names in STAGES.values() for name in names]
# Figures of the models, which show no data.
SCHEMATICS = ["fig01", "fig04"]
FIGURES = sorted(name for name in DATASETS + SCHEMATICS if name.startswith("fig"))
TABLES = ["table1", "thresholds", "table1_readings"]
ARTIFACTS = sorted([*DATASETS, *SCHEMATICS, "claims"])

# Settings of the whole run on which the datasets of a stage depend.
SETTINGS = {
    "restitution_model": [],
    "apparent_restitution": ["release"],
    "continuation": ["release", "largest_step"],
    "table1_readings": [],
    "permanent_contact": ["release"],
    "error_thresholds": ["release"],
    "time_histories": ["release"],
}

# The modules of the package that each script imports, directly or by another module. A change of
# one of them runs the script again. A test compares these lists with the imports.
ORBITS = ["restitution", "spring_damper", "orbits", "continuation"]
CLAIMS = ["restitution", "spring_damper", "verdicts", "claims", "tables"]
DRAWING = ["drawing", "figures", "datasets"]
COMPARISON = [*CLAIMS, *DRAWING, "article", "differences", "compare", "products"]
MODULES = {
    "restitution_model": ["restitution", "datasets"],
    "apparent_restitution": [*ORBITS, "datasets"],
    "continuation": [*ORBITS, "errors", "datasets"],
    "table1_readings": [*ORBITS, "datasets"],
    "permanent_contact": [*ORBITS, "errors", "datasets"],
    "error_thresholds": [*ORBITS, "errors", "datasets"],
    "time_histories": [*ORBITS, "datasets"],
    "draw": DRAWING,
    "tables": [*CLAIMS, "datasets"],
    "claims": [*CLAIMS, "datasets"],
    "article": [*CLAIMS, "article", "datasets"],
    "compare": COMPARISON,
    "accept": COMPARISON,
}


def checkout(path):
    """A file of the checkout, as a path from the working directory.

    The mark `local` keeps it as it is if this workflow is a module with a prefix.
    """
    return local(os.path.relpath(CHECKOUT / path))


# The table as the paper prints it, which some scripts read: it decides what they make as code does.
PRINTED = "config/table1_printed.csv"
READ_PRINTED = ["continuation", "table1_readings", "claims"]


def code(script):
    """The files that decide what a script makes: itself, what it imports, the printed Table 1."""
    modules = [f"src/bouncing_ball/{module}.py" for module in ["__init__", *MODULES[script]]]
    printed = [PRINTED] if script in READ_PRINTED else []
    return [checkout(path) for path in [f"workflow/scripts/{script}.py", *modules, *printed]]


def datasets(stage):
    """The files of the datasets of a stage, by name."""
    return {name: f"results/figures/{name}.nc" for name in STAGES[stage]}


def figure_datasets(stage):
    """The datasets that the figures of a stage show."""
    return [file for name, file in datasets(stage).items() if name in FIGURES]


def pictures(stage):
    """The pictures of a stage, with what the report says of them."""
    names = [name for name in STAGES.get(stage, SCHEMATICS) if name in FIGURES]
    png = [f"results/figures/{name}.png" for name in names]
    about = {"caption": f"../report/{stage}.rst", "category": "Figures"}
    return {
        "png": [report(file, labels={"figure": Path(file).stem}, **about) for file in png],
        "svg": [f"results/figures/{name}.svg" for name in names],
    }


def files(name):
    """All files of a figure, a table or a dataset."""
    kinds = ["nc"] if name in [*DATASETS, "claims"] else []
    if name in FIGURES:
        kinds += ["png", "svg"]
    if name in [*TABLES, "claims"]:
        kinds += ["md", "csv"]
    return [f"results/figures/{name}.{kind}" for kind in kinds]


def requested(wildcards):
    """The figures and tables that the command line names together with `diff` or `accept`.

    With any other target, such as `article` or a file, everything is compared.
    """
    known = {name: [name] for name in ARTIFACTS} | STAGES | {"schematics": SCHEMATICS}
    targets = set(workflow.dag_settings.targets) - {"diff", "accept"}
    if not targets or targets - known.keys():
        return ARTIFACTS
    return sorted({name for target in targets for name in known[target]})


def requested_files(wildcards):
    """The files to compare: those of the figures and tables named, or everything."""
    if requested(wildcards) == ARTIFACTS:
        return rules.all.input
    return [file for name in requested(wildcards) for file in files(name)]


def results_folder(wildcards):
    """The folder of the results, below a prefix if this workflow is a module with one."""
    return os.path.dirname(rules.article.output.paper)


def description(name):
    """The parameters and the code from which a figure or table is made."""
    for stage, names in STAGES.items():
        if name in names:
            given = config.get(stage, {}).get(name, {})
            settings = {key: config[key] for key in SETTINGS[stage]}
            return {"parameters": {**given, **settings}, "code": code(stage)}
    script = "draw" if name in SCHEMATICS else name
    return {"parameters": {}, "code": code(script)}


wildcard_constraints:
    table="|".join(TABLES),

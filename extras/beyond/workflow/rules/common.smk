# Names and paths that the rules share.

import os
from pathlib import Path

# Where the packages are that scripts import: the library, what the studies share, the replication.
FOLDERS = {
    "bouncing_ball_beyond": PACKAGE / "src",
    "studies": PACKAGE / "workflow",
    "bouncing_ball": REPLICATION / "src",
}
# Scripts import these folders, whatever else is installed.
paths = [*map(str, FOLDERS.values()), os.environ.get("PYTHONPATH", "")]
os.environ.update(PYTHONPATH=os.pathsep.join(filter(None, paths)))

# The datasets of each stage.
STAGES = {stage: list(names) for stage, names in config.items() if isinstance(names, dict)}
DATASETS = [name for names in STAGES.values() for name in names]
FIGURES = [name for name in DATASETS if name not in ("ext_event", "explorer")]
TABLES = ["ext_orders", "ext_laws"]
TEXTS = ["article", "appendix", "figures"]

# Settings of the whole run on which the datasets of a stage depend.
SETTINGS = {
    "impacts": ["release"],
    "error_law": ["release"],
    "stiffness_map": [],
    "contact_laws": [],
    "phases": [],
    "events": [],
    "explorer": [],
}


def modules(package, *names):
    return [f"{package}/{name}" for name in names]


# The modules that each script imports, directly or by another module. A change of one of them runs
# the script again. A test compares these lists with the imports.
ORBITS = modules(
    "bouncing_ball_beyond",
    *("balls", "equations", "paths", "one_ball", "simulation"),
    *("periodic", "special_orbits", "forms", "continuation"),
)
ERRORS = [*ORBITS, *modules("bouncing_ball_beyond", "laws", "root_time", "error_law")]
SAVING = ["studies/variables", "bouncing_ball/datasets"]
STUDIES = ["studies/orbits", "bouncing_ball/restitution"]
MODELS = modules("bouncing_ball", "restitution", "spring_damper")
REPLICATED_ERRORS = [*MODELS, *modules("bouncing_ball", "orbits", "continuation", "errors")]
DRAWING = ["studies/figures", "bouncing_ball/drawing", *SAVING]
TABLES_OF_BOTH = [*MODELS, *modules("bouncing_ball", "tables", "claims", "verdicts")]
TABULATING = ["studies/tables", *TABLES_OF_BOTH, *SAVING]
WRITING = ["studies/article", *TABLES_OF_BOTH, *modules("bouncing_ball", "article", "datasets")]
PAGE = ["studies/explorer", "bouncing_ball/datasets"]
COMPARISON = [
    *DRAWING,
    *TABULATING,
    *WRITING,
    *PAGE,
    "studies/products",
    *modules("bouncing_ball", "compare", "differences"),
]
MODULES = {
    "impacts": [*ORBITS, *SAVING],
    "error_law": [*ERRORS, *STUDIES, *REPLICATED_ERRORS, *SAVING],
    "stiffness_map": [*ERRORS, *STUDIES, *SAVING],
    "contact_laws": [*ERRORS, "bouncing_ball_beyond/named_laws", *STUDIES, *SAVING],
    "phases": [*ERRORS, "bouncing_ball_beyond/named_laws", "studies/waveforms", *SAVING],
    "events": [*ORBITS, "bouncing_ball_beyond/motions", *SAVING],
    "explorer": [*ERRORS, *STUDIES, *SAVING],
    "draw": DRAWING,
    "tables": TABULATING,
    "explorer_page": PAGE,
    "article": WRITING,
    "compare": COMPARISON,
    "accept": COMPARISON,
}
# The files of the page of the explorer.
EXPLORER = sorted((PACKAGE / "workflow/explorer").iterdir())
# What scripts import, for `snakemake --sdm conda`: that of the replication.
ENVIRONMENT = str(REPLICATION / "workflow/envs/environment.yaml")


def package(path):
    """A file of this package, as a path from the working directory.

    The mark `local` keeps it as it is if this workflow is a module with a prefix.
    """
    return local(os.path.relpath(PACKAGE / path))


def code(script):
    """The files that decide what a script makes: itself, and the modules that it imports."""
    named = [name.split("/") for name in dict.fromkeys(MODULES[script])]
    packages = dict.fromkeys(folder for folder, _ in named)
    named = [*([folder, "__init__"] for folder in packages), *named]
    files = [FOLDERS[folder] / folder / f"{module}.py" for folder, module in named]
    return [package(path) for path in [f"workflow/scripts/{script}.py", *files]]


def datasets(stage):
    """The files of the datasets of a stage, by name."""
    return {name: f"results/figures/{name}.nc" for name in STAGES[stage]}


def pictures(stage):
    """The pictures of a stage, with what the report says of them."""
    png = [f"results/figures/{name}.png" for name in STAGES[stage]]
    about = {"caption": f"../report/{stage}.rst", "category": "Figures"}
    return {
        "png": [report(file, labels={"figure": Path(file).stem}, **about) for file in png],
        "svg": [f"results/figures/{name}.svg" for name in STAGES[stage]],
    }


def files(name):
    """All files of a figure, a table or a dataset."""
    kinds = ["nc"]
    if name in FIGURES:
        kinds += ["png", "svg"]
    if name in TABLES:
        kinds += ["md", "csv"]
    if name == "explorer":
        kinds += ["html"]
    return [f"results/figures/{name}.{kind}" for kind in kinds]


def requested(wildcards):
    """The figures that the command line names together with `diff` or `accept`.

    With any other target, such as `article` or a file, everything is compared.
    """
    known = {name: [name] for name in DATASETS} | STAGES
    targets = set(workflow.dag_settings.targets) - {"diff", "accept"}
    if not targets or targets - known.keys():
        return []
    return sorted({name for target in targets for name in known[target]})


def requested_files(wildcards):
    """The files to compare: those of the figures named, or everything."""
    names = requested(wildcards)
    return [file for name in names for file in files(name)] or rules.all.input


def results_folder(wildcards):
    """The folder of the results, below a prefix if this workflow is a module with one."""
    return os.path.dirname(rules.article.output.article)


def reference_folder(wildcards):
    """The folder of the reference."""
    return os.path.relpath(PACKAGE)


def descriptions():
    """The parameters and the code from which each dataset is made."""
    found = {}
    for stage, names in STAGES.items():
        settings = {key: config[key] for key in SETTINGS[stage]}
        for name in names:
            parameters = {**config[stage][name], **settings}
            found[name] = {"parameters": parameters, "code": code(stage)}
    return found


wildcard_constraints:
    table="|".join(TABLES),

# What only this workflow has of the names and paths that its rules share.

HERE = PACKAGE
# Of the library, of what the studies share, and of the replication.
SOURCES = [PACKAGE / "src", PACKAGE / "workflow", REPLICATION / "src"]


include: "../../../../workflow/rules/registry.smk"


def package(path):
    """A file of this package, as a path from the working directory."""
    return relative(PACKAGE / path)


# The settings of the whole run on which the datasets of a stage depend.
SETTINGS = {"impacts": ["release"], "error_law": ["release"]}
READS = {}
KINDS["explorer"] = ["nc", "html"]
TEXTS = ["article", "appendix", "phase", "figures"]

# The files of the page of the explorer.
EXPLORER = sorted((PACKAGE / "workflow/explorer").iterdir())
# What scripts import, for `snakemake --sdm conda`: that of the replication.
ENVIRONMENT = str(REPLICATION / "workflow/envs/environment.yaml")


def results_folder(wildcards):
    """The folder of the results, below a prefix if this workflow is a module with one."""
    return os.path.dirname(rules.article.output.article)


def reference_folder(wildcards):
    """The folder of the reference."""
    return os.path.relpath(PACKAGE)

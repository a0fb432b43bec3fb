# What only this workflow has of the names and paths that its rules share.

HERE = CHECKOUT
SOURCES = [CHECKOUT / "src"]


include: "registry.smk"


def checkout(path):
    """A file of the checkout, as a path from the working directory."""
    return relative(CHECKOUT / path)


# On what scripts depend beside their code and the parameters of their stage: settings of the whole
# run, and the table as the paper prints it.
SETTINGS = {
    "apparent_restitution": ["release"],
    "continuation": ["release", "largest_step"],
    "permanent_contact": ["release"],
    "error_thresholds": ["release"],
    "validity": ["release"],
    "time_histories": ["release"],
}
PRINTED = {"printed": checkout("config/table1_printed.csv")}
READS = {"continuation": PRINTED, "readings": PRINTED, "claims": PRINTED}
READS["article"] = {"choices": checkout("workflow/studies/choices.csv")}

# The claims follow from all datasets.
KINDS["claims"] = ["nc", "md", "csv"]


def results_folder(wildcards):
    """The folder of the results, below a prefix if this workflow is a module with one."""
    return os.path.dirname(rules.article.output.paper)

# The configuration: that of this folder, then that of the folder of the run, then what the command
# line gives. A mistake ends the run before any job, as in the replication, whose checks are used.

import os
from pathlib import Path


include: "../../../../workflow/rules/checks.smk"


# This package, and the checkout of the replication around it. Runs in another folder (--directory),
# or as a module of another workflow, read the configuration, code and reference of this package, and
# write their results below the folder of the run.
PACKAGE = Path(workflow.current_basedir).parents[1].resolve()
REPLICATION = PACKAGE.parents[1]


refuse_place(PACKAGE)
given = os.path.relpath(PACKAGE / "config/config.yaml")
refuse_files([given])


configfile: given


# With --directory. A workflow that uses this one as a module may have its own file of this name.
is_module = Path(workflow.basedir).resolve() != PACKAGE
if not is_module and Path.cwd() != PACKAGE and os.path.exists("config/config.yaml"):
    refuse_files(["config/config.yaml"])

    configfile: "config/config.yaml"


def crossed(parameters, keys=()):
    """A line for each mistake that a schema cannot know, in a section and those inside."""
    for key, value in parameters.items():
        if isinstance(value, dict):
            yield from crossed(value, (*keys, key))
    yield from unordered(parameters, keys)
    if "amplitude" in parameters:
        yield from below_saddle_node(parameters["n"], parameters, keys)
    for index, case in enumerate(parameters.get("further", [])):
        yield from below_saddle_node(case["n"], case, (*keys, "further", index))


schema = yaml_of(PACKAGE / "config/schema.yaml")
refuse_files(workflow.configfiles)
refuse(config, schema, crossed)

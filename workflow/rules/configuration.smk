# The configuration: that of the checkout, then that of the folder of the run, then what the command
# line gives. A mistake ends the run before any job, with a line that names the key, its value and
# what is allowed.

import os
from pathlib import Path


include: "checks.smk"


# The checkout. Runs in another folder (--directory), or as a module of another workflow, read its
# configuration, code and reference, and write their results below the folder of the run.
CHECKOUT = Path(workflow.current_basedir).parents[1].resolve()


refuse_place(CHECKOUT)
given = os.path.relpath(CHECKOUT / "config/config.yaml")
refuse_files([given])


configfile: given


# With --directory. A workflow that uses this one as a module may have its own file of this name.
is_module = Path(workflow.basedir).resolve() != CHECKOUT
if not is_module and Path.cwd() != CHECKOUT and os.path.exists("config/config.yaml"):
    refuse_files(["config/config.yaml"])

    configfile: "config/config.yaml"


def crossed(parameters, keys=()):
    """A line for each mistake that a schema cannot know, in a section and those inside."""
    for key, value in parameters.items():
        if isinstance(value, dict):
            yield from crossed(value, (*keys, key))
    yield from unordered(parameters, keys)
    for index, curve in enumerate(parameters.get("curves", [])):
        yield from below_saddle_node(curve["n"], curve, (*keys, "curves", index))
    if "advised" in parameters:
        yield from outside("advised", parameters, parameters["frequency_ratio"], keys)
    elif "n" in parameters:
        yield from too_low(parameters, keys)


def too_low(parameters, keys):
    """A line for each amplitude without an orbit, of the parameters or of its cases."""
    # Branches of several families need the orbit of the highest.
    n = max(parameters["n"]) if isinstance(parameters["n"], list) else parameters["n"]
    cases = parameters.get("cases", [parameters])
    for index, case in enumerate(cases):
        inside = (*keys, "cases", index) if "cases" in parameters else keys
        yield from below_saddle_node(n, case, inside)


schema = yaml_of(CHECKOUT / "config/schema.yaml")
refuse_files(workflow.configfiles)
refuse(config, schema, crossed)

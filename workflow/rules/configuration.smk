# The configuration: that of the checkout, then that of the folder of the run, then what the command
# line gives. A mistake ends the run before any job, with a line that names the key, its value and
# what is allowed.

import math
import os
import re
import sys
from difflib import get_close_matches
from pathlib import Path

import yaml
from jsonschema import Draft202012Validator, validators

# The checkout. Runs in another folder (--directory), or as a module of another workflow, read its
# configuration, code and reference, and write their results below the folder of the run.
CHECKOUT = Path(workflow.current_basedir).parents[1].resolve()


configfile: os.path.relpath(CHECKOUT / "config/config.yaml")


# With --directory. A workflow that uses this one as a module may have its own file of this name.
is_module = Path(workflow.basedir).resolve() != CHECKOUT
if not is_module and Path.cwd() != CHECKOUT and os.path.exists("config/config.yaml"):

    configfile: "config/config.yaml"


# Figures that are not in the paper may have any parameters, unless the schema has them.
FURTHER = re.compile("fig1[7-9]")


def is_whole(checker, value):
    return isinstance(value, int) and not isinstance(value, bool)


def is_finite(checker, value):
    return is_whole(checker, value) or isinstance(value, float) and math.isfinite(value)


# In JSON 1.0 is an integer, and "not a number" has no name.
TYPES = Draft202012Validator.TYPE_CHECKER.redefine_many({"integer": is_whole, "number": is_finite})
Validator = validators.extend(Draft202012Validator, type_checker=TYPES)


def place(keys):
    """The keys to a value, as `continuation.fig08.frequency_ratio[0]`."""
    return "".join(f"[{key}]" if isinstance(key, int) else f".{key}" for key in keys)[1:]


def mistakes(config, schema):
    """A line for each mistake that the schema knows."""
    for error in Validator(schema).iter_errors(config):
        where = place(error.absolute_path)
        reason = error.schema.get("description")
        if error.validator == "additionalProperties":
            allowed = error.schema["properties"]
            for key in error.instance.keys() - allowed:
                if len(error.absolute_path) == 1 and FURTHER.fullmatch(str(key)):
                    continue
                near = get_close_matches(str(key), allowed, n=1) or allowed
                yield f"unknown key {place([*error.absolute_path, key])}, allowed: {', '.join(near)}"
        elif (
            error.validator != "required"
            or error.instance.keys() <= error.schema["properties"].keys()
        ):
            yield f"{where or 'the file'}: {error.message}" + (f" ({reason})" if reason else "")


def crossed(parameters, keys=()):
    """A line for each mistake that a schema cannot know, in a section and those inside."""
    for key, value in parameters.items():
        if isinstance(value, dict) and not FURTHER.fullmatch(key):
            yield from crossed(value, (*keys, key))
    if {"min", "max"} <= parameters.keys() and parameters["min"] >= parameters["max"]:
        yield f"{place(keys)}.min = {parameters['min']}: must be less than max = {parameters['max']}"
    if "n" not in parameters:
        return
    # The n-T orbit of the restitution model exists from its saddle-node on, Eq. 7. Branches of
    # several families need the orbit of the highest.
    n = max(parameters["n"]) if isinstance(parameters["n"], list) else parameters["n"]
    cases = parameters.get("cases", [parameters])
    for index, case in enumerate(cases):
        inside = (*keys, "cases", index) if "cases" in parameters else keys
        r = case["restitution"]
        lowest = n * math.pi * (1 - r) / (1 + r)
        for key in {"amplitude", "amplitude_max"} & case.keys():
            for amplitude in case[key] if isinstance(case[key], list) else [case[key]]:
                if amplitude < lowest:
                    yield (
                        f"{place(inside)}.{key} = {amplitude}: must be at least {lowest:.6g}, the "
                        f"saddle-node of the {n}-T orbit at r = {r} (Eq. 7)"
                    )


def repeated(node, keys=()):
    """A line for each key that a file names twice, of which YAML would take the last."""
    if isinstance(node, yaml.SequenceNode):
        for index, item in enumerate(node.value):
            yield from repeated(item, (*keys, index))
    if isinstance(node, yaml.MappingNode):
        seen = set()
        for key, value in node.value:
            if key.value in seen:
                yield f"{place([*keys, key.value])} occurs twice, in line {key.start_mark.line + 1} again"
            seen.add(key.value)
            yield from repeated(value, (*keys, key.value))


# That of libyaml is several times faster.
Loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
found = []
for file in dict.fromkeys(workflow.configfiles):
    node = yaml.compose(Path(file).read_text("utf-8"), Loader)
    found += [f"{file}: {line}" for line in repeated(node)]
schema = yaml.load((CHECKOUT / "config/schema.yaml").read_text("utf-8"), Loader)
found = found or list(mistakes(config, schema)) or list(crossed(config))
if found:
    # Snakemake would print its WorkflowError in three lines, with places in this file.
    sys.exit("\n".join(f"configuration: {line}" for line in found))

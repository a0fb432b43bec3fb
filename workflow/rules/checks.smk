# What is wrong with a configuration, or with the place of results: the functions that both workflows
# of this repository share.

import math
import os
import sys
from difflib import get_close_matches
from pathlib import Path

import yaml
from jsonschema import Draft202012Validator, validators

LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


def yaml_of(file):
    """What a YAML file says; libyaml reads it several times faster."""
    return yaml.load(Path(file).read_text("utf-8"), LOADER)


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


def mistakes(config, schema, further=None):
    """A line for each mistake that the schema knows.

    In a stage, names that match the pattern `further` may have any parameters.
    """
    for error in Validator(schema).iter_errors(config):
        where = place(error.absolute_path)
        reason = error.schema.get("description")
        if error.validator == "additionalProperties":
            allowed = error.schema["properties"]
            for key in error.instance.keys() - allowed:
                if further and len(error.absolute_path) == 1 and further.fullmatch(str(key)):
                    continue
                near = get_close_matches(str(key), allowed, n=1) or allowed
                yield f"unknown key {place([*error.absolute_path, key])}, allowed: {', '.join(near)}"
        elif (
            error.validator != "required"
            or error.instance.keys() <= error.schema["properties"].keys()
        ):
            yield f"{where or 'the file'}: {error.message}" + (f" ({reason})" if reason else "")


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


def unordered(limits, keys):
    """A line if the lower limit of a range is not below the upper one."""
    if {"min", "max"} <= limits.keys() and limits["min"] >= limits["max"]:
        yield f"{place(keys)}.min = {limits['min']}: must be less than max = {limits['max']}"


def below_saddle_node(n, case, keys):
    """A line for each amplitude at which the restitution model has no n-T orbit (Eq. 7)."""
    r = case["restitution"]
    lowest = n * math.pi * (1 - r) / (1 + r)
    for key in {"amplitude", "amplitude_max"} & case.keys():
        for amplitude in case[key] if isinstance(case[key], list) else [case[key]]:
            if amplitude < lowest:
                yield (
                    f"{place(keys)}.{key} = {amplitude}: must be at least {lowest:.6g}, the "
                    f"saddle-node of the {n}-T orbit at r = {r} (Eq. 7)"
                )


def refuse(files, config, schema, crossed, further=None):
    """End the run with a line for each mistake: of its files, against its schema, and `crossed`,
    a function that finds what a schema cannot know.
    """
    found = []
    for file in dict.fromkeys(files):
        node = yaml.compose(Path(file).read_text("utf-8"), LOADER)
        found += [f"{file}: {line}" for line in repeated(node)]
    found = found or list(mistakes(config, schema, further)) or list(crossed(config))
    if found:
        # Snakemake would print its WorkflowError in three lines, with places in this file.
        sys.exit("\n".join(f"configuration: {line}" for line in found))


def refuse_links(checkout):
    """End the run if its results would be written over a checkout, for example through a link."""
    for folder in (Path("results"), Path("results/figures")):
        target = folder.resolve()
        linked = target != folder.absolute() and target.is_relative_to(checkout)
        if linked or target.is_relative_to(checkout / "figures"):
            sys.exit(f"{folder} is {target}: results must not be written over the checkout")
        if target.exists() and not target.is_dir():
            sys.exit(f"{folder} is no folder, but results are written there")

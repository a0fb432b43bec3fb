# What is wrong with a configuration, or with the place of a run: the functions that both workflows of
# this repository share. Their Snakefiles include this file. Their profiles run it as well, because
# Snakemake reads the files and values of its command line before it reads a Snakefile.

import argparse
import errno
import fcntl
import getpass
import math
import os
import re
import sys
import tempfile
from difflib import get_close_matches
from functools import cache
from pathlib import Path

import yaml
from jsonschema import Draft202012Validator, validators

LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
ALLOWED = "allowed: one YAML document of keys and values in UTF-8, as config/config.yaml"
# Snakemake writes the path of Python into a command of the shell, and replaces names in braces.
SPECIAL = set(" \t\n'\"\\`$&|;<>(){}")


def end(*lines):
    """End the run with these lines; control characters are written as escapes.

    Snakemake would print an exception of its own in three lines, with places in this file.
    """
    shown = ("".join(c if c.isprintable() else ascii(c)[1:-1] for c in line) for line in lines)
    sys.exit("\n".join(shown))


def yaml_of(file):
    """What a YAML file says; libyaml reads it several times faster."""
    return yaml.load(Path(file).read_text("utf-8"), LOADER)


def waits(path):
    """Whether a path is that of a pipe or a device, whose content may never come."""
    return os.path.exists(path) and not (os.path.isfile(path) or os.path.isdir(path))


def composed(file):
    """The YAML node of a configuration file, and the line on it if it has none.

    The loader in Python reads what libyaml cannot, because its messages name the character or the
    alias.
    """
    allowed = "allowed: a file; --configfile takes all names up to the next option"
    if waits(file):
        return None, f"{file}: a pipe or a device; {allowed}"
    try:
        content = Path(file).read_bytes()
    except OSError as error:
        return None, f"{file or repr(file)}: {error.strerror}; {allowed}"
    text = content.decode("utf-8", errors="replace")
    try:
        content.decode("utf-8")
        try:
            node = yaml.compose(text, LOADER)
        except yaml.YAMLError:
            node = yaml.compose(text, yaml.SafeLoader)
        if isinstance(node, yaml.MappingNode):
            # Tags and keys that YAML knows and a configuration cannot have.
            yaml.SafeLoader("").construct_document(node)
            return node, None
        reason = "no keys" if node else "the file is empty"
        line = node.start_mark.line if node else 0
    except UnicodeDecodeError as error:
        reason = f"the byte 0x{content[error.start]:02x} is not UTF-8"
        line = content.count(b"\n", 0, error.start)
    except yaml.reader.ReaderError as error:
        reason = error.reason
        line = text.count("\n", 0, error.position)
    except yaml.MarkedYAMLError as error:
        reason = error.problem.removeprefix("but ")
        line = error.problem_mark.line
        if error.context_mark and line == len(text.splitlines()):
            # Something is open at the end of the file.
            reason = f"{error.context}: {reason}"
            line = error.context_mark.line
    except (ValueError, RecursionError) as error:
        # A date that no calendar has, or hundreds of brackets.
        return None, f"{file}: {error}; {ALLOWED}"
    shown = [repr(each[:60]) for each in text.splitlines()[line : line + 1]]
    found = ": ".join([f"{file}, line {line + 1}", *shown, reason])
    return None, f"{found}; {ALLOWED}"


def is_whole(checker, value):
    return isinstance(value, int) and not isinstance(value, bool)


def is_finite(checker, value):
    return is_whole(checker, value) or isinstance(value, float) and math.isfinite(value)


# In JSON 1.0 is an integer, and "not a number" has no name.
TYPES = Draft202012Validator.TYPE_CHECKER.redefine_many({"integer": is_whole, "number": is_finite})
Validator = validators.extend(Draft202012Validator, type_checker=TYPES)


def place(keys):
    """The keys to a value, as `continuation.fig08.frequency_ratio[0]`."""
    parts = (f"[{key}]" if isinstance(key, int) else f".{key}" for key in keys)
    return "".join(parts).removeprefix(".")


def entries(section):
    """The stages of a configuration, or the figures, tables and datasets of a stage, by name."""
    return {name: entry for name, entry in section.items() if isinstance(entry, dict)}


def parameters_of(entry):
    """What an entry has beside its title, its caption, and `table`."""
    return {key: value for key, value in entry.items() if key not in ("title", "caption", "table")}


def without_new(section, known):
    """A section without the entries that `known` does not have and that have a title: they are new,
    and may have any parameters.
    """
    return {
        name: entry
        for name, entry in section.items()
        if name in known or not isinstance(entry, dict) or "title" not in entry
    }


def judged_by(schema, config):
    """What of a configuration its schema judges: the parameters of what it knows."""
    found = without_new(config, schema["properties"])
    for stage, section in entries(found).items():
        known = schema["properties"].get(stage, {}).get("properties", {})
        kept = without_new(parameters_of(section), known)
        found[stage] = kept | {name: parameters_of(entry) for name, entry in entries(kept).items()}
    return found


def undescribed(config):
    """A line for each stage, figure, table or dataset that is not described as it must be."""
    described = [((stage,), section) for stage, section in entries(config).items()]
    for stage, section in entries(config).items():
        described += [((stage, name), entry) for name, entry in entries(section).items()]
    names = []
    for keys, entry in described:
        for key, kind, what in (
            ("title", str, "a text"),
            ("caption", str, "a text"),
            ("table", bool, "true or false"),
        ):
            if (key in entry or key == "title") and not isinstance(entry.get(key), kind):
                yield f"{place([*keys, key])} = {entry.get(key)}: must be {what}"
        if not str(keys[-1]).isidentifier():
            yield f"{place(keys)}: a name has letters, digits and underscores"
        if len(keys) > 1:
            if keys[-1] in names:
                yield f"{place(keys)}: another stage has this name too"
            names.append(keys[-1])


def mistakes(config, schema):
    """A line for each mistake that the schema knows."""
    for error in Validator(schema).iter_errors(config):
        where = place(error.absolute_path)
        reason = error.schema.get("description")
        if error.validator == "additionalProperties":
            allowed = error.schema["properties"]
            for key in error.instance.keys() - allowed:
                near = get_close_matches(str(key), allowed, n=1) or allowed
                # Parameters are numbers, texts and lists, and entries are not.
                new = ", or a new one with a title" if isinstance(error.instance[key], dict) else ""
                where = place([*error.absolute_path, key])
                yield f"unknown key {where}, allowed: {', '.join(near)}{new}"
        elif (
            error.validator != "required"
            or error.instance.keys() <= error.schema["properties"].keys()
        ):
            yield f"{where or 'the file'}: {error.message}" + (f" ({reason})" if reason else "")


def repeated(node, keys=(), above=(), seen=None):
    """A line for each key that a mapping has twice, of which YAML would take the last, and for each
    alias inside of what it stands for. What several aliases stand for is read once.
    """
    seen = set() if seen is None else seen
    if node in above:
        yield f"{place(keys)} contains itself, allowed: values without an alias to what is around it"
    if node in seen:
        return
    seen.add(node)
    if isinstance(node, yaml.SequenceNode):
        for index, item in enumerate(node.value):
            yield from repeated(item, (*keys, index), (*above, node), seen)
    if isinstance(node, yaml.MappingNode):
        named = set()
        for key, value in node.value:
            if key.value in named:
                yield f"{place([*keys, key.value])} occurs twice, in line {key.start_mark.line + 1} again"
            named.add(key.value)
            yield from repeated(value, (*keys, key.value), (*above, node), seen)


@cache
def wrong(file):
    """A line for each mistake of a file by itself, without the schema."""
    node, line = composed(file)
    return [line] if line else [f"{file}: {each}" for each in repeated(node)]


def unordered(limits, keys):
    """A line if the lower limit of a range is not below the upper one."""
    if {"min", "max"} <= limits.keys() and limits["min"] >= limits["max"]:
        yield f"{place(keys)}.min = {limits['min']}: must be less than max = {limits['max']}"


def outside(key, parameters, limits, keys):
    """A line if a parameter is outside of a range."""
    if not limits["min"] <= parameters[key] <= limits["max"]:
        yield (
            f"{place(keys)}.{key} = {parameters[key]}: must be within {limits['min']} and "
            f"{limits['max']}, the ends of frequency_ratio"
        )


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


def refuse_files(files):
    """End the run with a line for each mistake of the files by themselves."""
    found = [line for file in dict.fromkeys(map(str, files)) for line in wrong(file)]
    if found:
        end(*(f"configuration: {line}" for line in found))


def refuse(config, schema, crossed):
    """End the run with a line for each mistake against the schema, or that `crossed` finds, a function
    for what a schema cannot know.
    """
    known = judged_by(schema, config)
    found = list(mistakes(known, schema)) or list(undescribed(config)) or list(crossed(known))
    if found:
        end(*(f"configuration: {line}" for line in found))


def refuse_command(arguments):
    """End the run if a value or a file of the command line is no configuration, or if Snakemake would
    fail for want of a user's name or of a folder for its cache.
    """
    parser = argparse.ArgumentParser(add_help=False, allow_abbrev=False)
    parser.add_argument("--configfile", "--configfiles", nargs="+", default=[])
    parser.add_argument("--config", "-C", nargs="*", default=[])
    given, _ = parser.parse_known_args(arguments)
    for entry in given.config:
        key, equals, _ = entry.partition("=")
        if not (equals and re.fullmatch(r"[a-zA-Z_][\w-]*\w", key)):
            end(f"configuration: --config {entry}: allowed: KEY=VALUE, as in largest_step=0.2")
    refuse_files(given.configfile)
    try:
        getpass.getuser()
    except (KeyError, OSError):
        end(f"The user {os.getuid()} has no name on this machine: set USER to any name")
    try:
        home = Path.home()
    except RuntimeError:
        end(f"The user {os.getuid()} has no home folder: set HOME to any folder, be it /")
    cache = Path(os.environ.get("XDG_CACHE_HOME") or home / ".cache")
    try:
        cache.mkdir(parents=True, exist_ok=True)
        tempfile.TemporaryFile(dir=cache).close()
    except OSError as error:
        end(f"{cache}: {error.strerror}; set XDG_CACHE_HOME to a folder that can be written to")


def refuse_place(checkout):
    """End the run if Snakemake cannot run in this folder or with this Python, or if the results would
    be written over a checkout, for example through a link, or where netCDF files cannot be locked.
    """
    for path, special in [(str(checkout), {*"{}"}), (sys.executable, SPECIAL)]:
        if found := special & set(path):
            named = " ".join(sorted(map(repr, found)))
            end(
                f"{path} has {named} in its name, and Snakemake cannot run there: rename the folder"
            )
    for folder in (Path("results"), Path("results/figures")):
        target = folder.resolve()
        linked = target != folder.absolute() and target.is_relative_to(checkout)
        if linked or target.is_relative_to(checkout / "figures"):
            end(f"{folder} is {target}: results must not be written over the checkout")
        if target.exists() and not target.is_dir():
            end(f"{folder} is no folder, but results are written there")
        for path in sorted(folder.glob("*")):
            if waits(path):
                end(f"{path} is a pipe or a device, which would be waited for: remove it")
    refuse_no_locks(Path("results") if Path("results").is_dir() else Path())


def refuse_no_locks(folder):
    """End the run if a file in a folder cannot be locked, as HDF5 does with each netCDF file."""
    if os.environ.get("HDF5_USE_FILE_LOCKING") in ("FALSE", "0"):
        return
    try:
        file = tempfile.TemporaryFile(dir=folder)
    except OSError:
        # Nothing can be written here; the jobs say so if they have to.
        return
    with file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            # HDF5 goes on if the system does not know of locks at all.
            if error.errno == errno.ENOSYS:
                return
            end(
                f"{folder.absolute()}: the file system has no locks ({error.strerror}): set "
                "HDF5_USE_FILE_LOCKING=FALSE, and let one run at a time write here"
            )

"""A configuration: its mistakes, and what the rules of a workflow make of its entries.

The sections of a configuration are stages, and their entries are figures, tables and datasets. All
that an entry may have besides its parameters is `described` among the definitions of the schema.
"""

import ast
import re
import sys
from collections.abc import Collection, Iterable, Iterator, Mapping
from difflib import get_close_matches
from itertools import chain, repeat
from pathlib import Path
from typing import Any

import yaml
from jsonschema import Draft202012Validator
from jsonschema.exceptions import ValidationError


def checked(config: Mapping, schema_file: Path, files: Iterable[str]) -> dict:
    """Return a configuration, which was read from files, with an int for each whole number.

    A mistake ends the program, with a line for each.
    """
    schema = yaml.safe_load(schema_file.read_text("utf-8"))
    lines = [
        f"{Path(file).name}, {line}"
        for file in files
        for line in mistakes_in_text(Path(file).read_text("utf-8"))
    ]
    stop(lines or mistakes(config, schema))
    return with_whole_numbers(config, schema, schema["$defs"])


def stop(mistakes: Iterable[str]) -> None:
    """End the program with the mistakes in the configuration, if there are some."""
    if lines := [f"configuration: {line}" for line in mistakes]:
        sys.exit("\n".join(lines))


def mistakes(config: Mapping, schema: Mapping) -> Iterator[str]:
    """Yield a line for each mistake: the key, its value, and what is allowed.

    >>> schema = {"properties": {"release": {"enum": ["displacement", "force"]}}}
    >>> schema |= {"additionalProperties": False}
    >>> list(mistakes({"release": "sticky"}, schema))
    ["release: 'sticky' is not one of ['displacement', 'force']"]
    >>> list(mistakes({"relese": "force"}, schema))
    ['relese: unknown key, did you mean release?']
    >>> schema |= {"$defs": {"described": {"properties": {"title": {}}}}}
    >>> list(mistakes({"stage": {}}, schema))
    ['stage: unknown key, allowed: release']
    >>> list(mistakes({"period": {}}, {"properties": {"periods": {}}, "required": ["periods"]}))
    ['period: unknown key, did you mean periods?']
    """
    if missing := [name for name in schema.get("required", []) if name not in config]:
        unknown = [name for name in config if name not in schema["properties"]]
        misnamed = [name for name in unknown if get_close_matches(name, missing, n=1)]
        yield from (f"{name}: unknown key{meant(name, missing)}" for name in misnamed)
        if not misnamed:
            names_of_all = ", ".join(missing)
            yield f"{names_of_all} missing: leave out --replace-workflow-config to change parts"
        return
    yield from impossible_numbers(config)
    misplaced = settings_in_entries(config, schema)
    yield from (f"{path}: a setting of the whole run, not of an entry" for path in misplaced)
    for error in Draft202012Validator(schema).iter_errors(config):
        if error.validator in ("additionalProperties", "unevaluatedProperties"):
            lines = unknown_keys(error, schema)
            yield from (line for path, line in lines.items() if path not in misplaced)
        elif error.validator == "required" and error.validator_value == ["title"]:
            yield untitled(error, schema)
        else:
            where = dotted(error.absolute_path)
            yield ": ".join(filter(None, (where, f"{error.message}{reason(error)}")))


def settings_in_entries(config: Mapping, schema: Mapping) -> list[str]:
    """Return the paths of settings of the whole run that stand in an entry."""
    settings = schema.get("properties", {}).keys() & config.keys() - stages(config)
    return [
        dotted((stage, name, key))
        for stage, section in stages(config).items()
        for name, entry in section.items()
        if isinstance(entry, Mapping)
        for key in entry
        if key in settings
    ]


def unknown_keys(error: ValidationError, schema: Mapping) -> dict[str, str]:
    """Return a line for each key that the schema does not know, by its path."""
    known = [*error.schema["properties"]]
    if error.validator == "unevaluatedProperties":
        known += schema.get("$defs", {}).get("described", {}).get("properties", ())
    paths = {dotted((*error.absolute_path, key)): str(key) for key in error.instance}
    unknown = {path: key for path, key in paths.items() if key not in known}
    return {path: f"{path}: unknown key{meant(key, known)}" for path, key in unknown.items()}


def untitled(error: ValidationError, schema: Mapping) -> str:
    """Return the line for an entry without a title: a new one, or one whose name is misspelled."""
    stage, name = error.absolute_path
    known = schema["properties"][stage]["properties"]
    unknown = "" if name in known else f"unknown key{meant(str(name), known)} "
    return f"{stage}.{name}: {unknown}({error.schema['description']})"


def dotted(path: Iterable[object]) -> str:
    """Return the path of a key, such as `continuation.table1.n`."""
    return ".".join(map(str, path))


def stages(config: Mapping) -> dict[str, Mapping]:
    """Return the sections of a configuration, by name."""
    return {name: section for name, section in config.items() if isinstance(section, Mapping)}


def entries(config: Mapping) -> dict[str, Mapping]:
    """Return the figures, tables and datasets of all stages, by name."""
    return {name: section[name] for section in stages(config).values() for name in names(section)}


SHOWN_BY = ("caption", "table")
"""Keys of an entry that decide how it is shown, and no number."""


def shown_as(entry: Mapping) -> list[str]:
    """Return the endings of the files that show an entry: pictures have a caption.

    >>> shown_as({"caption": "Height over time", "table": True})
    ['png', 'svg', 'md', 'csv']
    """
    picture = ["png", "svg"] if "caption" in entry else []
    table = ["md", "csv"] if entry.get("table") else []
    return picture + table


def names(section: Mapping) -> list[str]:
    """The figures, tables and datasets of a stage, of which this is the section."""
    return [name for name in section if name != "title"]


def datasets(section: Mapping) -> dict[str, str]:
    """The files of the datasets of a stage, by name."""
    return {name: f"results/figures/{name}.nc" for name in names(section)}


def computed_from(section: Mapping) -> dict[str, dict]:
    """The title and the parameters of each dataset of a stage."""
    return {
        name: {key: value for key, value in section[name].items() if key not in SHOWN_BY}
        for name in names(section)
    }


def captions(name: str, entry: Mapping) -> dict[str, str]:
    """What `snakemake --report` shows beside a figure or a table."""
    return {"name": name, "title": entry["title"], "caption": entry.get("caption", "")}


def named(config: Mapping, targets: Iterable[str]) -> list[str]:
    """The figures, tables and datasets that targets name; none for all.

    Claims and texts follow from all datasets: with them, everything is compared. A figure may show
    the `data` of another entry, which is compared, too.
    """
    known = entries(config)
    asked: set[str] = set()
    sections = stages(config)
    for target in {*targets} - {"diff"}:
        asked.update(names(sections[target]) if target in sections else [Path(target).stem])
    if not asked <= known.keys():
        return []
    return sorted(asked.union(known[name].get("data", name) for name in asked))


def without_function(top: Path, needed: Mapping[str, Iterable[str]]) -> Iterator[str]:
    """Yield a line for each entry for which a file of code, from a folder, has no function."""
    for file, names_of_entries in needed.items():
        known = registered(top / file)
        for name in names_of_entries:
            if name not in known:
                yield f"{name}: {file} needs a function for it"


def code_of_packages(folder: Path) -> Iterator[str]:
    """Yield a line for each `__init__.py` that has more than a docstring and a version.

    No rule lists these files, so that a change of their code would run nothing again.
    """
    for file in sorted(folder.rglob("__init__.py")):
        tree = ast.parse(file.read_text("utf-8"))
        lines = map(ast.unparse, tree.body[ast.get_docstring(tree) is not None :])
        if not all(line.startswith("__version__ = ") for line in lines):
            yield f"{file}: move its code into a module, because no rule lists this file"


def registered(file: Path) -> set[str]:
    """The keys of the dictionaries that a file of code has, such as those of its functions; none
    without the file.

    The file is not imported: with conda, its libraries are in the environment of the jobs only.
    """
    text = file.read_text("utf-8") if file.is_file() else ""
    nodes = ast.walk(ast.parse(text, str(file)))
    keys = chain.from_iterable(node.keys for node in nodes if isinstance(node, ast.Dict))
    return {str(key.value) for key in keys if isinstance(key, ast.Constant)}


def with_whole_numbers(value: Any, schema: Mapping, known: Mapping) -> Any:
    """Return a configuration with an int for each number that its schema calls an integer.

    JSON calls 1.0e+3 an integer, and Python does not. `known` has the definitions of the schema.

    >>> schema = {"properties": {"n": {"items": {"$ref": "#/$defs/n"}}}}
    >>> with_whole_numbers({"n": [1.0, 2]}, schema, {"n": {"type": "integer"}})
    {'n': [1, 2]}
    """
    schema = known.get(schema.get("$ref", "").rpartition("/")[2], {}) | schema
    if isinstance(value, Mapping):
        inner = schema.get("properties", {})
        return {
            key: with_whole_numbers(part, inner.get(key, {}), known) for key, part in value.items()
        }
    if isinstance(value, list):
        schemas = chain(schema.get("prefixItems", []), repeat(schema.get("items", {})))
        return [
            with_whole_numbers(part, inner, known)
            for part, inner in zip(value, schemas, strict=False)
        ]
    return int(value) if schema.get("type") == "integer" else value


def impossible_numbers(value: object, where: str = "") -> Iterator[str]:
    """Yield a line for each range whose ends are equal or reversed, and for each `.nan`."""
    if isinstance(value, list):
        value = dict(enumerate(value))
    if isinstance(value, Mapping):
        low = value.get("min")
        high = value.get("max")
        if isinstance(low, int | float) and isinstance(high, int | float) and low >= high:
            yield f"{where}: min = {low:g} must be less than max = {high:g}"
        for key, part in value.items():
            yield from impossible_numbers(part, f"{where}.{key}".removeprefix("."))
    elif value != value:
        yield f"{where}: .nan must be a number"


def unreadable(file: Path) -> Iterator[str]:
    """Yield why a file is no YAML in UTF-8, as with the marks of a conflict."""
    try:
        yaml.safe_load(file.read_bytes())
    except yaml.YAMLError as error:
        yield f"{file.name} cannot be read: {' '.join(str(error).split())}"


def mistakes_in_text(text: str) -> Iterator[str]:
    """Yield a line for each key that a mapping in YAML has twice, of which only the last value
    counts, and for each number that YAML 1.1 does not read as it is written.

    >>> list(mistakes_in_text("validity: {}\\ntable: {n: 1}\\nvalidity: {}"))
    ['line 3: validity stands twice: write its keys together']
    >>> list(mistakes_in_text("impacts: 02000"))
    ['line 1: YAML reads 02000 as 1024: write it in decimals']
    >>> list(mistakes_in_text("advised: [1:40, '1:40', 0.5, -1.0e-3]"))
    ['line 1: YAML reads 1:40 as 100: write it in decimals']
    """
    nodes = [yaml.compose(text)]
    for node in nodes:
        if isinstance(node, yaml.MappingNode):
            last = {key.value: key for key, _ in node.value}
            for key, value in node.value:
                nodes.append(value)
                if key is not last[key.value]:
                    line = last[key.value].start_mark.line + 1
                    yield f"line {line}: {key.value} stands twice: write its keys together"
        elif isinstance(node, yaml.SequenceNode):
            nodes.extend(node.value)
        elif node and node.tag.endswith(("int", "float")) and re.search(r"^\W?0\d|:", node.value):
            line = node.start_mark.line + 1
            number = yaml.safe_load(node.value)
            yield f"line {line}: YAML reads {node.value} as {number}: write it in decimals"


def meant(key: str, known: Collection[str]) -> str:
    """The known key that is nearest to an unknown one; all of them if none is near."""
    near = get_close_matches(key, known, n=1)
    return f", did you mean {near[0]}?" if near else f", allowed: {', '.join(known)}"


def reason(error: ValidationError) -> str:
    """Why a value is not allowed, and the remedy for a number that was read as a text."""
    described = error.schema.get("description")
    text = f" ({described})" if described else ""
    if error.validator == "type" and isinstance(error.instance, str):
        text += (
            "; YAML reads 1e4 as a text: write 1.0e+4; nested values of --config are texts: write "
            "them into a file for --configfile"
        )
    return text

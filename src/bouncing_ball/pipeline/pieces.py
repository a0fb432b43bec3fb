"""Whether every entry of the stages has all its pieces, before anything runs."""

import ast
from collections.abc import Iterable, Mapping
from typing import Any

from bouncing_ball.configuration.stages import Kind, Stage
from bouncing_ball.configuration.yaml_file import ConfigurationError
from bouncing_ball.figures import DRAWINGS
from bouncing_ball.pipeline.sources import module_file

SECTIONS = ("figures", "tables", "extensions", "studies")
"""Sections of the configuration in which each key is an artifact."""

# Where what draws or sets an artifact is, and what it is called.
_RENDERERS = {
    Kind.TABLE: ("figures.tables", "rows"),
}


def _require_function(stage: Stage, name: str) -> ast.FunctionDef | None:
    """The definition of a function, if it is not imported from elsewhere."""
    module, _, function = name.rpartition(".")
    file = module_file(f"bouncing_ball.{module}")
    if file is None:
        raise ConfigurationError(
            f"{stage.name}: no module src/bouncing_ball/{module.replace('.', '/')}.py, which must "
            f"define {function}"
        )
    tree = ast.parse(file.read_text(encoding="utf-8"))
    found = {node.name: node for node in tree.body if isinstance(node, ast.FunctionDef)}
    imported = [
        alias.asname or alias.name
        for node in tree.body
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
    ]
    if function not in [*found, *imported]:
        raise ConfigurationError(
            f"{stage.name}: no function {function} in src/bouncing_ball/{module.replace('.', '/')}"
        )
    return found.get(function)


def _require_arguments(stage: Stage, study: ast.FunctionDef) -> None:
    """Raise unless the study takes as many arguments as a job gives it."""
    given = [
        *(["data"] if stage.reads else []),
        *(["parameters"] if stage.section else []),
        *stage.arguments,
    ]
    taken = [argument.arg for argument in study.args.args]
    if not len(taken) - len(study.args.defaults) <= len(given) <= len(taken):
        raise ConfigurationError(
            f"{stage.name}: {stage.study} takes ({', '.join(taken)}), "
            f"its entry gives ({', '.join(given)})"
        )


def check_entries(entries: Iterable[Stage]) -> None:
    """Raise on a name that two entries have, or a list that is given as a text.

    Raises
    ------
    ConfigurationError
        One line that names the entry.
    """
    seen = set()
    for stage in entries:
        if stage.name in seen:
            raise ConfigurationError(f"{stage.name}: two entries have this name")
        seen.add(stage.name)
        for part in ("arguments", "reads"):
            value = getattr(stage, part)
            if isinstance(value, str):
                raise ConfigurationError(
                    f"{stage.name}: {part}={value!r} must be a tuple: {part}=({value!r},)"
                )


def check_pieces(stages: Mapping[str, Stage], run: Mapping[str, Any]) -> None:
    """Raise on the first piece that an entry names and that is missing.

    Parameters
    ----------
    stages : mapping
        The entries by name.
    run : mapping
        The configuration.

    Raises
    ------
    ConfigurationError
        One line: a parameter section, a study, a module that draws or sets the
        artifact, a dataset read, or a setting of the run that is not there; a
        study that takes other arguments; or a section of the configuration that
        no entry uses.
    """
    for stage in stages.values():
        if stage.kind in _RENDERERS:
            package, function = _RENDERERS[stage.kind]
            _require_function(stage, f"{package}.{stage.name}.{function}")
        if stage.kind in (Kind.FIGURE, Kind.EXTENSION):
            if stage.name not in DRAWINGS:
                raise ConfigurationError(
                    f"{stage.name}: no drawing in DRAWINGS of src/bouncing_ball/figures/__init__.py"
                )
            _require_function(stage, f"figures.{DRAWINGS[stage.name]}")
        if stage.tabulated:
            _require_function(stage, f"figures.tables.{stage.name}.rows")
        if stage.study:
            study = _require_function(stage, stage.study)
            _require_keys(stage, run)
            _require_datasets(stage, stages)
            if study:
                _require_arguments(stage, study)
    used = {stage.section for stage in stages.values()}
    for section in _sections(run):
        if section not in used:
            raise ConfigurationError(
                f"{section} has no entry in src/bouncing_ball/configuration/stages.py"
            )


def _require_keys(stage: Stage, run: Mapping[str, Any]) -> None:
    try:
        stage.parameters(run)
    except KeyError:
        raise ConfigurationError(
            f"{stage.name}: no section {stage.section} in config/config.yaml"
        ) from None
    try:
        stage.settings(run)
    except KeyError as error:
        raise ConfigurationError(f"{stage.name}: unknown setting {error.args[0]}") from None


def _require_datasets(stage: Stage, stages: Mapping[str, Stage]) -> None:
    for name in stage.reads:
        if name not in stages or not stages[name].study:
            raise ConfigurationError(f"{stage.name}: it reads an unknown dataset {name}")


def _sections(run: Mapping[str, Any]) -> Iterable[str]:
    return (f"{part}.{name}" for part in SECTIONS for name in run.get(part, {}))

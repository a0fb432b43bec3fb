"""The ledger of claims from its file, checked, and what the rules need of it."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from bouncing_ball.audit.claims.ledger import parse_ledger, printed_table
from bouncing_ball.configuration.check import check_schema
from bouncing_ball.configuration.yaml_file import ConfigurationError, read_yaml
from bouncing_ball.errors import ModelError


def read_ledger(folder: str | Path) -> dict[str, Any]:
    """The mapping of ``claims.yaml`` in a folder, checked against its schema.

    Raises
    ------
    ConfigurationError
        One line for the first mistake.
    """
    names = ("claims.yaml", "claims.schema.yaml")
    mapping, schema = (read_yaml(Path(folder, name)) for name in names)
    check_schema(mapping, schema)
    try:
        parse_ledger(mapping)
    except ModelError as error:
        raise ConfigurationError(str(error)) from error
    return mapping


def check_datasets(mapping: Mapping[str, Any], made: Iterable[str]) -> None:
    """Raise if a ledger needs a dataset that the pipeline does not make.

    Raises
    ------
    ConfigurationError
        One line for the first one.
    """
    made = sorted(made)
    asked = {name.partition(".")[0] for name in mapping["parameters"]} - {"every"}
    named = [*datasets_of(mapping), *sorted(asked)]
    for name in named:
        if name not in made:
            raise ConfigurationError(f"there is no dataset {name}, only {', '.join(made)}")


def datasets_of(mapping: Mapping[str, Any]) -> list[str]:
    """Names of the datasets that a ledger is decided by, sorted."""
    ledger = parse_ledger(mapping)
    used = [part.uses for part in ledger.claims] + [part.uses for part in ledger.explanations]
    return sorted({name for names in used for name in names})


def printed(mapping: Mapping[str, Any], name: str) -> dict[str, Any]:
    """A printed table of the ledger by its id, as numbers.

    Raises
    ------
    ConfigurationError
        If the ledger has no such table.
    """
    for entry in mapping["claims"]:
        if entry["id"] == name and entry["kind"] == "table":
            return printed_table(entry)
    raise ConfigurationError(f"there is no table {name!r} among the claims")

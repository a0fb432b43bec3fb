"""The ledger of claims from its file, checked, and what the rules need of it."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import yaml

from bouncing_ball.claims.ledger import parse_ledger, printed_table
from bouncing_ball.pipeline.configuration import ConfigurationError, check_schema


def read_ledger(folder: str | Path) -> dict[str, Any]:
    """The mapping of ``claims.yaml`` in a folder, checked against its schema.

    Raises
    ------
    ConfigurationError
        One line for the first mistake.
    """
    mapping, schema = (
        yaml.safe_load(Path(folder, name).read_text(encoding="utf-8"))
        for name in ("claims.yaml", "claims.schema.yaml")
    )
    check_schema(mapping, schema)
    try:
        parse_ledger(mapping)
    except ValueError as error:
        raise ConfigurationError(str(error)) from error
    return mapping


def datasets_of(mapping: Mapping[str, Any]) -> list[str]:
    """Names of the datasets that a ledger is decided by, sorted."""
    ledger = parse_ledger(mapping)
    parts = [*ledger.claims, *ledger.explanations]
    return sorted({name for part in parts for name in part.uses})


def printed(mapping: Mapping[str, Any], name: str) -> dict[str, Any]:
    """A printed table of the ledger by its id, as numbers."""
    return printed_table(next(entry for entry in mapping["claims"] if entry["id"] == name))

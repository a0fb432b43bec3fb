"""Everything that was found, as JSON."""

import json
import math
from collections.abc import Mapping
from dataclasses import asdict, replace
from typing import Any

from bouncing_ball.compare.data import VariableResult
from bouncing_ball.compare.folders import Artifact, Comparison
from bouncing_ball.compare.outcome import status
from bouncing_ball.compare.parts import Part
from bouncing_ball.record.provenance import Provenance, made_otherwise, read_mapping
from bouncing_ball.record.reading import printable


def _plain(value: Any) -> Any:
    """As JSON can hold it: it knows no infinity, and UTF-8 no half of a pair."""
    if isinstance(value, Mapping):
        return {printable(key): _plain(each) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(each) for each in value]
    if isinstance(value, str):
        return printable(value, width=None)
    return str(value) if isinstance(value, float) and not math.isfinite(value) else value


def _variable(result: VariableResult) -> dict[str, Any]:
    largest = [] if result.trace is None else [asdict(each) for each in result.trace.largest]
    found = asdict(replace(result, trace=None)) | {"largest": largest}
    del found["trace"]
    return found


def _made(record: Provenance | None, new: Provenance | None) -> dict[str, Any]:
    """Commits, versions, and what else the two sides were made from that differs."""
    sides = {"record": record, "new": new}
    found: dict[str, Any] = {
        name: {"commit": side.commit, "dirty": side.dirty, "versions": read_mapping(side.versions)}
        for name, side in sides.items()
        if side is not None
    }
    return found | {"otherwise": made_otherwise(record, new) if record and new else []}


def _part(part: Part) -> dict[str, Any]:
    found: dict[str, Any] = {
        "file": part.file,
        "outcome": part.outcome,
        "decides": part.decides,
        "share": part.share,
        "note": part.note,
    }
    if part.picture is not None:
        found["rms"] = part.picture.rms
        found["changed_pixels"] = part.picture.changed
    if any(part.made):
        found["made"] = _made(*part.made)
    if part.variables:
        found["variables"] = [_variable(result) for result in part.variables]
    if part.lines:
        found["lines"] = [asdict(line) for line in part.lines]
    return found


def _artifact(artifact: Artifact) -> dict[str, Any]:
    return {
        "name": artifact.name,
        "outcome": artifact.outcome,
        "share": artifact.share,
        "parts": [_part(part) for part in artifact.parts],
    }


def to_json(comparison: Comparison) -> str:
    """One object: exit status, outcome, and the artifacts, worst first.

    Numbers that are infinite are the text "inf".

    Examples
    --------
    >>> print(to_json(Comparison(())), end="")
    {
      "status": 0,
      "outcome": "identical",
      "artifacts": []
    }
    """
    content = {
        "status": status(comparison.outcome),
        "outcome": comparison.outcome,
        "artifacts": [_artifact(artifact) for artifact in comparison.artifacts],
    }
    return json.dumps(_plain(content), ensure_ascii=False, indent=2, allow_nan=False) + "\n"

"""Everything that was found, as JSON."""

import json
import math
from dataclasses import asdict
from typing import Any

from bouncing_ball.record.diff.data import VariableResult
from bouncing_ball.record.diff.folders import Artifact, Comparison
from bouncing_ball.record.diff.outcome import status
from bouncing_ball.record.diff.parts import Part


def _number(value: float | None) -> float | str | None:
    """JSON knows no infinity."""
    return value if value is None or math.isfinite(value) else str(value)


def _variable(result: VariableResult) -> dict[str, Any]:
    return {
        name: _number(value) if isinstance(value, float) else value
        for name, value in asdict(result).items()
    }


def _part(part: Part) -> dict[str, Any]:
    found = {
        "file": part.file,
        "outcome": part.outcome,
        "decides": part.decides,
        "share": _number(part.share),
        "note": part.note,
    }
    if part.picture is not None:
        found["rms"] = part.picture.rms
    if part.variables:
        found["variables"] = [_variable(result) for result in part.variables]
    return found


def _artifact(artifact: Artifact) -> dict[str, Any]:
    return {
        "name": artifact.name,
        "outcome": artifact.outcome,
        "share": _number(artifact.share),
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
    return json.dumps(content, ensure_ascii=False, indent=2, allow_nan=False) + "\n"

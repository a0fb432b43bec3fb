"""Whether the accepted samples in ``config`` are older than the code that computes them.

A sample is a dataset that a run reads and does not make. It records the files that computed it with
digests of their code, without comments and docstrings (:func:`.sources.computation`): the modules
that its study imports, but for texts, names and pictures; for what physics engines gave, the files
that ran the engines. If one of these files computes something else today, the sample has to be made
again.
"""

import os
from collections.abc import Iterable
from pathlib import Path

from bouncing_ball.errors import ModelError
from bouncing_ball.pipeline.provenance import PREFIX, read_attributes
from bouncing_ball.pipeline.sources import changed_since, computation

COMPUTATION = f"{PREFIX}computation"
"""The attribute with the lines of :func:`.sources.computation`."""

SECONDS = f"{PREFIX}seconds"
"""The attribute with the processor time that a sample took, or one of its shards."""

# More files than these are counted.
_NAMED = 4


def computed_by(paths: Iterable[Path]) -> dict[str, str]:
    """The attribute of a sample that these files compute."""
    return {COMPUTATION: computation(paths)}


def seconds_since(start: float = 0.0) -> dict[str, str]:
    """The attribute with the processor time of this process and of those that it has started and
    awaited, from a time of :func:`processor_time` on.
    """
    return {SECONDS: f"{processor_time() - start:.0f}"}


def processor_time() -> float:
    """The processor time of this process and of those that it has started and awaited, in s."""
    return sum(os.times()[:4])


def why_outdated(sample: Path) -> str:
    """What has changed since a sample was made, in one line; empty if nothing has.

    Raises
    ------
    ModelError
        If the file cannot be read.
    """
    recorded = str(read_attributes(sample).get(COMPUTATION, ""))
    if not recorded:
        return "it does not record the code that computed it"
    changed = changed_since(recorded)
    if not changed:
        return ""
    more = len(changed) - _NAMED
    rest = f" and {more} more" if more > 0 else ""
    return f"older than {', '.join(changed[:_NAMED])}{rest}"


def outdated(checkout: Path) -> dict[str, str]:
    """The samples of a checkout that are older than their code, each with the reason."""
    found = {}
    for sample in sorted((checkout / "config").glob("*.nc")):
        try:
            why = why_outdated(sample)
        except ModelError as error:
            why = str(error)
        if why:
            found[sample.name] = why
    return found

"""Whether results are what the commit checked out makes, by what the files say.

Every file is the one that its job wrote, by the checksum in the job's log; and
the job had the script, modules, parameters, lock file and inputs that the
workflow would give it now, by the checksums in the file itself, or in the log
of a text. Inputs are known by their content: so a dataset changed together with
the checksum in its log is found by what was made from it. No time of a file
counts.

What is changed together with its log and all that is made from it passes here. A
picture, a table or a page is found by making it once more
(:mod:`bouncing_ball.pipeline.again`); of a dataset, or the article, with its log only
making everything again tells, ``make clean all diff``, as continuous integration
does with each commit.
"""

import json
import re
from collections.abc import Mapping, Sequence
from pathlib import Path

from bouncing_ball.errors import ModelError
from bouncing_ball.record.job_log import read_log
from bouncing_ball.record.provenance import (
    LIBRARIES,
    LOCK,
    Provenance,
    ProvenanceError,
    file_digest,
    flattened,
    made_otherwise,
    read_mapping,
)
from bouncing_ball.record.recipe import Recipe, Run, gather, recorded

# More than these are made again all together.
_NAMED = 4


class RefusedError(ModelError):
    """Results that must not become the record, with the reason why."""


def pins(lock: str) -> dict[str, set[str]]:
    """The versions that a lock file asks for, by the names of the packages.

    Several, where they depend on the system.

    Examples
    --------
    >>> lock = ["numpy==2.4.1 ; sys_platform == 'linux'", "    --hash=sha256:1f0e", "scipy==1.17.0"]
    >>> pins("\\n".join(lock))
    {'numpy': {'2.4.1'}, 'scipy': {'1.17.0'}}
    """
    found: dict[str, set[str]] = {}
    for name, version in re.findall(r"^([\w.-]+)==([^\s;\\]+)", lock, re.MULTILINE):
        found.setdefault(name.lower(), set()).add(version)
    return found


def check_versions(made: Mapping[str, Provenance], lock: str) -> None:
    """Raise :class:`RefusedError` if a result was made with versions that are not locked."""
    pinned = pins(lock)
    for name, provenance in made.items():
        versions = json.loads(provenance.versions)
        for library in LIBRARIES:
            wanted, used = pinned.get(library.lower(), set()), versions.get(library)
            if used not in wanted:
                locked = " or ".join(sorted(wanted)) or "none"
                raise RefusedError(
                    f"{name} made with {library} {used}, {LOCK} has {locked}: make setup, then "
                    "snakemake --cores 2 --forceall"
                )


def differences(made: Provenance, now: Provenance) -> list[str]:
    """What a file was made from, where that is not what it would be made from now.

    Commits may differ: a commit that changes nothing of what a file is made from
    leaves it up to date.
    """
    found = []
    if made.dirty != "no":
        found.append("the tree was dirty" if made.dirty == "yes" else "the commit is unknown")
    if changed := flattened(read_mapping(made.configuration)):
        found.append(f"configuration with another {', '.join(sorted(changed))}")
    return found + made_otherwise(made, now)


def _objections(recipe: Recipe, run: Run) -> tuple[Provenance | None, list[str]]:
    """What the files of a job say of where they come from, and the objections."""
    sums = read_log(Path(recipe.log)).sums
    changed = [file for file in recipe.outputs if sums.get(file) != file_digest(file)]
    if changed:
        # Not opened: a damaged file can keep its library busy for ever.
        return None, [f"{Path(file).name} is not what its job wrote" for file in changed]
    made, *others = recorded(recipe)
    if any(other != made for other in others):
        return made, ["its files are of different jobs"]
    found = differences(made, gather(recipe, run))
    return made, [f"made from other than this commit makes it from: {', '.join(found)}"][
        : len(found)
    ]


def _again(targets: Sequence[str]) -> str:
    what = f"--force {' '.join(targets)}" if len(targets) <= _NAMED else "--forceall"
    return f"make again: snakemake --cores 2 {what}"


def check_made(recipes: Sequence[Recipe], run: Run) -> dict[str, Provenance]:
    """The provenance of every result, by path, if they are what the commit makes.

    Raises
    ------
    RefusedError
        If a file is missing, is not what its job wrote, or was made from other
        than it would be made from now; with what differs, and the command that
        makes it again.
    """
    proven: dict[str, Provenance] = {}
    refused: dict[str, str] = {}
    for recipe in recipes:
        try:
            made, found = _objections(recipe, run)
        except FileNotFoundError as error:
            made, found = None, [f"no file {error.filename}"]
        except (ProvenanceError, OSError) as error:
            made, found = None, [str(error)]
        if made and not found:
            proven |= dict.fromkeys(recipe.outputs, made)
        else:
            refused[recipe.target] = ", ".join(found)
    if refused:
        first, why = next(iter(refused.items()))
        more = f"; and {len(refused) - 1} more" if len(refused) > 1 else ""
        raise RefusedError(f"{first}: {why}{more}; {_again(list(refused))}")
    return proven

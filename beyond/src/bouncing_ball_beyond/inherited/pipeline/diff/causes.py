"""Why an artifact differs from the record, as far as the two files and the repository say it.

Every dataset has the parameters among its attributes, and every dataset and picture its provenance:
the digests of the code that made it, the versions of the libraries, and the files it was made from.
A parameter that changed is the cause by itself. Otherwise the causes are other inputs, other code,
and other versions of the libraries that compute and draw. Of code, the files are named that the
present change touches, which are not committed or not in the main branch, and the others counted
that differ since the record was made. If the present change touches none, the others are named; if
these are many, the age of the record says more than their names.
"""

import os
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import Any

from bouncing_ball_beyond.inherited.pipeline.diff.datasets import attribute_rows
from bouncing_ball_beyond.inherited.pipeline.diff.outcome import Outcome
from bouncing_ball_beyond.inherited.pipeline.diff.texts import some
from bouncing_ball_beyond.inherited.pipeline.provenance import git
from bouncing_ball_beyond.inherited.pipeline.sources import REPOSITORY, changed_files

_LIBRARIES = ("numpy", "scipy", "matplotlib")
_MAIN = ("origin/HEAD", "origin/main", "main", "master")
# Of more files of code none is named, unless the present change touches it.
_FILES = 10


def touched_files() -> frozenset[str]:
    """The files of the repository that the present change touches, by their names."""
    if not (REPOSITORY / ".git").exists():
        return frozenset()
    bases = (git(REPOSITORY, "merge-base", "HEAD", branch) for branch in _MAIN)
    base = next(filter(None, bases), "HEAD").strip()
    changed = git(REPOSITORY, "diff", "--name-only", "-z", base) or ""
    new = git(REPOSITORY, "ls-files", "--others", "--exclude-standard", "-z") or ""
    return frozenset(f"{changed}{new}".split("\0"))


def code_in_place_of(configuration: Collection[Path]) -> str:
    """A line on the code that the present change touches, if it touches none of the files of a
    configuration, whose values a change of the code may have made impossible; otherwise nothing.
    """
    touched = touched_files()
    files = {os.path.relpath(path, REPOSITORY) for path in configuration}
    code = sorted(file for file in touched if "/src/" in f"/{file}")
    if not code or files & touched:
        return ""
    return f"The configuration has not changed, but code has: {some(code)}\n"


def suspects(made: Sequence[Mapping[str, Any]], touched: Collection[str]) -> list[str]:
    """The files of code that made an artifact and differ, if its parameters do not: those of the
    present change, or if there are none all of a few.

    ``made`` is the provenance in the record and the new one.

    Examples
    --------
    >>> made = [{"code": f"{digest} a.py\\n{digest} b.py"} for digest in ("1f0e", "2a2a")]
    >>> suspects(made, {"b.py", "c.py"}), suspects(made, {"c.py"})
    (['b.py'], ['a.py', 'b.py'])
    """
    if made[0].get("parameters") != made[1].get("parameters"):
        return []
    files = changed_files(*(side.get("code", "") for side in made))
    of_change = [file for file in files if file in touched]
    return of_change or (files if len(files) <= _FILES else [])


def causes(
    made: Sequence[Mapping[str, Any]], code: Sequence[str], inputs: Sequence[str]
) -> list[str]:
    """The causes of a difference, the most important one first.

    Parameters
    ----------
    made : sequence of mapping
        The provenance in the record and the new one.
    code : sequence of str
        The :func:`suspects` among the files of code.
    inputs : sequence of str
        The artifacts from whose datasets it is made, and which differ.

    Examples
    --------
    >>> made = [{"versions": {"numpy": number}} for number in ("2.2.0", "2.3.1")]
    >>> causes(made, [], ["fig14"])
    ['made from fig14', 'other numpy, 2.2.0 → 2.3.1']
    """
    parameters = [side.get("parameters", {}) for side in made]
    if changed := attribute_rows(parameters, Outcome.PARAMETERS):
        told = ", ".join(row.told for row in changed)
        return [f"parameter{'s' if len(changed) > 1 else ''} changed, {told}"]
    found = [f"made from {some(inputs)}"] if inputs else []
    files = changed_files(*(side.get("code", "") for side in made))
    others = len(files) - len(code)
    if code:
        since = f", and {others} more since the record" if others else ""
        found.append(f"changed code, {some(code)}{since}")
    elif files and not inputs:
        since = f"{made[0].get('commit')}..HEAD"
        age = git(REPOSITORY, "rev-list", "--count", "--end-of-options", since) or "many"
        record = f"the record, which is {age.strip()} commits old"
        found.append(f"changed code, {len(files)} files since {record}")
    for name in _LIBRARIES:
        old, now = (side.get("versions", {}).get(name) for side in made)
        if old and now and old != now:
            found.append(f"other {name}, {old} → {now}")
    return found

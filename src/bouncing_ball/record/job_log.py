"""What the log of a job says of the files that the job wrote.

The last lines: a checksum of each file, and the provenance where no file
carries it, which is so for texts and tables.
"""

import json
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from bouncing_ball.record.provenance import Provenance, ProvenanceError, file_digest, read_mapping

_SUM = "sha256"
_MADE = "provenance"


@dataclass(frozen=True)
class JobLog:
    """Checksums by path, and the line with the provenance, if there is one."""

    path: Path
    sums: dict[str, str]
    made: str = ""

    def provenance(self) -> Provenance:
        """The provenance of what the job wrote.

        Raises
        ------
        ProvenanceError
            If the log holds none.
        """
        try:
            return Provenance.of(read_mapping(self.made))
        except ValueError:
            raise ProvenanceError(f"{self.path} holds no provenance") from None


def log_lines(outputs: Iterable[str], made: Provenance | None = None) -> list[str]:
    """The last lines of a job's log."""
    lines = [f"{_SUM} {file_digest(path)} {path}" for path in outputs]
    if made is not None:
        lines.append(f"{_MADE} {json.dumps(made.attributes())}")
    return lines


def read_log(path: Path) -> JobLog:
    """The last lines of a job's log, read; nothing where there is no log."""
    sums, made = {}, ""
    text = path.read_text(encoding="utf-8", errors="replace") if path.is_file() else ""
    for line in text.splitlines():
        start, _, rest = line.partition(" ")
        if start == _SUM:
            checksum, _, file = rest.partition(" ")
            sums[file] = checksum
        elif start == _MADE:
            made = rest
    return JobLog(path, sums, made)


def is_as_written(path: str, log: str | Path) -> bool:
    """Whether a file that is there has the checksum that the log of its job says."""
    return read_log(Path(log)).sums.get(path) == file_digest(path)

"""The frame of every job: a log, an error of one line, and a quick start.

Scripts of the workflow import this module before anything else. It imports nothing that takes time.
"""

import gc
import signal
import sys
import traceback
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from bouncing_ball.pipeline.run import CONCLUSION

if hasattr(sys.modules["__main__"], "snakemake"):
    # A job mostly imports, and ends soon: looking for garbage would take a sixth of its time.
    gc.disable()
    # For every dataset xarray checks whether its values are quantities of pint. The values of a job
    # are plain numbers, and importing pint takes longer than reading them.
    modules: dict[str, Any] = sys.modules
    modules.setdefault("pint", None)


def write(path: Path, text: str) -> None:
    """Write a text, completely or not at all."""
    from bouncing_ball.datasets.files import write_text

    write_text(path, text)


def conclude(sentence: str) -> None:
    """End the run with this sentence, which replaces an earlier one, see :mod:`.run`."""
    write(CONCLUSION, sentence)


@contextmanager
def logged(snakemake: Any) -> Iterator[list[str]]:
    """Collect lines for the log of the job; on failure print one line about the failure.

    The line begins with the name of the rule, and with the notes of the error, such as the artifact
    that was made. The traceback is then in the log, whose last line is the same, and the process
    exits with status 1.
    """
    # Ctrl-C ends the job at once. An exception could be raised while a netCDF file is locked, and
    # closing the file would then wait forever. Because files are written completely or not at all,
    # no file is damaged.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    lines: list[str] = []
    log = Path(snakemake.log[0])
    log.unlink(missing_ok=True)
    try:
        yield lines
        write(log, "".join(f"{line}\n" for line in lines))
        if snakemake.output:
            print("made", *snakemake.output, flush=True)
    except Exception as error:
        name = "/".join([snakemake.rule, *getattr(error, "__notes__", [])])
        kind = "" if isinstance(error, ValueError) else f"{type(error).__name__}: "
        message = f"{name}: {kind}{' '.join(str(error).split())}"
        # For example, writing the log fails if the disk is full.
        with suppress(OSError):
            write(log, f"{traceback.format_exc()}{message}\n")
        sys.exit(f"{message} (details in {log})")

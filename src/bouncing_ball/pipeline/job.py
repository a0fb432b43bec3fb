"""The adapter around a job: log, one-line errors, files.

Scripts of the workflow are three lines on top of this; ``snakemake`` is the
object that Snakemake gives them.
"""

import signal
import sys
import traceback
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from bouncing_ball.configuration.stages import load
from bouncing_ball.datasets.netcdf import parameter_attributes, read_dataset, write_dataset
from bouncing_ball.record.carriers import read_attributes
from bouncing_ball.record.provenance import PREFIX, SUM, Provenance, file_digest, gather

REFERENCE = (
    "Carbonelli, Perret-Liaudet, Rigaud and Feki, Investigation of restitution coefficient "
    "and spring-damper models for the bouncing ball problem, DETC2011-47870 (2011)"
)


@contextmanager
def logged(snakemake: Any) -> Iterator[list[str]]:
    """Collect lines for the job's log; on failure say in one line what failed.

    The log holds the traceback, the terminal the sentence.
    """
    # Ctrl-C ends the job at once. As an exception it can arrive while a netCDF
    # file is locked, whose closing then waits for ever; files are written whole
    # or not at all, so nothing is lost.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    name = "/".join([snakemake.rule, *snakemake.wildcards])
    lines: list[str] = []
    log = Path(snakemake.log[0])
    log.parent.mkdir(parents=True, exist_ok=True)
    try:
        yield lines
    except Exception as error:
        log.write_text(traceback.format_exc(), encoding="utf-8")
        kind = "" if isinstance(error, ValueError) else f"{type(error).__name__}: "
        sys.exit(f"{name}: {kind}{' '.join(str(error).split())} (details in {log})")
    # What a job wrote is known by its checksum, so that a file changed by hand is seen.
    written = [f"{SUM} {file_digest(path)} {path}" for path in snakemake.output]
    log.write_text("".join(f"{line}\n" for line in [*lines, *written]), encoding="utf-8")


def provenance(snakemake: Any, parameters: Mapping[str, Any]) -> Provenance:
    """The provenance of what the job writes, its inputs' parameters included."""
    attributes = [read_attributes(Path(path)) for path in snakemake.input if path[-3:] == ".nc"]
    name = PREFIX + "parameters"
    inherited = [data[name] for data in attributes if name in data]
    return gather(snakemake, parameters, inherited)


def make_dataset(snakemake: Any) -> None:
    """Run the study of the job and write its dataset.

    The parameters and the settings of the run become global attributes, unless
    the study says itself what is worth recording, and so does the provenance.
    """
    with logged(snakemake) as lines:
        job = snakemake.params
        data = {Path(path).stem: read_dataset(path) for path in snakemake.input.data}
        inputs = [data] if data else []
        dataset = load(job.study)(*inputs, job.parameters, *job.settings.values())
        dataset.attrs = {
            "title": job.title,
            "references": REFERENCE,
            **(dataset.attrs or parameter_attributes(job.parameters | job.settings)),
            **provenance(snakemake, {"parameters": job.parameters, **job.settings}).attributes(),
        }
        write_dataset(dataset, snakemake.output.data)
        sizes = ", ".join(f"{name} {size}" for name, size in dataset.sizes.items())
        lines.append(f"{snakemake.output.data}: {sizes}")
        if "end_reason" in dataset:
            lines += [str(reason) for reason in dataset.end_reason.values.ravel()]

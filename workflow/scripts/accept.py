"""Copy the results over the accepted record."""

import shutil
from pathlib import Path

from bouncing_ball.pipeline.job import logged

with logged(snakemake) as lines:
    record = Path(snakemake.params.record)
    wanted = {}
    for source in map(Path, snakemake.input):
        wanted[record / source.relative_to("results")] = source
    for target, source in wanted.items():
        target.parent.mkdir(exist_ok=True)
        shutil.copyfile(source, target)
        lines.append(f"{source} -> {target.name}")
    # What the pipeline no longer makes is no longer part of the record.
    kept = {path for path in (record / "figures").iterdir() if path.is_file()}
    for stale in kept - set(wanted):
        stale.unlink()
        lines.append(f"removed {stale.name}")

"""The replication article from its template and the datasets."""

from pathlib import Path

from jinja2 import Environment, StrictUndefined

from bouncing_ball.datasets.netcdf import read_dataset
from bouncing_ball.pipeline.files import write_text
from bouncing_ball.pipeline.job import logged

with logged(snakemake) as lines:
    environment = Environment(undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True)
    template = environment.from_string(Path(snakemake.input.template).read_text(encoding="utf-8"))
    data = {Path(path).stem: read_dataset(path) for path in snakemake.input.data}
    tables = {
        Path(path).stem: Path(path).read_text(encoding="utf-8") for path in snakemake.input.tables
    }
    write_text(snakemake.output.paper, template.render(data=data, tables=tables) + "\n")
    lines.append(snakemake.output.paper)

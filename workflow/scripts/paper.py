"""The replication article from its template and the datasets."""

from pathlib import Path

import numpy as np
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

    def at(dataset, variable, digits, **where):
        """One value of a dataset, at the coordinates given, as text."""
        labels = {k: v for k, v in where.items() if isinstance(v, str)}
        numbers = {k: v for k, v in where.items() if k not in labels}
        chosen = data[dataset][variable].sel(labels)
        chosen = chosen.sel(numbers, method="nearest", tolerance=1e-9) if numbers else chosen
        return f"{chosen.item():.{digits}f}"

    def largest(difference):
        """The largest absolute entry, as text."""
        return f"{np.abs(difference).max().item():.4f}"

    def percent(share):
        return f"{100 * share:g} %"

    text = template.render(data=data, tables=tables, at=at, largest=largest, percent=percent)
    write_text(snakemake.output.paper, text + "\n")
    lines.append(snakemake.output.paper)

"""The replication article from its templates and the datasets, and the tally."""

from pathlib import Path

from bouncing_ball.claims.tally import tally
from bouncing_ball.datasets.files import write_text
from bouncing_ball.datasets.netcdf import read_dataset
from bouncing_ball.figures.article.render import render_article
from bouncing_ball.figures.atlas.tables import shares
from bouncing_ball.figures.tables.formats import to_markdown
from bouncing_ball.figures.tables.rows import claims
from bouncing_ball.pipeline.job import logged, read_input


def text_of(path):
    return Path(path).read_text(encoding="utf-8")


with logged(snakemake) as lines:
    data = {Path(path).stem: read_input(path) for path in snakemake.input.data}
    tables = {Path(path).stem: text_of(path) for path in snakemake.input.tables}
    tables["claims"] = to_markdown(*claims(data["claims"]))
    data["atlas"] = read_dataset(snakemake.input.atlas)
    tables["atlas"] = to_markdown(*shares(data["atlas"]))
    folder = Path(snakemake.input.templates[0]).parent
    write_text(snakemake.output.paper, render_article(folder, data, tables))
    last = tally(data["claims"], snakemake.params.figures)
    write_text(snakemake.output.tally, last + "\n")
    lines.append(last)

"""The charts and tables of the atlas, from its summary."""

from pathlib import Path

from bouncing_ball.datasets.files import write_text
from bouncing_ball.figures.atlas.charts import charts
from bouncing_ball.figures.atlas.tables import shares, worst
from bouncing_ball.figures.files import save
from bouncing_ball.figures.style import style
from bouncing_ball.figures.tables.formats import to_markdown
from bouncing_ball.pipeline.job import logged, provenance, read_input

with logged(snakemake), style():
    (summary,) = snakemake.input.parts
    data = read_input(summary)
    metadata = provenance(snakemake).attributes()
    folder = Path(snakemake.output.shares).parent
    for name, figure in charts(data):
        save(figure, folder / f"{name}.png", metadata)
    write_text(snakemake.output.shares, to_markdown(*shares(data)))
    write_text(snakemake.output.worst, to_markdown(*worst(data)))

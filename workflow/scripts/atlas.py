"""The summary of the atlas, and its charts and tables."""

from pathlib import Path

from bouncing_ball.atlas.plan import Plan
from bouncing_ball.atlas.summary import summary
from bouncing_ball.datasets.netcdf import parameter_attributes
from bouncing_ball.figures.atlas.charts import charts
from bouncing_ball.figures.files import save
from bouncing_ball.figures.style import style
from bouncing_ball.pipeline.job import logged, provenance, publish, read_input

with logged(snakemake), style():
    parameters = snakemake.params.parameters
    (path,) = snakemake.input.parts
    data = summary(Plan(**parameters), read_input(path))
    publish(snakemake, data, parameter_attributes(parameters), compressed=True)
    metadata = provenance(snakemake)
    folder = Path(snakemake.output.data).parent
    for name, figure in charts(data):
        save(figure, folder / f"{name}.png", metadata)

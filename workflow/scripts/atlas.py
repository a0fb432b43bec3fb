"""The summary of the atlas, and its charts and tables."""

from pathlib import Path

from bouncing_ball.beyond.atlas.figures import charts
from bouncing_ball.beyond.atlas.plan import Plan
from bouncing_ball.beyond.atlas.summary import summary
from bouncing_ball.datasets.files import parameter_attributes
from bouncing_ball.drawing.files import save
from bouncing_ball.drawing.style import style
from bouncing_ball.pipeline.jobs import logged, provenance, publish, read_input

with logged(snakemake), style():
    parameters = snakemake.params.parameters
    (path,) = snakemake.input.parts
    data = summary(Plan(**parameters), read_input(path))
    publish(snakemake, data, parameter_attributes(parameters))
    metadata = provenance(snakemake)
    folder = Path(snakemake.output.data).parent
    for name, figure in charts(data):
        save(figure, folder / f"{name}.png", metadata)

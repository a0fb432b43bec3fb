"""One figure from its dataset."""

from bouncing_ball.configuration.study import load
from bouncing_ball.figures.files import save
from bouncing_ball.figures.style import style
from bouncing_ball.pipeline.job import logged, provenance, read_input

with logged(snakemake) as lines, style():
    draw = load(snakemake.params.drawing)
    data = map(read_input, snakemake.input.get("data", []))
    figure, metadata = draw(*data), provenance(snakemake)
    for path in snakemake.output:
        save(figure, path, metadata)
    lines += snakemake.output

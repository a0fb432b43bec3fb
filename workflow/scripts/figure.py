"""One figure from its dataset."""

from bouncing_ball.drawing.files import save
from bouncing_ball.drawing.style import style
from bouncing_ball.pipeline.configuration import load
from bouncing_ball.pipeline.jobs import logged, provenance, read_input

with logged(snakemake) as lines, style():
    draw = load(snakemake.params.drawing)
    data = map(read_input, snakemake.input.get("data", []))
    figure, metadata = draw(*data), provenance(snakemake)
    for path in snakemake.output:
        save(figure, path, metadata)
    lines += snakemake.output

"""One figure from its dataset."""

from adapter import function

from bouncing_ball.drawing.files import save
from bouncing_ball.drawing.style import style
from bouncing_ball.pipeline.jobs import logged, provenance, read_input, using

with logged(snakemake) as lines, style():
    draw = function(snakemake.params.figures, snakemake.params.drawing)
    paths = list(snakemake.input.data)
    data = [read_input(path) for path in paths]
    if paths:
        with using(*paths):
            figure = draw(*data)
    else:
        figure = draw()
    metadata = provenance(snakemake)
    for path in snakemake.output:
        save(figure, path, metadata)
    lines += snakemake.output

"""One figure from its dataset."""

from pathlib import Path

from bouncing_ball.figures import drawing
from bouncing_ball.figures.files import save_all
from bouncing_ball.figures.given import require_numbers
from bouncing_ball.figures.style import style
from bouncing_ball.pipeline.job import logged, provenance, read_input

with logged(snakemake) as lines, style():
    draw = drawing(Path(snakemake.output[0]).stem)
    data = [require_numbers(read_input(path), path) for path in snakemake.input.get("data", [])]
    save_all(draw(*data), snakemake.output, provenance(snakemake).attributes())
    lines += snakemake.output

"""One figure from its dataset."""

from importlib import import_module
from pathlib import Path

from bouncing_ball.figures.given import from_dataset
from bouncing_ball.figures.style import save_all, style
from bouncing_ball.pipeline.job import logged, provenance, read_input

with logged(snakemake) as lines, style():
    name = Path(snakemake.output[0]).stem
    draw = import_module(f"bouncing_ball.figures.{name}").draw
    paths = snakemake.input.get("data", [])
    figure = from_dataset(draw, read_input(paths[0]), paths[0]) if paths else draw()
    save_all(figure, snakemake.output, provenance(snakemake).attributes())
    lines += snakemake.output

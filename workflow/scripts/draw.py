"""Draw one figure from its dataset, if it has one."""

from bouncing_ball.datasets import commit, read
from bouncing_ball.drawing import save_picture
from bouncing_ball.figures import draw

given = snakemake.input.get("data")  # noqa: F821
datasets = [read(str(given))] if given else []
figure = draw(snakemake.wildcards.figure, *datasets)  # noqa: F821
save_picture(figure, snakemake.output.png, snakemake.output.svg, commit())  # noqa: F821

"""One table as CSV and Markdown from its dataset."""

from pathlib import Path

from bouncing_ball.datasets.files import write_text
from bouncing_ball.figures.tables import rows
from bouncing_ball.figures.tables.formats import texts
from bouncing_ball.pipeline.job import logged, read_input

with logged(snakemake) as lines:
    name = Path(snakemake.output[0]).stem
    data = read_input(snakemake.input.data)
    table = texts(*getattr(rows, name)(data))
    if head := snakemake.input.get("head"):
        # Only this table needs the packages of the article.
        from bouncing_ball.figures.article.render import render_article

        table[".md"] = f"{render_article(head[0], {name: data}, {})}\n{table['.md']}"
    for path in snakemake.output:
        write_text(path, table[Path(path).suffix])
    lines += snakemake.output

"""One table as CSV and Markdown from its dataset."""

from pathlib import Path

from bouncing_ball.datasets.files import write_text
from bouncing_ball.drawing.tables import texts
from bouncing_ball.pipeline.configuration import load
from bouncing_ball.pipeline.jobs import logged, read_input

with logged(snakemake) as lines:
    name = Path(snakemake.output[0]).stem
    data = read_input(snakemake.input.data)
    table = texts(*load(snakemake.params.table)(data))
    if head := snakemake.input.get("head"):
        # Only this table needs the packages of the article.
        from bouncing_ball.paper.claims.tables import Claims
        from bouncing_ball.pipeline.article import render_article

        words = render_article(head[0], {name: data}, {}, Claims(data))
        table[".md"] = f"{words}\n{table['.md']}"
    for path in snakemake.output:
        write_text(path, table[Path(path).suffix])
    lines += snakemake.output

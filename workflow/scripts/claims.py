"""The claims as CSV, in Markdown with words before the table, and their tally."""

from bouncing_ball.datasets.files import write_text
from bouncing_ball.drawing.tables import tables_by_suffix
from bouncing_ball.paper.claims.claims import tally
from bouncing_ball.paper.claims.tables import Claims, claims
from bouncing_ball.pipeline.article import render_article
from bouncing_ball.pipeline.jobs import logged, read_input

with logged(snakemake) as lines:
    data = read_input(snakemake.input.data)
    table = tables_by_suffix(*claims(data))
    words = render_article(snakemake.params.words, {"claims": data}, {}, Claims(data), {})
    write_text(snakemake.output.csv, table[".csv"])
    write_text(snakemake.output.md, f"{words}\n{table['.md']}")
    write_text(snakemake.output.tally, tally(data) + "\n")
    lines += [*snakemake.output, tally(data)]
    print(tally(data), flush=True)

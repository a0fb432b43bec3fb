"""The claims as CSV and in Markdown, with words before the table, and their tally."""

from bouncing_ball.datasets.files import write_text
from bouncing_ball.drawing.tables import to_csv, to_markdown
from bouncing_ball.paper.claims.claim_tables import Claims, claims
from bouncing_ball.paper.claims.claims import tally
from bouncing_ball.pipeline.article import render_article
from bouncing_ball.pipeline.job import logged, read_input

with logged(snakemake) as lines:
    data = read_input(snakemake.input.data)
    columns = claims(data)
    words = render_article(snakemake.params.words, {"claims": data}, {}, Claims(data), {})
    write_text(snakemake.output.csv, to_csv(*columns))
    write_text(snakemake.output.md, f"{words}\n{to_markdown(*columns)}")
    lines.append(tally(data))
    print(tally(data), flush=True)

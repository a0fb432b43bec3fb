"""The replication article as a PDF."""

from pathlib import Path

from bouncing_ball.datasets.files import replacing
from bouncing_ball.figures.article.pdf import article_pdf
from bouncing_ball.pipeline.job import logged

with logged(snakemake) as lines:
    paper = Path(snakemake.input.paper)
    pdf = article_pdf(paper.read_text(encoding="utf-8"), snakemake.input.template, paper.parent)
    with replacing(snakemake.output.pdf) as temporary:
        temporary.write_bytes(pdf)
    lines.append(f"{snakemake.output.pdf}: {len(pdf) / 1e6:.1f} MB")

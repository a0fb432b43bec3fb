"""The replication article and its supplement as PDFs."""

from pathlib import Path

from bouncing_ball.datasets.files import replacing
from bouncing_ball.pipeline.article import article_pdf
from bouncing_ball.pipeline.job import logged

with logged(snakemake) as lines:
    for name, output in zip(snakemake.input.texts, snakemake.output, strict=True):
        text = Path(name).read_text(encoding="utf-8")
        pdf = article_pdf(text, snakemake.params.template, Path(name).parent)
        with replacing(output) as temporary:
            temporary.write_bytes(pdf)
        lines.append(f"{output}: {len(pdf) / 1e6:.1f} MB")

"""Articles from templates: each text with the sections of those before it."""

from pathlib import Path

from bouncing_ball.datasets.files import write_text
from bouncing_ball.drawing.tables import to_markdown
from bouncing_ball.paper.claims import claim_tables as rows
from bouncing_ball.pipeline.article import render_article, sections_of
from bouncing_ball.pipeline.job import logged, read_input
from bouncing_ball.pipeline.yaml_files import read_yaml


def text_of(path):
    return Path(path).read_text(encoding="utf-8")


with logged(snakemake) as lines:
    data = {Path(path).stem: read_input(path) for path in snakemake.input.data}
    tables = {Path(path).stem: text_of(path) for path in snakemake.input.tables}
    # Its page begins with words, which the supplement has already.
    tables["claims"] = to_markdown(*rows.claims(data["claims"]))
    claims = rows.Claims(data["claims"])
    about = read_yaml(snakemake.input.citation)
    sections: dict[str, str] = {}
    for template, path in zip(snakemake.params.templates, snakemake.output, strict=True):
        text = render_article(
            template,
            data,
            tables,
            claims,
            snakemake.params.artifacts,
            about=about,
            sections=sections,
            shared=snakemake.params.shared,
        )
        write_text(path, text)
        sections = sections_of(text)
        lines.append(path)

"""The replication article, its supplement, and the tally."""

from pathlib import Path

from bouncing_ball.datasets.files import write_text
from bouncing_ball.drawing.tables import to_markdown
from bouncing_ball.paper.claims import tables as rows
from bouncing_ball.paper.claims.claims import tally
from bouncing_ball.pipeline.article import render_article, sections_of
from bouncing_ball.pipeline.jobs import logged, read_input
from bouncing_ball.pipeline.yaml_files import read_yaml

# The templates, and the names of the texts. The supplement is the first, because the article refers
# to its sections.
ARTICLES = {"supplement": "supplement", "article": "paper"}


def text_of(path):
    return Path(path).read_text(encoding="utf-8")


with logged(snakemake) as lines:
    data = {Path(path).stem: read_input(path) for path in snakemake.input.data}
    tables = {Path(path).stem: text_of(path) for path in snakemake.input.tables}
    # Its page begins with words, which the supplement has already.
    tables["claims"] = to_markdown(*rows.claims(data["claims"]))
    claims = rows.Claims(data["claims"])
    artifacts = snakemake.params.artifacts
    about = read_yaml(snakemake.input.citation)
    sections: dict[str, str] = {}
    for template, path in ARTICLES.items():
        file = Path(snakemake.params.templates, f"{template}.md.j2")
        text = render_article(file, data, tables, claims, artifacts, about=about, sections=sections)
        write_text(snakemake.output[path], text)
        if template == "supplement":
            sections = sections_of(text)
    last = tally(data["claims"])
    write_text(snakemake.output.tally, last + "\n")
    lines.append(last)

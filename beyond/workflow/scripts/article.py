"""The article from its templates and datasets."""

from pathlib import Path

from bouncing_ball_beyond.inherited.datasets.files import write_text
from bouncing_ball_beyond.inherited.pipeline.article import render_article
from bouncing_ball_beyond.inherited.pipeline.job import logged, read_input
from bouncing_ball_beyond.inherited.pipeline.yaml_files import read_yaml

with logged(snakemake) as lines:
    data = {Path(path).stem: read_input(path) for path in snakemake.input.data}
    data["replicated"] = read_yaml(snakemake.input.replicated)
    (path,) = snakemake.output
    text = render_article(
        snakemake.params.template,
        data,
        {},
        snakemake.params.artifacts,
        about=read_yaml(snakemake.input.citation),
        shared=snakemake.params.shared,
    )
    write_text(path, text)
    lines.append(path)

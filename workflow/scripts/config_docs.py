"""The page about the configuration, and its JSON schema for editors."""

from pathlib import Path

from bouncing_ball.datasets.files import write_text
from bouncing_ball.paper.configuration import Configuration
from bouncing_ball.pipeline.configuration_docs import configuration_page, configuration_schema
from bouncing_ball.pipeline.job import logged
from bouncing_ball.pipeline.yaml_files import read_yaml

with logged(snakemake):
    folder = Path(snakemake.scriptdir).resolve().parents[1] / "config"
    page = configuration_page(Configuration, read_yaml(folder / "config.yaml"))
    write_text(folder / "README.md", page)
    write_text(folder / "schema.json", configuration_schema(Configuration))

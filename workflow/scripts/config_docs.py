"""The page about the configuration, and its JSON schema for editors."""

from pathlib import Path

from whole_configuration import configuration_type

from bouncing_ball.datasets.files import write_text
from bouncing_ball.pipeline.configuration_docs import configuration_page, configuration_schema
from bouncing_ball.pipeline.jobs import logged
from bouncing_ball.pipeline.yaml_files import read_yaml

with logged(snakemake):
    folder = Path(snakemake.scriptdir).resolve().parents[1] / "config"
    model = configuration_type(snakemake.params.artifacts)
    page = configuration_page(model, read_yaml(folder / "config.yaml"))
    write_text(folder / "README.md", page)
    write_text(folder / "schema.json", configuration_schema(model))

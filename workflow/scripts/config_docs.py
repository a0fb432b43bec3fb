"""The page about the configuration and its JSON schema for editors."""

from pathlib import Path

from whole_configuration import configuration_type

from bouncing_ball.datasets.files import write_text
from bouncing_ball.pipeline.configuration import read_yaml
from bouncing_ball.pipeline.configuration_docs import configuration_page, configuration_schema
from bouncing_ball.pipeline.jobs import logged

with logged(snakemake):
    folder = Path(snakemake.scriptdir).resolve().parents[1] / "config"
    config = read_yaml(folder / "config.yaml")
    model = configuration_type(snakemake.params.artifacts)
    write_text(folder / "README.md", configuration_page(model, config))
    write_text(folder / "schema.json", configuration_schema(model))

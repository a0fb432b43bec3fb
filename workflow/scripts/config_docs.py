"""The page about the configuration and its JSON schema for editors."""

from pathlib import Path

from bouncing_ball.configuration.check import configuration_model
from bouncing_ball.configuration.documentation import configuration_page, configuration_schema
from bouncing_ball.configuration.yaml_file import read_yaml
from bouncing_ball.datasets.files import write_text
from bouncing_ball.pipeline.job import logged

with logged(snakemake):
    folder = Path(snakemake.scriptdir).resolve().parents[1] / "config"
    config = read_yaml(folder / "config.yaml")
    model = configuration_model(snakemake.params.studies, config)
    write_text(folder / "README.md", configuration_page(model, config))
    write_text(folder / "schema.json", configuration_schema(model))

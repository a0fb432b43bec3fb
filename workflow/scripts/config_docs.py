"""The pages about the configuration and about the datasets, and the JSON schema for editors."""

from pathlib import Path

from whole_configuration import configuration_type

from bouncing_ball.datasets.files import read_dataset, write_text
from bouncing_ball.pipeline.configuration_docs import configuration_page, configuration_schema
from bouncing_ball.pipeline.dataset_docs import dictionary, in_record
from bouncing_ball.pipeline.jobs import logged
from bouncing_ball.pipeline.yaml_files import read_yaml

with logged(snakemake):
    repository = Path(snakemake.scriptdir).resolve().parents[1]
    folder = repository / "config"
    config = read_yaml(folder / "config.yaml")
    model = configuration_type(snakemake.params.artifacts)
    write_text(folder / "README.md", configuration_page(model, config))
    write_text(folder / "schema.json", configuration_schema(model))
    artifacts = snakemake.params.artifacts
    accepted = {
        each.name: repository / in_record(each.dataset) for each in artifacts if each.dataset
    }
    datasets = {name: read_dataset(path) for name, path in accepted.items() if path.is_file()}
    write_text(repository / "docs" / "variables.md", dictionary(artifacts, datasets))

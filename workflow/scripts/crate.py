"""The results as an RO-Crate."""

import json
from pathlib import Path

from bouncing_ball.configuration.yaml_file import read_yaml
from bouncing_ball.datasets.files import write_text
from bouncing_ball.pipeline.job import logged
from bouncing_ball.record.crate import NAME, crate
from bouncing_ball.record.revision import commit_date

with logged(snakemake) as lines:
    repository = Path(snakemake.params.record).resolve()
    citation = read_yaml(repository / "CITATION.cff")
    about = {
        "name": citation["title"],
        "description": "Datasets, figures, tables and text of the replication, and what made them",
        "license": f"https://spdx.org/licenses/{citation['license']}",
        "datePublished": commit_date(repository),
    }
    found = crate(snakemake.params.recipes, about)
    text = json.dumps(found, indent=1, ensure_ascii=False) + "\n"
    write_text(Path("results", NAME), text)
    lines.append(f"results/{NAME}: {len(found['@graph'])} entities")

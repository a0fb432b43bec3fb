"""The article, its appendices and the list of figures, from all datasets."""

import sys
from pathlib import Path

from paper_replication.provenance import reading

sys.stderr = open(snakemake.log[0], "w", encoding="utf-8")
with reading(snakemake.input) as sources:
    from project import PROJECT

    from paper_replication.datasets import read, save_record
    from studies.article import filled_in

    datasets = {Path(path).stem: read(path) for path in snakemake.input.data}
    for name in ("article", "appendix", "phase", "laid", "figures"):
        text = filled_in(name, datasets)
        Path(snakemake.output[name]).write_text(text, encoding="utf-8", newline="\n")
    save_record(snakemake, sources, PROJECT)

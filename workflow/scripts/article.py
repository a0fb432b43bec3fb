"""The article, its supplement, the list of figures and the pages of all results."""

import sys
from pathlib import Path

from paper_replication.provenance import reading

sys.stderr = open(snakemake.log[0], "w", encoding="utf-8")
with reading(snakemake.input) as sources:
    from project import PROJECT

    from carbonelli2011.index import pages
    from paper_replication.datasets import read, save_record

    results = Path(snakemake.output.index).parent
    datasets = {Path(path).stem: read(path) for path in snakemake.input.data}
    try:
        texts = pages(datasets, snakemake.params.entries)
    except (ValueError, LookupError) as error:
        # Of a template, the note is its line.
        if not (notes := getattr(error, "__notes__", [])):
            raise
        why = "the sentence is for other results: correct it, or PARAMETERS of paper.py"
        sys.exit(f"{': '.join(notes)}: {error}: {why}")
    for name, text in texts.items():
        (results / name).write_text(text, encoding="utf-8", newline="\n")
    save_record(snakemake, sources, PROJECT)

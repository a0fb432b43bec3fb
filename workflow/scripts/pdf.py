"""Draw a figure as PDF, with settings of one's own."""

import sys
from pathlib import Path

import yaml

from paper_replication.provenance import reading

sys.stderr = open(snakemake.log[0], "w", encoding="utf-8")
with reading(snakemake.input):
    from carbonelli2011.figures import Empty, draw
    from paper_replication.datasets import read
    from paper_replication.drawing import save_pdf

    file = snakemake.input.style
    try:
        # A style file is YAML.
        own = yaml.safe_load(Path(file).read_text("utf-8")) if file else {}
        shown = [read(path) for path in snakemake.input.data]
        save_pdf(draw(snakemake.wildcards.name, *shown, own=own), snakemake.output.pdf, own)
    except Empty as error:
        sys.exit(f"configuration: {error}")
    except (KeyError, ValueError, yaml.YAMLError) as error:
        words = " ".join(str(error).strip('"').split())
        sys.exit(f"configuration: {file}: {words}")

"""Draw a figure from its dataset, if it has one."""

import sys
from pathlib import Path

from paper_replication.provenance import reading

sys.stderr = open(snakemake.log[0], "w", encoding="utf-8")
with reading(snakemake.input) as sources:
    from project import PROJECT

    from carbonelli2011.curves import SALT
    from carbonelli2011.figures import Empty, draw, moving
    from paper_replication.datasets import read, save_record
    from paper_replication.drawing import save_picture

    shown = [read(path) for path in snakemake.input.data]
    png = snakemake.output.png
    name = Path(png).stem
    try:
        figure = draw(name, *shown)
    except Empty as error:
        sys.exit(f"configuration: {error}")
    save_picture(figure, png, snakemake.output.svg, SALT, moving(name, *shown))
    save_record(snakemake, sources, PROJECT)

"""Draw a figure from its dataset."""

import sys
from pathlib import Path

from paper_replication.provenance import reading

sys.stderr = open(snakemake.log[0], "w", encoding="utf-8")
with reading(snakemake.input) as sources:
    from project import PROJECT

    from carbonelli2011.curves import SALT
    from paper_replication.datasets import read, save_record
    from paper_replication.drawing import save_picture
    from studies.figures import draw

    data = snakemake.input.data
    picture = draw(Path(data).stem, read(data))
    save_picture(picture, snakemake.output.png, snakemake.output.svg, SALT)
    save_record(snakemake, sources, PROJECT)

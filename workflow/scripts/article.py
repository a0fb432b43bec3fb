"""The article, its supplement, the list of figures and the page of all results."""

import sys
from pathlib import Path

from bouncing_ball import article, pages
from bouncing_ball.datasets import read

sys.stderr = open(snakemake.log[0], "w", encoding="utf-8")
datasets = {Path(path).stem: read(path) for path in snakemake.input.data}
entries = snakemake.params.entries
captions = {name: entry["caption"] for name, entry in entries.items() if "caption" in entry}
texts = {
    "paper": article.written("paper", datasets),
    "supplement": article.written("supplement", datasets),
    "figures": pages.filled_in("md", datasets, entries),
    "index": pages.filled_in("html", datasets, entries),
}
for name in ("paper", "supplement"):
    texts[f"{name}_page"] = pages.page_of(texts[name], name, captions)
for name, text in texts.items():
    Path(snakemake.output[name]).write_text(text, encoding="utf-8", newline="\n")

"""The article, its supplement, the list of figures and the page of all results."""

import sys
from pathlib import Path

from carbonelli2011 import article, index
from paper_replication import pages
from paper_replication.datasets import read, save_record
from paper_replication.origins import bare

sys.stderr = open(snakemake.log[0], "w", encoding="utf-8")
datasets = {Path(path).stem: read(path) for path in snakemake.input.data}
entries = snakemake.params.entries
captions = {name: entry["caption"] for name, entry in entries.items() if "caption" in entry}
marked = {name: article.written(name, datasets) for name in ("paper", "supplement")}
origins = {name: article.origins_of(name, datasets) for name in marked}
texts = {name: bare(text) for name, text in marked.items()} | {
    "figures": index.filled_in("md", datasets, entries),
    "index": index.filled_in("html", datasets, entries),
    "numbers": pages.numbers(marked, origins, datasets),
}
for name, text in marked.items():
    texts[f"{name}_page"] = pages.page_of(text, name, captions, origins[name])
for name, text in texts.items():
    Path(snakemake.output[name]).write_text(text, encoding="utf-8", newline="\n")
save_record(snakemake)

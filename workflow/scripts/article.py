"""The article, its supplement, the list of figures and the page of all results."""

import sys
from pathlib import Path

from bouncing_ball import article, pages
from bouncing_ball.datasets import read

# Where the page leads.
LINKS = [
    ("The article (Markdown)", "paper.md"),
    ("its supplement (Markdown)", "supplement.md"),
    ("all claims (CSV)", "figures/claims.csv"),
    ("the same (Markdown)", "figures/claims.md"),
]

sys.stderr = open(snakemake.log[0], "w", encoding="utf-8")
datasets = {Path(path).stem: read(path) for path in snakemake.input.data}
entries = snakemake.params.entries
texts = {
    "paper": article.filled_in("paper", datasets),
    "supplement": article.filled_in("supplement", datasets),
    "figures": pages.filled_in("md", datasets, entries),
    "index": pages.filled_in("html", datasets, entries, links=LINKS),
}
for name, text in texts.items():
    Path(snakemake.output[name]).write_text(text, encoding="utf-8", newline="\n")

"""Where these studies lie, and what their records and comparisons need."""

from pathlib import Path

from carbonelli2011.variables import REFERENCE
from paper_replication.datasets import Project
from studies.variables import described

TOP = Path(__file__).resolve().parents[2]
OURS = ("Snakefile", "config", "src", "workflow")

PROJECT = Project(
    top=TOP,
    checkout=TOP.parents[1],
    describe=described,
    references=REFERENCE,
    texts=("article.md", "appendix.md", "phase.md"),
    code=(*(f"extras/beyond/{name}" for name in OURS), "src"),
)

"""Where this replication lies, and what its records and comparisons need."""

from pathlib import Path

from carbonelli2011.variables import REFERENCE, described
from paper_replication.datasets import Project

TOP = Path(__file__).resolve().parents[2]

PROJECT = Project(
    top=TOP,
    checkout=TOP,
    describe=described,
    references=REFERENCE,
    texts=("paper.md", "supplement.md"),
)

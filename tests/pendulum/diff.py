import sys
from pathlib import Path

from pendulum import PROJECT

from paper_replication.compare import report_of_run

sys.exit(report_of_run(PROJECT, Path("results"), snakemake))

# Check the configuration before anything runs; names shared by the rules.

import os
import sys
from pathlib import Path

from bouncing_ball.configuration.check import ConfigurationError, check_configuration
from bouncing_ball.audit.claims.ledger_file import check_datasets, datasets_of, printed, read_ledger
from bouncing_ball.pipeline.sources import sources
from bouncing_ball.configuration.yaml_file import read_yaml

schema = read_yaml(Path(workflow.basedir, "config/schema.yaml"))
try:
    check_configuration(config, schema)
except ConfigurationError as error:
    sys.exit(f"configuration: {error}")

# The paper's figures, those without data, and those beyond the paper.
PAPER_FIGURES = [f"fig{number:02d}" for number in range(1, 17)]
EXTENSIONS = ["ext_release"]
FIGURES = PAPER_FIGURES + EXTENSIONS
SCHEMATICS = ["fig01", "fig04"]
TABLES = ["table1", "thresholds", "witness", "forensics", "formulas", "claims"]
# Every dataset: of figures, of tables, and what statements are decided by.
DATASETS = [name for name in FIGURES if name not in SCHEMATICS] + TABLES + ["evidence"]
# Those that show orbits or their bifurcations.
WITNESSED = [f"fig{number:02d}" for number in (2, 3, 5, 6, 7, 8, 9, 10, 12, 13, 14, 15)]
WITNESSED += ["table1", "ext_release"]
# Those that statements in words are decided by.
EVIDENCE = [f"fig{number:02d}" for number in (3, 5, 6, 8, 9, 10, 13, 14, 15, 16)]
EVIDENCE += ["table1", "thresholds", "ext_release"]

try:
    LEDGER = read_ledger(Path(workflow.basedir, "config"))
    check_datasets(LEDGER, set(DATASETS) - {"claims"})
    TABLE1 = printed(LEDGER, "Table 1")
except ConfigurationError as error:
    sys.exit(f"config/claims.yaml: {error}")


def modules(*names):
    """Source files that a job uses: those modules, the adapter, all they import.

    Relative paths, so that a folder may be moved without running all again.
    """
    files = sources("bouncing_ball.pipeline.job", *(f"bouncing_ball.{name}" for name in names))
    return [os.path.relpath(file) for file in files]


def figure_parameters(wildcards):
    """The parameters of the figure or table whose dataset is made."""
    for section in ("figures", "tables", "extensions"):
        if wildcards.figure in config[section]:
            return config[section][wildcards.figure]
    raise KeyError(wildcards.figure)

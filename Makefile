# make        set up and make every figure, table and the paper in results/
# make test   set up and run the tests; make test-cluster runs the test with Slurm
# make quick  the tests of the computations, for use during development
# The environment is .venv/, from the hashed lock files.

PYTHON ?= python3
VENV ?= .venv
BIN := $(VENV)/bin
NEWEST := .venv-newest
# Snakemake starts jobs with the path of Python without quotes.
ifneq ($(words $(if $(filter /%,$(VENV)),$(VENV),$(CURDIR))),1)
$(error the path of this checkout has a space: move it, or make VENV=/a/path/without/spaces)
endif
COMMA := ,
# The target that every other target needs first; empty if another venv exists already.
SETUP ?= setup
# Print the files made, how many steps are done, and errors; the rest is in .snakemake/log.
QUIETLY := --quiet host rules reason
PIP := $(BIN)/python -m pip install --quiet --disable-pip-version-check

# Sixty jobs import the same modules, so that compiled modules are kept whatever the shell sets.
unexport PYTHONDONTWRITEBYTECODE

# Targets run one after another, because clean, run and compare share results/.
.NOTPARALLEL:
.PHONY: all replication setup lint test quick speed test-cluster test-long test-processors setup-engines test-engines docs test-docs gallery mutants diff accept samples report clean ci setup-newest newest config-docs readme lock

all: $(SETUP)
	$(BIN)/snakemake --cores 2 $(QUIETLY)
	@echo "Results: results/paper.md, results/motions.md, results/figures/. Compare with the record: make diff"

# The paper alone, and its comparison with the record: results/diff/replication.html.
replication: $(SETUP)
	$(BIN)/snakemake --cores 2 replication diff $(QUIETLY)

setup: $(VENV)/.installed

$(VENV)/.installed: requirements-build.lock requirements.lock
	@$(PYTHON) -c 'import sys; sys.exit(0 if sys.version_info >= (3, 11) else "Python 3.11 or newer is needed, this is %d.%d: make PYTHON=python3.12" % sys.version_info[:2])'
	$(PYTHON) -m venv $(VENV)
	$(PIP) --require-hashes --only-binary :all: --requirement requirements-build.lock
	$(PIP) --require-hashes --no-build-isolation --requirement requirements.lock
	$(PIP) --no-deps --no-build-isolation --editable .
	@touch $@

# Style, types, the floors of the house, and the linter of Snakemake.
lint: $(SETUP)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/snakefmt --check .
	$(BIN)/mypy
	$(BIN)/lint-imports --no-logo --no-cache
	@# The linter ends with the status 0 also if the workflow is not read to its end.
	@said="$$($(BIN)/snakemake --lint 2>&1)" && case "$$said" in *"in a good condition!"*) ;; \
	    *) false;; esac || { echo "$$said"; echo "snakemake --lint did not end"; exit 1; }

# One worker for each processor; all workers share one run of the pipeline, which goes on with the
# results of `make all` if they are of this commit. Each worker has one thread, because further
# threads would compete for the same processors.
THREADS ?= 1
PYTEST = OMP_NUM_THREADS=$(THREADS) $(BIN)/python -m pytest --numprocesses logical --maxprocesses 8 --dist worksteal

# The results of one run of the pipeline are compared with the record and are not computed again.
test: $(SETUP)
	$(PYTEST) --deselect tests/beyond/exhibits/test_against_the_record.py

# The tests of the computations, without runs of the pipeline, pictures and tests that take seconds.
# Some of them read the accepted record, so that a new artifact fails here until it is accepted.
quick: $(SETUP)
	$(PYTEST) $(addprefix --ignore=tests/,workflow drawing) --deselect tests/beyond/exhibits/test_against_the_record.py -m "not long and not slow and not cluster and not engines and not docs"

# One table of times against other programs: docs/speed.md. AUTO-07p is optional: `pip install
# bifpy` in the environment, with gfortran. COLD=--cold adds a cold run of the pipeline.
speed: $(SETUP)
	OMP_NUM_THREADS=1 $(BIN)/python tests/speed/side_by_side.py $(COLD)

# The atlas with Slurm, which the test starts: it mostly waits, and is skipped without Slurm.
test-cluster: $(SETUP)
	$(BIN)/python -m pytest -m cluster tests/workflow

# Long tests, and tests that repeat the assertions of others for more models and laws. They run on
# schedule in CI, and before a release.
test-long: $(SETUP)
	$(PYTEST) -m long --durations 20

# All tests again with the code of numpy, OpenBLAS and glibc for processors without AVX-512, and for
# processors without AVX2, the latter with two threads. numpy may leave out only what this processor
# has; X86_V3 is AVX2.
BEYOND = import numpy._core._multiarray_umath as cpu; print(*(x for x in cpu.__cpu_dispatch__ if cpu.__cpu_features__[x] and x != "$(1)"))
as_on = NPY_DISABLE_CPU_FEATURES="$$($(BIN)/python -c '$(call BEYOND,$(1))')" OPENBLAS_CORETYPE=$(2)
test-processors: $(SETUP)
	@failed=0; \
	$(call as_on,X86_V3,Haswell) $(MAKE) test SETUP= || failed=1; \
	$(call as_on,none,Nehalem) GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-FMA $(MAKE) test SETUP= THREADS=2 || failed=1; \
	exit $$failed

# The physics engines of the extra that have a wheel for this machine; the lock does not have them.
ENGINES = import tomllib; print(*tomllib.load(open("pyproject.toml", "rb"))["project"]["optional-dependencies"]["engines"])
setup-engines: $(SETUP)
	@missing=""; \
	for engine in $$($(BIN)/python -c '$(ENGINES)'); do \
	    $(PIP) --only-binary :all: --no-binary pygltflib "$$engine" || missing="$$missing $$engine"; done; \
	echo "Engines without a wheel for this machine:$${missing:- none}."; \
	echo "Engines of which no wheel was found: liggghts, mercurydpm, gazebo, jolt, physx; docs/bounces/javascript.mjs has the last two."; \
	$(BIN)/python -c "import torch" 2> /dev/null || \
	    echo "Genesis needs torch, of gigabytes, and is skipped without it: $(PIP) torch"

# Run the snippets of `design --engine` in the installed engines: ten minutes of processor time.
# The datasets are engines.nc, ext_bounces.nc, ext_bounce_settings.nc and bounce_drivers.nc in
# results/config; `make accept ONLY=engines` accepts one of them.
test-engines: $(SETUP)
	OMP_NUM_THREADS=1 $(BIN)/python -m pytest -m engines tests/contacts/engines
	$(BIN)/python docs/bounces/threads.py

# The site from the docs, the docstrings, the article and the explorer: results/site/index.html.
docs: $(SETUP) $(VENV)/.docs
	$(BIN)/python -m sphinx --quiet --fail-on-warning --keep-going -c docs . results/site
	@echo "The site: results/site/index.html"

$(VENV)/.docs: requirements-docs.lock
	$(PIP) --require-hashes --only-binary :all: --requirement requirements-docs.lock
	@touch $@

# Check links, pictures and errors of every page of the site in Chromium. It runs weekly in CI.
test-docs: docs
	$(BIN)/python -m pytest -m docs tests/test_site.py

# The pictures of the gallery and of the lesson, and the lesson as a notebook.
gallery: $(SETUP)
	cd docs/gallery && for script in *.py; do $(abspath $(BIN))/python $$script || exit; done
	cd docs/lesson && $(abspath $(BIN))/python -m doctest -o ELLIPSIS ../lesson.md
	$(BIN)/python docs/notebook.py

# Check that the tests detect faults: 200 single faults, one at a time.
mutants: $(SETUP)
	$(BIN)/python tests/mutants.py

# Compare the results with the accepted record; the page is results/diff/index.html. With
# ONLY=fig14, only this artifact is made and compared; its page is results/diff/fig14.html.
diff: $(SETUP)
	$(BIN)/snakemake --cores 2 $(strip $(subst $(COMMA), ,$(ONLY)) diff) $(QUIETLY)

# make accept ONLY='fig08 table1' copies these artifacts over the record; without ONLY, it copies
# all artifacts that have moved beyond their budgets.
export ONLY
accept: $(SETUP)
	$(BIN)/snakemake --cores 1 accept $(QUIETLY)

# Make the accepted samples of motions in config/ again, or only some, as in ONLY=ext_means. They
# take some minutes each.
SAMPLES = $(or $(ONLY),ext_basins ext_chaos ext_diagram ext_lives ext_locking ext_means)
samples: $(SETUP)
	$(BIN)/snakemake --cores 2 $(SAMPLES:%=results/figures/beyond/%.nc) $(QUIETLY)
	cp $(SAMPLES:%=results/figures/beyond/%.nc) config/

report: all
	$(BIN)/snakemake --report results/report.html

clean:
	rm -rf results .snakemake

# The steps of continuous integration.
ci:
	.ci/run

# The newest versions that pyproject.toml allows, without the lock, in a separate venv. The
# pipeline from clean, the diff and the tests run there, each even if another fails.
setup-newest:
	$(PYTHON) -m venv --clear $(NEWEST)
	$(NEWEST)/bin/python -m pip install --quiet --disable-pip-version-check --editable '.[test,pdf]'

newest: setup-newest clean
	$(MAKE) --keep-going all diff test VENV=$(NEWEST) SETUP=

config-docs: $(SETUP)
	$(BIN)/snakemake --cores 1 config_docs $(QUIETLY)

# The verdicts and Table 1 in README.md, what time steps cost in docs/engines.md, and the lists of
# files in figures/, from the accepted record.
readme: $(SETUP)
	$(BIN)/snakemake --cores 1 readme $(QUIETLY)

# Renew the lock files, for maintainers; this needs uv.
lock:
	uv pip compile pyproject.toml --extra test --extra pdf --extra lint --extra slurm --universal --python-version 3.11 --fork-strategy fewest --generate-hashes --no-header --no-annotate --upgrade --output-file requirements.lock
	uv pip compile pyproject.toml --extra docs --constraint requirements.lock --universal --python-version 3.11 --fork-strategy fewest --generate-hashes --no-header --no-annotate --upgrade --output-file requirements-docs.lock
	printf 'flit_core\nsetuptools\nwheel\n' | uv pip compile - --constraint requirements.lock --universal --python-version 3.11 --generate-hashes --no-header --no-annotate --upgrade --output-file requirements-build.lock

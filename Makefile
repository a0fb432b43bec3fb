# make            set up and make every figure, table and the paper in results/
# make test       set up and run the tests
# make everything beyond/ and contacts/, too, in an environment of their own; make test-everything
# make quick      the tests of the computations, for use during development
# The environment is .venv/, from the hashed lock files.

PYTHON ?= python3
VENV ?= .venv
BIN := $(VENV)/bin
NEWEST := .venv-newest
# A target of make has no space in its path.
ifneq ($(words $(if $(filter /%,$(VENV)),$(VENV),$(CURDIR))),1)
$(error the path of this checkout has a space: move it, or make VENV=/a/path/without/spaces)
endif
COMMA := ,
# The target that every other target needs first; empty if another venv exists already.
SETUP ?= setup
# Print the files made, how many steps are done, and errors; the rest is in .snakemake/log.
QUIETLY := --quiet host rules reason
PIP := $(BIN)/python -m pip install --quiet --disable-pip-version-check
PATHS := $(abspath $(BIN))
# The only package of the locks without a wheel.
SOURCES := connection-pool

# The processes of jobs import the same modules, so that compiled modules are kept whatever the shell sets.
unexport PYTHONDONTWRITEBYTECODE

# Targets run one after another, because clean, run and compare share results/.
.NOTPARALLEL:
.PHONY: all replication setup lint test quick diff accept release report clean ci test-cluster test-long test-processors everything setup-everything lint-everything test-everything test-beyond test-contacts diff-everything setup-engines test-engines docs test-docs gallery speed setup-newest newest config-docs readme lock

# The replication.

all: $(SETUP)
	$(BIN)/snakemake --cores 2 $(QUIETLY)
	@echo "Results: results/paper.md, results/figures/. Compare with the record: make replication"

# The same, and its comparison with the record: results/diff/index.html.
replication: $(SETUP)
	$(BIN)/snakemake --cores 2 replication diff $(QUIETLY)

setup: $(VENV)/.installed

# After a copy or a move of the checkout, the programs in .venv are those of the other folder: it is
# made anew, unless .installed names this folder.
ifneq ($(filter-out $(CURDIR),$(shell cat $(VENV)/.installed 2>/dev/null)),)
$(shell rm -f $(VENV)/.installed)
endif
$(VENV)/.installed: requirements-build.lock requirements.lock
	@$(PYTHON) -c 'import sys; sys.exit(0 if sys.version_info >= (3, 11) else "Python 3.11 or newer is needed, this is %d.%d: make PYTHON=python3.12" % sys.version_info[:2])'
	$(PYTHON) -m venv --clear $(VENV)
	$(PIP) --require-hashes --only-binary :all: --requirement requirements-build.lock
	$(PIP) --require-hashes --only-binary :all: --no-binary $(SOURCES) --no-build-isolation --requirement requirements.lock
	$(PIP) --no-deps --no-build-isolation --editable .
	@echo $(CURDIR) > $@

# Style, types, the floors of the house, and the linter of Snakemake.
lint: $(SETUP)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/snakefmt --check Snakefile workflow
	$(BIN)/mypy
	$(BIN)/lint-imports --no-logo --no-cache
	@# The linter ends with the status 0 also if the workflow is not read to its end.
	@said="$$($(BIN)/snakemake --lint 2>&1)" && case "$$said" in *"in a good condition!"*) ;; \
	    *) false;; esac || { echo "$$said"; echo "snakemake --lint did not end"; exit 1; }

# One worker for each processor; all workers share one run of the pipeline, which goes on with the
# results of `make all` if they are of this commit. Each worker has one thread, because further
# threads would compete for the same processors.
THREADS ?= 1
PYTEST = OMP_NUM_THREADS=$(THREADS) $(PATHS)/python -m pytest --numprocesses logical --maxprocesses 8 --dist worksteal

test: $(SETUP)
	$(PYTEST)

# The tests of the computations, without runs of the pipeline, pictures and tests that take seconds.
# Some of them read the accepted record, so that a new artifact fails here until it is accepted.
quick: $(SETUP)
	$(PYTEST) $(addprefix --ignore=tests/,workflow drawing) -m "not long and not slow and not cluster"

# Two stages with Slurm, which the test starts: it mostly waits, and is skipped without Slurm.
test-cluster: $(SETUP)
	$(BIN)/python -m pytest -m cluster tests/workflow

# Long tests. They run on schedule in CI, and before a release.
test-long: $(SETUP)
	$(PYTEST) -m long --durations 20

# All tests again with the code of numpy, OpenBLAS and glibc for processors without AVX-512, and for
# processors without AVX2, the latter with two threads. numpy may leave out only what this processor
# has; X86_V3 is AVX2.
PAST = import numpy._core._multiarray_umath as cpu; print(*(x for x in cpu.__cpu_dispatch__ if cpu.__cpu_features__[x] and x != "$(1)"))
as_on = NPY_DISABLE_CPU_FEATURES="$$($(BIN)/python -c '$(call PAST,$(1))')" OPENBLAS_CORETYPE=$(2)
test-processors: $(SETUP)
	@failed=0; \
	$(call as_on,X86_V3,Haswell) $(MAKE) test SETUP= || failed=1; \
	$(call as_on,none,Nehalem) GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-FMA $(MAKE) test SETUP= THREADS=2 || failed=1; \
	exit $$failed

# Compare the results with the accepted record; the page is results/diff/index.html. With
# ONLY=fig14, only this artifact is made and compared.
diff: $(SETUP)
	$(BIN)/snakemake --cores 2 $(strip $(subst $(COMMA), ,$(ONLY)) diff) $(QUIETLY)

# make accept ONLY='fig08 table1' copies these artifacts over the record; without ONLY, it copies
# all artifacts that have moved beyond their budgets.
export ONLY
accept: $(SETUP)
	$(BIN)/snakemake --cores 1 accept $(QUIETLY)

# One file to cite and to run without git, dist/bouncing-ball-VERSION.tar.gz: the commit that is
# checked out, with its lock files and its record. It must give the results of the record.
VERSION = $(shell sed -n 's/^version: //p' CITATION.cff)
release: $(SETUP)
	@changed="$$(git status --porcelain)" && test -z "$$changed" || { echo "A release is a commit: there are uncommitted changes, or there is no repository."; exit 1; }
	$(BIN)/snakemake --cores 2 replication diff $(QUIETLY)
	mkdir -p dist
	git archive --prefix=bouncing-ball-$(VERSION)/ --output=dist/bouncing-ball-$(VERSION).tar.gz HEAD
	@sha256sum dist/bouncing-ball-$(VERSION).tar.gz

report: all
	$(BIN)/snakemake --report results/report.html

clean:
	rm -rf results .snakemake
	$(MAKE) -C beyond clean

# The steps of continuous integration.
ci:
	.ci/run

# The other two packages, beyond/ and contacts/: they need nothing of this one, and beyond/Makefile has
# their environment and their targets.

setup-everything:
	$(MAKE) -C beyond setup

everything: all
	$(MAKE) -C beyond all

diff-everything: diff
	$(MAKE) -C beyond diff

lint-everything: lint
	$(MAKE) -C beyond lint lint-contacts

# The tests of all three packages, each whatever the others say.
test-everything:
	$(MAKE) --keep-going test test-beyond test-contacts

test-beyond:
	$(MAKE) -C beyond test

test-contacts:
	$(MAKE) -C beyond test-contacts

setup-engines:
	$(MAKE) -C beyond setup-engines

test-engines:
	$(MAKE) -C beyond engines

speed docs test-docs gallery:
	$(MAKE) -C beyond $@

# The newest versions that pyproject.toml allows, without the lock, in a separate venv. The
# pipeline from clean, the diff and the tests run there, each even if another fails.
setup-newest:
	$(PYTHON) -m venv --clear $(NEWEST)
	$(NEWEST)/bin/python -m pip install --quiet --disable-pip-version-check --editable '.[test,pdf]'

newest: setup-newest clean
	$(MAKE) --keep-going all diff test VENV=$(NEWEST) SETUP=

config-docs: $(SETUP)
	$(BIN)/snakemake --cores 1 config_docs $(QUIETLY)

# The verdicts and Table 1 in README.md, and figures/README.md, from the accepted record.
readme: $(SETUP)
	$(BIN)/snakemake --cores 1 readme $(QUIETLY)

# Renew the lock files, for maintainers; this needs uv.
LOCK := uv pip compile --universal --python-version 3.11 --fork-strategy fewest --generate-hashes --no-header --no-annotate --upgrade
lock:
	$(LOCK) pyproject.toml --extra test --extra pdf --extra lint --extra slurm --output-file requirements.lock
	printf 'flit_core\nsetuptools\nwheel\n' | $(LOCK) - --constraint requirements.lock --output-file requirements-build.lock

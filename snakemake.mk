# For the Makefiles of the replication and of beyond.

# A VENV of the shell does not count: make VENV=/another/path
VENV := .venv
RUN := $(VENV)/bin/python -m
SNAKEMAKE := $(RUN) snakemake --logger rich --cores 2

# Snakemake starts a Python whose path has no space.
FOLDER := $(if $(filter /%,$(VENV)),$(VENV),$(CURDIR))
ifneq ($(words $(FOLDER)),1)
$(error The path of Python has a space: move this folder, or make VENV=/another/path)
endif

# Snakemake's cache is in the home folder, which may be read-only.
WRITABLE := [ -w "$$HOME/.cache" ] || [ ! -e "$$HOME/.cache" -a -w "$$HOME" ]
ifeq ($(XDG_CACHE_HOME)$(shell $(WRITABLE) && echo yes),)
export XDG_CACHE_HOME := $(CURDIR)/.snakemake/cache
endif

# Targets run one after another, because they share results/.
.NOTPARALLEL:

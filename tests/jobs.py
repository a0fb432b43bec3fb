"""What a script gets from Snakemake, and git for tests."""

import os
import subprocess

import pytest


class Named(list):
    """The files of a job as Snakemake gives them to its script: a list with names."""

    def __init__(self, **files: str):
        super().__init__(files.values())
        self.__dict__.update(files)

    def __getitem__(self, name):
        return self.__dict__[name]


@pytest.fixture(autouse=True, scope="module")
def git_of_its_own():
    """Git without the variables of a hook, and without the configuration of a user or a machine.

    A hook exports the index and the repository of its commit. Tests that used them would commit
    their own project into the user's repository.
    """
    asked = ["git", "rev-parse", "--local-env-vars"]
    names = subprocess.run(asked, check=True, capture_output=True, text=True).stdout.split()
    with pytest.MonkeyPatch.context() as patch:
        for name in [*names, "GIT_DEFAULT_HASH", "GIT_TEMPLATE_DIR"]:
            patch.delenv(name, raising=False)
        patch.setenv("GIT_CONFIG_GLOBAL", os.devnull)
        patch.setenv("GIT_CONFIG_NOSYSTEM", "1")
        yield

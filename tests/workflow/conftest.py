"""Copies of the tree in which the workflow is run as a user runs it.

A whole run costs as much as hundreds of other tests: there is one, which all workers
share, and copies of it. It goes on with the results of the checkout if `make all` has made
all of them at this very commit; Snakemake makes what is not up to date. Otherwise a shorter
run makes everything. All runs are started by ``warm.py``, which has imported numpy and its
like once for all jobs.
"""

import compileall
import fcntl
import functools
import hashlib
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

import pytest
import yaml

from bouncing_ball.pipeline.artifact_files import CARRIERS, files_in
from bouncing_ball.pipeline.provenance import read_provenance

ROOT = Path(__file__).resolve().parents[2]
# No run takes as many seconds, unless it hangs.
HANGING = 1200
# A fresh clone: neither results nor the state of earlier runs.
OTHERS = ".git .venv* results .snakemake *.egg-info .*_cache"
IGNORED = shutil.ignore_patterns(*OTHERS.split())
TEXTS = ("paper.md", "supplement.md")
# What a whole run leaves: its results, and what Snakemake has noted about them.
MADE = (
    *(f"results/{name}" for name in ("figures", "code", "logs", *TEXTS)),
    *(f".snakemake/{name}" for name in ("metadata", "incomplete")),
)


@dataclass(frozen=True)
class Tree:
    """A copy of the repository with shortcuts to run and to change it."""

    path: Path
    python: str = sys.executable
    package: str = "src"

    def run(self, *arguments: str, check: bool = True) -> subprocess.CompletedProcess:
        """Snakemake in this tree; the package is imported from this tree."""
        done = subprocess.run(
            [self.python, "-m", "snakemake", *arguments],
            cwd=self.path,
            env=self.environment(),
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            timeout=HANGING,
        )
        if check and done.returncode != 0:
            pytest.fail(f"snakemake {' '.join(arguments)} failed:\n{done.stdout}{done.stderr}")
        return done

    def refusal(self, *arguments: str) -> str:
        """The one line with which a run ends before any job is run."""
        done = self.run("--cores", "1", *arguments, check=False)
        assert done.returncode == 1
        # Snakemake itself says which profile and files it uses; the rest is ours.
        own = ("Using ", "Config file ")
        (said,) = [line for line in done.stderr.splitlines() if not line.startswith(own)]
        return said

    def python_says(self, program: str, *arguments: str) -> str:
        """What a program of Python prints in this tree."""
        script = self.path / ".snakemake" / "program.py"
        script.parent.mkdir(exist_ok=True)
        script.write_text(program, encoding="utf-8")
        done = subprocess.run(
            [self.python, script, *arguments],
            cwd=self.path,
            env=self.environment(),
            capture_output=True,
            text=True,
            check=True,
        )
        return done.stdout.strip()

    def environment(self) -> dict[str, str]:
        return os.environ | {"PYTHONPATH": str(self.path / self.package)}

    def git(self, *arguments: str) -> str:
        """Git in this tree, without the settings of the user who runs the tests."""
        # A fixed date: the same files give the same commit.
        who = {f"GIT_{x}_{y}": "tests" for x in ("AUTHOR", "COMMITTER") for y in ("NAME", "EMAIL")}
        when = {f"GIT_{x}_DATE": "2011-08-28T00:00:00Z" for x in ("AUTHOR", "COMMITTER")}
        settings = {"GIT_CONFIG_GLOBAL": os.devnull, "GIT_CONFIG_NOSYSTEM": "1"}
        bare = {key: value for key, value in os.environ.items() if not key.startswith("GIT_")}
        done = subprocess.run(
            ["git", *arguments],
            cwd=self.path,
            env=bare | who | when | settings,
            capture_output=True,
            text=True,
            check=True,
        )
        return done.stdout.strip()

    def commit(self, message: str) -> str:
        """Commit everything that is not ignored; the full hash."""
        self.git("add", "--all")
        self.git("commit", "--quiet", "--allow-empty", "--message", message)
        return self.git("rev-parse", "HEAD")

    def planned(self, *arguments: str) -> set[str]:
        """The rules whose jobs a run would execute, except that of everything."""
        done = self.run("--cores", "1", "--dry-run", *arguments)
        jobs = re.findall(r"^(\w+) +1$", done.stdout + done.stderr, re.MULTILINE)
        return {*jobs} - {"all"}

    def planned_files(self, *arguments: str) -> dict[str, str]:
        """The files under results/figures that a run would make, with the rule of each."""
        done = self.run("--cores", "1", "--detailed-summary", *arguments)
        rows = [line.split("\t") for line in done.stdout.splitlines()]
        return {row[0]: row[2] for row in rows if row[0].startswith("results/figures/")}

    def needed(self, *targets: str) -> dict[str, set[str]]:
        """The rules of each target that a run of all of these would execute, with itself."""
        graph = self.run("--rulegraph", "--", *targets).stdout
        rules = dict(re.findall(r'^\s*(\d+)\[label = "(\w+)"', graph, re.MULTILINE))
        edges = [(rules[a], rules[b]) for a, b in re.findall(r"(\d+) -> (\d+)", graph)]
        found: dict[str, set[str]] = {}
        for target in targets:
            new = found[target] = {target}
            while new:
                new = {first for first, then in edges if then in new} - found[target]
                found[target] = found[target] | new
        return found

    def configure(self, *keys, value) -> None:
        """Change one value of the configuration."""
        path = self.path / "config" / "config.yaml"
        config = yaml.safe_load(path.read_text(encoding="utf-8"))
        section = config
        for key in keys[:-1]:
            section = section[key]
        section[keys[-1]] = value
        path.write_text(yaml.safe_dump(config, sort_keys=False), encoding="utf-8")

    def edit(self, file: str, line: str = "_EDITED = True") -> None:
        """Add a line to a source file, by default one of code that changes nothing it does."""
        with (self.path / "src" / "bouncing_ball" / file).open("a", encoding="utf-8") as module:
            module.write(f"\n{line}\n")

    def rewrite(self, file: str, old: str, new: str) -> None:
        """Replace a text that occurs once in a file."""
        path = self.path / file
        text = path.read_text(encoding="utf-8")
        assert text.count(old) == 1, f"{old!r} occurs {text.count(old)} times in {file}"
        path.write_text(text.replace(old, new), encoding="utf-8")

    def contents(self, folder: str = "") -> dict[str, bytes]:
        """All files under a folder except logs, digests of code and Snakemake's files.

        Files that were being written when a run was killed have other names, and are left out as
        well.
        """
        base = self.path / folder
        files = (path for path in sorted(base.rglob("*")) if path.is_file())
        names = {str(path.relative_to(base)): path for path in files}
        skipped = ("logs/", "code/", ".snakemake/", ".git/", ".part.")
        return {
            name: path.read_bytes()
            for name, path in names.items()
            if "__pycache__" not in name and not any(part in name for part in skipped)
        }

    def checksums(self, folder: str = "") -> dict[str, str]:
        """Checksums of the files of :meth:`contents`."""
        files = self.contents(folder)
        return {name: hashlib.sha256(content).hexdigest() for name, content in files.items()}

    def interrupt(
        self, sign: signal.Signals, *arguments: str, after: int, of: str = "figures/*"
    ) -> None:
        """Start a run and stop it as soon as it has made so many results."""
        running = subprocess.Popen(
            # In one group of processes with its jobs.
            [self.python, "-m", "snakemake", *arguments],
            cwd=self.path,
            env=self.environment(),
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            process_group=0,
        )
        end = time.monotonic() + HANGING
        while len(list(self.path.glob(f"results/{of}"))) < after and time.monotonic() < end:
            assert running.poll() is None, "the run ended before it could be interrupted"
            time.sleep(0.02)
        os.killpg(running.pid, sign)
        running.wait(HANGING)
        if sign == signal.SIGKILL:
            # Snakemake could not remove its lock: as `snakemake --unlock` does it.
            shutil.rmtree(self.path / ".snakemake" / "locks")


def copy_tree(tree: Tree, target: Path) -> Tree:
    """A copy of one of these trees with its git and its results."""
    # A few times as quick as Python.
    subprocess.run(["cp", "-pPR", tree.path, target], check=True)
    return replace(tree, path=target)


@pytest.fixture(scope="session")
def shared(tmp_path_factory) -> Path:
    """A folder of this session, the same for all workers."""
    base = tmp_path_factory.getbasetemp()
    return base.parent if "PYTEST_XDIST_WORKER" in os.environ else base


@pytest.fixture(scope="session")
def warm(shared) -> Iterator[str]:
    """A Python that is as quick to start as a fork, which the first worker who needs it starts for
    all; elsewhere than on Linux the usual one.

    A fork that runs on is not safe with the libraries of macOS.
    """
    if sys.platform != "linux":
        yield sys.executable
        return
    folder = shared / "warm"
    lock = open(shared / "warm.lock", "w")
    users = open(shared / "warm.users", "w")
    with lock, users, ExitStack() as server:
        fcntl.flock(lock, fcntl.LOCK_EX)
        starts = not folder.is_symlink()
        if starts:
            folder.symlink_to(server.enter_context(warm_server()))
        fcntl.flock(users, fcntl.LOCK_SH)
        fcntl.flock(lock, fcntl.LOCK_UN)
        yield str(folder.readlink() / "python")
        fcntl.flock(users, fcntl.LOCK_UN)
        if starts:
            # Nobody begins to use it, and those who do end first.
            fcntl.flock(lock, fcntl.LOCK_EX)
            fcntl.flock(users, fcntl.LOCK_EX)
            folder.unlink()


@contextmanager
def warm_server() -> Iterator[Path]:
    """The folder of a server that runs meanwhile."""
    # A socket's address is short.
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, Path(__file__).with_name("warm.py"), folder]
        with subprocess.Popen(command) as server:
            try:
                end = time.monotonic() + HANGING
                while not Path(folder, "ready").exists():
                    assert server.poll() is None, "the warm Python did not start"
                    assert time.monotonic() < end, "the warm Python hangs"
                    time.sleep(0.02)
                yield Path(folder)
            finally:
                server.terminate()


def made_once(target: Path, make: Callable[[Path], None], python: str) -> Tree:
    """A tree that the first worker who needs it makes, while the others wait for it."""
    with open(target.with_suffix(".lock"), "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not target.exists():
            part = target.with_suffix(".part")
            shutil.rmtree(part, ignore_errors=True)
            make(part)
            part.rename(target)
    return Tree(target, python)


def shorten(tree: Tree) -> None:
    """Let a run of this tree take less time."""
    # Who looks at pictures looks at those of `make`.
    settings = "src/bouncing_ball/drawing/style.mplstyle"
    tree.rewrite(settings, "savefig.dpi: 300", "savefig.dpi: 50")


@functools.cache
def made_by_this_commit() -> bool:
    """Whether all results in the checkout are of its commit and nothing was changed since then.

    Whether they are up to date is left to Snakemake.
    """
    checkout = Tree(ROOT)
    made = {f"results/{file}" for file in files_in(ROOT)}
    if not all((checkout.path / file).exists() for file in made | {".git", ".snakemake"}):
        return False
    if checkout.git("status", "--porcelain"):
        return False
    commit = checkout.git("rev-parse", "HEAD")
    figures = (checkout.path / "results" / "figures").rglob("*")
    found = {path for path in figures if path.suffix in CARRIERS}
    if not found <= {checkout.path / file for file in made}:
        return False
    return all(
        (each["commit"], each["dirty"], each["configuration"]) == (commit, "no", {})
        for each in map(read_provenance, found)
    )


@pytest.fixture(scope="session")
def cloned(shared, warm) -> Tree:
    """A fresh clone with one commit: that of the checkout if all of its results are of this
    commit, and otherwise one of a repository of its own in which runs are shorter.
    """

    def make(folder: Path) -> None:
        shutil.copytree(ROOT, folder, symlinks=True, ignore=IGNORED)
        tree = Tree(folder)
        if made_by_this_commit():
            tree.git("clone", "--quiet", "--shared", "--no-checkout", str(ROOT), "results/clone")
            shutil.move(folder / "results" / "clone" / ".git", folder)
            shutil.rmtree(folder / "results")
            tree.git("reset", "--quiet")
            assert tree.git("status", "--porcelain") == ""
        else:
            shorten(tree)
            tree.git("init", "--quiet")
            tree.commit("All")
        # Once, and not by every process of every copy; what is compiled already stays.
        compileall.compile_dir(folder / "src", quiet=2)

    return made_once(shared / "cloned", make, warm)


@pytest.fixture(scope="session")
def pristine(shared, cloned) -> Tree:
    """A complete run. Tests must not change it, nor run in it: other workers copy it."""

    def make(folder: Path) -> None:
        tree = copy_tree(cloned, folder)
        # Git reads the copied files once, and not for every job.
        tree.git("status")
        if made_by_this_commit():
            for name in MADE:
                if (ROOT / name).exists():
                    (folder / name).parent.mkdir(exist_ok=True)
                    subprocess.run(["cp", "-pPR", ROOT / name, folder / name], check=True)
        tree.run("--cores", "2")

    return made_once(shared / "pristine", make, cloned.python)


@pytest.fixture
def fresh(cloned, tmp_path) -> Tree:
    """A fresh clone in which nothing was run."""
    return copy_tree(cloned, tmp_path / "tree")


@pytest.fixture
def complete(pristine, tmp_path) -> Tree:
    """A complete run that a test may change."""
    return copy_tree(pristine, tmp_path / "tree")

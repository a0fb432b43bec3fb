"""Walk the roads that the pages promise, in a shell that inherits nothing: .ci/run does.

    ./python.sh tests/roads.py PAGE ...    run the shell blocks of pages, each in a new shell
    ./python.sh tests/roads.py recipes     follow recipes of CONTRIBUTING.md, and accept the results

A block is shell if it has no language, or `sh`; further words say why it is not run here. It may
show a session, in which commands begin with `$`. A command may name its exit status in a comment.
The environment of the package to which a page belongs is active.
"""

import os
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory
from textwrap import dedent, indent

ROOT = Path(__file__).resolve().parents[1]
AUTHORS = "The bouncing-ball maintainers"
BLOCK = re.compile(r"^ *```(.*)\n((?s:.*?))^ *```", re.MULTILINE)


def blocks(page: str) -> Iterator[tuple[str, str, str]]:
    """The info string and the content of each block of a page, and the paragraph before it."""
    text = (ROOT / page).read_text("utf-8")
    for block in BLOCK.finditer(text):
        paragraph = text[: block.start()].rstrip().rpartition("\n\n")[2]
        yield block[1].strip(), dedent(block[2]), paragraph


def commands(content: str) -> list[str]:
    """The commands of a shell block, or of a session."""
    lines = content.splitlines()
    if content.startswith("$ "):
        return [line.removeprefix("$ ") for line in lines if line.startswith("$ ")]
    return [line for line in lines if line]


def with_status(command: str) -> str:
    """A command that fails unless its exit status is the one that its comment names."""
    named = re.search(r"#.*\bexit status (\d+)", command)
    if named is None:
        return command
    return f"if {command}\nthen false; else [ $? = {named[1]} ]; fi"


def run(lines: list[str], folder: Path, environment: Path) -> int:
    """The exit status of a script in a new shell; it prints its commands, and ends at a failure."""
    variables = {"HOME": os.environ["HOME"], "LANG": "C.UTF-8"}
    variables["PATH"] = f"{environment / 'bin'}:{os.environ['PATH']}"
    script = "\n".join(["set -ex", *lines])
    return subprocess.run(["bash", "-c", script], cwd=folder, env=variables).returncode


def walk(page: str) -> int:
    """Run the shell blocks of a page, and write the configurations that it shows."""
    package = re.match(r"(extras/\w+/)?", page)[0]
    failed = 0
    for info, content, paragraph in blocks(page):
        language, _, reason = info.partition(" ")
        named = re.findall(r"`(\w+\.yaml)`", paragraph)
        if language == "yaml" and named:
            file = ROOT / named[0]
            if file.exists() and file.read_text("utf-8") != content:
                sys.exit(f"{file} is not that of {page}: move it elsewhere")
            file.write_text(content, "utf-8")
        elif language in ("", "sh") and reason:
            print(f"{page}: not walked {reason}: {'; '.join(commands(content))}", flush=True)
        elif language in ("", "sh"):
            lines = [with_status(command) for command in commands(content)]
            failed |= run(lines, ROOT, ROOT / package / ".venv")
    return failed


def insert(file: Path, pattern: str, text: str) -> None:
    """Insert a text behind the first match of a pattern."""
    content = file.read_text("utf-8")
    place = re.search(pattern, content, re.MULTILINE).end()
    file.write_text(content[:place] + text + content[place:], "utf-8")


def change(clone: Path) -> None:
    """A figure, a claim and another author, from the blocks of CONTRIBUTING.md."""
    (entry,) = (content for info, content, _ in blocks("CONTRIBUTING.md") if info == "yaml")
    code = [content for info, content, _ in blocks("CONTRIBUTING.md") if info == "python"]
    computed, drawing, drawn, claim = code
    section = "apparent_restitution"
    insert(clone / "config/config.yaml", rf"^{section}:\n.*\n", indent(entry, "  "))
    insert(clone / f"src/carbonelli2011/stages/{section}.py", r"^STAGE = \{", computed)
    figures = clone / "src/carbonelli2011/figures.py"
    insert(figures, r"(?=^PLOTS\b)", f"{drawing}\n\n")
    insert(figures, r"^PLOTS\b.*\{", f"\n{drawn}")
    insert(clone / "src/carbonelli2011/claims.py", r"\Z", f"\n\n{claim}")
    for name in ("metadata.yaml", "CITATION.cff", "src/carbonelli2011/templates/paper.md.j2"):
        content = (clone / name).read_text("utf-8")
        assert AUTHORS in content, name
        (clone / name).write_text(content.replace(AUTHORS, "Somebody Else"), "utf-8")


def follow_recipes() -> int:
    """Change a clone, and accept its results as CONTRIBUTING.md says."""
    git = "git -c user.name=A -c user.email=a@example.org"
    commit = f"{git} commit --quiet --all --message"
    make = f"make VENV={ROOT}/.venv"
    with TemporaryDirectory() as folder:
        clone = Path(folder, "clone")
        subprocess.run(["git", "clone", "--quiet", ROOT, clone], check=True)
        change(clone)
        accepted = "figures/fig17.png figures/fig17.svg figures/fig17.nc"
        lines = [
            f"{commit} 'A figure, a claim and other authors'",
            f"{ROOT}/.venv/bin/python -m pytest --collect-only -qq",
            f"{make} accept",
            f"git add {accepted}",
            f"{commit} 'Reference: a figure, a claim and other authors'",
            "grep 'heights differ' figures/claims.md",
            "grep 'Somebody Else' paper.md",
            f"{make} diff",
            "git diff --exit-code",
            # They are taken out again.
            f"{git} revert --no-edit HEAD~1",
            "rm results/figures/fig17.*",
            f"{make} accept",
            "test ! -e figures/fig17.nc",
        ]
        return run(lines, clone, ROOT / ".venv")


if __name__ == "__main__":
    failures = [
        road for road in sys.argv[1:] if (follow_recipes() if road == "recipes" else walk(road))
    ]
    sys.exit(f"Not walked to the end: {', '.join(failures)}" if failures else 0)

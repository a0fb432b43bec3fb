"""The installed program: its help, its outputs, and streams that take no output."""

import functools
import importlib
import inspect
import json
import os
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

import bouncing_ball_beyond.inherited
from bouncing_ball_beyond.inherited.cli.commands import COMMANDS
from bouncing_ball_beyond.inherited.cli.options import meanings
from bouncing_ball_beyond.inherited.models.spring_damper import spring_damper

ROOT = Path(__file__).resolve().parents[3]
PROGRAM = Path(sys.executable).with_name("bouncing-ball")
ORBIT = ("orbit", "--restitution", "0.85", "--amplitude", "1")


def program(*arguments, **options):
    return subprocess.run([PROGRAM, *arguments], stderr=subprocess.PIPE, check=False, **options)


def test_the_help_says_what_the_docstrings_of_the_calls_say(said):
    shown = "".join(said("orbit", "--help").split()).replace("-", "")
    texts = meanings(spring_damper)
    for name in inspect.signature(spring_damper).parameters:
        assert "".join(texts[name].split()).replace("-", "") in shown
    assert "(default: -3.142)" in said("simulate", "--help")
    assert said("--version") == f"bouncing-ball {bouncing_ball_beyond.inherited.__version__}\n"


@pytest.mark.parametrize("encoding", ["ascii", pytest.param("latin-1", marks=pytest.mark.long)])
@pytest.mark.parametrize(
    ("arguments", "status"), [(["orbit", "--help"], 0), ([*ORBIT[:-1], "0.1", "--json"], 1)]
)
def test_any_encoding_of_the_output(encoding, arguments, status):
    environment = os.environ | {"PYTHONIOENCODING": encoding}
    done = program(*arguments, stdout=subprocess.PIPE, env=environment)
    assert done.returncode == status
    assert b"Traceback" not in done.stderr and done.stderr.count(b"\n") <= 1
    assert "--json" not in arguments or json.loads(done.stdout.decode(encoding))


@pytest.mark.parametrize("arguments", [["--help"], ["--version"], [*ORBIT, "--json"]])
def test_a_full_device(arguments):
    with Path("/dev/full").open("wb") as full:
        done = program(*arguments, stdout=full, text=True)
    assert done.returncode == 2
    assert done.stderr == "bouncing-ball: the output cannot be written: No space left on device\n"


def test_what_is_not_imported():
    calls = {
        "--help": "numpy",
        "bounce": "numpy",
        "": "numpy",
        # A single ball needs no labels.
        "orbit --restitution 0.8 --frequency-ratio 10 --amplitude 1": "xarray",
        "limits --restitution 0.8": "xarray",
        "simulate --restitution 0.8 --amplitude 1": "xarray",
    }
    # Each of them imports no more than the one before it.
    code = (
        "import sys\n"
        "from bouncing_ball_beyond.inherited.cli.main import main\n"
        f"for arguments, unneeded in {calls!r}.items():\n"
        "    try:\n"
        "        main(arguments.split())\n"
        "    except SystemExit:\n"
        "        pass\n"
        "    finally:\n"
        "        print('is imported:', unneeded in sys.modules)\n"
    )
    call = [sys.executable, "-c", code]
    done = subprocess.run(call, capture_output=True, text=True, check=False)
    found = [line for line in done.stdout.splitlines() if line.startswith("is imported: ")]
    assert found == ["is imported: False"] * len(calls) and "Traceback" not in done.stderr


def test_diff_for_nobody_who_reads(tmp_path):
    # Python on this end, and on the other nobody: the status is the diff's all the same.
    for side in ("record", "results"):
        (tmp_path / side).mkdir()
        (tmp_path / side / "paper.md").write_text(side if side == "record" else "", "utf-8")
    reader, writer = os.pipe()
    os.close(reader)
    done = program("diff", "record", "results", cwd=tmp_path, stdout=writer, text=True)
    os.close(writer)
    # The texts differ. On a busy machine a line says that the answer takes long.
    errors = [line for line in done.stderr.splitlines() if "no answer after" not in line]
    assert (done.returncode, errors) == (1, [])


@pytest.mark.parametrize(
    "example",
    [
        each
        for name, about in COMMANDS.items()
        for each in about.examples
        # The comparison needs a run; its calls are tested with it.
        if name != "diff"
    ],
)
def test_the_examples_of_the_help_run(example, said, monkeypatch):
    monkeypatch.chdir(ROOT)
    command, *given = shlex.split(example)
    assert said(command, *given)
    assert f"bouncing-ball {example}" in said(command, "--help")


def test_every_command_is_explained_and_its_symbols_are(said):
    for command in COMMANDS:
        shown = said(command, "--help")
        assert "examples:" in shown
        assert "Eq. 16" not in shown or "exp(-πζ/√(1 - ζ²))" in " ".join(shown.split())


def test_a_file_is_refused_before_its_contents_are_computed(refused, monkeypatch):
    module = importlib.import_module("bouncing_ball_beyond.inherited.cli.diff")

    # The options of the command are made from the signature.
    @functools.wraps(module.compare_folders)
    def computed(*given, **more):
        pytest.fail("computed before the file was refused")

    monkeypatch.setattr(module, "compare_folders", computed)
    status, line = refused("diff", "figures", "results", "--html", "/dev/null/a.svg")
    assert status == 2 and "/dev/null/a.svg cannot be written: /dev/null is no folder" in line


@pytest.mark.parametrize("kind", ["a device", "a link", "a pipe", "a folder", "in no folder"])
def test_a_page_replaces_nothing_but_a_regular_file(refused, tmp_path, kind):
    target = tmp_path / "page.html"
    if kind == "a device":
        target = Path(os.devnull)
    elif kind == "a link":
        (tmp_path / "other").write_text("kept", encoding="utf-8")
        target.symlink_to(tmp_path / "other")
    elif kind == "a pipe":
        os.mkfifo(target)
    elif kind == "a folder":
        target.mkdir()
    else:
        target = tmp_path / "new" / "folder" / "page.html"
    before = sorted(tmp_path.rglob("*"))
    status, line = refused("diff", str(ROOT), str(ROOT), "fig01", "--html", str(target))
    assert status == 2 and f"{target} cannot be written" in line
    assert sorted(tmp_path.rglob("*")) == before
    if kind == "a link":
        assert target.is_symlink() and target.read_text(encoding="utf-8") == "kept"

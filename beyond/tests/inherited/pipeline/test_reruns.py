"""The jobs that a change makes run again, as far as parameters and contents determine them."""

import copy
import os
import subprocess
import sys
from pathlib import Path

import pytest
from declared_artifacts import SCRIPTS, STUDIES, given_to

from bouncing_ball_beyond.inherited.pipeline import sources as module
from bouncing_ball_beyond.inherited.pipeline.job import arguments
from bouncing_ball_beyond.inherited.pipeline.sources import (
    lines_of,
    parts_of_note,
    sources,
    without_remarks,
    write_note,
)
from bouncing_ball_beyond.inherited.pipeline.yaml_files import read_yaml

ROOT = Path(__file__).resolve().parents[3]
PACKAGE = ROOT / "src" / "bouncing_ball_beyond"
CONFIG = read_yaml(ROOT / "config" / "config.yaml")


def arguments_in(run):
    return {x: arguments(study, given_to(x, run)) for x, study in STUDIES.items()}


@pytest.mark.parametrize(
    ("keys", "value", "expected"),
    [
        (("beyond", "ext_map", "tolerance"), 0.02, {"ext_map"}),
        (("beyond", "explorer", "seed"), 1, {"explorer"}),
        (("release",), "force", {"ext_instant", "ext_orders"}),
    ],
)
def test_a_parameter_changes_the_arguments_of_its_studies_only(keys, value, expected):
    config = copy.deepcopy(CONFIG)
    section = config
    for key in keys[:-1]:
        section = section[key]
    section[keys[-1]] = value
    before = arguments_in(CONFIG)
    after = arguments_in(config)
    assert {name for name in STUDIES if before[name] != after[name]} == expected


@pytest.mark.parametrize(
    ("file", "expected"),
    [
        ("exhibits/release_rules.py", {"ext_impact", "ext_release"}),
        ("exhibits/stiffness_map.py", {"ext_map"}),
        # A change of a budget is one of the parameters of its study.
        ("exhibits/budgets.py", set()),
    ],
)
def test_a_module_belongs_to_the_studies_that_import_it(file, expected):
    changed = PACKAGE / file
    assert changed.is_file()
    scripts = {name: SCRIPTS / f"compute_{name}.py" for name in STUDIES}
    users = {name for name, script in scripts.items() if changed in sources([script])}
    assert users == expected


def test_the_modules_of_a_stage_are_those_that_python_imports():
    script = SCRIPTS / "compute_ext_map.py"
    code = (
        "import sys, bouncing_ball_beyond.exhibits.stiffness_map\n"
        "print(*sorted(m.__file__ for n, m in sys.modules.items()"
        " if n.split('.')[0] == 'bouncing_ball_beyond'), sep='\\n')"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    # Also what functions import when they are called.
    assert set(done.stdout.splitlines()) <= {str(path) for path in sources([script])}


def test_the_modules_that_a_script_imports_and_their_data_belong_to_its_code():
    script = SCRIPTS / "draw_ext_map.py"
    drawing = PACKAGE / "inherited" / "drawing"
    used = {script, drawing / "style.py", drawing / "style.mplstyle"}
    assert used <= {*sources([script])}


@pytest.fixture
def digest(tmp_path):
    """The digest of a text of Python."""

    def of(text):
        path = tmp_path / "a.py"
        path.write_bytes(text.encode())
        module.imported.cache_clear()
        module.reads_docstrings.cache_clear()
        return module.digest_of(path)

    return of


CODE = '"""Twice."""\n\n\ndef twice(x):\n    # By a sum.\n    return x + x\n'


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("Twice", "Two\ntimes"),
        ("# By a sum.", "# Exactly."),
        ("    # By a sum.\n", '    """The double."""\n'),
        ("\n\n\n", "\n"),
        ("\n", "\r\n"),
    ],
)
def test_a_docstring_a_comment_and_the_end_of_a_line_are_no_code(digest, old, new):
    assert old in CODE
    assert digest(CODE.replace(old, new)) == digest(CODE)


@pytest.mark.parametrize(
    ("old", "new"),
    [("x + x", "x - x"), ("x + x", "x + x + 0"), ("return x", 'return "#", x'), ("x + x", "x +")],
)
def test_what_is_computed_is_code(digest, old, new):
    assert digest(CODE.replace(old, new)) != digest(CODE)


@pytest.mark.parametrize(
    "code",
    [
        "x = (\n    'a'\n)\n",
        "x = \\\n    'a'\n",
        "'a'; y = 1\n",
        'x = """\n# no comment\n"""\n',
        "x = ['b'\n'c']\n",
        "f'{x}'\n",
    ],
)
def test_a_text_that_is_a_value_is_code(code):
    assert without_remarks(code) == code.rstrip("\n")


@pytest.mark.parametrize("name", ["models/damping.py"])
def test_the_docstrings_of_models_are_no_code(digest, name):
    text = (PACKAGE / name).read_text(encoding="utf-8")
    edited = text.replace('    """', '    """In other words, ', 1)
    assert digest(edited) == digest(text)


def test_where_docstrings_are_read_they_are_code(digest):
    reader = "import inspect\n\nTEXT = inspect.getdoc(max)\n"
    assert digest(CODE + reader) != digest(CODE.replace("Twice", "Two times") + reader)


def test_a_line_follows_contents_and_names_and_not_times(tmp_path, monkeypatch):
    monkeypatch.setattr(module, "REPOSITORY", tmp_path)

    def line_of(name, text):
        path = tmp_path / name
        path.write_text(text, encoding="utf-8")
        os.utime(path, (0, 0))
        # As in another process, which has read nothing yet.
        module.line_of.cache_clear()
        return module.line_of(path)

    first = line_of("a.py", "r = 0.85")
    assert first == line_of("a.py", "r = 0.85") and first.endswith(" a.py")
    assert first != line_of("a.py", "r = 0.70")
    assert first != line_of("b.py", "r = 0.85")


def test_a_package_that_shadows_a_module_is_the_one_that_is_read(tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(tmp_path)
    (tmp_path / "bouncing_ball_x").mkdir()
    shadowed = tmp_path / "bouncing_ball_x" / "damping.py"
    shadowing = tmp_path / "bouncing_ball_x" / "damping" / "__init__.py"
    shadowing.parent.mkdir()
    (tmp_path / "bouncing_ball_x" / "__init__.py").touch()
    for path in (shadowed, shadowing):
        path.touch()
        module.files_of_module.cache_clear()
        assert module.files_of_module("bouncing_ball_x.damping")[1:] == [path]
    module.files_of_module.cache_clear()


def test_a_note_is_written_only_when_the_code_or_a_library_changes(tmp_path, monkeypatch):
    note = tmp_path / "fig02"
    source = tmp_path / "src" / "a.txt"
    source.parent.mkdir()
    source.write_text("one", encoding="utf-8")
    write_note(note, [source])
    os.utime(note, (0, 0))
    write_note(note, [source])
    assert note.stat().st_mtime == 0
    before = note.read_text()
    assert parts_of_note(before) == (lines_of([source]), ".") and "numpy" in before.splitlines()[3]
    source.write_text("two", encoding="utf-8")
    # As in another process, which has read nothing yet.
    module.line_of.cache_clear()
    write_note(note, [source])
    assert note.stat().st_mtime > 0 and parts_of_note(note.read_text()) != parts_of_note(before)
    os.utime(note, (0, 0))
    monkeypatch.setattr(module, "versions", lambda: {"numpy": "1.0"})
    write_note(note, [source])
    assert note.stat().st_mtime > 0
    # Whatever another program has written there.
    note.write_bytes(b"\xff\xfe")
    write_note(note, [source])
    assert "1.0 numpy" in note.read_text()


def test_no_module_imports_relatively():
    """Such an import has no full name, and would be missed."""
    found = [path for path in PACKAGE.rglob("*.py") if "from ." in path.read_text(encoding="utf-8")]
    assert found == []

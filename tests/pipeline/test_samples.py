"""Accepted samples against the code that computes them."""

from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from bouncing_ball.datasets.files import read_dataset, write_dataset
from bouncing_ball.pipeline import sources
from bouncing_ball.pipeline.samples import (
    COMPUTATION,
    CONTENT,
    computed_by,
    content_digest,
    outdated,
)

ROOT = Path(__file__).parents[2]
CODE = '"""Twice."""\n\n\ndef twice(x):\n    # By a sum.\n    return x + x\n'
SAME = '"""Two\ntimes."""\ndef twice(x):\n    """The double."""\n    return x + x  # exactly\n'


@pytest.fixture
def checkout(tmp_path, monkeypatch):
    """A repository with one module, and a sample that it has computed."""
    package = tmp_path / "src" / "bouncing_ball"
    (package / "models").mkdir(parents=True)
    (tmp_path / "config").mkdir()
    monkeypatch.setattr(sources, "REPOSITORY", tmp_path)
    module = package / "models" / "twice.py"
    module.write_text(CODE)
    errors = package / "errors.py"
    errors.write_text("WORDS = 'no'\n")
    data = xr.Dataset({"x": ((), 1.0)}, attrs=computed_by([module, errors]))
    write_dataset(data, tmp_path / "config" / "one.nc")
    return tmp_path


def test_no_accepted_sample_is_older_than_its_code():
    """`make samples`, `snakemake --cores 2 atlas` and `make test-engines` make them again."""
    assert outdated(ROOT) == {}


def test_comments_texts_and_other_modules_make_no_sample_older(checkout):
    package = checkout / "src" / "bouncing_ball"
    (package / "models" / "twice.py").write_text(SAME)
    sources.module.cache_clear()
    (package / "errors.py").write_text("WORDS = 'never'\n")
    (package / "models" / "other.py").write_text("y = 2\n")
    assert outdated(checkout) == {}


@pytest.mark.parametrize(
    "code", [CODE.replace("x + x", "x * 3"), CODE.replace("+ x", "+ x + 0"), None]
)
def test_a_sample_is_older_than_code_that_computes_something_else(checkout, code):
    module = checkout / "src" / "bouncing_ball" / "models" / "twice.py"
    if code is None:
        module.unlink()
    else:
        module.write_text(code)
    sources.module.cache_clear()
    assert outdated(checkout) == {"one.nc": "older than src/bouncing_ball/models/twice.py"}


def test_a_text_in_the_code_that_is_no_docstring_counts():
    text = 'NAMES = ["one"]\n\n\ndef f():\n    return "#"\n'
    assert sources.without_remarks(text) == text.replace("\n\n\n", "\n").rstrip()
    assert (
        sources.without_remarks('x = 1\n"""A field."""\ny = """a\nb"""\n')
        == 'x = 1\ny = """a\nb"""'
    )


@pytest.mark.parametrize(
    "change",
    [
        lambda data: data.assign(hidden=2 * data.hidden),
        lambda data: data.assign(names=("t", ["a", "c", ""])),
        lambda data: data.assign_attrs(title="Another"),
        lambda data: data.assign(x=data.x.assign_attrs(units="rad")),
    ],
)
def test_a_sample_that_was_changed_by_hand_is_named(checkout, change):
    """Also where no picture shows it; the digest survives that the file is written and read."""
    path = checkout / "config" / "two.nc"
    times = np.array([1.0, np.nan, -0.0])
    made = xr.Dataset(
        {
            "x": ((), 1.0, {"units": "1"}),
            "hidden": ("t", times.astype(np.float32)),
            "kinds": ("t", np.array([1, 2, 3], dtype=np.int8)),
            "sure": ("t", [True, False, True]),
            "names": ("t", ["a", "b", ""]),
        },
        {"t": -times},
        attrs=computed_by([checkout / "src" / "bouncing_ball" / "models" / "twice.py"]),
    )
    made.attrs |= {"title": "Two"}
    made.attrs[CONTENT] = content_digest(made)
    write_dataset(made, path, compressed=True)
    assert outdated(checkout) == {}
    write_dataset(change(read_dataset(path)), path)
    assert outdated(checkout) == {"two.nc": "its content was changed after it was computed"}


def test_the_files_of_a_sample_are_named_with_digests(checkout):
    recorded = computed_by([checkout / "src" / "bouncing_ball" / "models" / "twice.py"])[
        COMPUTATION
    ]
    (line,) = recorded.splitlines()
    digest, name = line.split(" ")
    assert name == "src/bouncing_ball/models/twice.py" and len(digest) == 12

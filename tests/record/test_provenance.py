"""Checksums, and the provenance as attributes."""

import hashlib
import json
import os
import struct
import sys
import zlib
from pathlib import Path
from types import SimpleNamespace

import pytest
import xarray as xr

import bouncing_ball
from bouncing_ball.configuration.yaml_file import read_yaml
from bouncing_ball.datasets.netcdf import write_dataset
from bouncing_ball.pipeline.job import provenance
from bouncing_ball.pipeline.sources import sources
from bouncing_ball.record import recipe as recipe_module
from bouncing_ball.record.carriers import read_attributes, read_provenance
from bouncing_ball.record.job_log import log_lines, read_log
from bouncing_ball.record.provenance import (
    LIBRARIES,
    Provenance,
    ProvenanceError,
    changes,
    dependent_digest,
    digest,
    file_digest,
    sources_digest,
)
from bouncing_ball.record.revision import Revision

ROOT = Path(bouncing_ball.__file__).resolve().parents[2]


def blank(width, height):
    """A PNG file up to where its pixels begin."""
    head = b"IHDR" + struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)
    length, crc, begun = struct.pack(">I", 13), struct.pack(">I", zlib.crc32(head)), b"\0\0\1\0IDAT"
    return b"\x89PNG\r\n\x1a\n" + length + head + crc + begun


LARGE = blank(9_000, 9_000)
COMMIT = "c" * 40
MODULES = sources("bouncing_ball.contacts.damping")
MADE = Provenance(
    commit=COMMIT,
    dirty="no",
    configuration="{}",
    target="results/paper.md",
    parameters=digest({}),
    sources=digest({"a.py": "b"}),
    lock="unknown",
    inputs=json.dumps({"results/figures/fig08.nc": digest(1)}),
    versions=json.dumps({"python": "3.11.7", "numpy": "2.4.0rc1"}),
)


class Files(list):
    """Files as Snakemake gives them to a script: a list, some of them named."""

    def __init__(self, source=(), other=()):
        super().__init__([*other, *source])
        self.source = list(source)

    def get(self, name, default):
        return getattr(self, name, default)


CONFIG = read_yaml(ROOT / "config" / "config.yaml")


@pytest.fixture
def job(monkeypatch):
    """What a script sees of Snakemake, and the script's own name."""
    monkeypatch.setattr(sys.modules["__main__"], "__file__", "somewhere/table.py", raising=False)
    monkeypatch.setattr(recipe_module, "revision", lambda _: Revision(COMMIT, "no"))

    def make(output="results/figures/fig11.png", inputs=(), params=None, config=CONFIG):
        return SimpleNamespace(
            scriptdir=str(ROOT / "workflow" / "scripts"),
            input=Files(MODULES, inputs),
            output=[output],
            params=params or {},
            log=["results/logs/fig11.log"],
            config=config,
        )

    return make


def test_a_checksum_is_sha256_of_canonical_json():
    expected = hashlib.sha256('{"a":[1,2.0],"ϖ":null}'.encode()).hexdigest()
    assert digest({"ϖ": None, "a": [1, 2.0]}) == expected
    assert digest({"a": 1}) != digest({"a": 1.0})


def test_parameters_of_a_job_with_inputs():
    own, one, two = (digest({"n": n}) for n in (1, 2, 3))
    # Its own and each input's count; the order and repetition of inputs do not.
    assert dependent_digest("", [one]) == dependent_digest("", [one, one]) == one
    both = dependent_digest(own, [one, two])
    assert both == dependent_digest(own, [two, one])
    others = [dependent_digest(own, []), dependent_digest("", [one, two]), one]
    others += [dependent_digest(digest({"n": 4}), [one, two]), dependent_digest(own, [one])]
    assert len({both, *others}) == 6


def test_sources_count_by_content_and_not_by_place(tmp_path, monkeypatch):
    package = Path(bouncing_ball.__file__).parent
    moved = tmp_path / "moved" / "bouncing_ball"
    copies = [moved / Path(file).relative_to(package) for file in MODULES]
    for file, copied in zip(MODULES, copies, strict=True):
        copied.parent.mkdir(parents=True, exist_ok=True)
        copied.write_bytes(Path(file).read_bytes())
    script = tmp_path / "workflow" / "scripts" / "table.py"
    script.parent.mkdir(parents=True)
    script.write_bytes((ROOT / "workflow" / "scripts" / "table.py").read_bytes())
    here = sources_digest([ROOT / "workflow" / "scripts" / "table.py", *MODULES], ROOT)
    monkeypatch.setattr(bouncing_ball, "__file__", str(moved / "__init__.py"))
    assert sources_digest([*copies, script], tmp_path) == here
    assert sources_digest(copies, tmp_path) != here
    script.write_text("changed = True\n", encoding="utf-8")
    assert sources_digest([*copies, script], tmp_path) != here


def test_what_a_job_gathers(job, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    data = "results/figures/fig11.nc"
    write_dataset(xr.Dataset(attrs={"provenance_parameters": digest({"n": 1})}), data)
    made = provenance(job(inputs=[data]))
    assert made.target == "results/figures/fig11.png" and made.parameters == digest({"n": 1})
    assert json.loads(made.inputs) == {data: file_digest(data)}
    assert list(json.loads(made.versions)) == ["python", *LIBRARIES]
    assert made.lock == file_digest(ROOT / "requirements.lock")
    script = ROOT / "workflow" / "scripts" / "table.py"
    assert made.sources == sources_digest([script, *MODULES], ROOT)
    assert (made.commit, made.dirty, made.configuration) == (COMMIT, "no", "{}")
    # It can be read back, from what it is written to.
    assert Provenance.of(made.attributes()) == made


def test_the_parameters_of_a_dataset_are_all_that_its_job_has(job):
    made = provenance(job("results/figures/fig08.nc", params={"n": 1}))
    assert made.parameters == digest({"n": 1}) and made.inputs == "{}"


def test_an_input_outside_the_run_is_named_as_in_the_repository(job, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    template = os.path.relpath(ROOT / "README.md")
    assert list(json.loads(provenance(job(inputs=[template])).inputs)) == ["README.md"]


def test_what_the_configuration_changes(job):
    config = CONFIG | {"figures": CONFIG["figures"] | {"fig11": {"restitution": 0.7}}}
    made = provenance(job(config=config))
    assert json.loads(made.configuration) == {"figures": {"fig11": {"restitution": 0.7}}}
    # The tree is as clean as it was.
    assert made.dirty == "no"
    assert changes({"ratio": 10000}, {"ratio": 1e4}) == {"ratio": 10000}
    assert changes({"a": {"b": [1, 2]}}, {"a": {"b": [1]}}) == {"a": {"b": [1, 2]}}
    assert changes({"new": {}}, {}) == {"new": {}}


@pytest.mark.parametrize(
    ("found", "dirty"), [("no", "yes"), ("yes", "yes"), ("unknown", "unknown")]
)
def test_a_package_from_elsewhere_marks_the_run_as_dirty(job, monkeypatch, found, dirty):
    monkeypatch.setattr(recipe_module, "revision", lambda _: Revision(COMMIT, found))
    assert provenance(job()).dirty == found
    elsewhere = SimpleNamespace(__file__="/other/src/bouncing_ball/__init__.py")
    monkeypatch.setattr(recipe_module, "bouncing_ball", elsewhere)
    assert provenance(job()).dirty == dirty


def test_a_log_says_what_its_job_wrote(tmp_path, one_line):
    file, log = tmp_path / "a.csv", tmp_path / "a.log"
    file.write_text("1", encoding="utf-8")
    log.write_text("\n".join(["a line", *log_lines([str(file)], MADE)]), encoding="utf-8")
    read = read_log(log)
    assert read.sums == {str(file): file_digest(file)} and read.provenance() == MADE
    log.write_text("\n".join(log_lines([str(file)])), encoding="utf-8")
    for without in (read_log(log), read_log(tmp_path / "no.log")):
        with pytest.raises(ProvenanceError) as error:
            without.provenance()
        one_line(error, str(without.path), "holds no provenance")


def test_attributes_and_back():
    attributes = MADE.attributes()
    assert len(attributes) == 9 and all(name[:11] == "provenance_" for name in attributes)
    assert Provenance.of(attributes | {"title": "more"}) == MADE
    del attributes["provenance_lock"]
    with pytest.raises(ProvenanceError, match="no attribute provenance_lock"):
        Provenance.of(attributes)


@pytest.mark.parametrize(
    ("name", "content", "said"),
    [
        ("a.png", None, "No such file or directory"),
        ("a.png", b"", "damaged"),
        ("a.png", b"\x89PNG\r\n\x1a\n", "damaged"),
        ("a.nc", b"CDF?", "damaged"),
        ("a.svg", b"<svg", "damaged"),
        (
            "a.svg",
            b'<svg xmlns:d="http://purl.org/dc/elements/1.1/"><d:description>A ball'
            b"</d:description></svg>",
            "damaged, or not ours",
        ),
        *(
            (
                "a.svg",
                b'<svg xmlns:d="http://purl.org/dc/elements/1.1/"><d:description>%b'
                b"</d:description></svg>" % text,
                "damaged, or not ours",
            )
            for text in (b"[1, 2]", b"3", b"null", b'"text"')
        ),
        ("a.png", LARGE, "cannot be read: more than 8388608 pixels"),
        ("a.svg", b'<!DOCTYPE svg [<!ENTITY a "a">]><svg/>', "cannot be read: defines entities"),
        ("a.jpg", b"", "is not one of .nc, .png, .svg"),
        ("a.svg", b"<svg/>", "carries no provenance: no attribute provenance_commit"),
    ],
)
def test_a_file_that_says_nothing_is_one_line(tmp_path, one_line, name, content, said):
    path = tmp_path / name
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(ProvenanceError) as error:
        read_provenance(path)
    one_line(error, str(path), said)


def test_attributes_of_a_dataset(tmp_path):
    path = tmp_path / "a.nc"
    write_dataset(xr.Dataset(attrs={"title": "ϖ", **MADE.attributes()}), path)
    assert read_attributes(path) == {"title": "ϖ", **MADE.attributes()}
    assert read_provenance(path) == MADE

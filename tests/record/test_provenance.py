"""Checksums, and the provenance as attributes."""

import hashlib
import json
import struct
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
from bouncing_ball.record import provenance as provenance_module
from bouncing_ball.record.carriers import read_attributes, read_provenance
from bouncing_ball.record.provenance import (
    LIBRARIES,
    Provenance,
    ProvenanceError,
    departure,
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


# Pillow warns above 9e7 pixels and refuses twice as many.
LARGE, TOO_LARGE = blank(10_000, 10_000), blank(20_000, 20_000)


class Files(list):
    """Files as Snakemake gives them to a script: a list, some of them named."""

    def __init__(self, source=(), other=()):
        super().__init__([*other, *source])
        self.source = list(source)

    def get(self, name, default):
        return getattr(self, name, default)


def job(folder, rule="fig11", output="results/figures/fig11.png", inputs=()):
    modules = sources("bouncing_ball.impacts.damping")
    return SimpleNamespace(
        rule=rule,
        scriptdir=str(folder / "workflow" / "scripts"),
        input=Files(modules, inputs),
        output=[output],
        config=read_yaml(ROOT / "config" / "config.yaml"),
    )


def test_a_checksum_is_sha256_of_canonical_json():
    expected = hashlib.sha256('{"a":[1,2.0],"ϖ":null}'.encode()).hexdigest()
    assert digest({"ϖ": None, "a": [1, 2.0]}) == expected
    assert digest({"a": 1}) != digest({"a": 1.0})


def test_parameters_of_a_job_with_inputs():
    own, one, two = {"n": 1}, digest({"n": 2}), digest({"n": 3})
    # Its own and each input's count; the order and repetition of inputs do not.
    assert dependent_digest({}, [one]) == dependent_digest({}, [one, one]) == one
    both = dependent_digest(own, [one, two])
    assert both == dependent_digest(own, [two, one])
    others = [dependent_digest(own, []), dependent_digest({}, [one, two]), one]
    others += [dependent_digest({"n": 2}, [one, two]), dependent_digest(own, [one])]
    assert len({both, *others}) == 6


def test_sources_count_by_content_and_not_by_place(tmp_path, monkeypatch):
    files = sources("bouncing_ball.impacts.damping")
    package = Path(bouncing_ball.__file__).parent
    moved = tmp_path / "moved" / "bouncing_ball"
    copies = [moved / Path(file).relative_to(package) for file in files]
    for file, copied in zip(files, copies, strict=True):
        copied.parent.mkdir(parents=True, exist_ok=True)
        copied.write_bytes(Path(file).read_bytes())
    here = sources_digest(files)
    assert here == sources_digest(reversed(files))
    monkeypatch.setattr(bouncing_ball, "__file__", str(moved / "__init__.py"))
    assert sources_digest(map(str, copies)) == here
    copies[-1].write_text("changed = True\n", encoding="utf-8")
    assert sources_digest(map(str, copies)) != here


def test_what_a_job_gathers(tmp_path):
    data = tmp_path / "fig11.nc"
    write_dataset(xr.Dataset(attrs={"provenance_parameters": "ab12"}), data)
    made = provenance(job(ROOT, inputs=[str(data)]), {})
    assert made.target == "results/figures/fig11.png" and made.parameters == "ab12"
    assert json.loads(made.inputs) == {str(data): file_digest(data)}
    assert list(json.loads(made.versions)) == ["python", *LIBRARIES]
    assert made.lock == file_digest(ROOT / "requirements.lock")
    assert made.sources == sources_digest(sources("bouncing_ball.impacts.damping"))


def test_a_dataset_is_asked_for_by_its_path(tmp_path):
    made = provenance(job(ROOT, rule="continuation", output="results/figures/fig08.nc"), {"n": 1})
    assert made.target == "results/figures/fig08.nc"
    assert made.parameters == digest({"n": 1}) and made.inputs == "{}"


def test_a_folder_without_git_and_lock_is_unknown(tmp_path):
    made = provenance(job(tmp_path), {})
    assert (made.commit, made.dirty, made.lock) == ("unknown", "unknown", "unknown")


def test_what_a_run_rests_on_besides_the_commit(tmp_path):
    (tmp_path / "config").mkdir()
    (tmp_path / "config" / "config.yaml").write_text("release: force\nratio: 1.0e+4\n")
    (tmp_path / "other" / "src").mkdir(parents=True)
    own = [str(tmp_path / "src" / "bouncing_ball" / "errors.py")]
    config = {"ratio": 1e4, "release": "force"}
    assert departure(tmp_path, config, own) == ""
    # A reason to accept decides nothing.
    assert departure(tmp_path, config | {"reason": "why"}, own) == ""
    for other in ({"release": "force"}, config | {"ratio": 10000}, config | {"release": "f"}):
        assert departure(tmp_path, other, own) == "the configuration is not config/config.yaml"
    for place in ("other/src/a.py", ".venv/lib/site-packages/bouncing_ball/a.py", "srcs/a.py"):
        said = departure(tmp_path, config, [*own, str(tmp_path / place)])
        assert said == "the package is not imported from src/ of the repository"


@pytest.mark.parametrize("found", ["no", "yes", "unknown"])
@pytest.mark.parametrize("changed", [False, True])
def test_a_departure_is_dirt(monkeypatch, found, changed):
    monkeypatch.setattr(provenance_module, "revision", lambda _: Revision("1f0e", found))
    one = job(ROOT)
    if changed:
        one.config["release"] = "force"
    expected = "yes" if changed and found == "no" else found
    assert provenance(one, {}).dirty == expected


def test_attributes_and_back():
    made = Provenance(*"abcdefgh")
    attributes = made.attributes()
    assert len(attributes) == 8 and all(name[:11] == "provenance_" for name in attributes)
    assert Provenance.of(attributes | {"title": "more"}) == made
    del attributes["provenance_lock"]
    with pytest.raises(ProvenanceError, match="no attribute provenance_lock"):
        Provenance.of(attributes)


@pytest.mark.parametrize(
    ("name", "content", "said"),
    [
        ("a.png", None, "no such file"),
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
        ("a.png", LARGE, "cannot be read: too large a picture"),
        ("a.png", TOO_LARGE, "cannot be read: too large a picture"),
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
    attributes = Provenance(*"abcdefgh").attributes()
    write_dataset(xr.Dataset(attrs={"title": "ϖ", **attributes}), path)
    assert read_attributes(path) == {"title": "ϖ", **attributes}
    assert read_provenance(path) == Provenance(*"abcdefgh")

"""``bouncing-ball explain``: where a file comes from, and how to make it again."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
import xarray as xr
from matplotlib.figure import Figure

import bouncing_ball
from bouncing_ball.cli.main import main
from bouncing_ball.datasets.netcdf import write_dataset
from bouncing_ball.figures.files import save
from bouncing_ball.record import carriers
from bouncing_ball.record import explain as explain_module
from bouncing_ball.record.provenance import Provenance, digest, file_digest, versions
from bouncing_ball.record.reading import UnreadableError
from bouncing_ball.record.revision import Revision

ROOT = Path(bouncing_ball.__file__).resolve().parents[2]
COMMIT, OTHER = "a" * 40, "b" * 40


def provenance(
    target, *, commit=COMMIT, dirty="no", inputs=None, python="3.11.7", configuration=None
):
    return Provenance(
        commit=commit,
        dirty=dirty,
        configuration=json.dumps(configuration or {}),
        target=target,
        parameters=digest({"restitution": 0.85}),
        sources=digest({}),
        lock=file_digest(ROOT / "requirements.lock"),
        inputs=json.dumps(inputs or {}),
        versions=json.dumps(versions() | {"python": python}),
    ).attributes()


@pytest.fixture
def results(tmp_path, monkeypatch):
    """A folder with a dataset, its figure, its table and the paper."""
    monkeypatch.setattr(explain_module, "revision", lambda _: Revision(COMMIT, "no"))
    monkeypatch.chdir(tmp_path)
    figures = tmp_path / "results" / "figures"
    attributes = {"title": "stage", "references": "paper", "restitution": 0.85, "n": [1, 2]}
    made = provenance("results/figures/fig08.nc")
    write_dataset(xr.Dataset(attrs=attributes | made), figures / "fig08.nc")
    inputs = {"results/figures/fig08.nc": file_digest(figures / "fig08.nc")}
    for kind in ("png", "svg"):
        save(
            Figure(),
            figures / f"fig08.{kind}",
            provenance("results/figures/fig08.png", inputs=inputs),
        )
    (figures / "fig08.csv").write_text("r\n0.85\n", encoding="utf-8")
    (tmp_path / "results" / "paper.md").write_text("# Text\n", encoding="utf-8")
    return tmp_path / "results"


def asked(capsys, file):
    main(["explain", str(file), "--json"])
    out, err = capsys.readouterr()
    assert err == "" and out.count("\n") == 1
    return json.loads(out)


def test_a_picture(results, capsys):
    answer = asked(capsys, "results/figures/fig08.png")
    assert answer == asked(capsys, "results/figures/fig08.svg") | {
        "file": "results/figures/fig08.png",
        "read_from": "results/figures/fig08.png",
    }
    assert answer["artifact"] == "fig08, a picture"
    assert answer["commit"] == COMMIT and answer["checked_out"] is True
    assert answer["dirty"] == "no" and answer["lock"]["unchanged"] is True
    assert answer["parameters"]["values"] == {"restitution": 0.85, "n": [1, 2]}
    assert [(item["path"], item["state"]) for item in answer["inputs"]] == [
        ("results/figures/fig08.nc", "unchanged")
    ]
    running = versions()
    assert answer["versions"] == {
        name: {"made_with": made, "running": running[name]}
        for name, made in (running | {"python": "3.11.7"}).items()
    }
    assert answer["make_again"] == ["snakemake --cores 2 --force results/figures/fig08.png"]


def test_readable(results, capsys):
    main(["explain", "results/figures/fig08.png"])
    out = capsys.readouterr().out
    assert f"commit                          {COMMIT} (checked out)\n" in out
    assert "tree                            clean\n" in out
    assert "  restitution                   0.85\n" in out
    assert (
        "make it again                   snakemake --cores 2 --force results/figures/fig08.png\n"
        in out
    )


@pytest.mark.parametrize(
    ("file", "artifact", "target"),
    [
        ("figures/fig08.nc", "fig08, a dataset", "results/figures/fig08.nc"),
        ("figures/fig08.csv", "fig08, a table", "results/figures/fig08.csv"),
        ("paper.md", "paper, a text", "results/paper.md"),
    ],
)
def test_other_artifacts(results, capsys, file, artifact, target):
    answer = asked(capsys, results / file)
    assert answer["artifact"] == artifact and answer["commit"] == COMMIT
    assert answer["make_again"] == [f"snakemake --cores 2 --force {target}"]


def test_the_paper_of_several_commits(results, capsys):
    write_dataset(
        xr.Dataset(attrs=provenance("results/figures/fig09.nc", commit=OTHER)),
        results / "figures" / "fig09.nc",
    )
    answer = asked(capsys, results / "paper.md")
    assert answer["read_from"] == "2 datasets" and answer["commit"] == "several"
    assert answer["make_again"] == ["snakemake --cores 2 --force results/paper.md"]


def test_the_accepted_record(results, capsys):
    # figures/ in place of results/figures/: the dataset is the one next to it.
    shutil.move(results / "figures", results.parent / "figures")
    answer = asked(capsys, results.parent / "figures" / "fig08.png")
    assert answer["inputs"][0]["state"] == "unchanged"
    assert answer["parameters"]["values"]["restitution"] == 0.85


def test_a_file_copied_elsewhere(results, capsys, tmp_path_factory, monkeypatch):
    elsewhere = tmp_path_factory.mktemp("elsewhere")
    shutil.copy(results / "figures" / "fig08.png", elsewhere / "renamed.png")
    monkeypatch.chdir(elsewhere)
    monkeypatch.setattr(explain_module, "checkout", lambda *starts: None)
    answer = asked(capsys, "renamed.png")
    assert answer["artifact"] == "fig08, a picture" and answer["commit"] == COMMIT
    assert answer["checked_out"] is None and answer["lock"]["unchanged"] is None
    assert answer["inputs"][0]["state"] == "not found"
    assert answer["parameters"]["values"] == {}
    assert answer["make_again"][0] == f"git checkout {COMMIT}"


def test_a_dataset_that_has_changed_since(results, capsys):
    data = results / "figures" / "fig08.nc"
    write_dataset(xr.Dataset(attrs={"restitution": 0.9}), data)
    answer = asked(capsys, results / "figures" / "fig08.png")
    assert answer["inputs"][0]["state"] == "changed"
    # Its parameters are not those of the picture.
    assert answer["parameters"]["values"] == {}


def test_another_commit_dirt_and_other_versions(results, capsys):
    path = results / "figures" / "fig01.png"
    save(
        Figure(),
        path,
        provenance("results/figures/fig01.png", commit=OTHER, dirty="yes", python="3.99.0"),
    )
    answer = asked(capsys, path)
    assert answer["checked_out"] is False
    make = "snakemake --cores 2 --force results/figures/fig01.png"
    assert answer["make_again"] == [f"git checkout {OTHER}", "make setup", make]
    main(["explain", str(path)])
    out = capsys.readouterr().out
    assert f"{OTHER} (not checked out)" in out and "3.99.0 (running: " in out
    assert "dirty: the commit alone does not give this file" in out
    assert f"git checkout {OTHER} && make setup && {make}\n" in out


@pytest.mark.parametrize(
    ("file", "said"),
    [
        ("nothing.png", "cannot be read: no such file"),
        ("results", "cannot be read: a folder"),
        ("foreign.png", "carries no provenance: no attribute provenance_commit"),
        ("notes.md", "is not an artifact of this workflow: there is no notes.nc next to it"),
        ("paper.md", "is not an artifact of this workflow: there is no figures/*.nc next to it"),
        ("cut.nc", "cannot be read: damaged, not ours, or larger than memory"),
    ],
)
def test_a_file_that_is_not_ours_exits_2_with_one_line(results, capsys, file, said):
    Figure().savefig("foreign.png")
    for name in ("notes.md", "paper.md", "cut.nc"):
        Path(name).write_bytes(b"text")
    with pytest.raises(SystemExit) as exit_:
        main(["explain", file])
    lines = capsys.readouterr().err.splitlines()
    assert exit_.value.code == 2 and len(lines) == 1
    assert lines[0].startswith(f"bouncing-ball: {file} ") and said in lines[0]


def test_another_configuration_is_named_and_written_again(results, capsys):
    changed = {"figures": {"fig11": {"restitution": 0.7, "tolerance": 1e-12}}, "release": "it's"}
    path = results / "figures" / "fig11.png"
    save(Figure(), path, provenance("results/figures/fig11.png", configuration=changed))
    answer = asked(capsys, path)
    assert answer["dirty"] == "no"
    assert answer["configuration"] == {
        "figures.fig11.restitution": 0.7, "figures.fig11.tolerance": 1e-12, "release": "it's"
    }  # fmt: skip
    write, make = answer["make_again"]
    subprocess.run(["sh", "-c", write], check=True)
    written = results / "configuration.json"
    assert json.loads(written.read_text(encoding="utf-8")) == changed
    assert make == (
        "snakemake --cores 2 --force results/figures/fig11.png "
        "--configfile results/configuration.json"
    )
    main(["explain", str(path)])
    out = capsys.readouterr().out
    assert "tree                            clean\n" in out
    assert "configuration                   config/config.yaml with other values:\n" in out
    assert "  figures.fig11.restitution     0.7\n" in out


def failed(capsys, path, *arguments):
    with pytest.raises(SystemExit) as exit_:
        main(["explain", str(path), *arguments])
    said = capsys.readouterr().err
    assert exit_.value.code == 2 and said.count("\n") == 1 and said[:-1].isprintable()
    return said


def test_a_truncated_dataset_is_one_line(results, capsys):
    path = results / "figures" / "fig08.nc"
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
    assert "damaged" in failed(capsys, path)


def test_a_picture_is_explained_though_its_dataset_is_damaged(results, capsys):
    (results / "figures" / "fig08.nc").write_bytes(b"\x89HDF")
    answer = asked(capsys, results / "figures" / "fig08.png")
    assert answer["inputs"][0]["state"] == "changed"
    assert answer["parameters"]["values"] == {}


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("commit", 7),
        ("commit", "a" * 39 + "\x1b"),
        ("dirty", "no\n"),
        ("target", "results/figures/fig08.nc; date"),
        ("target", "results/../../x.nc"),
        ("target", "--cores"),
        ("lock", ""),
        ("inputs", "[1, 2]"),
        ("inputs", '{"../secret": "%s"}' % ("0" * 64)),
        ("inputs", '{"/dev/zero": "%s"}' % ("0" * 64)),
        ("inputs", '{"a.nc": 1}'),
        ("inputs", "[" * 5000),
        ("versions", '{"numpy": "$(date)"}'),
        ("configuration", '{"`date`": 1}'),
        ("configuration", '{"n": %s}' % ("9" * 5000)),
        ("configuration", "x" * 200_000),
    ],
)
def test_what_stands_in_a_file_is_of_its_form(results, capsys, name, value):
    path = results / "figures" / "fig09.nc"
    made = provenance("results/figures/fig09.nc") | {f"provenance_{name}": value}
    write_dataset(xr.Dataset(attrs=made), path)
    said = failed(capsys, path)
    assert f"carries no provenance: attribute provenance_{name} is malformed" in said


def test_parameters_are_printed_harmlessly(results, capsys):
    path = results / "figures" / "fig09.nc"
    hostile = {
        "a": float("nan"),
        "b": [1.0, float("inf")],
        "c": "\x1b[2J\nforged   line",
        "d": "x" * 9999,
    }
    write_dataset(xr.Dataset(attrs=hostile | provenance("results/figures/fig09.nc")), path)
    values = asked(capsys, path)["parameters"]["values"]
    assert values["a"] == "nan" and values["b"] == [1.0, "inf"] and values["c"] == hostile["c"]
    main(["explain", str(path)])
    out = capsys.readouterr().out
    assert all(line.isprintable() and len(line) < 400 for line in out.splitlines())
    assert "\\x1b[2J\\nforged" in out


def test_links_and_pipes_and_large_files_are_not_read(results, capsys):
    figures = results / "figures"
    (figures / "link.png").symlink_to(figures / "fig08.png")
    os.mkfifo(figures / "pipe.nc")
    with open(figures / "large.svg", "wb") as file:
        file.truncate(2**40)
    assert "a link; links are not followed" in failed(capsys, figures / "link.png")
    assert "not a regular file" in failed(capsys, figures / "pipe.nc")
    assert "larger than" in failed(capsys, figures / "large.svg")


@pytest.mark.parametrize(
    "name", ["x" * 5000 + ".png", "a/" * 2500 + "b.nc", "x" * 5000 + "/paper.md"]
)
def test_a_path_that_no_file_can_have(results, capsys, name):
    said = failed(capsys, name)
    assert "cannot be read: File name too long" in said and len(said) < 400


def test_a_name_with_controls(results, capsys):
    shutil.copy(results / "figures" / "fig08.png", results / "a\x1b[2J\nb.png")
    main(["explain", str(results / "a\x1b[2J\nb.png")])
    assert all(line.isprintable() for line in capsys.readouterr().out.splitlines())
    failed(capsys, results / "no\x1b[2J\nsuch.png")


def test_a_file_that_may_not_be_read(results, capsys, monkeypatch):
    def refuse(folder, file):
        raise UnreadableError("Permission denied")

    monkeypatch.setattr(carriers, "read_file", refuse)
    said = failed(capsys, results / "figures" / "fig08.png")
    assert said.endswith("cannot be read: Permission denied\n")


def test_a_mistake_is_answered_before_anything_large_is_imported():
    program = (
        "import sys\nfrom bouncing_ball.cli.main import main\n"
        "try:\n    main(['explain', 'nothing.png'])\nexcept SystemExit:\n    pass\n"
        "print(*{'scipy', 'matplotlib', 'xarray'} & set(sys.modules))"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    assert done.stdout.strip() == ""

"""Folders made to mislead: every part is judged alone, and what cannot be read is named."""

import os

import pytest
from netCDF4 import Dataset

from bouncing_ball.cli.main import main
from bouncing_ball.compare.outcome import Outcome, status
from bouncing_ball.compare.report_html import to_html
from bouncing_ball.compare.report_json import to_json
from bouncing_ball.compare.report_markdown import to_markdown
from bouncing_ball.compare.report_terminal import to_terminal
from bouncing_ball.record.reading import reason


def unreadable(pair, file, note):
    """One file is unreadable, by name and reason, and the others are as they were."""
    comparison = pair.compare()
    found = {part.file: part for each in comparison.artifacts for part in each.parts}
    part = found.pop(file)
    assert part.outcome is Outcome.UNREADABLE and note in part.note, part.note
    assert "\n" not in part.note and str(pair.new) not in part.note
    words = (".csv", ".md", ".tex")
    assert {each.outcome for each in found.values() if not each.file.endswith(words)} == {
        Outcome.IDENTICAL
    }
    assert status(comparison.outcome) == 2
    for report in (to_terminal, to_markdown, to_html, to_json):
        assert "unreadable" in report(comparison)
    return part


@pytest.mark.parametrize(
    ("owner", "name", "value"),
    [
        ("phase", "scale_factor", "abc"),
        ("phase", "_Encoding", "utf-99"),
        ("phase", "coordinates", 7),
        (None, "coordinates", 7),
    ],
)
def test_attributes_that_mean_nothing(pair, owner, name, value):
    with Dataset(pair.new / "figures" / "fig05.nc", "a") as data:
        (data if owner is None else data[owner]).setncattr(name, value)
    assert not pair.artifact("fig05").outcome.agrees
    others = {found.outcome for found in pair.compare().artifacts if found.name != "fig05"}
    assert others == {Outcome.IDENTICAL}


def test_a_zeroed_block(pair):
    path = pair.new / "figures" / "fig05.nc"
    content = path.read_bytes()
    path.write_bytes(content[:4000] + bytes(4000) + content[8000:])
    unreadable(pair, "figures/fig05.nc", "new: ")


def test_a_dataset_of_more_than_memory_holds(pair):
    with Dataset(pair.new / "figures" / "fig05.nc", "w") as data:
        data.createDimension("t", 10**12)
        data.createVariable("phase", "f8", ("t",), chunksizes=(1000,), compression="zlib")
    unreadable(pair, "figures/fig05.nc", "values")


def test_deep_json_in_the_versions(pair):
    with Dataset(pair.new / "figures" / "fig05.nc", "a") as data:
        data.setncattr("provenance_versions", "[" * 100_000)
    assert pair.artifact("fig05").outcome is Outcome.IDENTICAL


@pytest.mark.parametrize("file", ["figures/fig05.nc", "figures/fig05.png", "paper.md"])
def test_a_sparse_file(pair, file):
    with open(pair.new / file, "r+b") as large:
        large.truncate(50 * 10**9)
    unreadable(pair, file, "new: larger than")


@pytest.mark.parametrize("file", ["figures/table1.csv", "figures/fig05.png", "paper.md"])
def test_a_link_to_a_private_file(pair, file):
    secret = pair.new.parent / "private"
    # A picture, so that it would be embedded.
    secret.write_bytes((pair.record / "figures" / "fig01.png").read_bytes())
    (pair.new / file).unlink()
    (pair.new / file).symlink_to(secret)
    part = unreadable(pair, file, "new: a link; links are not followed")
    assert part.images == (None, None)


def test_an_unreadable_picture_that_the_record_has_not(pair):
    (pair.new / "figures" / "extra.png").write_bytes(b"\x89PNG\r\n\x1a\n")
    unreadable(pair, "figures/extra.png", "new: not a PNG file")


def test_a_number_beyond_all_numbers(pair):
    path = pair.new / "figures" / "table1.csv"
    text = path.read_text(encoding="utf-8")
    path.write_text(text.replace("0.23999", "1e99999999999999999999", 1), encoding="utf-8")
    assert pair.part("figures/table1.csv").outcome is Outcome.DRIFTED


NAMES = [os.fsdecode(b"\xff"), "a\x1b[2J\nfig01  identical", "<script>f()<", "\u202e", "a|b`"]


@pytest.mark.parametrize("name", NAMES)
def test_names_are_not_printed_raw(pair, name, capsys, tmp_path):
    for folder in (pair.record, pair.new):
        (folder / "figures" / f"{name}.csv").write_text(f"{name!a}\n")
    (pair.new / "figures" / f"{name}.csv").write_text("b\n")
    files = {kind: tmp_path / kind for kind in ("json", "markdown", "html")}
    options = [str(part) for kind, path in files.items() for part in (f"--{kind}", path)]
    with pytest.raises(SystemExit) as exit_:
        main(["diff", str(pair.record), str(pair.new), *options])
    assert exit_.value.code == 1
    out = capsys.readouterr().out
    for text in (out, *(path.read_text(encoding="utf-8") for path in files.values())):
        assert all(line.isprintable() for line in text.split("\n"))
    lines = [line for line in out.splitlines() if "drifted" in line]
    assert len(lines) == 2
    assert "<script" not in files["html"].read_text(encoding="utf-8")


def test_attributes_are_not_printed_raw(pair):
    data = pair.dataset("fig05").assign_attrs({"n": "\x1b]0;x\x07\n1 identical. \u202e<script>"})
    pair.write("fig05", data)
    comparison = pair.compare()
    for report in (to_terminal, to_markdown, to_html, to_json):
        text = report(comparison)
        assert all(line.isprintable() for line in text.split("\n"))
        assert "\\x1b]0;x" in text.replace("\\\\", "\\").replace("\\]", "]")
    assert "<script" not in to_html(comparison)


def test_what_nobody_thought_of_is_one_line_and_status_two(pair, monkeypatch, capsys):
    def fail(*_):
        raise MemoryError

    monkeypatch.setattr("bouncing_ball.compare.reports.compare_folders", fail)
    with pytest.raises(SystemExit) as exit_:
        main(["diff", str(pair.record), str(pair.new)])
    out, err = capsys.readouterr()
    assert (exit_.value.code, out, err) == (2, "", "bouncing-ball: MemoryError\n")
    assert reason(MemoryError()) == "MemoryError"


def test_time_is_bounded(pair, monkeypatch):
    monkeypatch.setattr("bouncing_ball.compare.folders._SECONDS", -1.0)
    comparison = pair.compare()
    assert status(comparison.outcome) == 2
    assert "not compared" in to_terminal(comparison)

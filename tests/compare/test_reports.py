"""The reports: complete, escaped, reproducible, and the exit status of the command."""

import io
import json
import re
import shutil
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path

import pytest
from PIL import Image

from bouncing_ball.cli.main import main
from bouncing_ball.compare.report_html import to_html
from bouncing_ball.compare.report_json import to_json
from bouncing_ball.compare.report_markdown import to_markdown
from bouncing_ball.compare.report_terminal import to_terminal
from bouncing_ball.datasets.netcdf import write_dataset

ROOT = Path(__file__).resolve().parents[2]
TOLERANCES = ROOT / "config" / "tolerances.yaml"


def command(capsys, *arguments):
    """Exit status, standard output and standard error of ``bouncing-ball diff``."""
    with pytest.raises(SystemExit) as exit_:
        main(["diff", *map(str, arguments)])
    out, err = capsys.readouterr()
    return exit_.value.code, out, err


@pytest.fixture(scope="module")
def changed(kept_pair):
    """One artifact of each outcome but the last."""
    pair = kept_pair
    data = pair.dataset("fig05")
    data.phase.values[1, 40] += 1e-3
    pair.write("fig05", data)
    data = pair.dataset("fig08")
    data.phase.values[0, 40] += 1e-9
    pair.write("fig08", data)
    pair.write("fig09", pair.dataset("fig09").drop_vars("admissible"))
    (pair.new / "figures" / "table1.tex").unlink()
    shutil.copyfile(pair.new / "figures" / "fig01.png", pair.new / "figures" / "fig99.png")
    return pair


@pytest.fixture(scope="module")
def comparison(changed):
    return changed.compare()


def test_the_terminal_in_short(comparison):
    lines = to_terminal(comparison).splitlines()
    assert lines[0].split() == ["artifact", "outcome", "of", "budget", "what"]
    assert [line.split()[0] for line in lines[1:-1]] == [
        "fig99",
        "table1",
        "fig09",
        "fig05",
        "fig08",
    ]
    assert lines[1].split()[1:] == ["extra", "figures/fig99.png", "extra"]
    assert "changed structure" in lines[3] and "admissible: is gone" in lines[3]
    assert "phase at case = 1, frequency_ratio = 2.51189" in lines[4]
    assert lines[-1] == (
        "1 extra, 1 missing, 1 changed structure, 1 drifted, 1 within budget, 3 identical. "
        "The new artifacts differ from the record."
    )


def test_json_holds_everything(changed, comparison):
    content = json.loads(to_json(comparison))
    assert content["status"] == 1 and content["outcome"] == "extra"
    assert [found["name"] for found in content["artifacts"]][:2] == ["fig99", "table1"]
    found = {each["name"]: each for each in content["artifacts"]}
    variables = {each["name"]: each for each in found["fig05"]["parts"][0]["variables"]}
    phase = variables["phase"]
    assert phase["outcome"] == "drifted" and phase["mode"] == "pointwise"
    assert phase["share"] == pytest.approx(phase["drift"] / phase["budget"])
    assert float(phase["new"]) - float(phase["record"]) == pytest.approx(1e-3)
    assert set(variables) == {str(name) for name in changed.dataset("fig05").variables}
    files = {part["file"] for each in content["artifacts"] for part in each["parts"]}
    assert {"paper.md", "figures/fig99.png", "figures/witness.csv"} <= files


def test_markdown_is_one_table(comparison):
    text = to_markdown(comparison)
    rows = [line for line in text.splitlines() if line.startswith("|")]
    # Header, rule, and one row for each artifact that is not identical.
    assert len(rows) == 2 + 5
    assert all(len(re.findall(r"(?<!\\)\|", row)) == 5 for row in rows)
    assert "**drifted**" in text and "| within budget |" in text
    assert "frequency\\_ratio" in text


def test_all_text_is_escaped(pair):
    path = pair.new / "figures" / "table1.csv"
    text = path.read_text(encoding="utf-8")
    bad = "<script>alert('|')</script>`*"
    path.write_text(text.replace("computed", bad, 1), encoding="utf-8")
    comparison = pair.compare()
    page, summary = to_html(comparison), to_markdown(comparison)
    assert "<script" not in page and "&lt;script&gt;" in page
    assert bad not in summary and "\\<script\\>" in summary and "\\|" in summary
    assert json.loads(to_json(comparison))["outcome"] == "drifted"


def test_the_page_fetches_nothing(comparison):
    page = to_html(comparison)
    assert (
        re.findall(r"(?:src|href|action|data|poster)\s*=\s*[\"'](?!data:image/png;|#)", page) == []
    )
    assert "url(" not in page and "@import" not in page and "<script" not in page
    assert not re.search(r"https?:", page)


def test_pictures_that_are_the_same_are_there_once(pair, comparison):
    # Those of four artifacts, and one that the record has not.
    assert to_html(comparison).count("<img") == 5
    shutil.copyfile(pair.new / "figures" / "fig08.png", pair.new / "figures" / "fig09.png")
    page = to_html(pair.compare())
    # Record, new and difference of that one, and three that are the same.
    assert page.count("<img") == 6
    assert "difference, × 1" in page


def test_a_drift_is_drawn_along_its_curve_and_its_values_are_named(pair):
    data = pair.dataset("fig08")
    data.phase.values[0, 100:150] += 0.02
    pair.write("fig08", data)
    found = pair.variable("fig08", "phase")
    ((label, shares),) = found.trace.lines
    assert found.trace.along == "point" and label.startswith("frequency_ratio = ")
    assert max(shares) == found.share == found.trace.largest[0].share > 100
    # Two samples of the curve to a column.
    over = [column for column, share in enumerate(shares) if share > 1]
    assert (over[0], over[-1]) == (50, 74)
    for each in found.trace.largest:
        assert float(each.new) - float(each.record) == pytest.approx(0.02)
    page = to_html(pair.compare())
    assert "phase: drift over its budget, along point" in page
    assert len(re.findall(r'<path class="dots', page)) == 1
    # Every value of the largest ones, with its digits marked.
    texts = re.sub(r"</?mark>", "", page)
    for each in found.trace.largest:
        assert each.place in texts and f">{each.record}<" in texts and f">{each.new}<" in texts


def test_where_both_sides_come_from(pair):
    made = {name: pair.dataset("fig05").attrs[f"provenance_{name}"] for name in ("commit", "lock")}
    for folder, lock in ((pair.record, made["lock"]), (pair.new, "a" * 64)):
        data = pair.dataset("fig05")
        data.attrs |= {"provenance_configuration": "{}", "provenance_lock": lock}
        versions = json.loads(data.attrs["provenance_versions"])
        if folder == pair.new:
            data.attrs |= {"provenance_commit": "b" * 40}
            versions["scipy"] = "9.9"
        data.attrs["provenance_versions"] = json.dumps(versions)
        write_dataset(data, folder / "figures" / "fig05.nc")
    comparison = pair.compare()
    page = to_html(comparison)
    assert made["commit"][:10] in page and "b" * 10 in page
    assert f"another requirements.lock, scipy {version('scipy')} → 9.9" in page
    found = {each["name"]: each for each in json.loads(to_json(comparison))["artifacts"]}
    part = found["fig05"]["parts"][0]
    assert part["made"]["record"]["commit"] == made["commit"]
    assert part["made"]["new"]["versions"]["scipy"] == "9.9"
    assert part["made"]["otherwise"] == ["another requirements.lock"]


def test_the_number_of_changed_pixels(pair):
    path = pair.new / "figures" / "fig08.png"
    # Of full size, as the record has it.
    shutil.copyfile(ROOT / "figures" / path.name, pair.record / "figures" / path.name)
    with Image.open(ROOT / "figures" / path.name) as picture:
        changed = picture.convert("RGB")
    for x in range(7):
        changed.putpixel((x, 0), (0, 0, 0))
    changed.save(path)
    part = pair.part("figures/fig08.png")
    assert part.picture.changed == 7 and "7 of " in part.note and part.outcome.agrees
    # Seven pixels of two million are seen all the same.
    with Image.open(io.BytesIO(part.picture.difference)) as picture:
        assert picture.getpixel((0, 0)) == (110, 0, 80) and picture.getpixel((20, 20))[0] == 255
    assert "7 of " in to_html(pair.compare())


def test_a_page_has_no_more_room_than_it_has(comparison, monkeypatch):
    whole = to_html(comparison)
    monkeypatch.setattr("bouncing_ball.compare.report_html._LARGEST", 1)
    page = to_html(comparison)
    # One artifact whole, the others by name and outcome.
    assert page.count("no more room") == len(comparison.artifacts) - 1
    assert len(page) < len(whole) / 2
    assert re.findall(r"<section id=\S+", page) == re.findall(r"<section id=\S+", whole)


def test_reports_are_the_same_every_time_and_name_no_folder(changed, capsys, tmp_path):
    for run in ("one", "two"):
        (tmp_path / run).mkdir()
        files = {kind: tmp_path / run / f"report.{kind}" for kind in ("json", "markdown", "html")}
        options = [part for kind, path in files.items() for part in (f"--{kind}", path)]
        call = (changed.record, changed.new, "--tolerances", TOLERANCES, *options)
        code, out, err = command(capsys, *call)
        assert (code, err) == (1, "")
        (tmp_path / run / "terminal").write_text(out, encoding="utf-8")
    written = sorted(path.name for path in (tmp_path / "one").iterdir())
    assert written == ["report.html", "report.json", "report.markdown", "terminal"]
    for name in written:
        content = (tmp_path / "one" / name).read_bytes()
        assert content == (tmp_path / "two" / name).read_bytes()
        assert str(tmp_path).encode() not in content


def test_exit_status(pair, capsys):
    call = (pair.record, pair.new, "--tolerances", TOLERANCES)
    assert command(capsys, *call)[0] == 0
    (pair.new / "paper.md").write_text("another text\n", encoding="utf-8")
    code, out, _ = command(capsys, *call)
    assert code == 1 and "paper.md, line 1: " in out and "→ another text" in out
    (pair.new / "paper.md").unlink()
    assert command(capsys, *call)[0] == 1
    (pair.new / "figures" / "fig05.nc").write_bytes(b"no dataset")
    assert command(capsys, *call)[0] == 2


def test_where_the_tolerances_come_from(pair, capsys, monkeypatch):
    # A folder that was sent may bring loose budgets with it: this checkout's hold.
    data = pair.dataset("fig05")
    data.phase.values[1, 40] += 1e-3
    pair.write("fig05", data)
    (pair.record / "config").mkdir()
    sent = pair.record / "config" / "tolerances.yaml"
    sent.write_text(TOLERANCES.read_text(encoding="utf-8").replace("1.0e-13", "1.0e+3"))
    monkeypatch.chdir(pair.record.parent)
    code, out, _ = command(capsys, "record", "new")
    assert code == 1 and out.startswith(f"Budgets: {TOLERANCES}\n")
    # Without a checkout there are no others, and it is said which.
    monkeypatch.setattr("bouncing_ball.record.revision.checkout", lambda *_: None)
    code, out, _ = command(capsys, "record", "new")
    assert code == 0 and out.startswith("Budgets: record/config/tolerances.yaml\n")
    assert command(capsys, "record", "new", "--tolerances", TOLERANCES)[0] == 1
    sent.unlink()
    sent.symlink_to(TOLERANCES)
    code, _, err = command(capsys, "record", "new")
    assert code == 2 and "a link" in err


def test_one_artifact_or_several(pair, capsys, tmp_path):
    data = pair.dataset("fig05")
    data.phase.values[1, 40] += 1e-3
    pair.write("fig05", data)
    report = tmp_path / "report.json"
    call = (pair.record, pair.new)
    options = ("--tolerances", TOLERANCES, "--json", report)
    for names, code in ((["fig08"], 0), (["fig05"], 1), (["paper", "fig08"], 0), (["paper"], 0)):
        assert command(capsys, *call, *names, *options)[0] == code, names
        content = json.loads(report.read_text(encoding="utf-8"))
        assert {found["name"] for found in content["artifacts"]} == set(names)
    code, out, err = command(capsys, *call, "fig08", "fig80", *options)
    assert (code, out) == (2, "") and err.count("\n") == 1
    assert "unknown artifact fig80; known: fig01, fig05, " in err


def test_what_cannot_be_compared_at_all_is_one_line(pair, capsys, tmp_path):
    empty = tmp_path / "empty"
    empty.mkdir()
    known = ("--tolerances", TOLERANCES)
    for arguments, said in (
        ((tmp_path / "nowhere", pair.new, *known), "no folder"),
        ((pair.record, empty, *known), "nothing to compare"),
        ((pair.record, pair.new / "paper.md", *known), "no folder"),
        ((pair.record, pair.new, "--tolerances", tmp_path / "none.yaml"), "No such file"),
        ((pair.record, pair.new, *known, "--json", pair.new / "paper.md" / "x"), "paper.md"),
    ):
        code, out, err = command(capsys, *arguments)
        assert (code, out) == (2, "")
        assert err.count("\n") == 1 and err.startswith("bouncing-ball: ") and said in err


def test_only_artifacts_are_compared(pair, capsys):
    for name in ("README.md", "figures/notes.txt", "figures/.fig05.part.nc", "logs/fig05.log"):
        path = pair.new / name
        path.parent.mkdir(exist_ok=True)
        path.write_text("something else", encoding="utf-8")
    code, out, _ = command(capsys, pair.record, pair.new, "--tolerances", TOLERANCES)
    assert code == 0 and out.splitlines()[1].startswith("7 identical.")


def test_help_needs_neither_numpy_nor_the_comparison():
    code = (
        "import sys\n"
        "from bouncing_ball.cli.main import main\n"
        "try:\n    main(['diff', '--help'])\n"
        "except SystemExit as done:\n    assert done.code == 0\n"
        "slow = {'xarray', 'matplotlib', 'jinja2', 'yaml', 'PIL', 'bouncing_ball.compare'}\n"
        "assert not slow & set(sys.modules), slow & set(sys.modules)\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert "Exit status: 0 the same" in done.stdout

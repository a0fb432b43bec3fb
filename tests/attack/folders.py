"""Hostile folders, compared with the record: an answer, in bounds, with nothing raw in it.

Each case changes a few things in a copy of a part of the record, on either side:
bits, ends of files, what they are, what they say and what they are called. A
case fell if the comparison raised, took too long or too much memory, printed
what is not printable, quoted a file outside the folder, or called
the same what is not.
"""

import itertools
import json
import os
import resource
import shutil
import struct
import sys
import time
import zlib
from collections.abc import Callable, Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from netCDF4 import Dataset

from bouncing_ball.compare.folders import ComparisonError, compare_folders
from bouncing_ball.compare.parts import read_data
from bouncing_ball.compare.report_html import to_html
from bouncing_ball.compare.report_json import to_json
from bouncing_ball.compare.report_markdown import to_markdown
from bouncing_ball.compare.report_terminal import to_terminal
from bouncing_ball.compare.tolerance_file import read_tolerances
from bouncing_ball.datasets.netcdf import write_dataset

ROOT = Path(__file__).resolve().parents[2]
NAMES = ("fig02", "fig11", "table1", "ext_basins", "explorer")
SECRET = "a-line-of-a-private-file"
# A whole comparison takes a second here; the slowest single file that is read, a few.
SECONDS, MEGABYTES = 60.0, 2000
BAD = "\x1b]0;x\x07\n\r\u202e<b onload=f()>|`\udc80\x9b"

Change = Callable[[Path, np.random.Generator], bool | None]
"""Changes a file; True where the comparison may not call it the same."""


def _flip(path, rng):
    content = bytearray(path.read_bytes())
    for place in rng.integers(0, len(content), rng.integers(1, 20)):
        content[place] ^= 1 << int(rng.integers(8))
    path.write_bytes(content)


def _cut(path, rng):
    content = path.read_bytes()
    path.write_bytes(content[: int(rng.integers(0, len(content)))])


def _zero(path, rng):
    content = bytearray(path.read_bytes())
    start = int(rng.integers(0, len(content)))
    end = min(len(content), start + int(rng.integers(1, 5000)))
    content[start:end] = bytes(end - start)
    path.write_bytes(content)


def _mixed(path, rng):
    content = path.read_bytes()
    a, b = sorted(int(k) for k in rng.integers(0, len(content), 2))
    path.write_bytes(content[:a] + content[b:] + content[a:b])


def _link_out(path, rng):
    path.unlink()
    path.symlink_to(path.parents[2] / "private")
    return True


def _pipe(path, rng):
    path.unlink()
    os.mkfifo(path)
    return True


def _folder(path, rng):
    path.unlink()
    path.mkdir()
    return True


def _sparse(path, rng):
    with open(path, "r+b") as file:
        file.truncate(50 * 10**9)
    return True


def _named(path, rng):
    if path.parent.name != "figures":
        return False  # beside the article a folder may hold anything
    name = [BAD, "x" * 200, os.fsdecode(b"\xff\xfe"), "<script>", "a|b"][int(rng.integers(5))]
    name = name.replace("/", "")
    shutil.copyfile(path, path.with_name(f"{name}{path.suffix}"))
    return True


def _other(path, rng):
    others = [each for each in sorted(path.parent.glob(f"*{path.suffix}")) if each != path]
    if others and all(each.is_file() and not each.is_symlink() for each in others):
        shutil.copyfile(others[int(rng.integers(len(others)))], path)
        return True


ANY: list[Change] = [_flip, _cut, _zero, _mixed, _link_out, _pipe, _folder, _sparse, _named, _other]


def _attribute(path, rng):
    deep = "[" * 10_000
    choices = [
        ("scale_factor", "abc"),
        ("add_offset", [1.0, 2.0]),
        ("_Encoding", "utf-99"),
        ("coordinates", 7),
        ("coordinates", "none of these"),
        ("units", "days since never"),
        ("dtype", "str"),
        ("missing_value", "x"),
        ("flag_values", BAD.encode("utf-8", "replace").decode()),
        ("long_name", "x" * 50_000),
        ("provenance_versions", deep),
        ("valid_range", np.arange(3.0)),
    ]
    name, value = choices[int(rng.integers(len(choices)))]
    with Dataset(path, "a") as data:
        names = list(data.variables)
        owner = data if rng.integers(3) == 0 else data[names[int(rng.integers(len(names)))]]
        owner.setncattr(name, value)


def _huge_dataset(path, rng):
    with Dataset(path, "w") as data:
        data.createDimension("t", 10 ** int(rng.integers(6, 13)))
        data.createVariable("x", "f8", ("t",), chunksizes=(1000,), compression="zlib")
    return True


def _long_texts(path, rng):
    with Dataset(path, "w") as data:
        data.createDimension("t", 20_000)
        variable = data.createVariable("x", str, ("t",))
        variable[:] = np.array(
            [BAD.encode("utf-8", "replace").decode() * 20] * 20_000, dtype=object
        )
    return True


def _labels(path, rng):
    data = read_data(path.read_bytes())
    for name in data.dims:
        if name in data.coords and data.sizes[name] > 1:
            values = data[name].values.copy()
            values[1] = values[0]
            write_dataset(data.assign_coords({name: data[name].copy(data=values)}), path)
            return True


def _value(path, rng):
    data = read_data(path.read_bytes())
    names = [name for name in data.data_vars if data[name].dtype.kind == "f" and data[name].size]
    name = names[int(rng.integers(len(names)))]
    values = data[name].values
    index = tuple(int(rng.integers(size)) for size in values.shape)
    values[index] = [np.nan, np.inf, 1e308, -1e-308, 7.0][int(rng.integers(5))]


def _bomb(path, rng):
    width, height = (int(k) for k in rng.integers(3000, 60_000, 2))
    head = b"IHDR" + struct.pack(">IIBBBBB", width, height, 1, 0, 0, 0, 0)
    data = b"IDAT" + zlib.compress(bytes(width // 8 + 2) * min(height, 3000))
    chunks = [head, data, b"IEND"]
    path.write_bytes(
        b"\x89PNG\r\n\x1a\n"
        + b"".join(
            struct.pack(">I", len(each) - 4) + each + struct.pack(">I", zlib.crc32(each))
            for each in chunks
        )
    )
    return True


def _drawing(path, rng):
    inside = [
        "<script>f()</script>",
        "<g onload='f()'/>",
        "<use href='file:///etc/hostname'/>",
        "<style>@import url(//a.b)</style>",
        "<metadata " * 30_000,
        "<g>" * 100_000 + "</g>" * 100_000,
        "<path d='M " + "0 0 L 1 1 " * 30_000 + "'/>",
        "<path d='M 1e999 nan L -1e-999 5'/>",
        "<g id='" + "a" * 10**6 + "'/>",
        "<!-- " + "<metadata>" * 10**5 + " -->",
    ][int(rng.integers(10))]
    text = path.read_text(encoding="utf-8", errors="replace")
    path.write_text(text.replace("</svg>", inside + "</svg>"), encoding="utf-8")
    return True


def _entities(path, rng):
    define = "".join(f'<!ENTITY a{k} "{f"&a{k - 1};" * 10}">' for k in range(1, 10))
    path.write_text(f'<!DOCTYPE svg [<!ENTITY a0 "x">{define}]><svg>&a9;</svg>')
    return True


def _line(path, rng):
    lines = path.read_text(encoding="utf-8", errors="replace").split("\n")
    k = int(rng.integers(len(lines)))
    new = ["1e99999999999999999999", BAD, "a" * 10**6, "9" * 10**6, '"' * 10**5, "1,2\0"]
    lines[k] += " " + new[int(rng.integers(len(new)))]
    path.write_text("\n".join(lines), encoding="utf-8", errors="replace")
    return True


def _many_lines(path, rng):
    lines = path.read_text(encoding="utf-8", errors="replace").split("\n")
    rng.shuffle(lines)
    path.write_text("\n".join(["a", *lines] * 50), encoding="utf-8")
    return True


def _bytes(path, rng):
    path.write_bytes(b"\xff\xfe\x00" + path.read_bytes())
    return True


def _page(path, rng):
    text = path.read_text(encoding="utf-8", errors="replace")
    start, end, new = [
        ("<script", "</script>", "alert(1)"),
        ("<head>", "", "<meta http-equiv=refresh content='0;//a.b'><script src=//a.b></script>"),
        ('type="application/json"', "</script>", "[" * 10_000),
        ('type="application/json"', "</script>", '{"a": 1e999, "a": NaN}'),
        ("default-src", ";", "* 'unsafe-inline' 'unsafe-eval'"),
        ("sha256-", "'", "A" * 43 + "="),
        ("</body>", "", "<p onload=f()>" + "<div>" * 10_000),
    ][int(rng.integers(7))]
    at = text.find(start)
    if at < 0:
        return False
    begin = text.find(">", at) + 1 if start.startswith(("<script", "type")) else at + len(start)
    stop = text.find(end, begin) if end else begin
    path.write_text(text[:begin] + new + text[stop:], encoding="utf-8", errors="replace")
    return True


TEXT: list[Change] = [_line, _line, _many_lines, _bytes]
KINDS: dict[str, list[Change]] = {
    ".nc": [_attribute] * 6 + [_huge_dataset, _long_texts, _labels, _value],
    ".png": [_bomb],
    ".svg": [_drawing] * 5 + [_entities],
    ".html": [_page] * 4 + [_line],
    **dict.fromkeys((".csv", ".md", ".tex"), TEXT),
}


def _changed(folder: Path, rng: np.random.Generator) -> tuple[str, bool]:
    """Change one file of a folder; what was done, and whether it must be seen."""
    paths = [path for path in sorted(folder.rglob("*.*")) if path.is_file()]
    paths = [path for path in paths if not path.is_symlink() and path.stat().st_size < 10**7]
    path = paths[int(rng.integers(len(paths)))]
    changes = KINDS[path.suffix] if rng.integers(2) else ANY
    change = changes[int(rng.integers(len(changes)))]
    try:
        seen = bool(change(path, rng))
    # A file that an earlier change has broken cannot be changed by its library.
    except Exception:
        return f"{change.__name__} failed on {path.name!a}", False
    return f"{change.__name__} of {path.name!a}", seen


def _faults(record: Path, new: Path, rules, must_differ: bool) -> list[str]:
    """What is wrong with the comparison of two folders."""
    start = time.process_time()
    try:
        comparison = compare_folders(record, new, rules)
    except ComparisonError as error:
        shown = str(error)
        return [] if shown.isprintable() and SECRET not in shown else ["raw text in an error"]
    reports = [to_terminal(comparison), to_markdown(comparison), to_html(comparison)]
    reports.append(to_json(comparison))
    json.loads(reports[-1])
    spent = time.process_time() - start
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2 ** (20 if MAC else 10)
    faults = []
    if any(SECRET in report for report in reports):
        faults.append("a private file is quoted")
    if not all(line.isprintable() for report in reports for line in report.split("\n")):
        faults.append("raw text in a report")
    if "onload=f()>" in reports[2]:
        faults.append("markup of a file in the page")
    if must_differ and comparison.outcome.agrees:
        faults.append("called the same")
    if spent > SECONDS:
        faults.append(f"{spent:.0f} s")
    if memory > MEGABYTES:
        faults.append(f"{memory:.0f} MB")
    return faults


MAC = sys.platform == "darwin"


def attack(seed: int) -> Iterator[list[str]]:
    """Random changes of one side or both, a few at a time."""
    rules = read_tolerances(ROOT / "config" / "tolerances.yaml")
    with TemporaryDirectory() as name:
        base, sides = Path(name, "base"), [Path(name, side) for side in ("record", "new")]
        (base / "figures").mkdir(parents=True)
        for path in sorted((ROOT / "figures").iterdir()):
            if path.stem in NAMES:
                shutil.copyfile(path, base / "figures" / path.name)
        shutil.copyfile(ROOT / "paper.md", base / "paper.md")
        Path(name, "private").write_text(f"{SECRET}\n")
        for number in itertools.count():
            # A case is found again by its own seed.
            rng = np.random.default_rng([seed, number])
            for side in sides:
                shutil.copytree(base, side)
            done, seen = [], False
            for _ in range(int(rng.integers(1, 4))):
                what, must = _changed(sides[int(rng.integers(4) > 0)], rng)
                # Two changes may undo each other, or meet in one file.
                seen = must and not done
                done.append(what)
            try:
                faults = _faults(*sides, rules, seen)
            # By intent: whatever it raises is what is looked for.
            except Exception as error:
                faults = [f"{type(error).__name__}: {error}"[:200]]
            what = f"case [{seed}, {number}], {'; '.join(done)}"
            yield [f"{what}: {', '.join(faults)}" if faults else ""]
            for side in sides:
                shutil.rmtree(side)

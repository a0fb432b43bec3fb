"""Configurations and places that are refused, each with one line: the key, its value and what is
allowed."""

import contextlib
import errno
import fcntl
import io
import math
import os
import pwd
import runpy
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
import yaml
from snakemake.api import SnakemakeApi
from snakemake.settings.types import ConfigSettings, OutputSettings, Quietness, ResourceSettings
from snakemake.utils import update_config

ROOT = Path(__file__).resolve().parents[1]


def read_workflow(changes: dict, *files: Path) -> None:
    """Read the Snakefile with a changed configuration, without a run."""
    with (
        SnakemakeApi(OutputSettings(quiet={Quietness.ALL})) as api,
        contextlib.redirect_stdout(io.StringIO()),
    ):
        workflow = api.workflow(
            resource_settings=ResourceSettings(),
            config_settings=ConfigSettings(config=changes, configfiles=files),
            snakefile=ROOT / "Snakefile",
        )
        workflow.list_rules()


def refusal(changes: dict, *files: Path) -> str:
    """The text with which a run ends before any job."""
    with pytest.raises(SystemExit) as ended:
        read_workflow(changes, *files)
    return ended.value.code


@pytest.fixture(autouse=True)
def elsewhere(tmp_path, monkeypatch):
    """Snakemake writes its own files into the working directory."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PYTHONPATH", "")


def nested(place: str, value) -> dict:
    """The configuration with one value at a place like `continuation.fig08.n`."""
    *above, last = place.split(".")
    config: dict = {last: value}
    for key in reversed(above):
        config = {key: config}
    return config


def test_the_configuration_in_git_is_accepted():
    read_workflow({})


def test_the_ends_of_ranges_are_accepted():
    changes: dict = {}
    for place, value in {
        "release": "force",
        "largest_step": 0.5,
        "restitution_model.fig02.restitution": 1,
        "restitution_model.fig02.samples": 20001,
        "continuation.fig08.n": 20,
        "continuation.fig08.restitution": 0.999,
        "continuation.fig08.frequency_ratio": [0.1, 1000000],
        "error_thresholds.thresholds.quantities": ["phase"],
    }.items():
        update_config(changes, nested(place, value))
    read_workflow(changes)


# A place, a value that is refused there, and what the line says after the place.
REFUSED = [
    ("release", "sticky", "'sticky' is not one of ['displacement', 'force']"),
    ("largest_step", 0.01, "0.01 is less than the minimum of 0.02"),
    ("largest_step", 0.6, "0.6 is greater than the maximum of 0.5"),
    ("continuation.fig08.n", 0, "0 is less than the minimum of 1"),
    ("continuation.fig08.n", 21, "21 is greater than the maximum of 20"),
    ("continuation.fig08.n", 1.0, "1.0 is not of type 'integer'"),
    ("continuation.fig08.n", True, "True is not of type 'integer'"),
    ("continuation.fig08.n", None, "None is not of type 'integer'"),
    ("restitution_model.fig03.n", [], "[] should be non-empty"),
    ("restitution_model.fig03.n", [1, 2, 1], "[1, 2, 1] has non-unique elements"),
    ("restitution_model.fig03.n", 1, "1 is not of type 'array'"),
    ("restitution_model.fig02.restitution", 0.04, "0.04 is less than the minimum of 0.05"),
    ("restitution_model.fig02.restitution", 1.01, "1.01 is greater than the maximum of 1"),
    ("continuation.fig15.restitution", 1, "1 is greater than the maximum of 0.999"),
    ("continuation.table1.restitution", 0.01, "0.01 is less than the minimum of 0.05"),
    ("time_histories.fig07.amplitude", 0, "0 is less than or equal to the minimum of 0"),
    ("time_histories.fig07.amplitude", 1001.0, "1001.0 is greater than the maximum of 1000"),
    ("time_histories.fig07.amplitude", math.nan, "nan is not of type 'number'"),
    ("time_histories.fig07.amplitude", math.inf, "inf is not of type 'number'"),
    ("time_histories.fig07.amplitude", "1e3", "'1e3' is not of type 'number'"),
    ("apparent_restitution.fig10.amplitude", [1.0, 1.0], "[1.0, 1.0] has non-unique elements"),
    ("apparent_restitution.fig10.amplitude", [], "[] should be non-empty"),
    ("continuation.fig09.amplitude_max", 0, "0 is less than or equal to the minimum of 0"),
    ("continuation.fig09.amplitude_max", 101, "101 is greater than the maximum of 100"),
    ("time_histories.fig07.frequency_ratio", 0.05, "0.05 is less than the minimum of 0.1"),
    ("time_histories.fig07.frequency_ratio", 2e6, "2000000.0 is greater than the maximum"),
    ("time_histories.fig12.frequency_ratio", [], "[] should be non-empty"),
    ("time_histories.fig12.frequency_ratio", [2, 2.0], "[2, 2.0] has non-unique elements"),
    ("time_histories.fig12.samples", 1, "1 is less than the minimum of 2"),
    ("time_histories.fig12.samples", 20002, "20002 is greater than the maximum of 20001"),
    ("permanent_contact.fig11.frequency_ratio.samples", 1, "1 is less than the minimum of 2"),
    ("permanent_contact.fig11.frequency_ratio.min", 0, "0 is less than the minimum of 0.1"),
    ("permanent_contact.fig11.frequency_ratio", 3, "3 is not of type 'object'"),
    ("continuation.fig08.points", 10, "10 is less than the minimum of 11"),
    ("continuation.fig08.points", 30000, "30000 is greater than the maximum of 20001"),
    ("restitution_model.fig02.periods", 0, "0 is less than the minimum of 1"),
    ("restitution_model.fig02.periods", 21, "21 is greater than the maximum of 20"),
    ("restitution_model.three_balls.phase", -11, "-11 is less than the minimum of -10"),
    ("restitution_model.three_balls.phase", 11, "11 is greater than the maximum of 10"),
    ("restitution_model.three_balls.impact_speed", 0, "0 is less than or equal to the minimum"),
    ("restitution_model.three_balls.impact_speed", 1001, "1001 is greater than the maximum"),
    ("restitution_model.three_balls.impacts", 255, "255 is less than the minimum of 256"),
    ("restitution_model.three_balls.impacts", 100001, "100001 is greater than the maximum"),
    ("error_thresholds.fig14.tolerance", 0, "0 is less than or equal to the minimum of 0"),
    ("error_thresholds.fig14.tolerance", 1, "1 is greater than or equal to the maximum of 1"),
    ("error_thresholds.thresholds.tolerances", [], "[] should be non-empty"),
    ("error_thresholds.thresholds.tolerances", [0.1, 0.1], "[0.1, 0.1] has non-unique elements"),
    ("error_thresholds.thresholds.quantities", [], "[] should be non-empty"),
    ("error_thresholds.thresholds.quantities", ["phase"] * 2, "['phase', 'phase'] has non-unique"),
    ("apparent_restitution.fig05.cases", [], "[] should be non-empty"),
    ("apparent_restitution.fig05", None, "None is not of type 'object'"),
    ("continuation.lowest_doubling", [], "[] is not of type 'object'"),
    ("validity.validity_map.restitution.max", 1.5, "1.5 is greater than the maximum of 0.999"),
    ("validity.validity_map.restitution.min", -0.1, "-0.1 is less than the minimum of 0.05"),
    ("validity.validity_map.restitution.samples", 0, "0 is less than the minimum of 2"),
    ("validity.validity_map.places", 1, "1 is less than the minimum of 2"),
    ("validity.validity_map.n", [], "[] should be non-empty"),
    ("validity.validity_map.tolerance", 0, "0 is less than or equal to the minimum of 0"),
]


def rounds() -> list[list[tuple]]:
    """The cases in groups, in each of which no figure occurs twice."""
    found: list[dict] = []
    for case in REFUSED:
        figure = ".".join(case[0].split(".")[:2])
        free = next((group for group in found if figure not in group), None)
        if free is None:
            found.append(free := {})
        free[figure] = case
    return [[*group.values()] for group in found]


@pytest.mark.parametrize("cases", rounds())
def test_each_wrong_value_is_refused_with_its_key_and_what_is_allowed(cases):
    changes: dict = {}
    for place, value, _ in cases:
        update_config(changes, nested(place, value))
    lines = refusal(changes).splitlines()
    assert len(lines) == len(cases)
    for place, _, said in cases:
        assert [line for line in lines if line.startswith(f"configuration: {place}: {said}")]


CASE = {"restitution": 0.65, "amplitude": 1.0}
INSIDE = [
    (
        nested("error_thresholds.thresholds.quantities", ["phase", "heigth"]),
        "error_thresholds.thresholds.quantities[1]: 'heigth' is not one of ['max_height', ",
    ),
    (
        nested("apparent_restitution.fig06.cases", [CASE, CASE | {"restitution": 0}]),
        "apparent_restitution.fig06.cases[1].restitution: 0 is less than the minimum of 0.05",
    ),
    (
        nested("apparent_restitution.fig06.cases", [{"restitution": 0.65}]),
        "apparent_restitution.fig06.cases[0]: 'amplitude' is a required property",
    ),
    (
        nested("apparent_restitution.fig06.cases", [CASE, CASE]),
        "apparent_restitution.fig06.cases: [{",
    ),
]


@pytest.mark.parametrize("changes, said", INSIDE)
def test_a_mistake_inside_a_list_names_the_entry(changes, said):
    line = refusal(changes)
    assert line.startswith(f"configuration: {said}") and "\n" not in line


@pytest.mark.parametrize(
    "place, nearest",
    [
        ("relase", "release"),
        ("continuaton", "continuation"),
        ("continuation.fig8", "fig08"),
        ("continuation.fig08.restituton", "restitution"),
        ("permanent_contact.fig11.frequency_ratio.sample", "samples"),
    ],
)
def test_a_misspelt_key_is_named_with_the_nearest_right_one(place, nearest):
    line = refusal(nested(place, 1))
    assert line == f"configuration: unknown key {place}, allowed: {nearest}"


def test_a_key_like_no_other_is_named_with_all_that_are_allowed():
    line = refusal(nested("permanent_contact.fig11.frequency_ratio.xyz", 1))
    assert line.endswith("frequency_ratio.xyz, allowed: min, max, samples")


@pytest.mark.parametrize(
    "changes, said",
    [
        (
            nested("permanent_contact.fig11.frequency_ratio", {"min": 2.0, "max": 2.0}),
            "permanent_contact.fig11.frequency_ratio.min = 2.0: must be less than max = 2.0",
        ),
        (
            nested("validity.validity_map.restitution", {"min": 0.9, "max": 0.1}),
            "validity.validity_map.restitution.min = 0.9: must be less than max = 0.1",
        ),
        (
            nested("validity.validity_map.advised", 20000.0),
            "validity.validity_map.advised = 20000.0: must be within 10.0 and 10000.0, the ends of "
            "frequency_ratio",
        ),
        (
            nested(
                "validity.validity_map.curves", [{"n": 2, "restitution": 0.1, "amplitude": 2.6}]
            ),
            "validity.validity_map.curves[0].amplitude = 2.6: must be at least 5.14079, the "
            "saddle-node of the 2-T orbit at r = 0.1 (Eq. 7)",
        ),
        (
            nested("time_histories.fig07.amplitude", 0.25),
            "time_histories.fig07.amplitude = 0.25: must be at least 0.254724, the saddle-node of "
            "the 1-T orbit at r = 0.85 (Eq. 7)",
        ),
        # The highest family has to exist.
        (
            nested("continuation.table1.amplitude_max", 0.7),
            "continuation.table1.amplitude_max = 0.7: must be at least 0.764171, the saddle-node "
            "of the 3-T orbit at r = 0.85 (Eq. 7)",
        ),
        # At r = 0.1 the saddle-node is at 9π/11.
        (
            nested("apparent_restitution.fig05.cases", [CASE | {"restitution": 0.1}]),
            "apparent_restitution.fig05.cases[0].amplitude = 1.0: must be at least 2.57039, the "
            "saddle-node of the 1-T orbit at r = 0.1 (Eq. 7)",
        ),
        (
            nested("apparent_restitution.fig10.amplitude", [1.0, 0.5]),
            "apparent_restitution.fig10.amplitude = 0.5: must be at least 0.509447, the "
            "saddle-node of the 2-T orbit at r = 0.85 (Eq. 7)",
        ),
    ],
)
def test_what_a_schema_cannot_know_is_refused_too(changes, said):
    assert refusal(changes) == f"configuration: {said}"


def test_every_mistake_has_a_line():
    lines = refusal({"release": "x", "largest_step": 1}).splitlines()
    assert [line.split(":")[1].strip() for line in lines] == ["release", "largest_step"]


def test_a_key_that_a_file_names_twice_is_refused(tmp_path):
    file = tmp_path / "mine.yaml"
    file.write_text("release: force\npermanent_contact:\n  fig11: {}\n  fig11: {}\n", "utf-8")
    line = refusal({}, file)
    assert line == f"configuration: {file}: permanent_contact.fig11 occurs twice, in line 4 again"


# Files, before Snakemake reads them: of a broken one it says no line, or shows a traceback.

CHECKS = runpy.run_path(str(ROOT / "workflow/rules/checks.smk"))
ALLOWED = "allowed: one YAML document of keys and values in UTF-8, as config/config.yaml"
BROKEN = {
    "a tab": (
        b"release: force\npermanent_contact:\n\tfig11: {}\n",
        r", line 3: '\tfig11: {}': found character '\t' that cannot start any token; " + ALLOWED,
    ),
    "a bracket": (
        b"largest_step: 0.1\nrelease: [force\n",
        ", line 2: 'release: [force': while parsing a flow sequence: expected ',' or ']'",
    ),
    "an alias": (b"release: *a\n", ", line 1: 'release: *a': found undefined alias 'a'; allowed: "),
    "two documents": (
        b"release: force\n---\nrelease: force\n",
        ", line 2: '---': found another document; allowed: one YAML document",
    ),
    "a list": (b"- release\n", ", line 1: '- release': no keys; allowed: one YAML document"),
    "a text": (b"release\n", ", line 1: 'release': no keys; allowed: one YAML document of keys"),
    "nothing": (b"", ", line 1: the file is empty; allowed: one YAML document"),
    "a comment": (b"# later\n", ", line 1: '# later': the file is empty; allowed: "),
    "Latin-1": (
        "release: force\n# größer\n".encode("latin-1"),
        ", line 2: '# gr\ufffd\ufffder': the byte 0xf6 is not UTF-8; allowed: one YAML document",
    ),
    "UTF-16": ("release: force\n".encode("utf-16-le"), r", line 1: 'r\x00e\x00l\x00e"),
    "UTF-16 with its mark": ("a: 1\n".encode("utf-16"), ": the byte 0xff is not UTF-8; allowed: "),
    "an alias of what is around it": (
        b"continuation: &a\n  fig08: *a\n",
        ": continuation.fig08 contains itself, allowed: values without an alias",
    ),
    "an object of Python": (b"release: !!python/object:os.system x\n", ": could not determine a"),
    "a list as a key": (b"? [a]\n: 1\n", ", line 1: '? [a]': found unhashable key; allowed: "),
    "no mapping to merge": (b"<<: 3\n", ", line 1: '<<: 3': expected a mapping or list of"),
    "a month that is none": (b"release: 2011-13-01\n", ": month must be in 1..12; allowed: "),
    "a control character": (
        b"release: \x1b[31mred\n",
        r", line 1: 'release: \x1b[31mred': special characters are not allowed; allowed: ",
    ),
    "a key twice": (b"release: force\nrelease: force\n", ": release occurs twice, in line 2 again"),
    "a key twice in a list": (b"a: [{b: 1, b: 2}]\n", ": a[0].b occurs twice, in line 1 again"),
}


def refused(*arguments) -> str:
    """The text with which a command line ends before Snakemake reads its files and values."""
    with pytest.raises(SystemExit) as ended:
        CHECKS["refuse_command"]([*map(str, arguments)])
    return ended.value.code


@pytest.mark.parametrize("content, said", BROKEN.values(), ids=BROKEN)
def test_a_broken_file_is_named_with_its_line_and_what_is_allowed(tmp_path, content, said):
    file = tmp_path / "mine.yaml"
    file.write_bytes(content)
    line = refused("all", "--configfile", file, "--cores", "1")
    assert line.startswith(f"configuration: {file}") and said in line
    assert line.isprintable()


def test_aliases_of_aliases_are_read_once(tmp_path):
    """Nine of nine of nine and so on: 9^20 values, if each were read."""
    lines = ["a0: &a0 []"]
    lines += [f"a{n}: &a{n} [{', '.join([f'*a{n - 1}'] * 9)}]" for n in range(1, 21)]
    file = tmp_path / "mine.yaml"
    file.write_text("\n".join(lines), "utf-8")
    CHECKS["refuse_command"](["--configfile", str(file)])


def test_brackets_without_an_end_are_refused(tmp_path):
    file = tmp_path / "mine.yaml"
    file.write_text("release: " + "[" * 1000, "utf-8")
    line = refused("--configfile", file)
    assert line.startswith(f"configuration: {file}: maximum recursion depth exceeded")
    assert "\n" not in line


@pytest.mark.parametrize("file", ["", ".", "absent.yaml", "all"])
def test_what_is_no_file_is_refused(file):
    line = refused("--cores", "2", "--configfile", file)
    reason = os.strerror(errno.EISDIR if os.path.isdir(file or ".") else errno.ENOENT)
    assert line == (
        f"configuration: {file or repr(file)}: {reason}; allowed: a file; --configfile takes all "
        "names up to the next option"
    )


@pytest.mark.parametrize("file", ["pipe", "/dev/null"])
def test_a_pipe_or_a_device_is_no_file_of_a_configuration(file):
    """It would be waited for, or could be read once only."""
    os.mkfifo("pipe")
    assert refused("--configfile", file).startswith(
        f"configuration: {file}: a pipe or a device; allowed: a file; "
    )


@pytest.mark.parametrize("entry", ["largest_step", "=3", "a=3", "3=a", "\x1b[31mred", ""])
@pytest.mark.parametrize("option", ["--config", "-C"])
def test_a_value_without_a_key_is_refused(option, entry):
    line = refused("all", option, "release=force", entry)
    shown = entry.replace("\x1b", r"\x1b")
    assert line == f"configuration: --config {shown}: allowed: KEY=VALUE, as in largest_step=0.2"


@pytest.mark.parametrize(
    "arguments", [[], ["all"], ["-C", "release=force"], ["--config", "release=", "--cores", "2"]]
)
def test_other_command_lines_are_left_to_snakemake(arguments):
    CHECKS["refuse_command"](arguments)


def test_snakemake_asks_the_checks_first(fresh, tmp_path):
    """By its profile, here and from another folder; and of the file of the checkout as well."""
    file = tmp_path / "mine.yaml"
    file.write_bytes(b"release: force\n\tfig11: 3\n")
    line = f"configuration: {file}, line 2: "
    assert str(fresh.run("--list", "--configfile", str(file))[0]).startswith(line)
    there = ["--snakefile", str(fresh.path / "Snakefile"), "--configfile", "mine.yaml"]
    line = "configuration: mine.yaml, line 2: "
    assert str(fresh.run("--list", *there, folder=tmp_path)[0]).startswith(line)
    assert str(fresh.run("--list", "--config", "x")[0]).startswith("configuration: --config x: ")
    (fresh.path / "config/config.yaml").write_bytes(b"release: [force")
    line = "configuration: config/config.yaml, line 1: 'release: [force': expected"
    assert str(fresh.run("--list")[0]).startswith(line)


# Titles


@pytest.mark.parametrize("value", [3, "{}", None, [1]])
def test_an_unknown_key_without_parameters_is_no_new_figure(value):
    line = refusal(nested("continuation.fig17", value))
    assert line.startswith("configuration: unknown key continuation.fig17, allowed: fig")


def test_a_new_figure_has_a_title_and_may_have_any_parameters():
    new = {"title": "Figure 17: another", "n": -1, "frequency_ratio": {"min": 2, "max": 1}}
    read_workflow(nested("continuation.further", new))
    line = refusal({"chaos": {"title": "A stage", "attractor": new}})
    assert line.startswith("configuration: chaos: there is no workflow/scripts/chaos.py")
    line = refusal(nested("continuation.further", {"n": 2}))
    assert line.startswith("configuration: unknown key continuation.further, allowed: fig")
    assert line.endswith(", or a new one with a title")


@pytest.mark.parametrize(
    "changes, said",
    [
        (nested("continuation.title", 3), "continuation.title = 3: must be a text"),
        (nested("continuation.fig08.title", None), "continuation.fig08.title = None: must be"),
        (nested("continuation.fig08.caption", 3), "continuation.fig08.caption = 3: must be a text"),
        (
            nested("continuation.table1.table", "yes"),
            "continuation.table1.table = yes: must be true or false",
        ),
        (
            nested("continuation.fig-17", {"title": "Figure 17"}),
            "continuation.fig-17: a name has letters, digits and underscores",
        ),
        (
            nested("continuation.fig14", {"title": "Figure 14"}),
            "error_thresholds.fig14: another stage has this name too",
        ),
        (nested("schematics.fig01.n", 3), "unknown key schematics.fig01.n, allowed: "),
    ],
)
def test_titles_captions_and_names_are_checked(changes, said):
    line = refusal(changes)
    assert line.startswith(f"configuration: {said}") and "\n" not in line


def test_control_characters_are_not_printed_raw():
    assert refusal({"release": "\x1b[31mred"}).startswith(r"configuration: release: '\x1b[31mred'")
    assert refusal({"re\x1b[31mlease": 3}).startswith(
        r"configuration: unknown key re\x1b[31mlease,"
    )


@pytest.mark.parametrize("key, named", [(3, "[3]"), (None, "None"), (2.5, "2.5"), (True, "[True]")])
def test_a_key_that_is_no_text_is_unknown(key, named):
    assert refusal({key: 3}).startswith(f"configuration: unknown key {named}, allowed: release, ")


# Users and places


def test_a_user_without_a_name_is_told_what_to_set(monkeypatch):
    def unknown(uid):
        raise KeyError(f"getpwuid(): uid not found: {uid}")

    monkeypatch.setattr(pwd, "getpwuid", unknown)
    for name in ("LOGNAME", "USER", "LNAME", "USERNAME"):
        monkeypatch.delenv(name, raising=False)
    line = f"The user {os.getuid()} has no name on this machine: set USER to any name"
    assert refused("all") == line
    monkeypatch.setenv("USER", "anybody")
    CHECKS["refuse_command"](["all"])
    # Its home folder is then known by HOME only.
    monkeypatch.delenv("HOME")
    line = f"The user {os.getuid()} has no home folder: set HOME to any folder, be it /"
    assert refused("all") == line


@pytest.mark.parametrize("variable, folder", [("HOME", "file/.cache"), ("XDG_CACHE_HOME", "file")])
def test_a_home_that_cannot_be_written_to_is_told_what_to_set(
    variable, folder, tmp_path, monkeypatch
):
    """Below a file, because root may write to every folder."""
    (tmp_path / "file").touch()
    monkeypatch.delenv("XDG_CACHE_HOME", raising=False)
    monkeypatch.setenv(variable, str(tmp_path / "file"))
    reason = os.strerror(errno.ENOTDIR if variable == "HOME" else errno.EEXIST)
    line = f"{tmp_path / folder}: {reason}; set XDG_CACHE_HOME to a folder that can be written to"
    assert refused("all") == line
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    CHECKS["refuse_command"](["all"])


def no_place(folder: Path) -> str:
    """The text with which a run of a checkout in a folder ends."""
    with pytest.raises(SystemExit) as ended:
        CHECKS["refuse_place"](folder)
    return ended.value.code


@pytest.mark.parametrize("name, found", [("br{x}", "'{' '}'"), ("one{", "'{'"), ("}", "'}'")])
def test_a_folder_with_braces_is_refused(name, found, tmp_path):
    assert no_place(tmp_path / name) == (
        f"{tmp_path / name} has {found} in its name, and Snakemake cannot run there: rename the "
        "folder"
    )


@pytest.mark.parametrize("character", " '\"\\`$&|;<>(){}\n")
def test_a_python_that_a_shell_misreads_is_refused(character, tmp_path, monkeypatch):
    monkeypatch.setattr(sys, "executable", f"/a{character}b/bin/python")
    line = no_place(tmp_path)
    assert f" has {character!r} in its name".replace("\\n", r"\n") in line and line.isprintable()


@pytest.mark.parametrize("folder", ["", "extras/beyond/"])
@pytest.mark.parametrize("name", ["sp ace", "br{x}", "qu'o", 'dou"ble', "do$lar", "pa(r", "ünï[1]"])
def test_make_refuses_a_folder_in_which_snakemake_fails(name, folder, tmp_path):
    """Before it sets anything up, unless the environment lies elsewhere."""
    (tmp_path / name).mkdir()
    shutil.copyfile(ROOT / f"{folder}Makefile", tmp_path / name / "Makefile")

    def refusal_of_make(*arguments: str) -> str:
        command = ["make", "--dry-run", *arguments, "lint"]
        done = subprocess.run(
            command, cwd=tmp_path / name, capture_output=True, text=True, check=False
        )
        return done.stderr

    line = (
        "Snakemake needs a Python whose path has no space and none of '\"\\`$&|;<>(){}: move this"
    )
    assert (line in refusal_of_make()) == (name != "ünï[1]")
    assert line not in refusal_of_make("VENV=/another/path")


def test_other_names_of_folders_are_good(tmp_path):
    CHECKS["refuse_place"](tmp_path / 'ünï co:de [1] 100% st*r\'s "x"')


@pytest.mark.parametrize("file", ["results/paper.md", "results/figures/any.nc"])
def test_a_pipe_among_the_results_is_refused(file, tmp_path):
    Path("results/figures").mkdir(parents=True)
    os.mkfifo(file)
    line = f"{file} is a pipe or a device, which would be waited for: remove it"
    assert no_place(tmp_path / "checkout") == line


def test_a_file_system_without_locks_is_said_so(tmp_path, monkeypatch):
    def refuse_locks(file, operation):
        raise OSError(number, os.strerror(number))

    number = errno.ENOLCK
    monkeypatch.setattr(fcntl, "flock", refuse_locks)
    assert no_place(tmp_path / "checkout") == (
        f"{tmp_path}: the file system has no locks ({os.strerror(number)}): set "
        "HDF5_USE_FILE_LOCKING=FALSE, and let one run at a time write here"
    )
    monkeypatch.setenv("HDF5_USE_FILE_LOCKING", "FALSE")
    CHECKS["refuse_place"](tmp_path / "checkout")
    # HDF5 goes on without locks if there is no such call.
    monkeypatch.delenv("HDF5_USE_FILE_LOCKING")
    number = errno.ENOSYS
    CHECKS["refuse_place"](tmp_path / "checkout")


def test_parameters_are_described_and_bounded():
    """Every number of the schema has both bounds, and a mistake ends with a reason."""
    schema = yaml.safe_load((ROOT / "config/schema.yaml").read_text("utf-8"))

    def check(node):
        if isinstance(node, dict):
            if node.get("type") in ("integer", "number"):
                assert "description" in node
                assert {"minimum", "exclusiveMinimum"} & node.keys()
                assert {"maximum", "exclusiveMaximum"} & node.keys()
            if node.get("type") == "object":
                assert node["additionalProperties"] is False
                assert node["required"] == list(node["properties"])
            for each in node.values():
                check(each)

    check(schema)

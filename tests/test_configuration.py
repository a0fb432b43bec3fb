"""A mistake in the configuration ends a run before any job, with a line that names it."""

from copy import deepcopy
from itertools import product

import pytest
from tests.reference import CONFIG, stage

from bouncing_ball import restitution
from bouncing_ball.orbits import NoOrbit
from carbonelli2011.existence import ALONG_CASES, COMPARED, stable_range, without_orbit
from paper_replication.configuration import names
from paper_replication.datasets import computed


@pytest.mark.parametrize(
    "changes, line",
    [
        ("relese: force", "relese: unknown key, did you mean release?"),
        ("release: sticky", "release: 'sticky' is not one of ['displacement', 'force'] (the"),
        (
            "error_thresholds: {fig14: {restitution: 1.5}}",
            "error_thresholds.fig14.restitution: 1.5 is greater than the maximum of 1 (restitution",
        ),
        (
            "error_thresholds: {fig14: {restitutoin: 0.5}}",
            "error_thresholds.fig14.restitutoin: unknown key, did you mean restitution?",
        ),
        (
            "error_thresholds: {fig15: {n: 1}}",
            "error_thresholds.fig15: unknown key, did you mean fig14? (a new entry needs a title",
        ),
        (
            "continuation: {fig08: {frequency_ratio: [1e4, 10]}}",
            "continuation.fig08.frequency_ratio.0: '1e4' is not of type 'number' (frequency",
        ),
        (
            "continuation: {fig08: {frequency_ratio: [2, 3, 4, 5, 6, 7]}}",
            "continuation.fig08.frequency_ratio: [2, 3, 4, 5, 6, 7] is too long (a panel for each",
        ),
        (
            "apparent_restitution: {fig06: {cases: [{restitution: .nan, amplitude: 1.0}]}}",
            "apparent_restitution.fig06.cases.0.restitution: .nan must be a number",
        ),
        (
            "error_thresholds: {fig99: {title: A new one, release: force}}",
            "error_thresholds.fig99.release: a setting of the whole run, not of an entry",
        ),
        ("restitution: 0.7", "restitution: unknown key, did you mean "),
        (
            "error_thresholds: {fig14: {amplitude: 3}}",
            "error_thresholds.fig14.amplitude: 3 has no stable 1-T orbit, which needs Λ from "
            "0.666398 to 1.2394 (Eqs. 7 and R1 for r = 0.65)",
        ),
        (
            "time_histories: {fig12: {amplitude: 0.3}}",
            "time_histories.fig12: 1-T orbits on stiff contacts need Λ >= 0.666398 (Eq. 7), and",
        ),
        (
            "continuation: {fig08: {points: 61}}\ncontinuation: {fig09: {points: 61}}",
            "mine.yaml, line 2: continuation stands twice: write its keys together",
        ),
        (
            "error_thresholds: {fig14: {frequency_ratio: {min: 10, max: 10}}}",
            "error_thresholds.fig14.frequency_ratio: min = 10 must be less than max = 10",
        ),
        (
            "continuation: {fig08: {points: 061}}",
            "mine.yaml, line 1: YAML reads 061 as 49: write it in decimals",
        ),
    ],
)
def test_a_mistake_is_one_line_before_any_job(fresh, changes, line):
    (fresh.path / "mine.yaml").write_text(changes, "utf-8")
    status, printed = fresh.run("--cores", "1", "--configfile", "mine.yaml", "--", "fig01")
    assert str(status).splitlines()[0].startswith(f"configuration: {line}"), (status, printed)
    assert not (fresh.path / "results").exists()


def test_a_part_of_a_configuration_that_replaces_it_all_names_the_missing_sections(fresh):
    (fresh.path / "mine.yaml").write_text("continuation: {fig08: {points: 61}}", "utf-8")
    command = ["-n", "--cores", "1", "--configfile", "mine.yaml", "--replace-workflow-config"]
    status, _ = fresh.run(*command, "--", "fig01")
    assert status.startswith("configuration: release, largest_step, schematics, restitution_model,")
    assert status.endswith("missing: leave out --replace-workflow-config to change parts")


def test_nested_values_of_the_command_line_are_texts_and_the_line_tells_the_remedy(fresh):
    changes = "error_thresholds={fig14: {restitution: 0.8}}"
    status, _ = fresh.run("--cores", "1", "--config", changes, "--", "fig01")
    assert "restitution: '0.8' is not of type 'number'" in status and "--configfile" in status


def test_a_new_figure_needs_a_title_and_functions_and_may_have_any_parameters(fresh):
    text = "permanent_contact: {fig99: {title: A new one, caption: With a caption, anything: 1}}"
    (fresh.path / "mine.yaml").write_text(text, "utf-8")
    command = ["-n", "--cores", "1", "--configfile", "mine.yaml", "--", "fig99"]
    for file in ("src/carbonelli2011/stages/permanent_contact.py", "src/carbonelli2011/figures.py"):
        line = f"configuration: fig99: {file} needs a function for it"
        assert fresh.run(*command)[0].splitlines()[0] == line
        fresh.edit(file, '"fig11": fig11', '"fig11": fig11, "fig99": fig11')
    status, printed = fresh.run(*command)
    assert status == 0 and "results/figures/fig99.png" in printed, printed


@pytest.mark.parametrize(
    "content", ["<<<<<<< HEAD\nrelease: force\n=======\n", "release: d\xe9placement\n"]
)
def test_a_configuration_that_cannot_be_read_is_one_line(fresh, content):
    """With the marks of a conflict, or in another encoding than UTF-8."""
    (fresh.path / "config/config.yaml").write_bytes(content.encode("latin-1"))
    status, _ = fresh.run("-n", "--cores", "1", "--", "fig01")
    assert status.startswith("configuration: config.yaml cannot be read: "), status
    assert "\n" not in status


def moved(name, section, factor, end):
    """The configuration with the ball of r = 0.65 in an entry, and all its amplitudes at a multiple
    of an end of their range.
    """
    config = deepcopy(CONFIG)
    entry = config[section][name]
    for case in entry.get("cases", [entry]):
        case["restitution"] = 0.65
        amplitude = factor * stable_range(entry["n"], 0.65)[end]
        key = "amplitude" if "amplitude" in case else "amplitude_max"
        case[key] = [amplitude] if isinstance(case[key], list) else amplitude
    return config


@pytest.mark.parametrize(
    "section, name",
    [
        (section, name)
        for section in (COMPARED, *ALONG_CASES)
        for name in names(CONFIG[section])
        if {"amplitude", "amplitude_max", "cases"} & CONFIG[section][name].keys()
    ],
)
def test_amplitudes_without_an_orbit_are_those_that_a_stage_refuses(section, name):
    """The closed forms refuse nothing that a stage computes, and nothing else stops it there."""
    for end in (0, 1):
        inside, outside = (1 + 1e-9, 1 - 1e-9) if end == 0 else (1 - 1e-9, 1 + 1e-9)
        assert [*without_orbit(moved(name, section, inside, end))] == []
        config = moved(name, section, outside, end)
        lines = [*without_orbit(config)]
        assert [line.split(":")[0].split(".")[1] for line in lines] == (
            [name] if end == 0 or section == COMPARED else []
        )
        if lines:
            function = stage(section).STAGE[name]
            settings = {key: config[key] for key in ("release", "largest_step")}
            with pytest.raises(NoOrbit):
                computed(function, config[section][name] | settings)


def test_thresholds_of_bifurcations_need_no_orbit():
    config = moved("thresholds", COMPARED, 0.9, 0)
    config[COMPARED]["thresholds"]["quantities"] = ["saddle_node", "permanent_contact"]
    assert [*without_orbit(config)] == []


def test_the_closed_forms_are_those_of_the_restitution_model():
    for n, r in product((1, 2, 5, 20), (1e-6, 0.05, 0.65, 1.0)):
        bifurcations = restitution.saddle_node(n, r), restitution.period_doubling(n, r)
        assert stable_range(n, r) == pytest.approx(bifurcations, rel=1e-14)

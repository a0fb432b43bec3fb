"""What a user sees: targets by name, reproducible bytes, interruptions."""

import re
import signal

import pytest
import yaml

from bouncing_ball.configuration.stages import Kind, names, studied, tables

PAPER_FIGURES = names(Kind.FIGURE)
FIGURES = names(Kind.FIGURE, Kind.EXTENSION)


def test_one_figure_by_its_name_makes_that_figure_only(fresh):
    fresh.run("--cores", "2", "fig11")
    assert set(fresh.contents("results")) == {
        "figures/fig11.nc",
        "figures/fig11.png",
        "figures/fig11.svg",
    }


def test_a_run_makes_every_figure_and_table(pristine):
    made = set(pristine.contents("results"))
    pictures = {f"figures/{name}.{kind}" for name in FIGURES for kind in ("png", "svg")}
    data = {f"figures/{stage.name}.nc" for stage in studied()}
    texts = {f"figures/{name}.{kind}" for name in tables() for kind in ("csv", "md", "tex")}
    assert made == pictures | data | texts | {"paper.md", "tally.txt"}


def test_a_run_touches_no_tracked_file(pristine, fresh):
    before = fresh.contents()
    after = {k: v for k, v in pristine.contents().items() if not k.startswith("results/")}
    assert after == before


def test_up_to_date_means_nothing_to_do(complete):
    assert complete.planned() == set()


def whole(tree):
    """The results under their own names; what is being written has another."""
    return {name: data for name, data in tree.contents("results").items() if ".part" not in name}


def test_a_killed_run_is_resumed_and_gives_the_same_bytes(pristine, fresh):
    fresh.interrupt(signal.SIGKILL, "--cores", "2", after=4)
    expected, early = pristine.contents("results"), whole(fresh)
    assert 0 < len(early) < len(expected)
    # What is there under its own name is whole, even after a kill.
    assert [name for name, content in early.items() if content != expected[name]] == []
    # Snakemake could not remove its lock; it says so and names this command.
    assert "--unlock" in fresh.run("--cores", "2", check=False).stderr
    fresh.run("--unlock")
    # Another number of jobs at a time, another order.
    fresh.run("--cores", "1")
    after = whole(fresh)
    assert after.keys() == expected.keys()
    assert [name for name in after if after[name] != expected[name]] == []


@pytest.mark.parametrize("sign", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupted_run_is_resumed(pristine, fresh, sign):
    run = ("--cores", "2", "fig11", "fig12")
    fresh.interrupt(sign, *run, after=1)
    expected = pristine.contents("results")
    early = whole(fresh)
    assert all(content == expected[name] for name, content in early.items())
    fresh.run(*run)
    after = whole(fresh)
    kinds = {f"figures/{name}.{kind}" for name in run[2:] for kind in ("nc", "png", "svg")}
    assert early.keys() < after.keys() == kinds
    assert [name for name in after if after[name] != expected[name]] == []


def test_report_shows_every_figure_offline(complete):
    complete.run("--report", "results/report.html")
    page = (complete.path / "results" / "report.html").read_text(encoding="utf-8")
    for name in FIGURES:
        assert f"results/figures/{name}.png" in page
    for name in PAPER_FIGURES:
        assert f"Figure {int(name[3:])}." in page
    loaded = re.findall(r"<(?:script|link|img)[^>]+(?:src|href)=[\"'](\w+:[^\"']*)", page)
    assert [url for url in loaded if not url.startswith("data:")] == []


def test_an_orbit_that_does_not_exist_is_one_line(fresh):
    # The restitution orbit exists there; the branch of a contact as soft as this
    # one ends before.
    fresh.configure("figures", "fig07", "frequency_ratio", value=0.2)
    done = fresh.run("--cores", "1", "fig07", check=False)
    assert done.returncode == 1
    said = [line for line in done.stderr.splitlines() if "fig07" in line]
    assert len(said) == 1 and "no 1-T orbit" in said[0]
    assert "Traceback" not in done.stderr
    assert not (fresh.path / "results").exists()


def test_configuration_page_is_the_schemas(fresh):
    from bouncing_ball.configuration.documentation import configuration_page

    folder = fresh.path / "config"
    schema, config = (
        yaml.safe_load((folder / name).read_text(encoding="utf-8"))
        for name in ("schema.yaml", "config.yaml")
    )
    page = (folder / "README.md").read_text(encoding="utf-8")
    assert page == configuration_page(schema, config), "run `make config-docs`"

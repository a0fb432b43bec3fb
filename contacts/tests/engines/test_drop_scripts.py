"""The scripts that drop a ball in an engine print what the answer promises."""

import re
import subprocess
import sys

import pytest
from asked_contacts import answered
from installed_engines import only_if_installed

from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_contacts.cli.design import answer_design
from bouncing_ball_contacts.engines.drop_scripts import ENGINES, drop_script

GIVEN = {"mass": 0.5, "restitution": 0.75, "time_step": "2 ms"}


def script(name, path):
    return answer_design(GIVEN | {"engine": name, "radius": None}, path / "drop.py")


@pytest.mark.parametrize("name", ENGINES)
def test_a_script_has_the_recipe_and_no_placeholder(name, tmp_path):
    settings = script(name, tmp_path).engine
    text = (tmp_path / "drop.py").read_text(encoding="utf-8")
    compile(text, name, "exec")
    recipe = settings.snippet.splitlines()
    assert set(recipe[1:]) <= set(text.splitlines()) and "@" not in text
    # Without imports and comments.
    without = ("#", '"""A', "import", "from", "  <!--", "       sol")
    code = [line for line in text.splitlines() if line and not line.startswith(without)]
    assert len(code) <= 15 and not any(";" in line for line in code)


def test_a_script_is_for_an_engine_that_runs_from_python(tmp_path, refusal):
    with refusal(ModelError, "no script is written for mercurydpm: one of mujoco, pybullet"):
        script("mercurydpm", tmp_path)
    with refusal(ModelError, "script needs engine, such as mujoco"):
        answer_design({"mass": 1, "stiffness": 1e5, "restitution": 0.8}, tmp_path / "drop.py")
    with refusal(ModelError, "'drop.txt' does not end in .py"):
        answer_design(GIVEN | {"engine": "mujoco"}, type(tmp_path)("drop.txt"))
    fine = answered(mass=0.5, stiffness=1e9, restitution=0.75, engine="drake",
                    restitution_error=1e-5).engine  # fmt: skip
    with refusal(ModelError, "a drop in drake takes too many steps"):
        drop_script(fine, None, 9.81)


@pytest.mark.engines
@pytest.mark.parametrize("name", ENGINES)
def test_a_script_prints_the_rebound(name, tmp_path):
    only_if_installed(name)
    drop = script(name, tmp_path).engine.drop
    # The one of LAMMPS writes a file where it runs.
    run = subprocess.run(
        [sys.executable, "drop.py"], cwd=tmp_path, capture_output=True, text=True, check=True
    )
    (rise,) = re.findall(r"dropped from 1 m it rises to (\S+) m", run.stdout)
    # Four digits are printed, of numbers of single precision in PyBullet.
    assert drop.rise.least - 1e-3 <= float(rise) <= drop.rise.most + 1e-3

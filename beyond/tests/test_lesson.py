"""The second part of the lesson shows every scene of the explorer."""

import json
import re
from importlib.resources import files
from pathlib import Path

PAGE = Path(__file__).parents[1] / "docs" / "lesson.md"


def test_the_lesson_shows_every_scene_of_the_stage():
    scenes = json.loads(files("bouncing_ball_beyond.explorer").joinpath("scenes.json").read_text())
    shown = re.findall(r"\(\.\./figures/explorer\.html#scene=(\w+)\)", PAGE.read_text("utf-8"))
    assert sorted(shown) == sorted(scenes)

"""The formulas of laws that sentences quote are their forces."""

import re

import numpy as np
import pytest

from bouncing_ball_beyond.models.named_laws import LAWS


@pytest.mark.parametrize("name", [name for name, law in LAWS.items() if law.formula])
def test_the_formula_of_a_law_is_its_force(name):
    text = re.sub(
        "√(x)?", lambda root: f"np.sqrt({root[1]})" if root[1] else "np.sqrt", LAWS[name].formula
    )
    # A product is written as two factors side by side.
    product = re.sub(r"(?<=[\w)]) (?=[\w(])", "*", text.replace("ẋ", "v")).replace("^", "**")
    k, c = 3.0, 0.2
    for x, v in ((0.5, 1.5), (2.0, -0.7)):
        force = eval(product, {"np": np, "m": 1.0, "k": k, "C": c, "x": x, "v": v})
        assert float(LAWS[name](k, c).force(x, v)) == pytest.approx(force, rel=1e-12)

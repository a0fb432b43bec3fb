"""A small replication of two datasets, heavy and light, their claims, a table and a text, which is
edited, run and compared as one does with the real one. Its files of code are read when it runs.
"""

import runpy
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import yaml

from bouncing_ball import datasets
from bouncing_ball.accept import accept
from bouncing_ball.artifacts import Product, text
from bouncing_ball.compare import Comparison

FILES = {
    "src/study.py": """
import numpy as np
import xarray as xr

def heights(amplitude, printed):
    ratio = np.linspace(1.0, 10.0, 4)
    return xr.Dataset(
        {"max_height": (("amplitude", "frequency_ratio"), np.outer(amplitude, 1 / ratio))},
        {"amplitude": amplitude, "frequency_ratio": ratio},
    ).assign(printed=float(printed))
""",
    "src/model.py": "GRAVITY = 1.0\n",
    "src/judge.py": """
import xarray as xr

LIMIT = 2.0
CLAIMS = {"low": "heavy", "high": "light", "both": "heavy, light"}

def judge(data):
    heights = {name: max(data[each].max_height.max() for each in deciding.split(", "))
               for name, deciding in CLAIMS.items()}
    found = {name: "reproduced" if height < LIMIT else "contradicted"
             for name, height in heights.items()}
    return xr.Dataset(
        {"verdict": ("claim", [*found.values()]), "decided_by": ("claim", [*CLAIMS.values()])},
        {"claim": [*found]},
    )
""",
    "src/table.py": 'HEADING = "height"\n',
    "templates/paper.md": "The greatest height is {:.3f}, the verdicts are {}.\n",
    "config/config.yaml": """
release: displacement
stage:
  heavy: { amplitude: [0.5, 1.0] }
  light: { amplitude: [1.0, 1.5] }
""",
    "config/printed.csv": "0.255\n",
    "README.md": "read me\n",
}


@dataclass(frozen=True)
class Project:
    """A checkout with its reference, and a folder of results beside it."""

    top: Path
    CODE = ("src", "templates", "config")

    @property
    def results(self) -> Path:
        return self.top.with_name("results")

    @property
    def config(self) -> dict:
        return yaml.safe_load((self.top / "config/config.yaml").read_text("utf-8"))

    def code(self, name: str) -> dict:
        return runpy.run_path(str(self.top / "src" / f"{name}.py"))

    @property
    def products(self) -> list[Product]:
        """What follows from the datasets, by the code of now."""

        def judge(data, folder):
            judged = self.code("judge")["judge"](data)
            datasets.save(judged, folder / "figures/claims.nc", "Claims", {}, [])

        def table(data):
            greatest = float(data["heavy"].max_height.max())
            return f"{self.code('table')['HEADING']}\n{greatest:.3f}\n"

        def paper(data):
            template = (self.top / "templates/paper.md").read_text("utf-8")
            verdicts = ", ".join(data["claims"].verdict.values)
            return template.format(float(data["light"].max_height.max()), verdicts)

        needs = ("heavy", "light")
        return [
            Product(("figures/claims.nc",), needs, judge, ("src/judge.py",)),
            text("figures/heavy.md", ("heavy",), table, ("src/table.py",)),
            text("paper.md", (*needs, "claims"), paper, ("templates/paper.md",)),
        ]

    def run(self) -> None:
        """Make the results."""
        (self.results / "figures").mkdir(parents=True, exist_ok=True)
        printed = self.top / "config/printed.csv"
        study = self.top / "src/study.py"
        codes = {
            "heavy": [study, self.top / "src/model.py"],
            "light": [study, self.top / "src/model.py", printed],
        }
        for name, parameters in self.config["stage"].items():
            heights = self.code("study")["heights"](
                np.array(parameters["amplitude"]) * self.code("model")["GRAVITY"],
                printed.read_text() if name == "light" else "0",
            )
            known = {**parameters, "release": self.config["release"]}
            path = self.results / "figures" / f"{name}.nc"
            datasets.save(heights, path, name, known, codes[name])
        self.follow()

    def follow(self) -> None:
        """Make what follows from the datasets of the results."""
        data = {
            name: datasets.read(self.results / f"figures/{name}.nc")
            for name in self.config["stage"]
        }
        judged = self.code("judge")["judge"](data)
        code = [self.top / "src/judge.py", self.top / "config/printed.csv"]
        datasets.save(judged, self.results / "figures/claims.nc", "Claims", {}, code)
        data["claims"] = judged
        for product in self.products[1:]:
            product.make(data, self.results)

    def accept(self, *names: str, further: Sequence[Product] = ()) -> list[str]:
        folders = self.results, self.top
        products = [*self.products, *further]
        return accept(*folders, products, self.config, names, self.CODE, self.top)

    def lines(self, *names: str, reference: Path | None = None) -> list[str]:
        folders = self.results, reference or self.top
        return Comparison(*folders, self.products, self.config, names, self.top).lines

    def edit(self, file: str, old: str, new: str) -> None:
        path = self.top / file
        before = path.read_text("utf-8")
        assert old in before
        path.write_text(before.replace(old, new, 1), "utf-8")

    def change(self, name: str, folder: Path, change) -> None:
        """Rewrite a dataset as `change` returns it."""
        path = folder / "figures" / f"{name}.nc"
        change(datasets.read(path)).to_netcdf(path, engine="netcdf4")

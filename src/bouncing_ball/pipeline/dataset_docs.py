"""The dictionary of all datasets: a page in Markdown, made from the datasets of the record."""

from collections.abc import Iterable, Mapping

import xarray as xr

from bouncing_ball.pipeline.artifacts import Artifact

_HEAD = """# The variables of all datasets

Every dataset of the record: what each of its variables is, over which dimensions it is given, its
unit, its symbol and its equation in the paper, and where it is shown. `make config-docs` makes this
page from the datasets themselves. Everything is dimensionless except angles: times are Ωt, lengths
Ω²y/g, velocities Ωẏ/g. The parameters are among the attributes of each dataset.

```python
import bouncing_ball

data = bouncing_ball.open("{example}")  # an xarray.Dataset
data.plot("figure.pdf")  # its figure, if it has one
```
"""
_TABLE = """
| name | over | unit | symbol | equation | meaning |
| --- | --- | --- | --- | --- | --- |
"""


def in_record(path: str) -> str:
    """The path in the record of a file that a run makes.

    Examples
    --------
    >>> in_record("results/figures/fig14.nc"), in_record("config/ext_bounces.nc")
    ('figures/fig14.nc', 'config/ext_bounces.nc')
    """
    return path.removeprefix("results/")


def _cell(text: str) -> str:
    return text.replace("|", r"\|")


def _row(name: str, variable: xr.DataArray) -> str:
    """The row of a variable; a number is over nothing."""
    told = [str(variable.attrs.get(key, "")) for key in ("units", "symbol", "equation")]
    over = "itself" if variable.dims == (name,) else ", ".join(map(str, variable.dims))
    cells = [f"`{name}`", over, *told, str(variable.attrs["long_name"])]
    return f"| {' | '.join(_cell(cell) for cell in cells)} |\n"


def _shown(artifact: Artifact, readers: Iterable[str]) -> str:
    """The sentence about what is made from a dataset, empty if there is nothing."""
    made = [f"`{in_record(file)}`" for file in artifact.files if file != artifact.dataset]
    parts = [f"Shown in {', '.join(made)}."] if made else []
    if names := ", ".join(readers):
        parts.append(f"Read by {names}.")
    return " ".join(parts)


def dictionary(artifacts: Iterable[Artifact], datasets: Mapping[str, xr.Dataset]) -> str:
    """The page: a section for each artifact with a dataset, in the order of the rules.

    Parameters
    ----------
    artifacts : iterable of Artifact
    datasets : mapping
        The accepted datasets by the names of their artifacts.
    """
    listed = [each for each in artifacts if each.dataset and each.name in datasets]
    page = _HEAD.format(example=in_record(str(listed[0].dataset)))
    for each in listed:
        data = datasets[each.name]
        readers = [other.name for other in listed if each.name in other.reads]
        page += f"\n## {each.name}\n\n{each.title}: `{in_record(str(each.dataset))}`."
        page += f" {_shown(each, readers)}".rstrip() + "\n" + _TABLE
        names = [*map(str, data.coords), *map(str, data.data_vars)]
        page += "".join(_row(name, data[name]) for name in names)
    return page

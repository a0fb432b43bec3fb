"""Results that were saved, with their figures and with their orbits, for a user."""

from pathlib import Path

import xarray as xr

from bouncing_ball_beyond.drawing.result import MADE_BY, Result
from bouncing_ball_beyond.inherited.datasets.files import read_dataset
from bouncing_ball_beyond.inherited.drawing import result
from bouncing_ball_beyond.inherited.errors import ModelError, ParameterError, shortened, suggesting
from bouncing_ball_beyond.periodic.branches.labelled import BranchDataset
from bouncing_ball_beyond.periodic.orbits.orbit import Orbit
from bouncing_ball_beyond.periodic.orbits.saved import fields_in, has_orbits

_OF_ORBITS = ("follow", "branch", "curve")


@suggesting
def open(path: str | Path) -> Result:
    """The dataset in a netCDF file, as :func:`bouncing_ball_beyond.inherited.open`.

    A branch or a curve has its orbits, as from :func:`bouncing_ball_beyond.read_orbits`.
    """
    return _result_of(result.open(path))


def _result_of(data: xr.Dataset) -> Result:
    """The dataset as the result of the call that made it."""
    of_orbits = data.attrs.get(MADE_BY) in _OF_ORBITS and has_orbits(data)
    kind = BranchDataset if of_orbits else Result
    return kind(data.data_vars, data.coords, data.attrs)


@suggesting
def read_orbits(source: str | Path | xr.Dataset) -> Orbit | BranchDataset:
    """Orbits, a branch or a curve from a netCDF file or a dataset, with the same bits.

    Such datasets are the result of :func:`bouncing_ball_beyond.branch` and what ``to_dataset()`` of
    an orbit, or of a branch that was followed, returns; ``to_netcdf(path)`` writes one to a file.

    Parameters
    ----------
    source : str, Path or Dataset
        The file, or the dataset. If the orbits obey a law of your own, its class must be defined.

    Returns
    -------
    Orbit or BranchDataset
        What was saved.

    Raises
    ------
    ModelError
        If there is no such file, if it contains no orbits, or if a law is not known.

    Examples
    --------
    >>> import bouncing_ball_beyond as bb
    >>> one = bb.orbit(bb.rigid(restitution=0.85), amplitude=0.9)
    >>> branch = bb.follow(one, to=1.2)
    >>> data = branch.to_dataset()
    >>> part = bb.read_orbits(data.isel(point=slice(2, 5)))
    >>> part.first("period doubling") == branch.first("period doubling")
    True
    >>> list(part.states()) == list(branch.states())[2:5]
    True
    """
    if not isinstance(source, str | Path | xr.Dataset):
        raise ParameterError(
            "{source} = {} is neither a path nor a dataset, such as that of to_dataset()",
            shortened(source),
        )
    where = "the dataset" if isinstance(source, xr.Dataset) else str(source)
    data = source if isinstance(source, xr.Dataset) else read_dataset(source)
    if not has_orbits(data):
        raise ModelError(
            f"{where} contains no orbits: it is no result of branch, and no to_dataset() of an "
            "orbit or a branch"
        )
    found = _result_of(data)
    return found if isinstance(found, BranchDataset) else Orbit(**fields_in(data))

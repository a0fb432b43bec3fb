"""How results become the reference.

Only results that follow from committed code and from the configuration in git are accepted, so that
the commit that a dataset names has the code that made it.
"""

import shutil
import tempfile
from collections.abc import Collection, Iterator, Mapping
from pathlib import Path
from typing import Any

import netCDF4
import xarray as xr

from bouncing_ball import datasets
from bouncing_ball.artifacts import Product
from bouncing_ball.compare import Comparison
from bouncing_ball.differences import dataset_differences, file_differences
from bouncing_ball.history import CHECKOUT

CODE = ("Snakefile", "config", "src", "workflow")
"""What must be committed, from the folder of the reference."""


def accept(
    results: str | Path,
    reference: str | Path,
    products: Collection[Product],
    config: Mapping,
    names: Collection[str] = (),
    code: Collection[str] = CODE,
    top: Path = CHECKOUT,
) -> list[str]:
    """Make results the reference: those named, or all; returns the files that were written.

    A dataset that agrees with that of the reference keeps its numbers, and names the commit, code
    and versions that gave them again, unless the code is still that of the commit that it names.
    Pictures, claims and texts are made anew from the datasets that are then the reference. Raises
    ValueError, with the reason, if a result is stale, incomplete, or not what its dataset gives,
    and if the code is not committed.
    """
    comparison = Comparison(results, reference, products, config, names, top)
    committed = [Path(reference) / each for each in code]
    for reason in unfit(comparison, committed):
        raise ValueError(f"nothing is accepted{reason}")
    data = dict(comparison.old.data)
    with tempfile.TemporaryDirectory() as scratch:
        made = Path(scratch)
        (made / "figures").mkdir()
        for name in comparison.names:
            if name not in comparison.derived:
                new = comparison.new.data[name]
                data[name] = renewed(comparison, name, new, made, committed)
        for product in products:
            known = [name for name in product.needs if name in data]
            changed = any(data[name] is not comparison.old.data.get(name) for name in known)
            if len(known) < len(product.needs) or not (changed or product in comparison.made):
                continue
            product.make(data, made)
            if product.is_dataset:
                name = product.artifact
                expected = datasets.read(made / product.files[0])
                (made / product.files[0]).unlink()
                data[name] = renewed(comparison, name, expected, made, committed)
        return list(moved(made, Path(reference)))


def unfit(comparison: Comparison, committed: list[Path]) -> Iterator[str]:
    """Why the results of a comparison must not become the reference."""
    edited = sorted(comparison.history.uncommitted(committed))
    if not comparison.history.head:
        yield ", because the commit of the code is unknown"
    if edited:
        yield f", commit first: {', '.join(edited)}"
    for finding in comparison.findings:
        if finding.of_results:
            yield f": {finding.line}"
    drew = [each for each in comparison.others["results"] if each.startswith("matplotlib")]
    if drew:
        yield f": pictures were drawn by {', '.join(drew)}"


def renewed(
    comparison: Comparison, name: str, expected: xr.Dataset, made: Path, committed: list[Path]
) -> xr.Dataset:
    """The dataset that becomes the reference; a file of the folder `made` if it is another one.

    Its numbers are those of the reference if these agree with the expected ones, and those of the
    results otherwise. Its provenance is that of the results.
    """
    agreeing = [
        side
        for side in (comparison.old, comparison.new)
        if name in side.data and not dataset_differences(expected, side.data[name])
    ]
    if not agreeing:
        raise ValueError(f"nothing is accepted: it changes the {name}; make and accept all results")
    side = agreeing[0]
    found = side.data[name]
    if side is comparison.old and name not in comparison.names:
        return found
    given = {key: comparison.new.data[name].attrs[key] for key in ("code", "versions")}
    same = side is comparison.old and given.items() <= found.attrs.items()
    history = comparison.history
    if same and history.since(str(found.attrs.get("commit")), committed) == []:
        return found
    copy = made / "figures" / f"{name}.nc"
    shutil.copyfile(side.folder / "figures" / copy.name, copy)
    with netCDF4.Dataset(copy, "a") as file:
        file.setncatts(given | {"commit": history.head})
    return datasets.read(copy)


def moved(source: Path, folder: Path) -> Iterator[str]:
    """Move the files that differ from one folder into another, each whole or not at all.

    What an earlier acceptance left unfinished, because it was killed, is removed.
    """
    for left in [*folder.glob(".*.part.*"), *folder.glob("figures/.*.part.*")]:
        left.unlink()
    for path in sorted(path for path in source.rglob("*") if path.is_file()):
        target = folder / path.relative_to(source)
        if path.suffix == ".nc" or not target.is_file() or file_differences(path, target):
            with datasets.whole(target) as unfinished:
                shutil.copyfile(path, unfinished)
            yield str(path.relative_to(source))


def main(
    products: Collection[Product], job: Any, code: Collection[str] = CODE, top: Path = CHECKOUT
) -> int | str:
    """Accept for a job of Snakemake, and print what was written; returns the exit status, or why
    nothing was accepted.
    """
    try:
        files = accept(**job.params, products=products, code=code, top=top)
    except ValueError as error:
        Path(job.log[0]).write_text(f"{error}\n", encoding="utf-8")
        return str(error)
    none = ["Nothing was written, because the reference has these results already."]
    written = [*files, f"{len(files)} files of the reference were written."]
    print("\n".join(written if files else none))
    return 0

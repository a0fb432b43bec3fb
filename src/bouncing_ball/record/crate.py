"""The results as an RO-Crate 1.1: what each file is, what made it, and from what.

All of it is read from the provenance that the files carry. The crate names no
person and no machine; the only time is that of the commit.
"""

import json
from collections.abc import Iterable, Mapping
from pathlib import Path, PurePosixPath
from typing import Any

from bouncing_ball.record.provenance import Provenance, file_digest
from bouncing_ball.record.recipe import Recipe, recorded

NAME = "ro-crate-metadata.json"
CONTEXT = "https://w3id.org/ro/crate/1.1/context"
PROFILE = "https://w3id.org/ro/crate/1.1"
FORMATS = {
    ".nc": "application/x-netcdf",
    ".png": "image/png",
    ".svg": "image/svg+xml",
    ".csv": "text/csv",
    ".md": "text/markdown",
    ".tex": "application/x-tex",
    ".txt": "text/plain",
    ".html": "text/html",
}

Entity = dict[str, Any]


def _ref(name: str) -> dict[str, str]:
    return {"@id": name}


def _id(path: str) -> str:
    """A file's name: within the results its path, else a place in the repository.

    Examples
    --------
    >>> _id("results/figures/fig08.nc"), _id("config/claims.yaml")
    ('figures/fig08.nc', '#config/claims.yaml')
    """
    parts = PurePosixPath(path).parts
    return "/".join(parts[1:]) if parts[0] == "results" else f"#{path}"


def _file(path: str) -> Entity:
    place = Path(path)
    return {
        "@id": _id(path),
        "@type": "File",
        "name": place.name,
        "encodingFormat": FORMATS[place.suffix],
        "contentSize": str(place.stat().st_size),
        "identifier": f"sha256:{file_digest(place)}",
    }


def _action(recipe: Recipe, made: Provenance) -> Entity:
    """The job that made some files, after the Process Run Crate."""
    return {
        "@id": f"#job/{_id(made.target)}",
        "@type": "CreateAction",
        "name": f"snakemake --cores 1 {made.target}",
        "instrument": _ref(_workflow(made.commit)),
        "object": [_ref(_id(path)) for path in sorted(json.loads(made.inputs))],
        "result": [_ref(_id(path)) for path in recipe.outputs],
        "description": (
            f"parameters sha256:{made.parameters}; sources sha256:{made.sources}; "
            f"lock sha256:{made.lock}; tree changed: {made.dirty}; "
            f"configuration changed: {made.configuration}"
        ),
    }


def _workflow(commit: str) -> str:
    return f"#workflow@{commit}"


def _instruments(made: Iterable[Provenance]) -> Iterable[Entity]:
    """The workflow at each commit, and the libraries that it ran with."""
    libraries: dict[str, dict[str, str]] = {}
    for one in made:
        libraries.setdefault(one.commit, {}).update(json.loads(one.versions))
    found = {}
    for commit, used in libraries.items():
        names = {f"#{name}@{version}": (name, version) for name, version in used.items()}
        found[_workflow(commit)] = {
            "@type": ["SoftwareSourceCode", "SoftwareApplication"],
            "name": "bouncing-ball, Snakemake workflow",
            "version": commit,
            "programmingLanguage": "Snakemake",
            "softwareRequirements": [_ref(name) for name in names],
        }
        for key, (name, version) in names.items():
            found[key] = {"@type": "SoftwareApplication", "name": name, "version": version}
    return ({"@id": name, **entity} for name, entity in found.items())


def crate(recipes: Iterable[Recipe], about: Mapping[str, str]) -> dict[str, Any]:
    """The metadata of a crate with all files that jobs made under ``results/``.

    Parameters
    ----------
    recipes : iterable of Recipe
        The jobs of a run, whose files are in the working directory.
    about : mapping
        ``name``, ``description``, ``license`` and ``datePublished`` of the whole.

    Raises
    ------
    ProvenanceError
        If a file does not say where it comes from.
    OSError
        If a file cannot be read.
    """
    jobs = sorted(recipes, key=lambda recipe: recipe.target)
    made = [recorded(recipe)[0] for recipe in jobs]
    files = [_file(path) for recipe in jobs for path in recipe.outputs]
    actions = [_action(*pair) for pair in zip(jobs, made, strict=True)]
    inside = {entity["@id"] for entity in files}
    outside: dict[str, Entity] = {}
    for one in made:
        for path, checksum in json.loads(one.inputs).items():
            if _id(path) not in inside:
                outside[_id(path)] = {
                    "@id": _id(path),
                    "@type": "CreativeWork",
                    "name": path,
                    "identifier": f"sha256:{checksum}",
                }
    root: Entity = {
        "@id": "./",
        "@type": "Dataset",
        **about,
        "license": _ref(about["license"]),
        "hasPart": [_ref(entity["@id"]) for entity in files],
        "mentions": [_ref(entity["@id"]) for entity in actions],
    }
    descriptor = {
        "@id": NAME,
        "@type": "CreativeWork",
        "conformsTo": _ref(PROFILE),
        "about": _ref("./"),
    }
    terms = {"@id": about["license"], "@type": "CreativeWork", "name": "The licence in LICENSE"}
    graph = [descriptor, root, terms, *_instruments(made), *files, *outside.values(), *actions]
    return {"@context": CONTEXT, "@graph": graph}

"""YAML files with keys twice, numbers to the base 60, aliases that expand, and hostile values.

The loader that reads configuration, tolerances and claims takes a mutated file
as a reader of it would, or refuses it in one line. So does what checks its values.
"""

import time
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import yaml
from ledger import mutated

from bouncing_ball.compare.tolerance_file import read_tolerances
from bouncing_ball.configuration.check import check_configuration, check_orbits
from bouncing_ball.configuration.yaml_file import ConfigurationError, read_yaml

ROOT = Path(__file__).resolve().parents[2]
FILES = ("config.yaml", "tolerances.yaml", "claims.yaml")
# A refusal or an answer within this; an alias bomb takes minutes.
SOON = 5.0


def twice(rng, lines: list[str]) -> list[str]:
    """A key of a mapping again, next to itself."""
    keys = [k for k, line in enumerate(lines) if is_pair(line)]
    at = int(rng.choice(keys))
    return [*lines[: at + 1], lines[at], *lines[at + 1 :]]


def sexagesimal(rng, lines: list[str]) -> list[str]:
    """A number as 1:30, which YAML 1.1 takes for 90."""
    keys = [k for k, line in enumerate(lines) if is_pair(line)]
    at = int(rng.choice(keys))
    value = f"{rng.integers(1, 60)}:{rng.integers(10, 60)}"
    value += str(rng.choice(["", ".5", ":00"]))
    changed = f"{lines[at].split(':')[0]}: {value}"
    return [*lines[:at], changed, *lines[at + 1 :]]


def bomb(rng, lines: list[str]) -> list[str]:
    """Aliases of aliases: few lines for more items than there is memory."""
    depth, width = int(rng.integers(8, 30)), int(rng.integers(8, 20))
    first = ["bomb0: &b0 [x, x]"]
    more = [f"bomb{k}: &b{k} [{', '.join([f'*b{k - 1}'] * width)}]" for k in range(1, depth)]
    return [*lines, *first, *more]


def cycle(rng, lines: list[str]) -> list[str]:
    """A collection that contains itself."""
    return [*lines, "self: &self [*self]"]


def tag(rng, lines: list[str]) -> list[str]:
    """A value that would be a Python object."""
    name = rng.choice(["object/apply:os.getcwd []", "name:os.system", "tuple [1, 2]"])
    return [*lines, f"tagged: !!python/{name}"]


def is_pair(line: str) -> bool:
    """Whether a line is a key with a plain value."""
    key, _, value = line.strip().partition(": ")
    return key.isidentifier() and bool(value) and value[0] not in "{[|>&*\"'#"


def checked(path: Path, name: str) -> None:
    """What a run or a comparison does with the file before anything else."""
    if name == "config.yaml":
        config = read_yaml(path)
        check_configuration(config, read_yaml(ROOT / "config" / "schema.yaml"))
        check_orbits(config)
    elif name == "tolerances.yaml":
        read_tolerances(path)
    else:
        read_yaml(path)


def hostile(rng, lines: list[str]) -> list[str]:
    """Values of another kind, somewhere else, or none."""
    other, _ = mutated(yaml.safe_load("\n".join(lines)), rng)
    return yaml.safe_dump(other, allow_unicode=True).split("\n")


MUST_FALL = (twice, sexagesimal, bomb, cycle, tag)


def torn(rng, lines: list[str]) -> list[str]:
    """Characters that another one stands for, anywhere: readable or not."""
    text = list("\n".join(lines))
    for _ in range(int(rng.integers(1, 4))):
        text[int(rng.integers(len(text)))] = str(rng.choice(list("\t\0:-{}[]&*!|>'\"%@`é\x85")))
    return "".join(text).split("\n")


KINDS = (*MUST_FALL, torn, hostile, hostile)


def wrong(path: Path, name: str, must_fall: bool) -> str:
    """What is wrong with the loader's answer; nothing if it is right."""
    start = time.monotonic()
    try:
        checked(path, name)
        said = "accepted" if must_fall else ""
    except ConfigurationError as error:
        said = "" if str(error).isprintable() else "more than one line"
    except Exception as error:
        said = f"{type(error).__name__}: {error}"
    took = time.monotonic() - start
    return said or (f"took {took:.1f} s" if took > SOON else "")


def attack(seed: int) -> Iterator[list[str]]:
    """Random mutations of the project's own files."""
    rng = np.random.default_rng(seed)
    texts = {
        name: (ROOT / "config" / name).read_text(encoding="utf-8").splitlines() for name in FILES
    }
    with TemporaryDirectory() as folder:
        path = Path(folder, "file.yaml")
        while True:
            kind = KINDS[int(rng.integers(len(KINDS)))]
            # The attack on ledgers has the values of the claims.
            name = str(rng.choice(FILES[:2] if kind is hostile else FILES))
            lines = kind(rng, texts[name])
            path.write_text("\n".join(lines) + "\n", encoding="utf-8", newline="\n")
            said = wrong(path, name, kind in MUST_FALL)
            new = [line for line in lines if line not in texts[name]] or ["a line twice"]
            fell = f"{kind.__name__} in {name}, {said}: {' / '.join(new)[:200]!r}"
            yield [fell if said else ""]

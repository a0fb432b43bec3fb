"""Results and logs tampered with, against the proof that `accept` asks for and `explain`.

The proof must refuse every change of what a file is made from, and of every file
that something is made from, and pass where only times have changed; `explain`
must answer in time, or say in one printable line why not.
"""

import contextlib
import itertools
import json
import os
import random
import shlex
import shutil
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

from matplotlib.figure import Figure

from bouncing_ball.configuration.yaml_file import read_yaml
from bouncing_ball.datasets.netcdf import read_dataset, write_dataset
from bouncing_ball.figures.style import save
from bouncing_ball.record.explain import explain, lines
from bouncing_ball.record.job_log import log_lines
from bouncing_ball.record.proof import RefusedError, check_made
from bouncing_ball.record.provenance import ProvenanceError, changes, digest
from bouncing_ball.record.recipe import Recipe, Run, gather
from bouncing_ball.record.revision import Revision

ROOT = Path(__file__).resolve().parents[2]
COMMIT = "c" * 40
SECONDS = 5.0


class SmallRun:
    """A figure, a table and a paper, made in no time, in the working directory.

    A checkout with sources and a configuration, the results of a run, and logs,
    all as those of the workflow; the numbers are those of the record.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def create(self) -> "SmallRun":
        for name in ("stage", "figure", "table", "paper"):
            script = self.folder / "workflow" / "scripts" / f"{name}.py"
            script.parent.mkdir(parents=True, exist_ok=True)
            script.write_text(f"# {name}\n", encoding="utf-8")
        (self.folder / "config").mkdir()
        shutil.copy(ROOT / "config" / "tolerances.yaml", self.folder / "config")
        if not (self.folder / "requirements.lock").exists():
            shutil.copy(ROOT / "requirements.lock", self.folder)
        self.configure(fig11=0.85)
        return self.make()

    def configure(self, **parameters: float) -> None:
        path = self.folder / "config" / "config.yaml"
        path.write_text(json.dumps({"fig11": 0.85, "table": 1} | parameters), encoding="utf-8")

    def recipes(self, config: dict | None = None) -> list[Recipe]:
        """What the workflow would make, from the configuration as it is."""
        config = config or read_yaml(self.folder / "config" / "config.yaml")

        def recipe(script, outputs, inputs=(), parameters=None):
            folder = "figures" if script == "figure" else "stages"
            return Recipe(
                outputs=tuple(f"results/{file}" for file in outputs),
                inputs=tuple(f"results/{file}" for file in inputs),
                sources=(f"workflow/scripts/{script}.py",),
                parameters="" if parameters is None else digest(parameters),
                log=f"results/logs/{folder}/{Path(outputs[0]).name}.log",
            )

        table = ["figures/thresholds.csv", "figures/thresholds.md", "figures/thresholds.tex"]
        return [
            recipe("stage", ["figures/fig11.nc"], parameters=config["fig11"]),
            recipe("stage", ["figures/thresholds.nc"], parameters=config["table"]),
            recipe("figure", ["figures/fig11.png", "figures/fig11.svg"], ["figures/fig11.nc"]),
            recipe("table", table, ["figures/thresholds.nc"]),
            recipe(
                "paper",
                ["paper.md"],
                ["figures/fig11.nc", "figures/thresholds.nc", "figures/thresholds.md"],
            ),
        ]

    def run(self, dirty: str = "no", config: dict | None = None) -> Run:
        written = read_yaml(self.folder / "config" / "config.yaml")
        changed = json.dumps(changes(config or written, written))
        return Run(self.folder, Revision(COMMIT, dirty), changed)

    def files(self) -> list[str]:
        """What is published, relative to the results."""
        paths = [Path(file) for recipe in self.recipes() for file in recipe.outputs]
        return sorted(path.relative_to("results").as_posix() for path in paths)

    def make(self, *names: str, run: Run | None = None, config: dict | None = None) -> "SmallRun":
        """Make the files of the jobs that write any of these, or all."""
        for recipe in self.recipes(config):
            if names and not {Path(file).name for file in recipe.outputs} & set(names):
                continue
            made = gather(recipe, run or self.run())
            for file in recipe.outputs:
                self.write(Path(file), made.attributes())
            silent = recipe.outputs[0].endswith((".csv", ".md"))
            log = Path(recipe.log)
            log.parent.mkdir(parents=True, exist_ok=True)
            text = "\n".join(["a line", *log_lines(recipe.outputs, made if silent else None)])
            log.write_text(text + "\n", encoding="utf-8")
        return self

    def write(self, path: Path, attributes: dict[str, str]) -> None:
        path.parent.mkdir(parents=True, exist_ok=True)
        if path.suffix == ".nc":
            data = read_dataset(ROOT / "figures" / path.name)
            kept = {k: v for k, v in data.attrs.items() if not k.startswith("provenance_")}
            data.attrs = kept | attributes
            write_dataset(data, path)
        elif path.suffix in (".png", ".svg"):
            save(Figure(figsize=(1, 1)), path, attributes)
        else:
            record = ROOT / path.relative_to("results")
            path.write_text(record.read_text(encoding="utf-8"), encoding="utf-8")

    def sign(self, file: str) -> None:
        """Put the checksum of a file, as it is now, into its job's log."""
        for recipe in self.recipes():
            if f"results/{file}" in recipe.outputs:
                log = Path(recipe.log)
                old = log.read_text(encoding="utf-8").splitlines()
                new = log_lines([f"results/{file}"])[0]
                text = [new if line.endswith(f" results/{file}") else line for line in old]
                log.write_text("\n".join(text) + "\n", encoding="utf-8")


def flipped(path: Path, chance: random.Random) -> str:
    content = bytearray(path.read_bytes())
    at, bit = chance.randrange(len(content)), chance.randrange(8)
    content[at] ^= 1 << bit
    path.write_bytes(content)
    return f"bit {bit} of byte {at} of {path.name}"


def cut(path: Path, chance: random.Random) -> str:
    size = chance.randrange(path.stat().st_size)
    path.write_bytes(path.read_bytes()[:size])
    return f"{path.name} cut to {size} bytes"


def _some_file(world: SmallRun, chance: random.Random) -> Path:
    return Path("results") / chance.choice(world.files())


def flip_a_file(world: SmallRun, chance: random.Random) -> str:
    return flipped(_some_file(world, chance), chance)


def cut_a_file(world: SmallRun, chance: random.Random) -> str:
    return cut(_some_file(world, chance), chance)


def flip_an_input_and_sign(world: SmallRun, chance: random.Random) -> str:
    file = chance.choice(["figures/fig11.nc", "figures/thresholds.nc", "figures/thresholds.md"])
    said = flipped(Path("results") / file, chance)
    world.sign(file)
    return f"{said}, signed"


def edit_a_source(world: SmallRun, chance: random.Random) -> str:
    path = chance.choice(sorted(Path("workflow/scripts").glob("*.py")))
    before = path.stat()
    said = flipped(path, chance)
    os.utime(path, ns=(before.st_atime_ns, chance.randrange(before.st_mtime_ns)))
    return f"{said}, and made old"


def edit_the_configuration(world: SmallRun, chance: random.Random) -> str:
    key, value = chance.choice(["fig11", "table"]), chance.random()
    world.configure(**{key: value})
    return f"{key} = {value}"


def edit_the_lock(world: SmallRun, chance: random.Random) -> str:
    return flipped(Path("requirements.lock"), chance)


def remove_a_file(world: SmallRun, chance: random.Random) -> str:
    path = chance.choice([p for p in Path("results").rglob("*.*") if p.is_file()])
    path.unlink()
    return f"{path.name} removed"


def edit_a_log(world: SmallRun, chance: random.Random) -> str:
    path = chance.choice(sorted(Path("results/logs").rglob("*.log")))
    text = path.read_text(encoding="utf-8")
    # One digit of a checksum, of a file or in the provenance.
    places = [
        i for i, c in enumerate(text) if c in "0123456789abcdef" and len(_word(text, i)) == 64
    ]
    at = chance.choice(places)
    path.write_text(text[:at] + ("0" if text[at] != "0" else "1") + text[at + 1 :], "utf-8")
    return f"character {at} of {path.name}"


def _word(text: str, at: int) -> str:
    start = end = at
    while start and text[start - 1].isalnum():
        start -= 1
    while end < len(text) and text[end].isalnum():
        end += 1
    return text[start:end]


def swap_pictures_of_a_dirty_tree(world: SmallRun, chance: random.Random) -> str:
    name = chance.choice(["fig11.png", "thresholds.csv", "fig11.nc", "paper.md"])
    world.make(name, run=world.run(dirty=chance.choice(["yes", "unknown"])))
    return f"{name} of a dirty tree"


def make_with_another_configuration(world: SmallRun, chance: random.Random) -> str:
    config = {"fig11": 0.85, "table": 1} | {chance.choice(["fig11", "table"]): chance.random()}
    name = chance.choice(["fig11.nc", "thresholds.nc"])
    world.make(name, run=world.run(config=config), config=config)
    return f"{name} with {config}"


REFUSED: list[Callable[[SmallRun, random.Random], str]] = [
    flip_a_file,
    cut_a_file,
    flip_an_input_and_sign,
    edit_a_source,
    edit_the_configuration,
    edit_the_lock,
    remove_a_file,
    edit_a_log,
    swap_pictures_of_a_dirty_tree,
    make_with_another_configuration,
]


def touch_all(world: SmallRun, chance: random.Random) -> str:
    for path in Path().rglob("*"):
        os.utime(path, ns=(0, chance.randrange(10**18)))
    return "all files with other times"


def make_some_again(world: SmallRun, chance: random.Random) -> str:
    names = chance.sample(["fig11.png", "thresholds.csv", "paper.md"], 2)
    world.make(*names)
    return f"{names} made again"


TAKEN = [touch_all, make_some_again]


def proof(world: SmallRun, chance: random.Random) -> str:
    """One tampering against the proof; what went wrong, or nothing."""
    wanted = chance.random() < 0.1
    said = chance.choice(TAKEN if wanted else REFUSED)(world, chance)
    try:
        check_made(world.recipes(), world.run())
        taken = True
    except RefusedError as error:
        taken = False
        if not str(error).isprintable() or "snakemake --cores 2" not in str(error):
            return f"{said}: {error!r}"
    return "" if taken == wanted else f"{said}: {'taken' if taken else 'refused'}"


def nonsense(chance: random.Random) -> object:
    """A value that an attribute may have."""
    return chance.choice(
        [
            "",
            "x" * chance.randrange(100_000),
            "\x1b[2J; rm -rf ~ $(date)\n",
            "{" * 2000,
            json.dumps({"../../etc/passwd": "0" * 64, "/dev/zero": "0" * 64}),
            json.dumps({"--cores": {"`date`": [1e308]}}),
            json.dumps({"a'b; date #": float("nan")}),
            chance.randrange(-(2**31), 2**31),
            float("nan"),
            [1.5, float("inf")],
            "results/figures/fig11.nc; date",
            "-rf",
            "9" * 5000,
        ]
    )


def explained(world: SmallRun, chance: random.Random) -> str:
    """One hostile file against `explain`; what went wrong, or nothing."""
    path = Path("results/figures", chance.choice(["fig11.nc", "fig11.png", "fig11.svg"]))
    if chance.random() < 0.5:
        said = chance.choice([flipped, cut])(path, chance)
    else:
        data = read_dataset("results/figures/fig11.nc")
        name = chance.choice([*data.attrs, "new"])
        data.attrs[name] = nonsense(chance)
        path = Path("results/figures/fig11.nc")
        write_dataset(data, path)
        said = f"{name} = {str(data.attrs[name])[:60]!r}"
    begun = time.monotonic()
    try:
        answer = explain(path)
        json.dumps(answer, allow_nan=False)
        shown = lines(answer)
        for command in answer["make_again"]:
            shlex.split(command)
    except ProvenanceError as error:
        shown = [str(error)]
    if not all(line.isprintable() for line in shown):
        return f"{said}: not printable"
    return f"{said}: slow" if time.monotonic() - begun > SECONDS else ""


def attack(seed: int) -> Iterator[list[str]]:
    """Small runs, one after the other."""
    with TemporaryDirectory() as folder, contextlib.ExitStack() as stack:
        template, copied = Path(folder, "template"), Path(folder, "copy")
        template.mkdir()
        with contextlib.chdir(template):
            SmallRun(template).create()
        stack.callback(os.chdir, ROOT)
        for number in itertools.count():
            shutil.copytree(template, copied)
            os.chdir(copied)
            chance = random.Random(f"{seed}/{number}")
            case = proof if chance.random() < 0.7 else explained
            try:
                why = case(SmallRun(copied), chance)
            except Exception as error:
                why = f"{type(error).__name__}: {error}"
            yield [f"seed {seed}, case {number}, {case.__name__}: {why}"[:300] if why else ""]
            os.chdir(ROOT)
            shutil.rmtree(copied)

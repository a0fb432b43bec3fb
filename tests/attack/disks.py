"""Disks that fill up while an artifact is written: no wrong file under its name.

The process may write so many bytes into a file and no more (RLIMIT_FSIZE, which
the kernel answers as it does a full disk, at any byte of any library's write).
"""

import resource
import signal
from collections.abc import Callable, Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from bouncing_ball.datasets.files import write_text
from bouncing_ball.datasets.netcdf import read_dataset, write_dataset
from bouncing_ball.figures.style import canvas, save, style

ROOT = Path(__file__).resolve().parents[2]


def writers() -> dict[str, Callable[[Path], None]]:
    """What writes an artifact of each kind, by the suffix."""
    data = read_dataset(ROOT / "figures" / "fig11.nc")
    text = (ROOT / "paper.md").read_text(encoding="utf-8")

    def draw(path: Path) -> None:
        figure, axes = canvas()
        axes.plot(np.arange(50.0) ** 2)
        save(figure, path, {"target": "x"})

    return {
        ".nc": lambda path: write_dataset(data, path),
        ".md": lambda path: write_text(path, text),
        ".png": draw,
        ".svg": draw,
    }


def limited(write: Callable[[Path], None], path: Path, limit: int) -> bool:
    """Whether the writer says that it could write, with files of so many bytes at most."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (limit, before[1]))
    try:
        write(path)
    except (OSError, RuntimeError):
        return False
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    return True


def attack(seed: int) -> Iterator[list[str]]:
    """Random limits, with and without an older file under the name."""
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    rng = np.random.default_rng(seed)
    with style(), TemporaryDirectory() as name:
        folder = Path(name)
        kinds = writers()
        whole = {}
        for suffix, write in kinds.items():
            path = folder / f"whole{suffix}"
            write(path)
            whole[suffix] = path.read_bytes()
        while True:
            suffix = str(rng.choice(list(kinds)))
            limit = int(rng.integers(0, int(1.1 * len(whole[suffix]))))
            older = bool(rng.integers(2))
            path = folder / f"case{suffix}"
            if older:
                path.write_bytes(b"older")
            done = limited(kinds[suffix], path, limit)
            found = path.read_bytes() if path.exists() else None
            expected = whole[suffix] if done else (b"older" if older else None)
            left = [part.name for part in folder.iterdir() if part.stem not in ("whole", "case")]
            fell = found != expected or left or (not done and limit >= len(whole[suffix]))
            yield [f"{suffix}, {limit} bytes, older file: {older}; left {left}" if fell else ""]
            for part in folder.glob("*"):
                if part.stem != "whole":
                    part.unlink()

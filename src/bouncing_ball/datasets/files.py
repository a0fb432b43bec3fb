"""Text files, written whole or not at all."""

from pathlib import Path

from bouncing_ball.datasets.atomic import replacing


def write_text(path: str | Path, text: str) -> None:
    """Write UTF-8 text, with the same line ends everywhere."""
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8", newline="\n")

"""Additions to the ``--help`` of a subcommand: an explanation, and examples to run."""

import textwrap
import tomllib
from importlib.resources import files

_WIDTH = 80
_TEXTS = tomllib.loads(files(__package__).joinpath("explained.toml").read_text("utf-8"))

EXPLAINED: dict[str, tuple[str, list[str]]] = {
    name: (" ".join(entry["text"].split()), entry["examples"])
    for name, entry in _TEXTS["commands"].items()
}
"""By subcommand: the explanation, and examples without the name of the program."""


def explained(command: str) -> str:
    """The end of the help of a subcommand: explanation, symbols and examples."""
    text, examples = EXPLAINED[command]
    lines = [*textwrap.wrap(text, _WIDTH), ""]
    if command not in ("design", "explain", "diff"):
        for symbol, meaning in _TEXTS["symbols"].items():
            lines += textwrap.wrap(f"{symbol}  {meaning}", _WIDTH, subsequent_indent="   ")
        lines += [""]
    return "\n".join([*lines, "examples:", *(f"  bouncing-ball {each}" for each in examples)])

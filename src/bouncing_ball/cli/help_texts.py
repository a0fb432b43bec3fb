"""The subcommands with their purposes, and the explanation and examples in their ``--help``."""

import textwrap
import tomllib
from pathlib import Path
from typing import Any

_WIDTH = 80
COMMANDS: dict[str, dict[str, Any]] = tomllib.loads(
    Path(__file__).with_suffix(".toml").read_text(encoding="utf-8")
)
"""By subcommand: purpose, module of its call, explanation, and examples without the program's name.

A module is imported when its subcommand is used, because the list of subcommands needs no numpy.
"""

_SYMBOLS = COMMANDS.pop("symbols")


def explained(command: str) -> str:
    """The end of the help of a subcommand: explanation, symbols and examples."""
    about = COMMANDS[command]
    lines = [*textwrap.wrap(about["text"], _WIDTH), ""]
    if command not in ("design", "explain", "diff"):
        for symbol, meaning in _SYMBOLS.items():
            lines += textwrap.wrap(f"{symbol}  {meaning}", _WIDTH, subsequent_indent="   ")
        lines += [""]
    examples = (f"  bouncing-ball {each}" for each in about["examples"])
    return "\n".join([*lines, "examples:", *examples])

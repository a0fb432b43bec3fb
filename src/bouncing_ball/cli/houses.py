"""The subcommands of the other houses, which add them when they are installed.

An entry point of the group ``bouncing_ball.commands`` names a mapping from subcommands to
:class:`~bouncing_ball.cli.commands.Command`. All that is known of the other houses here is which
command is whose, so that a command that is not installed is answered with how to install it.
"""

from importlib.metadata import entry_points

from bouncing_ball.cli.commands import COMMANDS, Command

_GROUP = "bouncing_ball.commands"
_HOUSE_OF = {
    "certify": "beyond",
    "curve": "beyond",
    "diagram": "beyond",
    "error-law": "beyond",
    "follow": "beyond",
    "law-limits": "beyond",
    "law-orbit": "beyond",
    "law-simulate": "beyond",
    "motion": "beyond",
    "design": "contacts",
    "fit": "contacts",
}
_FOLDERS = {"beyond": ". ./beyond", "contacts": ". ./beyond ./contacts"}


def commands() -> dict[str, Command]:
    """All subcommands that are installed, those of the root first."""
    found = dict(COMMANDS)
    for point in sorted(entry_points(group=_GROUP), key=lambda each: each.name):
        found |= point.load()
    return found


def how_to_install(command: str) -> str:
    """A sentence for a subcommand of a house that is not installed; empty for an unknown one.

    Examples
    --------
    >>> how_to_install("design")
    'design is a command of contacts: pip install . ./beyond ./contacts, or make everything'
    >>> how_to_install("orbits")
    ''
    """
    if command not in _HOUSE_OF:
        return ""
    house = _HOUSE_OF[command]
    return f"{command} is a command of {house}: pip install {_FOLDERS[house]}, or make everything"

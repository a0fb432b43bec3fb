"""codecheck.yml: what a checker of the computations makes again, from the stages.

``python -m bouncing_ball.pipeline.codecheck`` writes it in the working directory;
a test says when it is not what the stages make. What only a person can know is a
marked blank, see docs/publication.md.
"""

from typing import Any

import yaml

from bouncing_ball.configuration.stages import STAGES, Kind
from bouncing_ball.configuration.yaml_file import read_yaml
from bouncing_ball.datasets.files import write_text

NAME = "codecheck.yml"
_HEAD = (
    "# Made by `make codecheck` from the stages; the blanks are listed in docs/publication.md.\n"
)
_SHOWN = {Kind.FIGURE: "png", Kind.EXTENSION: "png", Kind.TABLE: "csv"}


def manifest() -> list[dict[str, str]]:
    """The files of the record that are to be made again, each with what it is.

    Examples
    --------
    >>> manifest()[7]["file"]
    'figures/fig08.png'
    """
    shown = [(stage, _SHOWN.get(stage.kind)) for stage in STAGES.values()]
    entries = [
        {"file": f"figures/{stage.name}.{suffix}", "comment": stage.title}
        for stage, suffix in shown
        if suffix
    ]
    return [*entries, {"file": "paper.md", "comment": "The article, every number from a dataset"}]


def codecheck(title: str) -> str:
    """The content of codecheck.yml, for an article with a title."""
    content: dict[str, Any] = {
        "version": "https://codecheck.org.uk/spec/config/1.0",
        "paper": {
            "title": title,
            "authors": [{"name": "BLANK-authors", "ORCID": "BLANK-authors"}],
            "reference": "BLANK-article-doi",
        },
        "manifest": manifest(),
        "codechecker": [{"name": "BLANK-codechecker", "ORCID": "BLANK-codechecker"}],
        "summary": "BLANK-codechecker",
        "repository": "BLANK-repository",
        "check_time": "BLANK-codechecker",
        "certificate": "BLANK-certificate",
        "report": "BLANK-certificate",
    }
    text = yaml.safe_dump(content, sort_keys=False, allow_unicode=True, width=100)
    return f"---\n{_HEAD}{text}"


def main() -> None:
    """Write codecheck.yml in the working directory."""
    write_text(NAME, codecheck(read_yaml("metadata.yaml")["title"]))


if __name__ == "__main__":
    main()

"""The schema of the configuration, from ``config/schema.yaml`` and the stages.

The file describes each kind of parameter once; what a figure or a table takes
is in its entry. Together they are a JSON schema.
"""

from collections.abc import Mapping
from typing import Any

from bouncing_ball.configuration.stages import STAGES
from bouncing_ball.configuration.yaml_file import ConfigurationError


def expanded(schema: Any) -> Any:
    """A schema without the abbreviations of ``config/schema.yaml``.

    Examples
    --------
    >>> expanded({"properties": {"n": "ratio"}})
    {'type': 'object', 'additionalProperties': False, 'required': ['n'], \
'properties': {'n': {'$ref': '#/$defs/ratio'}}}
    """
    if isinstance(schema, str):
        return {"$ref": f"#/$defs/{schema}"}
    full = dict(schema)
    if "$ref" in full:
        full["$ref"] = f"#/$defs/{full['$ref'].removeprefix('#/$defs/')}"
    if "items" in full:
        full["items"] = expanded(full["items"])
    for part in {"properties", "$defs"} & set(full):
        full[part] = {key: expanded(value) for key, value in full[part].items()}
    if "properties" in full:
        closed = {"type": "object", "additionalProperties": False}
        full = closed | {"required": list(full["properties"])} | full
    return full


def configuration_schema(kinds: Mapping[str, Any]) -> dict[str, Any]:
    """The schema of the whole configuration.

    Parameters
    ----------
    kinds : mapping
        The content of ``config/schema.yaml``.

    Raises
    ------
    ConfigurationError
        If an entry gives a parameter a kind that the file does not describe.
    """
    properties = dict(kinds["properties"])
    for stage in STAGES.values():
        for key, kind in stage.takes.items():
            if kind not in kinds["$defs"]:
                raise ConfigurationError(
                    f"{stage.name}: its parameter {key} has the kind {kind}, "
                    "which config/schema.yaml does not describe"
                )
        if stage.takes:
            section, name = stage.section.split(".")
            known = properties.get(section, {"properties": {}})["properties"]
            properties[section] = {"properties": known | {name: {"properties": stage.takes}}}
    return expanded({**kinds, "properties": properties})

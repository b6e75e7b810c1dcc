"""The messages as TypeScript types: ``python -m tarsus.studio.messages.typescript web/src/protocol.ts``."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any, get_args

from pydantic import BaseModel
from pydantic.json_schema import models_json_schema

from tarsus.robot.schema import RobotFile, robot_schema
from tarsus.studio.messages import CLOSED, SOCKET, ClientMessage, ServerMessage
from tarsus.studio.messages.general import PlayerData

__all__ = ["typescript"]

_HEAD = f"""\
// Written by `make protocol` from src/tarsus/studio/messages. Do not edit.

/** Path of the socket on the page's host. */
export const SOCKET = {json.dumps(SOCKET)};

/** Codes with which the server closes the socket. */
export const CLOSED = {{
{chr(10).join(f"  /** {why} */{chr(10)}  {name}: {code}," for name, (code, why) in CLOSED.items())}
}} as const;
"""
_PLAIN = {"string": "string", "number": "number", "integer": "number", "boolean": "boolean", "null": "null"}


def typescript() -> str:
    """Return the text of the TypeScript module that declares all messages."""
    clients, servers = (get_args(get_args(union)[0]) for union in (ClientMessage, ServerMessage))
    # Keys with defaults are always sent by the server; only clients may omit them.
    every = (*clients, *servers, PlayerData)
    models: list[tuple[type[BaseModel], Any]] = [(model, "serialization") for model in every]
    _, schema = models_json_schema(models, ref_template="{model}")
    parts = [_HEAD]
    loose = {model.__name__ for model in clients}
    for name, definition in sorted(schema["$defs"].items()):
        parts.append(_declare(name, definition, loose=name in loose))
    parts += [_union("ClientMessage", clients), _union("ServerMessage", servers)]
    parts += [_file_type()]
    return "\n".join(parts)


def _union(name: str, models: tuple[type[BaseModel], ...]) -> str:
    return f"export type {name} =\n" + "\n".join(f"  | {model.__name__}" for model in models) + ";\n"


def _file_type() -> str:
    """Return the types of a robot file, with optional keys, under separate names."""
    schema = robot_schema()
    definitions = {RobotFile.__name__: schema, **schema["$defs"]}
    declared = [
        _declare(_file_name(name), definition, loose=True, file=True) for name, definition in definitions.items()
    ]
    return "\n".join(declared)


def _file_name(name: str) -> str:
    return name if name == RobotFile.__name__ else f"File{name}"


def _declare(name: str, definition: dict[str, Any], *, loose: bool, file: bool = False) -> str:
    required = set(definition.get("required", ()))
    lines = [*_comment(definition.get("description"), ""), f"export interface {name} {{"]
    for key, spec in definition.get("properties", {}).items():
        lines += _comment(spec.get("description"), "  ")
        optional = "?" if loose and (key not in required or "default" in spec) else ""
        lines.append(f"  {key}{optional}: {_type(spec, file=file)};")
    return "\n".join([*lines, "}", ""])


def _comment(text: str | None, indent: str) -> list[str]:
    if not text:
        return []
    lines = text.splitlines()
    if len(lines) == 1:
        return [f"{indent}/** {text} */"]
    return [f"{indent}/**", *(f"{indent} * {line}".rstrip() for line in lines), f"{indent} */"]


def _type(spec: dict[str, Any], *, file: bool) -> str:
    if "ts" in spec:
        return str(spec["ts"])
    if "$ref" in spec:
        name = spec["$ref"].rpartition("/")[2]
        return _file_name(name) if file else str(name)
    if "const" in spec or "enum" in spec:
        return " | ".join(json.dumps(value) for value in spec.get("enum", [spec.get("const")]))
    choices = spec.get("anyOf") or spec.get("oneOf")
    if choices:
        return " | ".join(dict.fromkeys(_type(choice, file=file) for choice in choices))
    if spec.get("type") == "array":
        return _array(spec, file=file)
    return _PLAIN[spec["type"]]


def _array(spec: dict[str, Any], *, file: bool) -> str:
    if "prefixItems" in spec:
        return f"[{', '.join(_type(item, file=file) for item in spec['prefixItems'])}]"
    item = _type(spec["items"], file=file)
    return f"({item})[]" if " | " in item else f"{item}[]"


if __name__ == "__main__":
    Path(sys.argv[1]).write_text(typescript(), encoding="utf-8")

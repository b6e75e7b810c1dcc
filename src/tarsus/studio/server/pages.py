"""Static files of the front end, read and compressed once; no other files are served."""

from __future__ import annotations

import gzip
import hashlib
import html
import mimetypes
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from tarsus.studio.player import BUILD_HINT, WEB

if TYPE_CHECKING:
    from fastapi import Request, Response

__all__ = ["Pages"]

_LEAST_COMPRESSED = 1000
_KINDS = {".js": "text/javascript", ".css": "text/css", ".wasm": "application/wasm", ".webmanifest": "application/json"}


@dataclass(frozen=True)
class _File:
    """A file with its headers."""

    content: bytes
    packed: bytes | None
    kind: str
    tag: str
    immutable: bool

    @classmethod
    def of(cls, path: Path, *, immutable: bool) -> _File:
        content = path.read_bytes()
        kind = _KINDS.get(path.suffix) or mimetypes.guess_type(path.name)[0] or "application/octet-stream"
        packed = gzip.compress(content, compresslevel=9, mtime=0) if len(content) > _LEAST_COMPRESSED else None
        if packed is not None and len(packed) > 0.9 * len(content):
            packed = None
        text = kind.startswith("text/") or kind.endswith(("json", "xml"))
        return cls(
            content=content,
            packed=packed,
            kind=f"{kind}; charset=utf-8" if text else kind,
            tag=f'"{hashlib.sha256(content).hexdigest()[:20]}"',
            immutable=immutable,
        )


class Pages:
    """The built front end, held in memory.

    Parameters
    ----------
    folder : path
        Folder of the built front end.
    """

    def __init__(self, folder: Path = WEB) -> None:
        files = sorted(path for path in folder.rglob("*") if path.is_file()) if folder.is_dir() else []
        # Names of assets contain a hash of their content, so they can be cached permanently.
        self._files = {
            path.relative_to(folder).as_posix(): _File.of(path, immutable=path.parent.name == "assets")
            for path in files
        }

    @property
    def built(self) -> bool:
        """Whether the front end has been built."""
        return "index.html" in self._files

    def answer(self, request: Request, name: str) -> Response:
        """Return the response to a request for a file.

        Parameters
        ----------
        request : Request
            The request, for its caching and compression headers.
        name : str
            Path of the file in the folder; empty for the page itself.
        """
        from fastapi import Response

        if not self.built and name in ("", "index.html"):
            page = f"<!doctype html><title>Tarsus Studio</title><p>{html.escape(BUILD_HINT)}</p>"
            return Response(page, status_code=503, media_type="text/html")
        file = self._files.get(name or "index.html")
        if file is None:
            return Response("no such file", status_code=404, media_type="text/plain")
        caching = "public, max-age=31536000, immutable" if file.immutable else "no-cache"
        headers = {"etag": file.tag, "cache-control": caching, "vary": "accept-encoding"}
        if file.tag in request.headers.get("if-none-match", ""):
            return Response(status_code=304, headers=headers)
        content = file.content
        if file.packed is not None and "gzip" in request.headers.get("accept-encoding", ""):
            content, headers["content-encoding"] = file.packed, "gzip"
        return Response(content, headers=headers, media_type=file.kind)

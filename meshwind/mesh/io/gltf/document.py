"""The JSON of GLB and GLTF files with the buffers that it refers to, by the glTF 2.0 specification."""

import base64
import binascii
import json
import re
import struct
from pathlib import Path
from typing import Any, NoReturn
from urllib.parse import unquote, unquote_to_bytes

import numpy as np

from meshwind.core.cast import Floats
from meshwind.core.errors import BadInputError

INSTANCING, VISIBILITY = "EXT_mesh_gpu_instancing", "KHR_node_visibility"
DRACO = "KHR_draco_mesh_compression"
MESHOPT = ("EXT_meshopt_compression", "KHR_meshopt_compression")
_READ = ("KHR_mesh_quantization", "KHR_accessor_float64", INSTANCING, VISIBILITY)
_HARMLESS = (
    "KHR_materials_", "KHR_texture_", "KHR_lights_", "KHR_node_selectability", "KHR_node_hoverability", "KHR_xmp",
    "KHR_animation_pointer", "KHR_audio", "KHR_interactivity", "KHR_techniques_webgl", "KHR_physics_rigid_bodies",
    "EXT_texture_", "EXT_textureInfo_", "EXT_lights_", "EXT_mesh_manifold", "EXT_mesh_features",
    "EXT_mesh_primitive_restart", "EXT_mesh_primitive_edge_visibility", "EXT_instance_features", "EXT_feature_metadata",
    "EXT_structural_metadata", "MSFT_packing_", "MSFT_texture_", "MSFT_lod", "ADOBE_materials_", "AGI_stk_metadata",
    "BENTLEY_materials_", "CESIUM_primitive_outline", "FB_geometry_metadata", "GODOT_single_root", "NV_materials_",
    "VRMC_", "VRM",
)  # fmt: skip
"""Beginnings of the extensions that say nothing of the shape that is shown first."""
_JSON, _BIN = 0x4E4F534A, 0x004E4942
_ADDRESS = re.compile(r"[a-z][a-z0-9+.-]+:", re.IGNORECASE)


def is_harmless(extension: str) -> bool:
    """Whether an extension is read, or changes nothing of the shape."""
    return extension in _READ or extension.startswith(_HARMLESS)


def whole(value: object, what: str) -> int:
    """A whole number that is not negative; JSON may write it with a decimal point (clause 2.5)."""
    if isinstance(value, bool) or not isinstance(value, int | float) or value < 0 or value != value // 1:
        raise ValueError(f"{what} is {str(value)[:20]}, not a whole number")
    return int(value)


def numbers(value: object, count: int, what: str) -> Floats:
    """An array of finite numbers, of the given length or of any if count is negative."""
    array = np.array(value, dtype=np.float64)
    if array.ndim != 1 or (count >= 0 and len(array) != count) or not np.isfinite(array).all():
        raise ValueError(f"{what} is not of {count if count >= 0 else 'finite'} numbers")
    return array


def table(value: object, what: str) -> dict[str, Any]:
    """An object of JSON."""
    if not isinstance(value, dict):
        raise ValueError(f"{what} is no object")
    return value


class Document:
    """A file's JSON and buffers."""

    def __init__(self, path: Path) -> None:
        self.path, self.name = path, path.name
        text, self._chunk = _chunks(path)
        self.tree = table(json.loads(text.decode("utf-8-sig"), parse_constant=_no_number), "its JSON")
        self._buffers: dict[int, bytes] = {}
        self._check()

    def entries(self, kind: str) -> list[Any]:
        """All entries of one kind, such as "nodes"."""
        held = self.tree.get(kind, [])
        if not isinstance(held, list):
            raise ValueError(f"its {kind} are no list")
        return held

    def entry(self, kind: str, number: object) -> dict[str, Any]:
        """The entry of a number."""
        held, at = self.entries(kind), whole(number, f"a number of its {kind}")
        if at >= len(held):
            raise ValueError(f"it refers to number {at} of its {len(held)} {kind} (0 is the first)")
        return table(held[at], f"number {at} of its {kind}")

    def extensions(self, held: dict[str, Any]) -> dict[str, Any]:
        """Extensions of an entry by name."""
        return table(held.get("extensions", {}), "an entry's extensions")

    def compressed(self, extension: str) -> NoReturn:
        """Refuse geometry that is compressed."""
        raise BadInputError(
            f"{self.name}: needs the extension {extension} (compressed geometry), which is not read; "
            "export it without compression"
        )

    def buffer(self, number: object) -> bytes:
        """Content of a buffer: the GLB chunk, data in the JSON, or a file beside this one."""
        entry, at = self.entry("buffers", number), whole(number, "a buffer's number")
        if at not in self._buffers:
            self._buffers[at] = self._content(entry, at)
        return self._buffers[at]

    def has_content(self, number: object) -> bool:
        """Whether a buffer has bytes of its own; placeholders for what is compressed have none."""
        entry = self.entry("buffers", number)
        return "uri" in entry or (whole(number, "a buffer's number") == 0 and self._chunk is not None)

    def _content(self, entry: dict[str, Any], number: int) -> bytes:
        uri, size = entry.get("uri"), whole(entry.get("byteLength", 0), "a buffer's length")
        if uri is None:
            content = self._chunk if number == 0 else None
            if content is None:
                raise ValueError(f"buffer {number} has no content")
        elif not isinstance(uri, str):
            raise ValueError(f"the address of buffer {number} is no text")
        else:
            content = _embedded(uri, number) if uri[:5].lower() == "data:" else self._beside(uri)
        if len(content) < size:
            raise BadInputError(
                f"{self.name}: buffer {number} has {len(content)} of {size} bytes; copy or export the mesh again"
            )
        return content

    def _beside(self, uri: str) -> bytes:
        """A file in this one's folder or below; no other is opened."""
        if _ADDRESS.match(uri):
            raise BadInputError(
                f"{self.name}: its buffer is at an address, {uri[:80]!r}, which is not opened; export it as GLB"
            )
        folder, name = self.path.parent.resolve(), unquote(uri)
        file = (folder / name).resolve()
        if not file.is_relative_to(folder):
            raise ValueError("it refers to a file outside its folder")
        if not file.is_file():
            raise BadInputError(
                f"{self.name}: its buffer {name[:80]} is not in its folder; put it there, or export as GLB"
            )
        return file.read_bytes()

    def _check(self) -> None:
        """Refuse other versions (clause 3.2), and extensions that are required and not read (clause 3.12)."""
        asset = table(self.tree.get("asset", {}), "its asset")
        version, least = str(asset.get("version", "")), str(asset.get("minVersion", "2.0"))
        if not version.startswith("2."):
            raise BadInputError(
                f"{self.name}: is glTF {version[:20] or 'of no version'}, not 2.0; export it again as glTF 2.0"
            )
        if least != "2.0":
            raise BadInputError(
                f"{self.name}: needs a reader of glTF {least[:20]}, and 2.0 is read; export it as glTF 2.0"
            )
        for extension in map(str, self.entries("extensionsRequired")):
            if extension == DRACO or extension in MESHOPT:
                self.compressed(extension)
            if not is_harmless(extension):
                raise BadInputError(
                    f"{self.name}: requires the extension {extension[:60]} (it may change the shape), which is not "
                    "read; export it without"
                )


def _chunks(path: Path) -> tuple[bytes, bytes | None]:
    """JSON of a file, and the binary chunk of a GLB file (clause 4.4), None if there is none."""
    content = path.read_bytes()
    if content[:4] != b"glTF":
        return content, None
    if len(content) < 12:
        raise ValueError("its header is cut short")
    version, length = struct.unpack_from("<II", content, 4)
    if version != 2:
        raise BadInputError(f"{path.name}: is glTF {version}, and glTF 2.0 is read; export it again as glTF 2.0")
    if length > len(content):
        raise BadInputError(f"{path.name}: is cut short: {len(content)} of {length} bytes; copy or export it again")
    chunks: list[tuple[int, bytes]] = []
    at = 12
    while at + 8 <= length:
        size, kind = struct.unpack_from("<II", content, at)
        if at + 8 + size > length:
            raise ValueError(f"chunk {len(chunks)} is longer than the file")
        chunks.append((kind, content[at + 8 : at + 8 + size]))
        at += 8 + size
    if not chunks or chunks[0][0] != _JSON:
        raise ValueError("its first chunk is no JSON")
    return chunks[0][1], next((held for kind, held in chunks[1:] if kind == _BIN), None)


def _embedded(uri: str, number: int) -> bytes:
    """Content of a data address (RFC 2397)."""
    head, comma, held = uri.partition(",")
    if not comma:
        raise ValueError(f"the data of buffer {number} has no comma")
    if not head.lower().endswith(";base64"):
        return unquote_to_bytes(held)
    plain = "".join((unquote(held) if "%" in held else held).split()).rstrip("=")
    try:
        return base64.b64decode(plain + "=" * (-len(plain) % 4), altchars=None, validate=True)
    except binascii.Error as error:
        raise ValueError(f"the data of buffer {number} is no base64") from error


def _no_number(text: str) -> NoReturn:
    raise ValueError(f"its JSON holds {text}, which is no number of JSON")

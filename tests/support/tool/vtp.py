"""Reads the .vtp files of ParaView that the tool writes: binary data behind the XML."""
import struct
import xml.etree.ElementTree as ElementTree
from pathlib import Path

FORMATS = {"Int32": "i", "UInt32": "I", "Int64": "q", "Float64": "d", "UInt8": "B", "String": "s"}


class Vtp:
    """A file. arrays: by the name of their section, such as CellData, and their own, as (type, values)."""

    def __init__(self, path):
        text, self._data = Path(path).read_bytes().split(b'<AppendedData encoding="raw">\n_', 1)
        root = ElementTree.fromstring(text + b"</VTKFile>")
        assert (root.get("byte_order"), root.get("header_type")) == ("LittleEndian", "UInt64")
        piece = root.find("PolyData/Piece")
        self.counts = {key.replace("NumberOf", ""): int(value) for key, value in piece.items()}
        sections = [root.find("PolyData/FieldData"), *piece]
        self.arrays = {section.tag: {array.get("Name"): self._read(array) for array in section} for section in sections}

    def _read(self, array):
        kind, offset = array.get("type"), int(array.get("offset"))
        (size,) = struct.unpack_from("<Q", self._data, offset)
        data = self._data[offset + 8 : offset + 8 + size]
        assert len(data) == size and array.get("format") == "appended"
        if kind == "String":
            assert data.endswith(b"\0")
            return kind, data.decode("utf-8").split("\0")[:-1]
        return kind, [value for (value,) in struct.iter_unpack("<" + FORMATS[kind], data)]

    def values(self, section, name, kind):
        """The values of an array, which must have this type."""
        found, values = self.arrays[section][name]
        assert found == kind
        return values

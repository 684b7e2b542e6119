"""Reads PNG files of eight bits and four channels, as the tool writes them."""
import struct
import zlib
from pathlib import Path


class Picture:
    """Rows of pixels, each 4 bytes: red, green, blue, opacity."""

    def __init__(self, rows):
        self.rows, self.width, self.height = rows, len(rows[0]) // 4, len(rows)

    def pixels(self):
        """All pixels, as (red, green, blue)."""
        return [tuple(row[at : at + 3]) for row in self.rows for at in range(0, len(row), 4)]

    def count(self, colour):
        """The number of pixels of exactly this colour."""
        return self.pixels().count(colour)

    def tile(self, index, columns, width, height):
        """One tile of a strip."""
        top, left = index // columns * height, index % columns * width
        return Picture([row[4 * left : 4 * (left + width)] for row in self.rows[top : top + height]])

    def __eq__(self, other):
        return self.rows == other.rows


def _nearest(left, above, corner):
    """The predictor of Paeth."""
    distances = [abs(above - corner), abs(left - corner), abs(left + above - 2 * corner)]
    return (left, above, corner)[distances.index(min(distances))]


def _unfiltered(kind, line, above):
    """A line without its filter: each byte was predicted by the one of the pixel at the left, the one above, or both."""
    row = bytearray(line)
    for at, byte in enumerate(line if kind != 0 else b""):
        left, corner = (row[at - 4], above[at - 4]) if at >= 4 else (0, 0)
        predicted = (0, left, above[at], (left + above[at]) // 2)[kind] if kind < 4 else _nearest(left, above[at], corner)
        row[at] = (byte + predicted) & 255
    return bytes(row)


def read_png(path):
    """Reads a picture; every part of the file must have its checksum."""
    data, at, packed, header = Path(path).read_bytes(), 8, b"", b""
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at : at + 8])
        body = data[at + 8 : at + 8 + size]
        assert struct.unpack(">I", data[at + 8 + size : at + 12 + size])[0] == zlib.crc32(kind + body), kind
        header = body if kind == b"IHDR" else header
        packed += body if kind == b"IDAT" else b""
        at += 12 + size
    width, height, *form = struct.unpack(">IIBBBBB", header)
    assert form == [8, 6, 0, 0, 0] and kind == b"IEND"
    lines, rows = zlib.decompress(packed), [bytes(4 * width)]
    assert len(lines) == height * (4 * width + 1)
    for begin in range(0, len(lines), 4 * width + 1):
        rows.append(_unfiltered(lines[begin], lines[begin + 1 : begin + 4 * width + 1], rows[-1]))
    return Picture(rows[1:])


def png_size(path):
    """Width and height alone."""
    return struct.unpack(">II", Path(path).read_bytes()[16:24])

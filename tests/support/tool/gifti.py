"""GIFTI files of a square, in every way that the format has."""
import base64
import gzip
import struct
import zlib

SQUARE = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
HALVES = [(0, 1, 2), (0, 2, 3)]
ASCII, BASE64, ZIPPED = "ASCII", "Base64Binary", "GZipBase64Binary"


HEADER = """<?xml version="1.0" encoding="UTF-8"?>
<!DOCTYPE GIFTI SYSTEM "http://www.nitrc.org/frs/download.php/115/gifti.dtd">
<GIFTI Version="1.0" NumberOfDataArrays="4">
 <MetaData><MD><Name><![CDATA[Who]]></Name><Value><![CDATA[a<b]]></Value></MD></MetaData>
 <LabelTable/>
 <DataArray Intent="NIFTI_INTENT_LABEL" DataType="NIFTI_TYPE_INT32" ArrayIndexingOrder="RowMajorOrder" Dimensionality="1" \
Dim0="4" Encoding="ASCII" Endian="LittleEndian"><Data>1 2 3 4</Data></DataArray>
"""
ARRAY = """ <DataArray Intent="NIFTI_INTENT_{}" DataType="NIFTI_TYPE_{}" ArrayIndexingOrder="{}MajorOrder" Dimensionality="2" \
Dim0="{}" Dim1="3"
  Encoding="{}" Endian="{}Endian" ExternalFileName="" ExternalFileOffset="">
  <MetaData/>
  <Data>{}</Data>
 </DataArray>
"""
FORMATS = {"INT32": "i", "FLOAT32": "f", "FLOAT64": "d"}


def square_gifti(encoding=ASCII, kind="FLOAT32", big_endian=False, column_major=False, gzip_header=False):
    """A file. The points stand from line 7 on, with their numbers in line 10; labels, and points behind, are no part of it."""
    def array(intent, own_kind, rows):
        numbers = [number for row in (zip(*rows) if column_major else rows) for number in row]
        data = struct.pack(f"{'>' if big_endian else '<'}{len(numbers)}{FORMATS[own_kind]}", *numbers)
        if encoding == ZIPPED:
            data = gzip.compress(data) if gzip_header else zlib.compress(data)
        text = " ".join(map(repr, numbers)) if encoding == ASCII else base64.b64encode(data).decode()
        return ARRAY.format(intent, own_kind, "Column" if column_major else "Row", len(rows), encoding,
                            "Big" if big_endian else "Little", text)

    return (HEADER + array("POINTSET", kind, SQUARE) + array("TRIANGLE", "INT32", HALVES)
            + array("POINTSET", kind, [(9, 9, 9)]) + "</GIFTI>\n")

"""Reads what the tool writes, strictly."""
import csv
import io
import json
from pathlib import Path
from typing import NamedTuple, Tuple

CONTACT_COLUMNS = "frame,kind,toi,a0,a1,b0,b1,b2,u,v,x,y,z,nx,ny,nz".split(",")
CONTACT_MEMBERS = "frame kind toi a b u v point normal".split()


def _refuse_constant(name):
    raise ValueError(f"{name} is no number of JSON")


def _object_of(pairs):
    members = dict(pairs)
    assert len(members) == len(pairs), f"a key is repeated: {[key for key, _ in pairs]}"
    return members


def json_of(text):
    """The value of a text in JSON (RFC 8259): no NaN, no repeated keys."""
    return json.loads(text, parse_constant=_refuse_constant, object_pairs_hook=_object_of)


def read_json(path):
    """The value of a file of JSON."""
    return json_of(Path(path).read_bytes().decode("utf-8"))


def lines_of(text):
    """The lines of a text, each of which has its end."""
    assert text == "" or text.endswith("\n"), f"the last line is cut: {text[-200:]}"
    return text.split("\n")[:-1]


def read_json_lines(path):
    """The values of a file of JSON Lines."""
    return [json_of(line) for line in lines_of(Path(path).read_bytes().decode("utf-8"))]


def read_csv(path):
    """The rows of a table as dicts of texts; all have as many fields as the header."""
    text = Path(path).read_bytes().decode("utf-8")
    lines_of(text)
    header, *rows = csv.reader(io.StringIO(text, newline=""), strict=True)
    assert len(set(header)) == len(header), header
    for row in rows:
        assert len(row) == len(header), row
    return [dict(zip(header, row)) for row in rows]


class Contact(NamedTuple):
    """A line of a file of contacts; numbers are read to the last bit."""

    frame: int
    kind: str
    toi: float
    a: Tuple[int, ...]
    b: Tuple[int, ...]
    u: float
    v: float
    point: Tuple[float, ...]
    normal: Tuple[float, ...]
    objects: Tuple[str, ...] = ()


def _check(contact):
    assert (contact.kind, len(contact.a), len(contact.b)) in (("vf", 1, 3), ("ee", 2, 2)), contact
    return contact


def read_contacts(path):
    """The contacts of a .csv or .jsonl file."""
    if str(path).endswith(".jsonl"):
        return [_check(_contact_of_line(line)) for line in read_json_lines(path)]
    return [_check(_contact_of_row(row)) for row in read_csv(path)]


def _contact_of_line(line):
    assert list(line) in (CONTACT_MEMBERS, CONTACT_MEMBERS + ["objects"]), line
    values = {key: line[key] for key in Contact._fields if key in line}
    return Contact(**{key: tuple(value) if isinstance(value, list) else value for key, value in values.items()})


def _contact_of_row(row):
    assert list(row) in (CONTACT_COLUMNS, CONTACT_COLUMNS + ["object_a", "object_b"])
    number = {key: float(text) if text else None for key, text in row.items() if key not in ("kind", "object_a", "object_b")}
    corners = [[int(row[key]) for key in keys if row[key]] for keys in (("a0", "a1"), ("b0", "b1", "b2"))]
    return Contact(int(row["frame"]), row["kind"], number["toi"], *map(tuple, corners), number["u"], number["v"],
                   tuple(number[key] for key in "xyz"), tuple(number["n" + key] for key in "xyz"),
                   (row["object_a"], row["object_b"]) if "object_a" in row else ())

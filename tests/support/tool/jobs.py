"""Lists of jobs, and their results."""
import json
from pathlib import Path

from support.tool.reading import read_json_lines

SQUARE = "v 0 0 0\nv 4 0 0\nv 0 4 0\n"
CLEAN = f"{SQUARE}f 1 2 3\n"
CROSSING = f"{SQUARE}v 1 1 -1\nv 1 1 1\nv 2 1 1\nf 1 2 3\nf 4 5 6\n"
DAMAGED = "v 0 0 0\nf 1 2 9\n"


def write_list(path, *jobs):
    """Writes a line for each job, as JSON."""
    Path(path).write_text("".join(json.dumps(job) + "\n" for job in jobs), encoding="utf-8")


def read_results(path):
    """The lines of a file of results by their jobs, none of which is there twice."""
    lines = read_json_lines(path)
    results = {line["job"]: line for line in lines}
    assert len(results) == len(lines)
    return results

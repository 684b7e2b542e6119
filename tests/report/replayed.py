"""Replays a recording of the tests, and reads its page."""
from report_file import Report
from support.tool.running import run


def write(recording):
    """Writes a recording as model.obj and frames.pc2."""
    recording.write_mesh("model.obj")
    recording.write_cache("frames.pc2")
    return recording


def report_of(options=""):
    """The page of a replay of these, beside which the summary is out.json."""
    run(f"replay model.obj frames.pc2 --report page.html --json out.json --quiet {options}")
    return Report("page.html")

"""The man pages have no warnings, and name every option of the tool, and no others.

The examples are those of --help, and none is refused.
"""
import re
import shlex

import pytest

from support.install.built_tree import ROOT, shell
from support.tool.running import run

COMMANDS = ("preprocess", "replay", "report", "sense", "check", "untangle", "merge", "info", "render")
# The text of cscd(1) without fonts.
PAGE = re.sub(r"\\f.", "", (ROOT / "docs/man/cscd.1").read_text()).replace("\\-", "-")


# What each mesh format is called, and the endings of its files.
FORMATS = re.findall(r'\((?:[A-Z]+), "([^"]*)", "([^"]*)"\)', (ROOT / "tool/io/mesh_file.h").read_text())


def help_of(command=""):
    return run(f"{command} --help").out


def part_of(page, title):
    """What stands below a title, up to the next."""
    return re.split(r"^\.S[SH] ", page.split(f"\n.SS {title}\n")[1], flags=re.MULTILINE)[0]


def options_in(text):
    return sorted({option for option in re.findall(r"(?:^|[^-a-z])(-(?:o\b|-[a-z-]+))", text, re.MULTILINE)})


def examples_of(command):
    """Command lines and what they do, as --help shows them first."""
    return [line.strip() for line in help_of(command).split("\n\n")[0].splitlines()]


def test_pages_have_no_warnings():
    assert shell("groff -man -ww -z docs/man/cscd.1 docs/man/cscd.3") == ""


def test_commands_are_those_of_the_tool():
    assert re.findall(r"^\.SS cscd (.*)$", PAGE, re.MULTILINE) == re.findall("^  ([a-z]+) .*", help_of(), re.MULTILINE) != []
    codes = re.search(r"\.SH EXIT(.*?)\.SH EX[^I]", PAGE, re.DOTALL).group(1)
    told = re.search("^exit: (.*)$", help_of(), re.MULTILINE).group(1)
    assert re.findall(r"^\.B (\d+)$", codes, re.MULTILINE) == re.findall(r"(?:^|, )(\d+)", told) != []


@pytest.mark.parametrize("command", COMMANDS)
def test_options_are_those_of_the_tool(command):
    """With their arguments, as --help lists them: two spaces end an option."""
    text = help_of(command)
    titles = re.findall("^([A-Z].*):$", text, re.MULTILINE)
    synopsis = re.findall(f"^cscd {command} .*$", PAGE.split(".SH DESCRIPTION")[0], re.MULTILINE)
    part = "\n".join([*synopsis, *(part_of(PAGE, title) for title in (f"cscd {command}", *titles))])
    assert options_in(part) == options_in(text) != []
    for option in re.findall("^  (-.*)", text, re.MULTILINE):
        assert option.split("  ")[0] in part.splitlines()


def test_no_option_is_made_up():
    """Options in examples exist, too."""
    assert options_in(PAGE) == options_in("\n".join(map(help_of, ("", *COMMANDS))))


def test_examples_are_those_of_the_tool():
    examples = PAGE.split("\n.SH EXAMPLES\n")[1].split("\n.SH SEE")[0].replace("\\(aq", "'")
    on_page = [line for line in re.sub(r"^\.TP$", "", examples, flags=re.MULTILINE).splitlines() if line]
    assert on_page == [line for command in COMMANDS for line in examples_of(command)]


@pytest.mark.parametrize("command", COMMANDS)
def test_no_example_is_refused(command):
    """In an empty folder an example ends with 1, because it finds no files.

    With 2, if its options do not exist, have values that do not fit, or contradict each other.
    """
    lines = [line for line in examples_of(command) if line.startswith(f"cscd {command} ")]
    assert len(lines) == 3
    for line in lines:
        run(" ".join(map(shlex.quote, shlex.split(line)[1:])), code=1)


@pytest.mark.parametrize("command", COMMANDS)
def test_help_fits_a_terminal(command):
    assert all(len(line) <= 110 for line in help_of(command).splitlines())


def test_formats_are_those_that_are_read():
    """Pages name each format as the list of the readers has it, and --help names all."""
    files = PAGE.split("\n.SH FILES\n")[1].split("\n.SH ")[0].split("\n.TP\n")[0]
    rows = (ROOT / "docs/artist/formats.md").read_text().split("## Read: meshes")[1].split("\n## ")[0]
    named = [re.sub(r"[ (].*", "", row) for row in re.findall(r"^\| ([A-Za-z][^|]*) \|", rows, re.MULTILINE)]
    assert named == ["format", *(name for name, _ in FORMATS)] and len(FORMATS) > 5
    assert all(name in files for name, _ in FORMATS)
    assert ", ".join(name for name, _ in FORMATS) in " ".join(help_of("replay").split())


@pytest.mark.parametrize("title, source", [
    ("## Contacts: `replay", "tool/io/record.c"), ("The table has a row per pair", "tool/check/check_output.c"),
    ("## Events: `--events", "tool/answers/answer_files.c"), ("The CSV has a row per warning", "sensors/tool/sense_files.c"),
])
def test_columns_are_those_of_the_tables(title, source):
    """formats.md names the columns of each list in their order, as the program writes them."""
    columns = ",".join(re.findall(r'^    \{"([a-z0-9_,]+)", [^}]*RECORD_', (ROOT / source).read_text(), re.MULTILINE)).split(",")
    text = (ROOT / "docs/artist/formats.md").read_text().split(title)[1].split("\n## ")[0]
    rows = re.findall(r"^\| ([a-z0-9_, ]+) \|", text, re.MULTILINE)[1:]
    words = re.split(r"\W+", ", ".join(rows) if rows else text)
    places = [i for i in range(len(words)) if words[i:i + 3] == columns[:3]]
    listed = words[places[0]:] if rows else [word for word in words[places[0]:] if word in columns]
    assert len(columns) > 9 and listed[:len(columns)] == columns

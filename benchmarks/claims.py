#!/usr/bin/env python3
"""Writes docs/about/measurements.md, and tables in other pages, from the measured tables in benchmarks/results: `make claims`.

A file of results has a title, what was measured (command, commit, date, machine), its tables, and the claims that the page
makes of them. A table that the page shows says with which columns and rows,
and how many claims stand before it. Another page has the table of a file between the lines `<!-- table of NAME -->` and `<!-- end -->`.
With --check nothing is written, and the status is 1 where a page is not what the results say.
"""
import json
import re
import sys
import textwrap
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
RESULTS = ROOT / 'benchmarks' / 'results'
PAGE = ROOT / 'docs' / 'about' / 'measurements.md'
SECTIONS = (
    'demo', 'methods', 'culling-choice', 'small-steps', 'size', 'threads', 'bulk-motion', 'topology', 'intersections', 'proximity',
    'near-pairs', 'response', 'energies',
    'peers', 'elementary', 'volumes', 'charge', 'cuts', 'stiffness', 'cold-disk',
    'extremes', 'extreme-shapes', 'reports')
OPENING = """# Measurements

This page is made by `make claims` from the tables in [benchmarks/results](../../benchmarks/results/), which have every row, the
commands, commits, dates and machines; some tables stand there alone. Unless a section says otherwise, numbers are of one thread,
with `-O3` of gcc 12.2 on Debian 12, on machines of two cores that others share. Their speed changes by a third within minutes:
ratios within a table say more than times, and counts do not change. `make benchmarks` builds the programs.
"""


def row_of(cells):
    return '| ' + ' | '.join(cells) + ' |'


def table_of(table):
    """The columns and rows of a table that the page shows."""
    def chosen(cells):
        return [cells[i] for i in table['shown']['columns']]
    columns = chosen(table['columns'])
    return '\n'.join([row_of(columns), row_of(['---'] * len(columns)), *(row_of(chosen(table['rows'][i])) for i in table['shown']['rows'])])


def wrapped(claim):
    """A claim in lines of at most 130 characters; pictures stay as they are."""
    lines = claim.split('\n')
    return '\n'.join(textwrap.fill(line, 130, subsequent_indent='  ' if line.startswith('*') else '', break_long_words=False,
                                   break_on_hyphens=False) for line in lines)


def section_of(name):
    result = json.loads((RESULTS / f'{name}.json').read_text(encoding='utf-8'))
    parts = [wrapped(claim) for claim in result['claims']]
    for table in reversed([table for table in result['tables'] if 'shown' in table]):
        parts.insert(table['shown']['after'], table_of(table))
    places = '; '.join(f"{measured['commit']}, {measured['date']}" for measured in result['measured'])
    source = f'[{name}.json](../../benchmarks/results/{name}.json) ({places})'
    return '\n\n'.join([f"## {result['title']}", *parts, source])


def page_of_claims():
    return '\n\n'.join([OPENING.rstrip(), *map(section_of, SECTIONS)]) + '\n'


def with_tables(page):
    """A page whose tables are those of the results."""
    def filled(match):
        result = json.loads((RESULTS / f'{match[2]}.json').read_text(encoding='utf-8'))
        return match[1] + '\n\n'.join(table_of(table) for table in result['tables'] if 'shown' in table) + '\n'
    return re.sub(r'(<!-- table of (\S+) -->\n).*?(?=<!-- end -->)', filled, page.read_text(encoding='utf-8'), flags=re.S)


def main():
    status = 0
    pages = {PAGE: page_of_claims(), **{page: with_tables(page) for page in sorted(ROOT.glob('docs/*/*.md')) if page != PAGE}}
    for place, page in pages.items():
        if place.exists() and place.read_text(encoding='utf-8') == page:
            continue
        if sys.argv[1:] != ['--check']:
            place.write_text(page, encoding='utf-8')
        else:
            print(f'{place.relative_to(ROOT)} is not what benchmarks/results says; run make claims')
            status = 1
    return status


sys.exit(main())

#!/usr/bin/env python3
"""Writes docs/man/cscd.1 from cscd.1.in and from what --help of each command says: manual.py TOOL, by `make manual`.

Options that several commands have stand once, below a title of their own. With --check behind it nothing is written, and the
status is 1 where the page is not what the tool says.
"""
import re
import subprocess
import sys
from pathlib import Path

FOLDER = Path(__file__).resolve().parent.parent / 'docs' / 'man'
VALUE = re.compile(r'[A-Z][A-Za-z]*(?:\.[a-z]+)?')


class Help:
    """What --help says of a command: its usage, description, own options, lists of shared ones and examples."""

    def __init__(self, tool, command):
        text = subprocess.run([tool, command, '--help'], capture_output=True, text=True, check=True).stdout
        examples, usage, *paragraphs = text.rstrip('\n').split('\n\n')
        lines = [line.strip() for line in examples.split('\n')]
        self.command, self.examples = command, list(zip(lines[::2], lines[1::2]))
        self.usage = [line.replace('usage:', '').strip() for line in usage.split('\n')]
        first = next(i for i, paragraph in enumerate(paragraphs) if paragraph.startswith('  -'))
        self.description = ' '.join(' '.join(paragraphs[:first]).split())
        self.own, self.shared = options_of(paragraphs[first]), {}
        for paragraph in paragraphs[first + 1:]:
            title, _, rows = paragraph.partition(':\n')
            self.shared[title] = options_of(rows)


def options_of(paragraph):
    """Pairs of an option with its value and what is said of it."""
    rows = []
    for line in paragraph.split('\n'):
        head = re.match(r'  (-.*?)(?:  +(.*))?$', line)
        if head:
            rows.append([head[1], head[2] or ''])
        else:
            rows[-1][1] = f'{rows[-1][1]} {line.strip()}'.strip()
    return tuple(map(tuple, rows))


def escaped(text):
    return text.replace('-', '\\-').replace("'", '\\(aq')


def in_fonts(text, values):
    """Options bold, and what stands for something else in italics."""
    pieces = []
    for word in re.split(r'((?<![\w-])--?[a-z][a-z-]*|\b[A-Z][A-Za-z]*\b)', text):
        font = 'B' if word.startswith('-') and len(word) > 1 else 'I' if word in values else ''
        pieces.append(f'\\f{font}{escaped(word)}\\fR' if font else escaped(word))
    return ''.join(pieces)


def head_of(option):
    name, blank, value = option.partition(' ')
    name, equals, choice = name.partition('[')
    parts = [part for part in re.split(f'({VALUE.pattern})', value) if part]
    value = ''.join(f'\\f{"I" if VALUE.fullmatch(part) else "B"}{escaped(part)}\\fR' for part in parts)
    return f'\\fB{escaped(name)}\\fR{equals}{escaped(choice)}{blank}{value}'


def rows_of(options):
    values = {value for option, _ in options for value in re.findall(r'\b[A-Z]+\b', option)} | {'MODEL', 'FRAMES'}
    lines = []
    for option, text in options:
        said = in_fonts(text[:1].upper() + text[1:], values)
        lines += ['.TP', head_of(option), said if said.endswith('.') else said + '.']
    return lines


def page_of(tool):
    listed = subprocess.run([tool, '--help'], capture_output=True, text=True, check=True).stdout
    helps = [Help(tool, command) for command in re.findall('^  ([a-z]+) .*', listed, re.M)]
    shared, parts, synopsis, examples = {}, [], [], []
    for page in helps:
        name = f'cscd {page.command}'
        synopsis += [in_fonts(line, {'MODEL', 'FRAMES'}).replace(name, f'\\fB{name}\\fR', 1) for line in page.usage]
        parts += [f'.SS cscd {page.command}', in_fonts(page.description, {'MODEL', 'FRAMES'}), *rows_of(page.own)]
        for title, options in page.shared.items():
            if shared.setdefault(title, options) != options:
                sys.exit(f'manual.py: cscd {page.command} has other options below "{title}" than the commands before')
        if page.shared:
            parts += ['.PP', 'Also, below: ' + '; '.join(page.shared) + '.']
        for line, does in page.examples:
            examples += ['.TP', f'\\fB{escaped(line)}\\fR', escaped(does)]
    lists = [line for title, options in shared.items() for line in (f'.SS {title}', *rows_of(options))]
    text = (FOLDER / 'cscd.1.in').read_text(encoding='utf-8')
    for name, lines in (('synopsis', synopsis), ('commands', parts), ('shared', lists), ('examples', examples)):
        text = text.replace(f'@{name}@\n', '\n'.join(lines) + '\n')
    return text


def main():
    text, place = page_of(sys.argv[1]), FOLDER / 'cscd.1'
    if sys.argv[2:] != ['--check']:
        place.write_text(text, encoding='utf-8')
    elif place.read_text(encoding='utf-8') != text:
        print('docs/man/cscd.1 is not what the tool says; run make manual')
        return 1
    return 0


sys.exit(main())

#!/usr/bin/env python3
"""Compiles and runs the examples in the comments of the public headers: header_examples.py FOLDER LIBRARY FLAG...

An example stands in a comment after a paragraph with the words `An example`, indented by four spaces. It is a part of a
function with the variables of header_examples.h, or a function. If the paragraph says `prints "..."`, it prints that.
"""
import os
import re
import subprocess
import sys
from pathlib import Path

MARK = r'\bAn(?: |\n \* )example\b'
EXAMPLE = re.compile(MARK + r'(.*?):\n \*\n((?: \*     [^\n]*\n| \*\n(?= \*     ))+)', re.S)


def examples():
    """For each example its place, its lines, and what it prints; None: nothing is said."""
    for path in sorted(Path('include/cscd').glob('*.h')):
        text = path.read_text()
        if len(re.findall(MARK, text)) != len(EXAMPLE.findall(text)):
            sys.exit(f'{path}: an example has no code, or is not indented by four spaces after an empty line')
        for comment in re.finditer(r'/\*.*?\*/', text, re.S):
            for match in EXAMPLE.finditer(comment[0]):
                line = text.count('\n', 0, comment.start() + match.start()) + 1
                code = [row[7:] for row in match[2].splitlines()]
                said = re.search(r'prints "(.*?)"', re.sub(r'\n \* *', ' ', match[1]))
                yield f'{path}:{line}', code, said and said[1]


def program_of(all_examples):
    """One function for each, and a program that calls the one whose number it is given."""
    text = '#include "tests/install/header_examples.h"\n'
    calls = ''
    for i, (place, code, _) in enumerate(all_examples):
        function = re.match(r'static .*?(\w+)\(', code[0])
        if function:
            text += '\n'.join(code) + '\n'
            calls += f'    if (which == {i}) (void){function[1]};\n'
        else:
            body = '\n'.join('    ' + row for row in code)
            # A status that an example leaves to its reader must be good.
            check = '\n    if (status != CSCD_OK) return (int)status;' if re.search(r'cscd_status status\b', body) else ''
            text += f'static int example_{i}(void) {{ /* {place} */\n{body}{check}\n    return 0;\n}}\n'
            calls += f'    if (which == {i}) result = example_{i}();\n'
    return text + f'''int main(int argc, char **argv) {{
    int which = argc > 1 ? atoi(argv[1]) : -1, result = 0;
    set_up();
{calls}    tear_down();
    return result;
}}
'''


def main():
    folder, library, *flags = sys.argv[1:]
    found = list(examples())
    source, program = Path(folder, 'examples.c'), Path(folder, 'examples')
    source.write_text(program_of(found))
    compiler = os.environ.get('CC', 'cc').split()
    subprocess.run([*compiler, '-std=c99', '-Wall', '-Wextra', '-Werror', '-Wno-unused-but-set-variable', '-Iinclude', '-I.',
                    source, library, *flags, '-o', program], check=True)
    bad = 0
    for i, (place, _, said) in enumerate(found):
        run = subprocess.run([program, str(i)], capture_output=True, text=True)
        if run.returncode != 0 or run.stderr or (said is not None and run.stdout.strip() != said):
            print(f'{place}: ended with {run.returncode}, printed {run.stdout.strip()!r} {run.stderr.strip()}; expected {said!r}')
            bad += 1
    print(f'{len(found)} examples, {bad} bad')
    return 1 if bad or not found else 0


sys.exit(main())

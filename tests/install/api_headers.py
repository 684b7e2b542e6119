#!/usr/bin/env python3
"""Reads the public headers of the C API: what they promise, and the headers that a later version would have.

    api_headers.py print             what is frozen, a line for each enumerator, struct, member and function
    api_headers.py write             renews what is made from the headers: api_frozen.txt, src/core/least_sizes.h, the
                                     prototypes of python/cscd/_api.py, the functions in docs/man/cscd.3: `make freeze-api`
    api_headers.py check             fails if the prototypes or the man page are not those of the headers
    api_headers.py rules             fails if a struct ends in padding, with 64-bit and with 32-bit pointers, or if the
                                     library could not know the size of one that grows
    api_headers.py grows             the structs that may grow
    api_headers.py later FOLDER      writes FOLDER/cscd/*.h, in which each of these has grown by one member
Run it in the root of the repository; CC names the compiler.
"""
import glob
import os
import re
import subprocess
import sys
import tempfile

FROZEN = 'tests/install/api_frozen.txt'
LEAST = 'src/core/least_sizes.h'
COMPILER = os.environ.get('CC', 'gcc').split()
PYTHON = 'python/cscd/_api.py'
MAN = 'docs/man/cscd.3'
LATER = 'uint32_t later_member[2];'
HEADERS = sorted(glob.glob('include/cscd/*.h'))
INCLUDES = ''.join(f'#include <cscd/{os.path.basename(header)}>\n' for header in HEADERS)


def fail(text):
    sys.exit('api_headers.py: ' + text)


def read_code(header):
    """The declarations of a header, in one line, and its macros without parameters."""
    with open(header, encoding='utf-8') as file:
        text = file.read().replace('\\\n', ' ')
    text = re.sub(r'/\*.*?\*/', ' ', text, flags=re.S)
    macros = re.findall(r'^#define (CSCD_\w+)[ \t]+(\S.*)$', text, flags=re.M)
    text = re.sub(r'^[ \t]*#.*$', ' ', text, flags=re.M)
    return re.sub(r'\s+', ' ', text), macros


def split_declarators(text):
    """Splits `double u, v` into `double u` and `double v`; a pointer to a function stays whole."""
    if '(' in text:
        return [(text, re.search(r'\(\*(\w+)\)', text).group(1))]
    first, *others = [part.strip() for part in text.split(',')]
    kind = re.match(r'(.*?)[ *]*\w+(\[\w+\])*$', first).group(1)
    declarations = [first] + [f'{kind} {other}' for other in others]
    return [(declaration, re.search(r'(\w+)(\[\w+\])*$', declaration).group(1)) for declaration in declarations]


def without_names(parameters):
    """Parameters may change their names, not their types."""
    def strip(parameter):
        name = re.match(r'(.+[ *])\w+((\[\w*\])*)$', parameter.strip())
        return (name.group(1).strip() + name.group(2)) if name else parameter.strip()
    return ', '.join(strip(parameter) for parameter in parameters.split(','))


class Api:
    def __init__(self):
        self.values, self.structs, self.functions, self.exported, self.opaque = [], {}, [], [], []
        for header in HEADERS:
            self.read(header)
        inputs = ' '.join(parameters for _, name, parameters in self.functions if name.endswith('_sized'))
        # A struct grows if callers fill it and the library is told its size: by a parameter or by its first member.
        self.growing = [name for name, members in self.structs.items()
                        if members[0][1] == 'struct_size' or re.search(rf'const {name} \*\w+, size_t \w*size\b', inputs)]

    def read(self, header):
        code, macros = read_code(header)
        enums = re.findall(r'typedef enum (\w+) \{(.*?)\} \1;', code)
        structs = re.findall(r'typedef struct (\w+) \{(.*?)\} \1;', code)
        opaque = re.findall(r'typedef struct (\w+) \1;', code)
        functions = re.findall(r'CSCD_API ([^;{(]*?)(\w+)\(([^;]*)\);', code)
        inlines = re.findall(r'static inline ([^;{(]*?)(\w+)\(([^{;]*)\) \{', code)
        # What the expressions above do not understand is not left out silently.
        if len(enums) + len(structs) + len(opaque) != code.count('typedef '):
            fail(f'{header}: a typedef that is neither an enum nor a struct, or is written in another way')
        if len(functions) != code.count('CSCD_API ') or len(inlines) != code.count('static inline '):
            fail(f'{header}: a function that is written in another way')
        self.values += [value.split('=')[0].strip() for _, body in enums for value in body.split(',') if value.strip()]
        others = ('CSCD_API', 'CSCD_VERSION_MINOR', 'CSCD_VERSION_PATCH')
        self.values += [name for name, _ in macros if name not in others]
        for name, body in structs:
            members = [part.strip() for part in body.split(';') if part.strip()]
            self.structs[name] = [member for text in members for member in split_declarators(text)]
        self.opaque += opaque
        self.exported += functions
        self.functions += [(kind.strip(), name, parameters) for kind, name, parameters in functions + inlines]


def run_program(text):
    """Compiles and runs a program and returns its output."""
    with tempfile.TemporaryDirectory() as folder:
        source, program = os.path.join(folder, 'print.c'), os.path.join(folder, 'print')
        with open(source, 'w', encoding='utf-8') as file:
            file.write(text)
        # Inline functions call the library, which nobody runs here.
        flags = ['-std=c11', '-w', '-Iinclude', '-Wl,--unresolved-symbols=ignore-all', '-o', program]
        subprocess.run(COMPILER + flags + [source], check=True)
        return subprocess.run([program], check=True, capture_output=True, text=True).stdout


def print_frozen(api):
    """The lines that a later version of this major version still has, sorted."""
    rows = [f'printf("value {name} %d\\n", (int){name});' for name in api.values]
    for name, members in api.structs.items():
        for declaration, member in members:
            if member == 'reserved':
                continue  # a later version may take it for a member of its own
            rows.append(f'printf("member {name} %zu {declaration}\\n", offsetof({name}, {member}));')
        if name in api.growing:
            rows.append(f'puts("struct {name} grows");')
        else:
            rows.append(f'printf("struct {name} of %zu bytes\\n", sizeof({name}));')
    rows += [f'puts("type {name}");' for name in api.opaque]
    rows += [f'puts("function {name}: {kind} ({without_names(parameters)})");'
             for kind, name, parameters in api.functions]
    includes = f'#include <stddef.h>\n#include <stdio.h>\n{INCLUDES}'
    text = run_program(includes + 'int main(void) {\n' + '\n'.join(rows) + '\n}\n')
    return sorted(text.splitlines())


def check_sizes(api):
    """A struct that grows is nobody's member, and every function is told its size or finds it in struct_size."""
    for name, members in api.structs.items():
        for declaration, _ in members:
            if any(re.match(rf'(const )?{inner} \w', declaration) for inner in api.growing):
                fail(f'{name} contains a struct that may grow: {declaration}')
    told = [name for name in api.growing if api.structs[name][0][1] != 'struct_size']
    for kind, name, parameters in api.exported:
        by_value = [inner for inner in api.growing
                    if re.search(rf'\b{inner}$', kind.strip()) or re.search(rf'\b{inner} \w', parameters)]
        untold = [inner for inner in told if re.search(rf'\b{inner} \*', parameters) and not name.endswith('_sized')]
        if by_value or untold:
            fail(f'{name} is not told the size of {", ".join(by_value + untold)}')


def check_padding(api):
    """Without padding at the end, a new member always changes the size of its struct."""
    asserts = ''.join(
        f'_Static_assert(sizeof({name}) == offsetof({name}, {members[-1][1]}) + '
        f'sizeof((({name} *)0)->{members[-1][1]}), "{name} ends in padding");\n'
        for name, members in api.structs.items())
    program = f'#include <stddef.h>\n{INCLUDES}{asserts}'
    compile_only = COMPILER + ['-std=c11', '-w', '-Iinclude', '-fsyntax-only', '-x', 'c', '-']
    failed = subprocess.run(compile_only, input=program, text=True, check=False).returncode != 0
    small = compile_only + ['-m32', '-ffreestanding']
    if subprocess.run(small, input='int x;', text=True, check=False, stderr=subprocess.DEVNULL).returncode == 0:
        failed |= subprocess.run(small, input=program, text=True, check=False).returncode != 0
    if failed:
        sys.exit(1)


def is_released():
    """CHANGELOG.md calls the first version of this major version unreleased as long as it is."""
    with open('CHANGELOG.md', encoding='utf-8') as file:
        return re.search(r'^## 2\.0\.0 \(unreleased\)', file.read(), flags=re.M) is None


def write_frozen(api):
    lines = print_frozen(api)
    if is_released():
        with open(FROZEN, encoding='utf-8') as file:
            lost = [line for line in file.read().splitlines() if line not in lines]
        if lost:
            fail('version 2.0.0 is released, so these must stay as they are:\n' + '\n'.join(lost))
    with open(FROZEN, 'w', encoding='utf-8') as file:
        file.write('\n'.join(lines) + '\n')
    write_least(api)


def write_least(api):
    """The last members of the structs that grow, as of the version in which each struct was first released."""
    last = {}
    if is_released():
        with open(LEAST, encoding='utf-8') as file:
            last = dict(re.findall(r'STRUCT_THROUGH\((\w+), (\w+)\)', file.read()))
    with open(LEAST, 'w', encoding='utf-8') as file:
        file.write('/* The sizes of the structs that callers fill, as they were first released: no caller has smaller ones.'
                   ' Made by\n'
                   ' * make freeze-api, which leaves the rows of released versions as they are. */\n'
                   '#pragma once\n\n#include <stddef.h>\n\n'
                   '#define STRUCT_THROUGH(type, member) (offsetof(type, member) + sizeof(((type *)0)->member))\n'
                   '#define LEAST_SIZE(type)             LEAST_##type\n\n')
        width = max(len(name) for name in api.growing)
        for name in api.growing:
            member = last.get(name, api.structs[name][-1][1])
            file.write(f'#define LEAST_{name.ljust(width)} STRUCT_THROUGH({name}, {member})\n')


def write_later(api, folder):
    os.makedirs(os.path.join(folder, 'cscd'), exist_ok=True)
    for header in HEADERS:
        with open(header, encoding='utf-8') as file:
            text = file.read()
        for name in api.growing:
            text = re.sub(rf'^}} {name};', f'    {LATER}\n}} {name};', text, flags=re.M)
        with open(os.path.join(folder, 'cscd', os.path.basename(header)), 'w', encoding='utf-8') as file:
            file.write(text)


# ---- Python ------------------------------------------------------------------------------------------------------------------

SCALARS = {'void': 'None', 'bool': 'c_bool', 'int': 'c_int', 'double': 'c_double', 'size_t': 'c_size_t',
           'uint32_t': 'c_uint32', 'uint64_t': 'c_uint64', 'const char *': 'c_char_p'}


def python_type(kind):
    """The type of ctypes for a result or a parameter; what is not listed is an enumeration."""
    kind = kind.strip()
    return SCALARS.get(kind, 'c_void_p' if kind.endswith(('*', ']')) else 'c_uint32')


def python_text(api):
    """The functions that Python calls by their names, and the values of all enumerators."""
    called = set()
    for path in glob.glob('python/cscd/*.py'):
        with open(path, encoding='utf-8') as file:
            called.update(re.findall(r'library\.(cscd_\w+)', file.read()))
    rows = []
    for kind, name, parameters in sorted(api.exported, key=lambda function: function[1]):
        if name not in called:
            continue
        types = without_names(parameters)
        arguments = [] if types == 'void' else [python_type(each) for each in types.split(', ')]
        rows.append(f'    "{name}": ({python_type(kind)}, [{", ".join(arguments)}]),')
        called.remove(name)
    if called:
        fail('Python calls functions that the headers do not have: ' + ', '.join(sorted(called)))
    values = [line.split()[1:] for line in print_frozen(api) if line.startswith('value ')]
    rows_of_values = [f'    "{name}": {value},' for name, value in values if not name.endswith('_MAX_ENUM')]
    return ('"""The functions of the public headers that Python calls, and the values of their enumerators.\n\n'
            'Made from include/cscd by ``make freeze-api``.\n"""\n\nfrom __future__ import annotations\n\n'
            'from ctypes import c_bool, c_char_p, c_double, c_int, c_size_t, c_uint32, c_uint64, c_void_p\n'
            'from typing import Any, Dict, List, Tuple\n\n__all__ = ["FUNCTIONS", "VALUES"]\n\n'
            '#: By name: the type of the result, and those of the arguments.\n'
            'FUNCTIONS: Dict[str, Tuple[Any, List[Any]]] = {\n' + '\n'.join(rows) + '\n}\n\n'
            '#: Enumerators and flags by name.\n'
            'VALUES: Dict[str, int] = {\n' + '\n'.join(rows_of_values) + '\n}\n')


# ---- the man page ------------------------------------------------------------------------------------------------------------

MAN_BEGIN, MAN_END = '.\\" Functions, made from the headers by make freeze-api.\n', '.\\" The end of what is made.\n'


def first_sentence(comment):
    """The first sentence of a comment, in one line."""
    text = re.sub(r'\s*\n\s*\*\s?', ' ', comment).strip()
    sentence = re.match(r'.*?[.:;](?= [A-Z]|$)', text)
    return re.sub(r'[:;]$', '.', sentence.group() if sentence else text + '.')


def man_text():
    """An entry for each function: its parameters, and the first sentence above it. Functions that follow each other with the same
    sentence, or without one, share an entry."""
    text = ''
    for header in HEADERS:
        with open(header, encoding='utf-8') as file:
            code = re.sub(r'/\* (?:====|----).*?\*/|^#.*?$', '', file.read(), flags=re.M)
        entries = []
        pattern = r'(?:/\*((?:(?!\*/).)*?)\*/\n)?(?:CSCD_API|static inline) [^;{(]*?(\w+)\(([^;{)]*)\)'
        for comment, name, parameters in re.findall(pattern, code, flags=re.S):
            if name.endswith('_sized'):
                last = comment
                continue
            names = [re.search(r'(\w+)(?:\[\w*\])*$', each.strip()).group(1)
                     for each in parameters.split(',') if each.strip() not in ('', 'void')]
            comment = comment or last
            last = comment
            arguments = ', '.join(f'\\fI{each}\\fR' for each in names)
            sentence = first_sentence(comment).replace('\\', '\\e').replace('-', '\\-')
            heading = f'\\fB{name}\\fR({arguments})\n'
            if entries and entries[-1][1] == sentence:
                entries[-1][0] += f'.TQ\n{heading}'
            else:
                entries.append([f'.TP\n{heading}', sentence])
        if entries:
            text += f'.SS <cscd/{os.path.basename(header)}>\n' + ''.join(f'{headings}{sentence}\n' for headings, sentence in entries)
    return text


def man_page():
    with open(MAN, encoding='utf-8') as file:
        page = file.read()
    before, rest = page.split(MAN_BEGIN)
    return before + MAN_BEGIN + man_text() + MAN_END + rest.split(MAN_END)[1]


def made_files(api):
    return {PYTHON: python_text(api), MAN: man_page()}


def write_made(api):
    for path, text in made_files(api).items():
        with open(path, 'w', encoding='utf-8') as file:
            file.write(text)


def check_made(api):
    for path, text in made_files(api).items():
        with open(path, encoding='utf-8') as file:
            if file.read() != text:
                fail(f'{path} is not what the headers say; run make freeze-api')


def main():
    api = Api()
    command = sys.argv[1] if len(sys.argv) > 1 else ''
    if command == 'print':
        print('\n'.join(print_frozen(api)))
    elif command == 'write':
        write_frozen(api)
        write_made(api)
    elif command == 'check':
        check_made(api)
    elif command == 'rules':
        check_sizes(api)
        check_padding(api)
    elif command == 'grows':
        print('\n'.join(sorted(api.growing)))
    elif command == 'later' and len(sys.argv) == 3:
        write_later(api, sys.argv[2])
    else:
        sys.exit(__doc__)


main()

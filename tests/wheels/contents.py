#!/usr/bin/env python3
"""Looks at wheels without installing them: contents.py WHEEL...

Names, tags, the list RECORD, the files of the package, the kind of its library and what that needs and exports. The last line is
`N passed, M failed`.
"""
import base64
import hashlib
import pathlib
import re
import runpy
import struct
import subprocess
import sys
import tempfile
import zipfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
HEADER = (ROOT / 'include/cscd/cscd.h').read_text()
VERSION = '.'.join(re.findall(r'#define CSCD_VERSION_\w+ (\d+)', HEADER))
LICENCES = {'LICENSE', 'expat.txt', 'json-c.txt', 'libpng.txt', 'zlib.txt'}
C_LIBRARY = r'lib[cm]\.so\.6|ld-linux-\S+'
# By the tag: the tools of its compiler, the library's name, the machine in its head, what it may need, more licences.
PLATFORMS = {
    'linux_x86_64': ('', 'libcscd-python.so', 62, C_LIBRARY, set()),
    'linux_aarch64': ('aarch64-linux-gnu-', 'libcscd-python.so', 183, C_LIBRARY, set()),
    'win_amd64': ('x86_64-w64-mingw32-', 'libcscd-python.dll', 0x8664, r'(?i:kernel32|msvcrt|advapi32)\.dll', {'gcc.txt', 'mingw-w64.txt'}),
}
passed = failed = 0


def check(what, good):
    """Counts, and names what is wrong."""
    global passed, failed
    passed, failed = passed + bool(good), failed + (not good)
    if not good:
        print(f'failed: {what}')


def machine_of(library):
    """The number of the processor in the head of an ELF library or a DLL."""
    if library[:4] == b'\x7fELF':
        return struct.unpack_from('<H', library, 18)[0]
    return struct.unpack_from('<H', library, struct.unpack_from('<I', library, 60)[0] + 4)[0]


def names_in(library, tools, *words):
    """What a tool of the compiler prints of a library, line by line."""
    with tempfile.NamedTemporaryFile(suffix='.library') as file:
        file.write(library)
        file.flush()
        return subprocess.run([tools + words[0], *words[1:], file.name], check=True, text=True, stdout=subprocess.PIPE).stdout.splitlines()


def exports_of(library, tools):
    """The names that other programs find."""
    if library[:2] == b'MZ':
        lines = names_in(library, tools, 'objdump', '-p')
        table = lines[next(i for i, line in enumerate(lines) if '[Ordinal/Name Pointer] Table' in line) + 1:]
        return {line.split()[-1] for line in table if line.strip().startswith('[')}
    return {line.split()[-1] for line in names_in(library, tools, 'nm', '-D', '--defined-only')}


def look_at(wheel):
    tag = wheel.stem.rsplit('-', 1)[1]
    check(f'{wheel.name} has a name of ours', tag in PLATFORMS and wheel.name == f'cscd-{VERSION}-py3-none-{tag}.whl')
    tools, name, machine, everywhere, licences = PLATFORMS[tag]
    with zipfile.ZipFile(wheel) as archive:
        check(f'{tag}: the archive is whole', archive.testzip() is None)
        files = {member: archive.read(member) for member in archive.namelist()}
    information = f'cscd-{VERSION}.dist-info'
    record = dict(line.split(',', 1) for line in files[f'{information}/RECORD'].decode().splitlines())
    check(f'{tag}: RECORD names every file', record.keys() == files.keys())
    for path, data in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b'=').decode()
        check(f'{tag}: RECORD knows {path}', path == f'{information}/RECORD' or record.get(path) == f'sha256={digest},{len(data)}')
    check(f'{tag}: the file WHEEL has the tag', f'\nTag: py3-none-{tag}\n' in files[f'{information}/WHEEL'].decode())
    check(f'{tag}: METADATA has the version', f'\nVersion: {VERSION}\n' in files[f'{information}/METADATA'].decode())
    check(f'{tag}: all licences', {path.rsplit('/', 1)[1] for path in files if '/licenses/' in path} == LICENCES | licences)
    sources = {f'cscd/{path.name}': path.read_bytes() for path in (ROOT / 'python/cscd').iterdir() if path.is_file()}
    check(f'{tag}: the package is the sources and {name}', {path for path in files if path.startswith('cscd/')} == {*sources, f'cscd/{name}'})
    check(f'{tag}: the sources are those of this tree', all(files.get(path) == data for path, data in sources.items()))
    library = files[f'cscd/{name}']
    check(f'{tag}: the library is for its processor', machine_of(library) == machine)
    needed = [line.split()[-1] for line in names_in(library, tools, 'objdump', '-p')
              if line.split()[:1] == ['NEEDED'] or 'DLL Name:' in line]
    check(f'{tag}: the library needs {needed}', needed and all(re.fullmatch(everywhere, one) for one in needed))
    exported = exports_of(library, tools)
    check(f'{tag}: it exports nothing but our names', exported and all(re.match('cscd_|cscdpy_', one) for one in exported))
    called = {*runpy.run_path(str(ROOT / 'python/cscd/_prototypes.py'))['PROTOTYPES'],
              *runpy.run_path(str(ROOT / 'python/cscd/_api.py'))['FUNCTIONS']}
    missing = called - exported
    check(f'{tag}: it exports what Python calls, but for {missing}', not missing)


def main():
    for name in sys.argv[1:]:
        look_at(pathlib.Path(name))
    print(f'{passed} passed, {failed} failed')
    return int(failed > 0 or passed == 0)


if __name__ == '__main__':
    sys.exit(main())

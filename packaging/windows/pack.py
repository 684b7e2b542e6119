#!/usr/bin/env python3
"""Packs what is built for Windows as an archive that runs from any folder: pack.py BUILD LIBRARIES VERSION OUTPUT.zip.

BUILD is the build folder, LIBRARIES that of libraries.sh, for the licences of what is linked in. The same files give the same
bytes. Programs are stripped by STRIP.
"""
import os
import pathlib
import subprocess
import sys
import tempfile
import zipfile

# What is linked into the program or the library, and where its licence stands.
LICENCES = {
    'libpng': '{libraries}/sources/libpng1.6/debian/copyright',
    'json-c': '{libraries}/sources/json-c/debian/copyright',
    'expat': '{libraries}/sources/expat/debian/copyright',
    'zlib': '/usr/share/doc/libz-mingw-w64-dev/copyright',
    'mingw-w64': '/usr/share/doc/mingw-w64-x86-64-dev/copyright',
    'gcc': '/usr/share/doc/gcc-mingw-w64-x86-64-posix-runtime/copyright',
}


def files_of(build, libraries, scratch):
    """Pairs of a name in the archive and the file that it holds."""
    major = next(pathlib.Path(build).glob('libcscd-*.dll')).name
    for name, source in (('cscd.exe', 'cscd'), (f'lib/{major}', major)):
        stripped = pathlib.Path(scratch, pathlib.Path(name).name)
        subprocess.run([os.environ.get('STRIP', 'x86_64-w64-mingw32-strip'), '-o', stripped, pathlib.Path(build, source)], check=True,
                       env={**os.environ, 'SOURCE_DATE_EPOCH': '315532800'})  # the file would hold the time of now
        yield name, stripped
    for name in ('libcscd.dll.a', major.replace('.dll', '.def')):
        yield f'lib/{name}', pathlib.Path(build, name)
    for header in sorted(pathlib.Path('include/cscd').iterdir()):
        yield f'include/cscd/{header.name}', header
    for name in ('LICENSE', 'README.md', 'CHANGELOG.md'):
        yield name, pathlib.Path(name)
    for page in sorted(pathlib.Path('docs').glob('*/*.md')):
        yield page.as_posix(), page
    for name, place in LICENCES.items():
        yield f'licences/{name}.txt', pathlib.Path(place.format(libraries=libraries))


def main():
    build, libraries, version, output = sys.argv[1:]
    top = f'cscd-{version}-windows-x86_64'
    with tempfile.TemporaryDirectory() as scratch, zipfile.ZipFile(output, 'w', zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for name, source in files_of(build, libraries, scratch):
            entry = zipfile.ZipInfo(f'{top}/{name}', (1980, 1, 1, 0, 0, 0))
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = 0o644 << 16
            archive.writestr(entry, source.read_bytes())


if __name__ == '__main__':
    main()

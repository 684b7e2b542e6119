"""Packs the extension as a zip: `pack.py WHEEL FOLDER` writes FOLDER/cscd_blender-VERSION.zip and prints its path.

All files lie in one folder within the archive, which Blender 4.2 takes as an extension and Blender 3.4 as an add-on. The wheel of
the Python package is in it. The same files make the same bytes.
"""
import os
import re
import sys
import zipfile

HERE = os.path.dirname(os.path.abspath(__file__))
NAME = 'cscd_blender'
TIME = (2026, 1, 1, 0, 0, 0)


def read_version():
    with open(os.path.join(HERE, NAME, 'blender_manifest.toml'), encoding='utf-8') as file:
        return re.search(r'^version = "([^"]+)"', file.read(), re.MULTILINE)[1]


def pack(wheel, folder):
    """Writes the archive, which takes the place of an older one when it is whole."""
    os.makedirs(folder, exist_ok=True)
    path = os.path.join(folder, f'{NAME}-{read_version()}.zip')
    source = os.path.join(HERE, NAME)
    members = [(f'{NAME}/{name}', os.path.join(source, name)) for name in sorted(os.listdir(source))
               if name.endswith(('.py', '.toml'))]
    members.append((f'{NAME}/LICENSE', os.path.join(HERE, '..', 'LICENSE')))
    members.append((f'{NAME}/wheels/{os.path.basename(wheel)}', wheel))
    beside = f'{path}.{os.getpid()}.part'
    with zipfile.ZipFile(beside, 'w', zipfile.ZIP_DEFLATED) as archive:
        for name, file_path in members:
            with open(file_path, 'rb') as file:
                archive.writestr(zipfile.ZipInfo(name, TIME), file.read(), zipfile.ZIP_DEFLATED)
    os.replace(beside, path)
    return path


if __name__ == '__main__':
    if len(sys.argv) != 3:
        sys.exit('usage: pack.py WHEEL FOLDER')
    print(pack(*sys.argv[1:]))

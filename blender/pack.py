"""Packs the extension as a zip: `pack.py FOLDER WHEEL...` writes FOLDER/cscd_blender-VERSION.zip and prints its path.

All files lie in one folder within the archive, which Blender 4.2 takes as an extension and Blender 3.4 as an add-on. The wheels
of the Python package are in it, and the manifest in it names no platform but theirs. The same files make the same bytes.
"""
import os
import re
import sys
import zipfile

HERE = os.path.dirname(os.path.abspath(__file__))
NAME = 'cscd_blender'
TIME = (2026, 1, 1, 0, 0, 0)
# What Blender calls the platforms that wheels name.
PLATFORMS = {'linux_x86_64': 'linux-x64', 'linux_aarch64': 'linux-arm64', 'win_amd64': 'windows-x64'}


def contents(path):
    with open(path, 'rb') as file:
        return file.read()


def read_manifest(wheels):
    """The manifest for these wheels: a line for each platform and wheel that is not packed is left out."""
    text = contents(os.path.join(HERE, NAME, 'blender_manifest.toml')).decode()
    packed = {os.path.basename(wheel) for wheel in wheels}
    for name in re.findall(r'"\./wheels/(.+)"', text):
        if name not in packed:
            platform = PLATFORMS[name[:-len('.whl')].rsplit('-', 1)[1]]
            text = re.sub(rf'^ *"(\./wheels/{re.escape(name)}|{platform})",\n', '', text, flags=re.MULTILINE)
        packed.discard(name)
    if packed or '"./wheels/' not in text:
        sys.exit(f'pack.py: blender_manifest.toml names no wheel {" and ".join(sorted(packed))}')
    return text


def pack(folder, wheels):
    """Writes the archive, which takes the place of an older one when it is whole."""
    manifest = read_manifest(wheels)
    os.makedirs(folder, exist_ok=True)
    version = re.search(r'^version = "([^"]+)"', manifest, re.MULTILINE)[1]
    path = os.path.join(folder, f'{NAME}-{version}.zip')
    source = os.path.join(HERE, NAME)
    members = {name: contents(os.path.join(source, name)) for name in sorted(os.listdir(source)) if name.endswith('.py')}
    members['blender_manifest.toml'] = manifest.encode()
    members['LICENSE'] = contents(os.path.join(HERE, '..', 'LICENSE'))
    members.update({f'wheels/{os.path.basename(wheel)}': contents(wheel) for wheel in sorted(wheels)})
    beside = f'{path}.{os.getpid()}.part'
    with zipfile.ZipFile(beside, 'w', zipfile.ZIP_DEFLATED) as archive:
        for name, data in members.items():
            archive.writestr(zipfile.ZipInfo(f'{NAME}/{name}', TIME), data, zipfile.ZIP_DEFLATED)
    os.replace(beside, path)
    return path


if __name__ == '__main__':
    if len(sys.argv) < 3:
        sys.exit('usage: pack.py FOLDER WHEEL...')
    print(pack(sys.argv[1], sys.argv[2:]))

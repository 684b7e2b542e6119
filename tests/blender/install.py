"""The packed extension, installed as an add-on into an empty folder, where no Python package of ours is seen.

Run by `blender --background FILE.blend --python install.py -- ARCHIVE`, with BLENDER_USER_SCRIPTS naming the folder.
"""
import os
import sys

import bpy

ARCHIVE = sys.argv[-1]


def main():
    assert not any(os.path.isdir(os.path.join(folder, 'cscd')) for folder in sys.path), 'a package is seen that is not ours to test'
    assert bpy.ops.preferences.addon_install(filepath=ARCHIVE) == {'FINISHED'}
    assert bpy.ops.preferences.addon_enable(module='cscd_blender') == {'FINISHED'}
    import cscd
    assert os.path.realpath(cscd.__file__).startswith(os.path.realpath(os.environ['BLENDER_USER_SCRIPTS'])), cscd.__file__
    assert bpy.ops.cscd.check() == {'FINISHED'}
    assert len(bpy.context.scene.cscd.events) > 0
    assert bpy.ops.preferences.addon_disable(module='cscd_blender') == {'FINISHED'}
    assert not hasattr(bpy.context.scene, 'cscd') and not hasattr(bpy.types, 'CSCD_PT_check')
    print('install: the archive works as an add-on, with the package that is in it, and goes away again')


main()

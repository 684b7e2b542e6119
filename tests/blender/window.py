"""The extension in a window, for window.sh: no splash, the sidebar open, and what the panel knows in a file.

Run by `blender FILE.blend --python window.py -- STATE.json`. Once there is a file page-wanted beside the state, page.html is
written there.
"""
import json
import os
import sys

import bpy

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..', 'blender'))
import cscd_blender
from cscd_blender.properties import is_running

bpy.context.preferences.view.show_splash = False
cscd_blender.register()


def open_sidebar():
    for area in bpy.context.window_manager.windows[0].screen.areas:
        if area.type == 'VIEW_3D':
            area.spaces.active.show_region_ui = True
            area.spaces.active.region_3d.view_perspective = 'CAMERA'


def view():
    return [area.spaces.active.region_3d.view_perspective for area in bpy.context.window_manager.windows[0].screen.areas
            if area.type == 'VIEW_3D'][0]


def write_page(folder):
    wanted = os.path.join(folder, 'page-wanted')
    if not os.path.exists(wanted):
        return
    os.remove(wanted)
    with bpy.context.temp_override(window=bpy.context.window_manager.windows[0]):
        bpy.ops.cscd.report(filepath=os.path.join(folder, 'page.html'), open_page=False)


def tell():
    write_page(os.path.dirname(sys.argv[-1]))
    scene = bpy.context.scene
    path = sys.argv[-1]
    with open(path + '.part', 'w') as file:
        json.dump({'running': is_running(), 'events': len(scene.cscd.events), 'frame': scene.frame_current,
                   'view': view(),
                   'selected': [thing.name for thing in bpy.context.selected_objects]}, file)
    os.replace(path + '.part', path)
    return 0.2


bpy.app.timers.register(open_sidebar, first_interval=1.0)
bpy.app.timers.register(tell, first_interval=2.0)

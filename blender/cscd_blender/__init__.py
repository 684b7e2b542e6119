"""Finds where characters, cloth and props go through each other and themselves, frame by frame."""

bl_info = {
    "name": "cscd",
    "author": "the authors of cscd",
    "version": (2, 0, 0),
    "blender": (3, 4, 0),
    "location": "3D View > Sidebar > cscd",
    "description": "Finds where surfaces go through each other and themselves, frame by frame",
    "category": "Animation",
}


def _modules():  # type: ignore[no-untyped-def]
    from . import operators, panel, properties
    return properties, operators, panel


def register() -> None:
    """What Blender calls when the extension is switched on."""
    for module in _modules():
        module.register()


def unregister() -> None:
    """What Blender calls when the extension is switched off."""
    for module in reversed(_modules()):
        module.unregister()

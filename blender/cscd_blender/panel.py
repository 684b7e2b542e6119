"""The tab "cscd" of the 3D view's sidebar."""

from __future__ import annotations

from typing import Any, List

import bpy

from .properties import findings_of, is_running


class CSCD_UL_events(bpy.types.UIList):
    """The events: who, when, how deep."""

    def draw_item(self, context: Any, layout: Any, data: Any, item: Any, icon: int, active_data: Any,
                  active_property: str, index: int = 0, flt_flag: int = 0) -> None:
        row = layout.split(factor=0.5)
        row.label(text=f"{_short(item.a)} x {_short(item.b)}")
        numbers = row.split(factor=0.45)
        numbers.label(text=f"{item.first}-{item.last}" if item.last > item.first else f"{item.first}")
        word = "copies" if "same_solid" in item.kinds else ""
        numbers.label(text=_length(context, item.depth) if item.depth > 0.0 else word)


class CSCD_UL_ignored(bpy.types.UIList):
    """Pairs of parts that are left out."""

    def draw_item(self, context: Any, layout: Any, data: Any, item: Any, icon: int, active_data: Any,
                  active_property: str, index: int = 0, flt_flag: int = 0) -> None:
        row = layout.row(align=True)
        row.prop(item, "a", text="", emboss=False, icon="MESH_DATA")
        row.prop(item, "b", text="", emboss=False, icon="MESH_DATA")


def _short(part: str) -> str:
    """A part without its object."""
    return part.rpartition("/")[2]


def _length(context: Any, length: float) -> str:
    """A length in the units of the scene."""
    settings = context.scene.unit_settings
    return bpy.utils.units.to_string(settings.system, "LENGTH", length * settings.scale_length, precision=2)


class _CscdPanel:
    """Where all panels are."""

    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "cscd"


class CSCD_PT_check(_CscdPanel, bpy.types.Panel):
    bl_idname = "CSCD_PT_check"
    bl_label = "Intersections"

    def draw(self, context: Any) -> None:
        layout, settings = self.layout, context.scene.cscd
        column = layout.column()
        column.enabled = not is_running()
        column.prop(settings, "source", text="")
        if settings.source == "COLLECTION":
            column.prop(settings, "collection", text="")
        column.prop(settings, "use_range")
        if settings.use_range:
            frames = column.column(align=True)
            frames.prop(settings, "first", text="Frame Start")
            frames.prop(settings, "last", text="End")
            frames.prop(settings, "step")
        column.prop(settings, "by_groups")
        column.prop(settings, "depths")
        if is_running():
            layout.prop(settings, "progress", slider=True, text="Esc stops")
        else:
            row = layout.split(factor=0.6, align=True)
            row.operator("cscd.check", icon="PLAY")
            row.operator("cscd.untangle").every_frame = False


class CSCD_PT_left_out(_CscdPanel, bpy.types.Panel):
    bl_idname = "CSCD_PT_left_out"
    bl_label = "Left Out"
    bl_parent_id = "CSCD_PT_check"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: Any) -> None:
        layout, settings = self.layout, context.scene.cscd
        layout.prop(settings, "rest", text="")
        row = layout.row()
        row.template_list("CSCD_UL_ignored", "", settings, "ignored", settings, "ignored_index", rows=2)
        buttons = row.column(align=True)
        buttons.operator("cscd.ignore", icon="ADD", text="").from_event = False
        buttons.operator("cscd.look_at_again", icon="REMOVE", text="")


class CSCD_PT_untangle(_CscdPanel, bpy.types.Panel):
    bl_idname = "CSCD_PT_untangle"
    bl_label = "Untangle"
    bl_parent_id = "CSCD_PT_check"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: Any) -> None:
        layout, settings, active = self.layout, context.scene.cscd, context.view_layer.objects.active
        column = layout.column()
        column.enabled = not is_running()
        column.prop(settings, "gap")
        if active is not None and active.type == "MESH":
            column.prop_search(settings, "pin_group", active, "vertex_groups")
        column.prop(settings, "steady")
        column.operator("cscd.untangle", text="This Frame").every_frame = False
        column.operator("cscd.untangle", text="All Frames").every_frame = True
        lines = layout.column(align=True)
        lines.scale_y = 0.8
        for line in _wrapped(settings.untangled, max(24, context.region.width // 8)):
            lines.label(text=line)


class CSCD_PT_events(_CscdPanel, bpy.types.Panel):
    bl_idname = "CSCD_PT_events"
    bl_label = "Events"
    bl_parent_id = "CSCD_PT_check"

    @classmethod
    def poll(cls, context: Any) -> bool:
        return bool(context.scene.cscd.summary)

    def draw(self, context: Any) -> None:
        layout, settings = self.layout, context.scene.cscd
        lines = layout.column(align=True)
        lines.scale_y = 0.8
        for line in _wrapped(settings.summary, max(24, context.region.width // 8)):
            lines.label(text=line)
        if not settings.events:
            return
        layout.template_list("CSCD_UL_events", "", settings, "events", settings, "event_index", rows=4)
        row = layout.row(align=True)
        row.operator("cscd.show_event", icon="ZOOM_SELECTED")
        row.operator("cscd.ignore", icon="HIDE_ON").from_event = True
        if findings_of(context.scene) is None:
            layout.label(text="Check again to mark faces", icon="INFO")


class CSCD_PT_marks(_CscdPanel, bpy.types.Panel):
    bl_idname = "CSCD_PT_marks"
    bl_label = "Into the Scene"
    bl_parent_id = "CSCD_PT_check"

    @classmethod
    def poll(cls, context: Any) -> bool:
        return bool(context.scene.cscd.summary)

    def draw(self, context: Any) -> None:
        column = self.layout.column(align=True)
        column.operator("cscd.mark_timeline", icon="MARKER_HLT")
        column.operator("cscd.mark_materials", icon="MATERIAL")
        column.operator("cscd.mark_attributes", icon="SPREADSHEET")
        column.operator("cscd.mark_groups", icon="GROUP_VERTEX")
        column.operator("cscd.mark_curves", icon="OUTLINER_OB_CURVE")
        self.layout.operator("cscd.report", icon="URL")
        self.layout.operator("cscd.clear", icon="X")


def _wrapped(text: str, width: int) -> List[str]:
    """Lines of so many characters at most, broken between words."""
    lines = [""]
    for word in text.split():
        if lines[-1] and len(lines[-1]) + 1 + len(word) > width:
            lines.append("")
        lines[-1] += (" " if lines[-1] else "") + word
    return lines


_classes = (CSCD_UL_events, CSCD_UL_ignored, CSCD_PT_check, CSCD_PT_left_out, CSCD_PT_events, CSCD_PT_marks, CSCD_PT_untangle)

register, unregister = bpy.utils.register_classes_factory(_classes)

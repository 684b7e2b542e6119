"""What the buttons of the panel do."""

from __future__ import annotations

import os
import pathlib
import threading
from typing import Any, Callable, List, Optional, Set

import bpy

import cscd

from . import marks
from .checking import Findings, Run, run_to_end
from .properties import findings_of, is_running, keep_findings, say_running
from .scene import KeptFrame, SceneError, read_frames
from .untangling import UntangleRun, untangle_to_end

#: Seconds between two turns of a run, and how long a turn waits.
_TICK, _PATIENCE = 0.02, 0.01

#: What a scene can be wrong with, said in a sentence.
_FAILURES = (SceneError, MemoryError, ValueError, cscd.Error)


def _redraw(context: Any) -> None:
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()


class CSCD_OT_check(bpy.types.Operator):
    """Find where the objects go through each other and themselves, in every frame. Esc ends it"""

    bl_idname = "cscd.check"
    bl_label = "Check"
    bl_options = {"REGISTER"}

    _run: Optional[Run] = None
    _scene_name = ""
    _timer: Any = None

    @classmethod
    def poll(cls, context: Any) -> bool:
        if context.mode.startswith("EDIT"):
            cls.poll_message_set("Leave edit mode: what is checked are objects as they are rendered")
            return False
        return not is_running()

    def execute(self, context: Any) -> Set[str]:
        """The whole run at once, for scripts."""
        try:
            keep_findings(context.scene, run_to_end(context, context.scene.cscd.request(context)))
        except _FAILURES as problem:
            self.report({"ERROR"}, str(problem))
            return {"CANCELLED"}
        self.report({"INFO"}, context.scene.cscd.summary)
        return {"FINISHED"}

    def invoke(self, context: Any, event: Any) -> Set[str]:
        if bpy.app.background:
            return self.execute(context)
        try:
            self._run = Run(context, context.scene.cscd.request(context))
        except _FAILURES as problem:
            self.report({"ERROR"}, str(problem))
            return {"CANCELLED"}
        self._scene_name = context.scene.name
        context.scene.cscd.progress = 0.0
        say_running(self._scene_name, True)
        self._timer = context.window_manager.event_timer_add(_TICK, window=context.window)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: Any, event: Any) -> Set[str]:
        if event.type == "ESC":
            self.cancel(context)
            self.report({"INFO"}, "Stopped; the findings of the check before are kept")
            return {"CANCELLED"}
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        assert self._run is not None
        try:
            more = self._run.step(_PATIENCE)
            scene = self._scene()
        except _FAILURES as problem:
            self.cancel(context)
            self.report({"ERROR"}, str(problem))
            return {"CANCELLED"}
        except BaseException:
            self.cancel(context)
            raise
        scene.cscd.progress = 100.0 * self._run.done / self._run.total
        _redraw(context)
        if more:
            return {"RUNNING_MODAL"}
        keep_findings(scene, self._run.findings)
        self._end(context)
        self.report({"INFO"}, scene.cscd.summary)
        return {"FINISHED"}

    def _scene(self) -> Any:
        """The scene that is checked; the window may show another one by now."""
        scene = bpy.data.scenes.get(self._scene_name)
        if scene is None:
            raise SceneError(f"the scene {self._scene_name!r} is no longer there")
        return scene

    def cancel(self, context: Any) -> None:
        """Ends the run early; also called when the window closes."""
        if self._run is not None:
            self._run.cancel()
        self._end(context)

    def _end(self, context: Any) -> None:
        say_running(self._scene_name, False)
        if self._timer is not None:
            context.window_manager.event_timer_remove(self._timer)
        self._timer = self._run = None
        _redraw(context)


class CSCD_OT_untangle(bpy.types.Operator):
    """Lead the active object out of itself and of the others, as shape keys. Esc ends it"""

    bl_idname = "cscd.untangle"
    bl_label = "Untangle"
    bl_options = {"REGISTER", "UNDO"}

    every_frame: bpy.props.BoolProperty(  # type: ignore[valid-type]
        name="All frames", description="Each frame of the range has a key of its own, which is keyed; else this frame has one")

    _run: Optional[UntangleRun] = None
    _scene_name = ""
    _timer: Any = None

    @classmethod
    def poll(cls, context: Any) -> bool:
        if context.mode != "OBJECT":
            cls.poll_message_set("Go to object mode: what is untangled is the object as it is rendered")
            return False
        return not is_running() and context.view_layer.objects.active is not None

    def _say(self, scene: Any, result: Any) -> Set[str]:
        scene.cscd.untangled = result.sentence
        self.report({"INFO"} if result.clean else {"WARNING"}, result.sentence)
        return {"FINISHED"}

    def execute(self, context: Any) -> Set[str]:
        """The whole run at once, for scripts."""
        try:
            result = untangle_to_end(context, context.scene.cscd.untangle_request(context, self.every_frame))
        except _FAILURES as problem:
            self.report({"ERROR"}, str(problem))
            return {"CANCELLED"}
        return self._say(context.scene, result)

    def invoke(self, context: Any, event: Any) -> Set[str]:
        if bpy.app.background:
            return self.execute(context)
        try:
            self._run = UntangleRun(context, context.scene.cscd.untangle_request(context, self.every_frame))
        except _FAILURES as problem:
            self.report({"ERROR"}, str(problem))
            return {"CANCELLED"}
        self._scene_name = context.scene.name
        context.scene.cscd.progress = 0.0
        say_running(self._scene_name, True)
        self._timer = context.window_manager.event_timer_add(_TICK, window=context.window)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: Any, event: Any) -> Set[str]:
        if event.type == "ESC":
            self.cancel(context)
            self.report({"INFO"}, "Stopped; nothing was changed")
            return {"CANCELLED"}
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        assert self._run is not None
        scene = bpy.data.scenes.get(self._scene_name)
        try:
            more = self._run.step(_PATIENCE)
        except _FAILURES as problem:
            self._end(context)
            self.report({"ERROR"}, str(problem))
            return {"CANCELLED"}
        except BaseException:
            self._end(context)
            raise
        if scene is not None:
            scene.cscd.progress = 100.0 * self._run.done / (self._run.total + 1)
        _redraw(context)
        if more:
            return {"RUNNING_MODAL"}
        result = self._run.result
        self._end(context)
        return self._say(scene or context.scene, result)

    def cancel(self, context: Any) -> None:
        """Ends the run early; also called when the window closes."""
        if self._run is not None:
            self._run.cancel()
        self._end(context)

    def _end(self, context: Any) -> None:
        say_running(self._scene_name, False)
        if self._timer is not None:
            context.window_manager.event_timer_remove(self._timer)
        self._timer = self._run = None
        _redraw(context)


class _MarkOperator:
    """What operators have in common that put findings into the scene."""

    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: Any) -> bool:
        return findings_of(context.scene) is not None and context.mode == "OBJECT"


class _MarkObjects(_MarkOperator):
    """Marks each object that was checked, and says on how many, and on which ones it could not."""

    mark: Callable[[Findings, Any], int]
    made: str

    def execute(self, context: Any) -> Set[str]:
        findings = findings_of(context.scene)
        assert findings is not None
        text = f"{self.made} on {self.mark(findings, context.view_layer)} objects"
        left = marks.unmarked_names(findings, context.view_layer)
        if left:
            self.report({"WARNING"}, f"{text}; not on {', '.join(left)}, "  # type: ignore[attr-defined]
                        "whose modifiers make other faces, or which belong to other files: apply the modifiers, or make "
                        "them local")
        else:
            self.report({"INFO"}, text)  # type: ignore[attr-defined]
        return {"FINISHED"}


class CSCD_OT_mark_attributes(_MarkObjects, bpy.types.Operator):
    """Write the face attribute cscd_kind and the vertex attribute cscd_depth, the worst over all frames"""

    bl_idname = "cscd.mark_attributes"
    bl_label = "Attributes"
    mark = staticmethod(marks.add_attributes)
    made = "Attributes"


class CSCD_OT_mark_groups(_MarkObjects, bpy.types.Operator):
    """Make a vertex group of what intersects, weighted by depth"""

    bl_idname = "cscd.mark_groups"
    bl_label = "Vertex Group"
    mark = staticmethod(marks.add_groups)
    made = "A vertex group"


class CSCD_OT_mark_materials(_MarkObjects, bpy.types.Operator):
    """Colour the faces that intersect, by kind and depth; Clear gives their materials back"""

    bl_idname = "cscd.mark_materials"
    bl_label = "Colours"
    mark = staticmethod(marks.add_materials)
    made = "Colours"


class CSCD_OT_mark_curves(_MarkOperator, bpy.types.Operator):
    """Draw the curves along which surfaces cross in the current frame, as a curve object"""

    bl_idname = "cscd.mark_curves"
    bl_label = "Curves of This Frame"

    def execute(self, context: Any) -> Set[str]:
        findings = findings_of(context.scene)
        assert findings is not None
        count = marks.add_curves(findings, context.scene, context.scene.frame_current)
        self.report({"INFO"}, f"{count} curves at frame {context.scene.frame_current}")
        return {"FINISHED"}


class CSCD_OT_mark_timeline(bpy.types.Operator):
    """Put a marker on the timeline where each event is worst"""

    bl_idname = "cscd.mark_timeline"
    bl_label = "Timeline Markers"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: Any) -> bool:
        return len(context.scene.cscd.events) > 0

    def execute(self, context: Any) -> Set[str]:
        self.report({"INFO"}, f"{marks.add_timeline_markers(context.scene)} markers")
        return {"FINISHED"}


class CSCD_OT_clear(bpy.types.Operator):
    """Take the list and all marks out of the scene again"""

    bl_idname = "cscd.clear"
    bl_label = "Clear"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: Any) -> bool:
        return context.mode == "OBJECT" and not is_running()

    def execute(self, context: Any) -> Set[str]:
        marks.clear(context)
        keep_findings(context.scene, None)
        return {"FINISHED"}


class CSCD_OT_show_event(bpy.types.Operator):
    """Go to the frame where the event is worst, frame it, and select its faces"""

    bl_idname = "cscd.show_event"
    bl_label = "Show"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: Any) -> bool:
        return 0 <= context.scene.cscd.event_index < len(context.scene.cscd.events)

    def execute(self, context: Any) -> Set[str]:
        settings = context.scene.cscd
        marks.show_event(context, settings.events[settings.event_index])
        return {"FINISHED"}


class CSCD_OT_ignore(bpy.types.Operator):
    """Leave out two parts in the checks to come"""

    bl_idname = "cscd.ignore"
    bl_label = "Leave Out"
    bl_options = {"REGISTER", "UNDO"}

    from_event: bpy.props.BoolProperty(options={"HIDDEN"})  # type: ignore[valid-type]

    def execute(self, context: Any) -> Set[str]:
        settings = context.scene.cscd
        added = settings.ignored.add()
        if self.from_event and 0 <= settings.event_index < len(settings.events):
            event = settings.events[settings.event_index]
            added.a, added.b = event.a, event.b
        settings.ignored_index = len(settings.ignored) - 1
        return {"FINISHED"}


class CSCD_OT_look_at_again(bpy.types.Operator):
    """Take a pair of parts from the list of what is left out"""

    bl_idname = "cscd.look_at_again"
    bl_label = "Look At Again"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: Any) -> bool:
        return 0 <= context.scene.cscd.ignored_index < len(context.scene.cscd.ignored)

    def execute(self, context: Any) -> Set[str]:
        settings = context.scene.cscd
        settings.ignored.remove(settings.ignored_index)
        settings.ignored_index = max(0, settings.ignored_index - 1)
        return {"FINISHED"}


class CSCD_OT_report(bpy.types.Operator):
    """Write the page of the findings, and open it in the browser"""

    bl_idname = "cscd.report"
    bl_label = "Report Page"
    bl_options = {"REGISTER"}

    filepath: bpy.props.StringProperty(subtype="FILE_PATH")  # type: ignore[valid-type]
    filter_glob: bpy.props.StringProperty(default="*.html", options={"HIDDEN"})  # type: ignore[valid-type]
    open_page: bpy.props.BoolProperty(name="Open in the browser", default=True)  # type: ignore[valid-type]

    _timer: Any = None

    @classmethod
    def poll(cls, context: Any) -> bool:
        return findings_of(context.scene) is not None

    def invoke(self, context: Any, event: Any) -> Set[str]:
        name = os.path.splitext(bpy.data.filepath)[0] or os.path.join(os.path.expanduser("~"), "cscd")
        self.filepath = f"{name}.html"
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, context: Any) -> Set[str]:
        """Reads a frame in each turn, and writes the page on a thread, so that the window stays alive."""
        findings = findings_of(context.scene)
        assert findings is not None
        if len(findings.frames) < 2:
            self.report({"ERROR"}, "The page shows motion: check two frames or more")
            return {"CANCELLED"}
        self._findings = findings
        self._said: List[str] = []
        self._thread: Optional[threading.Thread] = None
        self._read: List[Any] = []
        self._kept = KeptFrame(context.scene)
        self._coming = read_frames(context.scene, findings.checked, context.view_layer, list(findings.frames))
        scene = context.scene
        self._arguments = dict(title=os.path.basename(bpy.data.filepath) or scene.name, part_names=findings.parts.names,
                               part_labels=findings.parts.labels, frame_numbers=list(findings.frames),
                               fps=scene.render.fps / scene.render.fps_base, up="z")
        if bpy.app.background:
            while self._thread is None:
                if not self._take_frame():
                    return {"CANCELLED"}
            self._thread.join()
            return self._finish()
        context.window_manager.progress_begin(0, len(findings.frames))
        self._timer = context.window_manager.event_timer_add(_TICK, window=context.window)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def _take_frame(self) -> bool:
        """Reads a frame; behind the last one the page is begun. False: it was said what is wrong."""
        try:
            positions = next(self._coming, None)
        except SceneError as problem:
            self._kept.restore()
            self.report({"ERROR"}, str(problem))
            return False
        if positions is not None:
            self._read.append(positions)
            return True
        self._kept.restore()
        self._thread = threading.Thread(target=self._write, daemon=True)
        self._thread.start()
        return True

    def _write(self) -> None:
        try:
            cscd.write_report(bpy.path.abspath(self.filepath), self._read, self._findings.checked.mesh, **self._arguments)
        except Exception as problem:
            self._said.append(str(problem))

    def modal(self, context: Any, event: Any) -> Set[str]:
        if self._thread is None and event.type == "ESC":
            self._kept.restore()
            self._end(context)
            self.report({"INFO"}, "Stopped; no page was written")
            return {"CANCELLED"}
        if event.type != "TIMER" or (self._thread is not None and self._thread.is_alive()):
            return {"PASS_THROUGH"}
        if self._thread is None:
            if not self._take_frame():
                self._end(context)
                return {"CANCELLED"}
            context.window_manager.progress_update(len(self._read))
            return {"RUNNING_MODAL"}
        self._end(context)
        return self._finish()

    def cancel(self, context: Any) -> None:
        """The window closes."""
        if self._thread is None:
            self._kept.restore()
        self._end(context)

    def _end(self, context: Any) -> None:
        context.window_manager.event_timer_remove(self._timer)
        context.window_manager.progress_end()

    def _finish(self) -> Set[str]:
        if self._said:
            self.report({"ERROR"}, self._said[0])
            return {"CANCELLED"}
        path = bpy.path.abspath(self.filepath)
        self.report({"INFO"}, f"{path} is written")
        if self.open_page and not bpy.app.background:
            bpy.ops.wm.url_open(url=pathlib.Path(path).absolute().as_uri())
        return {"FINISHED"}


_classes = (CSCD_OT_check, CSCD_OT_untangle, CSCD_OT_mark_attributes, CSCD_OT_mark_groups, CSCD_OT_mark_materials,
            CSCD_OT_mark_curves, CSCD_OT_mark_timeline, CSCD_OT_clear, CSCD_OT_show_event, CSCD_OT_ignore,
            CSCD_OT_look_at_again, CSCD_OT_report)

register, unregister = bpy.utils.register_classes_factory(_classes)

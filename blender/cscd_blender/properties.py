"""What the panel remembers in a scene: what to check, what to leave out, and the list of events."""

from __future__ import annotations

from typing import Any, Dict, Optional, Set, Tuple

import bpy

from .checking import Findings, FoundEvent, Request
from .scene import SceneError, frames_of
from .untangling import UntangleRequest

#: The findings of this session, by the name of the scene; a file keeps the list of events alone.
_findings: Dict[str, Findings] = {}

#: The names of scenes whose check is running. They are not kept in the scenes, where an undo would bring them back.
_running: Set[str] = set()


def is_running() -> bool:
    """Whether a check is going on in some scene."""
    return bool(_running)


def say_running(scene_name: str, running: bool) -> None:
    """Remembers that a check has begun in a scene, or ended."""
    if running:
        _running.add(scene_name)
    else:
        _running.discard(scene_name)


@bpy.app.handlers.persistent
def _forget_file(*_: Any) -> None:
    """Another file has scenes of the same names."""
    _findings.clear()
    _running.clear()


def findings_of(scene: Any) -> Optional[Findings]:
    """What the last check of a scene in this session has found."""
    return _findings.get(scene.name)


def keep_findings(scene: Any, findings: Optional[Findings]) -> None:
    """Remembers findings, and puts their events into the list; None forgets them."""
    settings = scene.cscd
    settings.events.clear()
    settings.summary = ""
    _findings.pop(scene.name, None)
    if findings is None:
        return
    from .farm import summarise
    _findings[scene.name] = findings
    settings.summary = summarise(findings)
    for event in findings.events:
        settings.events.add().take(event)
    settings["event_index"] = 0  # without going there


def _go_to_event(settings: Any, context: Any) -> None:
    if 0 <= settings.event_index < len(settings.events):
        from .marks import show_event
        show_event(context, settings.events[settings.event_index])


class CscdEvent(bpy.types.PropertyGroup):
    """An event of the list."""

    a: bpy.props.StringProperty(name="Part")  # type: ignore[valid-type]
    b: bpy.props.StringProperty(name="Other part")  # type: ignore[valid-type]
    first: bpy.props.IntProperty(name="First frame")  # type: ignore[valid-type]
    last: bpy.props.IntProperty(name="Last frame")  # type: ignore[valid-type]
    worst: bpy.props.IntProperty(name="Worst frame")  # type: ignore[valid-type]
    kinds: bpy.props.StringProperty(name="Kinds")  # type: ignore[valid-type]
    depth: bpy.props.FloatProperty(name="Depth", unit="LENGTH")  # type: ignore[valid-type]
    place: bpy.props.FloatVectorProperty(name="Place", subtype="XYZ")  # type: ignore[valid-type]
    has_place: bpy.props.BoolProperty(name="Place is known")  # type: ignore[valid-type]

    def take(self, event: FoundEvent) -> None:
        """Copies an event of the findings."""
        self.name = f"{event.a} x {event.b}"
        for member in ("a", "b", "first", "last", "worst", "depth"):
            setattr(self, member, getattr(event, member))
        self.kinds = ", ".join(event.kinds) or ("contact" if event.contacts else "buried")
        self.has_place = event.place is not None
        if event.place is not None:
            self.place = event.place


class CscdIgnored(bpy.types.PropertyGroup):
    """Two parts that are not looked at with each other."""

    a: bpy.props.StringProperty(name="Part", description="An object, or OBJECT/GROUP")  # type: ignore[valid-type]
    b: bpy.props.StringProperty(name="Other part",  # type: ignore[valid-type]
                                description="An object, or OBJECT/GROUP; the same part: with itself")


class CscdSettings(bpy.types.PropertyGroup):
    """The settings of a scene."""

    source: bpy.props.EnumProperty(  # type: ignore[valid-type]
        name="Check", description="Which objects are checked",
        items=[("VISIBLE", "Visible objects", "All visible objects that have faces"),
               ("SELECTED", "Selected objects", "The selected objects"),
               ("COLLECTION", "A collection", "The objects of a collection, and of those in it")])
    collection: bpy.props.PointerProperty(type=bpy.types.Collection, name="Collection")  # type: ignore[valid-type]
    use_range: bpy.props.BoolProperty(  # type: ignore[valid-type]
        name="Own frame range", description="Check other frames than those of the scene")
    first: bpy.props.IntProperty(name="First", default=1)  # type: ignore[valid-type]
    last: bpy.props.IntProperty(name="Last", default=250)  # type: ignore[valid-type]
    step: bpy.props.IntProperty(name="Step", default=1, min=1,  # type: ignore[valid-type]
                                description="Check every so many frames")
    by_groups: bpy.props.BoolProperty(  # type: ignore[valid-type]
        name="Parts by vertex group", default=True,
        description="The bone or vertex group with the largest weight says which part a face is in; else an object is one part")
    rest: bpy.props.EnumProperty(  # type: ignore[valid-type]
        name="At rest", description="What is left out because it meets in the first frame",
        items=[("NONE", "Nothing left out", "Everything that meets is found"),
               ("PARTS", "Parts that meet in the first frame", "Pairs of parts that meet in the first frame are left out"),
               ("PAIRS", "Faces that meet in the first frame", "Pairs of faces that meet in the first frame are left out")])
    ignored: bpy.props.CollectionProperty(type=CscdIgnored)  # type: ignore[valid-type]
    ignored_index: bpy.props.IntProperty()  # type: ignore[valid-type]
    depths: bpy.props.BoolProperty(name="Depths", default=True,  # type: ignore[valid-type]
                                   description="Find how deep surfaces go into each other, and the curves along which they cross")
    events: bpy.props.CollectionProperty(type=CscdEvent)  # type: ignore[valid-type]
    event_index: bpy.props.IntProperty(name="Event", update=_go_to_event)  # type: ignore[valid-type]
    summary: bpy.props.StringProperty()  # type: ignore[valid-type]
    progress: bpy.props.FloatProperty(name="Progress", subtype="PERCENTAGE", min=0, max=100,  # type: ignore[valid-type]
                                      options={"SKIP_SAVE"})

    gap: bpy.props.FloatProperty(  # type: ignore[valid-type]
        name="Gap", default=0.0, min=0.0, unit="LENGTH", precision=4, description="Surfaces keep this distance after Untangle")
    pin_group: bpy.props.StringProperty(  # type: ignore[valid-type]
        name="Pin",
        description="A vertex group of the active object: vertices of weight 1 stay, others the more the larger it is")
    steady: bpy.props.FloatProperty(  # type: ignore[valid-type]
        name="Steady", default=0.5, min=0.0, max=0.99,
        description="Of several frames: near 1 a displacement lasts from frame to frame, against jitter")
    untangled: bpy.props.StringProperty()  # type: ignore[valid-type]

    def untangle_request(self, context: Any, every_frame: bool) -> UntangleRequest:
        """What these settings ask for: the active object in the frame at hand, or in the frames of a check."""
        thing, scene = context.view_layer.objects.active, context.scene
        if thing is None:
            raise SceneError("no object is active: click the one whose vertices are to move")
        beside = self.request(context)
        frames = frames_of(scene, beside.first, beside.last) if every_frame else (scene.frame_current,)
        return UntangleRequest(thing.name_full, beside, tuple(frames), self.gap, self.pin_group, self.steady)

    def request(self, context: Any) -> Request:
        """What these settings ask for."""
        objects: Tuple[str, ...] = ()
        collections: Tuple[str, ...] = ()
        if self.source == "SELECTED":
            objects = tuple(thing.name_full for thing in context.selected_objects)
            if not objects:
                raise SceneError("no object is selected: select what is to be checked, or choose Visible objects")
        elif self.source == "COLLECTION":
            if self.collection is None:
                raise SceneError("no collection is chosen: choose one below Check, or choose Visible objects")
            collections = (self.collection.name,)
        return Request(objects, collections, self.first if self.use_range else None, self.last if self.use_range else None,
                       self.step, self.by_groups, tuple((pair.a, pair.b) for pair in self.ignored if pair.a and pair.b),
                       {"NONE": None, "PARTS": "parts", "PAIRS": "pairs"}[self.rest], self.depths)


_register_classes, _unregister_classes = bpy.utils.register_classes_factory((CscdEvent, CscdIgnored, CscdSettings))


def register() -> None:
    _register_classes()
    bpy.types.Scene.cscd = bpy.props.PointerProperty(type=CscdSettings)
    bpy.app.handlers.load_post.append(_forget_file)


def unregister() -> None:
    bpy.app.handlers.load_post.remove(_forget_file)
    del bpy.types.Scene.cscd
    _unregister_classes()
    _forget_file()

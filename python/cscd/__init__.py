"""cscd: where and when do the surfaces of triangle meshes run into themselves and each other?

One mesh at one moment: ``self_intersections``, ``is_self_intersecting``, ``self_intersecting_faces`` for many frames,
``intersections`` of two meshes. Two moments: ``contacts``. A recording: ``replay``. Solvers keep a ``Detector``.
Every verdict is that of exact arithmetic on the given numbers. Positions belong to a call until it returns: another
thread must not write to them meanwhile.
"""

from __future__ import annotations

from ._library import library as _library
from .detector import Detector
from .energy import Energy, EnergySum
from .errors import Cancelled, Error, InContact, ListTooLong
from .files import FrameSequence, Recording, read, write_report
from .intersections import Curve, Intersections, PartPairs
from .lenses import LENS_REASONS, Lenses, Patches
from .line_search import LineSearch
from .measures import Measures, TetSurface, tet_surface
from .mesh import HalfSpace, Mesh, Points, Scene, Wires
from .pairs import pairs_near, pairs_step
from .plan import ComparedPlan, Plan
from .questions import contacts, intersections, is_self_intersecting, self_intersecting_faces, self_intersections
from .replay import Frame, Replay, replay
from .results import (CONTACT_KINDS, INTERSECTION_KINDS, RESPONSES, UNTANGLE_STARTS, Contacts, Events, PairContacts,
                      PairDistances, Proximities, SafeMotion, Untangled)
from .untangling import untangle, untangle_frames

__version__: str = _library.cscd_version_string().decode()

__all__ = ["CONTACT_KINDS", "Cancelled", "ComparedPlan", "Contacts", "Curve", "Detector", "Energy", "EnergySum",
           "Error", "Events", "Frame", "FrameSequence", "HalfSpace", "INTERSECTION_KINDS", "InContact",
           "Intersections", "LENS_REASONS", "Lenses", "LineSearch", "ListTooLong", "Measures", "Mesh", "PairContacts",
           "PairDistances", "PartPairs", "Patches", "Plan", "Points", "Proximities", "RESPONSES", "Recording",
           "Replay", "SafeMotion", "Scene", "TetSurface", "UNTANGLE_STARTS", "Untangled", "Wires", "__version__",
           "contacts", "intersections", "is_self_intersecting", "pairs_near", "pairs_step", "read", "replay",
           "self_intersecting_faces", "self_intersections", "tet_surface", "untangle", "untangle_frames",
           "write_report"]

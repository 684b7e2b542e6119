"""Intersections at one moment: pairs of triangles with their kinds, curves, buried patches, and depths."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Iterable, List, NamedTuple, NoReturn, Optional, Tuple, Union

import numpy as np

from ._arrays import count_of
from ._library import address_of, copy_items, copy_list, library, new_struct, records, structs
from .results import INTERSECTION_KINDS, names_of

if TYPE_CHECKING:
    from .detector import Detector
    from .lenses import Patches
    from .mesh import Mesh

__all__ = ["Curve", "Intersections", "PartPairs"]

Array = Any

_NONE = 2**32 - 1
_LIST, _ANY = 0, 2

#: The results that a search may leave out: see ``Intersections.left_out``.
LEFT_OUT = names_of("CSCD_LEFT_OUTS")


def kind_set(kinds: Union[None, str, Iterable[str]]) -> int:
    """A set of kinds as the library takes it; None stands for all."""
    if kinds is None:
        return 2**64 - 1
    names = [kinds] if isinstance(kinds, str) else list(kinds)
    for name in names:
        if name not in INTERSECTION_KINDS:
            raise ValueError(f"kinds: expected some of {', '.join(INTERSECTION_KINDS)}; got {name!r}")
    if not names:
        raise ValueError(f"kinds: expected some of {', '.join(INTERSECTION_KINDS)}; got none")
    return sum(1 << INTERSECTION_KINDS.index(name) for name in set(names))


class Curve(NamedTuple):
    """A curve along which two sheets of surface pass through each other."""

    #: (p, 3) float64: the points of the curve, in the unit of the positions; a closed one ends where it begins.
    points: Array
    #: (p - 1, 2) int64: the triangles of each piece, the first sheet's and the second one's.
    triangles: Array
    closed: bool
    #: The surfaces only touch along it.
    touching: bool
    length: float
    #: The components of the two sheets.
    components: Tuple[int, int]
    objects: Tuple[int, int]


class PartPairs(np.recarray):  # type: ignore[type-arg]
    """Intersections summed up by pair of parts: a, b, crossing, coplanar, folded, duplicate, touching, faces (2),
    shares (2), curves, touching_curves, length, depth, bound, same_solid, in_other_body.

    A part that is closed by itself is a body of its own here: depths are measured to its own surface, and may be other than
    those of ``Intersections``."""


class Intersections:
    """The pairs of triangles of a mesh that intersect or touch at one moment. True if there are any.

    Attributes
    ----------
    mesh : Mesh
    triangles : (k, 2) int64
        Two triangles of ``mesh``, the smaller number first, sorted.
    kind : (k,) int64
        How they meet: a code of ``INTERSECTION_KINDS``.
    shared : (k,) int64
        How many vertices they share, 0 to 3.
    components, objects : (k, 2) int64
    stopped : bool
        The search ended at ``stop_after`` pairs, so there may be more.
    collapsed : (c,) int64
        The components that have no surface here, because all their triangles have no area, as of an object that is hidden
        by a scale of 0. They were not looked at: a mesh all of whose components are among them has no pairs.
    """

    def __init__(self, mesh: Mesh, detector: Optional[Detector], positions: Any, pairs: Array, stopped: bool,
                 allowed: bool) -> None:
        self.mesh = mesh
        self.stopped = stopped
        self.collapsed: Array = np.empty(0, np.int64)
        self._detector = detector
        self._positions = positions
        self._allowed = allowed
        self._surface: Optional[_Surface] = None
        self._patches: Optional[Patches] = None
        #: For a frame of ``replay``: the findings, summed up by pair of parts.
        self.part_pairs: Optional[PartPairs] = None
        #: For a frame of ``replay``: results that do not fit ``max_memory`` or ``max_work``, as ("depths",); they raise
        #: ``MemoryError`` on access; ``part_pairs`` is None then. () elsewhere.
        self.left_out: Tuple[str, ...] = ()
        #: The face that counts as row 0 of each column of ``pairs``.
        self.first_faces: Array = np.zeros(2, np.int64)
        self.triangles: Array = np.stack([pairs["a"], pairs["b"]], axis=1)
        self.kind: Array = pairs["kind"].copy()
        self.shared: Array = pairs["shared"].copy()
        self.components: Array = pairs["components"].copy()
        self.objects: Array = pairs["objects"].copy()

    @classmethod
    def none(cls, mesh: Mesh) -> Intersections:
        """The findings in a mesh without triangles."""
        found = cls(mesh, None, None, np.empty(0, records["intersection"]), False, True)
        found._surface = _Surface.none(mesh.vertex_count)
        return found

    def __len__(self) -> int:
        return len(self.kind)

    @property
    def pairs(self) -> Array:
        """(k, 2) int64: the faces, as rows of F, that the triangles are cut from."""
        return self.mesh.triangle_face[self.triangles] - self.first_faces

    @property
    def faces(self) -> Array:
        """(m,) bool: the faces that take part in a pair."""
        marked = np.zeros(self.mesh.face_count, bool)
        marked[self.mesh.triangle_face[self.triangles].ravel()] = True
        return marked

    def kind_names(self) -> List[str]:
        """The name of each pair's kind."""
        return [INTERSECTION_KINDS[kind] for kind in self.kind]

    def count(self, kind: str) -> int:
        """The number of pairs of a kind, as in ``count("crossing")``."""
        kind_set(kind)
        return int((self.kind == INTERSECTION_KINDS.index(kind)).sum())

    # ---- computed when they are asked for ----------------------------------------------------------------

    @property
    def curves(self) -> List[Curve]:
        """The curves along which surfaces pass through each other."""
        return self._found().curves()

    @property
    def patches(self) -> Patches:
        """What the curves cut surfaces into, what buries these, and what curves cut off of open surfaces."""
        if self._patches is None:
            detector, positions = self._again()
            self._patches = detector._patches(positions)
        return self._patches

    @property
    def buried(self) -> Array:
        """(n,) bool: the vertices that an object contains; of their own one, that it contains twice."""
        return self._found().buried

    @property
    def depth(self) -> Array:
        """(n,) float64: how deep each vertex is below the surface that contains it; 0 where none does."""
        return self._found().depth

    @property
    def depths(self) -> Array:
        """All depths, by the members of ``cscd_depth`` (include/cscd/surface.h): of vertices, then of edges, whose ``vertex``
        is -1, then the deepest points of faces, whose ``edge`` is -1, too."""
        return self._found().depths

    @property
    def max_depth(self) -> float:
        """The greatest of all depths; 0 without any."""
        depths = self.depths
        return float(depths["depth"].max()) if len(depths) else 0.0

    def by_parts(self, labels: Any, part_count: Optional[int] = None, bodies: Any = None) -> PartPairs:
        """Sums up by pair of parts.

        Parameters
        ----------
        labels : (t,) integers
            The part of each triangle of ``mesh``; -1: it is in none.
        bodies : (t,) integers, optional
            What belongs together, in which depths are measured, as ``Recording.body_labels``; by default the parts.
        """
        detector, positions = self._again()
        with detector._host.lock:  # labels that other threads, or the caller of the detector, have chosen stay
            before = detector._labels, detector._bodies
            try:
                detector.set_parts(labels, part_count)
                detector.set_bodies(bodies)
                return detector._surface_answers(positions, parts=True).parts
            finally:
                detector._set_labels(before[0])
                detector._set_bodies(before[1])

    def _again(self) -> Tuple[Detector, Any]:
        if not self._allowed:
            raise ValueError("curves, patches, buried, depth and parts need the list of all pairs; leave out kinds= and "
                             "stop_after=")
        if self._detector is None:
            raise ValueError("curves, patches, buried, depth and parts are computed when they are asked for, and do not "
                             "come along in a copy or a pickle; ask for them before")
        return self._detector, self._positions

    def _found(self) -> _Surface:
        if self._surface is None:
            detector, positions = self._again()
            self._surface = detector._surface_answers(positions)
        return self._surface

    def __repr__(self) -> str:
        counts = [f"{self.count(name)} {name}" for name in INTERSECTION_KINDS if self.count(name)]
        missing = len(self.collapsed)
        without = f"; {missing} component{'s' if missing > 1 else ''} without a surface" if missing else ""
        return f"Intersections({', '.join(counts) or 'none'}{without})"

    def __getstate__(self) -> Any:
        return {**self.__dict__, "_detector": None, "_positions": None}


def collapsed_of(found: Array) -> Array:
    """A copy of the components that a list of pairs says have no surface."""
    count = int(found["collapsed"][0])
    if count == 0:
        return np.empty(0, np.int64)
    return copy_list(int(found["collapsed_components"][0]), count, np.uint32).astype(np.int64)


class _Surface:
    """Copies of curves, patches, depths and parts, which live in the library until its next call."""

    def __init__(self, found: Array, vertex_count: int, depths: bool, parts: bool) -> None:
        self._lists: Tuple[Array, Array, Array] = (np.empty(0), np.empty(0), np.empty(0))
        self._found_depths: Optional[Tuple[Array, Array, Array]] = None
        self._found_parts: Optional[PartPairs] = None
        #: The results that did not fit max_memory or max_work, and the amount that would have been enough to go on.
        self.left_out: Tuple[str, ...] = ()
        if len(found) == 0:
            return
        members = "left_out", "count", "wanted_memory", "wanted_work"
        bits, self._pair_count, memory, work = (int(found[name][0]) for name in members)
        self._wanted = (f"max_work, of which they would take some {work} comparisons" if work else
                        f"max_memory, of which {memory} bytes would be the least to try")
        self.left_out = tuple(name for i, name in enumerate(LEFT_OUT) if bits >> i & 1)
        if depths and "curves" not in self.left_out:
            self._copy_curves(int(found["curves"][0]))
        if depths and "depths" not in self.left_out:
            self._copy_depths(int(found["depths"][0]), vertex_count)
        if parts and "parts" not in self.left_out:
            sums = copy_struct("part_pairs", int(found["parts"][0]))
            self._found_parts = copy_items(int(sums["items"]), int(sums["count"]), "part_pair").view(PartPairs)

    def _refuse(self, name: str) -> NoReturn:
        raise MemoryError(f"the {name} of {self._pair_count} pairs of triangles do not fit {self._wanted}; "
                          "are the vertices in another order than those of the faces?")

    def check_patches(self) -> None:
        """Fails if patches or cut-offs did not fit."""
        for name in ("curves", "patches", "cut-offs"):
            if name in self.left_out:
                self._refuse(name)

    @classmethod
    def none(cls, vertex_count: int) -> _Surface:
        """Nothing is buried, and there are no curves."""
        found = cls(np.empty(0), vertex_count, False, False)
        depths = np.empty(0, records["depth"]).view(np.recarray)
        found._found_depths = depths, np.zeros(vertex_count, bool), np.zeros(vertex_count)
        return found

    def _copy_curves(self, address: int) -> None:
        curves = copy_struct("curves", address)
        self._lists = (copy_items(int(curves["items"]), int(curves["count"]), "curve"),
                       copy_items(int(curves["points"]), int(curves["point_count"]), "curve_point"),
                       copy_items(int(curves["pieces"]), int(curves["piece_count"]), "curve_piece"))

    def _copy_depths(self, address: int, vertex_count: int) -> None:
        depths = copy_struct("depths", address)
        items = copy_items(int(depths["items"]), int(depths["count"]), "depth").view(np.recarray)
        of_vertices = items[: int(depths["vertex_count"])]
        buried, depth = np.zeros(vertex_count, bool), np.zeros(vertex_count)
        buried[of_vertices["vertex"]] = True
        np.maximum.at(depth, of_vertices["vertex"], of_vertices["depth"])
        self._found_depths = items, buried, depth

    def _depths(self) -> Tuple[Array, Array, Array]:
        if self._found_depths is None:
            self._refuse("depths")
        return self._found_depths

    @property
    def depths(self) -> Array:
        return self._depths()[0]

    @property
    def buried(self) -> Array:
        return self._depths()[1]

    @property
    def depth(self) -> Array:
        return self._depths()[2]

    @property
    def parts(self) -> PartPairs:
        if self._found_parts is None:
            self._refuse("sums by parts")
        return self._found_parts

    def curves(self) -> List[Curve]:
        if "curves" in self.left_out:
            self._refuse("curves")
        items, points, pieces = self._lists
        return [self._curve(item, points, pieces) for item in items]

    @staticmethod
    def _curve(item: Any, points: Array, pieces: Array) -> Curve:
        first, count = int(item["first_point"]), int(item["point_count"])
        begin, end = int(item["first_piece"]), int(item["first_piece"]) + int(item["piece_count"])
        line = points["x"][first: first + count]
        if item["closed"]:
            line = np.concatenate([line, line[:1]])
        triangles = np.stack([pieces["a"][begin:end], pieces["b"][begin:end]], axis=1)
        return Curve(line.copy(), triangles, bool(item["closed"]), bool(item["touching"]), float(item["length"]),
                     (int(item["components"][0]), int(item["components"][1])),
                     (int(item["objects"][0]), int(item["objects"][1])))


def copy_struct(name: str, address: int) -> Any:
    """A struct of the library, by its address."""
    return copy_list(address, 1, structs[name])[0]


def intersection_options(kinds: int, stop_after: int, any_alone: bool, depths: bool, parts: bool,
                         limits: Tuple[int, int]) -> Array:
    """Options of the library for one search."""
    options = new_struct("intersection_options")
    library.cscd_intersection_defaults_sized(address_of(options), options.nbytes)
    options["answer"] = _ANY if any_alone else _LIST
    options["kinds"] = kinds
    options["stop_after"] = stop_after
    options["curves"] = options["patches"] = options["depths"] = depths
    options["part_bodies"] = True
    options["parts"] = parts
    options["max_memory"], options["max_work"] = limits
    return options


def labels_of(labels: Any, triangle_count: int, part_count: Optional[int], called: str = "labels") -> Tuple[Array, int]:
    """Labels of triangles as the library takes them, and how many parts they make; ``called``: by the caller."""
    array = np.asarray(labels)
    if array.shape != (triangle_count,) or array.dtype.kind not in "iu":
        raise ValueError(f"{called}: expected {triangle_count} whole numbers, one for each triangle of the mesh, got "
                         f"shape {array.shape} of {array.dtype}")
    lowest, highest = (int(array.min()), int(array.max())) if array.size else (0, -1)
    count = highest + 1 if part_count is None else count_of("part_count", part_count, _NONE - 1)
    if lowest < -1 or highest >= max(count, 1) or highest >= _NONE:
        raise ValueError(f"{called}: expected numbers from 0 to {count - 1}, or -1 for no part; got "
                         f"{lowest} to {highest}")
    return np.where(array < 0, _NONE, array).astype(np.uint32), max(count, 1)

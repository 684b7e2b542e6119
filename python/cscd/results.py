"""Lists that the library gives out, as numpy arrays with names: contacts, proximities, events."""

from __future__ import annotations

from typing import Any, List, NamedTuple, Tuple

import numpy as np

from ._api import VALUES
from ._library import copy_items, copy_list, library, records

__all__ = ["CONTACT_KINDS", "Contacts", "Events", "INTERSECTION_KINDS", "PairContacts", "PairDistances", "Proximities",
           "RESPONSES", "SafeMotion"]


def names_of(enumeration: str) -> Tuple[str, ...]:
    """The names of all values of an enumeration (``cscd_enumeration``), in the order of their codes."""
    names: List[str] = []
    while True:
        name = library.cscd_name(VALUES[enumeration], len(names))
        if name == b"unknown":
            return tuple(names)
        names.append(name.decode())


#: The kinds of contacts by their codes: "vf", "ee", ...
CONTACT_KINDS = names_of("CSCD_CONTACT_KINDS")

#: The kinds of intersections by their codes: "crossing", "coplanar", "folded", "duplicate", "touching".
INTERSECTION_KINDS = names_of("CSCD_INTERSECTION_KINDS")


class Records(np.recarray):  # type: ignore[type-arg]
    """A structured array whose members are attributes, too, of the array and of each item."""

    @classmethod
    def record(cls) -> Any:
        """The dtype of one item."""
        raise NotImplementedError


class Contacts(Records):
    """Contacts, sorted by (toi, kind, a, b): where two features touch during an interval, and when they first do.

    Attributes
    ----------
    kind : (k,) int64
        A code of ``CONTACT_KINDS``: 0 is vf, a vertex and a face, 1 is ee, two edges.
    a, b : (k,) int64
        The features: vertex and triangle, or two edges, in the numbering of the mesh.
    toi : (k,) float64
        The time of impact, as a fraction of the interval, 0 to 1.
    u, v : (k,) float64
        Barycentric coordinates of the points that touch.
    vertices, weights : (k, 4) int64 and float64
        The four vertices behind each contact, and weights so that ``(weights[..., None] * x[vertices]).sum(1)`` is the
        vector to the point on a from that on b.
    point, normal : (k, 3) float64
        Where they touch, in the unit of the positions, and a unit vector against the motion of a relative to b.
    bounded : (k,) bool
        With a minimum separation only: the time is safe, but may be early.
    """

    @classmethod
    def record(cls) -> Any:
        return records["contact"]

    @property
    def weights(self) -> Any:
        return _weights(self)


#: What kept the motion of a vertex safe, by the codes of ``SafeMotion.responses``.
RESPONSES = ("free", "stopped", "truncated", "held")


class SafeMotion(NamedTuple):
    """The findings of ``Detector.make_safe``.

    Attributes
    ----------
    responses : (n,) uint8
        The strongest means that each vertex needed, a code of ``RESPONSES``.
    mean_share, least_share : float
        The share of its motion that a vertex made, along it, from 0 to 1.
    obstacle_share : float
        The least by which an obstacle, or all, went as a whole; mostly 1.
    rounds, truncations : int
        How many rounds of the search for contacts it took, and after how many of them planes shortened motions.
    pushed : int
        On how many pairs of points an impulse acts.
    moved : bool
        Some vertex is not where it was.
    held : Contacts
        The pairs that touch at ``x0``, whose vertices stay.
    """

    responses: Any
    mean_share: float
    least_share: float
    obstacle_share: float
    rounds: int
    truncations: int
    pushed: int
    moved: bool
    held: Contacts

    @classmethod
    def of(cls, found: Any, vertex_count: int) -> SafeMotion:
        """Copies the findings out of the library."""
        held: Contacts = copy_items(int(found["held"]), int(found["held_count"]), "contact").view(Contacts)
        return cls(copy_list(int(found["responses"]), vertex_count, np.uint8), float(found["mean_share"]),
                   float(found["least_share"]), float(found["obstacle_share"]), int(found["rounds"]),
                   int(found["truncations"]),
                   int(found["pushed"]), bool(found["moved"]), held)


#: The clean positions from which a result comes, by the codes of the library.
UNTANGLE_STARTS = ("none", "given", "pushed", "shrunk")


class Untangled(NamedTuple):
    """The findings of ``Detector.untangle``.

    Attributes
    ----------
    vertices : (n, 3)
        The positions that were found; the input itself where nothing better was.
    clean : bool
        Nothing intersects in these numbers, and all pairs keep what they have to.
    moved : bool
        Some vertex is not where it was.
    stopped : bool
        ``max_seconds`` or ``progress`` ended the call before it was done.
    pairs_before, pairs_after : int
        How many pairs of triangles intersect.
    near_before, near_after : int
        How many other pairs are nearer than they have to keep.
    moved_vertices, farthest : int
        How many vertices moved, and the first of those that moved farthest; -1: none.
    displacement, mean_displacement : float
        How far it moved, and the mean of those that moved.
    thickness : float
        How deep the parts were in each other: of the thickest lens (``Detector.find_lenses``); 0: not known.
    start : str
        A name of ``UNTANGLE_STARTS``.
    rounds, steps : int
        Rounds of pushing, and steps of the descent.
    """

    vertices: Any
    clean: bool
    moved: bool
    stopped: bool
    pairs_before: int
    pairs_after: int
    near_before: int
    near_after: int
    moved_vertices: int
    farthest: int
    displacement: float
    mean_displacement: float
    thickness: float
    start: str
    rounds: int
    steps: int

    @classmethod
    def of(cls, found: Any, vertices: Any) -> Untangled:
        """Copies the findings out of the library."""
        farthest = int(found["farthest"])
        return cls(vertices, bool(found["clean"]), bool(found["moved"]), bool(found["stopped"]),
                   int(found["pairs_before"]), int(found["pairs_after"]), int(found["near_before"]),
                   int(found["near_after"]), int(found["moved_vertices"]), -1 if farthest == 2**32 - 1 else farthest,
                   float(found["displacement"]), float(found["mean_displacement"]), float(found["thickness"]),
                   UNTANGLE_STARTS[int(found["start"])], int(found["rounds"]), int(found["steps"]))


class Proximities(Records):
    """Pairs of features that are near each other at one moment, sorted by (kind, a, b).

    Attributes
    ----------
    kind, a, b : (k,) int64
        A code of ``CONTACT_KINDS``, and two features of that kind.
    count, vf_count, ee_count : (k,) int64
        How many pairs of features an item stands for; 1 unless ``unique`` was asked for.
    distance : (k,) float64
        In the unit of the positions.
    vertices, weights : (k, 4) int64 and float64
        As those of ``Contacts``. The gradient of the distance at ``vertices[:, i]`` is ``weights[:, i] * normal``.
    normal : (k, 3) float64
        A unit vector from b's nearest point to a's.
    threshold : (k,) float64
        Of two edges, after ``set_rest``: below it a barrier's energy fades.
    weight : (k,) float64
        Of an item's energy: ``count``, or after ``set_rest`` an area (Li et al. 2023; include/cscd/solver.h).
    separation : (k,) float64
        The distance that the pair has to keep, by its rules.
    u, v : (k,) float64
        Barycentric coordinates of the nearest points, as those of ``Contacts``; they follow from the weights.
    """

    @classmethod
    def record(cls) -> Any:
        return records["proximity"]

    @property
    def u(self) -> Any:
        kind, weights = np.asarray(self["kind"]), np.asarray(self["weights"])
        named = np.where((kind == 1) | (kind == 4), weights[..., 1], 0.0)
        return np.where(kind == 0, -weights[..., 2], named)

    @property
    def v(self) -> Any:
        return np.where(np.asarray(self["kind"]) <= 1, -np.asarray(self["weights"])[..., 3], 0.0)

    def points(self, x: Any) -> Any:
        """(k, 3) float64: the middles between the nearest points, at the positions ``x`` (n, 3) of the list."""
        weights, vertices = np.asarray(self["weights"]), np.asarray(self["vertices"])
        corners = np.asarray(x, dtype=np.float64)[vertices]
        of_a = (np.where(weights > 0.0, weights, 0.0)[..., None] * corners).sum(axis=-2)
        return of_a - 0.5 * np.asarray(self["distance"])[..., None] * np.asarray(self["normal"])


class PairContacts(Records):
    """The contact of each pair of ``pairs_step``: toi (inf without contact), contact, bounded, u, v, point, normal."""

    @classmethod
    def record(cls) -> Any:
        return records["pair_contact"]


class PairDistances(Records):
    """The distance of the features of each pair of ``pairs_near``: distance (inf beyond the limit), u, v, point,
    normal."""

    @classmethod
    def record(cls) -> Any:
        return records["pair_distance"]


class Events(Records):
    """Events, sorted by (first_frame, a, b): what two parts have to do with each other at one place, for some frames.

    Attributes
    ----------
    a, b : (k,) int64
        Parts, a <= b.
    first_frame, last_frame, worst_frame : (k,) int64
    kinds : (k,) int64
        A set of intersection kinds: bit i stands for ``INTERSECTION_KINDS[i]``, and bit 63 says that the parts are two
        copies of one solid in some frame.
    pairs, depths, contacts : (k,) int64
        So many of each, all frames together.
    depth, length : (k,) float64
        The greatest depth and the greatest length of curves, in the unit of the positions; 0 where none is known.
    x : (k, 3) float64
        A place to look at in the worst frame; NaN where only pairs are known.
    triangle, first_triangle : (k,) int64
        The triangle at that place, and the least one of the first frame.
    """

    @classmethod
    def record(cls) -> Any:
        return records["event"]

    def kind_names(self) -> Tuple[Tuple[str, ...], ...]:
        """The names of the kinds of each event; the last is "same_solid" where the parts are two copies of one solid."""
        bits = (*enumerate(INTERSECTION_KINDS), (63, "same_solid"))
        return tuple(tuple(name for i, name in bits if int(kinds) >> i & 1)
                     for kinds in np.atleast_1d(np.asarray(self["kinds"])))

    def worst_first(self) -> Any:
        """Their indices (k,), the worst first, as the tool has them.

        Intersections with another part (crossing, deep or a copy) come before touches, these before contacts alone, and contacts
        of a part with itself without a pair come last; then depth, length, pairs and contacts decide.
        """
        events = {name: np.atleast_1d(np.asarray(self[name]))
                  for name in ("a", "b", "kinds", "pairs", "contacts", "depth", "length")}
        crosses = events["kinds"] & 1 << INTERSECTION_KINDS.index("crossing") != 0
        within = crosses | (events["kinds"] < 0) | (events["depth"] > 0.0)
        rank = np.where(within, 0, np.where(events["pairs"] > 0, 1, 2))
        rank[(events["a"] == events["b"]) & (events["pairs"] == 0) & (events["contacts"] == 0)] = 3
        return np.lexsort([-events[name] for name in ("contacts", "pairs", "length", "depth")] + [rank])


def _weights(found: Any) -> Any:
    """The weights of contacts, which follow from kind, u and v (cscd_stencil_weights)."""
    u, v, kind = found.u, found.v, found.kind
    vf, _, _, vv, ev, vh = (kind == code for code in range(6))
    a_is_vertex, b_is_vertex = vf | vv | vh, vv | ev | vh
    columns = (np.where(a_is_vertex, 1.0, 1.0 - u),
               np.where(vf, u + v - 1.0, np.where(a_is_vertex, -1.0, u)),
               np.where(vf, -u, np.where(a_is_vertex, 0.0, np.where(b_is_vertex, -1.0, v - 1.0))),
               np.where(b_is_vertex, 0.0, -v))
    return np.stack(columns, axis=-1)


def near_form(unique: bool, beyond: bool) -> int:
    """The form of a list of proximities (cscd_near_form)."""
    form: int = VALUES["CSCD_NEAR_UNIQUE" if unique else "CSCD_NEAR_PAIRS"]
    return form | VALUES["CSCD_NEAR_BEYOND"] if beyond else form


def copy_records(found: Any, name: str) -> Any:
    """A copy of the list of such structs that a struct of the library gives out."""
    return copy_items(int(found["items"][0]), int(found["count"][0]), name)

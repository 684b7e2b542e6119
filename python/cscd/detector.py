"""A detector finds the contacts of one mesh, interval by interval, and keeps its trees between them."""

from __future__ import annotations

import copy
from typing import Any, Callable, Dict, Iterable, List, Optional, Tuple

import numpy as np

from ._api import VALUES
from ._arrays import as_faces, as_numbers, count_of, mutable_view, number_of, views_of
from ._host import IN_CONTACT, Handle, Host, new_handle, raise_status
from ._library import address_of, items_of, library, new_struct, structs
from ._options import DetectorOptions, in_python
from .errors import InContact, ListTooLong
from .intersections import Intersections, _Surface, collapsed_of, intersection_options, kind_set
from .lenses import Lenses, Patches
from .line_search import LineSearch
from .live import LiveSettings
from .measures import Measures
from .mesh import Mesh
from .plan import Plan
from .results import RESPONSES, Contacts, Proximities, SafeMotion, Untangled, copy_records, near_form

__all__ = ["Detector"]

Array = Any



class Detector(LiveSettings):
    """Finds the contacts of one mesh.

    Parameters
    ----------
    mesh : Mesh or (m, 3) integers
    plan : Plan, optional
        Makes steps faster; contacts stay the same.
    method : str
        "auto", "none", "single", "kmeans" or "charge" (docs/solver/tuning.md), or one to compare with.
    mode : str
        "all": every contact; "earliest": of each component with itself, the first ones only.
    start : str
        "prove", "vouched" (you say that every start is free of intersections) or "unknown".
    volume : str
        "box" or "kdop14".
    min_separation, tolerance : float
        A length, and a share of it: coming within ``min_separation`` is a contact. 0: touching is.
    step_factor, floor_ratio : float
        See ``max_step``.
    seams : (k, 2) integers, optional
        Pairs of vertices that count as one.
    ignored : (k, 2) integers, optional
        Pairs of triangles that are left out.
    ignore : function (kind, a, b) -> bool, optional
        Leaves out a pair that was found if it returns true.
    rules : sequence of dict, optional
        One for each object, with some of category, mask, thickness, thickness_class, self, obstacle_pairs.
    thickness_matrix : (c, c), optional
        Distances of objects by their thickness_class.
    seam_reach : float, optional
    longest_list : int
        Lists that would be longer raise ``ListTooLong``; 0: any length.
    max_memory : int
        The bytes that the findings of one moment may take in addition to the pairs: curves, depths, sums by parts.
        Findings that do not fit are left out, and raise ``MemoryError`` on access. 0: a quarter of the memory that is free.
    max_work : int
        The comparisons of points with parts of triangles that depths may take at one moment, by an estimate; depths that would
        take more are left out like what does not fit ``max_memory``. 0: 2**28, which take some ten seconds.
    coherence : str
        "auto": steps in which little moves test a list of pairs; "off": each looks at the whole mesh.
    ours : iterable of str
        With the methods "published" and "iccd-published", which lose contacts and are there to compare with: steps that are
        done as "charge" does them, some of motion, starts, representatives, neighbours, tests, boxes (docs/theory/thesis.md).
    threads : int
        0: one per processor.
    progress : function (stage, fraction), optional
        Called every few milliseconds of a long call. An exception that it raises ends the call, which raises it.

    One call at a time has a detector; a call from another thread waits. Ctrl-C ends a long call. Arrays that are given
    back own their memory. Pickling keeps what a detector was made from, but not ``ignore`` and ``progress``.

    A point of one triangle falls through another one:

    >>> x0 = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [.2, .2, 1], [.3, .2, 3], [.2, .3, 3]])
    >>> x1 = x0.copy()
    >>> x1[3:, 2] -= 2
    >>> found = Detector([[0, 1, 2], [3, 4, 5]]).step(x0, x1)
    >>> found.toi.round(6).tolist(), found.vertices.tolist()
    ([0.5], [[3, 0, 1, 2]])
    """

    def __init__(self, mesh: Any, *, plan: Optional[Plan] = None, method: str = "auto", mode: str = "all",
                 start: str = "prove", volume: str = "box", min_separation: float = 0.0, tolerance: float = 0.0,
                 step_factor: float = 0.8, floor_ratio: float = 0.9, seams: Any = None, ignored: Any = None,
                 ignore: Optional[Callable[[str, int, int], bool]] = None, rules: Any = None,
                 thickness_matrix: Any = None, seam_reach: float = 0.0, longest_list: int = 0,
                 max_memory: int = 0, max_work: int = 0, coherence: str = "auto", ours: Iterable[str] = (),
                 threads: int = 1, simd: str = "auto", progress: Optional[Callable[[str, float], Any]] = None,
                 _left_out: Optional[Handle] = None) -> None:
        self._left_out = _left_out  # of a replay; it outlives the detector
        self.mesh: Mesh = mesh if isinstance(mesh, Mesh) else Mesh(as_faces("mesh", mesh))
        self._inputs = dict(plan=plan, method=method, mode=mode, start=start, volume=volume,
                            min_separation=min_separation, tolerance=tolerance, step_factor=step_factor,
                            floor_ratio=floor_ratio, seams=seams, ignored=ignored, rules=rules,
                            thickness_matrix=thickness_matrix, seam_reach=seam_reach, longest_list=longest_list,
                            max_memory=count_of("max_memory", max_memory), max_work=count_of("max_work", max_work),
                            coherence=coherence, ours=tuple(ours), threads=threads, simd=simd)
        if plan is not None and not isinstance(plan, Plan):
            raise ValueError(f"plan: expected a Plan, got {type(plan).__name__}")
        pointer = self.mesh.pointer
        self._vertex_counts = self.mesh.vertex_counts
        self._host = Host(threads, simd, progress, ignore)
        options = DetectorOptions(self.mesh, self._inputs, self._host, ignore is not None, self._left_out)
        for name in ("seams", "ignored", "rules", "thickness_matrix"):  # the caller's may change
            self._inputs[name] = copy.deepcopy(self._inputs[name])
        host = self._host
        with host.lock:
            self._handle: Handle = new_handle(host, library.cscd_detector_destroy, library.cscdpy_detector_create,
                                              pointer, None if plan is None else plan.pointer, options.address)
        self._detector = self._handle.pointer
        self._name = "x"  # what a sentence calls the positions of one moment
        self._lists = {name: new_struct(name) for name in ("contacts", "intersections", "proximities",
                                                           "free_step")}
        self._at = {name: address_of(array) for name, array in self._lists.items()}

    # ---- contacts ---------------------------------------------------------------------------------------

    def step(self, x0: Any, x1: Any) -> Contacts:
        """Finds the contacts while every vertex moves in a straight line from ``x0`` to ``x1``, both (n, 3).

        Every verdict is that of exact arithmetic on the given numbers (docs/solver/guarantees.md).
        """
        start, kept0 = self._views("x0", x0)
        end, kept1 = self._views("x1", x1)
        host = self._host
        with host.lock:
            self._call(host, "contacts", library.cscdpy_detector_step, self._detector, address_of(start),
                       address_of(end), self._at["contacts"])
            found: Contacts = copy_records(self._lists["contacts"], "contact").view(Contacts)
            return found

    def max_step(self, x0: Any, x1: Any, out: Optional[Array] = None) -> Tuple[Array, float, Optional[Contacts]]:
        """Finds how far the vertices may go from ``x0`` towards ``x1`` without any contact, and certifies it.

        Parameters
        ----------
        out : (n, 3) float32 or float64, packed, optional
            Where the positions are written. By default an array of the type of ``x0``.

        Returns
        -------
        x : (n, 3)
            ``x0 + fraction * (x1 - x0)``, rounded. It is the motion to these very numbers that is free of contact.
        fraction : float
            In (0, 1]; at most ``step_factor`` of the way to the contact that limits it.
        limit : Contacts or None
            That contact (one item); None if the whole way is free.

        Raises
        ------
        InContact
            Two features touch at ``x0``.
        """
        start, kept0 = self._views("x0", x0)
        end, kept1 = self._views("x1", x1)
        reached = self._positions_for("out", out, kept0)
        target = mutable_view(reached)
        host = self._host
        with host.lock:
            self._call(host, "free_step", library.cscdpy_detector_max_step, self._detector, address_of(start),
                       address_of(end), address_of(target), self._at["free_step"])
            return free_step_of(self._lists["free_step"], reached)

    # ---- one moment -------------------------------------------------------------------------------------

    def check(self, x: Any) -> Array:
        """The pairs of triangles that intersect or touch at positions ``x``: (k, 2) int64, sorted."""
        options = self._find_options(kind_set(None), 0, False, False, False)
        views, kept = self._views("x", x)
        host = self._host
        with host.lock:
            self._find(host, views, options)
            found = copy_records(self._lists["intersections"], "intersection")
        return np.stack([found["a"], found["b"]], axis=1).astype(np.int64)

    def find_intersections(self, x: Any, kinds: Any = None, stop_after: int = 0) -> Intersections:
        """The pairs of triangles that intersect or touch at positions ``x``, with their kinds.

        Parameters
        ----------
        kinds : str or iterable of str, optional
            The kinds that count, of ``INTERSECTION_KINDS``; None: all.
        stop_after : int
            Ends the search at this number of pairs; 0: never.
        """
        kind_bits = kind_set(kinds)
        options = self._find_options(kind_bits, count_of("stop_after", stop_after), False, False, False)
        views, kept = self._views("x", x)
        host = self._host
        with host.lock:
            self._find(host, views, options)
            pairs = copy_records(self._lists["intersections"], "intersection")
            stopped = bool(self._lists["intersections"]["stopped"][0])
            collapsed = collapsed_of(self._lists["intersections"])
        found = Intersections(self.mesh, self, [array.copy() for array in kept], pairs, stopped,
                              kinds is None and stop_after == 0)
        found.collapsed = collapsed
        return found

    def is_intersecting(self, x: Any, kinds: Any = None) -> bool:
        """Whether there is any pair of these kinds at positions ``x``; the search ends at the first one."""
        options = self._find_options(kind_set(kinds), 0, True, False, False)
        views, kept = self._views("x", x)
        host = self._host
        with host.lock:
            self._find(host, views, options)
            return bool(self._lists["intersections"]["count"][0])

    def overlap_volumes(self, x: Any) -> Any:
        """The volumes that bodies have in common at positions ``x``, and how they change with every vertex.

        They are ``Measures``; of a batch, an array (b, n, 3), a list of b of them. Of a body with itself it is the integral
        of (winding number - 1) where that is above 1. Values are NaN where an open surface is in a body or crosses one.
        Bodies are parts that are closed by themselves, or objects (``set_parts``).
        """
        return self._measures(library.cscdpy_detector_overlap_volumes, x)

    def curve_lengths(self, x: Any) -> Any:
        """The lengths of the intersection curves of bodies, open ones, too, at positions ``x``, and how they change.

        They are ``Measures``; of a batch, an array (b, n, 3), a list of b of them.
        """
        return self._measures(library.cscdpy_detector_curve_lengths, x)

    def _measures(self, function: Any, x: Any) -> Any:
        if isinstance(x, np.ndarray) and x.ndim == 3:
            return [self._measures(function, one) for one in x]
        options = self._find_options(2**64 - 1, 0, False, False, False)
        views, kept = self._views("x", x)
        found = new_struct("measures")
        host = self._host
        with host.lock:
            host.call(function, self._detector, address_of(views), address_of(options), address_of(found))
            return Measures(found, self.mesh.vertex_count)

    def _surface_answers(self, positions: Any, parts: bool = False) -> _Surface:
        """Curves and depths, or sums by parts, of which they are a part, of positions that were looked at before."""
        options = self._find_options(2**64 - 1, 0, False, True, parts)
        views, kept = self._views("x", positions if len(positions) > 1 else positions[0])
        host = self._host
        with host.lock:
            self._find(host, views, options)
            return _Surface(self._lists["intersections"], self.mesh.vertex_count, not parts, parts)

    def _patches(self, positions: Any) -> Patches:
        """Patches and cut-offs of positions that were looked at before."""
        options = self._find_options(2**64 - 1, 0, False, False, False)
        options["patches"] = options["cut_offs"] = True
        views, kept = self._views("x", positions if len(positions) > 1 else positions[0])
        host = self._host
        with host.lock:
            self._find(host, views, options)
            found, mesh = self._lists["intersections"], self.mesh
            _Surface(found, mesh.vertex_count, False, False).check_patches()
            return Patches(found, mesh.vertex_count, mesh.triangle_count, mesh.component_count)

    def find_lenses(self, x: Any, part_bodies: bool = False) -> Lenses:
        """Which points of surfaces are on the wrong side at positions ``x``, where on the other sheet each belongs, in which
        direction, and how far: the depth between two limbs, or of a fold.

        Parameters
        ----------
        part_bodies : bool
            Parts (``set_parts``) that are closed by themselves are bodies of their own. By default objects are the bodies,
            as in ``untangle``, whose thickness is that of the thickest lens.

        The tip of a box is in another one:

        >>> corners = np.array([[v & 1, v >> 1 & 1, v >> 2] for v in range(8)])
        >>> box = np.array([[0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6], [0, 1, 5], [0, 5, 4],
        ...                 [2, 6, 7], [2, 7, 3], [0, 4, 6], [0, 6, 2], [1, 3, 7], [1, 7, 5]])
        >>> x = np.concatenate([corners, 0.4 * corners + [0.9, 0.55, 0.1]])
        >>> lenses = Detector(np.concatenate([box, box + 8])).find_lenses(x)
        >>> lenses.reason_names(), lenses.points_of(0).vertex.tolist(), round(lenses.thickness, 12)
        (['buried'], [8, 10, 12, 14], 0.1)
        """
        options = self._find_options(2**64 - 1, 0, False, False, False)
        options["part_bodies"] = part_bodies
        views, kept = self._views("x", x)
        found = new_struct("lenses")
        host = self._host
        with host.lock:
            host.call(library.cscdpy_detector_find_lenses, self._detector, address_of(views), address_of(options),
                      address_of(found))
            return Lenses(found)

    def near(self, x: Any, distance: float, unique: bool = False, beyond: bool = False) -> Proximities:
        """Every pair of features whose distance at positions ``x`` is at most ``distance``, a length above 0.

        Parameters
        ----------
        unique : bool
            Pairs with the same nearest vertices, or edge and vertex, are one item with a ``count``, so that the sum of
            ``count * energy(distance)`` is that over all pairs (include/cscd/solver.h).
        beyond : bool
            The distance counts beyond what each pair has to keep (``separation``), so that an energy of the difference has all
            its pairs, whatever the thickness of their objects.
        """
        views, kept = self._views("x", x)
        host = self._host
        with host.lock:
            self._call(host, "proximities", library.cscdpy_detector_find_near, self._detector, address_of(views),
                       number_of("distance", distance), near_form(unique, beyond),
                       self._at["proximities"])
            found: Proximities = copy_records(self._lists["proximities"], "proximity").view(Proximities)
            return found

    def bounds(self, x: Any, search_radius: float) -> Array:
        """(n,) float64: how far each vertex may go from ``x``, on any path, so that all that is apart stays apart.

        Offset Geometric Contact (Chen et al. 2025); docs/theory/displacement-bounds.md has the proof. Vertices farther
        than ``search_radius`` from everything have half of it.
        """
        views, kept = self._views("x", x)
        bounds = np.empty(self.mesh.vertex_count)
        out = new_struct("displacement_bounds")
        host = self._host
        with host.lock:
            host.call(library.cscdpy_detector_displacement_bounds, self._detector, address_of(views),
                      number_of("search_radius", search_radius), 0, address_of(bounds), bounds.nbytes, address_of(out))
        return bounds

    def truncate(self, x0: Any, x1: Any, search_radius: float, out: Optional[Array] = None) -> Tuple[Array, Any]:
        """Lets every vertex go from ``x0`` towards ``x1`` as far as planes between near pairs allow.

        Divide and Truncate (Chen et al. 2026). Returns the positions, and a record of ``cscd_truncation``: fraction,
        obstacle_fraction, near_count, moved, shortened.
        """
        start, kept0 = self._views("x0", x0)
        end, kept1 = self._views("x1", x1)
        reached = self._positions_for("out", out, kept0)
        target = mutable_view(reached)
        found = new_struct("truncation")
        host = self._host
        with host.lock:
            host.call(library.cscdpy_detector_truncate, self._detector, address_of(start), address_of(end),
                      number_of("search_radius", search_radius), address_of(target), address_of(found))
        names = ["fraction", "obstacle_fraction", "near_count", "moved", "shortened"]
        return reached, found[names].view(np.recarray)[0]

    def make_safe(self, x0: Any, x1: Any, inverse_masses: Any = None, friction: Any = None,
                  out: Optional[Array] = None) -> Tuple[Array, SafeMotion]:
        """Finds a motion near the one from ``x0`` to ``x1`` that is certified free of contact and goes on moving.

        Contacts stop what approaches, by impulses that keep momentum, with Coulomb friction; planes shorten the motions
        of what this leaves (include/cscd/solver.h). Returns the positions, and what it took.

        Parameters
        ----------
        inverse_masses : (n,) floats, optional
            0: no impulse moves the vertex, nor any obstacle. 1 each by default.
        friction : (object_count,) floats or a number, optional
            Coulomb's coefficient of each object; two objects have the geometric mean.

        A point of one triangle falls onto another one, which is too heavy to move:

        >>> x0 = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [.2, .2, 1], [.3, .2, 3], [.2, .3, 3]])
        >>> x1 = x0.copy()
        >>> x1[3:, 2] -= 2
        >>> x, safe = Detector([[0, 1, 2], [3, 4, 5]], min_separation=0.01).make_safe(x0, x1, [0, 0, 0, 1, 1, 1])
        >>> x[3:, 2].round(3).tolist(), [RESPONSES[i] for i in safe.responses]
        ([0.015, 1.0, 1.0], ['free', 'free', 'free', 'stopped', 'free', 'free'])
        """
        start, kept0 = self._views("x0", x0)
        end, kept1 = self._views("x1", x1)
        reached = self._positions_for("out", out, kept0)
        target = mutable_view(reached)
        options = new_struct("response_options")
        library.cscd_response_defaults_sized(address_of(options), options.nbytes)
        kept = [as_numbers("inverse_masses", inverse_masses, self.mesh.vertex_count),
                as_numbers("friction", friction, self.mesh.object_count)]
        for name, numbers in zip(("inverse_masses", "friction"), kept):
            options[name] = 0 if numbers is None else address_of(numbers)
        found = new_struct("safe_motion")
        host = self._host
        with host.lock:
            host.call(library.cscdpy_detector_make_safe, self._detector, address_of(start), address_of(end),
                      address_of(options), address_of(target), address_of(found))
            return reached, SafeMotion.of(found[0], self.mesh.vertex_count)

    def untangle(self, x: Any, *, start: Any = None, start_input: Any = None, steady: float = 0.0, weights: Any = None,
                 spread: float = 0.0, rest: Any = None, bending: float = 0.0, max_seconds: float = np.inf,
                 max_rounds: int = 60, max_steps: int = 40, out: Optional[Array] = None) -> Untangled:
        """Finds positions near ``x`` at which nothing intersects; the result is never worse (include/cscd/untangle.h).

        Parameters
        ----------
        start : (n, 3), optional
            Clean positions to start from, as those of the frame before; the result is then always clean.
        start_input : (n, 3), optional
            The positions that ``start`` was the result for, and ``steady`` in [0, 1) says how far its displacement goes on.
        weights : (n,) floats, optional
            How strongly each vertex is drawn to ``x``; above 0, and ``inf`` pins it. 1 each by default.
        spread : float
            The length over which displacements are spread; 0: about twice the thickness of what intersects.
        rest : (n, 3), optional
            A shape without intersections: near what intersects, edges are drawn to the lengths and angles that they have there.
        bending : float
            The length over which displacements bend smoothly, at about three times the cost; 0: they may have edges.
        max_seconds : float
            Then the call ends with the best so far.
        max_rounds, max_steps : int
            Rounds of pushing, and steps of the descent, for each start that is tried.
        out : (n, 3) float32 or float64, packed, optional
            Where the positions are written. By default an array of the type of ``x``.
        """
        views, kept = self._views("x", x)
        reached = self._positions_for("out", out, kept)
        target = mutable_view(reached)
        options = new_struct("untangle_options")
        library.cscd_untangle_defaults_sized(address_of(options), options.nbytes)
        numbers = as_numbers("weights", weights, self.mesh.vertex_count)
        given = [self._views(name, value) if value is not None else None
                 for name, value in (("start", start), ("start_input", start_input), ("rest", rest))]
        options["weights"] = 0 if numbers is None else address_of(numbers)
        for name, one in zip(("start", "start_input", "rest"), given):
            options[name] = 0 if one is None else address_of(one[0])
        for name, length in (("steady", steady), ("spread", spread), ("bending", bending)):
            options[name] = number_of(name, length)
        options["max_seconds"] = max_seconds
        options["max_rounds"] = count_of("max_rounds", max_rounds, 2**32 - 1)
        options["max_steps"] = count_of("max_steps", max_steps, 2**32 - 1)
        found = new_struct("untangled")
        host = self._host
        with host.lock:
            host.call(library.cscdpy_detector_untangle, self._detector, address_of(views), address_of(options),
                      address_of(target), address_of(found))
        return Untangled.of(found[0], reached)

    def line_search(self, x0: Any, x1: Any, reach: float = 0.0) -> LineSearch:
        """One motion for many questions; ``reach``: the largest distance for which ``near`` is called."""
        return LineSearch(self, x0, x1, reach)

    # ---- while a call runs ----------------------------------------------------------------------------------

    def cancel(self) -> None:
        """Ends a call that is running in another thread, which then raises ``Cancelled``."""
        self._host.cancel()

    # ---- what the last step was like ----------------------------------------------------------------------

    def guarantee(self, component: int = 0) -> Dict[str, Any]:
        """The promises of the last step for the contacts of a component with itself: complete, start_embedded, reason."""
        if not 0 <= component < self.mesh.component_count:
            raise IndexError(f"component {component}: the mesh has {self.mesh.component_count}")
        found = self._read("guarantee", library.cscdpy_detector_guarantee, component)
        found["reason"] = library.cscd_name(VALUES["CSCD_REASONS"], found["reason"]).decode()
        return found

    def collapsed(self) -> List[int]:
        """The components that were collapsed in the last check, or at an end of the last step: hidden by a scale of 0, say,
        so that all their triangles had no area. There they intersect nothing, and are not looked at with each other."""
        with self._host.lock:
            return [c for c in range(self.mesh.component_count) if library.cscd_detector_collapsed(self._detector, c)]

    @property
    def timings(self) -> Dict[str, float]:
        """Milliseconds of each stage of the last step, by the members of ``cscd_timings``."""
        return self._read("timings", library.cscdpy_detector_timings)

    @property
    def counters(self) -> Dict[str, int]:
        """The work of the last step, by the members of ``cscd_counters``: the same for any number of threads."""
        return self._read("counters", library.cscdpy_detector_counters)

    @property
    def live_bytes(self) -> int:
        """The bytes that the detector holds in the library."""
        return self._host.live_bytes()

    # ---- inside -----------------------------------------------------------------------------------------

    def _views(self, name: str, positions: Any) -> Tuple[Array, Any]:
        return views_of(name, positions, self._vertex_counts)

    def _call(self, host: Host, kind: str, function: Any, *arguments: Any) -> None:
        host.check()
        status = function(host.handle, *arguments)
        if status:
            self._fail(status, in_python(host.detail(), self._name), kind)

    def _fail(self, status: int, sentence: str, kind: str) -> None:
        if status == IN_CONTACT:
            raise InContact(sentence, items_of(self._lists[kind]["limit"], "contact").view(Contacts))
        try:
            raise_status(status, sentence)
        except ListTooLong as problem:
            problem.count = int(self._lists[kind]["count"][0])
            raise

    def _find(self, host: Host, views: Array, options: Array) -> None:
        self._call(host, "intersections", library.cscdpy_detector_find_intersections, self._detector,
                   address_of(views), address_of(options), self._at["intersections"])

    def _find_options(self, kinds: int, stop_after: int, any_alone: bool, depths: bool, parts: bool) -> Array:
        limits = self._inputs["max_memory"], self._inputs["max_work"]
        return intersection_options(kinds, stop_after, any_alone, depths, parts, limits)

    def _positions_for(self, name: str, out: Optional[Array], kept: Any) -> Array:
        """The view into which positions are written."""
        shape = (self.mesh.vertex_count, 3)
        if out is None:
            single = all(array.itemsize == 4 for array in kept)
            return np.empty(shape, np.float32 if single else np.float64)
        if not isinstance(out, np.ndarray) or out.shape != shape or out.dtype not in (np.float32, np.float64) \
                or not out.flags.c_contiguous or not out.flags.writeable:
            raise ValueError(f"{name}: expected a packed, writable array {shape} of float32 or float64")
        return out

    def _called(self, name: str) -> Detector:
        """The same detector, whose positions have another name in sentences."""
        self._name = name
        return self

    def _read(self, name: str, function: Any, *arguments: Any) -> Dict[str, Any]:
        found = new_struct(name)
        with self._host.lock:
            function(self._detector, *arguments, address_of(found))
        return {member: found[member][0].item() for member in structs[name].names}

    def __repr__(self) -> str:
        return f"Detector({self.mesh!r}, method {self._inputs['method']!r})"

    def __reduce__(self) -> Tuple[Callable[..., Any], Tuple[Any, ...]]:
        return _restore, (self.mesh, self._inputs)


def free_step_of(step: Array, reached: Array) -> Tuple[Array, float, Optional[Contacts]]:
    """The results of ``max_step`` from the struct of the library."""
    limited = bool(step["limited"][0])
    return reached, float(step["fraction"][0]), items_of(step["limit"], "contact").view(Contacts) if limited else None


def _restore(mesh: Mesh, inputs: Dict[str, Any]) -> Detector:
    """Called by pickle."""
    return Detector(mesh, **inputs)

"""Plans: how a mesh is cut into regions, once, so that steps are faster. Contacts are the same with any plan."""

from __future__ import annotations

import ctypes
import os
import warnings
from typing import Any, Callable, Dict, Iterable, List, NamedTuple, Optional, Tuple, Union

import numpy as np

from ._api import VALUES
from ._arrays import as_floats, as_indices, as_positions, check_magnitudes, count_of, number_of, views_of
from ._host import PLAN_STEPS, Handle, Host, code_of, new_handle, ours_of
from ._library import address_of, copy_list, items_of, library, new_struct, structs
from .errors import Error
from .mesh import Mesh, read_surface

__all__ = ["ComparedPlan", "Plan"]

Array = Any
_SOLVERS = {"tree": 0, "dense": 1, "coarse": 2}


class ComparedPlan(NamedTuple):
    """A plan that ``Plan.auto`` has compared with others."""

    method: str
    k: Optional[int]
    """The number of regions that k-means was called with."""
    region_count: int
    tested_share: float
    """Predicted: the share of the triangles that a step has to look at with others of their component."""
    kept: bool
    failure: Optional[str]
    """Why there is no plan by charge; None: there is."""


def _compared(row: Any) -> ComparedPlan:
    failure = ctypes.c_char_p(int(row["failure"])).value
    return ComparedPlan(str(library.cscd_name(VALUES["CSCD_METHODS"], int(row["method"])).decode()), int(row["k"]) or None,
                        int(row["region_count"]), float(row["tested_share"]), bool(row["kept"]),
                        failure.decode() if failure is not None else None)


class Plan:
    """The regions of a mesh and their detector points.

    Made by ``Plan.charge``, ``Plan.kmeans``, ``Plan.auto``, ``Plan.published``, ``Plan.read`` or ``Plan.from_parts``.

    Attributes
    ----------
    mesh : Mesh
    method : str
        "charge", "kmeans", "single" or "published".
    origin : str or None
        Method, solver, thresholds, frames and version, as words; None: the plan is of parts that say nothing.
    region_count : int
    triangle_regions : (t,) int64
    detector_points : (r, 3) float64
        Inside each region, at rest.
    charges : (t,) float64 or None
        Charge densities of triangles, in Gaussian units.
    charge_kernels, better_kernels : str or None
        See there.
    """

    mesh: Mesh
    rest: Array
    _handle: Handle

    @classmethod
    def charge(cls, mesh: Mesh, V: Any, *, threshold: float = 0.1, solver: str = "tree", memory_limit: int = 0,
               stiffness: Any = None, frames: Any = None, threads: int = 0,
               progress: Optional[Callable[[str, float], Any]] = None) -> Plan:
        """Cuts a mesh by its charge density (docs/theory/charge.md; Yeh 2012).

        Parameters
        ----------
        V : (n, 3)
            The mesh at rest.
        threshold : float
            The share of the triangles, those of least density, along which cuts run; in (0, 1).
        solver : str
            "tree": iterations of a treecode, densities within 1e-3. "coarse": half the iterations, within some percent.
            "dense": exactly, by LAPACK, with 8 bytes for each pair of triangles and time with the cube of their number.
        memory_limit : int
            Bytes that the solution may take; 0: what the system has.
        stiffness : (t,) float64, optional
            The stiffness of the material at each triangle, positive and finite, in any unit: borders of regions run in soft
            places, and a part beyond a soft place is given a detector point of its own.
        frames : (f, n, 3) or a list of (n, 3), optional
            Positions in a motion that the plan is made for: the sight of the detector points in them counts as well. If
            there are many, some count, evenly spaced.

        Warns
        -----
        RuntimeWarning
            ``solver`` is "dense", and OpenBLAS runs kernels that are slow on this processor; ``better_kernels`` names others.

        Raises
        ------
        Error
            ``solver`` is "dense", and libcscd-baselines.so is missing, which wheels do not have; the text says how to get it.
        """
        if not isinstance(solver, str) or solver not in _SOLVERS:
            raise ValueError(f"solver: expected one of {', '.join(_SOLVERS)}; got {solver!r}")
        kept, members = cls._motion(mesh, stiffness, frames)
        plan = cls._create(mesh, V, threads, progress, method=code_of("method", "charge"), threshold=threshold,
                           charge_solver=_SOLVERS[solver], memory_limit=memory_limit, **members)
        del kept
        better = plan.better_kernels
        if better is not None:
            warnings.warn(f"OpenBLAS ran its kernels for {plan.charge_kernels}, which are slow on this processor: with "
                          f"OPENBLAS_CORETYPE={better} in the environment of Python, from its start, a dense solution takes "
                          "about a third of the time", RuntimeWarning, stacklevel=2)
        return plan

    @classmethod
    def kmeans(cls, mesh: Mesh, V: Any, k: int = 4, *, seed: int = 1, threads: int = 0,
               progress: Optional[Callable[[str, float], Any]] = None) -> Plan:
        """Cuts a mesh into ``k`` regions by k-means of its triangles."""
        return cls._create(mesh, V, threads, progress, method=code_of("method", "kmeans"), k=k, seed=seed)

    @classmethod
    def published(cls, mesh: Mesh, V: Any, *, threshold: float = 0.1, growing: float = 1 / 400, ours: Iterable[str] = (),
                  threads: int = 0, progress: Optional[Callable[[str, float], Any]] = None) -> Plan:
        """Cuts a mesh as published (Yeh 2012, chapter 3), to compare with: docs/theory/thesis.md.

        Parameters
        ----------
        V : (n, 3)
            The mesh at rest.
        threshold : float
            Triangles whose equalized density is below it form clusters; in (0, 1).
        growing : float
            Clusters with more than this share of their component's triangles grow; in [0, 1].
        ours : iterable of str
            Steps that are done as ``Plan.charge`` does them: "charge", "ranks", "cuts", "points".

        Raises
        ------
        Error
            ``ours`` has no "charge", and this installation is built without LAPACK, as wheels are.
        """
        return cls._create(mesh, V, threads, progress, method=code_of("method", "published"), threshold=threshold,
                           growing=growing, ours=ours_of(ours, PLAN_STEPS))

    @classmethod
    def auto(cls, mesh: Mesh, V: Any, *, stiffness: Any = None, frames: Any = None, threads: int = 0,
             progress: Optional[Callable[[str, float], Any]] = None) -> Plan:
        """The plan by charge, by one region for each component or by k-means that leaves the least to test, as predicted at
        rest and in the frames, beyond soft places, too; ``compared`` lists them. The other parameters are those of ``charge``."""
        kept, members = cls._motion(mesh, stiffness, frames)
        plan = cls._create(mesh, V, threads, progress, method=code_of("method", "auto"), **members)
        del kept
        return plan

    @classmethod
    def from_parts(cls, mesh: Mesh, V: Any, triangle_regions: Any, detector_points: Any, *, method: str = "single",
                   charges: Any = None, capacitances: Any = None, origin: Optional[str] = None) -> Plan:
        """A plan from what another one, or another program, consists of; origin: up to 255 characters of ASCII that say how
        it was made."""
        parts = new_struct("plan_parts")
        arrays: Dict[str, Array] = {}
        for name, values in (("detector_points", detector_points), ("charges", charges), ("capacitances", capacitances)):
            if values is not None:
                arrays[name] = np.ascontiguousarray(as_floats(name, values, "an array of numbers"), np.float64)
        if arrays["detector_points"].ndim != 2:
            raise ValueError(f"detector_points: expected shape (r, 3), got {arrays['detector_points'].shape}")
        arrays["triangle_regions"] = as_indices("triangle_regions", triangle_regions, 1, len(arrays["detector_points"]),
                                                "regions")
        cls._check_parts(mesh, arrays)
        parts["method"] = code_of("method", method)
        parts["region_count"] = len(arrays["detector_points"])
        for name, array in arrays.items():
            parts[name] = address_of(array)
        words = ctypes.create_string_buffer(origin.encode()) if origin is not None else None
        parts["origin"] = ctypes.addressof(words) if words is not None else 0
        return cls._made(mesh, V, Host(), library.cscdpy_plan_create_from_parts, parts)

    @classmethod
    def read(cls, path: Union[str, os.PathLike[str]], mesh: Optional[Mesh] = None) -> Plan:
        """Reads a plan that ``write``, or ``cscd preprocess``, has written: bit for bit, and with charge everywhere.

        Parameters
        ----------
        mesh : Mesh, optional
            That of the detector. By default the one in the file.

        Raises
        ------
        ValueError
            The file is no plan, or one of another mesh.
        """
        triangles, rest = read_surface(path)
        plan = cls.__new__(cls)
        plan.mesh = mesh if mesh is not None else Mesh(triangles, len(rest))
        plan.rest = rest
        error = ctypes.create_string_buffer(1024)
        pointer = plan.mesh.pointer
        host = plan.mesh.host
        with host.lock:
            handle = Handle(host, library.cscd_plan_destroy)
            if not library.cscdpy_plan_read(os.fsencode(path), pointer, handle.place, ctypes.addressof(error)):
                raise ValueError(error.value.decode(errors="replace"))
            plan._handle = handle
        return plan

    def write(self, path: Union[str, os.PathLike[str]]) -> None:
        """Writes the plan as a PLY file that any viewer shows (docs/artist/formats.md); an older file is replaced at once."""
        error = ctypes.create_string_buffer(1024)
        if not library.cscdpy_plan_write(os.fsencode(path), self.mesh.pointer, address_of(self.rest), self.pointer,
                                         ctypes.addressof(error)):
            raise OSError(error.value.decode(errors="replace"))

    @staticmethod
    def _stiffness(mesh: Mesh, stiffness: Any) -> Array:
        values = as_floats("stiffness", stiffness, "an array of numbers")
        if values.shape != (mesh.triangle_count,):
            raise ValueError(f"stiffness: expected shape {(mesh.triangle_count,)}, got {values.shape}")
        return np.ascontiguousarray(values, np.float64)

    @staticmethod
    def _frames(mesh: Mesh, frames: Any) -> List[Array]:
        """The addresses of views, first, and what keeps them alive."""
        if not isinstance(frames, (list, tuple, np.ndarray)):
            raise ValueError(f"frames: expected an array (f, n, 3) or a list of arrays (n, 3), got {type(frames).__name__}")
        count = sum(mesh.vertex_counts)
        packed = [np.ascontiguousarray(as_positions(f"frames[{i}]", frame, count)) for i, frame in enumerate(frames)]
        views = [views_of("frames", frame, mesh.vertex_counts)[0] for frame in packed]
        return [np.array([address_of(view) for view in views], np.uintp), *views, *packed]

    @classmethod
    def _motion(cls, mesh: Mesh, stiffness: Any, frames: Any) -> Tuple[List[Array], Dict[str, int]]:
        """Arrays that must live as long as the call, and the members of the options that point to them."""
        if not isinstance(mesh, Mesh):
            raise ValueError(f"mesh: expected a Mesh, got {type(mesh).__name__}")
        kept: List[Array] = []
        members: Dict[str, int] = {}
        if stiffness is not None:
            kept.append(cls._stiffness(mesh, stiffness))
            members["stiffness"] = address_of(kept[0])
        if frames is not None:
            arrays = cls._frames(mesh, frames)
            members["frames"], members["frame_count"] = address_of(arrays[0]), len(arrays[0])
            kept += arrays
        return kept, members

    @staticmethod
    def _check_parts(mesh: Mesh, arrays: Dict[str, Array]) -> None:
        expected = {"triangle_regions": (mesh.triangle_count,), "charges": (mesh.triangle_count,),
                    "detector_points": (len(arrays["detector_points"]), 3), "capacitances": (mesh.component_count,)}
        for name, array in arrays.items():
            if array.shape != expected[name]:
                raise ValueError(f"{name}: expected shape {expected[name]}, got {array.shape}")

    @classmethod
    def _create(cls, mesh: Mesh, V: Any, threads: int, progress: Any, **members: Any) -> Plan:
        options = new_struct("plan_options")
        library.cscd_plan_defaults_sized(address_of(options), options.nbytes)
        for name, value in members.items():
            if name in ("threshold", "growing"):
                options[name] = number_of(name, value)
            else:
                options[name] = count_of(name, value, int(np.iinfo(structs["plan_options"][name]).max))
        try:
            return cls._made(mesh, V, Host(threads, progress=progress), library.cscdpy_plan_create, options)
        except Error as problem:
            if "libcscd-baselines" not in str(problem):
                raise
            raise Error(f"{problem}\nWheels of cscd do not have libcscd-baselines.so. Take solver=\"tree\", "
                        "or install it from its sources on a machine with LAPACKE, OpenBLAS and GSL (Debian: "
                        "liblapacke-dev, libopenblas-dev, libgsl-dev), by `pip install .` there") from None

    @classmethod
    def _made(cls, mesh: Mesh, V: Any, host: Host, create: Any, options: Array) -> Plan:
        plan = cls.__new__(cls)
        if not isinstance(mesh, Mesh):
            raise ValueError(f"mesh: expected a Mesh, got {type(mesh).__name__}")
        views, kept = views_of("V", V, mesh.vertex_counts)
        for part in kept:
            check_magnitudes("V", part)
        plan.mesh = mesh
        with host.lock:
            plan._handle = new_handle(host, library.cscd_plan_destroy, create, mesh.pointer, address_of(views),
                                      address_of(options))
        plan.rest = np.concatenate([as_positions("V", part).astype(np.float64) for part in kept])
        return plan

    @property
    def pointer(self) -> int:
        """The plan of the library, for the detectors that use it."""
        return self._handle.pointer

    @property
    def method(self) -> str:
        return str(library.cscd_name(VALUES["CSCD_METHODS"], self._info("method")).decode())

    @property
    def region_count(self) -> int:
        return self._info("region_count")

    @property
    def triangle_regions(self) -> Array:
        labels = library.cscd_plan_triangle_regions(self.pointer)
        return copy_list(labels, self.mesh.triangle_count, np.uint32).astype(np.int64)

    @property
    def regions(self) -> Any:
        """The regions, by the members of ``cscd_region``: component, triangle_count, area, visible_share,
        detector_point."""
        found = new_struct("region", self.region_count)
        size = structs["region"].itemsize
        for i in range(len(found)):
            library.cscdpy_plan_region(self.pointer, i, address_of(found) + i * size)
        return items_of(found, "region").view(np.recarray)

    @property
    def detector_points(self) -> Array:
        return self.regions["detector_point"].copy()

    @property
    def charges(self) -> Optional[Array]:
        if self.method not in ("charge", "published"):
            return None
        return np.array([library.cscd_plan_triangle_charge(self.pointer, t) for t in range(self.mesh.triangle_count)])

    @property
    def capacitances(self) -> Optional[Array]:
        """(c,) float64: the capacitance of each component, a length in Gaussian units; None without charge."""
        if self.method not in ("charge", "published"):
            return None
        return np.array([library.cscd_plan_capacitance(self.pointer, c) for c in range(self.mesh.component_count)])

    @property
    def compared(self) -> List[ComparedPlan]:
        """The plans that ``Plan.auto`` has compared, in the order in which it tried them; empty for any other plan."""
        found = new_struct("compared_plan", self._info("compared_count"))
        size = structs["compared_plan"].itemsize
        for i in range(len(found)):
            library.cscdpy_plan_compared(self.pointer, i, address_of(found) + i * size)
        return [_compared(row) for row in found]

    @property
    def charge_kernels(self) -> Optional[str]:
        """The kernels with which OpenBLAS solved the charge system, by its own name, such as "SkylakeX". None: the plan is
        not made in this process by ``Plan.charge`` with ``solver="dense"``, or the BLAS is another one."""
        return self._words("charge_kernels")

    @property
    def better_kernels(self) -> Optional[str]:
        """The value that ``OPENBLAS_CORETYPE`` should have before Python starts, because OpenBLAS did not know the processor and
        took old kernels, which take about three times as long. None: the kernels will do, or are not known."""
        return self._words("better_kernels")

    @property
    def origin(self) -> Optional[str]:
        return self._words("origin")

    def _info(self, member: str) -> int:
        found = new_struct("plan_info")
        library.cscdpy_plan_describe(self.pointer, address_of(found))
        return int(found[member][0])

    def _words(self, member: str) -> Optional[str]:
        name = ctypes.c_char_p(self._info(member)).value
        return name.decode() if name is not None else None

    def __repr__(self) -> str:
        return f"Plan(method {self.method!r}, {self.region_count} regions)"

    def __reduce__(self) -> Tuple[Callable[..., Any], Tuple[Any, ...]]:
        return _restore, (self.mesh, self.rest, self.triangle_regions, self.detector_points, self.method, self.charges,
                          self.capacitances, self.origin)


def _restore(mesh: Mesh, rest: Array, *parts: Any) -> Plan:
    """Called by pickle."""
    regions, points, method, charges, capacitances, origin = parts
    return Plan.from_parts(mesh, rest, regions, points, method=method, charges=charges, capacitances=capacitances,
                           origin=origin)


"""Meshes: the triangles of one object or of a scene of several, which never change."""

from __future__ import annotations

import ctypes
import os
from typing import Any, Callable, Dict, List, Optional, Sequence, Tuple, Union

import numpy as np

from ._api import VALUES
from ._arrays import as_faces, as_floats, as_indices, as_positions, check_magnitudes, count_of
from ._host import Handle, Host, Keeper, new_handle
from ._library import address_of, copy_list, items_of, library, new_struct, structs

__all__ = ["HalfSpace", "Mesh", "Points", "Scene", "Wires"]

Array = Any

_TRIANGLES, _WIRES, _POINTS, _HALF_SPACE = 0, 1, 2, 3
_MOST_CORNERS = 2**31 - 1
_MOST_VERTICES = 2**32 - 2


def cut_polygons(positions: Array, corners: Array, face_sizes: Array) -> Tuple[Array, Array]:
    """Cuts faces into triangles by their shape, as faces of files are cut; returns these and the face of each."""
    keeper, error = Keeper(None, library.cscdpy_polygons_free), ctypes.create_string_buffer(1024)
    packed = np.ascontiguousarray(positions, np.float64)
    if not library.cscdpy_polygons_cut(address_of(packed), len(packed), address_of(corners), address_of(face_sizes),
                                       len(face_sizes), keeper.place, ctypes.addressof(error)):
        raise ValueError(error.value.decode())
    out = keeper.pointer
    count = library.cscdpy_polygons_count(out)
    triangles, faces = np.empty((count, 3), np.uint32), np.empty(count, np.uint32)
    library.cscdpy_polygons_copy(out, address_of(triangles), address_of(faces))
    return triangles, faces


def read_surface(path: Union[str, os.PathLike[str]]) -> Tuple[Array, Array]:
    """The triangles and the positions of a mesh file."""
    os.stat(path)  # a missing file is Python's own error
    keeper, error = Keeper(None, library.cscdpy_polygons_free), ctypes.create_string_buffer(1024)
    if not library.cscdpy_mesh_read(os.fsencode(path), keeper.place, ctypes.addressof(error)):
        raise ValueError(error.value.decode(errors="replace"))
    out = keeper.pointer
    count = library.cscdpy_polygons_count(out)
    triangles, faces = np.empty((count, 3), np.uint32), np.empty(count, np.uint32)
    positions = np.empty((library.cscdpy_mesh_vertex_count(out), 3))
    library.cscdpy_polygons_copy(out, address_of(triangles), address_of(faces))
    library.cscdpy_mesh_copy_positions(out, address_of(positions))
    return triangles, positions


class Surface:
    """Triangles, and the faces that they are cut from: what an object of a mesh needs to know of its faces."""

    def __init__(self, triangles: Array, triangle_face: Array, face_count: int, vertex_count: int) -> None:
        self.triangles = triangles
        self.triangle_face = triangle_face
        self.face_count = face_count
        self.vertex_count = vertex_count

    @classmethod
    def of_faces(cls, faces: Any, vertex_count: Optional[int], positions: Any) -> Surface:
        """Faces of three or four corners. Those without three different corners have no triangle."""
        if positions is not None:
            positions = as_positions("positions", positions, vertex_count)
            vertex_count = len(positions)
        if vertex_count is not None:
            vertex_count = count_of("vertex_count", vertex_count, _MOST_VERTICES)
        rows = as_faces("F", faces, vertex_count)
        if vertex_count is None:
            vertex_count = int(rows.max()) + 1 if rows.size else 0
        if rows.shape[1] == 4 and len(rows):
            if positions is None:
                raise ValueError("positions: expected an array (n, 3), because faces of four corners are cut into "
                                 "triangles by their shape, got None")
            check_magnitudes("positions", positions)
            sizes = np.full(len(rows), 4, np.uint32)
            triangles, triangle_face = cut_polygons(positions, rows.reshape(-1), sizes)
            return cls(triangles, triangle_face, len(rows), vertex_count)
        rows = rows[:, :3]
        whole = (rows[:, 0] != rows[:, 1]) & (rows[:, 1] != rows[:, 2]) & (rows[:, 2] != rows[:, 0])
        if whole.all():
            return cls(rows, np.arange(len(rows), dtype=np.uint32), len(rows), vertex_count)
        return cls(np.ascontiguousarray(rows[whole]), np.flatnonzero(whole).astype(np.uint32), len(rows), vertex_count)

    @classmethod
    def of_polygons(cls, positions: Any, corners: Any, face_sizes: Any) -> Surface:
        """Faces of any number of corners, one after the other."""
        positions = as_positions("positions", positions)
        check_magnitudes("positions", positions)
        corners = as_indices("corners", corners, 1, len(positions), "vertices")
        face_sizes = as_indices("counts", face_sizes, 1, _MOST_CORNERS, "corners of a face")
        if int(face_sizes.sum(dtype=np.uint64)) != len(corners):
            raise ValueError(f"counts: expected a sum of {len(corners)}, the number of corners, got "
                             f"{int(face_sizes.sum(dtype=np.uint64))}")
        if len(face_sizes) == 0:
            return cls(np.empty((0, 3), np.uint32), np.empty(0, np.uint32), 0, len(positions))
        triangles, triangle_face = cut_polygons(positions, corners, face_sizes)
        return cls(triangles, triangle_face, len(face_sizes), len(positions))


class Wires:
    """An object of segments between its vertices, as of hair: ``edges`` (k, 2), indices of its own vertices."""

    def __init__(self, edges: Any, vertex_count: Optional[int] = None) -> None:
        limit = _MOST_VERTICES if vertex_count is None else count_of("vertex_count", vertex_count, _MOST_VERTICES)
        self.edges = as_indices("edges", edges, 2, limit, "vertices").copy()
        self.vertex_count = int(self.edges.max(initial=0)) + 1 if vertex_count is None else limit


class Points:
    """An object of ``vertex_count`` points, as of particles; with a thickness they are spheres."""

    def __init__(self, vertex_count: int) -> None:
        self.vertex_count = count_of("vertex_count", vertex_count, _MOST_VERTICES)


class HalfSpace:
    """All that is behind a plane, as the ground. ``normal`` (3,) points out of it; its vertex lies in the plane."""

    vertex_count = 1

    def __init__(self, normal: Any) -> None:
        self.normal = as_floats("normal", normal, "three numbers").astype(np.float64)
        if self.normal.shape != (3,):
            raise ValueError(f"normal: expected three numbers, got shape {self.normal.shape}")


class Mesh:
    """The triangles of a surface, and what follows from them. It holds no positions.

    Parameters
    ----------
    F : (m, 3) or (m, 4) integers
        Faces, counter-clockwise from outside. Faces of four corners are cut into two triangles by their shape at
        ``positions``. A face without three different corners has no triangle.
    vertex_count : int, optional
        By default one more than the largest index, or the number of positions.
    positions : (n, 3), optional
        Only faces of four corners need them.

    Attributes
    ----------
    triangles : (t, 3) int64
    triangle_face : (t,) int64
        The row of ``F`` that each triangle is cut from.
    face_count, vertex_count : int

    Open, non-manifold and inconsistently oriented surfaces are allowed. Meshes may be used by several threads at once.

    >>> mesh = Mesh([[0, 1, 2], [2, 1, 3]])
    >>> mesh.vertex_count, mesh.edges.tolist()
    (4, [[0, 1], [0, 2], [1, 2], [1, 3], [2, 3]])
    """

    object_count = 1

    def __init__(self, F: Any, vertex_count: Optional[int] = None, positions: Any = None) -> None:
        self._begin([Surface.of_faces(F, vertex_count, positions)], [False])

    @classmethod
    def from_polygons(cls, positions: Any, corners: Any, counts: Any) -> Mesh:
        """A mesh of faces with any number of corners, as Blender and USD have them.

        Parameters
        ----------
        positions : (n, 3)
            By which faces are cut into triangles, as the faces of files are.
        corners : (c,) integers
            The vertices of all faces, one face after the other.
        counts : (m,) integers
            How many corners each face has; their sum is c.
        """
        return cls.of_surface(Surface.of_polygons(positions, corners, counts))

    @classmethod
    def of_surface(cls, surface: Surface) -> Mesh:
        """A mesh of one object whose triangles are known."""
        mesh = cls.__new__(cls)
        mesh._begin([surface], [False])
        return mesh

    def _begin(self, objects: Sequence[Any], obstacles: Sequence[bool]) -> None:
        self._objects = list(objects)
        self._obstacles = [bool(obstacle) for obstacle in obstacles]
        self._collect_faces()
        self._handle: Optional[Handle] = None
        self._edges: Optional[Array] = None
        if self.triangles.size or any(not isinstance(item, Surface) for item in self._objects):
            if all(not isinstance(item, Surface) or len(item.triangles) for item in self._objects):
                self._create()

    def _collect_faces(self) -> None:
        """Numbers triangles and faces object by object, as vertices are."""
        triangles: List[Array] = [np.empty((0, 3), np.int64)]
        faces: List[Array] = [np.empty(0, np.int64)]
        vertex_count = face_count = 0
        for item in self._objects:
            if isinstance(item, Surface):
                triangles.append(item.triangles + np.int64(vertex_count))
                faces.append(item.triangle_face + np.int64(face_count))
                face_count += item.face_count
            vertex_count += item.vertex_count
        self.vertex_count: int = vertex_count
        self.face_count: int = face_count
        self.triangles: Array = np.concatenate(triangles)
        self.triangle_face: Array = np.concatenate(faces)
        for array in (self.triangles, self.triangle_face):
            array.flags.writeable = False

    def _create(self) -> None:
        described = new_struct("object_desc", len(self._objects))
        kinds = {Surface: _TRIANGLES, Wires: _WIRES, Points: _POINTS, HalfSpace: _HALF_SPACE}
        for desc, item, obstacle in zip(described, self._objects, self._obstacles):
            desc["vertex_count"], desc["obstacle"], desc["kind"] = item.vertex_count, obstacle, kinds[type(item)]
            if isinstance(item, Surface):
                desc["triangle_count"], desc["triangles"] = len(item.triangles), address_of(item.triangles)
            elif isinstance(item, Wires):
                desc["wire_count"], desc["wires"] = len(item.edges), address_of(item.edges)
            elif isinstance(item, HalfSpace):
                desc["normal"] = item.normal
        host = Host()
        with host.lock:
            self._handle = new_handle(host, library.cscd_mesh_destroy, library.cscdpy_mesh_create,
                                      address_of(described), len(described))

    @property
    def pointer(self) -> int:
        """The mesh of the library, for what is made from it."""
        if self._handle is None:
            raise ValueError("this mesh, or an object of it, has no triangle; expected one at least")
        return self._handle.pointer

    @property
    def host(self) -> Host:
        """The address of the mesh in the library."""
        assert self._handle is not None
        return self._handle.host

    @property
    def triangle_count(self) -> int:
        return len(self.triangles)

    @property
    def vertex_counts(self) -> List[int]:
        """The number of vertices of each object."""
        return [item.vertex_count for item in self._objects]

    @property
    def triangle_objects(self) -> Array:
        """(t,) int64: the object of each triangle."""
        counts = [len(item.triangles) if isinstance(item, Surface) else 0 for item in self._objects]
        return np.repeat(np.arange(len(counts)), counts)

    @property
    def edges(self) -> Array:
        """(e, 2) int64: the two vertices of each edge, the smaller one first, sorted."""
        if self._edges is None:
            count = 0 if self._handle is None else library.cscd_mesh_count(self.pointer, VALUES["CSCD_EDGES"])
            source = library.cscd_mesh_array(self.pointer, VALUES["CSCD_EDGE_VERTICES"]) if count else 0
            self._edges = copy_list(source, 2 * count, np.uint32).reshape(count, 2).astype(np.int64)
            self._edges.flags.writeable = False
        return self._edges

    @property
    def component_count(self) -> int:
        """The number of components: triangles that can be reached from each other over common vertices."""
        return 0 if self._handle is None else int(library.cscd_mesh_count(self.pointer, VALUES["CSCD_COMPONENTS"]))

    @property
    def triangle_components(self) -> Array:
        """(t,) int64: the component of each triangle."""
        source = 0 if self._handle is None else library.cscd_mesh_array(self.pointer, VALUES["CSCD_TRIANGLE_COMPONENTS"])
        return copy_list(source, self.triangle_count, np.uint32).astype(np.int64)

    def component(self, index: int) -> Dict[str, Any]:
        """The counts and the defects of a component, by the names of ``cscd_component`` (include/cscd/detector.h).

        The first edge or vertex with a defect is -1 where there is none.
        """
        if not 0 <= index < self.component_count:
            raise IndexError(f"component {index}: the mesh has {self.component_count}")
        found = new_struct("component")
        library.cscdpy_mesh_component(self.pointer, index, address_of(found))
        return dict(zip(structs["component"].names, items_of(found, "component")[0].item()))

    @property
    def is_closed_manifold(self) -> bool:
        """All components are closed, manifold and consistently oriented."""
        return self.component_count > 0 and all(self.component(i)["closed_manifold"]
                                                for i in range(self.component_count))

    @property
    def hash(self) -> int:
        """A hash of vertex count and triangles; plans are of meshes with the same one."""
        return int(library.cscd_mesh_hash(self.pointer))

    def __repr__(self) -> str:
        return (f"{type(self).__name__}({self.vertex_count} vertices, {self.triangle_count} triangles"
                f"{f', {self.object_count} objects' if self.object_count > 1 else ''})")

    def __reduce__(self) -> Tuple[Callable[..., Any], Tuple[Any, ...]]:
        return _restore, (type(self), self._objects, self._obstacles)


class Scene(Mesh):
    """A mesh of several objects, each a ``Mesh``, ``Wires``, ``Points`` or ``HalfSpace``.

    Vertices, triangles and faces are numbered object by object. Positions of a scene are one array of all vertices, or
    a list with an array for each object.

    Parameters
    ----------
    objects : sequence
    obstacles : iterable of int
        The objects that the caller moves: nothing is looked for within one of them, nor between two.

    >>> triangle = Mesh([[0, 1, 2]])
    >>> Scene([triangle, triangle], obstacles=[1])
    Scene(6 vertices, 2 triangles, 2 objects)
    """

    def __init__(self, objects: Sequence[Union[Mesh, Wires, Points, HalfSpace]],
                 obstacles: Sequence[int] = ()) -> None:
        parts: List[Any] = []
        for i, item in enumerate(objects):
            if isinstance(item, Mesh):
                parts.extend(item._objects)
                if len(item._objects) != 1:
                    raise ValueError(f"objects[{i}] is a scene of {len(item._objects)} objects; expected one object")
            elif isinstance(item, (Wires, Points, HalfSpace)):
                parts.append(item)
            else:
                raise ValueError(f"objects[{i}]: expected a Mesh, Wires, Points or HalfSpace, got "
                                 f"{type(item).__name__}")
        if not parts:
            raise ValueError("objects: expected one at least, got none")
        numbers = as_indices("obstacles", list(obstacles), 1, len(parts), "objects").tolist()
        self._begin(parts, [i in numbers for i in range(len(parts))])

    @property
    def object_count(self) -> int:  # type: ignore[override]
        return len(self._objects)


def _restore(kind: Any, objects: List[Any], obstacles: List[bool]) -> Mesh:
    """Called by pickle."""
    mesh: Mesh = kind.__new__(kind)
    mesh._begin(objects, obstacles)
    return mesh

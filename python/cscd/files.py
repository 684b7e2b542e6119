"""Recordings in files, and the page for a browser."""

from __future__ import annotations

import ctypes
import itertools
import operator
import os
import shutil
import subprocess
import sys
import tempfile
import threading
from typing import Any, Iterable, Iterator, List, Optional, Sequence, Tuple, Union

import numpy as np

from ._api import VALUES
from ._arrays import as_positions, number_of
from ._host import Keeper
from ._library import address_of, copy_list, library
from .errors import Error
from .mesh import Mesh, Scene, Surface
from .questions import mesh_of

__all__ = ["FrameSequence", "Recording", "read", "write_report"]

Array = Any
PathLike = Union[str, "os.PathLike[str]"]

_NO_PART = 2**32 - 1


class _Choices(ctypes.Structure):
    """The options for reading the files; texts are None if they are not given."""

    _fields_ = [("model_path", ctypes.c_char_p), ("frame_paths", ctypes.POINTER(ctypes.c_char_p)),
                ("frame_path_count", ctypes.c_size_t), ("weld", ctypes.c_char_p), ("animation", ctypes.c_char_p),
                ("parts_path", ctypes.c_char_p), ("parts_by", ctypes.c_char_p), ("fps", ctypes.c_double),
                ("names", ctypes.POINTER(ctypes.c_char_p)), ("paths", ctypes.POINTER(ctypes.c_char_p)),
                ("frames", ctypes.POINTER(ctypes.c_char_p)), ("obstacles", ctypes.POINTER(ctypes.c_ubyte)),
                ("object_count", ctypes.c_size_t), ("rest", ctypes.c_ubyte), ("allow_gaps", ctypes.c_ubyte)]


def _texts(items: Sequence[Optional[bytes]]) -> Any:
    return (ctypes.c_char_p * len(items))(*items)


class _OpenRecording:
    """Open files, which are closed with this object."""

    def __init__(self, path: PathLike, choices: _Choices) -> None:
        os.stat(path)  # a missing file is Python's own error
        self._keeper, error = Keeper(None, library.cscdpy_recording_close), ctypes.create_string_buffer(1024)
        self._kept = choices  # the library does not copy its texts
        if not library.cscdpy_recording_open(ctypes.addressof(choices), self._keeper.place, ctypes.addressof(error)):
            raise ValueError(error.value.decode(errors="replace"))
        self.pointer = self._keeper.pointer
        self.lock = threading.Lock()

    def read(self, frame: int, positions: Array) -> None:
        """Reads a frame into packed doubles."""
        error = ctypes.create_string_buffer(1024)
        with self.lock:
            if not library.cscdpy_recording_read(self.pointer, frame, address_of(positions), ctypes.addressof(error)):
                raise ValueError(error.value.decode(errors="replace"))


class FrameSequence(Sequence[Array]):
    """The frames of a recording, each read from its file on access: (n, 3) float64."""

    def __init__(self, opened: _OpenRecording, indices: Sequence[int], vertex_count: int) -> None:
        self._opened = opened
        self._indices = indices
        self._vertex_count = vertex_count

    def __len__(self) -> int:
        return len(self._indices)

    def __getitem__(self, index: Any) -> Any:
        if isinstance(index, slice):
            return FrameSequence(self._opened, self._indices[index], self._vertex_count)
        positions = np.empty((self._vertex_count, 3))
        self._opened.read(self._indices[index], positions)
        return positions

    def __iter__(self) -> Iterator[Array]:
        return (self[i] for i in range(len(self)))


class Recording:
    """A mesh and its frames, as ``read`` gives them.

    Attributes
    ----------
    mesh : Mesh
        Its faces are those of the file; a ``Scene`` where there are several objects.
    object_names : list of str
        The names of the objects; the first one has the name of its file.
    vertices : (n, 3) float64
        The first frame.
    frames : sequence of (n, 3) float64
        Each is read on access.
    frame_numbers : list of int
        The numbers that the artist knows them by.
    fps : float
        Frames a second; 0: nobody knows.
    part_names : list of str
        Objects and groups of the file, or its components.
    part_labels : (t,) int64
        The part of each triangle of the mesh, -1 for none.
    body_labels : (t,) int64, optional
        The bodies of the triangles, if these are not the parts: the parts that the triangles have without ``parts_by``; all -1 if
        the files name none, or one for all: then each component is by itself, and a cavity with the body around it. ``by_parts``
        and ``replay`` take it as ``bodies``. None: the parts say so.
    file_vertices : (n,) int64
        The number that each vertex has in the file. Formats that store vertices several times, as STL and glTF, have
        several for one; this is the first.
    """

    def __init__(self, opened: _OpenRecording) -> None:
        pointer = opened.pointer
        of_library = library.cscdpy_recording_mesh(pointer)
        vertex_count = int(library.cscd_mesh_count(of_library, VALUES["CSCD_VERTICES"]))
        triangle_count = int(library.cscd_mesh_count(of_library, VALUES["CSCD_TRIANGLES"]))
        corners = library.cscd_mesh_array(of_library, VALUES["CSCD_TRIANGLE_VERTICES"])
        triangles = copy_list(corners, 3 * triangle_count, np.uint32)
        numbers = np.empty(library.cscdpy_recording_frame_count(pointer), np.int32)
        faces, parts = np.empty(triangle_count, np.uint32), np.empty(triangle_count, np.uint32)
        file_vertices = np.empty(vertex_count, np.uint32)
        library.cscdpy_recording_copy(pointer, address_of(numbers), address_of(faces), address_of(parts),
                                      address_of(file_vertices))
        self.file_vertices: Array = file_vertices.astype(np.int64)
        self._take_objects(pointer, triangles.reshape(-1, 3), faces)
        self.frames = FrameSequence(opened, range(len(numbers)), vertex_count)
        self.frame_numbers: List[int] = numbers.tolist()
        self.fps = float(library.cscdpy_recording_fps(pointer))
        self.part_names: List[str] = [library.cscdpy_recording_part_name(pointer, i).decode(errors="replace")
                                      for i in range(library.cscdpy_recording_part_count(pointer))]
        self.part_labels: Array = np.where(parts == _NO_PART, -1, parts.astype(np.int64))
        bodies = np.empty(triangle_count, np.uint32)
        self.body_labels: Optional[Array] = None
        if library.cscdpy_recording_copy_bodies(pointer, address_of(bodies)):
            self.body_labels = np.where(bodies == _NO_PART, -1, bodies.astype(np.int64))
        self._first: Optional[Array] = None

    def _take_objects(self, pointer: int, triangles: Array, faces: Array) -> None:
        """Makes the mesh, object by object."""
        self.object_names: List[str] = []
        meshes: List[Mesh] = []
        obstacles: List[int] = []
        first_vertex = first_triangle = 0
        for i in range(library.cscdpy_recording_object_count(pointer)):
            counts = np.empty(4, np.uint32)
            name = library.cscdpy_recording_object(pointer, i, address_of(counts))
            vertex_count, triangle_count, face_count, obstacle = counts.tolist()
            end = first_triangle + triangle_count
            own = np.ascontiguousarray(triangles[first_triangle:end] - np.uint32(first_vertex))
            surface = Surface(own, faces[first_triangle:end].copy(), face_count, vertex_count)
            meshes.append(Mesh.of_surface(surface))
            self.object_names.append(name.decode(errors="replace"))
            if obstacle:
                obstacles.append(i)
            first_vertex, first_triangle = first_vertex + vertex_count, end
        self.mesh: Mesh = meshes[0] if len(meshes) == 1 and not obstacles else Scene(meshes, obstacles)

    @property
    def vertices(self) -> Array:
        if self._first is None:
            self._first = self.frames[0]
        return self._first

    def __repr__(self) -> str:
        return f"Recording({self.mesh!r}, {len(self.frames)} frames)"


def _weld_text(weld: Union[None, str, float]) -> Optional[bytes]:
    if weld is None:
        return None
    return weld.encode() if isinstance(weld, str) else f"{number_of('weld', weld):.17g}".encode()


def _tell_objects(choices: _Choices, objects: Any, obstacles: Sequence[str]) -> None:
    """Further objects: a path, or a path and frames, by name."""
    given = {} if objects is None else dict(objects)
    unknown = [name for name in obstacles if name not in given]
    if unknown:
        raise ValueError(f"obstacles: {unknown[0]!r} is no object; expected names of objects")
    pairs = [(item, None) if isinstance(item, (str, os.PathLike)) else tuple(item) for item in given.values()]
    if any(len(pair) != 2 for pair in pairs):
        raise ValueError("objects: expected a path, or a path and frames, for each name")
    for path, _ in pairs:
        os.stat(path)
    choices.names = _texts([name.encode() for name in given])
    choices.paths = _texts([os.fsencode(path) for path, _ in pairs])
    choices.frames = _texts([None if frames is None else os.fsencode(frames) for _, frames in pairs])
    choices.obstacles = (ctypes.c_ubyte * len(given))(*[name in obstacles for name in given])
    choices.object_count = len(given)


def read(path: PathLike, frames: Union[None, PathLike, Sequence[PathLike]] = None, *, fps: float = 0.0,
         weld: Union[None, str, float] = None, animation: Optional[str] = None, rest: bool = False,
         objects: Any = None, obstacles: Sequence[str] = (), parts: Optional[PathLike] = None,
         parts_by: Optional[str] = None, allow_gaps: bool = False) -> Recording:
    """Reads a mesh, and what it does, with the options of the tool.

    Parameters
    ----------
    path : path
        A mesh file: OBJ, PLY, STL, glTF, or another format that ``cscd`` reads.
    frames : path or sequence of paths, optional
        A point cache (.pc2, .mdd), a glTF file, a pattern (``f_%04d.obj``), a folder, or mesh files, one a frame. By
        default what a glTF file animates, else the mesh is the only frame.
    fps : float
        Frames a second, of a glTF file; 0: 24.
    weld : str or float, optional
        Which vertices are joined: "exact" those in one place in all frames, a distance those within it, "none" none. By
        default those of STL files and, within a part, of glTF files.
    animation : str, optional
        Which animation of a glTF file; by default the first.
    rest : bool
        A glTF file stays at rest.
    objects : mapping, optional
        Further objects by name: a path, or a path and its frames (a point cache, a pattern, a folder or a glTF file). All
        that move have as many frames.
    obstacles : sequence of str
        Which of these objects are obstacles: nothing is looked for within one of them, nor between two.
    parts : path, optional
        A table with the part of each triangle, face or vertex, as ``--parts`` has it.
    parts_by : "object", "group" or "material", optional
        What makes the parts, of OBJ and glTF files, as ``--parts-by`` has it; by default objects with their groups, or nodes.
    allow_gaps : bool
        Of numbered files, some may be missing.

    Raises
    ------
    ValueError
        The text says what is wrong, in which file, and where.
    """
    if frames is None:
        listed: List[bytes] = []
    elif isinstance(frames, (str, os.PathLike)):
        listed = [os.fsencode(frames)]
    else:
        listed = [os.fsencode(item) for item in frames]
    choices = _Choices(model_path=os.fsencode(path), frame_paths=_texts(listed), frame_path_count=len(listed),
                       weld=_weld_text(weld), animation=None if animation is None else animation.encode(),
                       parts_path=None if parts is None else os.fsencode(parts),
                       parts_by=None if parts_by is None else parts_by.encode(), fps=number_of("fps", fps),
                       rest=bool(rest), allow_gaps=bool(allow_gaps))
    _tell_objects(choices, objects, list(obstacles))
    return Recording(_OpenRecording(path, choices))


# ---- the page ------------------------------------------------------------------------------------------------


def _write_model(path: str, positions: Array, triangles: Array) -> None:
    """A mesh as OBJ, every coordinate as it is."""
    with open(path, "w", encoding="ascii") as file:
        file.writelines(f"v {x!r} {y!r} {z!r}\n" for x, y, z in positions.astype(np.float64).tolist())
        file.writelines(f"f {a} {b} {c}\n" for a, b, c in (triangles.astype(np.int64) + 1).tolist())


def _numbers_of(frame_numbers: Optional[Sequence[int]]) -> Iterator[int]:
    """The numbers of frames, from the first one on: 0, 1, 2, ... where none are given."""
    if frame_numbers is None:
        return itertools.count()
    numbers = [operator.index(number) for number in frame_numbers]
    if not numbers:
        raise ValueError("frame_numbers: expected a number for each frame, got none")
    if any(later <= earlier for earlier, later in zip(numbers, numbers[1:])):
        raise ValueError("frame_numbers: expected numbers that ascend")
    return iter([number - numbers[0] for number in numbers])


def _write_frames(folder: str, frames: Iterable[Any], F: Any, frame_numbers: Optional[Sequence[int]]) -> Tuple[Mesh, int]:
    """A mesh file for each frame; returns the mesh, and how many there are."""
    mesh: Optional[Mesh] = None
    count = 0
    numbers = _numbers_of(frame_numbers)
    number: Optional[int] = 0
    for frame in frames:
        number = next(numbers, None)
        if number is None:
            break
        positions = as_positions(f"frames[{count}]", frame, None if mesh is None else mesh.vertex_count)
        if mesh is None:
            mesh = mesh_of(F, positions)
        _write_model(os.path.join(folder, f"frame_{number:06d}.obj"), positions, mesh.triangles)
        count += 1
    if frame_numbers is not None and (number is None or next(numbers, None) is not None):
        raise ValueError(f"frame_numbers: expected as many as there are frames, got {len(frame_numbers)}")
    if mesh is None or count < 2:
        raise ValueError(f"frames: expected two at least, got {count}; of one mesh `python -m cscd check` tells all")
    return mesh, count


def write_report(path: PathLike, frames: Any, F: Any, *, title: str = "", part_names: Optional[Sequence[str]] = None,
                 part_labels: Any = None, fps: float = 0.0, unit: str = "", up: str = "",
                 frame_numbers: Optional[Sequence[int]] = None) -> str:
    """Writes the page for a browser: the frames in three dimensions, their intersections, contacts and events.

    It is the page of ``cscd replay --report``, made by the tool in a process of its own.

    Parameters
    ----------
    path : path
        An HTML file, which needs no other file.
    frames : (B, n, 3), or an iterable of (n, 3)
        Two at least.
    F : (m, 3) or (m, 4) integers, or Mesh
    title : str, optional
    part_names, part_labels : sequence of str, and (t,) integers, optional
        The part of each triangle of the mesh, -1 for none.
    fps : float
        Frames a second, for playing them.
    unit : str
        The unit of the positions: "mm", "cm", "m", ...
    up : str
        "y" or "z".
    frame_numbers : sequence of int, optional
        The numbers of the frames, ascending; by default 0, 1, 2, ...

    Returns
    -------
    str
        The sentence that the tool prints: what crosses, in which frames, and the worst.
    """
    with tempfile.TemporaryDirectory(prefix="cscd-") as folder:
        mesh, count = _write_frames(folder, frames, F, frame_numbers)
        command = ["replay", os.path.join(folder, "frame_000000.obj"),
                   os.path.join(folder, "frame_%06d.obj"), "--report", os.path.abspath(os.fspath(path)),
                   "--title", title or os.path.splitext(os.path.basename(os.fspath(path)))[0]]
        for option, value in (("--unit", unit), ("--up", up), ("--fps", f"{fps:.17g}" if fps else "")):
            if value:
                command += [option, value]
        if frame_numbers is not None:
            command += ["--allow-gaps", "--first-frame", str(operator.index(frame_numbers[0]))]
        if part_labels is not None:
            command += ["--parts", _write_parts(folder, mesh, part_names, part_labels)]
        return _run_tool(command)


def _write_parts(folder: str, mesh: Mesh, names: Optional[Sequence[str]], labels: Any) -> str:
    """The table of parts that the tool reads."""
    from .intersections import labels_of
    array, count = labels_of(labels, mesh.triangle_count, None if names is None else len(names))
    path = os.path.join(folder, "parts.csv")
    with open(path, "w", encoding="utf-8") as file:
        file.write("triangle,name\n")
        for triangle, part in enumerate(array.tolist()):
            if part != _NO_PART:
                name = str(part) if names is None else " ".join(str(names[part]).split())
                file.write(f"{triangle},{name}\n")
    return path


def _interpreter() -> str:
    """A Python for the tool. If a program embeds Python, ``sys.executable`` may be that program, or empty."""
    if os.name == "nt":
        folders, names = ["", "Scripts", "bin"], ["python.exe"]
    else:
        folders, names = ["bin"], [f"python{sys.version_info[0]}.{sys.version_info[1]}", "python3"]
    beside = [os.path.join(prefix, folder, name) for prefix in (sys.exec_prefix, sys.base_exec_prefix)
              for folder in folders for name in names]
    for path in (sys.executable, *beside, *(shutil.which(name) for name in names)):
        if path and "python" in os.path.basename(path).lower() and os.access(path, os.X_OK):
            return path
    raise Error("write_report runs the tool in a process of its own, and found no Python for it; "
                f"put {names[-1]} on the PATH")


def _run_tool(command: List[str]) -> str:
    """Runs the tool of this package; returns its first line."""
    program = os.path.join(os.path.dirname(os.path.abspath(__file__)), "__main__.py")
    done = subprocess.run([_interpreter(), "-I", program, *command], encoding="utf-8", errors="replace", stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, check=False)
    if done.returncode != 0:
        raise Error(done.stderr.strip() or f"the tool ended with {done.returncode}")
    return done.stdout.split("\n", 1)[0]

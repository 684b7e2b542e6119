"""Arrays of the caller, as the library reads them: checked, and without a copy where its views allow."""

from __future__ import annotations

from typing import Any, List, Optional, Sequence, Tuple

import numpy as np

from ._library import address_of, structs

__all__ = ["as_faces", "as_floats", "as_indices", "as_numbers", "as_positions", "check_magnitudes",
           "count_of", "mutable_view", "number_of", "views_of"]

Array = Any  # np.ndarray[Any, Any], said shorter

_LARGEST_INDEX = 2**32 - 2
_LARGEST_EXACT = 2**53


def describe(array: Array) -> str:
    """The part of a sentence that describes an array that does not fit."""
    return f"shape {array.shape} of {array.dtype}"


def number_of(name: str, value: Any) -> float:
    """A number, as a double."""
    if not isinstance(value, (str, bytes, bool, np.bool_, np.complexfloating)) and np.ndim(value) == 0:
        try:
            return float(value)
        except (OverflowError, TypeError, ValueError):
            pass
    raise ValueError(f"{name}: expected a number, got {value!r}")


def count_of(name: str, value: Any, largest: int = 2**63 - 1) -> int:
    """A whole number from 0 on."""
    if isinstance(value, bool) or not isinstance(value, (int, np.integer)) or not 0 <= value <= largest:
        raise ValueError(f"{name}: expected a whole number from 0 to {largest}, got {value!r}")
    return int(value)


def as_floats(name: str, values: Any, what: str) -> Array:
    """Floats as they are; whole numbers and halves as doubles, which have the same values."""
    try:
        array = np.asarray(values)
    except Exception as problem:  # whatever __array__ of a foreign object raises
        raise ValueError(f"{name}: expected {what}, got {type(values).__name__}: {problem}") from None
    if array.dtype in (np.float64, np.float32) and array.dtype.isnative:
        return array
    if array.dtype.kind == "f" and array.dtype.itemsize <= 8:
        return array.astype(np.float64)
    if array.dtype.kind in "iu":
        if array.dtype.itemsize == 8 and array.size and max(int(array.max()), -int(array.min())) > _LARGEST_EXACT:
            largest = max((int(array.max()), int(array.min())), key=abs)
            raise ValueError(f"{name}: expected {what}, got the whole number {largest}, beyond 2^53, where not every one is "
                             "a double")
        return array.astype(np.float64)
    raise ValueError(f"{name}: expected {what}, got {describe(array)}")


def as_numbers(name: str, values: Any, count: int) -> Optional[Array]:
    """``count`` numbers as packed doubles; one number stands for all, and None stays None."""
    if values is None:
        return None
    what = f"a number or an array ({count},)"
    array = as_floats(name, values, what)
    if array.shape not in ((), (count,)):
        raise ValueError(f"{name}: expected {what}, got {describe(array)}")
    return np.array(np.broadcast_to(array, count), np.float64, order="C")


def as_positions(name: str, values: Any, vertex_count: Optional[int] = None) -> Array:
    """Vertex positions (n, 3), float32 or float64."""
    rows = "n" if vertex_count is None else str(vertex_count)
    array = as_floats(name, values, f"an array ({rows}, 3) of float32 or float64")
    if array.size == 0 and array.ndim == 1:
        array = array.reshape(0, 3)
    if array.ndim != 2 or array.shape[1] != 3 or (vertex_count is not None and len(array) != vertex_count):
        raise ValueError(f"{name}: expected an array ({rows}, 3) of float32 or float64, got {describe(array)}")
    return array


def check_magnitudes(name: str, positions: Array) -> None:
    """Says what the library would say of one object's positions, with their own name and number."""
    sizes = np.abs(positions.astype(np.float64))
    right = (sizes == 0.0) | ((sizes >= 2.0**-300) & (sizes <= 2.0**300))
    if not right.all():
        vertex, column = (int(i) for i in np.argwhere(~right)[0])
        raise ValueError(f"{name}: vertex {vertex} has {'xyz'[column]} = {positions[vertex, column]}, expected 0 or a "
                         "magnitude from 2^-300 to 2^300")


def as_faces(name: str, values: Any, vertex_count: Optional[int] = None) -> Array:
    """Faces (m, 3) or (m, 4) of whole numbers, as packed uint32; ``vertex_count`` bounds them."""
    what = "an array (m, 3) or (m, 4) of whole numbers"
    try:
        array = np.asarray(values)
    except Exception as problem:
        raise ValueError(f"{name}: expected {what}, got {type(values).__name__}: {problem}") from None
    if array.size == 0 and (array.ndim < 2 or array.shape[1] in (3, 4)):
        return np.empty((0, array.shape[1] if array.ndim == 2 else 3), np.uint32)
    if array.ndim != 2 or array.shape[1] not in (3, 4) or array.dtype.kind not in "iu":
        raise ValueError(f"{name}: expected {what}, got {describe(array)}")
    limit = _LARGEST_INDEX if vertex_count is None else vertex_count - 1
    if int(array.min()) < 0 or int(array.max()) > limit:
        row, column = np.argwhere((array < 0) | (array > limit))[0]
        has = "" if vertex_count is None else f", of {vertex_count} vertices"
        if limit < 0:
            raise ValueError(f"{name}[{row}, {column}] is {array[row, column]}, but there are no vertices")
        raise ValueError(f"{name}[{row}, {column}] is {array[row, column]}; expected an index from 0 to {limit}{has}")
    return np.array(array, np.uint32, order="C")  # a copy: a mesh keeps it, and the caller's array may change


def as_indices(name: str, values: Any, columns: int, limit: int, of_what: str) -> Array:
    """Rows of ``columns`` indices below ``limit``, as packed uint32; with one column the array is flat."""
    shape = "(k,)" if columns == 1 else f"(k, {columns})"
    what = f"an array {shape} of whole numbers"
    array = np.asarray(values)
    if array.size == 0:
        return np.empty((0,) if columns == 1 else (0, columns), np.uint32)
    if array.dtype.kind not in "iu" or array.shape[1:] != (() if columns == 1 else (columns,)) or array.ndim == 0:
        raise ValueError(f"{name}: expected {what}, got {describe(array)}")
    if int(array.min()) < 0 or int(array.max()) >= limit:
        place = tuple(int(i) for i in np.argwhere((array < 0) | (array >= limit))[0])
        raise ValueError(f"{name}{list(place)} is {array[place]}; expected the index of one of {limit} {of_what}")
    return np.ascontiguousarray(array, np.uint32)


def _view(array: Array, objects: int) -> Tuple[Tuple[int, ...], Array]:
    """The members of a view of positions, and the array that it looks at."""
    stride, step = array.strides
    item = array.itemsize
    if len(array) > 0 and (stride <= 0 or step <= 0):  # backwards, or one row many times
        array = np.ascontiguousarray(array)
        stride, step = array.strides
    size = (len(array) - 1) * stride + 2 * step + item if len(array) else 0
    return (address_of(array), size, stride, step, 1 if item == 4 else 0, objects), array


def views_of(name: str, positions: Any, vertex_counts: Sequence[int]) -> Tuple[Array, List[Array]]:
    """Views of one array of all vertices, or of a list with an array for each object, and what keeps them alive."""
    if vertex_counts and isinstance(positions, (list, tuple)) and len(positions) == len(vertex_counts) \
            and np.ndim(positions[0]) == 2:
        parts = [as_positions(f"{name}[{i}]", part, vertex_counts[i]) for i, part in enumerate(positions)]
        pairs = [_view(part, 1) for part in parts]
    else:
        pairs = [_view(as_positions(name, positions, sum(vertex_counts)), 0)]
    return np.array([members for members, _ in pairs], structs["view"]), [array for _, array in pairs]


def mutable_view(array: Array) -> Array:
    """A view of a packed array that the library writes."""
    return np.array([(address_of(array), array.nbytes, 0, 0, 1 if array.itemsize == 4 else 0, 0)],
                    structs["mutable_view"])

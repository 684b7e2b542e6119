"""Finds the compiled library and loads it: its functions, and its structs as numpy dtypes.

The functions are called through ``ctypes.PyDLL``, with Python's lock held. Calls that may take long give the lock back
themselves and take it again to look for signals (python/native/host.h), which costs less than a thread for each call,
and what a signal's handler raises is raised here as if it had been called directly. The functions of Python that
these need are handed over as addresses, so that the library is built without Python's headers and fits every version.
"""

from __future__ import annotations

import ctypes
import os
from typing import Any, Dict, List

import numpy as np

from ._api import FUNCTIONS
from ._prototypes import PROTOTYPES

__all__ = ["address_of", "copy_items", "copy_list", "items_of", "library", "new_struct", "records", "structs"]

_NONE = 2**32 - 1
_ITEMS_AT_ONCE = 1 << 16
_INDICES_MAY_BE_NONE = ("component", "depth", "event", "lens", "lens_point", "part_pair")
_FROM_PYTHON = ("PyEval_SaveThread", "PyEval_RestoreThread", "PyErr_CheckSignals", "PyObject_CallFunction",
                "PyObject_IsTrue", "Py_DecRef", "PyCapsule_New", "PyCapsule_GetPointer")


def _load() -> ctypes.PyDLL:
    name = "libcscd-python.dll" if os.name == "nt" else "libcscd-python.so"
    path = os.path.join(os.path.dirname(os.path.abspath(__file__)), name)
    if not os.path.exists(path):
        raise ImportError(f"cscd: the compiled library {path} is missing; `pip install .` or `make python` in the "
                          "sources of cscd builds it")
    loaded = ctypes.PyDLL(path)
    for name, (result, arguments) in {**PROTOTYPES, **FUNCTIONS}.items():
        function = getattr(loaded, name)
        function.restype = result
        function.argtypes = arguments
    addresses = [ctypes.cast(getattr(ctypes.pythonapi, name), ctypes.c_void_p) for name in _FROM_PYTHON]
    if not loaded.cscdpy_set_interpreter((ctypes.c_void_p * len(addresses))(*addresses), len(addresses)):
        raise ImportError(f"cscd: {path} is of another version of the package")
    return loaded


def _describe_member(index: int, member: int) -> List[Any]:
    """The name, the numpy format and the offset of a member of a struct."""
    numbers = (ctypes.c_size_t * 3)()
    letter = ctypes.c_char()
    name = library.cscdpy_member(index, member, numbers, ctypes.byref(letter)).decode()
    offset, size, item = numbers
    if letter.value == b"s":
        return [name, structs["contact"], offset]
    kind = {b"b": "?", b"p": f"u{item}"}.get(letter.value, f"{letter.value.decode()}{item}")
    return [name, kind if size == item else (kind, (size // item,)), offset]


def _signed(struct: Any) -> Any:
    """The same members, with signed whole numbers of 64 bits in place of unsigned ones."""
    members = []
    for name in struct.names:
        item, shape = struct[name].subdtype or (struct[name], ())
        members.append((name, np.dtype(np.int64) if item.kind == "u" else item, shape))
    return np.dtype(members, align=True)


def _read_structs() -> None:
    """Makes a dtype of each struct that the library describes."""
    size, members = ctypes.c_size_t(), ctypes.c_size_t()
    index = 0
    while True:
        name = library.cscdpy_struct(index, ctypes.byref(size), ctypes.byref(members))
        if name is None:
            return
        names, formats, offsets = zip(*(_describe_member(index, i) for i in range(members.value)))
        struct = np.dtype({"names": names, "formats": formats, "offsets": offsets, "itemsize": size.value})
        structs[name.decode()], records[name.decode()] = struct, _signed(struct)
        index += 1


library = _load()

#: A dtype for each struct of the library, by its name without ``cscd_``.
structs: Dict[str, Any] = {}

#: The same as callers get them: every whole number is an int64, whose differences do not wrap.
records: Dict[str, Any] = {}
_read_structs()


def address_of(array: np.ndarray[Any, Any]) -> int:
    """The address of the first byte of an array."""
    # Not by __array_interface__, which loses what a signal's handler raises while it describes the members of records.
    return int(array.ctypes.data)


def new_struct(name: str, count: int = 1) -> np.ndarray[Any, Any]:
    """An array of structs, all zero."""
    return np.zeros(count, structs[name])


class _Memory:
    """Memory of the library, for numpy."""

    def __init__(self, address: int, size: int) -> None:
        self.__array_interface__ = {"version": 3, "shape": (size,), "typestr": "|u1", "data": (address, True)}


def items_of(found: np.ndarray[Any, Any], name: str) -> np.ndarray[Any, Any]:
    """Structs of the library as records. An index of which all bits are set, which says that there is none, becomes -1.

    Ctrl-C has its turn after a fixed number of items.
    """
    struct = structs[name]
    items = np.empty(len(found), records[name])
    for begin in range(0, len(found), _ITEMS_AT_ONCE):
        items[begin: begin + _ITEMS_AT_ONCE] = found[begin: begin + _ITEMS_AT_ONCE]
    for member in struct.names if name in _INDICES_MAY_BE_NONE else ():
        if struct[member].base == np.uint32:
            items[member][items[member] == _NONE] = -1
    return items


def copy_items(address: int, count: int, name: str) -> np.ndarray[Any, Any]:
    """A list of the library as records, which the caller owns."""
    if count == 0:
        return np.empty(0, records[name])
    memory: np.ndarray[Any, Any] = np.asarray(_Memory(address, count * structs[name].itemsize))
    return items_of(memory.view(structs[name]), name)


def copy_list(address: int, count: int, dtype: Any) -> np.ndarray[Any, Any]:
    """A copy of a list of the library, which the caller owns."""
    copied = np.empty(count, dtype)
    library.cscdpy_copy(address_of(copied), address, copied.nbytes)
    return copied

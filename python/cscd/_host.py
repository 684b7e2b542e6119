"""The place where calls run: a context of the library with its threads, one call at a time; and the errors of failures."""

from __future__ import annotations

import ctypes
import operator
import os
import threading
import weakref
from typing import Any, Callable, Dict, Iterable, NoReturn, Optional, Set

import numpy as np

from ._api import VALUES
from ._library import library
from .errors import Cancelled, Error, ListTooLong

__all__ = ["DETECTOR_STEPS", "Handle", "Host", "Keeper", "PLAN_STEPS", "code_of", "new_handle", "ours_of",
           "processor_count", "raise_status", "thread_count_of"]

_OUT_OF_MEMORY, _INVALID_ARGUMENT, _INVALID_MESH, _SYSTEM_ERROR, _CANCELLED, IN_CONTACT, _BUSY = 1, 2, 3, 4, 5, 6, 7
_LIST_TOO_LONG = 9
_MOST_THREADS = 256

#: All hosts of this process, of which a child gets copies. No WeakSet: what that does when one goes is written in Python,
#: and an exception of a signal's handler would be lost there.
_hosts: Set[weakref.ref[Host]] = set()


def _look_after_fork() -> None:
    """In a child: calls that run in other threads have stayed in the process that forked."""
    for reference in list(_hosts):
        host = reference()
        if host is not None:
            host.after_fork()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_look_after_fork)


def raise_status(status: int, sentence: str) -> NoReturn:
    """Raises the exception that a status of the library stands for."""
    phrase = library.cscd_status_string(status).decode()
    text = sentence or phrase
    if status == _BUSY:
        raise Error("this object is in the middle of a call, which a callback of it cannot repeat; make the call when it "
                    "has returned, or with another object")
    if status == _OUT_OF_MEMORY:
        raise MemoryError(text)
    if status in (_INVALID_ARGUMENT, _INVALID_MESH):
        raise ValueError(text)
    if status == _CANCELLED:
        raise Cancelled(text)
    if status == _LIST_TOO_LONG:
        raise ListTooLong(text)
    raise Error(text)


# Steps of the published method that may be done as charge does them: the CSCD_OURS_ constants of cscd/research.h.
PLAN_STEPS = {"charge": 1, "ranks": 2, "cuts": 4, "points": 8}
DETECTOR_STEPS = {"motion": 16, "starts": 32, "representatives": 64, "neighbours": 128, "tests": 256, "boxes": 512}


def ours_of(words: Iterable[str], steps: Dict[str, int]) -> int:
    """The sum of the steps with these names."""
    names = {words} if isinstance(words, str) else set(words)
    for name in names:
        if name not in steps:
            raise ValueError(f"ours: expected some of {', '.join(steps)}; got {name!r}")
    return sum(steps[name] for name in names)


def code_of(what: str, name: Any) -> int:
    """The number of a method, mode, volume or simd level, by its name; ``what`` says which of them."""
    code = ctypes.c_uint32()
    if not isinstance(name, str) or "\0" in name:
        raise ValueError(f"{what}: expected a name, got {name!r}")
    if not library.cscd_from_name(VALUES[f"CSCD_{what.upper()}S"], name.encode(), ctypes.byref(code)):
        raise ValueError(f"{what}: {name!r} is unknown")
    return code.value


def thread_count_of(threads: Any) -> int:
    """A number of threads, 0 for one per processor."""
    try:
        if isinstance(threads, (bool, np.bool_)):
            raise TypeError
        count = operator.index(threads)
    except TypeError:
        raise ValueError(f"threads: expected a whole number, got {threads!r}") from None
    if not 0 <= count <= _MOST_THREADS:
        raise ValueError(f"threads: expected 0 (one per processor) to {_MOST_THREADS}, got {count}")
    return count


def processor_count() -> int:
    """The number of processors that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


class Keeper:
    """Something of the library, which is given back with this one, by ``destroy``.

    It is there before what it keeps: a function that creates an object puts it into ``place``, so that no signal comes
    in between. It has no ``__del__``, in which an exception of a signal's handler would be lost, but a capsule, whose
    destructor is in C (python/native/host.c).
    """

    __slots__ = ("_capsule", "_out")

    def __init__(self, host: Optional[int], destroy: Any) -> None:
        address = ctypes.c_void_p()
        self._capsule = library.cscdpy_keep(host, ctypes.cast(destroy, ctypes.c_void_p), ctypes.byref(address))
        assert address.value is not None
        self._out = ctypes.c_void_p.from_address(address.value)

    @property
    def place(self) -> Any:
        """The address at which the object is put."""
        return ctypes.byref(self._out)

    @property
    def pointer(self) -> int:
        """The object."""
        assert self._out.value is not None
        return self._out.value


class Host:
    """A context and its lock. ``with host.lock:`` is a turn in it; another thread waits for its own turn.

    Results of a call live in the library until the next one, so they are copied within the same turn. The lock is written
    in C, because Python handles signals between its own steps: an ``__enter__`` in Python would leave the lock behind when
    Ctrl-C comes just there. The same thread may take it again, from a callback; the library then refuses the call.
    """

    __slots__ = ("handle", "lock", "threads", "lost", "_keeper", "_kept", "__weakref__")

    def __init__(self, threads: Any = 1, simd: str = "auto", progress: Optional[Callable[[str, float], Any]] = None,
                 ignore: Optional[Callable[[str, int, int], bool]] = None) -> None:
        #: Why it cannot be used any more; "" if it can.
        self.lost = ""
        self.lock: Any = threading.RLock()
        self._kept = (progress, ignore)
        for name, callback in (("progress", progress), ("ignore", ignore)):
            if callback is not None and not callable(callback):
                raise ValueError(f"{name}: expected a function, got {callback!r}")
        self._keeper = Keeper(None, library.cscdpy_host_release)
        reason = ctypes.create_string_buffer(500)
        status = library.cscdpy_host_create(
            thread_count_of(threads), code_of("simd", simd), None if progress is None else id(progress),
            None if ignore is None else id(ignore), ctypes.addressof(reason), len(reason), self._keeper.place)
        if status:
            raise_status(status, reason.value.decode())
        self.handle: int = self._keeper.pointer
        self.threads: int = library.cscdpy_host_thread_count(self.handle)
        _hosts.add(weakref.ref(self, _hosts.discard))

    def after_fork(self) -> None:
        """Runs in a child. A host that was in the middle of a call is of no use there, and is never destroyed."""
        self.lock._at_fork_reinit()
        if library.cscdpy_host_is_busy(self.handle):
            self.lost = "this object was in the middle of a call when the process forked"
            library.cscdpy_host_lose(self.handle)

    def check(self) -> None:
        """Raises if it cannot be used."""
        if self.lost:
            raise Error(f"{self.lost}; make another one here, or use the start method 'spawn'")

    def call(self, function: Any, *arguments: Any) -> None:
        """Calls a function of the layer, within a turn."""
        self.check()
        status = function(self.handle, *arguments)
        if status:
            raise_status(status, self.detail())

    def call_public(self, function: Any, *arguments: Any) -> None:
        """The same of a function of the public headers, which takes no host."""
        self.check()
        status = function(*arguments)
        if status:
            raise_status(status, self.detail())

    def detail(self) -> str:
        """Why the last call failed."""
        return str(library.cscdpy_host_detail(self.handle).decode())

    def cancel(self) -> None:
        """Ends the call that is running, from another thread."""
        if not self.lost:
            library.cscdpy_host_cancel(self.handle)

    def live_bytes(self) -> int:
        """The bytes that the context and its objects hold."""
        return int(library.cscdpy_host_bytes(self.handle))


class Handle(Keeper):
    """An object of the library in the context of a host, which lives as long."""

    __slots__ = ("host",)

    def __init__(self, host: Host, destroy: Any) -> None:
        super().__init__(host.handle, destroy)
        self.host = host


def new_handle(host: Host, destroy: Any, create: Any, *arguments: Any) -> Handle:
    """Creates an object by a function whose last argument is where to put it, within a turn."""
    handle = Handle(host, destroy)
    host.call(create, *arguments, handle.place)
    return handle

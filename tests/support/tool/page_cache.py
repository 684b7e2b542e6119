"""Which files the system has in memory."""
import ctypes
import mmap
import os

from support.tool.running import wait_until

_LIBC = ctypes.CDLL(None, use_errno=True)


def cached_pages(path):
    """How many pages of a file are in memory, and how many it has."""
    pages = -(-os.path.getsize(path) // mmap.PAGESIZE)
    found = (ctypes.c_ubyte * pages)()
    with open(path, "r+b") as file, mmap.mmap(file.fileno(), 0) as memory:
        view = ctypes.c_char.from_buffer(memory)
        status = _LIBC.mincore(ctypes.c_void_p(ctypes.addressof(view)), ctypes.c_size_t(len(memory)), found)
        del view
    assert status == 0, os.strerror(ctypes.get_errno())
    return sum(page & 1 for page in found), pages


def drop(path):
    """Takes a file out of memory; returns whether the system did so."""
    with open(path, "rb") as file:
        os.fsync(file.fileno())
        os.posix_fadvise(file.fileno(), 0, 0, os.POSIX_FADV_DONTNEED)
    return cached_pages(path)[0] == 0


def expect_cached(path):
    """Waits until all of a file is in memory."""
    def is_there():
        found, pages = cached_pages(path)
        return found == pages

    wait_until(is_there, seconds=10)

"""Failures as exceptions.

Wrong input (shapes, types, numbers that are not finite, indices out of range) is a ``ValueError`` that says what was
expected and what was found; a lack of memory is a ``MemoryError``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Tuple

if TYPE_CHECKING:
    from .results import Contacts

__all__ = ["Cancelled", "Error", "InContact", "ListTooLong"]


class Error(RuntimeError):
    """A call has failed for a reason that is neither its input nor memory; the text says which."""


class Cancelled(Error):
    """A call was ended from outside, by ``Detector.cancel``."""


class ListTooLong(Error):
    """A list would have more items than ``longest_list`` allows, or more pairs of triangles than fit ``max_memory``.

    Attributes
    ----------
    count : int
        How many items there would be.
    """

    def __init__(self, message: str, count: int = 0) -> None:
        super().__init__(message)
        self.count = count

    def __reduce__(self) -> Tuple[object, ...]:
        return type(self), (str(self), self.count)


class InContact(Error):
    """No step is free of contact, because the start is not.

    Attributes
    ----------
    pair : Contacts
        One contact, of two features that touch at the start.
    """

    def __init__(self, message: str, pair: Contacts) -> None:
        super().__init__(message)
        self.pair = pair

    def __reduce__(self) -> Tuple[object, ...]:
        return type(self), (str(self), self.pair)

"""Energies of near pairs, with gradients and Hessians: barriers, penalties and friction (docs/solver/energies.md)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, List, NamedTuple, Optional, Tuple

import numpy as np

from ._api import VALUES
from ._arrays import as_floats, number_of, views_of
from ._host import Handle, Host, new_handle
from ._library import address_of, copy_list, library, new_struct
from .mesh import Mesh

if TYPE_CHECKING:
    from .detector import Detector

__all__ = ["Energy", "EnergySum"]

Array = Any

_LAWS = ("barrier", "barrier_squared", "quadratic", "cubic")
_HESSIANS = (None, "blocks", "bsr", "csr", "coo")


class EnergySum(NamedTuple):
    """The energy of a list of near pairs, and the derivatives that were asked for."""

    value: float
    """inf if a pair is infinite."""
    gradient: Optional[Array]
    """(n, 3)."""
    hessian: Any
    """None, or as asked for."""
    least: float
    """The least distance less separation; of friction the least sliding. inf without pairs."""
    active: int
    """The pairs whose energy is not 0."""
    infinite: int
    """The pairs whose energy is infinite; their derivatives count as 0."""


class Energy:
    """A law of the distance between near pairs, summed up over lists of them.

    Parameters
    ----------
    mesh : Mesh
    reach : float
        Pairs nearer than this, beyond their separation, have an energy.
    law : str
        "barrier" and "barrier_squared" (Li et al. 2020), "quadratic", "cubic".
    stiffness : float
    physical : bool
        The law is made a length, so that with areas as weights the stiffness is a pressure.
    by_count : bool
        A pair weighs its ``count``, whatever weight it has.
    beyond : bool
        Distances count beyond each pair's separation, for lists that were found so.
    friction : float or (objects,)
        A coefficient for all pairs, or one for each object, of which a pair has the geometric mean.
    slip : float
        Points that slide less than this length hold by static friction.
    threads : int
        0: one per processor.

    >>> from cscd import Detector
    >>> x = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [.25, .25, .125], [.3, .2, 3], [.2, .3, 3]])
    >>> detector = Detector([[0, 1, 2], [3, 4, 5]])
    >>> found = Energy(detector.mesh, 0.25, "quadratic").evaluate(x, detector.near(x, 0.25, unique=True))
    >>> found.value, found.gradient[3].tolist()
    (0.0078125, [0.0, 0.0, -0.125])
    """

    def __init__(self, mesh: Mesh, reach: float, law: str = "barrier", *, stiffness: float = 1.0,
                 physical: bool = False, by_count: bool = False, beyond: bool = False, friction: Any = 0.0,
                 slip: float = 0.0, threads: int = 1, simd: str = "auto") -> None:
        if law not in _LAWS:
            raise ValueError(f"law: expected one of {', '.join(_LAWS)}; got {law!r}")
        self.mesh = mesh
        self._options = new_struct("energy_options")
        library.cscd_energy_defaults_sized(address_of(self._options), self._options.nbytes)
        self._options["law"] = VALUES[f"CSCD_ENERGY_{law.upper()}"]
        self._options["physical"], self._options["by_count"] = bool(physical), bool(by_count)
        self._options["beyond"] = bool(beyond)
        for name, value in (("reach", reach), ("stiffness", stiffness), ("slip", slip)):
            self._options[name] = number_of(name, value)
        self._friction = self._set_friction(friction)
        self._host = Host(threads, simd)
        with self._host.lock:
            self._handle: Handle = new_handle(self._host, library.cscd_energy_destroy,
                                              library.cscdpy_energy_create, mesh.pointer)
        self._frozen = 0

    def _set_friction(self, friction: Any) -> Array:
        """Coefficients of objects; they must outlive the options that point to them."""
        if np.ndim(friction) == 0:
            self._options["friction"] = number_of("friction", friction)
            return np.empty(0)
        count = len(self.mesh.vertex_counts)
        array = np.ascontiguousarray(as_floats("friction", friction, f"a number or an array ({count},)"), np.float64)
        if array.shape != (count,):
            raise ValueError(f"friction: expected a number or an array ({count},), got shape {array.shape}")
        self._options["object_friction"] = address_of(array)
        return array

    @property
    def stiffness(self) -> float:
        """May be set between calls."""
        return float(self._options["stiffness"][0])

    @stiffness.setter
    def stiffness(self, value: float) -> None:
        self._options["stiffness"] = number_of("stiffness", value)

    def evaluate(self, x: Any, near: Any, *, gradient: bool = True, hessian: Optional[str] = None,
                 project: bool = True) -> EnergySum:
        """Sums the energy of near pairs at the positions ``x`` (n, 3) at which they were found.

        Parameters
        ----------
        near : Proximities
        hessian : str, optional
            "blocks": (k, 12, 12) for the ``vertices`` of each item; "csr" and "bsr": (data, indices, indptr), and
            "coo": (data, (rows, columns)), as scipy's matrices take them.
        project : bool
            Each item's Hessian becomes the nearest positive semidefinite matrix.
        """
        views, kept = self._views("x", x)
        items, lists = self._list_of(near)
        host = self._host
        with host.lock:
            def call(targets: Any, found: Any) -> None:
                host.call(library.cscdpy_energy_evaluate, self._handle.pointer, address_of(lists), address_of(views),
                          address_of(self._options), targets, found)
            return self._sum(call, lists, len(items), gradient, hessian, project)

    def at(self, detector: Detector, x: Any) -> Tuple[Any, Array]:
        """The value and the gradient at ``x`` (n, 3), whose near pairs a detector finds; or of a batch (b, n, 3)."""
        if isinstance(x, np.ndarray) and x.ndim == 3:
            parts = [self.at(detector, one) for one in x]
            return (np.array([value for value, _ in parts]),
                    np.array([gradient for _, gradient in parts]).reshape(x.shape))
        found = self.evaluate(x, detector.near(x, float(self._options["reach"][0]), unique=True,
                                               beyond=bool(self._options["beyond"][0])))
        return found.value, found.gradient

    def freeze_friction(self, x: Any, near: Any) -> None:
        """Freezes the friction of near pairs: their normal forces and tangent planes at ``x`` (n, 3)."""
        views, kept = self._views("x", x)
        items, lists = self._list_of(near)
        host = self._host
        with host.lock:
            host.call(library.cscdpy_energy_freeze_friction, self._handle.pointer, address_of(lists),
                      address_of(views), address_of(self._options))
            self._frozen = len(items)

    def evaluate_friction(self, x0: Any, x1: Any, *, gradient: bool = True, hessian: Optional[str] = None) -> EnergySum:
        """Sums the frozen friction for the displacement from ``x0`` to ``x1``, both (n, 3); derivatives are by ``x1``."""
        start, kept0 = self._views("x0", x0)
        end, kept1 = self._views("x1", x1)
        items, lists = self._list_of(None)
        host = self._host
        with host.lock:
            def call(targets: Any, found: Any) -> None:
                host.call(library.cscdpy_energy_evaluate_friction, self._handle.pointer, address_of(start),
                          address_of(end), targets, found)
            return self._sum(call, lists, self._frozen, gradient, hessian, True)

    # ---- arguments ----------------------------------------------------------------------------------------

    def _views(self, name: str, x: Any) -> Tuple[Array, List[Array]]:
        return views_of(name, x, self.mesh.vertex_counts)

    @staticmethod
    def _list_of(near: Any) -> Tuple[Array, Array]:
        """The items as the library has them, and the struct that points to them."""
        items = new_struct("proximity", 0 if near is None else len(near))
        for name in items.dtype.names if near is not None else ():
            items[name] = near[name]
        lists = new_struct("proximities")
        lists["items"], lists["count"] = address_of(items), len(items)
        return items, lists

    def _sum(self, call: Any, lists: Array, count: int, gradient: bool, hessian: Optional[str],
             project: bool) -> EnergySum:
        """Makes a call with the targets that are asked for."""
        if hessian not in _HESSIANS:
            raise ValueError(f"hessian: expected one of {', '.join(map(repr, _HESSIANS))}; got {hessian!r}")
        n = sum(self.mesh.vertex_counts)
        targets, found, pattern = new_struct("energy_targets"), new_struct("energy_sum"), new_struct("energy_pattern")
        slopes = np.empty((n, 3)) if gradient else None
        blocks = np.empty((count, 12, 12)) if hessian == "blocks" else None
        matrix = None
        if hessian not in (None, "blocks"):
            self._host.call(library.cscdpy_energy_make_pattern, self._handle.pointer, address_of(lists), None,
                            address_of(pattern))
            matrix = np.empty((int(pattern["block_count"][0]), 3, 3))
            targets["pattern"] = address_of(pattern)
        for name, array in (("gradient", slopes), ("blocks", blocks), ("matrix", matrix)):
            targets[name] = 0 if array is None else address_of(array)
        targets["scalar_rows"], targets["project"] = hessian == "csr", bool(project)
        call(address_of(targets), address_of(found))
        second = blocks if matrix is None else _matrix_of(pattern, matrix, n, hessian)
        return EnergySum(float(found["value"][0]), slopes, second, float(found["least"][0]), int(found["active"][0]),
                         int(found["infinite"][0]))


def _matrix_of(pattern: Array, matrix: Array, n: int, form: Optional[str]) -> Any:
    """The arrays of a sparse matrix, as scipy takes them."""
    rows = copy_list(int(pattern["rows"][0]), n + 1, np.uintp).astype(np.int64)
    columns = copy_list(int(pattern["columns"][0]), len(matrix), np.uint32).astype(np.int64)
    if form == "bsr":
        return matrix, columns, rows
    lengths = np.diff(rows)
    if form == "coo":
        of_rows = np.repeat(np.arange(n), lengths)
        axes = np.arange(3)
        row = np.broadcast_to(3 * of_rows[:, None, None] + axes[:, None], matrix.shape)
        column = np.broadcast_to(3 * columns[:, None, None] + axes, matrix.shape)
        return matrix.ravel(), (row.ravel(), column.ravel())
    starts = np.concatenate([[0], np.cumsum(np.repeat(3 * lengths, 3))])
    scalars = (3 * columns[:, None] + np.arange(3)).reshape(-1)
    order = np.repeat(np.arange(n), 3)
    indices = np.concatenate([scalars[3 * rows[v]: 3 * rows[v + 1]] for v in order]) if n else scalars
    return matrix.ravel(), indices, starts

"""The derived history ``history.vtkhdf``: one unstructured grid, static in the reference state, with steps.

The file follows the VTKHDF format (version 2) and is plain HDF5: 32-bit floats behind HDF5's own shuffle and
deflate filters. To be small and quick to write, it uses what these allow:

- a vector or tensor is chunked by component, and components that are always zero in the plane are never
  written (HDF5 reads them as zero);
- the fields of cells are rounded to 16 significant bits (relative error at most 2^-16 = 1.5e-5);
  displacements and growth keep all 24 bits. The full precision is in the journal;
- fields of the contour are NaN (forces: zero) elsewhere; where its points follow each other in the mesh, they
  make a chunk of their own, and the other chunks are not written;
- what does not change from step to step is written once, and every step points at it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import h5py
import numpy as np
from numpy.typing import NDArray

from gyrify.config.run_sections import OutputField
from gyrify.errors import HistoryError
from gyrify.mesh import Mesh
from gyrify.solve.types import FloatArray
from gyrify.store.derived import sha256_of
from gyrify.store.disk_faults import storage_faults
from gyrify.store.external import cell_type, padded
from gyrify.store.fields import CONTOUR_FIELDS, STATIC_FIELDS, FieldMaker, field_unit
from gyrify.store.files import whole_file
from gyrify.store.history import History
from gyrify.store.state_fields import POINT_FIELDS, StateFields

FORMAT_VERSION: Final = (2, 2)


@dataclass(frozen=True)
class Layout:
    """How the values of a field lie in the file.

    Attributes
    ----------
    n_components : int
        Components in the file; those not in ``written`` are zero.
    written : tuple of int
        Components that are written.
    rounded : bool
        Whether values are rounded to 16 significant bits.
    elsewhere : float
        Value of what is not written.
    """

    n_components: int = 1
    written: tuple[int, ...] = (0,)
    rounded: bool = True
    elsewhere: float = 0.0

    def stored(self, values: FloatArray) -> NDArray[np.float32]:
        """Values as the file has them."""
        single = values.astype("<f4")
        if self.rounded:
            bits = single.view("<u4")
            bits += 0x80
            bits &= 0xFFFFFF00
        return single


_EXACT: Final = Layout(rounded=False)
_ON_CONTOUR: Final = Layout(rounded=False, elsewhere=np.nan)
# In the plane the shear stresses 23 and 13 are zero.
_STRESSES: Final = {2: (0, 1, 2, 3), 3: (0, 1, 2, 3, 4, 5)}


def _layout(name: OutputField, n_dim: int) -> Layout:
    """How the values of a field lie in the file, in a number of dimensions."""
    vector = Layout(3, tuple(range(n_dim)), rounded=False)
    layouts: dict[OutputField, Layout] = {
        "displacement": vector,
        "growth_stretch": _EXACT,
        "J_growth": _EXACT,
        "cauchy_stress": Layout(6, _STRESSES[n_dim]),
        "thickness": _ON_CONTOUR,
        "curvature": _ON_CONTOUR,
        "contact_force": vector,
    }
    return layouts.get(name, Layout())


def write_vtkhdf(
    history: History,
    path: str | Path,
    *,
    fields: Sequence[OutputField] | None = None,
    every: int | None = None,
) -> None:
    """Write a run as a time series for ParaView.

    The points are those of the reference state; ``displacement`` moves them. The array of field data
    ``contour`` lists the points of the outer contour in order, and ``increment`` the increment of each step.

    Parameters
    ----------
    history : History
        The run, complete or not.
    path : path
        File to write; an existing one is replaced once the new one is complete.
    fields : sequence of str, optional
        Fields to write; those of ``output.fields`` by default.
    every : int, optional
        Increments between two steps; ``output.every`` by default. The last state is always written.

    Raises
    ------
    HistoryError
        If the file cannot be written.
    """
    output = history.config.output
    names = tuple(output.fields if fields is None else fields)
    steps = written_states(len(history), output.every if every is None else every)
    target = Path(path)
    with storage_faults(target.parent, str(target)):
        with whole_file(target) as partial, h5py.File(partial, "w", locking=False) as file:
            root = file.create_group("VTKHDF")
            _write_geometry(root, history, steps)
            _write_fields(root, history, steps, names)
        _note_digest(history, target)


def _note_digest(history: History, target: Path) -> None:
    """Have the journal remember the file beside it, so that it can be known again without being opened."""
    path = history.journal.path
    if path is not None and target.resolve() == (path.parent / "history.vtkhdf").resolve():
        with suppress(HistoryError):  # a journal that may only be read
            history.journal.set_meta(vtkhdf_sha256=sha256_of(target))


def written_states(n_states: int, every: int) -> list[int]:
    """States that become steps: every so many from the first, and the last."""
    chosen = list(range(0, n_states, every))
    return chosen if chosen[-1] == n_states - 1 else [*chosen, n_states - 1]


def _write_geometry(root: h5py.Group, history: History, steps: list[int]) -> None:
    """Mesh, written once, and for each step its time and where its mesh starts: always at the beginning."""
    mesh, n_steps = history.mesh, len(steps)
    root.attrs["Version"] = np.array(FORMAT_VERSION)
    root.attrs["Type"] = np.bytes_("UnstructuredGrid")
    n_nodes = mesh.cells.shape[1]
    root["NumberOfPoints"] = np.array([mesh.n_points])
    root["NumberOfCells"] = np.array([mesh.n_cells])
    root["NumberOfConnectivityIds"] = np.array([mesh.cells.size])
    root["Points"] = padded(mesh.points)
    root["Connectivity"] = mesh.cells.ravel()
    root["Offsets"] = np.arange(mesh.n_cells + 1) * n_nodes
    root["Types"] = np.full(mesh.n_cells, cell_type(mesh).vtk, dtype=np.uint8)
    group = root.create_group("Steps")
    group.attrs["NSteps"] = n_steps
    group["Values"] = history.growth_times[steps]
    nowhere = np.zeros(n_steps, dtype=np.int64)
    group["PartOffsets"] = nowhere
    group["NumberOfParts"] = np.ones(n_steps, dtype=np.int64)
    group["PointOffsets"] = nowhere
    group["CellOffsets"] = nowhere[:, None]
    group["ConnectivityIdOffsets"] = nowhere[:, None]
    fixed = root.create_group("FieldData")
    fixed["contour"] = mesh.contour
    fixed["increment"] = np.array(steps)
    group["FieldDataOffsets/contour"] = nowhere
    group["FieldDataOffsets/increment"] = np.arange(n_steps)
    group["FieldDataSizes/contour"] = np.tile([1, mesh.contour.size], (n_steps, 1))
    group["FieldDataSizes/increment"] = np.ones((n_steps, 2), dtype=np.int64)


def _write_fields(
    root: h5py.Group, history: History, steps: list[int], names: tuple[OutputField, ...]
) -> None:
    """Every field at every step; static ones once."""
    targets = {}
    for name in names:
        place = "Point" if name in POINT_FIELDS else "Cell"
        data, mesh = root.require_group(f"{place}Data"), history.mesh
        n_values = mesh.n_points if place == "Point" else mesh.n_cells
        starts = np.arange(len(steps)) * n_values
        if name in STATIC_FIELDS:
            data[name], starts = mesh.region.astype(np.uint8), np.zeros_like(starts)
        else:
            layout, part = _layout(name, mesh.n_dim), _written_part(mesh, name)
            targets[name] = _Target.create(data, name, layout, starts, n_values, part)
        root[f"Steps/{place}DataOffsets/{name}"] = starts
        data[name].attrs["unit"] = field_unit(name, history.mesh.n_dim)
    for step, state in enumerate(_states(history, steps)):
        for name, target in targets.items():
            target.write(step, _components(state, name))


def _written_part(mesh: Mesh, name: OutputField) -> slice | None:
    """Where the values of a field of the contour lie, if that is one chunk of several; else None."""
    start, n = int(mesh.contour[0]), mesh.contour.size
    together = np.array_equal(mesh.contour, np.arange(start, start + n))
    aligned = start % n == 0 and mesh.n_points % n == 0
    return slice(start, start + n) if name in CONTOUR_FIELDS and together and aligned else None


@dataclass(frozen=True, eq=False)
class _Target:
    """Dataset of all steps of a field; a chunk for each step, component and part.

    Attributes
    ----------
    dataset : h5py.Dataset
        Where to write.
    layout : Layout
        How to write.
    starts : (n_steps,) int array
        Where each step begins.
    part : slice or None
        The values of a step that are written, if not all.
    """

    dataset: h5py.Dataset
    layout: Layout
    starts: NDArray[np.int64]
    part: slice | None

    @staticmethod
    def create(
        group: h5py.Group,
        name: str,
        layout: Layout,
        starts: NDArray[np.int64],
        n_values: int,
        part: slice | None,
    ) -> _Target:
        """Empty dataset."""
        n_dims = 1 if layout.n_components == 1 else 2
        length = n_values if part is None else part.stop - part.start
        dataset = group.create_dataset(
            name,
            (starts.size * n_values, layout.n_components)[:n_dims],
            dtype="<f4",
            chunks=(length, 1)[:n_dims],
            fillvalue=layout.elsewhere,
            shuffle=True,
            compression="gzip",
            compression_opts=1,
        )
        return _Target(dataset, layout, starts, part)

    def write(self, step: int, components: tuple[FloatArray, ...]) -> None:
        """Write the components of one step."""
        first = int(self.starts[step]) + (0 if self.part is None else self.part.start)
        for component, values in zip(self.layout.written, components, strict=True):
            chunk = self.layout.stored(values if self.part is None else values[self.part])
            rows = slice(first, first + chunk.size)
            self.dataset[rows if self.dataset.ndim == 1 else (rows, component)] = chunk


def _states(history: History, steps: list[int]) -> Iterator[StateFields]:
    """Fields of the chosen states; each depends on the state before it too."""
    maker, fractions = FieldMaker(history.slice), history.fractions
    last, u_last = -1, history.state_vector(0)
    for number in steps:
        u_start = u_last if last == number - 1 else history.state_vector(max(number - 1, 0))
        last, u_last = number, history.state_vector(number)
        yield maker.state(u_last, float(fractions[number]), u_start)


def _components(state: StateFields, name: OutputField) -> tuple[FloatArray, ...]:
    """Written components of a field, in the order of VTK (a symmetric tensor: 11, 22, 33, 12, 23, 13)."""
    if name == "cauchy_stress":
        return state.cell_stress
    values = state[name]
    return (values,) if values.ndim == 1 else tuple(values.T)

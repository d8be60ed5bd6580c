"""The derived history ``history.vtkhdf``: one unstructured grid, static in the reference state, with steps.

The file follows the VTKHDF format (version 2) and is plain HDF5: 32-bit floats behind HDF5's own shuffle and
deflate filters. To be small and quick to write, it uses what these allow:

- a vector or tensor is chunked by component, and components that are always zero in the plane are never
  written (HDF5 reads them as zero);
- of a value's four bytes only the sign and exponent byte is worth compressing; the mantissa is passed through
  in stored (uncompressed) blocks of the same deflate stream;
- the fields of cells are rounded to 16 significant bits (relative error at most 2^-16 = 1.5e-5), so that
  their last byte vanishes; displacements and growth keep all 24 bits. The full precision is in the journal;
- what does not change from step to step is written once, and every step points at it.
"""

from __future__ import annotations

import os
import zlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Final

import h5py
import numpy as np
from numpy.typing import NDArray

from gyrify.config.run_sections import OutputField
from gyrify.solve.types import FloatArray
from gyrify.store.faults import storage_faults
from gyrify.store.fields import POINT_FIELDS, STATIC_FIELDS, UNITS, FieldMaker, StateFields
from gyrify.store.history import History

FORMAT_VERSION: Final = (2, 2)
# VTK's numbers of triangles with three and six nodes.
_TRIANGLES: Final = {3: 5, 6: 22}
# Longest stored block of a deflate stream.
_LONGEST_BLOCK: Final = 65535


@dataclass(frozen=True)
class Layout:
    """How the values of a field lie in the file.

    Attributes
    ----------
    n_components : int
        Components in the file; those not in ``written`` are zero.
    written : tuple of int
        Components that are written.
    stored : tuple of int
        Bytes of a value, from the lowest, that are passed through uncompressed.
    rounded : bool
        Whether values are rounded to 16 significant bits.
    """

    n_components: int = 1
    written: tuple[int, ...] = (0,)
    stored: tuple[int, ...] = (1, 2)
    rounded: bool = True


_COMPRESSED: Final = Layout(stored=(), rounded=False)
_LAYOUTS: Final[dict[OutputField, Layout]] = {
    "displacement": Layout(3, (0, 1), stored=(0, 1, 2), rounded=False),
    "growth_stretch": _COMPRESSED,
    "J_growth": _COMPRESSED,
    "cauchy_stress": Layout(6, (0, 1, 2, 3)),
    "thickness": _COMPRESSED,
    "curvature": _COMPRESSED,
    "contact_force": Layout(3, (0, 1), stored=(), rounded=False),
}


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
    partial = target.with_name(target.name + ".partial")
    with storage_faults(target.parent, str(target)):
        try:
            with h5py.File(partial, "w") as file:
                root = file.create_group("VTKHDF")
                _write_geometry(root, history, steps)
                _write_fields(root, history, steps, names)
            os.replace(partial, target)
        finally:
            partial.unlink(missing_ok=True)


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
    root["Points"] = np.pad(mesh.points, ((0, 0), (0, 1)))
    root["Connectivity"] = mesh.cells.ravel()
    root["Offsets"] = np.arange(mesh.n_cells + 1) * n_nodes
    root["Types"] = np.full(mesh.n_cells, _TRIANGLES[n_nodes], dtype=np.uint8)
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
    mesh, chunks = history.mesh, {}
    for name in names:
        place = "Point" if name in POINT_FIELDS else "Cell"
        n_values = mesh.n_points if place == "Point" else mesh.n_cells
        is_static = name in STATIC_FIELDS
        starts = np.zeros(len(steps), dtype=np.int64) if is_static else np.arange(len(steps)) * n_values
        root[f"Steps/{place}DataOffsets/{name}"] = starts
        data = root.require_group(f"{place}Data")
        if is_static:
            data[name] = mesh.region.astype(np.uint8)
        else:
            chunks[name] = _create(data, name, len(steps), n_values)
        data[name].attrs["unit"] = UNITS[name]
    for step, state in enumerate(_states(history, steps)):
        for name, dataset in chunks.items():
            layout = _LAYOUTS.get(name, Layout())
            for component, values in zip(layout.written, _components(state, name), strict=True):
                at = (step * values.size, component)[: dataset.rank]
                dataset.write_direct_chunk(at, _encoded(values, layout))


def _create(group: h5py.Group, name: OutputField, n_steps: int, n_values: int) -> h5py.h5d.DatasetID:
    """Empty dataset of all steps of a field, a chunk for each step and component."""
    layout = _LAYOUTS.get(name, Layout())
    n_dims = 1 if layout.n_components == 1 else 2
    shape, chunk = (n_steps * n_values, layout.n_components)[:n_dims], (n_values, 1)[:n_dims]
    filters = {"chunks": chunk, "shuffle": True, "compression": "gzip", "compression_opts": 1}
    return group.create_dataset(name, shape, dtype="<f4", **filters).id


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


def _encoded(values: FloatArray, layout: Layout) -> bytes:
    """One chunk as HDF5 stores it: shuffled bytes of 32-bit floats in a zlib stream.

    Parameters
    ----------
    values : (n,) float array
        One component at one step.
    layout : Layout
        How to store it.

    Returns
    -------
    bytes
    """
    single = values.astype("<f4")
    if layout.rounded:
        bits = single.view("<u4")
        bits += 0x80
        bits &= 0xFFFFFF00
    planes = np.ascontiguousarray(single.view(np.uint8).reshape(-1, 4).T)
    checksum = zlib.adler32(planes.data)
    if not layout.stored:
        return zlib.compress(planes.data, 1)
    blocks = [b"\x78\x01"]
    for byte, plane in enumerate(planes):
        if layout.rounded and byte == 0:
            blocks.append(_deflated_zeros(plane.size))
        elif byte in layout.stored:
            blocks += _stored(plane)
        else:
            blocks.append(_deflated(plane))
    return b"".join([*blocks, b"\x03\x00", checksum.to_bytes(4, "big")])


def _stored(plane: NDArray[np.uint8]) -> Iterator[bytes]:
    """Uncompressed blocks of a deflate stream (RFC 1951, 3.2.4), none of them the last."""
    for start in range(0, plane.size, _LONGEST_BLOCK):
        block = plane[start : start + _LONGEST_BLOCK].tobytes()
        yield b"\x00" + len(block).to_bytes(2, "little") + (len(block) ^ 0xFFFF).to_bytes(2, "little")
        yield block


def _deflated(plane: NDArray[np.uint8]) -> bytes:
    """Compressed blocks of a deflate stream, none of them the last, padded to whole bytes."""
    stream = zlib.compressobj(1, zlib.DEFLATED, -zlib.MAX_WBITS)
    return stream.compress(plane.data) + stream.flush(zlib.Z_FULL_FLUSH)


@lru_cache(maxsize=8)
def _deflated_zeros(size: int) -> bytes:
    return _deflated(np.zeros(size, dtype=np.uint8))

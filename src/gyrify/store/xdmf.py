"""XDMF: one file that names the arrays, and an HDF5 file beside it that holds them."""

from __future__ import annotations

from pathlib import Path
from typing import Final
from xml.etree import ElementTree

import h5py

from gyrify.config.run_sections import OutputField
from gyrify.store.external import cell_type, padded, point_and_cell_data
from gyrify.store.files import fresh
from gyrify.store.history import History

_KINDS: Final = {1: "Scalar", 3: "Vector", 9: "Tensor"}


def write_xdmf(history: History, path: Path, states: list[int], names: tuple[OutputField, ...]) -> list[Path]:
    """Write one state as a grid, or several as a temporal collection of grids that share the mesh.

    One state stands alone, for `meshio.read` takes one grid, and neither a collection nor a time.
    """
    heavy = path.with_suffix(".h5")
    root = ElementTree.Element("Xdmf", Version="3.0")
    parent = ElementTree.SubElement(root, "Domain")
    if len(states) > 1:
        parent = ElementTree.SubElement(
            parent, "Grid", Name="run", GridType="Collection", CollectionType="Temporal"
        )
    with h5py.File(fresh(heavy), "w", locking=False) as file:
        file["points"], file["cells"] = padded(history.mesh.points), history.mesh.cells
        for number in states:
            time = repr(float(history.growth_times[number]))
            name = f"increment {number}" if len(states) > 1 else f"increment {number}, growth time {time}"
            grid = ElementTree.SubElement(parent, "Grid", Name=name, GridType="Uniform")
            if len(states) > 1:
                ElementTree.SubElement(grid, "Time", Value=time)
            _write_mesh(grid, file, history)
            _write_fields(grid, file, history, number, names)
    ElementTree.indent(root)
    ElementTree.ElementTree(root).write(fresh(path), encoding="utf-8", xml_declaration=True)
    return [path, heavy]


def _write_mesh(grid: ElementTree.Element, file: h5py.File, history: History) -> None:
    kind, n_cells = cell_type(history.mesh).xdmf, str(history.mesh.n_cells)
    topology = ElementTree.SubElement(grid, "Topology", TopologyType=kind, NumberOfElements=n_cells)
    _refer(topology, file["cells"])
    _refer(ElementTree.SubElement(grid, "Geometry", GeometryType="XYZ"), file["points"])


def _write_fields(
    grid: ElementTree.Element,
    file: h5py.File,
    history: History,
    number: int,
    names: tuple[OutputField, ...],
) -> None:
    point_data, cell_data = point_and_cell_data(history, number, names)
    for centre, data in (("Node", point_data), ("Cell", {k: v[0] for k, v in cell_data.items()})):
        for name, values in data.items():
            place, kind = f"{number}/{name}", _KINDS[values.shape[1] if values.ndim == 2 else 1]
            file.create_dataset(place, data=values, compression=1, shuffle=True)
            attribute = ElementTree.SubElement(
                grid, "Attribute", Name=name, Center=centre, AttributeType=kind
            )
            _refer(attribute, file[place])


def _refer(parent: ElementTree.Element, dataset: h5py.Dataset) -> None:
    """Point at a dataset in the HDF5 file."""
    number_type = "Int" if dataset.dtype.kind == "i" else "Float"
    item = ElementTree.SubElement(
        parent,
        "DataItem",
        Dimensions=" ".join(map(str, dataset.shape)),
        NumberType=number_type,
        Precision=str(dataset.dtype.itemsize),
        Format="HDF",
    )
    item.text = f"{Path(dataset.file.filename).name}:{dataset.name}"

"""What was repaired of a body from a file, and what its mesh could not do."""

from __future__ import annotations

from typing import TYPE_CHECKING

from gyrify.config.body_sections import FROM_FILES

if TYPE_CHECKING:
    from gyrify.config import Config


def surface_notes(config: Config) -> list[str]:
    """Warn of repairs, and of what the mesh could not do."""
    geometry = config.geometry
    if geometry.shape not in FROM_FILES:
        return []
    from gyrify.model.kept_mesh import mesh_inside

    found = []
    if geometry.shape == "volume" and geometry.volume.notes:
        found.append(f"The volume of geometry.file: {'; '.join(geometry.volume.notes)}.")
    for key, surface in (("file", geometry.surface), ("hole_file", geometry.hole_surface)):
        if surface is not None and surface.notes:
            found.append(
                f"The surface of geometry.{key} was repaired: {'; '.join(surface.notes)}. Look whether it is "
                "what you mean."
            )
    if (n := geometry.surface.n_parts) > 1:
        found.append(
            f"geometry.file has {n} closed surfaces: indices of hull and closing, depths and gyri are those "
            "of all together, and count the clefts between them as sulci. Run each alone to compare its "
            "indices."
        )
    return [*found, *mesh_inside(config).notes]

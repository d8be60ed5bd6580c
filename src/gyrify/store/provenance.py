"""What a run was computed with."""

from __future__ import annotations

import json

from gyrify.config import Config
from gyrify.store.journal import Journal


class Provenance:
    """Part of `History`."""

    journal: Journal
    config: Config

    @property
    def versions(self) -> dict[str, str]:
        """Versions of gyrify and of what it computes with."""
        return dict(json.loads(self.journal.meta("versions", "{}")))

    @property
    def linear_solver(self) -> str:
        """Library that factorised the stiffness matrices."""
        return self.journal.meta("linear_solver", "unknown")

    @property
    def contact_library(self) -> str:
        """What computed contact: ``ipctk``, ``gyrify`` (kernels of its own), or ``none`` where it is off."""
        return self.journal.meta("contact_library", "ipctk" if self.config.contact.enabled else "none")

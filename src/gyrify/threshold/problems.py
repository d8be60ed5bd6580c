"""The tissue at a value of the parameter that a threshold is sought in."""

from __future__ import annotations

from dataclasses import dataclass, field

from gyrify.config import Config
from gyrify.model.slice import Slice, build_mesh
from gyrify.threshold.scanned_parameter import configured


@dataclass
class Problems:
    """Gives tissue and growth fraction; what depends on the mesh alone is shared.

    Over the thickness of the cortex the mesh stays that of the configuration, with its layers moved: the
    branch is followed from one value to the next.

    Attributes
    ----------
    config : Config
        The other parameters.
    parameter : str
        Key of the parameter.
    """

    config: Config
    parameter: str
    _first: Slice | None = field(default=None, repr=False)

    def __call__(self, value: float) -> tuple[Slice, float]:
        """Tissue and growth fraction at a value of the parameter."""
        if self.parameter == "growth.time":
            if self._first is None:
                self._first = Slice(self.config)
            return self._first, value / self.config.growth.duration
        config = configured(self.config, self.parameter, value)
        if self._first is None or self.parameter.startswith("geometry"):
            problem = Slice(config, build_mesh(config, like=self.config))
        else:
            problem = self._first.varied(config)
        self._first = self._first or problem
        return problem, 1.0

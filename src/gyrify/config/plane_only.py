"""What is built for bodies in the plane alone, and says so."""

from __future__ import annotations

from typing import TYPE_CHECKING

from gyrify.errors import ConfigError

if TYPE_CHECKING:
    from gyrify.config.settings import Config


def require_plane(config: Config, what: str, instead: str = "") -> None:
    """Refuse a body in space.

    Parameters
    ----------
    config : Config
        The run.
    what : str
        What cannot be done, as the beginning of a sentence: "A study".
    instead : str
        What to do, as a sentence.

    Raises
    ------
    ConfigError
        If the body lies in space.
    """
    if config.geometry.n_dim == 3:
        raise ConfigError(
            f'{what} of a body in space (geometry.shape = "{config.geometry.shape}") is not built yet.',
            instead or "Use `gyrify run`: summary.json, metrics.csv and history.vtkhdf have the results.",
        )

"""``gyrify presets``: what there is to start from."""

from __future__ import annotations

import dataclasses

from gyrify.cli.streams import print_json, say


def presets(*, json: bool = False, quiet: bool = False) -> None:  # noqa: ARG001 - for uniformity
    """List the presets.

    Parameters
    ----------
    json : bool
        Print one JSON document.
    quiet : bool
        Show no progress.
    """
    from gyrify.config import Config, preset_about, preset_names

    found = [preset_about(name) for name in preset_names()]
    if json:
        print_json(
            [
                {**dataclasses.asdict(about), "config_hash": Config.preset(about.name).config_hash}
                for about in found
            ]
        )
        return
    width = max(len(about.name) for about in found)
    for about in found:
        say(f"{about.name:<{width}}  {about.description}")
        for line in about.not_claimed:
            say(f"{'':<{width}}  Not claimed: {line[0].lower()}{line[1:]}")

"""All that can be fuzzed, by name."""

from __future__ import annotations

import command_target
import page_target
import series_target
import stored_targets
import text_targets
from target import Target

TARGETS: dict[str, Target] = {
    target.name: target
    for module in (text_targets, stored_targets, series_target, command_target, page_target)
    for target in module.TARGETS
}

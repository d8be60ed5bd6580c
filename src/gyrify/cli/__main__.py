"""``python -m gyrify.cli`` is ``gyrify``."""

from __future__ import annotations

import sys

from gyrify.cli.app import main

sys.exit(main())

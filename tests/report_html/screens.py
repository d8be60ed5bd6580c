"""Screens on which reports are looked at."""

SCREENS = {"phone": (390, 844), "desk": (1440, 900), "wide": (2560, 1440)}
IS_DRAWN = "Boolean(window.gyrify)"

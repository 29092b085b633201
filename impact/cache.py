"""Where rosimpact keeps what it can make again."""

import os
from collections.abc import Mapping
from pathlib import Path

CACHE_VARIABLE = "ROSIMPACT_CACHE"


def cache_folder(environment: Mapping[str, str] = os.environ) -> Path:
    """$ROSIMPACT_CACHE, else the user's cache folder for rosimpact as the platform has it. Nothing is created here."""
    chosen = environment.get(CACHE_VARIABLE)
    if chosen:
        return Path(os.path.abspath(os.path.expanduser(chosen)))
    import platformdirs

    return Path(platformdirs.user_cache_dir("rosimpact", appauthor=False))

"""Where rosimpact keeps what it can make again."""

import hashlib
import os
from collections.abc import Mapping
from functools import cache
from pathlib import Path

CACHE_VARIABLE = "ROSIMPACT_CACHE"


def cache_folder(environment: Mapping[str, str] = os.environ) -> Path:
    """$ROSIMPACT_CACHE, else the user's cache folder for rosimpact as the platform has it. Nothing is created here."""
    chosen = environment.get(CACHE_VARIABLE)
    if chosen:
        return Path(os.path.abspath(os.path.expanduser(chosen)))
    import platformdirs

    return Path(platformdirs.user_cache_dir("rosimpact", appauthor=False))


@cache
def code_digest() -> str:
    """The same on every machine that has the same tool: names and contents of its files."""
    root = Path(__file__).parent
    digest = hashlib.sha1()
    for path in sorted(root.rglob("*")):
        if path.suffix != ".pyc" and path.is_file():
            data = path.read_bytes()
            digest.update(f"{path.relative_to(root).as_posix()} {len(data)}\n".encode("utf-8", "surrogateescape"))
            digest.update(data)
    return digest.hexdigest()

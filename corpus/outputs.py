"""Whether what a command is to write can be written: asked before the work, rather than found out after it."""

from __future__ import annotations

import errno
import os
from pathlib import Path

from ..edges.files import check_writable_path
from .report import CorpusError


def need_file(file: Path) -> None:
    """Raises CorpusError when a file cannot be written, as far as that can be known without trying."""
    fault = explain_unwritable(file) if not os.path.isdir(file) else os.strerror(errno.EISDIR)
    try:
        check_writable_path(file)
    except OSError as error:
        fault = fault or error.strerror
    if fault:
        raise CorpusError(f"{file}: cannot be written: {fault}; give another file")


def need_folder(folder: Path) -> None:
    """Raises CorpusError when a folder cannot be made, or no file in it, as far as that can be known without trying."""
    fault = explain_unwritable(folder) if not os.path.isfile(folder) else os.strerror(errno.ENOTDIR)
    if fault:
        raise CorpusError(f"{folder}: cannot be written: {fault}; give another folder")


def explain_unwritable(path: Path) -> str:
    """Why a file or folder cannot be written, or made where it is not there, in the system's words; else empty."""
    nearest = next((place for place in (path, *path.parents) if os.path.exists(place)), None)
    if nearest == path and os.path.isfile(path):
        return "" if os.access(path, os.W_OK) else os.strerror(errno.EACCES)
    if nearest is None or not os.path.isdir(nearest):
        return os.strerror(errno.ENOTDIR) if nearest is not None else os.strerror(errno.ENOENT)
    return "" if os.access(nearest, os.W_OK | os.X_OK) else os.strerror(errno.EACCES)

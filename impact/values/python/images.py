"""What cv_bridge says of an image whose encoding may be any text. Source: cv_bridge/core.py and `getCvType`."""

from __future__ import annotations

from typing import Any

import z3

from . import texts
from .run import PythonRun
from .terms import SymbolicText, Truth, make_truth

ENCODINGS = (
    "mono8", "mono16", "rgb8", "rgb16", "bgr8", "bgr16", "rgba8", "rgba16", "bgra8", "bgra16", "yuv422",
    *(f"bayer_{order}{bits}" for order in ("rggb", "bggr", "gbrg", "grbg") for bits in (8, 16)),
    "yuv422_yuy2", "uyvy", "yuyv", "nv12", "nv21", "nv24",
)  # fmt: skip
"""Those that a release knows."""
TYPES = ("8U", "8S", "16U", "16S", "32S", "32F", "64F")
"""What the others begin with that it may know: `32FC1`."""
BRIDGES = frozenset(("cv_bridge.CvBridge", "cv_bridge.core.CvBridge"))


def require_encoding(run: PythonRun, encoding: Any) -> None:
    """Raises what cv_bridge does where it surely knows no such encoding."""
    if isinstance(encoding, (str, SymbolicText)) and not run.decide(_may_be_known(run, encoding)):
        error = run.throw("CvBridgeError", "Unrecognized image encoding")
        error.bases = ("TypeError",)
        raise error


def _may_be_known(run: PythonRun, encoding: SymbolicText | str) -> Truth | bool:
    if isinstance(encoding, str):
        return encoding in ENCODINGS or encoding.startswith(TYPES)
    found = [texts.are_equal(run, encoding, name) for name in ENCODINGS]
    found += [_begins_with(encoding, start) for start in TYPES]
    if any(one is True for one in found):
        return True
    return make_truth(z3.Or(*[one.term for one in found if isinstance(one, Truth)]))


def _begins_with(text: SymbolicText, start: str) -> Truth | bool:
    if len(start) > len(text.characters):
        return False
    terms = [z3.BoolVal(True)] if text.size is None else [text.size.term >= len(start)]
    for own, wanted in zip(text.characters, start, strict=False):
        if not isinstance(own, int):
            terms.append(own == ord(wanted))
        elif own != ord(wanted):
            return False
    return make_truth(z3.And(*terms))

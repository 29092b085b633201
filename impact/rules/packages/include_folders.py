"""Folders that headers lie in, as far as whoever is not given their package misses them: now, or after an update."""

from ...targets.surface.offers import Offers
from ..vocabulary import Doubt, Need, TargetView

# System libraries whose headers lie in a folder of their own that the compiler does not search by itself. Kept by
# hand: the stored index has headers by the path that dependants write, below whichever folder.
OFF_PATH = frozenset({"eigen", "bullet", "libbullet-dev", "libpcl-all-dev", "libpcl-dev", "libogre-dev", "libxml2"})


def shares_one_folder(view: TargetView) -> bool:
    """Whether the headers of all released packages lie in one folder, and go on to with all updates that are known."""
    return all(
        offers.has_one_include_folder for offers in (view.offers, *(then.offers for _, then in view.updates))
    )


def collect_folder_doubts(view: TargetView, name: str, header: str) -> tuple[Doubt, ...] | None:
    """What speaks against an error where a header's package is not given to what includes it; None where the header
    lies in the folder that packages have in common, and goes on to."""
    own = _has_own_folder(view, view.offers, name, header)
    if own is not False:
        return () if own else (Doubt.INCOMPLETE,)
    for ahead, then in view.updates:
        if _has_own_folder(view, then.offers, name, header):
            return (Doubt.FAR if ahead.far else Doubt.UPCOMING,)
    return None


def find_include_doubt(view: TargetView, need: Need) -> Doubt | None:
    """What speaks against a compiler that stops at an include whose package CMake does not look for at all."""
    if not need.targets:
        return Doubt.UNCOMPILED
    first, *others = need.providers
    together = view.target.ros == 1 or view.offers.has_one_include_folder or others
    apart = not together and _has_own_folder(view, view.offers, first.name, need.subject)
    return None if apart else Doubt.LUCKY


def _has_own_folder(view: TargetView, offers: Offers, name: str, header: str) -> bool | None:
    if name in view.workspace.packages:
        return not offers.has_one_include_folder
    return offers.has_own_folder(name, header)

"""The versions of released packages that a run can say something about: what its targets have, and what an update of
each of them brings. Uses that are alike on all of these need not be looked for."""

import hashlib
from collections.abc import Iterable

from ...edges.memory import cache_method
from .availability import list_horizons
from .distro.distro import DistroTarget


class AskedVersions:
    """The versions of packages on some targets. identity: differs whenever the targets, or what is to come for them,
    do."""

    def __init__(self, targets: Iterable[DistroTarget]):
        self._targets: list[tuple[DistroTarget, bool]] = []
        for target in targets:
            self._targets.append((target, False))
            self._targets.extend((ahead.target, True) for ahead in list_horizons(target) if not ahead.platform)
        about = [(target.compute_identity(), ahead) for target, ahead in self._targets]
        self.identity = hashlib.sha1(repr(about).encode()).hexdigest()

    @cache_method
    def list_asked(self, package: str, ros: int) -> tuple[tuple[str, bool], ...]:
        """The versions of a package of a ROS generation, and of each whether only an update brings it; empty for one
        that no target has."""
        found: dict[str, bool] = {}
        for target, ahead in self._targets:
            version = target.find_version(package) if target.ros == ros else None
            if version is not None:
                found[version] = ahead and found.get(version, True)
        return tuple(found.items())

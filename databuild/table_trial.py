"""Reads every table of the data folder that ROSIMPACT_DATA names, as a check does; of large ones some rows.

`rosimpact data update` runs this in a process of its own, so that tables which cannot be read never come into use.
"""

import sys

from ..edges.console import run_command


def read_tables() -> int:
    """Returns 0. Raises SnapshotError for a table that cannot be read."""
    # Some tables are read when the modules are imported.
    from ..impact.targets import changes, parameters
    from ..impact.targets.constants import load_constants
    from ..impact.targets.distro.distro import DistroTarget
    from ..impact.targets.distro.known import list_known_distros
    from ..impact.targets.gazebo_topics import load_gazebo_topics
    from ..impact.targets.gz_systems import load_gz_systems
    from ..impact.targets.machine.sonames import load_sonames
    from ..impact.targets.providers.apt import load_apt
    from ..impact.targets.providers.archive import load_archives
    from ..impact.targets.providers.compiled import load_compiled
    from ..impact.targets.providers.components import load_components
    from ..impact.targets.providers.includes import load_offered
    from ..impact.targets.providers.libraries import load_libraries
    from ..impact.targets.providers.library import include_roots
    from ..impact.targets.providers.providers import load_providers
    from ..impact.targets.providers.standard import index_headers, list_brought
    from ..impact.targets.providers.stdlib import is_in_any_stdlib
    from ..impact.targets.providers.version_macros import make_version_test
    from ..impact.targets.surface.fields import load_fields
    from ..impact.targets.surface.store import load_shipped
    from ..impact.targets.tree_nodes import load_tree_nodes

    target = DistroTarget(list_known_distros()[-1].name, platform="conda-forge")
    target.find_library("eigen")
    for package in ("rclcpp", "roscpp"):
        target.find_version(package)
        load_fields().find_history(package, target.ros)
        load_shipped().find_lines(package)
        history = load_shipped().find_history(package, target.ros)
        if history is not None:
            history.load_surface(history.versions[-1])
    for library in ("eigen", "opencv"):
        include_roots(library)
        for version in load_libraries().list_versions(library).values():
            load_libraries().build(library, version)
    load_providers().find_header("ros/ros.h")
    load_providers().find_cmake("SDL2")
    load_providers().commands.get(target.ros)
    list_brought("vector", 13)
    is_in_any_stdlib("os")
    make_version_test("rclcpp", False, "1.0.0", ros=2, oldest="1.0.0")
    for kind in ("call-changed", "behaviour"):
        changes.load_uses(kind)
    for load in (
        *(changes.load_rows, changes.load_transitive, parameters.load_renamed_parameters, load_sonames, load_offered),
        *(index_headers, load_gazebo_topics, load_gz_systems, load_tree_nodes, load_archives, load_compiled),
        *(load_components, load_constants, lambda: load_apt("ubuntu jammy"), lambda: load_shipped().about),
    ):
        load()
    return 0


if __name__ == "__main__":
    sys.exit(run_command(read_tables, about="the tables"))

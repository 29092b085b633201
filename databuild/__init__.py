"""Makes the shipped snapshot from git repositories: rosdistro's history and, where given, superflore's caches."""

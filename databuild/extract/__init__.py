"""Sources of a version of a package to facts of what it offers. The facts themselves are in impact/facts."""

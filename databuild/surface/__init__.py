"""What the packages of a tree, a clone or an install space offer."""

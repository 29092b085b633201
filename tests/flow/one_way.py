"""Guards of a statement that a single way leads to."""

from rosimpact.impact.logic.guards import AS_WRITTEN, compare_ways, explain_ways


def compare(old, new, reading=AS_WRITTEN):
    return compare_ways((old,), (new,), reading)


def explain(old, new, reading=AS_WRITTEN):
    return explain_ways((old,), (new,), reading)

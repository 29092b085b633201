"""Guards as the functions of `logic` are given them: in the language of their files, and of a single way."""

from rosimpact.impact.logic import guards
from rosimpact.impact.logic.guards import NameReading


def language(*ways):
    paths = [guard.path for way in ways for guard in way]
    return "python" if paths and paths[0].endswith(".py") else "cpp"


def compare_ways(old, new, renames=None):
    return guards.compare_ways(old, new, NameReading(renames or {}, language(*old, *new)))


def explain_ways(old, new, renames=None):
    return guards.explain_ways(old, new, NameReading(renames or {}, language(*old, *new)))


def is_impossible(asked):
    return guards.is_impossible(asked, language(asked))


def compare(old, new, renames=None):
    return compare_ways((old,), (new,), renames)


def explain(old, new, renames=None):
    return explain_ways((old,), (new,), renames)

"""Conditions as written in a file, before anybody knows on whose machine they hold."""

import msgspec


class Condition(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """One branch that must be taken for a statement to count.

    language: `cmake`, `cpp`, `python`, `manifest` or `launch`; `macro` for an #if on a macro that CMake defines.
    text: the test. For cmake the arguments of if(), variables expanded where known, one space between them; for cpp the
    expression of #if (`#ifdef X` is written `defined(X)`); for macro what CMake tests; for a manifest its condition
    attribute; for python `try` (an except that covers ImportError), `TYPE_CHECKING`, or the source of the test.
    negated: True in the else branch. declared: for cmake, the packages that the test asks `X_FOUND` of and that the
    package it stands in declares. gate: where it does not hold nothing at all of the package is built.
    """

    language: str
    text: str
    negated: bool = False
    declared: tuple[str, ...] = ()
    gate: bool = False


UNDECIDED = Condition("launch", "")
"""Stands for any test of which only running tells."""

"""missing-standard-include: a name of the standard library is used and its header reaches the file only by luck.

What it does
    Reports names of the standard libraries of C++ and C in files that do not include the header that offers them, when
    no header that they do include brings it along with the compiler of the target, or with that of the newest distro.

Why it breaks
    Some other header brought it. The next version of libstdc++ stops including it, and the build fails on the machine
    that has that version.

Severity
    error when a source compiles the file, none of the headers that reach it there brings the name on the target, under
    the C++ standard in force, and all of them are known; warning in tests, under conditions, and in installed headers
    that only tests compile, or nothing; note where the contents of one of the headers are not known, for files that no
    source compiles, and for what lies ahead, in the newest distro, but for the first of a kind, a warning.

Example
    uint32_t width;                             // and no #include <cstdint>: GCC 13 stops here

Use instead
    #include <cstdint>

Not reported
    Names that a header which reaches the file may still bring; names in files that something unknown reaches; names
    that packages found bring under a later C++ standard which they ask for; macros that a file of the workspace
    defines, or that macros alone use; packages with target_precompile_headers().
"""

from ..vocabulary import TargetView, Text, rule
from .lost_includes import LOST, find_missing_includes


@rule(
    group="missing-include",
    scope="target",
    texts={
        "dropped": Text(LOST + "which {by} {version}[[ of {horizon}]] no longer includes", "#include <{subject}>"),
        "never": Text(LOST + "and no included header includes it with {by} {version}", "#include <{subject}>"),
    },
)
def missing_standard_include(view: TargetView):
    yield from find_missing_includes(view, standard=True)

"""Whether it is known whose an included header is, as the rules on what a file declares ask for it."""

from ..vocabulary import TargetView


def is_known_include(view: TargetView, path: str) -> bool:
    """Whether an included header is of the compiler, of somebody else, or of an interface of the workspace."""
    owner, _, rest = path.partition("/")
    if owner in view.workspace.packages:
        return path in view.workspace.headers or view.workspace.is_interface_header(owner, rest)
    providers = view.find_header(path)
    made = path.startswith(".") or any(provider.name in view.workspace.packages for provider in providers)
    return bool(providers) and not made

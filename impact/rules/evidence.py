"""What several rules ask: by what name one declares what is needed, and what leads in a circle."""

from ..model.view import Need, TargetView
from ..model.workspace import Package


def circular(view: TargetView, package: Package, name: str) -> bool:
    """True when what would be declared comes with the package itself, or is of the workspace and needs it."""
    other = view.workspace.packages.get(name)
    if other is None:
        return package.name in view.spread([name])
    return package.name in view.closure(other) or any(
        provider.name == package.name for need in view.needs(other) for provider in need.providers[:1]
    )


def name_to_declare(view: TargetView, need: Need) -> str | None:
    """The name a person would put into the manifest for a need: the first provider that can be had on the target, or
    the package that is named by its form, wherever it comes from."""
    other = "python3-" if view.target.python_major == 2 else "python-"
    for provider in sorted(need.providers, key=lambda p: p.name.startswith(other)):
        if provider.name and view.available(provider.name):
            return provider.name
    first = need.providers[0]
    if need.how not in ("launch", "find_package", "component", "import") or first.kind != "ros" or not first.sure:
        return None
    meant = first.name == need.subject.partition(".")[0] and not view.target.other_generation(first.name)
    return first.name if meant else None

"""What takes the place of ament_target_dependencies(): target_link_libraries() and kin, by what is linked."""

from collections.abc import Iterable
from itertools import pairwise

from ....edges.groups import group_pairs
from ...model.cmake.build import At, BuildTarget, DependencyCall
from ...model.cmake.link_forms import LinkForm, find_link_form
from ..vocabulary import FixAction, Insert, Package, Replace, TargetView

_KEYWORDS = ("PUBLIC", "PRIVATE", "INTERFACE")
_COMMAND = "ament_target_dependencies"
_LINKING = "target_link_libraries"


def tell_replacement(view: TargetView, package: Package, call: DependencyCall) -> str:
    """The call of target_link_libraries() that links the same, with `...` for what is not known."""
    words = [word for _, _, words in call.arguments for word in words]
    if not words:
        return _LINKING
    items = [word for word in words[1:] if word != "SYSTEM"]
    forms = {item: find_link_form(view, item) for item in items if item not in _KEYWORDS}
    links = [link for item in items for link in ((item,) if item in _KEYWORDS else (forms[item] or LinkForm()).links)]
    keyword = _find_keyword(package, call, words) if not items or items[0] not in _KEYWORDS else ""
    more = ["..."] if any(form is None or form.folders or form.definitions for form in forms.values()) else []
    return f"{_LINKING}({' '.join(dict.fromkeys([call.target, *filter(None, [keyword]), *links, *more]))})"


def make_link_fix(view: TargetView, package: Package) -> tuple[FixAction, ...]:
    """Actions that replace every call that counts on the target; none where one of them cannot be replaced."""
    calls = group_pairs((call.at, call) for call in package.build.dependency_calls)
    actions: list[FixAction] = []
    for several in calls.values():
        made = _replace_call(view, package, several[0]) if len(several) == 1 else ()
        if not made:
            return ()
        actions += made
    return tuple(actions)


def _replace_call(view: TargetView, package: Package, call: DependencyCall) -> tuple[FixAction, ...]:
    words = [word for _, _, words in call.arguments for word in words]
    keyword = _find_keyword(package, call, words)
    if len(words) < 2 or keyword is None or len(call.arguments[0][2]) != 1:
        return ()
    needs: list[tuple[str, str]] = []
    folders: dict[str, None] = {}
    definitions: dict[str, None] = {}
    pieces = [(_COMMAND, call.at, _LINKING), (call.arguments[0][0], call.arguments[0][1], call.arguments[0][0])]
    linked: set[str] = set()
    ahead = keyword
    for raw, at, held in call.arguments[1:]:
        texts: list[str] = []
        for word in held:
            if word == "SYSTEM":
                continue
            if word in _KEYWORDS:
                texts.append(word)
                linked.clear()
                continue
            form = find_link_form(view, word)
            if form is None:
                return ()
            needs += ((word, item) for item in form.items)
            folders.update(dict.fromkeys(form.folders))
            definitions.update(dict.fromkeys(form.definitions))
            texts += (link for link in form.links if link not in linked)
            linked.update(form.links)
        if ahead and texts:
            texts.insert(0, ahead)
            ahead = ""
        pieces.append((raw, at, " ".join(texts)))
    replaced = _replace_pieces(pieces, tuple(needs))
    if not replaced:
        return ()
    scope = next((word for word in words if word in _KEYWORDS), "PUBLIC")
    name, system = call.arguments[0][0], " SYSTEM" if "SYSTEM" in words else ""
    rest = [("target_include_directories", system, folders), ("target_compile_definitions", "", definitions)]
    lines = [f"{command}({name}{flag} {scope} {' '.join(items)})" for command, flag, items in rest if items]
    return (*replaced, *(Insert(call.at.path, call.at.line, line, tuple(needs)) for line in lines))


def _find_keyword(package: Package, call: DependencyCall, words: Iterable[str]) -> str | None:
    """The keyword to add, so that all calls that link the target have one or none has; None where some have and some
    have none already."""
    target = next((one for one in package.build.targets if one.name == call.target), BuildTarget("", "", call.at))
    kinds = {bool(link.visibility) for link in target.links if link.how == "link"}
    if len(kinds) == 2:
        return None
    with_keyword = any(link.visibility for link in target.links if link.how in ("link", "ament"))
    if not set(words).isdisjoint(_KEYWORDS):
        return None if kinds == {False} else ""
    if with_keyword:
        return None if kinds == {False} else "PUBLIC"
    return ""


def _replace_pieces(pieces: list[tuple[str, At, str]], needs: tuple[tuple[str, str], ...]) -> tuple[Replace, ...]:
    """Replacements of pieces of one call: those that one space, or the opening parenthesis, parts are replaced
    together, so that none is left where a piece goes. Empty where a line would be left without any."""
    groups: list[list[tuple[str, At, str]]] = [[pieces[0]]]
    for (raw, at, _), piece in pairwise(pieces):
        if piece[1].line == at.line and piece[1].column == at.column + len(raw) + 1:
            groups[-1].append(piece)
        else:
            groups.append([piece])
    result: list[Replace] = []
    for group in groups:
        at = group[0][1]
        old, new = " ".join(raw for raw, _, _ in group), " ".join(text for _, _, text in group if text)
        if not new:
            return ()
        if old.startswith(f"{_COMMAND} "):
            old, new = (text.replace(" ", "(", 1) for text in (old, new))
        if old != new:
            result.append(Replace(at.path, at.line, at.column, old, new, needs))
    return tuple(result)

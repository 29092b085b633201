"""Random message definitions, random lengths, and messages that have these."""

from hypothesis import strategies as st
from rosimpact.impact.facts.interface import extract
from rosimpact.impact.model.wire import SIZES

PRIMITIVE = sorted(SIZES.keys() - {"octet"})


@st.composite
def drawn_messages(draw, times=(), bounded=True):
    """(texts by `package/Name`, the last of which may hold the others; how long strings and arrays are)."""
    texts, full = {}, ""
    for number in range(draw(st.integers(1, 4))):
        lines = []
        for place in range(draw(st.integers(0 if number else 1, 6))):
            kinds = ["primitive", "primitive", "string", *(["nested"] if texts else [])]
            kind = draw(st.sampled_from(kinds))
            type_ = {
                "primitive": lambda: draw(st.sampled_from([*PRIMITIVE, *times])),
                "string": lambda: draw(st.sampled_from(["string", *(["string<=9"] if bounded else [])])),
                "nested": lambda: draw(st.sampled_from(sorted(texts))),
            }[kind]()
            arrays = ["", "", "", "[]", "[2]", "[5]", *(["[<=9]"] if bounded else [])]
            lines.append(f"{type_}{draw(st.sampled_from(arrays))} f{place}\n")
        full = f"pkg_{draw(st.sampled_from('ab'))}/M{number}"
        texts[full] = "".join(lines)
    lengths = {}
    for path in list_lengths(texts, full):
        lengths[path] = draw(st.integers(0, 9))
    return texts, full, lengths


def parse_sections(texts):
    return {name: extract(text.encode(), "msg").sections[0] for name, text in texts.items()}


def list_lengths(texts, full, above=""):
    """The paths of all strings and arrays that have a length."""
    for field in parse_sections(texts)[full].fields:
        path = f"{above}.{field.name}" if above else field.name
        if field.array and field.array not in ("[2]", "[5]"):
            yield path
        inside = f"{path}[]" if field.array else path
        if field.type in texts:
            yield from list_lengths(texts, field.type, inside)
        elif field.type.startswith("string"):
            yield inside


def fill_message(texts, full, lengths, make, above="", number=1):
    """A message whose strings and arrays are as long as asked. make: makes one of its type's name and values."""
    values = {}
    for field in parse_sections(texts)[full].fields:
        path = f"{above}.{field.name}" if above else field.name
        inside = f"{path}[]" if field.array else path

        def fill_one(field=field, inside=inside):
            if field.type in texts:
                return fill_message(texts, field.type, lengths, make, inside, number)
            if field.type.startswith("string"):
                return "s" * lengths[inside]
            return make(field.type, number)

        if field.array:
            count = int(field.array[1:-1]) if field.array in ("[2]", "[5]") else lengths[path]
            values[field.name] = make(field.type + "[]", [fill_one() for _ in range(count)])
        else:
            values[field.name] = fill_one()
    return make(full, values)

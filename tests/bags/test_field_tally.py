"""Fields counted on the bytes of messages: the same as when a message is built of them."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rosimpact.impact.analysis.field_tally import MessageTally, WrongBytes
from rosimpact.impact.facts.interface import extract
from rosimpact.impact.model.wire import SIZES, build_layout

typesys = pytest.importorskip("rosbags.typesys")
numpy = pytest.importorskip("numpy")

TYPES = sorted(SIZES.keys() - {"octet", "byte"})


@st.composite
def drawn_values(draw):
    """(texts by name, name of the last, values of some messages of it as nested dictionaries)."""
    texts = {}
    for number in range(draw(st.integers(1, 3))):
        lines = []
        for place in range(draw(st.integers(0 if number else 1, 5))):
            type_ = draw(st.sampled_from([*TYPES, "string", "string", *texts, *texts]))
            lines.append(f"{type_}{draw(st.sampled_from(['', '', '[]', '[2]', '[3]']))} f{place}\n")
        texts[f"p/M{number}"] = "".join(lines)
    full = f"p/M{len(texts) - 1}"
    return texts, full, [draw(draw_message(texts, full)) for _ in range(draw(st.integers(1, 3)))]


@st.composite
def draw_message(draw, texts, full):
    values = {}
    for field in parse_section(texts[full]).fields:
        if field.type in texts:
            one = draw_message(texts, field.type)
        elif field.type == "string":
            one = st.sampled_from(["", "", "a", "abcde"])
        else:
            some = {"float": [0.0, -0.0, 1.5], "bool": [False, False, True]}.get(field.type.rstrip("3264"), [0, 0, 1])
            one = st.sampled_from(some)
        length = {"": None, "[]": (0, 3), "[2]": (2, 2), "[3]": (3, 3)}[field.array]
        values[field.name] = draw(one if length is None else st.lists(one, min_size=length[0], max_size=length[1]))
    return values


def parse_section(text):
    return extract(text.encode(), "msg").sections[0]


def build(store, texts, full, values):
    fields = {}
    for field in parse_section(texts[full]).fields:
        value = values[field.name]
        if field.type in texts:
            inner = [build(store, texts, field.type, one) for one in (value if field.array else [value])]
            fields[field.name] = inner if field.array else inner[0]
        elif field.array and field.type != "string":
            fields[field.name] = numpy.array(value, {"bool": "bool_", "char": "uint8"}.get(field.type, field.type))
        else:
            fields[field.name] = value
    return store.types[full.replace("/", "/msg/")](**fields)


def list_values(texts, full, values, above=""):
    """(path, value) of every field wherever it is in a message."""
    for field in parse_section(texts[full]).fields:
        value, path = values[field.name], f"{above}.{field.name}" if above else field.name
        if field.type not in texts:
            yield path, value
            continue
        if field.array:
            yield path, (value if field.array == "[]" else [])
        for one in value if field.array else [value]:
            yield from list_values(texts, field.type, one, f"{path}[]" if field.array else path)


def is_nonzero(value):
    return any(map(is_nonzero, value)) if isinstance(value, list) else bool(value) and not isinstance(value, dict)


@given(drawn_values())
@settings(max_examples=150)
def test_fields_are_counted_as_they_are(drawn):
    texts, full, messages = drawn
    store = typesys.get_typestore(typesys.Stores.EMPTY)
    for name, text in texts.items():
        store.register(typesys.get_types_from_msg(text, name.replace("/", "/msg/")))
    sections = {name: parse_section(text) for name, text in texts.items()}
    for encoding in ("ros1", "cdr"):
        tally = MessageTally(build_layout(sections.get, full, encoding), encoding)
        for number, message in enumerate(messages):
            built = build(store, texts, full, message)
            name = full.replace("/", "/msg/")
            if encoding == "ros1":
                tally.add(bytes(store.serialize_ros1(built, name)))
            else:
                tally.add(bytes(store.serialize_cdr(built, name, little_endian=number % 2 == 0)))
        tally.finish()
        seen = {}
        for message in messages:
            for path, value in list_values(texts, full, message):
                seen.setdefault(path, []).append(value)
        for each in tally.fields:
            field, values = each.field, seen.get(each.field.path, [])
            if field.members or field.type in texts:
                assert each.filled == any(values), field
            else:
                assert each.nonzero == is_nonzero(values), (encoding, field)
                assert each.filled == any(v != [] and (field.elements == -1 or is_nonzero(v)) for v in values), field
            if field.size:
                one = sum(len(value) if isinstance(value, list) else 1 for value in values)
                least = one * field.size + (4 * len(values) if field.elements == -1 else 0)
                assert least <= each.size <= least + 7 * len(values)
                assert each.size == least or encoding == "cdr"
            if field.elements == -1:
                lengths = [len(value) for value in values] or [0]
                assert (each.met, each.total, each.most) == (len(values), sum(lengths), max(lengths))
                assert each.least == (min(lengths) if values else -1)


@given(st.binary(max_size=60), drawn_values())
def test_any_bytes_are_counted_or_refused(data, drawn):
    texts, full, _ = drawn
    sections = {name: parse_section(text) for name, text in texts.items()}
    for encoding in ("ros1", "cdr"):
        tally = MessageTally(build_layout(sections.get, full, encoding), encoding)
        try:
            tally.add(data)
        except WrongBytes:
            continue
        tally.finish()
        assert sum(each.size for each in tally.fields) <= len(data)


def test_padding_at_the_end_of_a_message():
    layout = build_layout({"p/M": parse_section("uint8 a\n")}.get, "p/M", "cdr")
    tally = MessageTally(layout, "cdr")
    tally.add(b"\0\1\0\3a\0\0\0")
    with pytest.raises(WrongBytes, match="has 9 bytes where its definition says 5"):
        tally.add(b"\0\1\0\3a\0\0\0\0")

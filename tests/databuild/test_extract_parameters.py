"""Parameters that files declare: one file in, its parameters with their defaults out."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rosimpact.databuild.extract.parameters import make_kind, mentions
from rosimpact.impact.facts.kinds import FileFacts, decode, encode, extract

CPP = [
    ('node->declare_parameter("rate", 20.0);', [("rate", "20.0")]),
    ('declare_parameter<double>("rate", 0.50f);', [("rate", "0.5")]),
    ('declare_parameter("frame", std::string("map"));', [("frame", '"map"')]),
    ('declare_parameter("n", rclcpp::ParameterValue(1\'000));', [("n", "1000")]),
    ('declare_parameter("joints", std::vector<std::string>{});', [("joints", "{}")]),
    ('declare_parameter("gains", std::vector<double>{1.0, 2.0});', [("gains", "{1.0, 2.0}")]),
    ('declare_parameter("rate", rclcpp::PARAMETER_DOUBLE, descriptor);', [("rate", None)]),
    ('declare_parameter("rate", rclcpp::ParameterType::PARAMETER_DOUBLE);', [("rate", None)]),
    ('declare_parameter("rate", default_rate());', [("rate", "?")]),
    (
        'nav2_util::declare_parameter_if_not_declared(node, name + ".tolerance", rclcpp::ParameterValue(0.25));',
        [("*.tolerance", "0.25")],
    ),
    ('node->declare_or_get_parameter("odom_topic", std::string("odom"));', [("odom_topic", '"odom"')]),
    ('declare_parameters("arm", {{"a", 1}, {"b", 2.5}});', [("arm.a", "1"), ("arm.b", "2.5")]),
    ("declare_parameter(name, value);", []),
    ('declare_parameter("names", std::map<std::string, int>{});', [("names", "?")]),
    ('declare_parameter("mark", std::string("),("), descriptor);', [("mark", '"),("')]),
    ('declare_parameter("open", 1', []),
    ('// declare_parameter("old", 1);\n/* declare_parameter("older", 1); */', []),
    ("void declare_parameter(const std::string & name, int value = 3);", []),
    ('undeclare_parameter("rate");', []),
]
PYTHON = [
    ("self.declare_parameter('rate', 20.0)", [("rate", "20.0")]),
    ("self.declare_parameter('on', True)", [("on", "true")]),
    ("self.declare_parameter('frame', 'map', descriptor)", [("frame", '"map"')]),
    ("self.declare_parameter('gains', [1, 2])", [("gains", "{1, 2}")]),
    ("self.declare_parameter(name='rate', value=compute())", [("rate", "?")]),
    ("self.declare_parameter('rate', Parameter.Type.DOUBLE)", [("rate", None)]),
    ("self.declare_parameter('rate')", [("rate", None)]),
    ("self.declare_parameter(f'{name}.rate', 1)", [("*.rate", "1")]),
    ("self.declare_parameter(name + '.rate', 1)", [("*.rate", "1")]),
    ("self.declare_parameters('arm', [('a', 1), ('b', None, d)])", [("arm.a", "1"), ("arm.b", "None")]),
    ("RATE = 'rate'\nFAST = 20.0\nself.declare_parameter(RATE, FAST)", [("rate", "20.0")]),
    ("ARM = 'arm'\nself.declare_parameter(f'{ARM}.rate', ARM + '_link')", [("arm.rate", '"arm_link"')]),
    ("ARM = 'arm'\nself.declare_parameters(ARM, [(ARM + '_a', 1)])", [("arm.arm_a", "1")]),
    ("RATE = 'rate'\nRATE = 'speed'\nself.declare_parameter(RATE, 1)", []),
    ("RATE = 'rate'\ndef f(RATE):\n  self.declare_parameter(RATE, 1)", []),
    ("self.declare_parameter(name, 1)\n# self.declare_parameter('x', 1)", []),
]
CFG = [
    ("gen.add('rate', double_t, 0, 'how fast', 20.0, 0, 50)", [("rate", "20.0")]),
    ("gen.add('on', bool_t, 0, description='x', default=True)", [("on", "true")]),
    ("group.add('frame', str_t, 0, 'which')", [("frame", None)]),
    ("names.add('x')", []),
]
YAML = [
    (
        "arm:\n  rate: {type: double, default_value: 2.0}\n  pid:\n    p: {type: double}",
        [("rate", "2.0"), ("pid.p", None)],
    ),
    ("arm:\n  gains:\n    __map_joints:\n      p: {type: double, default_value: 0.1}", [("gains.*.p", "0.1")]),
    ("arm:\n  names: {type: string_array, default_value: []}", [("names", "{}")]),
    ("- a\n- b", []),
]


@pytest.mark.parametrize(
    ("kind", "text", "expected"),
    [
        (make_kind(kind), *row)
        for kind, rows in (("cpp", CPP), ("python", PYTHON), ("cfg", CFG), ("yaml", YAML))
        for row in rows
    ],
)
def test_what_a_file_declares(kind, text, expected):
    facts = extract(kind, text.encode()).facts
    assert not facts.problems
    assert [(one.name, one.default) for one in facts.parameters] == expected


@pytest.mark.parametrize(
    ("kind", "text", "mentioned"),
    [
        (make_kind("cpp"), 'f("rate"); g("arm.gains.p", \'x\');', ("p", "rate", "x")),
        (
            make_kind("cpp"),
            '// "old_rate"\nh(name + "_limit", "turbo/steps", "~frame", "gains.");',
            ("_limit", "frame", "gains", "old_rate", "steps"),
        ),
        (make_kind("cpp"), 'log("a sentence", "50", "");', ()),
        (make_kind("python"), "names = ['rate', \"frame\"]", ("frame", "rate")),
        (make_kind("cfg"), "gen.add('rate', double_t, 0, 'x', 1.0)", ()),
    ],
)
def test_what_a_file_mentions(kind, text, mentioned):
    assert extract(kind, text.encode()).facts.mentioned == mentioned


@pytest.mark.parametrize(
    ("name", "expected"),
    [("base.rate", True), ("rate", True), ("rates", False), ("speed_limit", True), ("limit", False),
     ("max_speed", True), ("max", False)],
)  # fmt: skip
def test_what_may_be_a_mentioned_name(name, expected):
    assert mentions(("_limit", "max_", "rate"), name) is expected


@pytest.mark.parametrize("kind", [make_kind("python"), make_kind("cfg"), make_kind("yaml")])
def test_a_file_that_cannot_be_read_declares_nothing(kind):
    facts = extract(kind, b"declare: [(").facts
    assert not facts.parameters and facts.problems


@given(st.binary(max_size=200), st.sampled_from(["cpp", "python", "cfg", "yaml"]))
def test_any_bytes_give_facts(data, kind):
    kind = make_kind(kind)
    facts = extract(kind, b'declare_parameter("a", ' + data)
    assert decode(kind, encode(facts)) == facts and isinstance(facts, FileFacts)

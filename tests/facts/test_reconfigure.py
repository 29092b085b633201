"""Files of dynamic_reconfigure: the parameters that they generate."""

import pytest
from rosimpact.impact.facts.reconfigure import ReconfigurableParameter as Parameter
from rosimpact.impact.facts.reconfigure import extract


@pytest.mark.parametrize(
    ("call", "expected"),
    [
        ('gen.add("speed", double_t, 0, "m/s", 0.5, 0.0, 2)', Parameter("speed", "double", 1, 0.0, 2.0)),
        ('gen.add("beams", int_t, 0, "", 2, -4, +4)', Parameter("beams", "integer", 1, -4.0, 4.0)),
        ('gen.add("beams", "int", 0, "", default=2, max=4)', Parameter("beams", "integer", 1, None, 4.0)),
        ('gen.add(name="on", paramtype=bool_t, level=0, description="")', Parameter("on", "bool", 1)),
        ('gen.add("on", bool_t, 0, "", True, False, True)', Parameter("on", "bool", 1)),
        ('gen.add("frame", str_t, 0, "", "map")', Parameter("frame", "string", 1)),
        ('gen.add("far", double_t, 0, "", 1.0, 0.0, LONGEST)', Parameter("far", "double", 1, 0.0, None)),
        ('group.add("speed", double_t, 0, "", 0.5)', Parameter("speed", "double", 1)),
        ('gen.add(NAME, double_t, 0, "", 0.5)', None),
        ('gen.add("speed", TYPE, 0, "", 0.5)', None),
        ('gen.add_group("speed")', None),
    ],
)
def test_parameters(call, expected):
    assert extract(call.encode()).parameters == ((expected,) if expected else ())


@pytest.mark.parametrize(
    ("code", "name"),
    [
        ('exit(gen.generate(PACKAGE, "node", "Lamp"))', "Lamp"),
        ('gen.generate(PACKAGE, "node", NAME)', ""),
        ('print "old"\nexit(gen.generate("lamp", "node", "Lamp"))', "Lamp"),
    ],
)
def test_name_of_what_is_generated(code, name):
    assert extract(code.encode()).generated == name


def test_what_is_no_python_has_no_parameters():
    assert extract(b"gen.add(((").parameters == ()

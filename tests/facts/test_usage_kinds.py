"""Arguments that show what they are: floating point numbers, strings, shared pointers."""

import pytest
from rosimpact.impact.facts.usage import Pattern, find_use_places

DURATION = Pattern("Duration", before="rclcpp::", arguments="1", where={"1": "<float>"}, names=True)
ERROR = Pattern("RCLCPP_ERROR", arguments="2+", where={"2": "<string>"})
PUBLISH = Pattern("publish", before=r"(?:->|\.)", arguments="1", where={"1": "<shared>"})

USES = (
    (
        DURATION,
        {
            "auto a = rclcpp::Duration(0.5);": True,
            "const rclcpp::Duration a{2.0 / rate};": True,
            "auto a = rclcpp::Duration(static_cast<double>(n));": True,
            "void f(double s) { a = rclcpp::Duration(s * 2); }": True,
            "auto a = rclcpp::Duration(rclcpp::Duration::from_seconds(0.5));": False,
            "double ns = 5; auto a = rclcpp::Duration(rclcpp::Duration::from_nanoseconds(ns / 2));": False,
            "auto a = rclcpp::Duration(round(0.5));": False,
            "auto a = rclcpp::Duration(1.5s);": False,
            "rclcpp::Duration to_duration(double seconds);": False,
        },
    ),
    (
        ERROR,
        {
            'RCLCPP_ERROR(logger, "no " + name);': True,
            "RCLCPP_ERROR(logger, text.str());": True,
            "RCLCPP_ERROR(logger, std::to_string(3));": True,
            "void f(const std::string & why) { RCLCPP_ERROR(logger, why); }": True,
            "void g(const char * why); void f(const std::string & why) { RCLCPP_ERROR(logger, why); }": False,
            'RCLCPP_ERROR(logger, ("no " + name).c_str());': False,
            'RCLCPP_ERROR(logger, "%s", ("no " + name).c_str());': False,
            'RCLCPP_ERROR(logger, good ? "yes" : "no");': False,
            'RCLCPP_ERROR(logger, "no %" PRIu64, number);': False,
        },
    ),
    (
        PUBLISH,
        {
            "auto said = std::make_shared<String>(); publisher->publish(said);": True,
            "auto said = std::make_shared<String>(); publisher->publish(*said);": False,
            "auto said = std::make_unique<String>(); publisher->publish(said);": False,
            "auto said = std::make_shared<String>(); void f(const String & said) { publisher->publish(said); }": False,
            "String said; publisher->publish(said);": False,
        },
    ),
)


@pytest.mark.parametrize(
    ("pattern", "text", "seen"),
    [(pattern, text, seen) for pattern, texts in USES for text, seen in texts.items()],
    ids=[text for _, texts in USES for text in texts],
)
def test_what_an_argument_is_is_told_from_the_file(pattern, text, seen):
    assert bool(list(find_use_places(text.encode(), pattern))) is seen

"""Parameters that handlers read for many objects: by overloads, from within themselves, and over and over."""

import pytest
from joining import graph, joined, manifest
from rosimpact.impact.model.flow import values as flow_values

HANDLERS = """
    #pragma once
    #include <rclcpp/rclcpp.hpp>
    class Handler {
    public:
      Handler(std::shared_ptr<rclcpp::Node> node, const std::string & name) : base_name_(name), node_(node) {}
      template <typename T>
      T getParam(const std::string & parameter) {
        T value;
        node_->get_parameter<T>(join(parameter), value);
        return value;
      }
      std::string join(const std::string & parameter) { return base_name_ + "." + parameter; }
      std::string join() { return base_name_; }
    protected:
      std::string base_name_;
      std::shared_ptr<rclcpp::Node> node_;
    };
    class LensHandler : public Handler {
    public:
      LensHandler(std::shared_ptr<rclcpp::Node> node, const std::string & name) : Handler(node, name) {}
    };
    class ClockHandler : public Handler {
    public:
      ClockHandler(std::shared_ptr<rclcpp::Node> node, const std::string & name) : Handler(node, name) {}
    };
    class Lens {
    public:
      Lens(std::shared_ptr<rclcpp::Node> node, const std::string & name) {
        handler_ = std::make_unique<LensHandler>(node, name);
        READS
      }
      std::unique_ptr<LensHandler> handler_;
    };
"""
MAIN = """
    #include "handlers.hpp"
    int main(int argc, char ** argv) {
      rclcpp::init(argc, argv);
      auto node = std::make_shared<rclcpp::Node>("driver");
      auto clock = std::make_unique<ClockHandler>(node, "clock");
      clock->getParam<int>("rate");
      auto left = std::make_unique<Lens>(node, "left");
      auto right = std::make_unique<Lens>(node, "right");
      rclcpp::spin(node);
    }
"""


def make_files(reads: str) -> dict[str, str]:
    return {
        "p/package.xml": manifest("p", "ament_cmake"),
        "p/handlers.hpp": HANDLERS.replace("READS", reads),
        "p/driver.cpp": MAIN,
    }


def test_each_overload_is_given_what_its_own_calls_give():
    found = graph(make_files('handler_->getParam<int>("width");'))
    assert {one.name for one in found.parameters} == {"clock.rate", "left.width", "right.width"}


def test_what_is_worked_out_once_costs_nothing_again(monkeypatch):
    names = [f"p{number}" for number in range(60)]
    monkeypatch.setattr(flow_values, "_STEPS_IN_ALL", 1_000)
    monkeypatch.setattr(flow_values, "_STEPS_A_FUNCTION", 0)
    monkeypatch.setattr(flow_values, "_FEW_STEPS", 3)
    found = graph(make_files(" ".join(f'handler_->getParam<int>("{name}");' for name in names)))
    expected = {f"{side}.{name}" for side in ("left", "right") for name in names}
    assert {one.name for one in found.parameters} == {"clock.rate", *expected}


@pytest.mark.parametrize("lost", ["ClockHandler", "LensHandler"])
def test_where_one_is_not_known_those_of_other_objects_are(monkeypatch, lost):
    """For the objects of one class there are too many steps."""
    join = joined(make_files('handler_->getParam<int>("width");'))
    evaluate = flow_values.FlowValues.evaluate

    def give_up(self, value, fn, line=0):
        of = {name for maker, rows in self.made.items() for row in rows for name in row[0].name.split("::")}
        too_many = flow_values.FlowValue(None, "unresolved", flow_values.TOO_MANY)
        return [too_many] if lost in of and fn.name == "Handler::getParam" else evaluate(self, value, fn, line)

    monkeypatch.setattr(flow_values.FlowValues, "evaluate", give_up)
    names = {one.name for one in join.build().parameters}
    assert names == ({"left.width", "right.width"} if lost == "ClockHandler" else {"clock.rate"})

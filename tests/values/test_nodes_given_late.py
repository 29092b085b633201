"""Objects that are given their node after the constructor, as plugins are: that is done before they subscribe."""

import pytest
from harness_workspaces import needs_clang, write_workspace
from rosimpact.impact.analysis.values import explore_values
from rosimpact.impact.values.outcomes import Reaction

PLUGIN = """
#include <rclcpp/rclcpp.hpp>
#include <std_msgs/msg/int32.hpp>
using std_msgs::msg::Int32;
class Grid {{
 public:
  Grid(const std::string &name, int width) : name_(name), width_(width) {{}}
  int width() const {{ return width_; }}
 private:
  std::string name_;
  int width_;
}};
class Base {{
 public:
  virtual ~Base() = default;
  void {method}(Grid *grid, {given} parent) {{
    grid_ = grid;
    node_ = parent{lock};
    if (!node_ || grid_->width() > 100) throw std::runtime_error("not usable");
    {start}
  }}
  virtual void start() = 0;
 protected:
  Grid *grid_ = nullptr;
  rclcpp::Node::SharedPtr node_;
}};
class Plugin : public Base {{
 public:
  void start() override {{
    pub_ = node_->create_publisher<Int32>("out", 1);
    sub_ = node_->create_subscription<Int32>("in", 1, [this](const Int32::SharedPtr msg) {{
      Int32 out;
      out.data = 100 / msg->data;
      if (msg->data > 3) pub_->publish(out);
    }});
  }}
  rclcpp::Publisher<Int32>::SharedPtr pub_;
  rclcpp::Subscription<Int32>::SharedPtr sub_;
}};
"""


def explore(root, source):
    root = write_workspace(root, 2, {"src/plugin.cpp": source}, "src/plugin.cpp")
    (one,) = explore_values(root, publishers=False, jobs=1).report.callbacks
    return one


@needs_clang
@pytest.mark.parametrize(
    "given, lock, start",
    [
        ("const rclcpp::Node::WeakPtr &", ".lock()", "start();"),
        ("rclcpp::Node::SharedPtr", "", "start();"),
        ("std::shared_ptr<rclcpp::Node>", "", ""),
    ],
)
def test_a_plugin_has_its_node_when_it_subscribes(tmp_path, given, lock, start):
    source = PLUGIN.format(method="initialize", given=given, lock=lock, start=start)
    one = explore(tmp_path / "ws", source)
    assert not one.reason and {each.crash.value for each in one.examples if each.crash} == {"division by zero"}
    (data,) = (each for each in one.fields if each.path == "data")
    assert data.sets[Reaction.HANDLED].spans == ((4, 2147483647),)


@needs_clang
def test_a_node_that_nobody_gives_it_is_not_there(tmp_path):
    """What takes no node is not called before."""
    source = PLUGIN.format(method="set", given="int", lock=" ? node_ : nullptr", start="")
    one = explore(tmp_path / "ws", source)
    assert not one.counts.keys() & {Reaction.HANDLED, Reaction.CRASH}

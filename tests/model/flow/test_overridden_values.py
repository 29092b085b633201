"""Methods and members that deriving classes replace: what an object has is that of its own class."""

import pytest
from joining import graph

PYTHON = """
    import rclpy
    from rclpy.node import Node
    from std_msgs.msg import String

    class Base(Node):
        topic = "/base"
        def __init__(self, name="base"):
            super().__init__(name)
            self.create_publisher(String, {given}, 1)
        def find(self):
            return "/base"
        @property
        def prop(self):
            return "/base"

    class Derived(Base):
        topic = "/derived"
        def __init__(self):
            super().__init__("derived")
        def find(self):
            return "/derived"
        @property
        def prop(self):
            return "/derived"

    class Plain(Base):
        pass

    def main():
        rclpy.init()
        executor = rclpy.executors.SingleThreadedExecutor()
        {made}
        executor.spin()
    main()
"""


def list_published(files):
    """Names of nodes and what they publish."""
    found = graph(files)
    names = {one.id: one.name for one in found.nodes}
    published = [one for one in found.endpoints if one.role == "publisher" and not one.implied]
    assert {(one.how, one.only_if) for one in published} == {("literal", "")}
    return {(names[one.node], one.topic) for one in published}


@pytest.mark.parametrize("given", ["self.topic", "self.find()", "self.prop"])
@pytest.mark.parametrize(("made", "expected"), [
    ("executor.add_node(Derived())", {("/derived", "/derived")}),
    ("executor.add_node(Base())", {("/base", "/base")}),
    ("executor.add_node(Plain())", {("/base", "/base")}),
    ("executor.add_node(Base())\n        executor.add_node(Derived())", {("/base", "/base"), ("/derived", "/derived")}),
])  # fmt: skip
def test_an_object_of_python_has_what_its_class_says(given, made, expected):
    assert list_published({"p/robot.py": PYTHON.format(given=given, made=made)}) == expected


CPP = """
    #include <rclcpp/rclcpp.hpp>
    class Base : public rclcpp::Node {{
     public:
      explicit Base(const std::string & name) : Node(name) {{}}
      void start() {{ pub_ = create_publisher<std_msgs::msg::String>(find(), 1); }}
      virtual std::string find() {{ return "/base"; }}
      rclcpp::Publisher<std_msgs::msg::String>::SharedPtr pub_;
    }};
    class Derived : public Base {{
     public:
      Derived() : Base("derived") {{}}
      std::string find() override {{ return "/derived"; }}
    }};
    int main(int argc, char ** argv) {{
      rclcpp::init(argc, argv);
      {made}
      node->start();
      rclcpp::spin(node);
    }}
"""


@pytest.mark.parametrize(("made", "expected"), [
    ("auto node = std::make_shared<Derived>();", {("/derived", "/derived")}),
    ('auto node = std::make_shared<Base>("base");', {("/base", "/base")}),
])  # fmt: skip
def test_an_object_of_cpp_has_what_its_class_says(made, expected):
    assert list_published({"p/robot.cpp": CPP.format(made=made)}) == expected


def test_where_nothing_is_seen_to_make_objects_all_may_be():
    text = PYTHON.format(given="self.find()", made="executor.add_node(choose()())")
    found = graph({"p/robot.py": text})
    published = {one.topic for one in found.endpoints if one.role == "publisher" and not one.implied}
    assert published == {"/base", "/derived"}


def test_a_member_that_a_constructor_assigns_is_what_that_says():
    text = """
        import rclpy
        from rclpy.node import Node
        from std_msgs.msg import String
        class Config:
            out = "/plain"
            def __init__(self):
                self.out = "/own"
        class Robot(Node):
            def __init__(self, config: Config):
                super().__init__("robot")
                self.create_publisher(String, config.out, 1)
        rclpy.init()
        rclpy.spin(Robot(Config()))
    """
    assert list_published({"p/robot.py": text}) == {("/robot", "/own")}

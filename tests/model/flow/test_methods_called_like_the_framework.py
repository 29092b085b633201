"""A method that is called like one of the framework's, of an object that is no node, is followed as any other."""

import pytest
from joining import ends, graph, manifest

TALKER = """
    import rclpy
    from rclpy.node import Node
    from std_msgs.msg import Empty


    class Topics:
        def __init__(self, node):
            self.node = node
            self.made = {}

        def NAME(self, kind, topic, qos=10):
            self.made[topic] = self.node.create_publisher(Empty, topic, qos)


    class Base(Node):
        def __init__(self, name):
            super().__init__(name)
            self.topics = Topics(self)


    class Talker(Base):
        def __init__(self):
            super().__init__("talker")
            self.topics.NAME(Empty, "said", 1)
            self.topics.NAME(Empty, "/heard", 1)


    def main():
        rclpy.init()
        rclpy.spin(Talker())


    if __name__ == "__main__":
        main()
"""
OVERRIDDEN = """
    import rclpy
    from rclpy.node import Node
    from std_msgs.msg import Empty


    class Talker(Node):
        def __init__(self):
            super().__init__("talker")
            self.create_publisher(Empty, "said", 1)

        def create_publisher(self, kind, topic, qos):
            return super().create_publisher(kind, topic, qos)


    if __name__ == "__main__":
        rclpy.init()
        rclpy.spin(Talker())
"""


@pytest.mark.parametrize("name", ("add", "create_publisher"))
def test_the_name_of_the_method_of_another_object_changes_nothing(name: str):
    found = graph({"p/package.xml": manifest("p", "ament_cmake"), "p/talker.py": TALKER.replace("NAME", name)}, 2)
    said = {("p/talker.py", topic, "std_msgs/Empty") for topic in ("/said", "/heard")}
    assert ends(found, "publisher") == said


def test_what_a_node_overrides_has_its_callers_as_sites():
    found = graph({"p/package.xml": manifest("p", "ament_cmake"), "p/talker.py": OVERRIDDEN}, 2)
    lines = [e.line for e in found.endpoints if e.role == "publisher" and not e.implied]
    assert ends(found, "publisher") == {("p/talker.py", "/said", "std_msgs/Empty")}
    assert len(lines) == 1

import rclpy
from rclpy.node import Node
from std_msgs.msg import Empty


class Bell(Node):
    def __init__(self):
        super().__init__('bell')
        self.publisher = self.create_publisher(Empty, 'bell', 10)


def main():
    rclpy.init()
    rclpy.spin(Bell())

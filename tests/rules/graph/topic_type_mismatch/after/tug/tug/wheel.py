import rclpy
from geometry_msgs.msg import TwistStamped
from rclpy.node import Node


class Wheel(Node):
    def __init__(self):
        super().__init__('wheel')
        self.publisher = self.create_publisher(TwistStamped, 'course', 10)


def main():
    rclpy.init()
    rclpy.spin(Wheel())

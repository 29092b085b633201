import rclpy
from rclpy.node import Node
from geometry_msgs.msg import Twist


class Wheel(Node):
    def __init__(self):
        super().__init__('wheel')
        self.publisher = self.create_publisher(Twist, 'course', 10)


def main():
    rclpy.init()
    rclpy.spin(Wheel())

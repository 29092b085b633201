import rclpy
from rclpy.node import Node
from std_msgs.msg import Float32


class Gauge(Node):
    def __init__(self):
        super().__init__('gauge')
        self.publisher = self.create_publisher(Float32, 'tide_level', 10)


def main():
    rclpy.init()
    rclpy.spin(Gauge())

import rclpy
from rclpy.node import Node
from steam_msgs.msg import Pressure


class Gauge(Node):
    def __init__(self):
        super().__init__('gauge')
        self.publisher = self.create_publisher(Pressure, 'boiler', 10)


def main():
    rclpy.init()
    rclpy.spin(Gauge())

import rclpy
from rclpy.node import Node
from steam_msgs.msg import Pressure


class Dial(Node):
    def __init__(self):
        super().__init__('dial')
        self.create_subscription(Pressure, 'boiler', self.on_pressure, 10)

    def on_pressure(self, message):
        self.get_logger().info(str(message.bar))


def main():
    rclpy.init()
    rclpy.spin(Dial())

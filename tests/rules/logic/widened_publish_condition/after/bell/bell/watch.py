import rclpy
from rclpy.node import Node
from std_msgs.msg import Empty


class Watch(Node):
    def __init__(self):
        super().__init__('watch')
        self.create_subscription(Empty, 'ship_bell', self.on_bell, 10)

    def on_bell(self, message):
        self.get_logger().info('bell')


def main():
    rclpy.init()
    rclpy.spin(Watch())

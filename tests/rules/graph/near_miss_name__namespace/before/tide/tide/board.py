import rclpy
from rclpy.node import Node
from std_msgs.msg import Float32


class Board(Node):
    def __init__(self):
        super().__init__('board')
        self.create_subscription(Float32, 'tide_level', self.on_level, 10)

    def on_level(self, message):
        self.get_logger().info(str(message.data))


def main():
    rclpy.init()
    rclpy.spin(Board())

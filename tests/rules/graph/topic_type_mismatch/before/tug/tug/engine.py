import rclpy
from geometry_msgs.msg import TwistStamped
from rclpy.node import Node


class Engine(Node):
    def __init__(self):
        super().__init__('engine')
        self.create_subscription(TwistStamped, 'course', self.on_course, 10)

    def on_course(self, message):
        self.get_logger().info(message.header.frame_id)


def main():
    rclpy.init()
    rclpy.spin(Engine())

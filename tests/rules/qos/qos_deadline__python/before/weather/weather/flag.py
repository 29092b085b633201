import rclpy
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.qos import QoSProfile
from std_msgs.msg import Float32


class Flag(Node):
    def __init__(self):
        super().__init__('flag')
        qos = QoSProfile(depth=5, deadline=Duration(nanoseconds=100000000))
        self.create_subscription(Float32, 'wind', self.on_wind, qos)

    def on_wind(self, message):
        self.get_logger().info(str(message.data))


def main():
    rclpy.init()
    rclpy.spin(Flag())

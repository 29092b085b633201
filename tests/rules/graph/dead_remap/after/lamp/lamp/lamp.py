import rclpy
from rclpy.node import Node
from std_msgs.msg import Bool


class Lamp(Node):
    def __init__(self):
        super().__init__('lamp')
        self.create_subscription(Bool, 'fog_horn', self.on_horn, 10)

    def on_horn(self, message):
        self.get_logger().info(str(message.data))


def main():
    rclpy.init()
    rclpy.spin(Lamp())

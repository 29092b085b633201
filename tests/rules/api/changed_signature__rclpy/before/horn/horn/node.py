import rclpy
from rclpy.node import Node
from std_msgs.msg import Bool


class Horn(Node):
    def __init__(self):
        super().__init__('horn')
        self.publisher = self.create_publisher(Bool, 'blown')
        self.create_subscription(Bool, 'blow', self.blow)

    def blow(self, message):
        self.publisher.publish(message)


def main():
    rclpy.init()
    rclpy.spin(Horn())

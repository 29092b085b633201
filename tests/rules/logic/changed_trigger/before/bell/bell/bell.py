import rclpy
from rclpy.node import Node
from std_msgs.msg import Empty


class Bell(Node):
    def __init__(self):
        super().__init__('bell')
        self.rope = True
        self.hours = 0
        self.publisher = self.create_publisher(Empty, 'ship_bell', 10)
        self.timer = self.create_timer(30.0, self.ring)

    def ring(self):
        self.hours = (self.hours + 1) % 8
        if self.rope:
            self.publisher.publish(Empty())


def main():
    rclpy.init()
    rclpy.spin(Bell())

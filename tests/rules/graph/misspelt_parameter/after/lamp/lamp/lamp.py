import rclpy
from rclpy.node import Node


class Lamp(Node):
    def __init__(self):
        super().__init__('lamp')
        self.declare_parameter('turning_period', 7.5)
        self.period = self.get_parameter('turning_period').value
        self.timer = self.create_timer(self.period, self.turn)

    def turn(self):
        self.get_logger().info('turned')


def main():
    rclpy.init()
    rclpy.spin(Lamp())

import rclpy
from rclpy.node import Node
from std_msgs.msg import Float32


class Sounder(Node):
    def __init__(self):
        super().__init__('sounder')
        self.publisher = self.create_publisher(Float32, 'depth', 10)


def main():
    rclpy.init()
    rclpy.spin(Sounder())

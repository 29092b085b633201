import rclpy
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.qos import QoSProfile
from std_msgs.msg import Float32


class Mast(Node):
    def __init__(self):
        super().__init__('mast')
        qos = QoSProfile(depth=5, deadline=Duration(seconds=0.05))
        self.publisher = self.create_publisher(Float32, 'wind', qos)


def main():
    rclpy.init()
    rclpy.spin(Mast())

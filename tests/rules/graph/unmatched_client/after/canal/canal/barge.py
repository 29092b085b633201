import rclpy
from canal_msgs.srv import OpenGate
from rclpy.node import Node


class Barge(Node):
    def __init__(self):
        super().__init__('barge')
        self.gate = self.create_client(OpenGate, 'open_gate')


def main():
    rclpy.init()
    rclpy.spin(Barge())

import rclpy
from canal_msgs.srv import OpenGate
from rclpy.node import Node


class Lock(Node):
    def __init__(self):
        super().__init__('lock')
        self.create_service(OpenGate, 'lock/open_gate', self.on_open)

    def on_open(self, request, response):
        response.done = request.gate == 1
        return response


def main():
    rclpy.init()
    rclpy.spin(Lock())

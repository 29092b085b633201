import rclpy
from rclpy.executors import MultiThreadedExecutor


def main():
    rclpy.init()
    node = rclpy.create_node('arm')
    rclpy.spin(node, MultiThreadedExecutor())

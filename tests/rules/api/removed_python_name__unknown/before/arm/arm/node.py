import rclpy
from rclpy.executors import ThreadedExecutor


def main():
    rclpy.init()
    node = rclpy.create_node('arm')
    rclpy.spin(node, ThreadedExecutor())

import rclpy
from nav2_common.launch import ParseMultiRobotPose
from nav2_simple_commander.costmap_2d import PyCostmap2D


def main():
    rclpy.init()
    node = rclpy.create_node('arm')
    print(ParseMultiRobotPose('robots').value())
    print(on_map(PyCostmap2D(node.costmap)))


def on_map(costmap: PyCostmap2D):
    return costmap.worldToMap(1.0, 2.0)

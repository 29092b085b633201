import rclpy
from nav2_simple_commander.costmap_2d import PyCostmap2D

try:
    from nav2_common.launch import ParseMultiRobotPose as call
except ImportError:
    call = None


def main():
    rclpy.init()
    node = rclpy.create_node('arm')
    if call is not None:
        print(call('robots').value())
    print(on_map(PyCostmap2D(node.costmap)))


def on_map(costmap: PyCostmap2D):
    if hasattr(costmap, 'worldToMap'):
        return costmap.worldToMap(1.0, 2.0)
    return costmap.worldToMapValidated(1.0, 2.0)

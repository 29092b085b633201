# Copyright 2026 The rosimpact authors
# SPDX-License-Identifier: Apache-2.0

"""The battery monitor: battery reports in, diagnostics out."""

from pathlib import Path

import rclpy
from ament_index_python.packages import get_package_share_directory
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from porter_msgs.msg import BatteryReport
from rclpy.node import Node

from porter_monitor.limits import Verdict, read_limits

LEVELS = {
    Verdict.GO_ON: DiagnosticStatus.OK,
    Verdict.RETURN: DiagnosticStatus.WARN,
    Verdict.STOP: DiagnosticStatus.ERROR,
}


class BatteryMonitor(Node):
    """Turns battery reports into diagnostics."""

    def __init__(self):
        super().__init__("battery_monitor")
        share = Path(get_package_share_directory("porter_monitor"))
        self.limits = read_limits((share / "limits.yaml").read_text())
        self.publisher = self.create_publisher(DiagnosticArray, "/diagnostics", 10)
        self.subscription = self.create_subscription(BatteryReport, "battery", self.on_report, 10)

    def on_report(self, report: BatteryReport) -> None:
        """Judge one report."""
        verdict = self.limits.judge(report.voltage)
        status = DiagnosticStatus(
            level=LEVELS[verdict],
            name="battery",
            message=verdict.value,
            values=[
                KeyValue(key="voltage", value=f"{report.voltage:.2f}"),
                KeyValue(key="percentage", value=f"{report.percentage:.0%}"),
            ],
        )
        array = DiagnosticArray(status=[status])
        array.header.stamp = self.get_clock().now().to_msg()
        self.publisher.publish(array)
        if verdict is not Verdict.GO_ON:
            self.get_logger().warning(verdict.value, throttle_duration_sec=10.0)


def main():
    """Run the node until it is interrupted."""
    rclpy.init()
    node = BatteryMonitor()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()

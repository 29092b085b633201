#!/usr/bin/env python3
from controller_manager_msgs.srv import SwitchController


def request():
    return SwitchController.Request(deactivate_controllers=["arm"])

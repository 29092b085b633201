"""A ROS distro over time: releases, dependencies, rosdep keys."""

from setuptools import setup

setup(
    name='rover_bringup',
    version='1.2.0',
    packages=['rover_bringup'],
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/rover_bringup']),
        ('share/rover_bringup', ['package.xml']),
        ('share/rover_bringup/launch', ['launch/drive.launch.py', 'launch/state.launch.xml']),
        ('share/rover_bringup/config', ['config/drive.yaml', 'config/arm.yaml']),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
)

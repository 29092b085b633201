from setuptools import setup

setup(
    name='arm_bringup',
    version='1.2.0',
    packages=['arm_bringup'],
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/arm_bringup']),
        ('share/arm_bringup', ['package.xml']),
        ('share/arm_bringup/launch', ['launch/servo.launch.py']),
        ('share/arm_bringup/config', ['config/behaviors.yaml']),
        ('share/arm_bringup/config/humble', ['config/humble/behaviors.yaml']),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
)

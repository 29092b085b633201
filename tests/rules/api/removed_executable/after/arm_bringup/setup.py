from setuptools import setup

setup(
    name='arm_bringup',
    version='1.2.0',
    packages=['arm_bringup'],
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/arm_bringup']),
        ('share/arm_bringup', ['package.xml']),
        ('share/arm_bringup/launch', ['launch/arm.launch.py']),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
)

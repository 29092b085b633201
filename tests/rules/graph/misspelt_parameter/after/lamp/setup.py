from setuptools import setup

setup(
    name='lamp',
    version='1.2.0',
    packages=['lamp'],
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/lamp']),
        ('share/lamp', ['package.xml']),
        ('share/lamp/launch', ['launch/lamp.launch.xml']),
        ('share/lamp/config', ['config/lamp.yaml']),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    entry_points={'console_scripts': ['lamp = lamp.lamp:main']},
)

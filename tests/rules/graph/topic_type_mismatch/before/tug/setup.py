from setuptools import setup

setup(
    name='tug',
    version='1.2.0',
    packages=['tug'],
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/tug']),
        ('share/tug', ['package.xml']),
        ('share/tug/launch', ['launch/tug.launch.xml']),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    entry_points={'console_scripts': ['wheel = tug.wheel:main', 'engine = tug.engine:main']},
)

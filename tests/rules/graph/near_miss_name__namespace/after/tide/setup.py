from setuptools import setup

setup(
    name='tide',
    version='1.2.0',
    packages=['tide'],
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/tide']),
        ('share/tide', ['package.xml']),
        ('share/tide/launch', ['launch/tide.launch.xml']),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    entry_points={'console_scripts': ['gauge = tide.gauge:main', 'board = tide.board:main']},
)

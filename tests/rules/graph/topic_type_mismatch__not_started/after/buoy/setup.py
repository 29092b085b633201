from setuptools import setup

setup(
    name='buoy',
    version='1.2.0',
    packages=['buoy'],
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/buoy']),
        ('share/buoy', ['package.xml']),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    entry_points={'console_scripts': ['sounder = buoy.sounder:main']},
)

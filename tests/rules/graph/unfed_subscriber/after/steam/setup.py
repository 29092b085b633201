from setuptools import setup

setup(
    name='steam',
    version='1.2.0',
    packages=['steam'],
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/steam']),
        ('share/steam', ['package.xml']),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    entry_points={'console_scripts': ['gauge = steam.gauge:main', 'dial = steam.dial:main']},
)

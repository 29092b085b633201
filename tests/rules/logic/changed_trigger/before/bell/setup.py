from setuptools import setup

setup(
    name='bell',
    version='1.2.0',
    packages=['bell'],
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/bell']),
        ('share/bell', ['package.xml']),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    entry_points={'console_scripts': ['bell = bell.bell:main', 'watch = bell.watch:main']},
)
